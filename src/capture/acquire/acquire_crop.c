// acquire_crop.c - a part of the photographs: as it is given, or the object, found by its relief
//
// Between two neighbouring pixels of a flat surface the ratio of brightness is the same under all
// lights, whatever is painted on it. On a relief it changes with the light. The median over the
// lights leaves out shadows on the table, which reach a pixel under few of them.
#include "capture/acquire/acquire.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/sort.h"

#include <math.h>
#include <string.h>

static const double FAINT = 0.02;   // of the bright parts: noise in the dark is no relief
static const double LEAST = 0.015;  // change of the logarithm from pixel to pixel; light that
                                    // falls off over a flat board reaches 0.01
static const double RELIEF = 0.15;  // of the strongest relief
static const double SHARE = 0.03;   // of all relief: what has less is dust or a reflection
static const double MARGIN = 0.03;  // of the object's longer side
static const double BALL = 1.3;     // radii: the rim and what the ball reflects onto the table
static const double ALL = 0.9;      // of the picture: the object fills it
enum { BLUR = 2, LEAST_SIDE = 8 };

struct map {
    int width, height;
    float *relief;
    unsigned char *ball;
};

// ---------------------------------------------------------------- relief

static double share_of(const float *value, const unsigned char *without, size_t n, double share,
                       double *sorted)
{
    size_t kept = 0;
    for (size_t i = 0; i < n; i++)
        if (!without || !without[i])
            sorted[kept++] = (double)value[i];
    if (!kept)
        return 0.0;
    sort_doubles(sorted, kept);
    return sorted[(size_t)(share * (double)(kept - 1))];
}

// Logarithms of the small photographs, [shots][height][width].
static relume_status take_logarithms(float *out, const struct acquisition *s, const struct map *m)
{
    const size_t n = (size_t)m->width * (size_t)m->height;
    double *sorted = mem_array(n, sizeof *sorted);
    if (!sorted)
        return RELUME_ENOMEM;
    for (int i = 0; i < s->shots; i++) {
        const float *from = s->shot[i].small.data;
        float *to = out + n * (size_t)i;
        for (size_t p = 0; p < n; p++)
            to[p] = (from[3 * p] + from[3 * p + 1] + from[3 * p + 2]) / 3.0f;
        const double faint = fmax(FAINT * share_of(to, NULL, n, 0.99, sorted), 1e-6);
        for (size_t p = 0; p < n; p++)
            to[p] = (float)log(fmax((double)to[p], 0.0) + faint);
    }
    mem_free(sorted);
    return RELUME_OK;
}

static double middle(double *value, int n)
{
    sort_doubles(value, (size_t)n);
    return value[n / 2];
}

// Returns the change of the step from pixel `at` to `next` between lights.
static float change(const float *log, size_t pixels, int shots, size_t at, size_t next,
                    double *step)
{
    for (int i = 0; i < shots; i++)
        step[i] = (double)log[pixels * (size_t)i + next] - (double)log[pixels * (size_t)i + at];
    const double usual = middle(step, shots);
    for (int i = 0; i < shots; i++)
        step[i] = fabs(step[i] - usual);
    return (float)middle(step, shots);
}

// Balls that stand in the photographs themselves.
static int balls_inside(const struct acquisition *s)
{
    return s->p.lights || s->balls.count ? 0 : s->out->balls;
}

static void mark_balls(struct map *m, const struct acquisition *s)
{
    const double step = acquire_small_step(s->width, s->height);
    for (int b = 0; b < balls_inside(s); b++) {
        const struct relume_ball *ball = &s->out->ball[b];
        const double far = BALL * ball->radius + BLUR * step;
        for (int y = 0; y < m->height; y++)
            for (int x = 0; x < m->width; x++)
                if (hypot((x + 0.5) * step - ball->x, (y + 0.5) * step - ball->y) < far)
                    m->ball[y * m->width + x] = 1;
    }
}

static void blur(struct map *m, float *relief)
{
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width; x++) {
            float sum = 0.0f;
            int n = 0;
            for (int v = y - BLUR; v <= y + BLUR; v++)
                for (int u = x - BLUR; u <= x + BLUR; u++)
                    if (u >= 0 && v >= 0 && u < m->width && v < m->height) {
                        const size_t at = (size_t)v * (size_t)m->width + (size_t)u;
                        sum += m->ball[at] ? 0.0f : relief[at];
                        n++;
                    }
            const size_t at = (size_t)y * (size_t)m->width + (size_t)x;
            m->relief[at] = m->ball[at] ? 0.0f : sum / (float)n;
        }
}

static relume_status find_relief(struct map *m, const struct acquisition *s)
{
    const size_t n = (size_t)m->width * (size_t)m->height;
    float *log = mem_array(n * (size_t)s->shots, sizeof *log);
    float *relief = mem_zeroed(n, sizeof *relief);
    double *step = mem_array((size_t)s->shots, sizeof *step);
    relume_status status = log && relief && step ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = take_logarithms(log, s, m);
    mark_balls(m, s);
    for (int y = 0; !status && y + 1 < m->height; y++)
        for (int x = 0; x + 1 < m->width; x++) {
            const size_t at = (size_t)y * (size_t)m->width + (size_t)x;
            relief[at] = change(log, n, s->shots, at, at + 1, step) +
                         change(log, n, s->shots, at, at + (size_t)m->width, step);
        }
    if (!status)
        blur(m, relief);
    mem_free(log);
    mem_free(relief);
    mem_free(step);
    return status;
}

// ---------------------------------------------------------------- the object

struct region {
    int left, top, right, bottom;  // the last two are outside
    double sum;
};

// Takes the region that `start` belongs to out of the map.
static struct region take_region(struct map *m, float least, int start, int *stack)
{
    struct region r = {m->width, m->height, 0, 0, 0.0};
    int count = 0;
    stack[count++] = start;
    r.sum = (double)m->relief[start];
    m->relief[start] = 0.0f;
    while (count) {
        const int at = stack[--count], x = at % m->width, y = at / m->width;
        r.left = x < r.left ? x : r.left;
        r.top = y < r.top ? y : r.top;
        r.right = x >= r.right ? x + 1 : r.right;
        r.bottom = y >= r.bottom ? y + 1 : r.bottom;
        for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < m->height; v++)
            for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < m->width; u++) {
                float *relief = &m->relief[v * m->width + u];
                if (*relief <= least)
                    continue;
                r.sum += (double)*relief;
                *relief = 0.0f;
                stack[count++] = v * m->width + u;
            }
    }
    return r;
}

static void add_region(struct region *to, const struct region *r)
{
    to->left = r->left < to->left ? r->left : to->left;
    to->top = r->top < to->top ? r->top : to->top;
    to->right = r->right > to->right ? r->right : to->right;
    to->bottom = r->bottom > to->bottom ? r->bottom : to->bottom;
    to->sum += r->sum;
}

// All regions with a share of the relief; sum 0: none.
static relume_status find_object(struct region *out, struct map *m)
{
    const size_t n = (size_t)m->width * (size_t)m->height;
    double *sorted = mem_array(n, sizeof *sorted), all = 0.0;
    int *stack = mem_array(n, sizeof *stack), regions = 0;
    struct region *region = mem_array(n, sizeof *region);
    *out = (struct region){m->width, m->height, 0, 0, 0.0};
    const relume_status status = sorted && stack && region ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        const double top = share_of(m->relief, m->ball, n, 0.98, sorted);
        const float least = (float)fmax(LEAST, RELIEF * top);
        for (size_t i = 0; i < n; i++)
            if (m->relief[i] > least) {
                region[regions] = take_region(m, least, (int)i, stack);
                all += region[regions++].sum;
            }
    }
    for (int i = 0; i < regions; i++)
        if (region[i].sum >= SHARE * all)
            add_region(out, &region[i]);
    mem_free(sorted);
    mem_free(stack);
    mem_free(region);
    return status;
}

// In pixels of the photographs, with a margin; width 0: all.
static void place_object(int crop[4], const struct acquisition *s, const struct region *r)
{
    const double step = acquire_small_step(s->width, s->height);
    const int side =
        r->right - r->left > r->bottom - r->top ? r->right - r->left : r->bottom - r->top;
    const double margin = MARGIN * side * step;
    const double from[2] = {r->left * step, r->top * step};
    const double to[2] = {fmin(r->right * step, s->width), fmin(r->bottom * step, s->height)};
    double low[2] = {fmax(from[0] - margin, 0.0), fmax(from[1] - margin, 0.0)};
    double high[2] = {fmin(to[0] + margin, s->width), fmin(to[1] + margin, s->height)};
    for (int b = 0; b < balls_inside(s); b++) {  // the margin ends at a ball
        const struct relume_ball *ball = &s->out->ball[b];
        const double at[2] = {ball->x, ball->y};
        for (int k = 0; k < 2; k++) {
            if (at[k] < from[k])
                low[k] = fmax(low[k], fmin(from[k], at[k] + ball->radius + 1.0));
            if (at[k] > to[k])
                high[k] = fmin(high[k], fmax(to[k], at[k] - ball->radius - 1.0));
        }
    }
    const int left = (int)ceil(low[0]), top = (int)ceil(low[1]);
    const int right = (int)floor(high[0]), bottom = (int)floor(high[1]);
    const bool fills = (double)(right - left) * (bottom - top) > ALL * s->width * s->height;
    memset(crop, 0, 4 * sizeof *crop);
    if (r->sum <= 0.0 || fills || right - left < LEAST_SIDE || bottom - top < LEAST_SIDE)
        return;
    crop[0] = left;
    crop[1] = top;
    crop[2] = right - left;
    crop[3] = bottom - top;
}

static relume_status find_crop(struct acquisition *s, int crop[4])
{
    struct map m = {.width = s->shot[0].small.width, .height = s->shot[0].small.height};
    struct region object = {0};
    const size_t n = (size_t)m.width * (size_t)m.height;
    m.relief = mem_zeroed(n, sizeof *m.relief);
    m.ball = mem_zeroed(n, 1);
    relume_status status = m.relief && m.ball ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = find_relief(&m, s);
    if (!status)
        status = find_object(&object, &m);
    if (!status)
        place_object(crop, s, &object);
    mem_free(m.relief);
    mem_free(m.ball);
    if (!status && !crop[2])
        log_line(s->p.log, RELUME_NOTE, "--crop auto: %s; nothing is cropped",
                 object.sum > 0.0 ? "the object fills the photographs" : "no relief is found");
    return status;
}

// ---------------------------------------------------------------- cropping

relume_status acquire_crop_image(struct relume_image *image, const int crop[4])
{
    struct relume_image part;
    const size_t channels = (size_t)image->channels;
    const relume_status status = relume_image_create(&part, crop[2], crop[3], image->channels);
    for (int y = 0; !status && y < crop[3]; y++)
        memcpy(part.data + channels * (size_t)y * (size_t)crop[2],
               image->data +
                   channels * ((size_t)(crop[1] + y) * (size_t)image->width + (size_t)crop[0]),
               channels * (size_t)crop[2] * sizeof *part.data);
    if (!status) {
        relume_image_destroy(image);
        *image = part;
    }
    return status;
}

static relume_status crop_shot(struct acquisition *s, struct shot *shot)
{
    struct relume_image image = {0};
    relume_status status = acquire_fetch(&image, s, shot);
    if (!status)
        status = acquire_crop_image(&image, s->out->crop);
    if (!status)
        status = acquire_save(s, shot, &image);
    relume_image_destroy(&shot->small);
    if (!status)
        status = acquire_shrink(&shot->small, &image);
    relume_image_destroy(&image);
    return status;
}

static relume_status check_inside(const struct acquisition *s, const int crop[4])
{
    if (crop[0] >= 0 && crop[1] >= 0 && crop[2] > 0 && crop[3] > 0 &&
        crop[0] <= s->width - crop[2] && crop[1] <= s->height - crop[3])
        return RELUME_OK;
    return log_fail(s->p.log, RELUME_EINVAL,
                    "--crop %d,%d,%d,%d: expected a part of the photographs of %d x %d pixels",
                    crop[0], crop[1], crop[2], crop[3], s->width, s->height);
}

relume_status acquire_crop(struct acquisition *s)
{
    int *const crop = s->out->crop;
    memcpy(crop, s->p.crop, sizeof s->p.crop);
    relume_status status = RELUME_OK;
    if (s->p.crop_auto)
        status = find_crop(s, crop);
    else if (s->p.crop[2] || s->p.crop[3])
        status = check_inside(s, crop);
    s->whole[0] = s->width;
    s->whole[1] = s->height;
    for (int i = 0; !status && crop[2] && i < s->shots; i++) {
        status = crop_shot(s, &s->shot[i]);
        if (!status && !log_progress(s->p.log, "cropping", (i + 1.0) / s->shots))
            status = RELUME_ECANCEL;
    }
    if (status || !crop[2])
        return status;
    s->width = crop[2];
    s->height = crop[3];
    log_line(s->p.log, RELUME_NOTE, "cropped to %d,%d,%d,%d of %d x %d pixels", crop[0], crop[1],
             crop[2], crop[3], s->whole[0], s->whole[1]);
    return RELUME_OK;
}
