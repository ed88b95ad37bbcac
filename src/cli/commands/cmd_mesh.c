// cmd_mesh.c - relume mesh: surfaces as triangles, of volumes and models
#include "commands/mesh_volume.h"

struct mesh_options {
    struct args args;
    const char *output;
    bool json;
    struct volume_options volume;
};
#define OPTIONS struct mesh_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "OUT", "mesh to write: .ply, .obj or .glb"),
    FLAG("--json", json, "triangles, vertices and seconds as one JSON object"),
    VOLUME_ROWS,
    {0},
};

static relume_status convert(const struct mesh_options *o)
{
    const struct relume_mesh_params *p = relume_mesh_params(.log = o->args.log);
    struct relume_mesh mesh = {0};
    relume_status status = relume_mesh_check(o->output, p);
    const double start = mesh_clock();
    if (!status)
        status = relume_mesh_read(&mesh, o->args.input[0], p);
    const struct mesh_made made = {o->output, &mesh, mesh_clock() - start, NULL, 0};
    if (!status)
        status = relume_mesh_write(&mesh, o->output, p);
    if (!status && o->json) {
        putchar('{');
        mesh_print_json(&made);
        puts("}");
    } else if (!status) {
        mesh_say(&o->args, &made);
    }
    relume_mesh_free(&mesh);
    return status;
}

static relume_status run(const struct args *args)
{
    const struct mesh_options *o = (const void *)args;
    return given(o, &o->volume.threshold) ? mesh_of_volume(args, &o->volume, o->output, o->json)
                                          : convert(o);
}

static const struct command *const tasks[] = {&mesh_task_simplify, NULL};

const struct command command_mesh = {
    .tasks = tasks,
    COMMAND("mesh", "VOLUME|MODEL -o OUT [OPTION ...]",
            "the surface in a volume as triangles, or a model in another format",
            "relume mesh head.nii.gz --threshold 80 -o head.ply", 1, 1),
};
