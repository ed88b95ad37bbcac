// acquire.c - the steps from photographs to a capture folder
#include "capture/acquire/acquire.h"

#include "capture/acquire/photometric.h"
#include "capture/acquire/refine.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outdir.h"
#include "core/base/outfile.h"
#include "core/base/params.h"
#include "core/base/tree.h"
#include "core/math/sort.h"
#include "image/geometry/geometry.h"
#include "image/image/image.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double SENSOR_MM = 36.0;      // width of the frame that focal lengths are given for
static const double OUTLIER = 3.0;         // times what photographs usually miss
static const double LOW = 0.1;             // z: lights below show little but rims
static const double CONTRADICTION = 0.10;  // of the albedo; matte scenes with right lights: 0.04

relume_status acquire_drop(struct acquisition *s, int i, bool allowed, const char *format, ...)
{
    char text[1024];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (!allowed)
        return log_fail(s->p.log, RELUME_EUNFIT, "%s", text);
    const char *path = s->shot[i].path;
    char *image = s->dir ? mem_format("%s/%s", outdir_path(s->dir), s->shot[i].name) : NULL;
    if (s->dir && !image)
        return RELUME_ENOMEM;
    if (image)
        unlink(image);
    mem_free(image);
    changed_picture_free(&s->shot[i].changed);
    const relume_status status = acquire_warn(s, "%s: left out: %s", path, text);
    relume_image_destroy(&s->shot[i].small);
    relume_image_destroy(&s->shot[i].luma);
    memmove(&s->shot[i], &s->shot[i + 1], (size_t)(s->shots - i - 1) * sizeof *s->shot);
    s->shots--;
    s->out->left_out++;
    if (!status && s->shots < 3)
        return log_fail(s->p.log, RELUME_EUNFIT,
                        "%s: left out: %s; fewer than 3 photographs are left", path, text);
    return status;
}

// ---------------------------------------------------------------- results

void relume_acquisition_destroy(struct relume_acquisition *acquisition)
{
    for (int i = 0; acquisition->photo && i < acquisition->lights; i++)
        mem_free(acquisition->photo[i].path);
    for (int i = 0; i < acquisition->warnings; i++)
        mem_free(acquisition->warning[i]);
    mem_free(acquisition->photo);
    mem_free(acquisition->direction);
    mem_free(acquisition->position);
    mem_free(acquisition->intensity);
    mem_free(acquisition->ball);
    mem_free(acquisition->warning);
    mem_free(acquisition->target);
    relume_photometric_destroy(&acquisition->photometric);
    *acquisition = (struct relume_acquisition){0};
}

static relume_status alloc_result(struct acquisition *s)
{
    struct relume_acquisition *out = s->out;
    const size_t n = (size_t)s->shots;
    out->photo = mem_zeroed(n, sizeof *out->photo);
    out->direction = mem_array(n, sizeof *out->direction);
    out->position = s->p.near ? mem_array(n, sizeof *out->position) : NULL;
    out->intensity =
        s->has_intensities || acquire_refines(s) ? mem_array(n, sizeof *out->intensity) : NULL;
    if (!out->photo || !out->direction || (s->p.near && !out->position) ||
        ((s->has_intensities || acquire_refines(s)) && !out->intensity))
        return RELUME_ENOMEM;
    out->lights = s->shots;
    return RELUME_OK;
}

static relume_status fill_result(struct acquisition *s)
{
    struct relume_acquisition *out = s->out;
    double squares = 0.0;
    out->width = s->width;
    out->height = s->height;
    const relume_status status = alloc_result(s);
    for (int i = 0; !status && i < s->shots; i++) {
        const struct shot *from = &s->shot[i];
        out->photo[i] = (struct relume_acquired_photo){
            .path = mem_text(from->path),
            .saturated = from->saturated,
            .black = from->black,
            .similarity = from->similarity,
            .sharpness = from->sharpness,
            .shift = {from->shift[0], from->shift[1]},
            .light = from->light,
            .sigma_deg = from->sigma_deg,
            .outlier = from->misfit,
        };
        if (!out->photo[i].path)
            return RELUME_ENOMEM;
        squares += from->sigma_deg * from->sigma_deg / s->shots;
        out->direction_error_deg = sqrt(squares);
        out->direction[i] = s->p.near ? vec3_unit(from->position) : from->direction;
        if (out->position) {
            out->position[i] = from->position;
            out->position_error += from->position_sigma / vec3_length(from->position) / s->shots;
        }
        for (int c = 0; out->intensity && c < 3; c++)
            out->intensity[i][c] = s->has_intensities ? fmaxf(from->intensity[c], 1e-6f) : 1.0f;
    }
    return status;
}

// ---------------------------------------------------------------- the folder

static struct relume_geometry geometry_of(const struct acquisition *s)
{
    struct relume_geometry g = relume_geometry_default(RELUME_PLANAR, s->whole[0], s->whole[1]);
    const struct relume_rect part = acquire_part(s);
    if (part.width)
        geometry_crop(&g, s->whole[0], s->whole[1], &part);
    g.perspective = s->p.fov_deg > 0.0;
    if (g.perspective)
        g.camera_z = 1.0 / tan(s->p.fov_deg * M_PI / 360.0);
    return g;
}

static bool is_display_coded(const struct acquisition *s)
{
    bool coded = s->p.transfer.curve != RELUME_CURVE_LINEAR;
    for (int i = 0; i < s->shots; i++)
        coded = coded && !s->shot[i].notes.linear && !s->shot[i].notes.floats;
    return coded;
}

relume_status acquire_describe(const struct acquisition *s,
                               relume_status (*use)(void *, const struct relume_manifest *),
                               void *context)
{
    const char **images = mem_array((size_t)s->shots, sizeof *images);
    if (!images)
        return RELUME_ENOMEM;
    for (int i = 0; i < s->shots; i++)
        images[i] = s->shot[i].name;
    char *provenance = acquire_provenance(s);
    const struct relume_manifest_view view = {.images = images,
                                              .mask = s->p.mask ? "mask.exr" : NULL};
    const struct relume_manifest m = {
        .transfer = {.curve = RELUME_CURVE_LINEAR},
        .geometry = geometry_of(s),
        .lights = s->shots,
        .directions = s->out->direction,
        .positions = s->out->position,
        .display_coded = is_display_coded(s),
        .intensities = (const float(*)[3])s->out->intensity,
        .views = 1,
        .view = &view,
        .provenance = provenance,
    };
    const relume_status status = provenance ? use(context, &m) : RELUME_ENOMEM;
    mem_free(provenance);
    mem_free(images);
    return status;
}

struct writing {
    const struct acquisition *s;
    const char *path;
};

static relume_status write_text(void *context, const struct relume_manifest *m)
{
    const struct writing *w = context;
    return relume_manifest_write(m, w->path, w->s->p.log);
}

static relume_status write_manifest(const struct acquisition *s, const char *path)
{
    return acquire_describe(s, write_text, &(struct writing){s, path});
}

static void print_lp(const void *context, FILE *f)
{
    const struct acquisition *s = context;
    fprintf(f, "%d\n", s->shots);
    for (int i = 0; i < s->shots; i++) {
        const vec3 d = s->out->direction[i];
        fprintf(f, "%s %.7f %.7f %.7f\n", s->shot[i].name, d.x, d.y, d.z);
    }
}

static relume_status write_lp(const struct acquisition *s, const char *path)
{
    return relume_file_print(path, print_lp, s, s->p.log);
}

relume_status acquire_load_mask(struct relume_image *out, const struct acquisition *s)
{
    const struct relume_transfer as_stored = {.curve = RELUME_CURVE_LINEAR};
    *out = (struct relume_image){0};
    if (!s->p.mask)
        return RELUME_OK;
    relume_status status = relume_image_load(
        out, s->p.mask, relume_image_params(.log = s->p.log, .channels = 1, .transfer = as_stored));
    if (!status && (out->width != s->whole[0] || out->height != s->whole[1]))
        status = log_fail(s->p.log, RELUME_EUNFIT, "%s: %d x %d pixels; expected %d x %d",
                          s->p.mask, out->width, out->height, s->whole[0], s->whole[1]);
    const struct relume_rect part = acquire_part(s);
    if (!status && part.width)
        status = image_crop(out, &part);
    if (status)
        relume_image_destroy(out);
    return status;
}

static relume_status copy_mask(const struct acquisition *s, const char *path)
{
    struct relume_image mask;
    relume_status status = acquire_load_mask(&mask, s);
    if (mask.data)
        status = relume_image_save(&mask, path, relume_image_params(.log = s->p.log, .half = true));
    relume_image_destroy(&mask);
    return status;
}

// Call `write` with a path in the folder.
static relume_status in_folder(const struct acquisition *s, const char *name,
                               relume_status (*write)(const struct acquisition *, const char *))
{
    char *path = mem_format("%s/%s", outdir_path(s->dir), name);
    const relume_status status = path ? write(s, path) : RELUME_ENOMEM;
    mem_free(path);
    return status;
}

static relume_status describe(const struct acquisition *s)
{
    relume_status status = in_folder(s, "mask.exr", copy_mask);
    if (!status)
        status = in_folder(s, "capture.json", write_manifest);
    return status ? status : in_folder(s, "lights.lp", write_lp);
}

// ---------------------------------------------------------------- what the images say

static relume_status refine(struct acquisition *s, const relume_capture *capture)
{
    struct relume_acquisition *out = s->out;
    double residual[2], curl[2] = {0.0, 0.0};
    double *bright = mem_array((size_t)out->lights, sizeof *bright);
    const struct relume_acquire_refine_params p = {
        .log = s->p.log,
        .threads = s->p.threads,
        .brightness = s->p.refine_brightness,
        .integrable = s->p.integrable,
        .curl = curl,
    };
    relume_status status =
        bright ? relume_acquire_refine(out->direction, bright, residual, capture, &p)
               : RELUME_ENOMEM;
    for (int i = 0; !status && i < out->lights; i++)
        for (int c = 0; c < 3; c++)
            out->intensity[i][c] *= (float)bright[i];
    mem_free(bright);
    if (status || residual[1] == residual[0])  // they stay, and that has been said
        return status ? status : describe(s);
    log_line(s->p.log, RELUME_NOTE, "%s refined: brightness error %.1f %%, %.1f %% before",
             s->p.refine_brightness ? "brightness" : "lights", 100.0 * residual[1],
             100.0 * residual[0]);
    if (s->p.integrable)
        log_line(s->p.log, RELUME_NOTE,
                 "lights refined: the surface's curl is %.3f of its curvature, %.3f before",
                 curl[1], curl[0]);
    return describe(s);
}

// What matte surfaces miss under a light, of their albedo, mean over the lights.
static double mean_miss(const struct relume_photometric *p)
{
    double sum = 0.0;
    for (int i = 0; i < p->lights; i++)
        sum += p->light_residual[i] / p->lights;
    return sum;
}

static relume_status name_power(struct acquisition *s, int i)
{
    const double miss = s->out->photometric.light_residual[i];
    const double gain = s->out->photometric.light_gain[i];
    return acquire_warn_alike(
        s, ALIKE_POWER, miss,
        "lamp %d (%s) is %.0f %% %s than expected; --refine-brightness measures each lamp", i + 1,
        path_name(s->shot[i].path), 100.0 * fabs(gain - 1.0), gain < 1.0 ? "dimmer" : "brighter");
}

static relume_status name_misfit(struct acquisition *s, int i, double usual)
{
    const double miss = s->out->photometric.light_residual[i];
    return acquire_warn_alike(
        s, ALIKE_MISFIT, miss,
        "%s does not fit its light: %.0f %% brightness error, the others %.0f %%; moved, "
        "damaged, or a lamp elsewhere or dimmer (--refine-lights)?",
        s->shot[i].path, 100.0 * miss, 100.0 * usual);
}

// Names photographs that contradict their lights. Where one factor mends each of them, lamps have
// other powers. A large factor is more likely a wrong direction. If two photographs were exchanged,
// a factor may mend one.
static relume_status name_outliers(struct acquisition *s)
{
    const struct relume_photometric *p = &s->out->photometric;
    double *sorted = mem_copy(p->light_residual, (size_t)p->lights, sizeof *sorted);
    if (!sorted)
        return RELUME_ENOMEM;
    sort_doubles(sorted, (size_t)p->lights);
    const double usual = sorted[p->lights / 2];
    bool powers = true;
    mem_free(sorted);
    for (int i = 0; i < p->lights; i++) {
        const double miss = p->light_residual[i], gain = p->light_gain[i];
        const bool outlier =
            s->out->direction[i].z > LOW && miss > fmax(OUTLIER * usual, CONTRADICTION);
        s->out->photo[i].outlier = outlier;
        powers &= !outlier || (p->mended_residual[i] < fmax(2.0 * usual, 0.5 * miss) &&
                               gain > 0.5 && gain < 2.0);
    }
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < p->lights; i++)
        if (s->out->photo[i].outlier)
            status = powers ? name_power(s, i) : name_misfit(s, i, usual);
    return status;
}

relume_status acquire_fit(struct acquisition *s, const relume_capture *capture)
{
    struct relume_acquisition *out = s->out;
    if (!s->dir && (s->coplanar || s->judged))  // it has nothing to say
        return RELUME_OK;
    relume_status status =
        !acquire_keeps_surface(s) && s->width > s->shot[0].small.width
            ? acquire_fit_small(s, capture)
            : relume_photometric_fit(
                  &out->photometric, capture, 0,
                  relume_photometric_params(.log = s->p.log, .threads = s->p.threads));
    if (status == RELUME_EUNFIT)  // the lights do not allow it; that has been said
        return RELUME_OK;
    if (!status && !s->judged)
        status = name_outliers(s);
    if (!status && !s->judged && mean_miss(&out->photometric) > CONTRADICTION)
        status = acquire_warn(
            s,
            "the photographs do not fit the lights: %.0f %% brightness error; wrong order, lamps "
            "of unequal brightness (--refine-brightness), or linear photographs (--transfer "
            "linear)?",
            100.0 * mean_miss(&out->photometric));
    return status;
}

static relume_status open_and(struct acquisition *s,
                              relume_status (*use)(struct acquisition *, const relume_capture *))
{
    relume_capture *capture;
    relume_status status =
        relume_capture_open(&capture, outdir_path(s->dir), relume_capture_params(.log = s->p.log));
    if (!status)
        status = use(s, capture);
    relume_capture_destroy(&capture);
    return status;
}

relume_status acquire_look(struct acquisition *s)
{
    relume_status status = acquire_read(s);
    if (!status)
        status = acquire_check_pictures(s);
    if (!status)
        status = acquire_sum_files(s);
    if (!status)
        acquire_say_alike(s);
    if (!status)
        status = acquire_find_lights(s);
    if (!status)
        status = acquire_leave_black_out(s);
    if (!status)
        status = acquire_whiten(s);
    if (!status)
        status = acquire_judge(s);
    if (!status)
        status = acquire_check_blacks(s);
    if (!status)
        status = acquire_check_relief(s);
    for (int i = 0; i < s->shots; i++)
        relume_image_destroy(&s->shot[i].luma);
    if (!status)
        status = acquire_crop(s);
    if (!status)
        status = fill_result(s);
    return status ? status : acquire_check_lights(s);
}

static relume_status fill_folder(struct acquisition *s)
{
    relume_status status = acquire_look(s);
    if (!status)
        status = describe(s);
    if (!status && acquire_refines(s))
        status = open_and(s, refine);
    if (!status)
        status = open_and(s, acquire_fit);
    if (!status)
        acquire_say_alike(s);
    return status ? status : acquire_report(s, outdir_path(s->dir));
}

// The last number in a file's name, -1 where there is none.
static long number_of(const char *path)
{
    const char *name = path_name(path), *dot = strrchr(name, '.');
    const char *at = dot ? dot : name + strlen(name);
    while (at > name && !isdigit((unsigned char)at[-1]))
        at--;
    while (at > name && isdigit((unsigned char)at[-1]))
        at--;
    return isdigit((unsigned char)*at) ? strtol(at, NULL, 10) : -1;
}

static bool has_number(const char *const *list, int n, long number)
{
    for (int i = 0; i < n; i++)
        if (number_of(list[i]) == number)
            return true;
    return false;
}

// What of `list` has a number that none of `others` has; NULL unless that is all that is too many.
static const char *odd_one(const char *const *list, int n, const char *const *others, int m)
{
    const char *odd = NULL;
    int count = 0;
    for (int i = n - 1; i >= 0; i--)
        if (!has_number(others, m, number_of(list[i]))) {
            odd = list[i];
            count++;
        }
    return count == n - m ? odd : NULL;
}

static relume_status check_balls(const struct acquisition *s)
{
    const char *const *ball_list = (const char *const *)s->balls.path;
    const char *const *object_list = (const char *const *)s->photographs.path;
    const int balls = s->balls.count, objects = s->photographs.count;
    if (!s->p.ball_photograph_count || balls == objects)
        return RELUME_OK;
    const bool more = balls > objects;
    const char *odd = more ? odd_one(ball_list, balls, object_list, objects)
                           : odd_one(object_list, objects, ball_list, balls);
    const char *what = more ? "photograph of the object" : "photograph of the ball";
    if (balls == 1)
        return log_fail(s->p.log, RELUME_EUNFIT,
                        "1 photograph of the ball, %d of the object; expected one for each; name "
                        "those of the object first, then --ball-photos and those of the ball",
                        objects);
    if (odd)
        return log_fail(s->p.log, RELUME_EUNFIT,
                        "%s: there is no %s with this number; expected one for each; found %d of "
                        "the ball, %d of the object",
                        odd, what, balls, objects);
    return log_fail(s->p.log, RELUME_EUNFIT,
                    "%d photographs of the ball; expected %d, one for each of the object", balls,
                    objects);
}

// ---------------------------------------------------------------- parameters

// Returns a sentence about members that need or exclude each other, NULL where all agree.
static const char *find_conflict(const struct relume_acquire_params *p)
{
    if (p->crop_auto && (p->crop[2] || p->crop[3]))
        return "expected one of --crop x,y,w,h and --crop auto";
    if (p->fov_deg > 0.0 && p->focal_mm > 0.0)
        return "expected one of --fov and --focal";
    if (p->refine_brightness && p->refine_lights)
        return "expected one of --refine-lights, which refines brightness as well, and "
               "--refine-brightness";
    if (p->ball_transfer.curve != RELUME_CURVE_AUTO && !p->ball_photograph_count)
        return "--ball-transfer needs --ball-photos; for the photographs themselves use "
               "--transfer";
    if (p->near && p->distant)
        return "expected one of --near and --distant";
    if (p->integrable && !p->refine_lights)
        return "--integrable needs --refine-lights";
    if (p->radial && !p->flat_count)
        return "--radial needs --flat FILE";
    if (p->white[2] && p->target)
        return "expected one of --white and --target, which gives the white balance as well";
    if (p->target_values && !p->target)
        return "--target-values needs --target FILE";
    if (p->target_corner && !p->target)
        return "--target-corners needs --target FILE";
    if (p->width_mm > 0.0 && !p->height)
        return "--width needs --height FILE";
    return NULL;
}

relume_status acquire_check_params(const struct relume_acquire_params *p)
{
    const char *conflict = find_conflict(p);
    return conflict ? log_fail(p->log, RELUME_EINVAL, "capture: %s", conflict) : RELUME_OK;
}

// Compares the params with the photographs and lights that were found.
static relume_status check_inputs(const struct acquisition *s)
{
    const struct relume_acquire_params *p = &s->p;
    const int count = s->photographs.count;
    if (count < 3)
        return log_fail(p->log, RELUME_EUNFIT, "%d photograph%s; expected at least 3", count,
                        relume_plural(count));
    const relume_status status = check_balls(s);
    if (status)
        return status;
    if (s->flats.count > 1 && s->flats.count != count)
        return log_fail(p->log, RELUME_EUNFIT,
                        "%d flat fields; expected 1, or %d as photographs, each under its light",
                        s->flats.count, count);
    if (p->white[2] && p->matte && !p->lights)
        return log_fail(
            p->log, RELUME_EINVAL,
            "--white: the matte ball shows the lamps' colour already; leave out --white");
    if (p->refine_lights && p->near)
        return log_fail(p->log, RELUME_EINVAL,
                        "--refine-lights: the directions of near lights cannot be refined; "
                        "--refine-brightness finds the power of each lamp");
    return RELUME_OK;
}

// ---------------------------------------------------------------- the call

void acquire_release(struct acquisition *s)
{
    for (int i = 0; s->shot && i < s->shots; i++) {
        changed_picture_free(&s->shot[i].changed);
        relume_image_destroy(&s->shot[i].small);
        relume_image_destroy(&s->shot[i].luma);
    }
    mem_free(s->shot);
    mem_free(s->given_index);
    relume_image_destroy(&s->first);
    relume_image_destroy(&s->gain);
    relume_image_destroy(&s->grey);
    relume_image_destroy(&s->mean);
    relume_image_destroy(&s->peak);
    relume_image_destroy(&s->change);
    relume_photographs_free(&s->photographs);
    relume_photographs_free(&s->balls);
    relume_photographs_free(&s->flats);
}

static relume_status list_shots(struct acquisition *s)
{
    s->shot = mem_zeroed((size_t)s->photographs.count, sizeof *s->shot);
    if (!s->shot)
        return RELUME_ENOMEM;
    s->shots = s->photographs.count;
    for (int i = 0; i < s->shots; i++) {
        s->shot[i].number = i;
        s->shot[i].sharpness = s->shot[i].similarity = NAN;
        s->shot[i].path = s->photographs.path[i];
        s->shot[i].ball_path = s->balls.count ? s->balls.path[i] : NULL;
    }
    return RELUME_OK;
}

static relume_status make_folder(struct acquisition *s, const char *dir)
{
    relume_status status = outdir_open(&s->dir, dir, s->p.force, s->p.log);
    if (!status)
        status = fill_folder(s);
    return outdir_end(&s->dir, status);
}

relume_status acquire_begin(struct acquisition *s, const char *const *photographs, int count)
{
    relume_status status = acquire_check_params(&s->p);
    if (s->p.focal_mm > 0.0)
        s->p.fov_deg = 2.0 * atan(SENSOR_MM / 2.0 / s->p.focal_mm) * 180.0 / M_PI;
    if (!status)
        status = acquire_find_inputs(s, photographs, count);
    if (!status)
        status = acquire_read_target(s);
    if (!status)
        status = check_inputs(s);
    return status ? status : list_shots(s);
}

relume_status relume_capture_photographs(const char *dir, const char *const *photographs, int count,
                                         const struct relume_acquire_params *params,
                                         struct relume_acquisition *report)
{
    struct relume_acquisition unread = {0}, *out = report ? report : &unread;
    struct acquisition s = {.p = PARAMS_WORK(relume_acquire_params, params), .out = out};
    *out = (struct relume_acquisition){0};
    relume_status status = acquire_begin(&s, photographs, count);
    if (!status)
        status = make_folder(&s, dir);
    if (!status)
        status = acquire_write_products(&s);
    acquire_release(&s);
    if (status || !report)
        relume_acquisition_destroy(out);
    return status;
}
