// cmd_maps.c - relume maps: colour, gloss and relief as maps for other programs
#include "cli/materials/maps_edit.h"

#include <math.h>

struct maps_options {
    struct args args;
    const char *output;
    struct relume_transfer transfer;
    int view, held_out, materials, mesh;
    double gain, width;
    bool force, json, directx, photometric, skip_missing, allow_outside, keep_going;
};
#define OPTIONS struct maps_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "DIR", "the folder of maps to make"),
    FLAG("--force", force, "replace a folder that relume made"),
    FLAG("--json", json, "print one JSON object"),
    FLAG("--directx", directx,
         "normal.png with green pointing down, as DirectX programs want it; default: up (OpenGL)"),
    INT("--mesh", mesh, "N",
        "model.gltf: a mesh of N columns displaced by the height; default: a plane", 1, 1024),
    NUMBER("--width", width, "MM", "width of the picture in millimetres: sets the scale", 1e-6,
           1e9),
    GROUP("model"),
    INT("--held-out", held_out, "K",
        "lights that are only used to measure the error; default: every 8th, at least 2", 0, 65535),
    INT("--materials", materials, "N", "most kinds of gloss; default: 8", 1,
        RELUME_MAPS_MOST_MATERIALS),
    NUMBER("--gain", gain, "G",
           "multiply the photographs by this; default: 1, or what makes them as bright as the "
           "surface should be",
           1e-6, 1e6),
    FLAG("--photometric", photometric,
         "normals as photometric stereo finds them; default: improved by the highlights"),
    GROUP("input"),
    TRANSFER("--transfer", transfer, "linear, srgb or gamma:G; overrides the capture's"),
    INT("--view", view, "N", "which view of a slab; default: 0", 0, 65535),
    FLAG("--skip-missing", skip_missing, "leave out lights whose image does not exist"),
    ALLOW_OUTSIDE_OPTION,
    KEEP_GOING_OPTION,
    {0},
};

// ---------------------------------------------------------------- what is said

static double percent(double share)
{
    return 100.0 * share;
}

static void say_quality(const struct maps_options *o, const struct relume_maps *m)
{
    const bool unseen = m->held_out.lights > 0;
    const struct relume_maps_quality *q = unseen ? &m->held_out : &m->fitted;
    const char *out = o->output;
    char ssim[32] = "";  // none of pictures smaller than its window
    if (isfinite(q->ssim))
        snprintf(ssim, sizeof ssim, ", SSIM %.3f", q->ssim);
    announce(&o->args, RELUME_NOTE,
             "%s: under %d light%s that %s used for the fit: %.2f dB PSNR (differences %s), deltaE "
             "%.2f%s",
             out, q->lights, relume_plural(q->lights),
             unseen ? q->lights == 1 ? "was not" : "were not" : "were", q->psnr_db,
             judgement(q->psnr_db), q->delta_e, ssim);
    announce(&o->args, RELUME_NOTE,
             "%s: %.1f %% of the pixels cannot be described by such maps (more than %.0f %% off): "
             "%.1f %% of all values are darker in the photographs (cast shadows), %.1f %% brighter "
             "(light between surfaces, fabric, hair, glass)",
             out, percent(q->off), percent(RELUME_MAPS_OFF), percent(q->shadowed),
             percent(q->brighter));
}

static void say_materials(const struct maps_options *o, const struct relume_maps *m)
{
    for (int i = 0; i < m->materials; i++) {
        const struct relume_maps_material *k = &m->material[i];
        char gloss[80], share[32] = "under 1 %";
        if (k->metal)
            snprintf(gloss, sizeof gloss, "metal, roughness %.2f", k->roughness);
        else if (k->f0 > 0.0)
            snprintf(gloss, sizeof gloss, "reflectance %.3f, roughness %.2f", k->f0, k->roughness);
        else
            snprintf(gloss, sizeof gloss, "matte");
        if (k->share >= 0.01)
            snprintf(share, sizeof share, "%.0f %%", percent(k->share));
        announce(&o->args, RELUME_NOTE, "%s: material %d of %d: %s, %s of the pixels", o->output,
                 i + 1, m->materials, gloss, share);
    }
}

static void say_result(const struct maps_options *o, const struct relume_maps *m)
{
    const char *out = o->output;
    if (m->matte_only)
        announce(&o->args, RELUME_WARNING,
                 "%s: %d lights are too few for gloss; expected %d or more. Normals, base colour, "
                 "height and occlusion are measured; roughness is 1 everywhere, with no highlight",
                 out, m->lights, RELUME_MAPS_LEAST_LIGHTS);
    else
        say_materials(o, m);
    if (m->gain != 1.0 && !given(o, &o->gain))
        announce(&o->args, RELUME_NOTE,
                 "%s: the photographs were multiplied by %.3g, since the brightness of the lights "
                 "is not known; --gain 1 leaves them as they are",
                 out, m->gain);
    if (!(o->width > 0.0))
        announce(&o->args, RELUME_NOTE,
                 "%s: the scale is not known: the model is %.3g m wide, one metre for each unit of "
                 "the capture; --width MM sets it",
                 out, m->pixel * m->width);
    say_quality(o, m);
}

static void put_quality(struct jwriter *w, const char *name, const struct relume_maps_quality *q)
{
    jopen_object(w, name);
    jput_integer(w, "lights", q->lights);
    jput_number(w, "psnr_db", q->psnr_db, 9);
    jput_number(w, "ssim", q->ssim, 9);
    jput_number(w, "delta_e", q->delta_e, 9);
    jput_number(w, "off", q->off, 9);
    jput_number(w, "shadowed", q->shadowed, 9);
    jput_number(w, "brighter", q->brighter, 9);
    jclose(w);
}

static void print_json(const struct maps_options *o, const struct relume_maps *m)
{
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_integer(&w, "width", m->width);
    jput_integer(&w, "height", m->height);
    jput_integer(&w, "fitted_lights", m->lights);
    jput_truth(&w, "gloss", !m->matte_only);
    jput_number(&w, "gain", m->gain, 9);
    jput_number(&w, "width_mm", o->width > 0.0 ? o->width : (double)NAN, 9);
    jopen_array(&w, "materials");
    for (int i = 0; i < m->materials; i++) {
        const struct relume_maps_material *k = &m->material[i];
        jopen_object(&w, NULL);
        jput_truth(&w, "metal", k->metal);
        jput_number(&w, "f0", k->metal ? (double)NAN : k->f0, 9);
        jput_number(&w, "roughness", k->roughness, 9);
        jput_number(&w, "share", k->share, 9);
        jclose(&w);
    }
    jclose(&w);
    put_quality(&w, "held_out", &m->held_out);
    put_quality(&w, "fitted", &m->fitted);
    jend(&w);
}

// ---------------------------------------------------------------- the work

static relume_status fit_capture(struct relume_maps *maps, const struct maps_options *o,
                                 const struct relume_maps_params *p)
{
    relume_capture *capture;
    relume_status status = relume_capture_open_photographs(
        &capture, o->args.input[0],
        relume_capture_params(.log = o->args.log, .transfer = o->transfer,
                              .skip_missing = o->skip_missing, .allow_outside = o->allow_outside,
                              .keep_bytes = KEEP_BYTES),
        NULL, NULL);
    if (!status)
        status = relume_maps_fit(maps, capture, p);
    relume_capture_destroy(&capture);
    return status;
}

static relume_status fit_file(struct relume_maps *maps, const struct maps_options *o,
                              const struct relume_maps_params *p)
{
    relume_pack *pack;
    relume_status status = relume_open(
        &pack, o->args.input[0],
        relume_open_params(.log = o->args.log, .threads = p->threads, .keep_going = o->keep_going));
    if (!status)
        status = relume_maps_fit_pack(maps, pack, p);
    relume_pack_destroy(&pack);
    return status;
}

static relume_status run_maps(const struct args *args)
{
    const struct maps_options *o = (const void *)args;
    struct prefix_log prefix;
    const struct relume_maps_params p = {
        .log = prefix_log(&prefix, args->log, args->input[0]),
        .threads = args->threads,
        .view = o->view,
        .held_out = given(o, &o->held_out) && o->held_out == 0 ? -1 : o->held_out,
        .materials = o->materials,
        .gain = o->gain,
        .keep_normals = o->photometric,
    };
    struct relume_maps maps = {0};
    relume_status status = relume_folder_check(o->output, o->force, args->log);
    if (!status)
        status = relume_kind_of(args->input[0]) == RELUME_KIND_CAPTURE ? fit_capture(&maps, o, &p)
                                                                       : fit_file(&maps, o, &p);
    if (!status)
        status = relume_maps_write(
            &maps, o->output,
            relume_maps_write_params(.log = args->log, .threads = args->threads, .force = o->force,
                                     .directx = o->directx, .mesh = o->mesh, .width_mm = o->width));
    if (!status)
        say_result(o, &maps);
    if (!status && o->json)
        print_json(o, &maps);
    relume_maps_destroy(&maps);
    return status;
}

static const struct command *const tasks[] = {&maps_task_edit, NULL};

const struct command command_maps = {
    .tasks = tasks,
    COMMAND(run_maps, "maps", "FILE|CAPTURE -o DIR [OPTION ...]",
            "normal, colour, gloss and height maps, glTF and MaterialX, for other programs",
            "relume maps statue -o statue-maps --width 120", 1, 1),
};
