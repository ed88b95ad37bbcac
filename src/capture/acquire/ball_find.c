// ball_find.c - balls found in the mean photograph
//
// Edges of log light vote for the middles that lie along their gradient (Hough 1962; Ballard 1981),
// in a pyramid, so that at each level only radii of 8 to 16 pixels are asked for. The best circles
// are followed at the level where they measure some 40 pixels, and the very best at full size.
#include "capture/acquire/ball.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/sort.h"

#include <stdio.h>
#include <string.h>

enum { LEVELS = 12, RADII = 10, FIRST_RADIUS = 8, PER_LEVEL = 40, MOST = LEVELS * PER_LEVEL };
static const double SMALLEST = 0.015, LARGEST = 0.6;
static const double EDGES = 0.7;          // quantile of the gradient above which edges lie
static const double WIDEST = 0.14;        // how far a circle may be off, share of its radius
static const double LEAST_EXCESS = 0.38;  // of coverage over chance: below it is no circle

struct pyramid {
    int levels;
    struct relume_image level[LEVELS];
};

struct candidate {
    struct relume_ball ball;  // in pixels of the full picture
    double score;
};

// The value below which `part` of some thousand samples lie; NaN when memory is short.
static float quantile(const float *v, size_t n, double part)
{
    const size_t step = n / 20000 + 1, count = (n + step - 1) / step;
    float *some = mem_array(count, sizeof *some);
    if (!some)
        return NAN;
    for (size_t i = 0; i < count; i++)
        some[i] = v[i * step];
    sort_floats(some, count);
    const float found = some[(size_t)(part * (double)(count - 1))];
    mem_free(some);
    return found;
}

// log(light + a little): a dark ball before a dark cloth differs by a factor, not by an amount.
static relume_status take_log(struct relume_image *out, const struct relume_image *mean)
{
    const size_t n = (size_t)mean->width * (size_t)mean->height;
    const relume_status status = relume_image_create(out, mean->width, mean->height, 1);
    if (status)
        return status;
    const float middle = quantile(mean->data, n, 0.5), little = fmaxf(0.3f * middle, 1e-5f);
    if (isnan(middle))
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++)
        out->data[i] = logf(fmaxf(mean->data[i], 0.0f) + little);
    return RELUME_OK;
}

static relume_status halve(struct relume_image *out, const struct relume_image *from)
{
    const relume_status status = relume_image_create(out, from->width / 2, from->height / 2, 1);
    for (int y = 0; !status && y < out->height; y++)
        for (int x = 0; x < out->width; x++) {
            const float *p = from->data + 2 * ((size_t)y * (size_t)from->width + (size_t)x);
            out->data[(size_t)y * (size_t)out->width + (size_t)x] =
                0.25f * (p[0] + p[1] + p[from->width] + p[from->width + 1]);
        }
    return status;
}

static relume_status build_pyramid(struct pyramid *p, const struct relume_image *mean)
{
    relume_status status = take_log(&p->level[0], mean);
    p->levels = 1;
    while (!status && p->levels < LEVELS) {
        const struct relume_image *last = &p->level[p->levels - 1];
        if (last->width < 32 || last->height < 32)
            break;
        status = halve(&p->level[p->levels], last);
        p->levels++;
    }
    return status;
}

// ---------------------------------------------------------------- votes

struct votes {
    int width, height;
    const float *image;
    float *gx, *gy, *size;
    uint16_t *count;  // [RADII][height][width]
};

static void find_gradient(struct votes *v)
{
    const int w = v->width;
    for (int y = 1; y < v->height - 1; y++)
        for (int x = 1; x < w - 1; x++) {
            const float *p = v->image + y * w + x;
            const float gx = p[1 - w] - p[-1 - w] + 2 * (p[1] - p[-1]) + p[1 + w] - p[-1 + w];
            const float gy = p[w - 1] - p[-w - 1] + 2 * (p[w] - p[-w]) + p[w + 1] - p[-w + 1];
            v->gx[y * w + x] = gx;
            v->gy[y * w + x] = gy;
            v->size[y * w + x] = hypotf(gx, gy);
        }
}

static void vote(struct votes *v, double x, double y, int radius)
{
    const int ix = (int)lrint(x), iy = (int)lrint(y);
    if (ix >= 0 && iy >= 0 && ix < v->width && iy < v->height)
        v->count[((radius - FIRST_RADIUS) * v->height + iy) * v->width + ix]++;
}

// Edges: steeper than most and than both neighbours along the gradient.
static void vote_all(struct votes *v, float least)
{
    const int w = v->width;
    for (int y = 2; y < v->height - 2; y++)
        for (int x = 2; x < w - 2; x++) {
            const int i = y * w + x;
            if (!(v->size[i] > least))
                continue;
            const float ux = v->gx[i] / v->size[i], uy = v->gy[i] / v->size[i];
            const int ahead = i + (int)lrintf(uy) * w + (int)lrintf(ux);
            if (v->size[i] < v->size[ahead] || v->size[i] < v->size[2 * i - ahead])
                continue;
            for (int r = FIRST_RADIUS; r < FIRST_RADIUS + RADII; r++) {
                vote(v, (double)x + r * (double)ux, (double)y + r * (double)uy, r);
                vote(v, (double)x - r * (double)ux, (double)y - r * (double)uy, r);
            }
        }
}

// Votes of a cell and its neighbours against those that a whole circle gets.
static double cell_score(const struct votes *v, int radius, int x, int y)
{
    const uint16_t *c = v->count + (radius - FIRST_RADIUS) * v->height * v->width;
    int sum = 0;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++)
            sum += c[(y + dy) * v->width + x + dx];
    return sum / (2.0 * M_PI * radius);
}

// Put a circle among the best `*n` of its level unless a better one lies close by.
static void keep_best(struct candidate *list, int *n, struct candidate c)
{
    for (int i = 0; i < *n; i++)
        if (hypot(list[i].ball.x - c.ball.x, list[i].ball.y - c.ball.y) < 0.3 * c.ball.radius) {
            if (c.score > list[i].score)
                list[i] = c;
            return;
        }
    if (*n < PER_LEVEL) {
        list[(*n)++] = c;
        return;
    }
    int worst = 0;
    for (int i = 1; i < PER_LEVEL; i++)
        if (list[i].score < list[worst].score)
            worst = i;
    if (c.score > list[worst].score)
        list[worst] = c;
}

static void collect(const struct votes *v, double scale, struct candidate *list, int *n)
{
    for (int r = FIRST_RADIUS; r < FIRST_RADIUS + RADII; r++)
        for (int y = 1; y < v->height - 1; y++)
            for (int x = 1; x < v->width - 1; x++) {
                const double score = cell_score(v, r, x, y);
                if (score > 0.3)
                    keep_best(list, n,
                              (struct candidate){.ball = {.x = (x + 0.5) * scale,
                                                          .y = (y + 0.5) * scale,
                                                          .radius = r * scale},
                                                 .score = score});
            }
}

static relume_status search_level(const struct relume_image *image, double scale,
                                  struct candidate *list, int *n)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    struct votes v = {
        .width = image->width,
        .height = image->height,
        .image = image->data,
        .gx = mem_zeroed(pixels, sizeof *v.gx),
        .gy = mem_zeroed(pixels, sizeof *v.gy),
        .size = mem_zeroed(pixels, sizeof *v.size),
        .count = mem_zeroed(RADII * pixels, sizeof *v.count),
    };
    relume_status status = v.gx && v.gy && v.size && v.count ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        find_gradient(&v);
        const float least = quantile(v.size, pixels, EDGES);
        status = isnan(least) ? RELUME_ENOMEM : RELUME_OK;
        vote_all(&v, fmaxf(least, 1e-6f));
        collect(&v, scale, list, n);
    }
    mem_free(v.gx);
    mem_free(v.gy);
    mem_free(v.size);
    mem_free(v.count);
    return status;
}

// ---------------------------------------------------------------- candidates

static relume_status follow_at(struct relume_ball *ball, const struct relume_ball_camera *camera,
                               const struct pyramid *p, int level, int angles)
{
    const double scale = 1 << level;
    // The camera and the ball as they are in a picture smaller by `scale`.
    const struct relume_ball_camera small = (struct relume_ball_camera){
        (int)(camera->width / scale), (int)(camera->height / scale), camera->focal_px / scale};
    ball->x /= scale;
    ball->y /= scale;
    ball->radius /= scale;
    const relume_status status = ball_follow(ball, &small, &p->level[level], angles, WIDEST);
    ball->x *= scale;
    ball->y *= scale;
    ball->radius *= scale;
    ball->sigma *= scale;
    return status;
}

static bool has_highlight(const struct relume_ball *b, const struct relume_image *peak, float least)
{
    const int x0 = relume_whole(fmax(b->x - b->radius, 0)),
              x1 = relume_whole(fmin(b->x + b->radius, peak->width));
    const int y0 = relume_whole(fmax(b->y - b->radius, 0)),
              y1 = relume_whole(fmin(b->y + b->radius, peak->height));
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            if (hypot(x + 0.5 - b->x, y + 0.5 - b->y) < 0.95 * b->radius &&
                ball_grey(peak, x, y) >= least)
                return true;
    return false;
}

static float brightest(const struct relume_image *image)
{
    float most = 0.0f;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        most = image->data[i] > most ? image->data[i] : most;
    return most;
}

static bool is_plausible(const struct relume_ball *b, const struct relume_image *mean,
                         const struct relume_ball_params *p)
{
    const double side = mean->width < mean->height ? mean->width : mean->height;
    const double least = p->smallest > 0.0 ? p->smallest : SMALLEST;
    const double most = p->largest > 0.0 ? p->largest : LARGEST;
    return b->radius >= least * side && b->radius >= 4.0 && b->radius <= most * side && b->x > 0 &&
           b->y > 0 && b->x < mean->width && b->y < mean->height;
}

// Coverage beyond that which texture has by chance, [0, 1] (the tolerance and the search of
// ball_follow).
static double excess(const struct relume_ball *b, double scale)
{
    const double r = b->radius / scale;
    const double chance = fmax(0.01 * r, 1.0) / fmax(0.08 * r, 5.0);
    return (b->coverage - chance) / (1.0 - chance);
}

static int by_score(const void *a, const void *b)
{
    const struct candidate *p = a, *q = b;
    if (p->score != q->score)
        return p->score > q->score ? -1 : 1;
    if (p->ball.x != q->ball.x)
        return p->ball.x < q->ball.x ? -1 : 1;
    return (p->ball.y > q->ball.y) - (p->ball.y < q->ball.y);
}

// Follow each at the level where it is some 40 pixels large; what is no circle loses its score.
static relume_status screen(struct candidate *list, int n, const struct pyramid *p,
                            const struct relume_image *mean,
                            const struct relume_ball_camera *camera,
                            const struct relume_ball_params *params)
{
    const float least = params->peak ? 0.5f * brightest(params->peak) : 0.0f;
    for (int i = 0; i < n; i++) {
        struct relume_ball *b = &list[i].ball;
        int level = 0;
        while (level + 1 < p->levels && b->radius / (2 << level) >= 30.0)
            level++;
        list[i].score = 0.0;
        const relume_status status = follow_at(b, camera, p, level, 120);
        if (status == RELUME_ENOMEM)
            return status;
        if (!status && is_plausible(b, mean, params) &&
            (!params->peak || has_highlight(b, params->peak, least)))
            list[i].score = excess(b, 1 << level);
    }
    qsort(list, (size_t)n, sizeof *list, by_score);
    return RELUME_OK;
}

// The steepest place of log light lies on the dark side of an edge, that of light itself on it.
static relume_status settle(struct relume_ball *ball, const struct relume_ball_camera *camera,
                            const struct relume_image *light)
{
    struct relume_ball b = *ball;
    const double reach = fmax(3.0 / b.radius, 0.02);
    const relume_status status = ball_follow(&b, camera, light, 360, reach);
    if (!status && b.coverage >= 0.5 * ball->coverage &&
        hypot(b.x - ball->x, b.y - ball->y) < 3.0 && fabs(b.radius - ball->radius) < 3.0) {
        b.coverage = ball->coverage;
        *ball = b;
    }
    return status == RELUME_ENOMEM ? status : RELUME_OK;
}

static bool is_apart(const struct relume_ball *a, const struct relume_ball *list, int n)
{
    for (int i = 0; i < n; i++)
        if (hypot(a->x - list[i].x, a->y - list[i].y) < fmax(a->radius, list[i].radius))
            return false;
    return true;
}

// The `count` best that do not overlap, followed at full size; `*found` are there.
static relume_status choose(struct relume_ball *out, int count, int *found,
                            const struct candidate *list, int n, const struct pyramid *p,
                            const struct relume_image *mean,
                            const struct relume_ball_camera *camera,
                            const struct relume_ball_params *params)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < n && *found < count && list[i].score >= 0.8 * LEAST_EXCESS; i++) {
        struct relume_ball b = list[i].ball;
        if (!is_apart(&b, out, *found))
            continue;
        status = follow_at(&b, camera, p, 0, 360);
        if (!status && excess(&b, 1.0) >= LEAST_EXCESS && is_plausible(&b, mean, params) &&
            is_apart(&b, out, *found)) {
            status = settle(&b, camera, params->mask ? params->mask : mean);
            out[(*found)++] = b;
        }
        if (status == RELUME_ENOMEM)
            return status;
    }
    return RELUME_OK;
}

relume_status relume_ball_candidates(struct relume_ball *out, int most, int *found,
                                     const struct relume_image *mean,
                                     const struct relume_ball_camera *camera,
                                     const struct relume_ball_params *params)
{
    const struct relume_ball_params p = PARAMS(relume_ball_params, params);
    const struct relume_image *look_at = p.mask ? p.mask : mean;
    struct pyramid pyramid = {0};
    struct candidate *list = mem_zeroed(MOST, sizeof *list);
    relume_status status = list ? build_pyramid(&pyramid, look_at) : RELUME_ENOMEM;
    int n = 0;
    *found = 0;
    for (int i = 0; !status && i < pyramid.levels; i++) {
        int here = 0;
        status = search_level(&pyramid.level[i], 1 << i, list + n, &here);
        n += here;
    }
    if (!status)
        status = screen(list, n, &pyramid, mean, camera, &p);
    if (!status)
        status = choose(out, most, found, list, n, &pyramid, mean, camera, &p);
    for (int i = 0; i < pyramid.levels; i++)
        relume_image_destroy(&pyramid.level[i]);
    mem_free(list);
    return status;
}

static int by_column(const void *a, const void *b)
{
    const struct relume_ball *p = a, *q = b;
    return (p->x > q->x) - (p->x < q->x);
}

void ball_sort(struct relume_ball *ball, int n)
{
    qsort(ball, (size_t)n, sizeof *ball, by_column);
}

relume_status relume_ball_find(struct relume_ball *out, int count, const struct relume_image *mean,
                               const struct relume_ball_camera *camera,
                               const struct relume_ball_params *params)
{
    int found;
    const relume_status status = relume_ball_candidates(out, count, &found, mean, camera, params);
    ball_sort(out, found);
    if (!status && found < count)
        return log_fail(params ? params->log : NULL, RELUME_EUNFIT,
                        "%d of %d ball%s found; expected round outlines against the background, "
                        "or --ball x,y,r",
                        found, count, relume_plural(count));
    return status;
}
