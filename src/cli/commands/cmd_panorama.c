// cmd_panorama.c - relume panorama: photographs all around one point become a capture
#include "cli/commands/capture_views.h"

#include <stdlib.h>

struct panorama_options {
    struct args args;
    const char *depth;
    enum relume_panorama_source layout;
    struct views_options views;
    int width, bands;
};
#define OPTIONS struct panorama_options
#define LAYOUTS "sphere", "cylinder", "cube", "stitch"

static const struct option options[] = {
    VIEWS_OPTIONS,
    GROUP("input"),
    NAME("--layout", layout, "P",
         "cube (six faces), sphere, cylinder or stitch (overlapping photographs); default: sphere "
         "for one photograph, else stitch",
         RELUME_PANORAMA_SPHERE, LAYOUTS),
    NAME("--panorama", layout, "P", NULL, RELUME_PANORAMA_SPHERE, LAYOUTS),  // of relume capture
    GROUP("picture"),
    INT("--width", width, "N", "stitch: width of the finished panorama, pixels", 1, 65536),
    INT("--bands", bands, "N",
        "stitch: number of blending bands, 1 (hard seams) to 10; default: by the size of the "
        "photographs",
        1, 10),
    GROUP("depth"),
    TEXT("--depth", depth, "FILE",
         "depth of the panorama: an EXR of distances, or a grey picture with --depth-range"),
    NUMBERS("--depth-range", views.depth_range, "A,B",
            "--depth: the distances of white and of black", 2),
    {0},
};

static relume_status run_panorama(const struct args *args)
{
    const struct panorama_options *o = (const void *)args;
    const struct relume_panorama_params panorama = {
        .depth = o->depth,
        .depth_range = {o->views.depth_range[0], o->views.depth_range[1]},
        .width = o->width,
        .bands = o->bands,
    };
    const enum relume_panorama_source source = given(o, &o->layout) ? o->layout
                                               : args->inputs > 1   ? RELUME_PANORAMA_STITCH
                                                                    : RELUME_PANORAMA_SPHERE;
    struct relume_vec3 *lights;
    struct relume_ingest_params p;
    relume_status status = ingest_params(&p, &lights, args, &o->views);
    if (!status)
        status = relume_panorama_ingest(o->views.output, args->input, args->inputs, source,
                                        &panorama, &p);
    relume_free(lights);
    if (!status)
        say_next(args, o->views.output, "a panorama");
    return status;
}

const struct command command_panorama = {
    COMMAND(run_panorama, "panorama", "PHOTO... -o DIR [OPTION ...]",
            "stitch photographs to a panorama, or turn a finished one into a capture",
            "relume panorama shot*.jpg -o forest", 1, 4096),
};
