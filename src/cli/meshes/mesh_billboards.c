// mesh_billboards.c - relume mesh billboards: a cloud of flat pictures in place of a model
#include "cli/meshes/mesh_tasks.h"

#include <math.h>
#include <stdlib.h>

struct billboards_options {
    struct args args;
    const char *output;
    bool json;
    double error, texel, angle, waste;
    int count;
    int method;
};
#define OPTIONS struct billboards_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "OUT",
           "quads to write: .obj, .ply or .glb, their picture beside it as OUT.png"),
    FLAG("--json", json, "billboards, texels, error and seconds as one JSON object"),
    GROUP("billboards"),
    NUMBER("--error", error, "E",
           "how far they may be from the surface, of the longest side of its box; default: 0.01",
           1e-6, 1.0),
    INT("--billboards", count, "N", "at most so many, in place of an error", 1, 1000000),
    NUMBER("--texel", texel, "T",
           "side of a texel, of the longest side of the box; default: half the error", 1e-6, 1.0),
    NAME("--method", method, "M",
         "clusters: what is near becomes one plane (default); greedy: the planes that pass most",
         RELUME_BILLBOARDS_CLUSTERS, "clusters", "greedy"),
    NUMBER("--angle", angle, "DEG", "clusters: between triangles and their plane; default: 60", 0.1,
           90.0),
    NUMBER("--waste", waste, "W", "clusters: the empty part of a rectangle; default: 0.75", 0.01,
           1.0),
    {0},
};

static void print(const struct billboards_options *o, const struct relume_billboards *cloud,
                  const struct relume_image *picture, double longest, double seconds)
{
    const double error = longest > 0.0 ? (double)cloud->error / longest : 0.0;
    if (!o->json) {
        announce(&o->args, RELUME_NOTE,
                 "%s: %zu billboards, %zu texels in a picture of %d x %d, error %.3g %%, %.2f s",
                 o->output, cloud->count, cloud->texels, picture->width, picture->height,
                 100.0 * error, seconds);
        return;
    }
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_text(&w, "output", o->output);
    jput_integer(&w, "billboards", (long long)cloud->count);
    jput_integer(&w, "texels", (long long)cloud->texels);
    jput_number(&w, "error", error, 9);
    jput_integer(&w, "width", picture->width);
    jput_integer(&w, "height", picture->height);
    jput_fixed(&w, "seconds", seconds, 6);
    jend(&w);
}

static double longest_side(const struct relume_mesh *m)
{
    double longest = 0.0;
    for (int c = 0; c < 3; c++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < m->vertex_count; i++) {
            low = fmin(low, (double)m->position[i][c]);
            high = fmax(high, (double)m->position[i][c]);
        }
        longest = fmax(longest, high - low);
    }
    return longest;
}

static relume_status load_colour(struct relume_image *colour, const struct relume_mesh *mesh,
                                 const struct relume_log *log)
{
    if (!mesh->picture || !mesh->texture)
        return RELUME_OK;
    return relume_image_load(colour, mesh->picture, relume_image_params(.log = log));
}

static relume_status make(const struct billboards_options *o, char *png)
{
    const struct relume_log *log = o->args.log;
    struct relume_mesh mesh = {0}, quads = {0};
    struct relume_billboards cloud = {0};
    struct relume_image colour = {0}, picture = {0};
    relume_status status =
        relume_mesh_read(&mesh, o->args.input[0], relume_mesh_params(.log = log));
    if (!status)
        status = load_colour(&colour, &mesh, log);
    const double start = mesh_clock();
    if (!status)
        status = relume_billboards_create(
            &cloud, &mesh,
            relume_billboards_params(.log = log, .method = (enum relume_billboards_method)o->method,
                                     .error = o->error, .count = o->count, .texel = o->texel,
                                     .angle_deg = o->angle, .waste = o->waste));
    if (!status)
        status = relume_billboards_sheet(&quads, &picture, &cloud, &mesh,
                                         colour.data ? &colour : NULL, log);
    const double seconds = mesh_clock() - start;
    quads.cut_out = true;
    if (!status)
        status = mesh_write_both(&quads, o->output, &picture, png, log);
    if (!status)
        print(o, &cloud, &picture, longest_side(&mesh), seconds);
    relume_mesh_free(&mesh);
    relume_mesh_free(&quads);
    relume_billboards_free(&cloud);
    relume_image_destroy(&colour);
    relume_image_destroy(&picture);
    return status;
}

static relume_status run_mesh_billboards(const struct args *args)
{
    const struct billboards_options *o = (const void *)args;
    if (o->count && o->error > 0.0)
        return usage_error("--billboards: not with --error; expected one of them");
    if (o->count && o->method == RELUME_BILLBOARDS_GREEDY)
        return usage_error("--billboards: of clusters only; expected --error with greedy");
    char *png = mesh_picture_name(o->output);
    relume_status status = relume_mesh_check(o->output, relume_mesh_params(.log = args->log));
    if (!status && !png)
        status = RELUME_ENOMEM;
    if (!status)
        status = relume_file_check(png, args->log);
    if (!status)
        status = make(o, png);
    free(png);
    return status;
}

const struct command mesh_task_billboards = {
    COMMAND(run_mesh_billboards, "mesh billboards", "MODEL -o OUT [OPTION ...]",
            "a model from afar: flat pictures with holes in place of its triangles",
            "relume mesh billboards cow.obj --error 0.02 -o far.glb", 1, 1),
};
