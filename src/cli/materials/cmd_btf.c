// cmd_btf.c - relume btf: measured materials, the models that compress them, and how good they are
#include "cli/materials/btf_inputs.h"
#include "cli/materials/btf_report.h"
#include "cli/program/clock.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define OPTIONS struct btf_options

// The place of a model in relume_btf_models.
static relume_status take_model(void *place, const struct option *o, const char *text,
                                const struct relume_log *log)
{
    const char *names[32];
    int n = 0;
    for (; n < 31 && relume_btf_models[n]; n++) {
        names[n] = relume_btf_model_name(relume_btf_models[n]);
        if (!strcmp(names[n], text)) {
            *(int *)place = n;
            return RELUME_OK;
        }
    }
    names[n] = NULL;
    return unknown_word(log, o->name, text, names);
}

static relume_status take_set(void *set, const struct option *o, const char *text,
                              const struct relume_log *log)
{
    const struct relume_btf_set *found = relume_btf_set_find(text);
    *(const struct relume_btf_set **)set = found;
    return found
               ? RELUME_OK
               : unknown_word(log, o->name, text, (const char *[]){"bonn", "dome", "coarse", NULL});
}

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(
        OPTION_OUTPUT, output, "OUT",
        "fit, plant, tile, expand: the folder to make, or for a g-BRDF an .exr file; render: the "
        "picture"),
    FLAG("--force", force, "fit, tile: replace a folder that relume made"),
    FLAG("--icc", icc, "render: put an sRGB colour profile into the picture (.jpg, .tif)"),
    GROUP("model"),
    OWN("--model", model, "NAME", "fit, tile: rfp, rfnl, rfnlc, vpca, lpca, ...; default: rfnlc",
        take_model),
    INT("--clusters", clusters, "N",
        "clusters of texels; default: lpca 32, cmf 512, rfnlc 1024; gbrdf: as many as are "
        "distinct, "
        "up to 8",
        1, 65536),
    INT("--components", components, "N",
        "components; default: vpca 4, lpca 8, fmf 100, qmf at most 512", 1, 1024),
    INT("--ratio", ratio, "R", "qmf: compress the measured values R times; default: 200", 1,
        1000000),
    FLAG("--resample", resample,
         "gbrdf: where no light stands where a view is, interpolate such lights"),
    INT("--lobes", lobes, "N", "lobes of rfnl, rfnlc, laf and slaf; default: 2", 1, 4),
    INT("--leave-out", leave_out, "K",
        "compare: also fit without every K-th view and light, and measure the error on these; fit: "
        "leave them out",
        2, 64),
    GROUP("measurements"),
    WORDS("--models", models, "A,B,...", "compare: only these models; default: all", OPTION_OWN,
          .take = take_model),
    FLAG("--unseen", unseen,
         "eval: measure only on views and lights that were left out of the fit"),
    INT("--pictures", pictures, "N",
        "compare, eval: number of pictures compared by CIEDE2000 and SSIM; default: 25", 0, 65536),
    GROUP("levels of detail"),
    INT("--levels", levels, "N",
        "fit, tile: levels of detail, each half as wide; -1: all; default: fit 1, tile all", -1,
        17),
    GROUP("camera"),
    POINT("--eye", eye, "x,y,z",
          "render: the direction towards the eye; default: 0,0,1; objects: the place of the eye"),
    POINT("--camera", camera, "x,y,z",
          "render a surface in perspective, from this point; its width is -1 to 1"),
    POINT("--look-at", look_at, "x,y,z",
          "render: the point looked at; default: the objects' middle, with --camera 0,0,0"),
    POINT("--up", up, "x,y,z",
          "render objects: the direction that is up in the picture; default: 0,1,0"),
    NUMBER("--fov", fov, "DEG",
           "render: horizontal field of view; default: shows all objects, with --camera 40", 0.01,
           179),
    GROUP("picture"),
    SIZE("--picture", picture, "WxH",
         "render: size in pixels; default: one pixel per texel, objects 512x512, with --camera "
         "640x400",
         1, 65536),
    GROUP("lights"),
    TEXTS("--light", lighting.light, "SPEC",
          "render: dir, env, point, spot, ... (docs/lights.md), area on objects only; may be "
          "repeated"),
    TEXT("--rig", lighting.rig, "FILE", "render objects: lights of a rig, before --light"),
    TEXT_AS(OPTION_RIG, "--save-rig", lighting.save_rig, "FILE",
            "render objects: write all lights as a rig"),
    GROUP("objects"),
    TEXT("--mesh", mesh, "FILE",
         "render: cover this mesh with the material: .obj, .ply, .gltf, .glb, ..."),
    TEXT("--reflections", reflections, "FILE",
         "render, of a description of objects: what their mirrors shall reflect where "
         "(docs/reflections.md)"),
    NUMBERS("--reflection-at", reflection_at, "x,y",
            "render, of a description of objects: print what is reflected at this pixel, as a "
            "constraint for --reflections",
            2),
    NUMBER("--repeat", repeat, "N",
           "--mesh: repeat the material N times across its texture; default: 1", 0.001, 10000),
    INT("--samples", samples, "N", "render objects: N x N rays a pixel; default: 3", 1, 16),
    FLAG("--no-shadows", no_shadows, "render objects: leave out shadows"),
    GROUP("tiles"),
    INT("--tiles", tiles, "N", "tile: number of tiles; default: 10", 1, 256),
    INT("--tile", tile, "TEXELS",
        "tile: side of a tile, a multiple of 8; default: half of the sample", 16, 4096),
    SIZE("--matrix", matrix, "WxH",
         "tile: columns and rows of tiles in the surface; default: 16x16", 1, 4096),
    TEXT("--map", map, "FILE", "tile: use this index map (.npy or picture) instead of tiles"),
    GROUP("material"),
    INT("--size", size, "N", "built-in material: width and height in texels; default: 64", 1, 1024),
    OWN("--directions", directions, "SET",
        "built-in material: directions of views and lights: bonn (default), dome, coarse",
        take_set),
    FLAG("--fill", fill, "interpolate pictures that are missing in a folder"),
    NUMBERS("--crop", crop, "x,y,w,h",
            ".btf file: read only these texels, counted from the upper left", 4),
    INT("--seed", seed, "S",
        "seed of the random choices in materials, clusters and tiles; default: 0", 0, 2147483647),
    GROUP("report"),
    FLAG("--json", json, "one JSON object"),
    {0},
};

static struct relume_btf_fit_params fit_params(const struct btf_options *o)
{
    return (struct relume_btf_fit_params){
        .log = o->args.log,
        .clusters = o->clusters,
        .components = o->components,
        .lobes = o->lobes,
        .seed = (uint64_t)o->seed,
        .threads = o->args.threads,
        .ratio = o->ratio,
        .resample = o->resample,
    };
}

// ---------------------------------------------------------------- compare

// Every K-th is dropped, but never the first: the pole keeps the hemisphere covered.
static int thin(int *kept, int n, int k)
{
    int count = 0;
    for (int i = 0; i < n; i++)
        if (i % k != k - 1)
            kept[count++] = i;
    return count;
}

static relume_status make_part(relume_btf **out, const relume_btf *whole,
                               const struct btf_options *o)
{
    const struct relume_btf_info *info = relume_btf_info(whole);
    *out = NULL;
    if (!o->leave_out)
        return RELUME_OK;
    int *views = malloc((size_t)info->views * sizeof *views);
    int *lights = malloc((size_t)info->lights * sizeof *lights);
    relume_status status = RELUME_ENOMEM;
    if (views && lights) {
        const int v = thin(views, info->views, o->leave_out),
                  l = thin(lights, info->lights, o->leave_out);
        status = relume_btf_part(out, whole, views, v, lights, l, o->args.log);
    }
    free(views);
    free(lights);
    return status;
}

static relume_status judge(struct btf_row *row, const relume_btf_fitted *fitted,
                           const relume_btf *btf, const struct btf_options *o)
{
    row->info = *relume_btf_fitted_info(fitted);
    row->cost = relume_btf_fitted_cost(fitted);
    row->evaluations = btf_speed(fitted);
    return relume_btf_judge(&row->error, fitted, btf,
                            relume_btf_judge_params(.log = o->args.log, .threads = o->args.threads,
                                                    .unseen = o->unseen, .pictures = o->pictures));
}

// The first model opens the list.
static void put_compared(struct jwriter *w, const struct btf_row *row)
{
    const bool first = w->style & JSON_DENSE;
    if (first) {
        jopen_object(w, NULL);
        jopen_array(w, "models");
        w->style &= ~(unsigned)JSON_DENSE;
    } else {
        jgap(w, "\n");
    }
    btf_put_row(w, row);
}

static relume_status compare_one(const relume_btf *btf, const relume_btf *part,
                                 const struct relume_btf_model *model, struct jwriter *w,
                                 const struct btf_options *o)
{
    const struct relume_btf_fit_params p = fit_params(o);
    struct btf_row row = {.held_out = NULL};
    struct relume_btf_error held_out;
    relume_btf_fitted *fitted, *of_part = NULL;
    const double start = now_s();
    relume_status status = relume_btf_fit(&fitted, btf, model, &p);
    row.fit_s = now_s() - start;
    if (!status)
        status = judge(&row, fitted, btf, o);
    if (!status && part) {
        row.held_out = &held_out;
        status = relume_btf_fit(&of_part, part, model, &p);
        if (!status)
            status = relume_btf_judge(&held_out, of_part, btf,
                                      relume_btf_judge_params(.log = o->args.log, .unseen = true,
                                                              .threads = o->args.threads));
        relume_btf_fitted_destroy(&of_part);
    }
    if (!status) {
        if (o->json)
            put_compared(w, &row);
        else
            btf_print(&row);
        fflush(stdout);
    }
    relume_btf_fitted_destroy(&fitted);
    return status;
}

static relume_status compare(const struct args *args)
{
    const struct btf_options *o = (const void *)args;
    relume_btf *btf = NULL, *part = NULL;
    relume_status status = btf_open(&btf, o->args.input[0], o);
    if (!status)
        status = make_part(&part, btf, o);
    if (!status && !o->json)
        btf_heading(part != NULL);
    const struct ints *named = &o->models;  // none: all that can be fitted
    struct jwriter w = json_dense();
    for (int i = 0; !status && (named->count ? i < named->count : relume_btf_models[i] != NULL);
         i++) {
        const struct relume_btf_model *model = relume_btf_models[named->count ? named->item[i] : i];
        if (!named->count && !o->resample && !relume_btf_model_fits(model, btf))
            announce(&o->args, RELUME_NOTE,
                     "%s is left out: no light stands where a view is; --resample interpolates "
                     "such lights",
                     relume_btf_model_name(model));
        else
            status = compare_one(btf, part, model, &w, o);
    }
    if (!status && o->json)
        status = jend(&w);
    relume_btf_destroy(&part);
    relume_btf_destroy(&btf);
    return status;
}

// ---------------------------------------------------------------- fit, eval

relume_status btf_fit(relume_btf_fitted **out, const relume_btf *btf, int levels,
                      const struct btf_options *o)
{
    struct relume_btf_fit_params p = fit_params(o);
    p.levels = (given(o, &o->levels) ? o->levels : levels);
    *out = NULL;
    return relume_btf_fit(
        out, btf, o->model < 0 ? relume_btf_model_find("rfnlc") : relume_btf_models[o->model], &p);
}

// Before the fit, which may take long.
static relume_status check_fit(const struct btf_options *o)
{
    const bool held = o->model >= 0 && (o->levels == 0 || o->levels == 1) &&
                      relume_btf_models[o->model] == relume_btf_model_find("gbrdf");
    return btf_is_model_file(o->output) && !held
               ? usage_error("%s: an .exr file holds a g-BRDF of one level of detail; expected "
                             "--model gbrdf without --levels, or a folder",
                             o->output)
               : btf_check_model_output(o);
}

static relume_status fit(const struct args *args)
{
    const struct btf_options *o = (const void *)args;
    relume_btf *btf = NULL, *part = NULL;
    relume_btf_fitted *fitted = NULL;
    relume_status status = check_fit(o);
    if (!status)
        status = btf_open(&btf, o->args.input[0], o);
    if (!status)
        status = make_part(&part, btf, o);
    if (!status)
        status = btf_fit(&fitted, part ? part : btf, 1, o);
    if (!status)
        status = relume_btf_fitted_save(fitted, o->output,
                                        relume_btf_params(.log = o->args.log, .force = o->force));
    relume_btf_fitted_destroy(&fitted);
    relume_btf_destroy(&part);
    relume_btf_destroy(&btf);
    return status;
}

static relume_status eval(const struct args *args)
{
    const struct btf_options *o = (const void *)args;
    relume_btf *btf = NULL;
    relume_btf_fitted *fitted = NULL;
    struct btf_row row = {.fit_s = (double)NAN};
    relume_status status =
        relume_btf_fitted_open(&fitted, o->args.input[0], relume_btf_params(.log = o->args.log));
    if (!status)
        status = btf_open(&btf, o->args.input[1], o);
    if (!status)
        status = judge(&row, fitted, btf, o);
    if (!status && o->json) {
        struct jwriter w = json_to(stdout);
        btf_put_row(&w, &row);
        status = jend(&w);
    } else if (!status) {
        btf_heading(false);
        btf_print(&row);
    }
    relume_btf_fitted_destroy(&fitted);
    relume_btf_destroy(&btf);
    // sizes that differ are the inputs' fault here
    return status == RELUME_EINVAL ? RELUME_EUNFIT : status;
}

// ---------------------------------------------------------------- info

static void print_fitted_json(const struct relume_btf_fitted_info *i, uint64_t raw)
{
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_text(&w, "model", relume_btf_model_name(i->model));
    jput_integer(&w, "width", i->width);
    jput_integer(&w, "height", i->height);
    jput_integer(&w, "views", i->views);
    jput_integer(&w, "lights", i->lights);
    jput_integer(&w, "clusters", i->clusters);
    jput_integer(&w, "components", i->components);
    jput_integer(&w, "lobes", i->lobes);
    jput_integer(&w, "bytes", (long long)i->bytes);
    jput_integer(&w, "bytes_each", (long long)i->bytes_each);
    jput_integer(&w, "levels", i->levels);
    jput_integer(&w, "bytes_levels", (long long)i->bytes_levels);
    jput_integer(&w, "raw_bytes", (long long)raw);
    jput_integer(&w, "edits", i->edits);
    jput_integer(&w, "edits_undone", i->edits_undone);
    jend(&w);
}

static void print_sample_json(const struct relume_btf_info *i, uint64_t raw)
{
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_integer(&w, "width", i->width);
    jput_integer(&w, "height", i->height);
    jput_integer(&w, "views", i->views);
    jput_integer(&w, "lights", i->lights);
    jput_truth(&w, "includes_cosine", !i->without_cosine);
    jput_integer(&w, "raw_bytes", (long long)raw);
    jend(&w);
}

static relume_status model_info(const struct btf_options *o)
{
    relume_btf_fitted *fitted;
    const relume_status status =
        relume_btf_fitted_open(&fitted, o->args.input[0], relume_btf_params(.log = o->args.log));
    if (status)
        return status;
    const struct relume_btf_fitted_info *i = relume_btf_fitted_info(fitted);
    const uint64_t raw = relume_btf_bytes(i->width, i->height, i->views, i->lights);
    if (o->json)
        print_fitted_json(i, raw);
    else
        printf(
            "model    %s: %s\ntexels   %d x %d\nviews    %d\nlights   %d\nbytes    %llu, %llu of "
            "each texel; 1:%.0f of the measured values\nlevels   %d, %llu bytes\n",
            relume_btf_model_name(i->model), relume_btf_model_summary(i->model), i->width,
            i->height, i->views, i->lights, (unsigned long long)i->bytes,
            (unsigned long long)i->bytes_each, (double)raw / (double)i->bytes, i->levels,
            (unsigned long long)i->bytes_levels);
    if (!o->json && i->edits + i->edits_undone)
        printf("edits    %d, %d undone\n", i->edits, i->edits_undone);
    relume_btf_fitted_destroy(&fitted);
    return RELUME_OK;
}

static relume_status surface_info(const struct btf_options *o)
{
    relume_btf_surface *surface;
    const relume_status status =
        relume_btf_surface_open(&surface, o->args.input[0], relume_btf_params(.log = o->args.log));
    if (status)
        return status;
    btf_say_surface(relume_btf_surface_info(surface), NULL, o->json);
    relume_btf_surface_destroy(&surface);
    return RELUME_OK;
}

static relume_status info(const struct args *args)
{
    const struct btf_options *o = (const void *)args;
    relume_btf *btf;
    if (btf_is_surface(o->args.input[0]))
        return surface_info(o);
    if (btf_is_model(o->args.input[0]))
        return model_info(o);
    const relume_status status = btf_open_outline(&btf, o->args.input[0], o);
    if (status)
        return status;
    const struct relume_btf_info *i = relume_btf_info(btf);
    const uint64_t raw = relume_btf_bytes(i->width, i->height, i->views, i->lights);
    if (o->json)
        print_sample_json(i, raw);
    else
        printf("BTF      %s\ntexels   %d x %d\nviews    %d\nlights   %d\nvalues   half RGB, %s "
               "n.l, %.3f GiB\n",
               i->name, i->width, i->height, i->views, i->lights,
               i->without_cosine ? "without" : "with", (double)raw / 1073741824.0);
    relume_btf_destroy(&btf);
    return RELUME_OK;
}

// ---------------------------------------------------------------- the command

static const struct btf_options defaults = {.model = -1,
                                            .pictures = 25,
                                            .samples = 3,
                                            .repeat = 1.0,
                                            .tiles = 10,
                                            .size = 64,
                                            .matrix = {16, 16}};

// Help shows the options of the groups in `what`; those of others are refused.
#define TASK(task, function, asks, does, shows, count, what)                                       \
    static const struct command task_##task = {                                                    \
        .name = "btf " #task,                                                                      \
        .usage = asks,                                                                             \
        .summary = does,                                                                           \
        .example = shows,                                                                          \
        .min_inputs = count,                                                                       \
        .max_inputs = count,                                                                       \
        .options = options,                                                                        \
        .groups = what,                                                                            \
        .size = sizeof(OPTIONS),                                                                   \
        .defaults = &defaults,                                                                     \
        .run = function,                                                                           \
    }
TASK(fit, fit, "BTF|MATERIAL -o DIR [OPTION ...]", "fit a model to a measured or built-in material",
     "relume btf fit corduroy --model rfnlc -o corduroy_model", 1,
     "output; model; levels of detail; material;");
TASK(eval, eval, "MODEL BTF|MATERIAL [OPTION ...]",
     "measure how well a model reproduces a material",
     "relume btf eval corduroy_model corduroy --json", 2, "measurements; material; report;");
TASK(compare, compare, "BTF|MATERIAL [OPTION ...]",
     "fit every model to a material and compare their errors and sizes",
     "relume btf compare corduroy --size 32 --models rfnl,lpca --json", 1,
     "measurements; model; material; report;");
TASK(info, info, "BTF|MODEL|SURFACE [OPTION ...]", "show what a BTF, a model or a surface holds",
     "relume btf info corduroy_model", 1, "material; report;");
TASK(render, btf_render, "BTF|MODEL|SURFACE|OBJECTS.json -o OUT [OPTION ...]",
     "render a material, a surface or objects under any light",
     "relume btf render corduroy_model -o corduroy.png --light \"dir 1 0 1\"", 1,
     "output; camera; picture; lights; objects; material;");
TASK(tile, btf_tile, "BTF|MODEL|MATERIAL -o DIR [OPTION ...]", "make a large surface from a sample",
     "relume btf tile corduroy_model -o corduroy_surface", 1,
     "output; model; levels of detail; tiles; material; report;");

TASK(plant, btf_plant, "-o OUT [OPTION ...]",
     "make a synthetic g-BRDF of which everything is known, to test fits",
     "relume btf plant -o planted.exr --size 32", 0, "output; material;");
TASK(expand, btf_expand, "MODEL -o DIR", "write what a model shows in its directions as a BTF",
     "relume btf expand planted.exr -o planted_btf", 1, "output;");

static const struct command *const tasks[] = {
    &task_fit,       &task_eval,  &task_compare, &task_info,     &task_render,   &task_tile,
    &btf_task_synth, &task_plant, &task_expand,  &btf_task_edit, &btf_task_make, NULL};

const struct command command_btf = {
    .name = "btf",
    .usage = "fit|eval|compare|info|render|tile|synth|plant|expand|edit|make ...",
    .summary = "measured materials: fit models to a BTF, compare and render them",
    .example = "relume btf compare corduroy --size 32 --models rfnl,lpca --json",
    .min_inputs = 1,
    .tasks = tasks,
};
