// panorama_stitch.c - overlapping photographs of one viewpoint become a sphere
//
// Poses and gains come from the mean over lights (stitch.h). A direction belongs to the photograph
// that shows it farthest from its rim; every light is then warped alike and blended by bands
// (blend.h), in linear light, so that sums of lights stay sums.
#include "capture/multiview/panorama.h"
#include "core/math/bilinear.h"

#include "capture/multiview/blend.h"
#include "capture/multiview/stitch.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"
#include "core/math/luminance.h"
#include "core/math/vec.h"

#include <string.h>

enum { MOST_WIDTH = 16384 };
// How strongly gains are pulled towards 1.
static const double gain_pull = 1e-3;

struct stitching {
    struct panorama_job *job;
    int n;
    struct stitch_picture *picture;  // [n], the mean over lights
    struct stitch_pose *pose;
    double *gain;  // [n]
    struct blend blend;
    double *azimuth;                   // [2 * width], sine and cosine of each column
    const struct relume_image *image;  // a photograph under one light
};

// ---------------------------------------------------------------- poses

static relume_status mean_picture(uint8_t *grey, const struct panorama_job *job, int camera)
{
    const size_t n = (size_t)job->set.width * (size_t)job->set.height;
    float *sum = mem_zeroed(n, sizeof *sum);
    relume_status status = sum ? RELUME_OK : RELUME_ENOMEM;
    for (int k = 0; k < job->set.lights && !status; k++) {
        struct relume_image image;
        status = panorama_load(&image, job, camera, k);
        for (size_t i = 0; !status && i < n; i++)
            sum[i] += luminance_709f(image.data + 3 * i) / (float)job->set.lights;
        relume_image_destroy(&image);
    }
    for (size_t i = 0; !status && i < n; i++)
        grey[i] = (uint8_t)lrintf(255.0f * sqrtf(fminf(fmaxf(sum[i], 0.0f), 1.0f)));
    mem_free(sum);
    return status;
}

static relume_status mean_pictures(struct stitching *s)
{
    const struct photo_set *set = &s->job->set;
    const size_t pixels = (size_t)set->width * (size_t)set->height;
    relume_status status = RELUME_OK;
    for (int i = 0; i < s->n && !status; i++) {
        uint8_t *grey = arena_array(&s->job->set.arena, pixels, 1);
        s->picture[i] = (struct stitch_picture){set->width, set->height, grey};
        status = grey ? mean_picture(grey, s->job, i) : RELUME_ENOMEM;
        if (!status && !log_progress(s->job->common->log, "reading", (i + 1.0) / s->n))
            status = RELUME_ECANCEL;
    }
    return status;
}

static vec3 column(const struct stitch_pose *p, int k)
{
    return vec3_of(p->rotation[k], p->rotation[3 + k], p->rotation[6 + k]);
}

// Turn all so that the first photograph looks along azimuth 0, which is -z.
static void face_ahead(struct stitching *s)
{
    const vec3 ahead = column(&s->pose[0], 2);
    const double length = hypot(ahead.x, ahead.z);
    if (length < 1e-6)
        return;
    const double c = -ahead.z / length, sine = ahead.x / length;
    for (int i = 0; i < s->n; i++)
        for (int k = 0; k < 3; k++) {
            double *r = s->pose[i].rotation;
            const double x = r[k], z = r[6 + k];
            r[k] = c * x + sine * z;
            r[6 + k] = c * z - sine * x;
        }
}

static relume_status find_poses(struct stitching *s)
{
    char why[300] = "";
    int stray = -1;
    const struct relume_log *log = s->job->common->log;
    const relume_status status = stitch_find(s->pose, &stray, why, s->picture, s->n, log);
    if (status == RELUME_EUNFIT)
        return log_fail(log, status, "%s: %s", s->job->set.camera[stray > 0 ? stray : 0].name, why);
    if (!status)
        face_ahead(s);
    return status;
}

// ---------------------------------------------------------------- gains

// Where a camera shows a direction, and how many pixels from its picture's rim: negative beyond.
static double look(double xy[2], const struct stitching *s, int camera, vec3 d)
{
    const struct stitch_pose *p = &s->pose[camera];
    const double z = vec3_dot(d, column(p, 2)), ahead = fmax(z, 1e-3);
    xy[0] = p->focal * vec3_dot(d, column(p, 0)) / ahead + p->center[0];
    xy[1] = p->focal * vec3_dot(d, column(p, 1)) / ahead + p->center[1];
    if (z < ahead)
        return (z - 2.0) * 1e9;
    return fmin(fmin(xy[0], s->job->set.width - 1 - xy[0]),
                fmin(xy[1], s->job->set.height - 1 - xy[1]));
}

static bool project(double xy[2], const struct stitching *s, int camera, vec3 d)
{
    return look(xy, s, camera, d) >= 0.0;
}

// Mean linear grey of 9 x 9 pixels; negative where some are too dark or too bright to measure.
static double grey_around(const struct stitch_picture *p, const double xy[2])
{
    enum { REACH = 4, DARK = 8, BRIGHT = 250 };
    const int x = relume_whole(xy[0]), y = relume_whole(xy[1]);
    if (x < REACH || y < REACH || x + REACH >= p->width || y + REACH >= p->height)
        return -1.0;
    double sum = 0.0;
    for (int j = y - REACH; j <= y + REACH; j++)
        for (int i = x - REACH; i <= x + REACH; i++) {
            const int g = p->grey[(size_t)j * (size_t)p->width + (size_t)i];
            if (g < DARK || g > BRIGHT)
                return -1.0;
            sum += (double)g * g;
        }
    return sum;
}

// Pairs of photographs that show one direction: log gain_i - log gain_k = log (value_k / value_i).
static void add_direction(double *matrix, double *right, const struct stitching *s, vec3 d)
{
    const size_t n = (size_t)s->n;
    for (size_t i = 0; i < n; i++) {
        double xy[2];
        if (!project(xy, s, (int)i, d))
            continue;
        const double value = grey_around(&s->picture[i], xy);
        for (size_t k = 0; k < i && value > 0.0; k++) {
            if (!project(xy, s, (int)k, d))
                continue;
            const double other = grey_around(&s->picture[k], xy);
            if (!(other > 0.0))
                continue;
            const double ratio = log(other / value);
            matrix[i * n + i] += 1.0;
            matrix[k * n + k] += 1.0;
            matrix[i * n + k] -= 1.0;
            matrix[k * n + i] -= 1.0;
            right[i] += ratio;
            right[k] -= ratio;
        }
    }
}

// Least squares over directions a degree or so apart.
static relume_status find_gains(struct stitching *s)
{
    enum { DIRECTIONS = 40000 };
    const size_t n = (size_t)s->n;
    double *matrix = mem_zeroed(n * n, sizeof *matrix);
    if (!matrix)
        return RELUME_ENOMEM;
    memset(s->gain, 0, n * sizeof *s->gain);
    for (int i = 0; i < DIRECTIONS; i++) {
        const double y = 1.0 - (2.0 * i + 1.0) / DIRECTIONS, r = sqrt(1.0 - y * y);
        const double phi = i * M_PI * (3.0 - sqrt(5.0));
        add_direction(matrix, s->gain, s, vec3_of(r * sin(phi), y, -r * cos(phi)));
    }
    for (size_t i = 0; i < n; i++)
        matrix[i * n + i] += gain_pull * (1.0 + matrix[i * n + i]);
    const bool solved = lsq_solve(matrix, s->n, s->gain, 1);
    for (size_t i = 0; i < n; i++)
        s->gain[i] = solved ? exp(s->gain[i]) : 1.0;
    mem_free(matrix);
    return RELUME_OK;
}

// ---------------------------------------------------------------- warping

static vec3 direction(const struct stitching *s, int x, double elevation)
{
    const double across = cos(elevation);
    return vec3_of(across * s->azimuth[2 * x], sin(elevation), -across * s->azimuth[2 * x + 1]);
}

static double elevation_of(const struct stitching *s, int y)
{
    return (0.5 - (y + 0.5) / s->blend.height) * M_PI;
}

static void find_owners(void *context, size_t item, int worker)
{
    const struct stitching *s = context;
    const double elevation = elevation_of(s, (int)item);
    (void)worker;
    for (int x = 0; x < s->blend.width; x++) {
        const vec3 d = direction(s, x, elevation);
        double xy[2], best = -INFINITY;
        int owner = 0;
        for (int i = 0; i < s->n; i++) {
            const double inside = look(xy, s, i, d);
            owner = inside > best ? i : owner;
            best = fmax(best, inside);
        }
        s->blend.owner[item * (size_t)s->blend.width + (size_t)x] =
            (uint16_t)(owner | (best < 0.0 ? BLEND_UNSEEN : 0));
    }
}

static void fetch(float *rgba, const void *context, int camera, int x, int y, int n)
{
    const struct stitching *s = context;
    const double elevation = elevation_of(s, y);
    const float gain = (float)s->gain[camera];
    for (int i = 0; i < n; i++) {
        double xy[2];
        look(xy, s, camera, direction(s, (x + i) % s->blend.width, elevation));
        xy[0] = fmin(fmax(xy[0], 0.0), s->image->width - 1);
        xy[1] = fmin(fmax(xy[1], 0.0), s->image->height - 1);
        const struct bilinear b =
            bilinear_at(xy[0], xy[1], s->image->width, s->image->height, EDGE_CLAMPED);
        for (size_t c = 0; c < 3; c++)
            rgba[4 * i + (int)c] = gain * bilinear_valuef(&b, s->image->data, 3, c);
    }
}

static relume_status warp_light(struct stitching *s, struct relume_image *out, int light)
{
    relume_status status = RELUME_OK;
    memset(out->data, 0, 3 * (size_t)out->width * (size_t)out->height * sizeof *out->data);
    for (int i = 0; i < s->n && !status; i++) {
        struct relume_image image;
        status = panorama_load(&image, s->job, i, light);
        s->image = &image;
        if (!status)
            status = blend_add(out->data, &s->blend, i, fetch, s, s->job->common->threads);
        relume_image_destroy(&image);
        s->image = NULL;
    }
    if (!status)
        blend_finish(out->data, &s->blend);
    return status;
}

// The coarsest band is as smooth as a Gaussian of a sixteenth of a photograph's shorter side, which
// goes over within an overlap of a quarter.
static int default_bands(const struct stitching *s)
{
    const double side = fmin(s->job->set.width, s->job->set.height) / s->pose[0].focal;
    const double pixels = side * s->blend.width / (2.0 * M_PI);
    return 1 + (int)fmin(fmax(log2(pixels / 16.0), 0.0), BLEND_BANDS - 1);
}

static relume_status share_out(struct stitching *s)
{
    struct blend *b = &s->blend;
    const size_t width = (size_t)s->job->width, height = (size_t)s->job->height;
    *b = (struct blend){.width = s->job->width, .height = s->job->height, .pictures = s->n};
    b->bands = s->job->p->bands ? s->job->p->bands : default_bands(s);
    b->owner = arena_array(&s->job->set.arena, width * height, sizeof *b->owner);
    s->azimuth = arena_array(&s->job->set.arena, 2 * width, sizeof *s->azimuth);
    if (!b->owner || !s->azimuth)
        return RELUME_ENOMEM;
    for (size_t x = 0; x < width; x++) {
        const double phi = (((double)x + 0.5) / (double)width * 2.0 - 1.0) * M_PI;
        s->azimuth[2 * x] = sin(phi);
        s->azimuth[2 * x + 1] = cos(phi);
    }
    thread_for(s->job->common->threads, height, find_owners, s);
    return blend_begin(b);
}

static void say_coverage(const struct stitching *s)
{
    const size_t n = (size_t)s->blend.width * (size_t)s->blend.height;
    size_t covered = 0;
    for (size_t i = 0; i < n; i++)
        covered += !(s->blend.owner[i] & BLEND_UNSEEN);
    log_line(s->job->common->log, RELUME_NOTE,
             "%d photographs of %.1f degrees cover %.0f %% of the sphere's picture, blended in %d "
             "bands; the rest is black",
             s->n, 360.0 / M_PI * atan(0.5 * s->job->set.width / s->pose[0].focal),
             100.0 * (double)covered / (double)n, s->blend.bands);
}

static relume_status warp_lights(struct stitching *s)
{
    struct panorama_job *job = s->job;
    struct relume_image out;
    relume_status status = relume_image_create(&out, job->width, job->height, 3);
    if (!status)
        status = share_out(s);
    for (int k = 0; k < job->set.lights && !status; k++) {
        status = warp_light(s, &out, k);
        if (!status)
            status = panorama_picture_name(job, k) ? save_inside(job->folder, job->view.images[k],
                                                                 &out, true, job->common->log)
                                                   : RELUME_ENOMEM;
        if (!status && !log_progress(job->common->log, "warping", (k + 1.0) / job->set.lights))
            status = RELUME_ECANCEL;
    }
    if (!status)
        say_coverage(s);
    mem_free(s->blend.box);
    relume_image_destroy(&out);
    return status;
}

// ---------------------------------------------------------------- all

static void choose_size(struct stitching *s)
{
    struct panorama_job *job = s->job;
    const int fitting = (int)fmin(2.0 * M_PI * s->pose[0].focal, MOST_WIDTH);
    job->height = (job->p->width ? job->p->width : fitting) / 2;
    job->height = job->height < 1 ? 1 : job->height;
    job->width = 2 * job->height;
    job->geometry = relume_geometry_default(RELUME_SPHERICAL, job->width, job->height);
    job->transfer = (struct relume_transfer){.curve = RELUME_CURVE_LINEAR};
}

relume_status panorama_from_stitch(struct panorama_job *job)
{
    const size_t n = (size_t)job->set.count;
    struct arena *a = &job->set.arena;
    struct stitching s = {
        .job = job,
        .n = job->set.count,
        .picture = arena_array(a, n, sizeof *s.picture),
        .pose = arena_array(a, n, sizeof *s.pose),
        .gain = arena_array(a, n, sizeof *s.gain),
    };
    if (!s.picture || !s.pose || !s.gain)
        return RELUME_ENOMEM;
    if ((unsigned)job->p->bands > BLEND_BANDS)
        return log_fail(job->common->log, RELUME_EINVAL,
                        "blending: expected 1 to %d bands; found %d", BLEND_BANDS, job->p->bands);
    if (n > BLEND_PICTURES)
        return log_fail(job->common->log, RELUME_ELIMIT, "%zu photographs; expected at most %d", n,
                        BLEND_PICTURES);
    if (n < 2)
        return log_fail(job->common->log, RELUME_EUNFIT,
                        "%s: a single photograph; expected two or more that overlap",
                        job->set.camera[0].name);
    relume_status status = mean_pictures(&s);
    if (!status)
        status = find_poses(&s);
    if (!status)
        status = find_gains(&s);
    if (!status) {
        choose_size(&s);
        status = warp_lights(&s);
    }
    return status;
}
