// cmd_btf.c - relume btf: measured materials, the models that compress them, and how good they are
#include "commands/btf_inputs.h"
#include "commands/btf_report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct option options[] = {
    {"-o", OPTION_OUTPUT, "DIR", "fit, tile: the folder to make; render: the picture", 0, 0},
    {"--model", OPTION_TEXT, "NAME", "fit, tile: rfp, rfnl, rfnlc, vpca, lpca, ...; default rfnlc",
     0, 0},
    {"--models", OPTION_TEXT, "A,B,...", "compare: only these models; default: all", 0, 0},
    {"--clusters", OPTION_INT, "N", "lpca: default 32; cmf: 512; rfnlc: 1024", 1, 65536},
    {"--components", OPTION_INT, "N", "vpca: default 4; lpca: 8; fmf: 100; qmf: at most, 512", 1,
     1024},
    {"--ratio", OPTION_INT, "R", "qmf: compress the measured values N times; default 200", 1,
     1000000},
    {"--lobes", OPTION_INT, "N", "rfnl, rfnlc, laf, slaf: default 2", 1, 4},
    {"--levels", OPTION_INT, "N",
     "fit, tile: levels of detail, each half as wide; -1: all; default: fit 1, tile all", -1, 17},
    {"--leave-out", OPTION_INT, "K",
     "compare: also fit without every K-th view and light and measure the error on those; fit: "
     "leave them out",
     2, 64},
    {"--unseen", OPTION_FLAG, NULL, "eval: only views and lights that were left out of the fit", 0,
     0},
    {"--pictures", OPTION_INT, "N",
     "compare, eval: pictures compared by CIEDE2000 and SSIM; default 25", 0, 65536},
    {"--eye", OPTION_TEXT, "x,y,z",
     "render: the direction towards the eye; default 0,0,1; for objects: where the eye is", 0, 0},
    {"--camera", OPTION_TEXT, "x,y,z",
     "render a surface in perspective, from this point; its width is -1 to 1", 0, 0},
    {"--look-at", OPTION_TEXT, "x,y,z",
     "render: the point looked at; default: the objects' middle, with --camera 0,0,0", 0, 0},
    {"--up", OPTION_TEXT, "x,y,z", "render objects: up in the picture; default 0,1,0", 0, 0},
    {"--fov", OPTION_NUMBER, "DEG",
     "render: horizontal field of view; default: shows all objects, with --camera 40", 0.01, 179},
    {"--picture", OPTION_TEXT, "WxH",
     "render: size in pixels; default: one pixel per texel, objects 512x512, with --camera 640x400",
     0, 0},
    {"--light", OPTION_TEXT, "SPEC",
     "render: dir, env, point, spot, ... (docs/lights.md), area on objects only; may be repeated",
     0, 0},
    {"--rig", OPTION_TEXT, "FILE", "render objects: lights of a rig, before --light", 0, 0},
    {"--save-rig", OPTION_OUTPUT, "FILE", "render objects: write all lights as a rig", 0, 0},
    {"--mesh", OPTION_TEXT, "FILE", "render: an object of it: .obj, .ply, .gltf, .glb, ...", 0, 0},
    {"--repeat", OPTION_NUMBER, "N",
     "--mesh: repeat the material N times across its texture; default 1", 0.001, 10000},
    {"--samples", OPTION_INT, "N", "render objects: N x N rays a pixel; default 3", 1, 16},
    {"--no-shadows", OPTION_FLAG, NULL, "render objects: without shadows", 0, 0},
    {"--tiles", OPTION_INT, "N", "tile: how many; default 10", 1, 256},
    {"--tile", OPTION_INT, "TEXELS", "tile: a side, a multiple of 8; default half the sample", 16,
     4096},
    {"--matrix", OPTION_TEXT, "WxH", "tile: how they are laid out; default 16x16", 0, 0},
    {"--map", OPTION_TEXT, "FILE", "tile: use this index map (.npy or picture) instead of tiles", 0,
     0},
    {"--size", OPTION_INT, "N", "of a built-in material, texels; default 64", 1, 1024},
    {"--directions", OPTION_TEXT, "SET", "of a built-in material: bonn (default), dome, coarse", 0,
     0},
    {"--fill", OPTION_FLAG, NULL, "interpolate pictures that are missing in a folder", 0, 0},
    {"--crop", OPTION_TEXT, "x,y,w,h",
     "of a .btf file: read only these texels, counted from the upper left", 0, 0},
    {"--seed", OPTION_INT, "S",
     "seed of the random choices in materials, clusters and tiles; default 0", 0, 2147483647},
    {"--force", OPTION_FLAG, NULL, "fit, tile: replace a folder that relume made", 0, 0},
    {"--json", OPTION_FLAG, NULL, "one JSON object", 0, 0},
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

// ---------------------------------------------------------------- names

static relume_status find_model(const struct relume_btf_model **out, const char *name)
{
    const char *names[32];
    int n = 0;
    for (const struct relume_btf_model *const *m = relume_btf_models; *m && n < 31; m++)
        names[n++] = relume_btf_model_name(*m);
    names[n] = NULL;
    *out = relume_btf_model_find(name);
    return *out ? RELUME_OK : unknown_name("model", name, names);
}

enum { MOST_MODELS = 32 };

// Those of --models, or all; NULL-terminated.
static relume_status choose_models(const struct relume_btf_model *out[MOST_MODELS],
                                   const struct args *args)
{
    const char *list = args_text(args, "--models", NULL);
    int n = 0;
    for (int i = 0; !list && relume_btf_models[i]; i++)
        out[n++] = relume_btf_models[i];
    while (list && *list && n + 1 < MOST_MODELS) {
        char name[32];
        const size_t length = strcspn(list, ",");
        snprintf(name, sizeof name, "%.*s", (int)length, list);
        const relume_status status = find_model(&out[n++], name);
        if (status)
            return status;
        list += length + (list[length] == ',');
    }
    out[n] = NULL;
    return n ? RELUME_OK : usage_error("--models: expected names of models; found none");
}

static struct relume_btf_fit_params fit_params(const struct args *args)
{
    return (struct relume_btf_fit_params){
        .log = args_log(args),
        .clusters = args_int(args, "--clusters", 0),
        .components = args_int(args, "--components", 0),
        .lobes = args_int(args, "--lobes", 0),
        .seed = (uint64_t)args_int(args, "--seed", 0),
        .threads = args_threads(args),
        .ratio = args_int(args, "--ratio", 0),
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

static relume_status make_part(relume_btf **out, const relume_btf *whole, const struct args *args)
{
    const struct relume_btf_info *info = relume_btf_info(whole);
    const int k = args_int(args, "--leave-out", 0);
    *out = NULL;
    if (!k)
        return RELUME_OK;
    int *views = malloc((size_t)info->views * sizeof *views);
    int *lights = malloc((size_t)info->lights * sizeof *lights);
    relume_status status = RELUME_ENOMEM;
    if (views && lights) {
        const int v = thin(views, info->views, k), l = thin(lights, info->lights, k);
        status = relume_btf_part(out, whole, views, v, lights, l, args_log(args));
    }
    free(views);
    free(lights);
    return status;
}

static relume_status judge_left_out(struct relume_btf_error *out, const relume_btf *part,
                                    const relume_btf *whole, const struct relume_btf_model *model,
                                    const struct args *args)
{
    const struct relume_btf_fit_params p = fit_params(args);
    relume_btf_fitted *fitted;
    relume_status status = relume_btf_fit(&fitted, part, model, &p);
    if (!status)
        status = relume_btf_judge(out, fitted, whole,
                                  relume_btf_judge_params(.log = args_log(args), .unseen = true,
                                                          .threads = args_threads(args)));
    relume_btf_fitted_destroy(&fitted);
    return status;
}

static relume_status judge(struct btf_row *row, const relume_btf_fitted *fitted,
                           const relume_btf *btf, const struct args *args)
{
    const relume_status status = relume_btf_judge(
        &row->error, fitted, btf,
        relume_btf_judge_params(.log = args_log(args), .threads = args_threads(args),
                                .unseen = args_has(args, "--unseen"),
                                .pictures = args_int(args, "--pictures", 25)));
    if (status)
        return status;
    row->info = relume_btf_fitted_info(fitted);
    row->cost = relume_btf_fitted_cost(fitted);
    row->evaluations = btf_speed(fitted);
    return RELUME_OK;
}

// `before` is what stands before its row in JSON.
static relume_status compare_one(const relume_btf *btf, const relume_btf *part,
                                 const struct relume_btf_model *model, const char *before,
                                 const struct args *args)
{
    const struct relume_btf_fit_params p = fit_params(args);
    struct btf_row row = {.held_out = NULL};
    struct relume_btf_error held_out;
    relume_btf_fitted *fitted;
    const double start = btf_now_s();
    relume_status status = relume_btf_fit(&fitted, btf, model, &p);
    row.fit_s = btf_now_s() - start;
    if (!status)
        status = judge(&row, fitted, btf, args);
    if (!status && part) {
        status = judge_left_out(&held_out, part, btf, model, args);
        row.held_out = &held_out;
    }
    if (!status) {
        if (args_has(args, "--json"))
            fputs(before, stdout);
        (args_has(args, "--json") ? btf_print_json : btf_print)(&row);
        fflush(stdout);
    }
    relume_btf_fitted_destroy(&fitted);
    return status;
}

static relume_status compare(const struct args *args)
{
    const bool json = args_has(args, "--json");
    const struct relume_btf_model *models[MOST_MODELS];
    relume_btf *btf = NULL, *part = NULL;
    relume_status status = choose_models(models, args);
    if (!status)
        status = btf_open(&btf, args_input(args, 1), args);
    if (!status)
        status = make_part(&part, btf, args);
    if (!status && !json)
        btf_heading(part != NULL);
    for (int i = 0; !status && models[i]; i++)
        status = compare_one(btf, part, models[i], i ? ",\n" : "{\"models\":[", args);
    if (!status && json)
        puts("]}");
    relume_btf_destroy(&part);
    relume_btf_destroy(&btf);
    return status;
}

// ---------------------------------------------------------------- fit, eval

relume_status btf_fit(relume_btf_fitted **out, const relume_btf *btf, int levels,
                      const struct args *args)
{
    struct relume_btf_fit_params p = fit_params(args);
    p.levels = args_int(args, "--levels", levels);
    const struct relume_btf_model *model;
    *out = NULL;
    const relume_status status = find_model(&model, args_text(args, "--model", "rfnlc"));
    return status ? status : relume_btf_fit(out, btf, model, &p);
}

static relume_status fit(const struct args *args)
{
    relume_btf *btf = NULL, *part = NULL;
    relume_btf_fitted *fitted = NULL;
    if (!args_has(args, "-o"))
        return usage_error("btf fit: expected -o DIR");
    relume_status status = btf_open(&btf, args_input(args, 1), args);
    if (!status)
        status = make_part(&part, btf, args);
    if (!status)
        status = btf_fit(&fitted, part ? part : btf, 1, args);
    if (!status)
        status = relume_btf_fitted_save(
            fitted, args_text(args, "-o", NULL),
            relume_btf_params(.log = args_log(args), .force = args_has(args, "--force")));
    relume_btf_fitted_destroy(&fitted);
    relume_btf_destroy(&part);
    relume_btf_destroy(&btf);
    return status;
}

static relume_status eval(const struct args *args)
{
    relume_btf *btf = NULL;
    relume_btf_fitted *fitted = NULL;
    struct btf_row row = {.fit_s = (double)NAN};
    if (args_inputs(args) != 3)
        return usage_error("btf eval: expected a model and a BTF");
    relume_status status = relume_btf_fitted_open(&fitted, args_input(args, 1),
                                                  relume_btf_params(.log = args_log(args)));
    if (!status)
        status = btf_open(&btf, args_input(args, 2), args);
    if (!status)
        status = judge(&row, fitted, btf, args);
    if (!status && args_has(args, "--json")) {
        btf_print_json(&row);
        puts("");
    } else if (!status) {
        btf_heading(false);
        btf_print(&row);
    }
    relume_btf_fitted_destroy(&fitted);
    relume_btf_destroy(&btf);
    // sizes that differ are the inputs' fault here
    return status == RELUME_EINVAL ? RELUME_EDATA : status;
}

// ---------------------------------------------------------------- info

static relume_status model_info(const struct args *args)
{
    relume_btf_fitted *fitted;
    const relume_status status = relume_btf_fitted_open(&fitted, args_input(args, 1),
                                                        relume_btf_params(.log = args_log(args)));
    if (status)
        return status;
    const struct relume_btf_fitted_info i = relume_btf_fitted_info(fitted);
    const uint64_t raw = relume_btf_bytes(i.width, i.height, i.views, i.lights);
    if (args_has(args, "--json"))
        printf(
            "{\"model\": \"%s\", \"width\": %d, \"height\": %d, \"views\": %d, \"lights\": %d, "
            "\"clusters\": %d, \"components\": %d, \"lobes\": %d, \"bytes\": %llu, "
            "\"bytes_each\": %llu, \"levels\": %d, \"bytes_levels\": %llu, \"raw_bytes\": %llu}\n",
            relume_btf_model_name(i.model), i.width, i.height, i.views, i.lights, i.clusters,
            i.components, i.lobes, (unsigned long long)i.bytes, (unsigned long long)i.bytes_each,
            i.levels, (unsigned long long)i.bytes_levels, (unsigned long long)raw);
    else
        printf(
            "model    %s: %s\ntexels   %d x %d\nviews    %d\nlights   %d\nbytes    %llu, %llu of "
            "each texel; 1:%.0f of the measured values\nlevels   %d, %llu bytes\n",
            relume_btf_model_name(i.model), relume_btf_model_summary(i.model), i.width, i.height,
            i.views, i.lights, (unsigned long long)i.bytes, (unsigned long long)i.bytes_each,
            (double)raw / (double)i.bytes, i.levels, (unsigned long long)i.bytes_levels);
    relume_btf_fitted_destroy(&fitted);
    return RELUME_OK;
}

static relume_status surface_info(const struct args *args)
{
    relume_btf_surface *surface;
    const relume_status status = relume_btf_surface_open(&surface, args_input(args, 1),
                                                         relume_btf_params(.log = args_log(args)));
    if (status)
        return status;
    const struct relume_btf_surface_info i = relume_btf_surface_info(surface);
    btf_say_surface(&i, NULL, args_has(args, "--json"));
    relume_btf_surface_destroy(&surface);
    return RELUME_OK;
}

static relume_status info(const struct args *args)
{
    relume_btf *btf;
    if (btf_is_surface(args_input(args, 1)))
        return surface_info(args);
    if (btf_is_model(args_input(args, 1)))
        return model_info(args);
    const relume_status status = btf_open_outline(&btf, args_input(args, 1), args);
    if (status)
        return status;
    const struct relume_btf_info *i = relume_btf_info(btf);
    const uint64_t raw = relume_btf_bytes(i->width, i->height, i->views, i->lights);
    if (args_has(args, "--json"))
        printf("{\"width\": %d, \"height\": %d, \"views\": %d, \"lights\": %d, "
               "\"includes_cosine\": %s, \"raw_bytes\": %llu}\n",
               i->width, i->height, i->views, i->lights, i->without_cosine ? "false" : "true",
               (unsigned long long)raw);
    else
        printf("BTF      %s\ntexels   %d x %d\nviews    %d\nlights   %d\nvalues   half RGB, %s "
               "n.l, %.3f GiB\n",
               i->name, i->width, i->height, i->views, i->lights,
               i->without_cosine ? "without" : "with", (double)raw / 1073741824.0);
    relume_btf_destroy(&btf);
    return RELUME_OK;
}

// ---------------------------------------------------------------- the command

static const struct verb {
    const char *name;
    relume_status (*run)(const struct args *args);
} verbs[] = {{"fit", fit},   {"eval", eval},         {"compare", compare},
             {"info", info}, {"render", btf_render}, {"tile", btf_tile}};
enum { VERBS = sizeof verbs / sizeof *verbs };

static relume_status run(const struct args *args)
{
    const char *names[VERBS + 1] = {NULL};
    for (int i = 0; i < VERBS; i++)
        names[i] = verbs[i].name;
    for (int i = 0; i < VERBS; i++)
        if (!strcmp(verbs[i].name, args_input(args, 0))) {
            if (args_inputs(args) > 2 && verbs[i].run != eval)
                return usage_error("btf %s: expected one BTF; found '%s' as well", verbs[i].name,
                                   args_input(args, 2));
            return verbs[i].run(args);
        }
    return unknown_name("task", args_input(args, 0), names);
}

const struct command command_btf = {
    .name = "btf",
    .usage = "fit|eval|compare|info|render|tile BTF|MATERIAL|MODEL|SURFACE|OBJECTS.json [BTF]",
    .summary = "measured materials: fit models to a BTF, compare and render them",
    .example = "relume btf compare corduroy --size 32 --models rfnl,lpca --json",
    .min_inputs = 2,
    .max_inputs = 3,
    .options = options,
    .run = run,
};
