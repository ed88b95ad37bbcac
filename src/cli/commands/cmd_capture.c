// cmd_capture.c - relume capture PHOTO ... -o DIR: a light sequence becomes a capture
#include "cli/commands/film_frames.h"
#include "cli/commands/crop_option.h"
#include "cli/frame_options.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

struct capture_options {
    struct args args;
    const char *output, *mask, *ball_mask, *lights, *normals, *albedo, *height, *encode, *relight;
    struct relume_transfer transfer, ball_transfer;
    double white[4], target_corners[8];
    struct crop crop;
    const char *target, *target_values;
    enum { ALIGN_AUTO, ALIGN_NONE, ALIGN_HOMOGRAPHY } align;
    bool force, json, skip_bad, matte, near, distant, refine_lights, refine_brightness, integrable,
        radial;
    struct points ball;
    struct texts ball_photos, flat;
    int balls, frames;
    double ball_z, fov, focal, width;
    struct light_options lighting;
    int cpu_mask;
};
#define OPTIONS struct capture_options
enum { FRAMES = 60 };  // of a film

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "DIR",
           "the capture folder to make; for several folders, an object each, one of captures"),
    FLAG("--force", force, "replace a folder that relume made"),
    FLAG("--json", json, "print one JSON object"),
    GROUP("input"),
    TRANSFER("--transfer", transfer, "linear, srgb or gamma:G; default: by file"),
    TEXT("--mask", mask, "FILE", "a mask: white where the object is"),
    CROP_OPTION,
    INT("--frames", frames, "N", "a film of a moving lamp: frames to keep; default: 60", 3,
        FILM_FRAMES_MOST),
    FLAG("--skip-bad", skip_bad, "leave out photographs that cannot be read or used"),
    GROUP("finding the lights"),
    POINTS("--ball", ball, "x,y,r",
           "outline of a mirror ball, pixels from the top left; may be repeated; default: found"),
    INT("--balls", balls, "N",
        "number of balls to look for; default: all mirror balls, 1 matte one", 1, 16),
    FILES("--ball-photos", ball_photos, "PATH...",
          "separate photographs of the ball: a folder, or files up to the next option"),
    TRANSFER("--ball-transfer", ball_transfer,
             "--ball-photos: linear, srgb or gamma:G; default: as --transfer, else by file"),
    TEXT("--ball-mask", ball_mask, "FILE", "a mask: white where the ball is"),
    FLAG("--matte", matte, "the ball is matte white, not a mirror"),
    TEXT("--lights", lights, "FILE",
         "the lights are known: a .lp, .dome or capture.json file, lines x y z, or COLMAP poses of "
         "a camera on the lamp"),
    FLAG("--near", near,
         "the lamps stand near: find their positions by balls, two or more, or take those of "
         "--lights"),
    FLAG("--distant", distant,
         "directions of lights even where two balls show that lamps are near"),
    NUMBER("--ball-z", ball_z, "Z",
           "height of the balls' middle over the plane z = 0, world units; default: 0", -1000,
           1000),
    NUMBER("--fov", fov, "DEG", "horizontal field of view; default: orthographic", 0.1, 170),
    NUMBER("--focal", focal, "MM", "the same as a focal length, for a sensor 36 mm wide", 5, 5000),
    FLAG("--refine-lights", refine_lights,
         "improve the directions and brightness of the lights from the photographs themselves"),
    FLAG("--refine-brightness", refine_brightness,
         "estimate the brightness of each lamp from the photographs; keep the directions"),
    FLAG("--integrable", integrable, "--refine-lights: keep the surface physically continuous"),
    GROUP("corrections"),
    NUMBERS("--white", white, "x,y,w,h",
            "a grey region of the picture: removes the colour of the lamps", 4),
    TEXT("--target", target, "FILE",
         "a photograph of a ColorChecker 24, or auto where it stands in the photographs: makes "
         "colours right"),
    NUMBERS("--target-corners", target_corners, "x,y,...",
            "outer corners of the target's four corner patches, pixels; default: found", 8),
    TEXT("--target-values", target_values, "FILE",
         "24 lines L* a* b* (D50) of your own target; default: the published ones"),
    FILES(
        "--flat", flat, "PATH...",
        "photograph of an even white surface: removes uneven light; one, or one under each light"),
    FLAG("--radial", radial,
         "--flat: use only how it falls off from the middle, as a smooth curve"),
    NAME("--align", align, "A",
         "auto (find where the camera was moved), none or homography; default: auto", ALIGN_AUTO,
         "auto", "none", "homography"),
    GROUP("surface"),
    TEXT_AS(OPTION_FLOATS, "--normals", normals, "FILE",
            "write surface normals: .exr, or .png or .tif of 16 bits"),
    TEXT_AS(OPTION_PICTURE, "--albedo", albedo, "FILE.exr", "write the surface's colour (albedo)"),
    TEXT_AS(OPTION_FLOATS, "--height", height, "FILE",
            "write the surface's height, as --normals; in --width's millimetres, or world units"),
    NUMBER("--width", width, "MM",
           "width of the photographs in millimetres: --height in millimetres", 1e-6, 1e9),
    TEXT_AS(OPTION_RELUME, "--encode", encode, "FILE.exr",
            "also encode the capture to this relume file"),
    TEXT_AS(OPTION_PICTURE, "--relight", relight, "PICTURE",
            "--encode: relight the file by --light and write this picture"),
    GROUP("lights"),
    LIGHT_OPTIONS,
    GROUP("machine"),
    CPU_OPTION,
    {0},
};

static relume_status check_options(const struct capture_options *o)
{
    if (given(o, &o->white) && !(o->white[2] >= 1.0 && o->white[3] >= 1.0))
        return usage_error("--white: expected a width and height of 1 or more; found %g and %g",
                           o->white[2], o->white[3]);
    if (o->relight && !o->encode)
        return usage_error("capture: --relight needs --encode FILE.exr");
    return RELUME_OK;
}

static struct relume_acquire_params read_options(const struct capture_options *o)
{
    struct relume_acquire_params p = {
        .struct_size = sizeof p,
        .log = o->args.log,
        .threads = o->args.threads,
        .transfer = o->transfer,
        .mask = o->mask,
        .skip_bad = o->skip_bad,
        .force = o->force,
        .lights = o->lights,
        .near = o->near,
        .distant = o->distant,
        .ball = (const double(*)[3])o->ball.point,
        .balls = o->ball.count ? o->ball.count : o->balls,
        .matte = o->matte,
        .ball_mask = o->ball_mask,
        .ball_photographs = o->ball_photos.text,
        .ball_photograph_count = o->ball_photos.count,
        .ball_transfer = o->ball_transfer,
        .ball_z = o->ball_z,
        .fov_deg = o->fov,
        .focal_mm = o->focal,
        .refine_lights = o->refine_lights,
        .refine_brightness = o->refine_brightness,
        .integrable = o->integrable,
        .target = o->target,
        .target_corner = given(o, o->target_corners) ? (const double(*)[2])o->target_corners : NULL,
        .target_values = o->target_values,
        .flats = o->flat.text,
        .flat_count = o->flat.count,
        .radial = o->radial,
        .align = o->align == ALIGN_HOMOGRAPHY,
        .no_registration = o->align == ALIGN_NONE,
        .normals = o->normals,
        .albedo = o->albedo,
        .height = o->height,
        .width_mm = o->width,
    };
    p.crop_auto = o->crop.automatic;
    memcpy(p.crop, o->crop.part, sizeof p.crop);
    for (int i = 0; i < 4; i++)
        p.white[i] = fabs(o->white[i]) < 1e6 ? (int)o->white[i] : -1;
    return p;
}

// ---------------------------------------------------------------- the file

// `args` has the log.
static relume_status relight(const struct capture_options *o, const struct args *args,
                             const char *file, const char *picture)
{
    relume_pack *pack;
    relume_rig *rig = NULL;
    const struct relume_light *lights;
    struct relume_image frame = {0};
    int n;
    struct relume_frame_params params = parse_frame(&o->args, &o->lighting, o->cpu_mask);
    params.log = args->log;
    params.masked = true;
    relume_status status = relume_pack_open(
        &pack, file, relume_pack_params(.log = args->log, .threads = args->threads));
    if (status)
        return status;
    status = parse_lights_of_file(args, &o->lighting, &rig, &lights, &n);
    if (!status)
        status = aim_lights(args, &o->lighting, rig, pack, file, &lights, &n);
    if (!status)
        status = relume_frame(&frame, pack, &(struct relume_camera){0}, lights, n, &params);
    if (!status)
        status = relume_image_save(&frame, picture, relume_image_params(.log = args->log));
    if (!status)
        status = save_lights(args, &o->lighting, rig);
    relume_image_destroy(&frame);
    relume_rig_destroy(&rig);
    relume_pack_destroy(&pack);
    return status;
}

// ---------------------------------------------------------------- what to say

static void put_patch(struct jwriter *w, const struct relume_chart_patch *p)
{
    jopen_object(w, NULL);
    jput_text(w, "name", p->name);
    jput_number(w, "x", p->place[0], 6);
    jput_number(w, "y", p->place[1], 6);
    jput_floats(w, "found", p->found, 3, 6);
    jput_number(w, "noise", p->noise, 4);
    jput_truth(w, "used", p->used);
    jput_number(w, "delta_e_before", p->delta_e_before, 4);
    jput_number(w, "delta_e_white", p->delta_e_balance, 4);
    jput_number(w, "delta_e", p->delta_e, 4);
    jclose(w);
}

static void put_target(struct jwriter *w, const struct relume_chart *c, const char *path)
{
    jopen_object(w, "target");
    jput_text(w, "file", path);
    jopen_array(w, "corners");
    for (int i = 0; i < 4; i++)
        jput_numbers(w, NULL, c->corner[i], 2, 6);
    jclose(w);
    jput_floats(w, "matrix", c->matrix, 9, 9);
    jput_floats(w, "white", c->white, 3, 9);
    jput_number(w, "exposure", c->exposure, 9);
    jput_number(w, "uneven", c->uneven, 4);
    jput_integer(w, "used", c->used);
    jput_numbers(w, "delta_e_before", c->before, 2, 4);
    jput_numbers(w, "delta_e_white", c->balanced, 2, 4);
    jput_numbers(w, "delta_e", c->after, 2, 4);
    jopen_array(w, "patches");
    for (int i = 0; i < RELUME_CHART_PATCHES; i++)
        put_patch(w, &c->patch[i]);
    jclose_levels(w, 2);
}

static void put_photograph(struct jwriter *w, const struct relume_acquisition *s, int i)
{
    jopen_object(w, NULL);
    jput_text(w, "file", s->photo[i].path);
    jput_vector(w, "direction", s->direction[i], 9);
    if (s->position)
        jput_vector(w, "position", s->position[i], 9);
    if (s->intensity)
        jput_floats(w, "intensity", s->intensity[i], 3, 9);
    jput_number(w, "error_deg", s->photo[i].sigma_deg, 6);
    jput_number(w, "saturated", (double)s->photo[i].saturated, 6);
    jput_number(w, "sharpness", (double)s->photo[i].sharpness, 9);
    if (s->photo[i].shift[0] != 0.0 || s->photo[i].shift[1] != 0.0)
        jput_numbers(w, "shift", s->photo[i].shift, 2, 6);
    jclose(w);
}

static void put_balls(struct jwriter *w, const struct relume_acquisition *s)
{
    jopen_array(w, "balls");
    for (int b = 0; b < s->balls; b++) {
        jopen_object(w, NULL);
        jput_number(w, "x", s->ball[b].x, 9);
        jput_number(w, "y", s->ball[b].y, 9);
        jput_number(w, "radius", s->ball[b].radius, 9);
        jput_number(w, "coverage", s->ball[b].coverage, 4);
        jclose(w);
    }
    jclose(w);
}

static void put_report(struct jwriter *w, const struct relume_acquisition *s)
{
    const bool measured = s->photometric.normal.data;
    jput_integer(w, "lights", s->lights);
    jput_integer(w, "left_out", s->left_out);
    jput_integer(w, "width", s->width);
    jput_integer(w, "height", s->height);
    if (s->crop[2]) {
        jopen_array(w, "crop");
        for (int i = 0; i < 4; i++)
            jput_integer(w, NULL, s->crop[i]);
        jclose(w);
    }
    put_balls(w, s);
    jput_number(w, "gap_deg", s->gap_deg, 6);
    jput_number(w, "residual", measured ? s->photometric.residual : (double)NAN, 9);
    jput_number(w, "position_error", s->position_error, 6);
    jopen_array(w, "photographs");
    for (int i = 0; i < s->lights; i++)
        put_photograph(w, s, i);
    jclose(w);
    jput_texts(w, "warnings", (const char *const *)s->warning, (size_t)s->warnings);
    if (s->target)
        put_target(w, &s->chart, s->target);
}

static void print_json(const struct relume_acquisition *s)
{
    struct jwriter w = json_dense();
    jopen_object(&w, NULL);
    put_report(&w, s);
    jend(&w);
}

static void say_made(const struct capture_options *o, const struct relume_acquisition *s)
{
    const char *q = relume_name_quotes(o->output);
    char directions[64] = "", positions[64] = "", left_out[64] = "", next[4200] = "";
    if (s->direction_error_deg > 0.0)
        snprintf(directions, sizeof directions, ", directions to about %.2f degrees",
                 s->direction_error_deg);
    if (s->position_error > 0.0)
        snprintf(positions, sizeof positions, ", positions to about %.1f %%",
                 100.0 * s->position_error);
    if (s->left_out)
        snprintf(left_out, sizeof left_out, ", %d photograph%s left out", s->left_out,
                 relume_plural(s->left_out));
    if (!o->encode)
        snprintf(next, sizeof next, "; next: relume encode %s%.4096s%s -o FILE.exr", q, o->output,
                 q);
    announce(&o->args, RELUME_NOTE, "%s: %d lights%s%s%s; see report.html there%s", o->output,
             s->lights, directions, positions, left_out, next);
}

// The photographs that are named, or frames of a film.
static relume_status make_capture(const struct capture_options *o,
                                  struct relume_acquisition *report)
{
    const struct args *args = &o->args;
    const struct relume_acquire_params params = read_options(o);
    struct film_frames film;
    if (args->inputs != 1 || !film_frames_named(args->input[0]))
        return relume_capture_photographs(o->output, args->input, args->inputs, &params, report);
    relume_status status =
        film_frames_open(&film, args->input[0], o->frames ? o->frames : FRAMES, args->log);
    if (status)
        return status;
    announce(args, RELUME_NOTE, "%s: %d of %d frames are taken, the sharp ones whose light differs",
             args->input[0], film.count, film.frames);
    status = relume_capture_photographs(o->output, (const char *const *)film.path, film.count,
                                        &params, report);
    film_frames_close(&film);
    return status;
}

static relume_status capture_one(const struct capture_options *o)
{
    const struct args *args = &o->args;
    struct relume_acquisition report = {0};
    relume_status status = make_capture(o, &report);
    if (!status && o->encode)
        status = encode_as_usual(args, o->output, o->encode);
    if (!status && o->relight)
        status = relight(o, args, o->encode, o->relight);
    if (!status && o->json)
        print_json(&report);
    else if (!status)
        say_made(o, &report);
    relume_acquisition_destroy(&report);
    return status;
}

// ---------------------------------------------------------------- many objects

// Fills in the path of a file in an object's folder; `*there`: the folder has one already.
static relume_status fill_path(char *path, size_t size, bool *there,
                               const struct relume_captured_object *object, const char *name)
{
    if (snprintf(path, size, "%s/%s", object->path, name) >= (int)size)
        return data_error("%s/%s: this name is too long", object->path, name);
    *there = !access(path, F_OK);
    return RELUME_OK;
}

// The relume file of an object and its picture. Files that are there stay.
static relume_status follow_object(void *user, const struct relume_captured_object *object,
                                   const struct relume_log *log)
{
    const struct capture_options *o = user;
    struct args args = o->args;
    char file[4096], picture[4096];
    bool encoded = true, relit = true;
    if (!o->encode)
        return RELUME_OK;
    args.log = log;
    relume_status status = fill_path(file, sizeof file, &encoded, object, o->encode);
    if (!status && o->relight)
        status = fill_path(picture, sizeof picture, &relit, object, o->relight);
    if (!status && !encoded)
        status = encode_as_usual(&args, object->path, file);
    return status || relit ? status : relight(o, &args, file, picture);
}

static void put_captured_object(struct jwriter *w, const struct relume_captured_object *object)
{
    jopen_object(w, NULL);
    jput_text(w, "name", object->name);
    jput_text(w, "folder", object->photographs);
    jput_text(w, "capture", object->path);
    jput_text(w, "status", relume_status_name(object->status));
    jput_text(w, "reason", object->reason);
    jput_truth(w, "kept", object->kept);
    if (object->capture.lights)
        put_report(w, &object->capture);
    jclose(w);
}

static void print_objects(const struct relume_captured_objects *objects)
{
    struct jwriter w = json_dense();
    jopen_object(&w, NULL);
    jopen_array(&w, "objects");
    for (int i = 0; i < objects->count; i++)
        put_captured_object(&w, &objects->object[i]);
    jend(&w);
}

// Names faults of the lights once, before the first object.
static relume_status check_lights(const struct capture_options *o)
{
    relume_rig *rig = NULL;
    const struct relume_light *lights;
    int n;
    const relume_status status =
        o->relight ? parse_lights(&o->args, &o->lighting, &rig, &lights, &n) : RELUME_OK;
    relume_rig_destroy(&rig);
    return status;
}

static relume_status capture_many(const struct capture_options *o)
{
    const struct args *args = &o->args;
    const struct relume_acquire_params each = read_options(o);
    const char *const files[] = {o->encode, o->relight};
    struct relume_captured_objects objects = {0};
    relume_status status = check_lights(o);
    if (!status)
        status = relume_capture_objects(
            o->output, args->input, args->inputs,
            relume_capture_objects_params(.log = args->log, .each = &each, .follow = follow_object,
                                          .user = (void *)o, .files = files,
                                          .file_count = (o->encode != NULL) + (o->relight != NULL)),
            &objects);
    if (o->json && objects.count && status != RELUME_ECANCEL)
        print_objects(&objects);
    else if (!status && !o->encode)
        announce(args, RELUME_NOTE,
                 "next: the same command with --encode NAME.exr puts a relume file into each "
                 "folder");
    relume_captured_objects_destroy(&objects);
    return status;
}

// Files of many objects lie in the folder of each.
static bool has_many_objects(const struct args *args)
{
    bool many;
    return !relume_capture_find_objects(&many, args->input, args->inputs, NULL) && many;
}

static relume_status run_capture(const struct args *args)
{
    const struct capture_options *o = (const void *)args;
    bool many = false;
    relume_status status = check_options(o);
    if (!status)
        status = relume_capture_find_objects(&many, args->input, args->inputs, args->log);
    return status ? status : many ? capture_many(o) : capture_one(o);
}

const struct command command_capture = {
    COMMAND(run_capture, "capture", "PHOTO... | FOLDER FOLDER... -o DIR [OPTION ...]",
            "turn photographs under one light each into a capture, and find their lights",
            "relume capture statue/*.jpg --ball-photos ball -o statue_capture\n"
            "  relume capture coins/* -o coin_captures",
            1, 4096),
    .defaults = &(const OPTIONS){.cpu_mask = ALL_KERNELS},
    .moves_outputs = has_many_objects,
};
