// acquire_read.c - photographs become the images of the folder, one at a time
#include "capture/acquire/acquire.h"

#include "capture/acquire/ball.h"
#include "capture/hdr/structure.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outdir.h"
#include "core/math/lsq.h"

#include <relume/capture/align.h>
#include <stdio.h>
#include <string.h>

static const float WHITE = 0.998f, BLACK = 0.002f;
static const float FAINT = 2e-4f;  // about one code of 8 bits in the dark

static int step_for(int width, int height, int most)
{
    const int side = width > height ? width : height;
    return (side + most - 1) / most;
}

int acquire_small_step(int width, int height)
{
    return step_for(width, height, SHOT_SMALL);
}

// Boxes of `step` x `step` pixels, so that at most `most` are left along a side.
static relume_status shrink(struct relume_image *out, const struct relume_image *from, int most)
{
    const int step = step_for(from->width, from->height, most);
    const int w = from->width / step, h = from->height / step;
    const relume_status status = relume_image_create(out, w > 0 ? w : 1, h > 0 ? h : 1, 3);
    if (status)
        return status;
    const float share = 1.0f / (float)(step * step);
    for (int y = 0; y < h * step; y++) {
        const float *p = from->data + 3 * (size_t)y * (size_t)from->width;
        float *to = out->data + 3 * (size_t)(y / step) * (size_t)w;
        for (int x = 0; x < w; x++, to += 3) {
            float r = to[0], g = to[1], b = to[2];
            for (int i = 0; i < step; i++, p += 3)
                r += share * p[0], g += share * p[1], b += share * p[2];
            to[0] = r, to[1] = g, to[2] = b;
        }
    }
    return RELUME_OK;
}

relume_status acquire_shrink(struct relume_image *out, const struct relume_image *from)
{
    return shrink(out, from, SHOT_SMALL);
}

struct ends {
    unsigned white, black, outside;  // pixels
};

// `to_file`, or NULL where values are as the file has them.
static struct ends ends_of(const float *p, int n, const float to_file[9])
{
    struct ends e = {0, 0, 0};
    for (int i = 0; !to_file && i < n; i++, p += 3) {
        e.white += (p[0] >= WHITE) | (p[1] >= WHITE) | (p[2] >= WHITE);
        e.black += (p[0] <= BLACK) & (p[1] <= BLACK) & (p[2] <= BLACK);
    }
    for (int i = 0; to_file && i < n; i++, p += 3) {
        bool white = false, outside = false;
        for (int c = 0; c < 3; c++) {
            const float *m = to_file + 3 * c;
            white |= m[0] * p[0] + m[1] * p[1] + m[2] * p[2] >= WHITE;
            outside |= (p[c] < -BLACK) | (p[c] > 1.0f + BLACK);
        }
        e.white += white;
        e.black += (p[0] <= BLACK) & (p[1] <= BLACK) & (p[2] <= BLACK);
        e.outside += outside;
    }
    return e;
}

// Counts the pixels at both ends of the code values, and those whose colour sRGB does not hold.
static relume_status count_ends(struct shot *shot, const struct relume_image *image)
{
    const size_t width = (size_t)image->width, n = width * (size_t)image->height;
    size_t white = 0, black = 0, outside = 0;
    double m[9];
    float to_file[9];
    for (int i = 0; i < 9; i++)
        m[i] = shot->notes.profile ? (double)shot->notes.to_srgb[i] : i % 4 == 0;
    const relume_status status = lsq_invert(m, 3);
    for (int i = 0; i < 9; i++)
        to_file[i] = (float)m[i];
    for (size_t y = 0; !status && y < (size_t)image->height; y++) {
        const struct ends row = ends_of(image->data + 3 * y * width, image->width,
                                        shot->notes.profile ? to_file : NULL);
        white += shot->notes.floats ? 0 : row.white;
        black += row.black;
        outside += row.outside;
    }
    shot->saturated = (float)white / (float)n;
    shot->black = (float)black / (float)n;
    shot->outside = (float)outside / (float)n;
    return status;
}

// For registration, before the photograph is moved by it, and for finding balls that a list of
// lights is compared with.
static relume_status keep_luma(struct acquisition *s, struct shot *shot,
                               const struct relume_image *image)
{
    struct relume_image small;
    if (s->again || (s->p.no_registration && !s->p.lights))
        return RELUME_OK;
    relume_status status = shrink(&small, image, acquire_luma_side(s->photographs.count));
    if (status)
        return status;
    status = structure_luma(&shot->luma, &small, s->p.threads);
    relume_image_destroy(&small);
    return status;
}

// Means of the logarithm, for finding the balls.
static relume_status add_to_mean(struct acquisition *s, const struct relume_image *image)
{
    if (!s->mean.data) {
        s->camera = (struct relume_ball_camera){
            .width = image->width,
            .height = image->height,
            .focal_px =
                s->p.fov_deg > 0.0 ? 0.5 * image->width / tan(s->p.fov_deg * M_PI / 360.0) : 0.0,
        };
        relume_status status = relume_image_create(&s->mean, image->width, image->height, 1);
        if (!status)
            status = relume_image_create(&s->peak, image->width, image->height, 1);
        if (!status)
            status = relume_image_create(&s->change, image->width, image->height, 1);
        if (status)
            return status;
    }
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            const size_t at = (size_t)y * (size_t)image->width + (size_t)x;
            const float v = ball_grey(image, x, y);
            const float off = logf(fmaxf(v, 0.0f) + FAINT) - s->mean.data[at];
            s->mean.data[at] += off / (float)(s->summed + 1);
            s->change.data[at] += off * off * (float)s->summed / (float)(s->summed + 1);
            s->peak.data[at] = v > s->peak.data[at] ? v : s->peak.data[at];
        }
    s->summed++;
    return RELUME_OK;
}

static relume_status align(struct acquisition *s, int i, struct relume_image *image)
{
    if (!s->p.align)
        return RELUME_OK;
    if (!s->first.data) {
        s->first = *image;
        s->first.data =
            mem_copy(image->data, (size_t)image->width * (size_t)image->height, 3 * sizeof(float));
        return s->first.data ? RELUME_OK : RELUME_ENOMEM;
    }
    struct relume_homography h;
    struct relume_image moved;
    relume_status status = relume_align_homography(
        &h, &s->first, image,
        &(struct relume_align_params){.log = s->p.log, .threads = s->p.threads});
    if (!status && h.correlation < 0.3)
        return acquire_warn_alike(s, ALIKE_UNALIGNED, -h.correlation,
                                  "%s: does not align with the first photograph; left as it is",
                                  s->shot[i].path);
    if (!status)
        status = relume_warp_homography(&moved, NULL, image, &h,
                                        &(struct relume_align_params){.threads = s->p.threads});
    if (!status) {
        relume_image_destroy(image);
        *image = moved;
    }
    return status;
}

relume_status acquire_save(struct acquisition *s, struct shot *shot,
                           const struct relume_image *image)
{
    if (!s->dir)
        return acquire_keep(s, shot, image);
    char *path = mem_format("%s/%s", outdir_path(s->dir), shot->name);
    const relume_status status =
        path ? relume_image_save(image, path, relume_image_params(.log = s->p.log, .half = true))
             : RELUME_ENOMEM;
    mem_free(path);
    return status;
}

relume_status acquire_fetch(struct relume_image *out, const struct acquisition *s,
                            const struct shot *shot)
{
    if (!s->dir)
        return acquire_kept(out, s, shot);
    const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};
    char *path = mem_format("%s/%s", outdir_path(s->dir), shot->name);
    const relume_status status =
        path
            ? relume_image_load(out, path, relume_image_params(.log = s->p.log, .transfer = linear))
            : RELUME_ENOMEM;
    mem_free(path);
    return status;
}

relume_status acquire_check_size(const struct acquisition *s, const struct relume_image *image,
                                 const char *path, int width, int height)
{
    if (!width || (image->width == width && image->height == height))
        return RELUME_OK;
    return log_fail(s->p.log, RELUME_EUNFIT, "%s: %d x %d pixels; expected %d x %d as before it",
                    path, image->width, image->height, width, height);
}

// What a camera that looks down notes of its orientation is chance.
relume_status acquire_load(struct relume_image *out, struct relume_exif *notes,
                           const struct acquisition *s, const char *path,
                           struct relume_transfer transfer)
{
    struct relume_photograph_params p =
        *relume_photograph_params(.log = s->p.log, .limits = s->p.limits, .transfer = transfer);
    struct relume_exif own = {0};
    notes = notes ? notes : &own;
    const relume_status status = relume_photograph_load(out, notes, path, &p);
    if (status || !s->orientation || notes->orientation == s->orientation)
        return status;
    const bool across = (notes->orientation >= 5) != (s->orientation >= 5);
    if (s->width != (across ? out->height : out->width) ||
        s->height != (across ? out->width : out->height))
        return RELUME_OK;  // turned by another program
    relume_image_destroy(out);
    p.orientation = s->orientation;
    return relume_photograph_load(out, notes, path, &p);
}

static relume_status warn_of_orientation(struct acquisition *s, const struct shot *shot)
{
    if (!s->orientation) {
        s->orientation = shot->notes.orientation;
        return RELUME_OK;
    }
    if (shot->notes.orientation == s->orientation || s->again)
        return RELUME_OK;
    return acquire_warn_alike(
        s, ALIKE_TURNED, 1.0,
        "%s: its EXIF orientation is not that of the first photograph; ignored, "
        "because the camera stands still",
        shot->path);
}

static relume_status take_ball(struct acquisition *s, int i)
{
    struct relume_image image;
    relume_status status = acquire_load_balls(&image, s, i);
    if (!status && s->mean.data)
        status = acquire_check_size(s, &image, s->shot[i].ball_path, s->mean.width, s->mean.height);
    if (!status)
        status = add_to_mean(s, &image);
    relume_image_destroy(&image);
    return status;
}

static relume_status take_photograph(struct acquisition *s, int i, struct relume_image *image)
{
    struct shot *shot = &s->shot[i];
    relume_status status = acquire_check_size(s, image, shot->path, s->width, s->height);
    if (!status && shot->ball_path)
        status = take_ball(s, i);
    if (!status)
        status = warn_of_orientation(s, shot);
    if (status)
        return status;
    s->width = s->whole[0] = image->width;
    s->height = s->whole[1] = image->height;
    status = count_ends(shot, image);
    acquire_measure_detail(shot, image);
    if (!status)
        status = acquire_flatten(s, shot, image);
    if (!status)
        acquire_correct(s, image, shot->notes.floats);
    if (!status)
        status = keep_luma(s, shot, image);
    if (!status)
        status = acquire_move_back(image, shot->shift);
    if (!status)
        status = acquire_add_grey(s, image);
    if (!status)
        status = align(s, i, image);
    if (!status)
        status = acquire_shrink(&shot->small, image);
    if (!status && !shot->ball_path && !s->p.lights)
        status = add_to_mean(s, image);
    return status ? status : acquire_save(s, shot, image);
}

// Forgets the sums and the small pictures of a first reading.
static void forget(struct acquisition *s)
{
    relume_image_destroy(&s->mean);
    relume_image_destroy(&s->peak);
    relume_image_destroy(&s->change);
    relume_image_destroy(&s->first);
    relume_image_destroy(&s->grey);
    s->summed = 0;
    for (int i = 0; i < s->shots; i++)
        relume_image_destroy(&s->shot[i].small);
}

static relume_status read_all(struct acquisition *s)
{
    relume_status status = RELUME_OK;
    const int all = s->shots;
    for (int i = 0, done = 0; !status && i < s->shots; done++) {
        struct relume_image image;
        struct shot *shot = &s->shot[i];
        if (!*shot->name)
            snprintf(shot->name, sizeof shot->name, "light%04d.exr", done);
        status = acquire_load(&image, &shot->notes, s, shot->path, s->p.transfer);
        if (!status)
            status = take_photograph(s, i, &image);
        relume_image_destroy(&image);
        if (relume_status_is_input(status) && s->p.skip_bad)
            status = acquire_drop(s, i, true, "cannot be used");
        else
            i++;
        if (!status && !log_progress(s->p.log, "reading", (done + 1.0) / all))
            status = RELUME_ECANCEL;
    }
    return status;
}

relume_status acquire_read(struct acquisition *s)
{
    bool moved = false;
    relume_status status = read_all(s);
    if (!status && s->shots < 3)
        status = log_fail(s->p.log, RELUME_EUNFIT, "%d photographs; expected at least 3", s->shots);
    if (!status && !s->p.no_registration)
        status = acquire_register(s, &moved);
    for (int i = 0; i < s->shots && !s->p.lights; i++)
        relume_image_destroy(&s->shot[i].luma);
    if (!status && moved) {
        forget(s);
        s->again = true;
        status = read_all(s);
    }
    for (size_t i = 0;
         !status && s->mean.data && i < (size_t)s->mean.width * (size_t)s->mean.height; i++) {
        s->mean.data[i] = expf(s->mean.data[i]);
        s->change.data[i] = sqrtf(s->change.data[i] / (float)s->summed);
    }
    return status;
}
