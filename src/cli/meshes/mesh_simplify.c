// mesh_simplify.c - relume mesh simplify: fewer triangles that look the same
#include "cli/meshes/mesh_tasks.h"

#include <math.h>

struct simplify_options {
    struct args args;
    const char *output, *steps;
    double error, jnd, distance, gloss, white;
    int triangles;
    bool quadrics, json;
};
#define OPTIONS struct simplify_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "OUT", "mesh to write: .ply, .obj or .glb"),
    TEXT_AS(OPTION_OUTPUT, "--steps", steps, "FILE.csv",
            "also write which vertex went onto which, in order: undone, they lead back"),
    FLAG("--json", json, "triangles, vertices, errors and seconds as one JSON object"),
    GROUP("how far"),
    NUMBER("--error", error, "E",
           "most distance from the original, in diagonals of its box: 0.001 is 0.1 %; default: "
           "what is not seen from --distance",
           1e-9, 1),
    INT("--triangles", triangles, "N", "as many triangles, or a few less", 1, 2147483647),
    NUMBER("--jnd", jnd, "J", "shading changes by about J noticeable steps at most; default: 4",
           0.01, 100),
    GROUP("what is seen"),
    NUMBER("--distance", distance, "D",
           "of the eye, in diagonals; default: where --error is seen under 1/30 degree, else 1.9",
           0.01, 1e6),
    NUMBER("--gloss", gloss, "G", "sharpness of highlights: 0 is matte; default: 20", 0, 1000),
    NUMBER("--luminance", white, "CD", "of white, in candela per square metre; default: 200", 0.01,
           1e6),
    FLAG("--quadrics", quadrics, "test nothing; --error is that of quadrics"),
    {0},
};

static void print_steps(const void *context, FILE *to)
{
    const struct relume_simplified *s = context;
    fputs("vertex,onto,error,distance\n", to);
    for (size_t i = 0; i < s->steps; i++)
        fprintf(to, "%u,%u,%.6g,%.6g\n", s->step[i].vertex, s->step[i].onto,
                (double)s->step[i].error, (double)s->step[i].distance);
}

static void report(const struct simplify_options *o, const struct relume_simplified *s,
                   size_t before, double time)
{
    if (!o->json) {
        announce(&o->args, RELUME_NOTE, "%s: %zu of %zu triangles, %zu vertices, %.2f s", o->output,
                 s->triangles, before, s->vertices, time);
        return;
    }
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_integer(&w, "triangles", (long long)s->triangles);
    jput_integer(&w, "vertices", (long long)s->vertices);
    jput_integer(&w, "triangles_before", (long long)before);
    jput_number(&w, "error", s->error, 9);
    jput_number(&w, "distance", s->distance, 9);
    jput_fixed(&w, "seconds", time, 6);
    jend(&w);
}

static relume_status run_mesh_simplify(const struct args *args)
{
    const struct simplify_options *o = (const void *)args;
    const struct relume_mesh_params *p = relume_mesh_params(.log = args->log);
    struct relume_mesh mesh = {0}, small = {0};
    struct relume_simplified done = {0};
    double time = 0.0;
    if (o->quadrics && o->jnd > 0.0)
        return usage_error("--quadrics tests nothing of what is seen; leave out --jnd");
    relume_status status = relume_mesh_check(o->output, p);
    if (!status)
        status = relume_mesh_read(&mesh, args->input[0], p);
    if (!status) {
        const double start = mesh_clock();
        status = relume_mesh_simplify(
            &small, &done, &mesh,
            relume_simplify_params(.log = args->log, .error = o->error,
                                   .triangles = (size_t)o->triangles, .jnd = o->jnd,
                                   .distance = o->distance,
                                   .gloss =
                                       given(o, &o->gloss) && o->gloss <= 0.0 ? -1.0 : o->gloss,
                                   .white = o->white, .quadrics = o->quadrics,
                                   .no_steps = !o->steps));
        time = mesh_clock() - start;
    }
    if (!status)
        status = relume_mesh_write(&small, o->output, p);
    if (!status && o->steps)
        status = relume_file_print(o->steps, print_steps, &done, args->log);
    if (!status)
        report(o, &done, mesh.triangle_count, time);
    relume_free(done.step);
    relume_mesh_free(&mesh);
    relume_mesh_free(&small);
    return status;
}

const struct command mesh_task_simplify = {
    COMMAND(run_mesh_simplify, "mesh simplify",
            "MODEL -o OUT [--error E] [--triangles N] [--jnd J] [OPTION ...]",
            "fewer triangles that look the same",
            "relume mesh simplify statue.ply -o small.glb --error 0.001", 1, 1),
};
