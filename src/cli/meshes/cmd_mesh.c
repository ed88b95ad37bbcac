// cmd_mesh.c - relume mesh: surfaces as triangles, of volumes, depth and models
#include "cli/meshes/mesh_depth.h"
#include "cli/meshes/mesh_volume.h"

#include <string.h>
#include <strings.h>
#include <sys/stat.h>

struct mesh_options {
    struct args args;
    const char *output;
    bool json;
    struct ints blocks;
    struct volume_options volume;
    struct depth_options depth;
};
#define OPTIONS struct mesh_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "OUT", "mesh to write: .ply, .obj or .glb"),
    FLAG("--json", json, "triangles, vertices and seconds as one JSON object"),
    WORDS(
        "--block", blocks, "N,...",
        "largest boxes: 1, 2, 4, 8 or 16 samples; fewer triangles where the surface is smooth; of "
        "volumes several, in OUT.1.ply, OUT.4.ply, ...; default: 1, of depth 2",
        OPTION_INT, .min = 1, .max = 16),
    VOLUME_ROWS,
    DEPTH_ROWS,
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
        struct jwriter w = json_to(stdout);
        jopen_object(&w, NULL);
        mesh_put_made(&w, &made);
        status = jend(&w);
    } else if (!status) {
        mesh_say(&o->args, &made);
    }
    relume_mesh_free(&mesh);
    return status;
}

static bool ends_in(const char *name, const char *const *endings)
{
    const char *dot = strrchr(name, '.');
    for (; dot && *endings; endings++)
        if (!strcasecmp(dot, *endings))
            return true;
    return false;
}

// What is a volume by its name, a folder of slices, or by the options that only volumes have.
static bool seems_volume(const struct mesh_options *o)
{
    static const char *const endings[] = {".raw", ".nrrd", ".nhdr", ".nii", ".gz",
                                          ".hdr", ".tif",  ".tiff", NULL};
    struct stat s;
    return o->volume.thresholds.count || o->volume.size.side[0] || o->volume.type ||
           ends_in(o->args.input[0], endings) ||
           (!stat(o->args.input[0], &s) && S_ISDIR(s.st_mode));
}

static relume_status run_mesh(const struct args *args)
{
    const struct mesh_options *o = (const void *)args;
    const int block = o->blocks.count ? o->blocks.item[0] : 2;
    if (seems_volume(o))
        return mesh_of_volume(args, &o->volume, &o->blocks, o->output, o->json);
    if (!ends_in(args->input[0], (const char *const[]){".exr", NULL}))
        return convert(o);
    if (o->blocks.count > 1)
        return usage_error("--block: expected one number for depth");
    if (o->depth.texture && o->depth.no_colours)
        return usage_error("--texture: not with --no-colours; expected one of them");
    return mesh_of_depth(args, &o->depth, block, o->output, o->json);
}

static const struct command *const tasks[] = {&mesh_task_simplify, &mesh_task_billboards, NULL};

const struct command command_mesh = {
    .tasks = tasks,
    COMMAND(run_mesh, "mesh", "VOLUME|FILE.exr|MODEL -o OUT [OPTION ...]",
            "the surface in a volume or behind depth as triangles; models in other formats",
            "relume mesh head.nii.gz --threshold 80 -o head.ply", 1, 1),
};
