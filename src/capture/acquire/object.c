// object.c - the object in photographs of one scene, found by its relief
//
// Between two neighbouring pixels of a flat surface the ratio of brightness is the same under all
// lights, whatever is painted on it. On a relief it changes with the light. The median over the
// lights leaves out shadows on the table, which reach a pixel under few of them.
#include "capture/acquire/object.h"

#include "core/base/memory.h"
#include "core/math/sort.h"

#include <math.h>

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
static relume_status take_logarithms(float *out, const struct object_search *s, const struct map *m)
{
    const size_t n = (size_t)m->width * (size_t)m->height;
    double *sorted = mem_array(n, sizeof *sorted);
    if (!sorted)
        return RELUME_ENOMEM;
    for (int i = 0; i < s->count; i++) {
        const float *from = s->small[i]->data;
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

static void mark_balls(struct map *m, const struct object_search *s)
{
    const double step = s->step;
    for (int b = 0; b < s->balls; b++) {
        const struct relume_ball *ball = &s->ball[b];
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

static relume_status find_relief(struct map *m, const struct object_search *s)
{
    const size_t n = (size_t)m->width * (size_t)m->height;
    float *log = mem_array(n * (size_t)s->count, sizeof *log);
    float *relief = mem_zeroed(n, sizeof *relief);
    double *step = mem_array((size_t)s->count, sizeof *step);
    relume_status status = log && relief && step ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = take_logarithms(log, s, m);
    mark_balls(m, s);
    for (int y = 0; !status && y + 1 < m->height; y++)
        for (int x = 0; x + 1 < m->width; x++) {
            const size_t at = (size_t)y * (size_t)m->width + (size_t)x;
            relief[at] = change(log, n, s->count, at, at + 1, step) +
                         change(log, n, s->count, at, at + (size_t)m->width, step);
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
static struct relume_rect place_object(const struct object_search *s, const struct region *r)
{
    const int side =
        r->right - r->left > r->bottom - r->top ? r->right - r->left : r->bottom - r->top;
    const double step = s->step, margin = MARGIN * side * step;
    const double from[2] = {r->left * step, r->top * step};
    const double to[2] = {fmin(r->right * step, s->width), fmin(r->bottom * step, s->height)};
    double low[2] = {fmax(from[0] - margin, 0.0), fmax(from[1] - margin, 0.0)};
    double high[2] = {fmin(to[0] + margin, s->width), fmin(to[1] + margin, s->height)};
    for (int b = 0; b < s->balls; b++) {  // the margin ends at a ball
        const struct relume_ball *ball = &s->ball[b];
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
    if (r->sum <= 0.0 || fills || right - left < LEAST_SIDE || bottom - top < LEAST_SIDE)
        return (struct relume_rect){0};
    return (struct relume_rect){left, top, right - left, bottom - top};
}

relume_status object_find(struct relume_rect *out, bool *relief, const struct object_search *s)
{
    struct map m = {.width = s->small[0]->width, .height = s->small[0]->height};
    struct region object = {0};
    const size_t n = (size_t)m.width * (size_t)m.height;
    m.relief = mem_zeroed(n, sizeof *m.relief);
    m.ball = mem_zeroed(n, 1);
    relume_status status = m.relief && m.ball ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = find_relief(&m, s);
    if (!status)
        status = find_object(&object, &m);
    *out = (struct relume_rect){.width = 0};
    if (!status)
        *out = place_object(s, &object);
    *relief = object.sum > 0.0;
    mem_free(m.relief);
    mem_free(m.ball);
    return status;
}
