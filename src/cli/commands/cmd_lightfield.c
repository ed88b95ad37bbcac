// cmd_lightfield.c - relume lightfield: grids and sets of cameras become a light slab, with depth
#include "cli/commands/capture_views.h"

#include <math.h>
#include <stdlib.h>

struct lightfield_options {
    struct args args;
    struct views_options views;
    const char *names, *colmap;
    bool slab, json, fill, turn, keep_order, depth_from_views;
    double baseline, baseline_v, distance, st_z, window, focus_disparity;
    int width, grid[2];
};
#define OPTIONS struct lightfield_options

static const struct option options[] = {
    VIEWS_OPTIONS,
    GROUP("output"),
    FLAG("--json", json, "--depth-from-views: print one JSON object"),
    GROUP("grid of cameras"),
    TEXT("--names", names, "PATTERN",
         "where the file names hold the place of the camera: {row}, {column}, {n}, {u}, {v}, *; "
         "default: found"),
    FLAG("--fill", fill, "fill a missing camera with the photograph of the nearest"),
    FLAG("--turn", turn, "the grid is turned: columns run to the left and rows upwards"),
    FLAG("--keep-order", keep_order,
         "keep the order of the names even if the photographs suggest another"),
    NUMBER("--baseline", baseline, "W",
           "world units from the first to the last column of cameras; default: 1", 1e-6, 1e6),
    NUMBER("--baseline-v", baseline_v, "H",
           "world units from the first to the last row; default: from positions in the names, else "
           "measured in the photographs",
           1e-6, 1e6),
    NUMBER("--distance", distance, "D",
           "world units from the cameras to the st plane; default: 3; --colmap: units of the model",
           1e-6, 1e6),
    NUMBER("--st-z", st_z, "Z", "height of the st plane; default: 0", -1e6, 1e6),
    NUMBER("--window", window, "W", "width of the st window; default: 2", 1e-6, 1e6),
    NUMBER("--focus-disparity", focus_disparity, "PX",
           "pixels by which a point on the st (focus) plane moves from one camera to the next; "
           "default: 0",
           -4096, 4096),
    GROUP("cameras with known poses"),
    TEXT("--colmap", colmap, "DIR",
         "folder with COLMAP's poses of the photographs (cameras.txt, images.txt): resample them "
         "to a slab"),
    SIZE("--views", grid, "GxG", "--colmap: grid of cameras to make; default: 5x5", 1, 9999),
    INT("--width", width, "N", "--colmap: width of a view, pixels", 1, 65536),
    GROUP("depth"),
    FLAG("--depth-from-views", depth_from_views,
         "estimate depth for the views of a light field; give its capture as the input"),
    NUMBERS("--depth-range", views.depth_range, "A,B",
            "--depth-from-views: nearest and farthest distance from the camera plane", 2),
    GROUP("input"),
    FLAG("--slab", slab, NULL),  // of relume capture
    {0},
};

static relume_status slab(const struct lightfield_options *o, const struct relume_ingest_params *p)
{
    return relume_slab_ingest(
        o->views.output, o->args.input, o->args.inputs,
        relume_slab_ingest_params(.names = o->names, .baseline = o->baseline,
                                  .baseline_v = o->baseline_v, .distance = o->distance,
                                  .st_z = o->st_z, .window = o->window,
                                  .focus_disparity = o->focus_disparity, .fill = o->fill,
                                  .turn = o->turn, .keep_order = o->keep_order),
        p);
}

static relume_status posed(const struct lightfield_options *o, const char *photos,
                           const struct relume_ingest_params *p)
{
    const struct relume_posed_params posed = {
        .width = o->width,
        .distance = o->distance,
        .grid = {o->grid[0], o->grid[1]},
    };
    if (o->args.inputs != 1)
        return usage_error("--colmap: expected the folder of the photographs; found %d input%s",
                           o->args.inputs, relume_plural(o->args.inputs));
    return relume_posed_ingest(o->views.output, o->colmap, photos, &posed, p);
}

static void print_depth(const struct relume_slab_depth_report *r, bool json)
{
    const bool known = r->compared > 0;
    if (!json) {
        printf("views     %d, searched at %d x %d under %d light%s\n", r->views, r->width,
               r->height, r->lights, relume_plural(r->lights));
        printf("planes    %d, distances %.4g to %.4g\n", r->planes, r->range[0], r->range[1]);
        printf("trusted   %.1f %% of pixels agree with the neighbouring views\n",
               100.0 * r->trusted);
        if (known)
            printf(
                "error     %.2f %% of the known depth (median), %.1f %% off by more than a plane\n",
                100.0 * r->median_relative, 100.0 * r->bad);
        return;
    }
    struct jwriter w = json_dense();
    jopen_object(&w, NULL);
    jput_integer(&w, "views", r->views);
    jput_integer(&w, "lights", r->lights);
    jput_integer(&w, "width", r->width);
    jput_integer(&w, "height", r->height);
    jput_integer(&w, "planes", r->planes);
    jput_numbers(&w, "range", r->range, 2, 9);
    jput_number(&w, "plane_step", r->plane_step, 9);
    jput_number(&w, "trusted", r->trusted, 9);
    jput_integer(&w, "compared", (long long)r->compared);
    jput_number(&w, "median_relative", known ? r->median_relative : (double)NAN, 9);
    jput_number(&w, "bad", known ? r->bad : (double)NAN, 9);
    jend(&w);
}

static relume_status depth_of(const struct lightfield_options *o)
{
    relume_capture *c;
    struct relume_slab_depth_report report;
    struct relume_slab_depth_params p = {
        .log = o->args.log,
        .force = o->views.force,
        .range = {o->views.depth_range[0], o->views.depth_range[1]},
        .threads = o->args.threads,
    };
    if (o->args.inputs != 1)
        return usage_error("--depth-from-views: expected one capture; found %d", o->args.inputs);
    relume_status status =
        relume_capture_open(&c, o->args.input[0], relume_capture_params(.log = p.log));
    if (!status)
        status = relume_slab_depth(&report, c, o->views.output, &p);
    if (!status && (o->json || !o->args.quiet))
        print_depth(&report, o->json);
    if (!status)
        say_next(&o->args, o->views.output, "a light slab with depth");
    relume_capture_destroy(&c);
    return status;
}

static relume_status run_lightfield(const struct args *args)
{
    const struct lightfield_options *o = (const void *)args;
    struct relume_vec3 *lights = NULL;
    struct relume_ingest_params p;
    if ((o->colmap != NULL) + o->depth_from_views + o->slab > 1)
        return usage_error("lightfield: expected one of --colmap and --depth-from-views; compute "
                           "depth in a second run");
    if (o->depth_from_views)
        return depth_of(o);
    if (o->json)
        return usage_error("lightfield: --json says how good depth is; leave it out, or see "
                           "--depth-from-views");
    relume_status status = ingest_params(&p, &lights, args, &o->views);
    if (!status)
        status = o->colmap ? posed(o, o->args.input[0], &p) : slab(o, &p);
    relume_free(lights);
    if (!status)
        say_next(args, o->views.output, "a light slab");
    return status;
}

const struct command command_lightfield = {
    COMMAND(run_lightfield, "lightfield", "PHOTO...|FOLDER|CAPTURE -o DIR [OPTION ...]",
            "turn photographs of many cameras into a light field, and estimate its depth",
            "relume lightfield chess/view_*.jpg -o chess_slab", 1, 4096),
};
