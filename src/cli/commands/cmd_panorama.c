// cmd_panorama.c - relume panorama: photographs all around one point become a capture
#include "commands/capture_views.h"

#include <stdlib.h>
#include <string.h>

struct panorama_options {
    struct args args;
    const char *layout, *depth;
    struct views_options views;
    int width, bands;
};
#define OPTIONS struct panorama_options

static const struct option options[] = {
    VIEWS_OPTIONS,
    TEXT("--layout", layout, "input", "P",
         "cube (six faces), sphere, cylinder or stitch (overlapping photographs); default: sphere "
         "of one photograph, else stitch"),
    INT("--width", width, "picture", "N", "stitch: width of the sphere", 1, 65536),
    INT("--bands", bands, "picture", "N",
        "stitch: bands of blending, 1 to 10; 1: hard seams; default: by the photographs' size", 1,
        10),
    TEXT("--depth", depth, "depth", "FILE", "a picture of its depth"),
    TEXT("--depth-range", views.depth_range, "depth", "A,B",
         "distance of white and of black in --depth"),
    TEXT("--panorama", layout, "input", "P", NULL),  // of relume capture
    {0},
};

static relume_status make(const struct panorama_options *o, const struct relume_ingest_params *p)
{
    static const char *const names[] = {"sphere", "cylinder", "cube", "stitch", NULL};
    const char *name = o->layout ? o->layout : o->args.inputs > 1 ? "stitch" : "sphere";
    int source = 0;
    while (names[source] && strcmp(names[source], name))
        source++;
    if (!names[source])
        return unknown_name("panorama", name, names);
    struct relume_panorama_params panorama = {
        .depth = o->depth,
        .width = o->width,
        .bands = o->bands,
    };
    const relume_status status = parse_depth_range(panorama.depth_range, &o->views);
    return status ? status
                  : relume_panorama_ingest(o->views.output, o->args.input, o->args.inputs,
                                           (enum relume_panorama_source)source, &panorama, p);
}

static relume_status run(const struct args *args)
{
    const struct panorama_options *o = (const void *)args;
    struct relume_vec3 *lights;
    struct relume_ingest_params p;
    if (!o->views.output)
        return usage_error("panorama: expected -o DIR");
    relume_status status = ingest_params(&p, &lights, args, &o->views);
    if (!status)
        status = make(o, &p);
    free(lights);
    if (!status)
        say_next(args, o->views.output, "a panorama");
    return status;
}

const struct command command_panorama = {
    .name = "panorama",
    .usage = "PHOTO... -o DIR [OPTION ...]",
    .summary = "stitch photographs to a panorama, or turn a finished one into a capture",
    .example = "relume panorama shot*.jpg -o forest",
    .min_inputs = 1,
    .max_inputs = 4096,
    .options = options,
    .size = sizeof(struct panorama_options),
    .run = run,
};
