// cmd_capture.c - relume capture PHOTO ... -o DIR: a light sequence becomes a capture
#include "cli/frame_options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct capture_options {
    struct args args;
    const char *output, *mask, *ball_mask, *lights, *normals, *albedo, *height, *encode, *relight;
    struct relume_transfer transfer, ball_transfer;
    double white[4], target_corners[8];
    const char *target, *target_values;
    enum { ALIGN_NONE, ALIGN_HOMOGRAPHY } align;
    bool force, json, skip_bad, matte, near, refine_lights, refine_brightness, integrable, radial;
    struct points ball;
    struct texts ball_photos, flat;
    int balls;
    double ball_z, fov, focal, width;
    struct light_options lighting;
    int cpu_mask;
};
#define OPTIONS struct capture_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "DIR", "the capture folder to make"),
    FLAG("--force", force, "replace a folder that relume made"),
    FLAG("--json", json, "print one JSON object"),
    GROUP("input"),
    TRANSFER("--transfer", transfer, "linear, srgb or gamma:G; default: by file"),
    TEXT("--mask", mask, "FILE", "a mask: white where the object is"),
    FLAG("--skip-bad", skip_bad, "leave out photographs that cannot be read or used"),
    GROUP("finding the lights"),
    POINTS("--ball", ball, "x,y,r",
           "outline of a mirror ball, pixels from the top left; may be repeated; default: found"),
    INT("--balls", balls, "N", "number of balls to look for; default: 1", 1, 16),
    TEXTS("--ball-photos", ball_photos, "PATH",
          "separate photographs of the ball: a folder, or one file (repeat the option for more)"),
    TRANSFER("--ball-transfer", ball_transfer,
             "--ball-photos: linear, srgb or gamma:G; default: as --transfer, else by file"),
    TEXT("--ball-mask", ball_mask, "FILE", "a mask: white where the ball is"),
    FLAG("--matte", matte, "the ball is matte white, not a mirror"),
    TEXT("--lights", lights, "FILE",
         "the lights are known: a .lp, .dome or capture.json file, lines x y z, or COLMAP poses of "
         "a camera on the lamp"),
    FLAG("--near", near,
         "the lamps stand near: find their positions by two balls or more, or take those of "
         "--lights"),
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
    TEXTS(
        "--flat", flat, "PATH",
        "photograph of an even white surface: removes uneven light; one, or one under each light"),
    FLAG("--radial", radial,
         "--flat: use only how it falls off from the middle, as a smooth curve"),
    NAME("--align", align, "A",
         "move the photographs onto each other: none, blocks or homography; default: none",
         ALIGN_NONE, "none", "homography"),
    GROUP("surface"),
    TEXT_AS(OPTION_FLOATS, "--normals", normals, "FILE.exr", "write surface normals"),
    TEXT_AS(OPTION_PICTURE, "--albedo", albedo, "FILE.exr", "write the surface's colour (albedo)"),
    TEXT_AS(OPTION_FLOATS, "--height", height, "FILE.exr",
            "write the surface's height, in --width's millimetres; default: world units"),
    NUMBER("--width", width, "MM", "width of the picture in millimetres: --height in millimetres",
           1e-6, 1e9),
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

struct job {
    struct relume_photographs photos, balls, flats;
    char likely_lights[4096];  // beside the photographs or above their folder
    struct relume_acquire_params p;
    struct relume_acquisition acquisition;
    struct relume_chart chart;
    const char *chart_path;
};

// ---------------------------------------------------------------- photographs

static int by_number(const void *a, const void *b)
{
    return strverscmp(*(char *const *)a, *(char *const *)b);
}

static relume_status list(struct relume_photographs *out, const char *const *paths, int n,
                          int least, const struct capture_options *o)
{
    const relume_status status = relume_photographs_list(
        out, paths, n,
        relume_photographs_params(.log = o->args.log, .companions = true, .least = least,
                                  .command = least ? "try: relume capture" : NULL));
    if (!status && out->count)  // img2 comes before img10, whatever the shell says
        qsort(out->path, (size_t)out->count, sizeof *out->path, by_number);
    return status;
}

static bool is_lp(const char *path)
{
    const size_t length = strlen(path);
    return length > 3 && !strcasecmp(path + length - 3, ".lp");
}

// A list of lights that names its photographs is a capture already.
static relume_status refuse_list(const struct capture_options *o)
{
    const char *path = o->args.input[0], *slash = strrchr(path, '/');
    if (o->args.inputs != 1 || !is_lp(path))
        return RELUME_OK;
    return say(o->args.log, RELUME_EUNFIT,
               "%s: this lists lights and photographs, which encode and maps take as it is; for "
               "capture give the photographs: relume capture %.*s --lights %s -o DIR",
               path, slash ? (int)(slash - path) : 1, slash ? path : ".", path);
}

static relume_status gather(const struct capture_options *o, struct job *job)
{
    relume_status status = refuse_list(o);
    if (!status)
        status = list(&job->photos, o->args.input, o->args.inputs, 3, o);
    if (!status && o->ball_photos.count)
        status = list(&job->balls, o->ball_photos.text, o->ball_photos.count, 0, o);
    if (!status && o->flat.count)
        status = list(&job->flats, o->flat.text, o->flat.count, 0, o);
    return status;
}

// A list that nobody named counts where it has a light for every photograph; an .lp file, which
// names them, also where it has more.
static bool fits(const char *path, const struct job *job)
{
    struct relume_captured_lights list;
    const bool names = is_lp(path);
    const bool good = !relume_captured_lights_load(&list, path, false, NULL);
    const bool fits =
        good && (names ? list.count >= job->photos.count : list.count == job->photos.count);
    relume_captured_lights_destroy(&list);
    return fits;
}

// A list of lights in the folder whose name has `length` bytes.
static bool find_lights_in(struct job *job, const char *folder, int length)
{
    static const char *const names[] = {"light_directions.txt", "lights.txt", "lights.lp",
                                        "dirs.lp"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(job->likely_lights, sizeof job->likely_lights, "%.*s%s", length, folder, names[i]);
        if (fits(job->likely_lights, job)) {
            job->p.likely_lights = job->likely_lights;
            return true;
        }
    }
    return false;
}

// Beside photographs that are named one by one; data sets of several objects keep one list above
// their folders.
static void find_likely_lights(struct job *job)
{
    const char *const first = job->photos.path[0], *slash = strrchr(first, '/');
    if (find_lights_in(job, first, slash ? (int)(slash + 1 - first) : 0) || !slash)
        return;
    while (slash > first && slash[-1] != '/')
        slash--;
    (void)find_lights_in(job, first, (int)(slash - first));
}

// Positions look like directions that are not of unit length.
static void mention_near(const struct capture_options *o, const char *lights)
{
    const char *name = strrchr(lights, '/');
    if (!o->near && strcasestr(name ? name : lights, "position"))
        announce(&o->args, RELUME_NOTE,
                 "%s: is read as light directions; add --near where it holds "
                 "the positions of lamps",
                 lights);
}

// --lights, or the file of lights that lies with the photographs unless a ball shows the lights.
static const char *lights_file(const struct capture_options *o, const struct job *job)
{
    const char *beside = job->photos.lights;
    const char *dot = beside ? strrchr(beside, '.') : NULL;
    if (o->lights || o->ball.count || o->ball_photos.count || given(o, &o->balls) || o->ball_mask ||
        o->matte) {
        if (o->lights)
            mention_near(o, o->lights);
        return o->lights;
    }
    if (!beside)
        return NULL;
    if (!strcasecmp(dot, ".txt") && !fits(beside, job)) {
        announce(
            &o->args, RELUME_NOTE,
            "%s: is not read; as light directions it would have a line x y z for each of the %d "
            "photographs",
            beside, job->photos.count);
        return NULL;
    }
    announce(
        &o->args, RELUME_NOTE,
        "%s: light directions are taken from this file; --ball or --ball-photos take them from a "
        "mirror ball instead",
        beside);
    mention_near(o, beside);
    return beside;
}

// ---------------------------------------------------------------- options

static relume_status check_options(const struct capture_options *o)
{
    if (given(o, &o->fov) && given(o, &o->focal))
        return usage_error("capture: expected one of --fov and --focal");
    if (o->refine_brightness && o->refine_lights)
        return usage_error("capture: expected one of --refine-lights, which refines brightness as "
                           "well, and --refine-brightness");
    if (given(o, &o->ball_transfer) && !o->ball_photos.count)
        return usage_error("capture: --ball-transfer needs --ball-photos; for the photographs "
                           "themselves use --transfer");
    if (o->integrable && !o->refine_lights)
        return usage_error("capture: --integrable needs --refine-lights");
    if (o->radial && !o->flat.count)
        return usage_error("capture: --radial needs --flat FILE");
    if (given(o, &o->white) && !(o->white[2] >= 1.0 && o->white[3] >= 1.0))
        return usage_error("--white: expected a width and height of 1 or more; found %g and %g",
                           o->white[2], o->white[3]);
    if (given(o, &o->white) && o->target)
        return usage_error("capture: expected one of --white and --target, which gives the white "
                           "balance as well");
    if ((given(o, &o->target_corners) || o->target_values) && !o->target)
        return usage_error("capture: %s needs --target FILE",
                           o->target_values ? "--target-values" : "--target-corners");
    if (given(o, &o->width) && !o->height)
        return usage_error("capture: --width needs --height FILE.exr");
    if (o->relight && !o->encode)
        return usage_error("capture: --relight needs --encode FILE.exr");
    return RELUME_OK;
}

static void read_options(const struct capture_options *o, struct job *job)
{
    job->p = (struct relume_acquire_params){
        .log = o->args.log,
        .mask = (o->mask ? o->mask : job->photos.mask),
        .ball_mask = (o->ball_mask ? o->ball_mask : job->balls.mask),
        .photographs = (const char *const *)job->photos.path,
        .photograph_count = job->photos.count,
        .quick = !o->normals && !o->albedo && !o->height,
        .ball_photographs = (const char *const *)job->balls.path,
        .ball_photograph_count = job->balls.count,
        .transfer = o->transfer,
        .ball_transfer = o->ball_transfer,
        .ball = (const double(*)[3])o->ball.point,
        .balls = o->ball.count ? o->ball.count : o->balls,
        .align = o->align == ALIGN_HOMOGRAPHY,
        .matte = o->matte,
        .fov_deg = o->focal > 0.0 ? 2.0 * atan(18.0 / o->focal) * 180.0 / M_PI : o->fov,
        .ball_z = o->ball_z,
        .lights = lights_file(o, job),
        .flats = (const char *const *)job->flats.path,
        .flat_count = job->flats.count,
        .radial = o->radial,
        .near = o->near,
        .refine = o->refine_lights || o->refine_brightness,
        .brightness = o->refine_brightness,
        .integrable = o->integrable,
        .skip_bad = o->skip_bad,
        .force = o->force,
        .threads = o->args.threads,
    };
    if (!job->p.lights)
        find_likely_lights(job);
    for (int i = 0; i < 4; i++)
        job->p.white[i] = fabs(o->white[i]) < 1e6 ? (int)o->white[i] : -1;
}

// ---------------------------------------------------------------- colour

static relume_status read_target(const struct capture_options *o, struct job *job)
{
    const bool among = o->target && !strcmp(o->target, "auto");
    const char *const *paths = among ? (const char *const *)job->photos.path : &o->target;
    double corner[4][2], values[RELUME_CHART_PATCHES][3];
    if (!o->target)
        return RELUME_OK;
    memcpy(corner, o->target_corners, sizeof corner);
    relume_status status = o->target_values
                               ? relume_chart_reference_load(values, o->target_values, o->args.log)
                               : RELUME_OK;
    if (status)
        return status;
    status = relume_chart_load(
        &job->chart, paths, among ? job->photos.count : 1,
        relume_chart_params(.log = o->args.log, .transfer = o->transfer,
                            .corner =
                                given(o, &o->target_corners) ? (const double(*)[2])corner : NULL,
                            .reference = o->target_values ? (const double(*)[3])values : NULL));
    if (status)
        return status;
    const struct relume_chart *c = &job->chart;
    job->chart_path = paths[c->photograph];
    job->p.chart = c;
    job->p.chart_path = job->chart_path;
    announce(&o->args, RELUME_NOTE,
             "%s: colour target, %d of 24 patches: colour difference %.1f (largest %.1f) as "
             "photographed, %.1f (%.1f) with white balance, %.1f (%.1f) corrected: %s",
             job->chart_path, c->used, c->before[0], c->before[1], c->balanced[0], c->balanced[1],
             c->after[0], c->after[1],
             c->after[0] < 2.0   ? "good"
             : c->after[0] < 4.0 ? "usable"
                                 : "poor; is the target clean, evenly lit, without shine?");
    return RELUME_OK;
}

// ---------------------------------------------------------------- by-products

static relume_status save(const struct capture_options *o, const char *path,
                          const struct relume_image *image)
{
    if (!path)
        return RELUME_OK;
    if (!image->data)
        return data_error("%s: normals cannot be computed; expected three lights or more that do "
                          "not lie in one plane",
                          path);
    return relume_image_save(image, path, relume_image_params(.log = o->args.log));
}

static relume_status save_height(const struct capture_options *o,
                                 const struct relume_acquisition *acquisition)
{
    struct relume_image height = {0};
    relume_status status = RELUME_OK;
    if (o->height && acquisition->photometric.normal.data)
        status = relume_height_integrate(
            &height, &acquisition->photometric.normal,
            relume_height_params(.log = o->args.log,
                                 .pixel = (o->width > 0.0 ? o->width : 2.0) / acquisition->width,
                                 .threads = o->args.threads,
                                 .confidence = &acquisition->photometric.confidence));
    if (!status)
        status = save(o, o->height, &height);
    relume_image_destroy(&height);
    return status;
}

// ---------------------------------------------------------------- the file

// What lies outside the file's mask is not known.
static relume_status blacken(struct relume_image *frame, relume_pack *pack)
{
    struct relume_image mask;
    const relume_status status = relume_pack_mask(&mask, pack, 0);
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    for (size_t i = 0; !status && mask.data && i < 3 * pixels; i++)
        frame->data[i] *= mask.data[i / 3] > 0.5f ? 1.0f : 0.0f;
    relume_image_destroy(&mask);
    return status;
}

static relume_status relight(const struct capture_options *o, const char *file)
{
    relume_pack *pack;
    relume_rig *rig = NULL;
    const struct relume_light *lights;
    struct relume_image frame = {0};
    int n;
    struct relume_frame_params params = parse_frame(&o->args, &o->lighting, o->cpu_mask);
    params.log = o->args.log;
    relume_status status = relume_pack_open(
        &pack, file, relume_pack_params(.log = o->args.log, .threads = o->args.threads));
    if (status)
        return status;
    status = parse_lights(&o->args, &o->lighting, &rig, &lights, &n);
    if (!status)
        status = relume_frame(&frame, pack, &(struct relume_camera){0}, lights, n, &params);
    if (!status)
        status = blacken(&frame, pack);
    if (!status)
        status = relume_image_save(&frame, o->relight, relume_image_params(.log = o->args.log));
    if (!status)
        status = save_lights(&o->args, &o->lighting, rig);
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

static void print_json(const struct job *job)
{
    const struct relume_acquisition *s = &job->acquisition;
    const bool measured = s->photometric.normal.data;
    struct jwriter w = json_dense();
    jopen_object(&w, NULL);
    jput_integer(&w, "lights", s->lights);
    jput_integer(&w, "width", s->width);
    jput_integer(&w, "height", s->height);
    put_balls(&w, s);
    jput_number(&w, "gap_deg", s->gap_deg, 6);
    jput_number(&w, "residual", measured ? s->photometric.residual : (double)NAN, 9);
    jput_number(&w, "position_error", s->position_error, 6);
    jopen_array(&w, "photographs");
    for (int i = 0; i < s->lights; i++)
        put_photograph(&w, s, i);
    jclose(&w);
    jput_texts(&w, "warnings", (const char *const *)s->warning, (size_t)s->warnings);
    if (job->chart_path)
        put_target(&w, &job->chart, job->chart_path);
    jend(&w);
}

static void say_made(const struct capture_options *o, const struct relume_acquisition *s)
{
    const char *q = relume_name_quotes(o->output);
    double sigma = 0.0;
    char directions[64] = "", positions[64] = "", next[4200] = "";
    for (int i = 0; i < s->lights; i++)
        sigma += s->photo[i].sigma_deg / s->lights;
    if (sigma > 0.0)
        snprintf(directions, sizeof directions, ", directions to about %.2f degrees", sigma);
    if (s->position_error > 0.0)
        snprintf(positions, sizeof positions, ", positions to about %.1f %%",
                 100.0 * s->position_error);
    if (!o->encode)
        snprintf(next, sizeof next, "; next: relume encode %s%.4096s%s -o FILE.exr", q, o->output,
                 q);
    announce(&o->args, RELUME_NOTE, "%s: %d lights%s%s; see report.html there%s", o->output,
             s->lights, directions, positions, next);
}

static relume_status make(const struct capture_options *o, struct job *job)
{
    relume_status status = relume_acquire(&job->acquisition, o->output, &job->p);
    if (status)
        return status;
    status = save(o, o->normals, &job->acquisition.photometric.normal);
    if (!status)
        status = save(o, o->albedo, &job->acquisition.photometric.albedo);
    if (!status)
        status = save_height(o, &job->acquisition);
    if (!status && o->encode)
        status = encode_as_usual(&o->args, o->output, o->encode);
    if (!status && o->relight)
        status = relight(o, o->encode);
    if (!status && o->json)
        print_json(job);
    else if (!status)
        say_made(o, &job->acquisition);
    return status;
}

static relume_status run(const struct args *args)
{
    const struct capture_options *o = (const void *)args;
    struct job job = {0};
    relume_status status = check_options(o);
    if (!status)
        status = gather(o, &job);
    if (!status) {
        read_options(o, &job);
        status = read_target(o, &job);
    }
    if (!status)
        status = make(o, &job);
    relume_photographs_free(&job.photos);
    relume_photographs_free(&job.balls);
    relume_photographs_free(&job.flats);
    relume_acquisition_destroy(&job.acquisition);
    return status;
}

const struct command command_capture = {
    COMMAND("capture", "PHOTO... -o DIR [OPTION ...]",
            "turn photographs under one light each into a capture, and find their lights",
            "relume capture statue/*.jpg --ball-photos ball -o statue_capture", 1, 4096),
    .defaults = &(const OPTIONS){.balls = 1, .cpu_mask = ALL_KERNELS},
};
