// ramp.c - the distance of near lights, by how brightness changes across a flat matte surface
//
// Under a lamp at P a matte plane is as bright as P.z / |P - p|^3. The logarithm of that is taken
// from the photographs' logarithms. The rest must be one number for each pixel and one for each
// photograph. Its median size says how well a distance fits. Most of what a ball capture shows is
// the table. A curved surface under distant lights has a ramp too, and is also tried.
#include "capture/acquire/ramp.h"

#include "core/base/memory.h"
#include "core/math/sort.h"

#include <math.h>
#include <string.h>

static const double FAINT = 0.05;  // of the bright parts: shadow
static const double WHITE = 0.95;  // may be clipped
static const double LOW = 0.15;    // z of lamps whose light the smallest slopes hide
static const double LIT = 0.6;     // of the photographs: what fewer light is no table
static const double BALL = 1.5;    // radii, with what a ball reflects around it
static const double LEAST_PIXELS = 0.2;
// Of made flat and matte scenes 0.01 to 0.16 of the ramp is left, of glossy plates 0.26 or more.
static const double LEFT = 0.2;
static const double ROUGHLY = 0.4;        // before the distance is looked for in smaller steps
static const double CURVED = 0.5;         // of what curved surfaces leave
static const double ALIKE = 1.25;         // distances that low and high lamps show, ...
static const double ROUGHLY_ALIKE = 1.6;  // ... and where lamps are few
static const double NEAREST = 1.6, FARTHEST = 20.0;  // world units: 0.8 and 10 widths
enum {
    SIDE = 36,
    LEAST_LAMPS = 6,
    FEW = 12,
    MOST_LAMPS = 24,
    DISTANCES = 13,
    FINER = 13,
    CURVES = 12
};
static const double STEEPEST = 1.5;  // slope of a curved surface at the border

struct ramp {
    int lamps, width, height;
    vec3 *direction;  // [lamps], the lowest first
    float *log;       // [lamps][height][width]; NaN: does not count
    float *left;      // the same, less a model
    double *sorted;   // [lamps height width]
    vec3 origin;
};

// ---------------------------------------------------------------- what is looked at

static float brightness(const struct relume_image *image, int x, int y)
{
    const float *p = image->data + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
    return (p[0] + p[1] + p[2]) / 3.0f;
}

static double bright_part(const struct relume_image *image, double *sorted)
{
    size_t n = 0;
    for (int y = 0; y < image->height; y += 2)
        for (int x = 0; x < image->width; x += 2)
            sorted[n++] = (double)brightness(image, x, y);
    sort_doubles(sorted, n);
    return sorted[(size_t)(0.99 * (double)(n - 1))];
}

static bool is_ball(const struct ramp_search *s, double x, double y)
{
    for (int b = 0; b < s->balls; b++)
        if (hypot(x - s->ball[b].x, y - s->ball[b].y) < BALL * s->ball[b].radius)
            return true;
    return false;
}

// Logarithms of every `every`-th small pixel of a photograph.
static void take_logarithms(float *to, const struct ramp *r, const struct ramp_search *s,
                            const struct relume_image *from, int every, double *sorted)
{
    const double faint = FAINT * bright_part(from, sorted);
    for (int y = 0; y < r->height; y++)
        for (int x = 0; x < r->width; x++) {
            const int u = x * every, v = y * every;
            const double value = (double)brightness(from, u, v);
            const bool counts = value > faint && value < WHITE &&
                                !is_ball(s, (u + 0.5) * s->step, (v + 0.5) * s->step);
            to[y * r->width + x] = counts ? (float)log(value) : NAN;
        }
}

// Pixels that too few photographs light do not count. Returns the share of those that do.
static double leave_dark_out(struct ramp *r)
{
    const size_t n = (size_t)r->width * (size_t)r->height;
    size_t kept = 0;
    for (size_t p = 0; p < n; p++) {
        int lit = 0;
        for (int i = 0; i < r->lamps; i++)
            lit += !isnan(r->log[n * (size_t)i + p]);
        const bool counts = lit >= LIT * r->lamps;
        kept += counts;
        for (int i = 0; !counts && i < r->lamps; i++)
            r->log[n * (size_t)i + p] = NAN;
    }
    return (double)kept / (double)n;
}

// Chooses some of the lamps, the lowest first. Returns how many.
static int choose_lamps(int *lamp, const struct ramp_search *s)
{
    const int most = s->count < MOST_LAMPS ? s->count : MOST_LAMPS;
    int chosen = 0;
    for (int k = 0; k < most; k++) {
        const int i = (int)((long long)k * s->count / most);
        if (!(s->direction[i].z > LOW))
            continue;
        int at = chosen++;
        for (; at && s->direction[lamp[at - 1]].z > s->direction[i].z; at--)
            lamp[at] = lamp[at - 1];
        lamp[at] = i;
    }
    return chosen;
}

static relume_status create(struct ramp *r, const struct ramp_search *s)
{
    const struct relume_image *first = s->small[0];
    const int longer = first->width > first->height ? first->width : first->height;
    const int every = (longer + SIDE - 1) / SIDE;
    const size_t whole = (size_t)first->width * (size_t)first->height;
    *r = (struct ramp){.width = (first->width + every - 1) / every,
                       .height = (first->height + every - 1) / every,
                       .origin = s->origin};
    const size_t n = (size_t)r->width * (size_t)r->height, lamps = MOST_LAMPS;
    const size_t all = n * lamps > whole ? n * lamps : whole;
    r->direction = mem_array(lamps, sizeof *r->direction);
    r->log = mem_array(n * lamps, sizeof *r->log);
    r->left = mem_array(n * lamps, sizeof *r->left);
    r->sorted = mem_array(all, sizeof *r->sorted);
    if (!r->direction || !r->log || !r->left || !r->sorted)
        return RELUME_ENOMEM;
    int lamp[MOST_LAMPS];
    r->lamps = choose_lamps(lamp, s);
    for (int k = 0; k < r->lamps; k++) {
        r->direction[k] = s->direction[lamp[k]];
        take_logarithms(r->log + n * (size_t)k, r, s, s->small[lamp[k]], every, r->sorted);
    }
    return RELUME_OK;
}

static void destroy(struct ramp *r)
{
    mem_free(r->direction);
    mem_free(r->log);
    mem_free(r->left);
    mem_free(r->sorted);
}

// ---------------------------------------------------------------- models

// The middle of a small pixel in the window that is 2 wide.
static vec3 point_of(const struct ramp *r, int x, int y)
{
    return vec3_of(2.0 * (x + 0.5) / r->width - 1.0, (r->height - 2.0 * (y + 0.5)) / r->width, 0.0);
}

static double log_plane(vec3 lamp, vec3 point)
{
    const vec3 to = vec3_sub(lamp, point);
    return log(fmax(to.z, 1e-6)) - 1.5 * log(vec3_dot(to, to));
}

static double log_curved(vec3 direction, vec3 point, double slope)
{
    const vec3 normal = vec3_unit(vec3_of(slope * point.x, slope * point.y, 1.0));
    return log(fmax(vec3_dot(normal, direction), 0.02));
}

static void subtract_pixels(struct ramp *r)
{
    const size_t n = (size_t)r->width * (size_t)r->height;
    for (size_t p = 0; p < n; p++) {
        double sum = 0.0;
        int lit = 0;
        for (int i = 0; i < r->lamps; i++)
            if (!isnan(r->left[n * (size_t)i + p])) {
                sum += (double)r->left[n * (size_t)i + p];
                lit++;
            }
        for (int i = 0; lit && i < r->lamps; i++)
            r->left[n * (size_t)i + p] -= (float)(sum / lit);
    }
}

static double middle(const float *value, size_t n, bool sizes, double *sorted)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        if (!isnan(value[i]))
            sorted[count++] = sizes ? fabs((double)value[i]) : (double)value[i];
    sort_doubles(sorted, count);
    return count ? sorted[count / 2] : 0.0;
}

static void subtract_photographs(struct ramp *r)
{
    const size_t n = (size_t)r->width * (size_t)r->height;
    for (int i = 0; i < r->lamps; i++) {
        float *left = r->left + n * (size_t)i;
        const float usual = (float)middle(left, n, false, r->sorted);
        for (size_t p = 0; p < n; p++)
            left[p] -= usual;
    }
}

// What lamps at a distance from a plane leave of the changes of brightness, or distant lights above
// a surface with `slope` at its border; neither: all.
static double left_by(struct ramp *r, double distance, double slope)
{
    const size_t n = (size_t)r->width * (size_t)r->height, all = n * (size_t)r->lamps;
    memcpy(r->left, r->log, all * sizeof *r->left);
    for (int i = 0; (distance > 0.0 || slope != 0.0) && i < r->lamps; i++) {
        const vec3 direction = r->direction[i], lamp = ramp_place(r->origin, direction, distance);
        for (int y = 0; y < r->height; y++)
            for (int x = 0; x < r->width; x++) {
                const vec3 point = point_of(r, x, y);
                r->left[n * (size_t)i + (size_t)(y * r->width + x)] -=
                    (float)(distance > 0.0 ? log_plane(lamp, point)
                                           : log_curved(direction, point, slope));
            }
    }
    subtract_pixels(r);
    subtract_photographs(r);
    subtract_pixels(r);
    return middle(r->left, all, true, r->sorted);
}

vec3 ramp_place(vec3 origin, vec3 direction, double distance)
{
    const double along = vec3_dot(origin, direction);
    const double rest = distance * distance - vec3_dot(origin, origin) + along * along;
    return vec3_along(origin, direction, sqrt(fmax(rest, 0.0)) - along);
}

// Returns the best of distances from `from` on, each `times` the one before, and what it leaves.
static double best_distance(double *best, struct ramp *r, double from, double times, int count)
{
    double found = from, distance = from;
    *best = INFINITY;
    for (int k = 0; k < count; k++, distance *= times) {
        const double left = left_by(r, distance, 0.0);
        if (left < *best) {
            *best = left;
            found = distance;
        }
    }
    return found;
}

// Returns whether low and high lamps show one distance. Highlights make a ramp, too, above all
// where lamps stand high.
static bool halves_agree(const struct ramp *r, double distance)
{
    const size_t n = (size_t)r->width * (size_t)r->height;
    struct ramp low = *r, high = *r;
    double best;
    low.lamps = r->lamps / 2;
    high.lamps = r->lamps - low.lamps;
    high.direction += low.lamps;
    high.log += n * (size_t)low.lamps;
    const double from = distance / ALIKE / ALIKE, step = pow(ALIKE, 4.0 / (FINER - 1));
    const double a = best_distance(&best, &low, from, step, FINER);
    const double b = best_distance(&best, &high, from, step, FINER);
    return fmax(a, b) <= (r->lamps < FEW ? ROUGHLY_ALIKE : ALIKE) * fmin(a, b);
}

static double search(struct ramp *r)
{
    double best, curved = INFINITY;
    const double all = left_by(r, 0.0, 0.0);
    const double step = pow(FARTHEST / NEAREST, 1.0 / (DISTANCES - 1));
    const double rough = best_distance(&best, r, NEAREST, step, DISTANCES);
    if (!(best <= ROUGHLY * all))
        return 0.0;
    const double found = best_distance(&best, r, rough / step, pow(step, 2.0 / (FINER - 1)), FINER);
    if (!(best <= LEFT * all))
        return 0.0;
    for (int k = 1; k <= CURVES; k++)
        for (int side = -1; side <= 1; side += 2)
            curved = fmin(curved, left_by(r, 0.0, side * STEEPEST * k / CURVES));
    return best <= CURVED * curved && halves_agree(r, found) ? found : 0.0;
}

relume_status ramp_find(double *distance, const struct ramp_search *s)
{
    struct ramp r;
    *distance = 0.0;
    const relume_status status = create(&r, s);
    if (!status && r.lamps >= LEAST_LAMPS && leave_dark_out(&r) > LEAST_PIXELS)
        *distance = search(&r);
    destroy(&r);
    return status;
}
