// cmd_mesh.c - relume mesh: surfaces as triangles
#include "commands/mesh_tasks.h"

#include <time.h>

struct mesh_options {
    struct args args;
    const char *output;
    bool json;
};
#define OPTIONS struct mesh_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "OUT", "mesh to write: .ply, .obj or .glb"),
    FLAG("--json", json, "triangles, vertices and seconds as one JSON object"),
    {0},
};

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void report(const struct mesh_options *o, const struct relume_mesh *mesh, double time)
{
    if (o->json)
        printf("{\"triangles\": %zu, \"vertices\": %zu, \"seconds\": %.6f}\n", mesh->triangle_count,
               mesh->vertex_count, time);
    else
        announce(&o->args, RELUME_NOTE, "%s: %zu triangles, %zu vertices, %.2f s", o->output,
                 mesh->triangle_count, mesh->vertex_count, time);
}

static relume_status run(const struct args *args)
{
    const struct mesh_options *o = (const void *)args;
    const struct relume_mesh_params *p = relume_mesh_params(.log = args->log);
    struct relume_mesh mesh = {0};
    relume_status status = relume_mesh_check(o->output, p);
    const double start = seconds();
    if (!status)
        status = relume_mesh_read(&mesh, args->input[0], p);
    const double time = seconds() - start;
    if (!status)
        status = relume_mesh_write(&mesh, o->output, p);
    if (!status)
        report(o, &mesh, time);
    relume_mesh_free(&mesh);
    return status;
}

static const struct command *const tasks[] = {&mesh_task_simplify, NULL};

const struct command command_mesh = {
    .tasks = tasks,
    COMMAND("mesh", "MODEL -o OUT [OPTION ...]", "surfaces as triangles, in other formats",
            "relume mesh statue.obj -o statue.glb", 1, 1),
};
