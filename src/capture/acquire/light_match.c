// light_match.c - which list of lights a ball shows
//
// A ball proves a list wrong only where it shows the same lights under other axes or in another
// order, to a few degrees. A round thing that merely disagrees may be no mirror. Lists are
// compared under all 48 signed permutations of their axes. They are turned in the plane of the
// picture, mirrored or not, and put in the order that is nearest to the directions of the ball.
#include "capture/acquire/light_match.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/sort.h"

#include <stdio.h>
#include <string.h>

#define REORDER "its lines are put in another order"

enum { LEAST = 4, ROUNDS = 5, MOST_LIGHTS = 4096 };
static const double LEAST_TOLERANCE = 4.0, MOST_TOLERANCE = 8.0;  // degrees, of the median
static const double LIKELY = 15.0;  // degrees: a right list, seen by something like a mirror
static const double OFFSET = 0.3;   // usual distance of a ball, over that of the lights
static const double MOST_OFFSET = 0.6;
static const double CLOSE = 0.25;  // share of the distance between lights: these are the same
static const double PAIRED = 0.8;  // share of the lights that have partners of their own
static const double COARSE = 4.0, FINE = 0.5;  // degrees, steps of a turn
static const double DEGREES = 180.0 / M_PI;

struct comparison {
    int n;
    int *index;                  // [n]
    vec3 *list, *turned, *seen;  // [n], those that were seen
    double *angle, *sorted;      // [n]
    vec3 offset;                 // of the ball, as the lights of `turned` are seen from it
};

static double median(double *v, int n)
{
    sort_doubles(v, (size_t)n);
    return v[n / 2];
}

static double sort_angles(struct comparison *c)
{
    memcpy(c->sorted, c->angle, (size_t)c->n * sizeof *c->sorted);
    return median(c->sorted, c->n);
}

static vec3 direction_of(const struct comparison *c, int i)
{
    return vec3_unit(vec3_sub(c->turned[i], c->offset));
}

static double measure_angles(struct comparison *c, vec3 offset)
{
    c->offset = offset;
    for (int i = 0; i < c->n; i++)
        c->angle[i] = vec3_angle(direction_of(c, i), c->seen[i]) * DEGREES;
    return sort_angles(c);
}

// One weighted least squares step: distances of turned - offset from the lines along `seen`.
static bool solve_offset(const struct comparison *c, double scale, vec3 *offset)
{
    const double pull = 0.001 * c->n / (OFFSET * OFFSET);
    double m[9] = {pull, 0, 0, 0, pull, 0, 0, 0, pull}, b[3] = {0.0};
    for (int i = 0; i < c->n; i++) {
        const double s[3] = {c->seen[i].x, c->seen[i].y, c->seen[i].z};
        const double l[3] = {c->turned[i].x, c->turned[i].y, c->turned[i].z};
        const double w = 1.0 / (1.0 + c->angle[i] * c->angle[i] / (scale * scale));
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) {
                const double across = w * ((j == k) - s[j] * s[k]);
                m[3 * j + k] += across;
                b[j] += across * l[k];
            }
    }
    if (!lsq_solve(m, 3, b, 1))
        return false;
    *offset = vec3_of(b[0], b[1], b[2]);
    const double length = vec3_length(*offset);
    if (length > MOST_OFFSET)
        *offset = vec3_scale(*offset, MOST_OFFSET / length);
    return true;
}

// The median angle under the best offset of the ball.
static double fit_offset(struct comparison *c)
{
    vec3 offset = vec3_of(0, 0, 0);
    double off = measure_angles(c, offset);
    for (int i = 0; i < ROUNDS && solve_offset(c, fmax(off, 2.0), &offset); i++)
        off = measure_angles(c, offset);
    return off;
}

static vec3 turn(const double m[9], vec3 v)
{
    return vec3_of(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
                   m[6] * v.x + m[7] * v.y + m[8] * v.z);
}

static double try_turn(struct comparison *c, const double m[9])
{
    for (int i = 0; i < c->n; i++)
        c->turned[i] = turn(m, c->list[i]);
    return fit_offset(c);
}

// ---------------------------------------------------------------- axes

static void set_axes(double m[9], const int axis[3], int signs)
{
    memset(m, 0, 9 * sizeof *m);
    for (int k = 0; k < 3; k++)
        m[3 * k + axis[k]] = signs >> k & 1 ? -1.0 : 1.0;
}

static void name_axes(char *out, size_t size, const int axis[3], int signs)
{
    static const char *const negated[] = {"",     "x is",        "y is",        "x and y are",
                                          "z is", "x and z are", "y and z are", "x, y and z are"};
    if (axis[0] == 0 && axis[1] == 1)
        snprintf(out, size, "%s negated", negated[signs]);
    else
        snprintf(out, size, "x, y, z are read as its %s%c, %s%c, %s%c", signs & 1 ? "-" : "",
                 "xyz"[axis[0]], signs & 2 ? "-" : "", "xyz"[axis[1]], signs & 4 ? "-" : "",
                 "xyz"[axis[2]]);
}

static void try_axes(struct light_match *out, struct comparison *c, double best[9])
{
    static const int order[6][3] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1},
                                    {2, 1, 0}, {1, 2, 0}, {2, 0, 1}};
    for (int k = 1; k < 48; k++) {
        double m[9];
        set_axes(m, order[k / 8], k % 8);
        const double left = try_turn(c, m);
        if (left >= out->left)
            continue;
        out->left = left;
        out->half_turn = k == 3;
        name_axes(out->mend, sizeof out->mend, order[k / 8], k % 8);
        memcpy(best, m, sizeof m);
    }
}

static double try_angle(struct comparison *c, double degrees, bool mirrored, double m[9])
{
    const double u = cos(degrees / DEGREES), v = sin(degrees / DEGREES), s = mirrored ? -1.0 : 1.0;
    const double turned[9] = {u, -s * v, 0, v, s * u, 0, 0, 0, 1};
    memcpy(m, turned, sizeof turned);
    return try_turn(c, m);
}

// Turns that are no exchange of axes count where they fit clearly better.
static void try_turns(struct light_match *out, struct comparison *c, double best[9])
{
    double left = INFINITY, at = 0.0, m[9];
    bool mirrored = false;
    for (double a = -180.0; a < 180.0; a += COARSE)
        for (int k = 0; k < 2; k++) {
            const double off = try_angle(c, a, k == 1, m);
            if (off < left) {
                left = off;
                at = a;
                mirrored = k == 1;
            }
        }
    const double middle = at;
    for (double a = middle - COARSE; a < middle + COARSE; a += FINE) {
        const double off = try_angle(c, a, mirrored, m);
        if (off < left) {
            left = off;
            at = a;
        }
    }
    if (left >= 0.7 * out->left - 0.2)
        return;
    out->left = try_angle(c, at, mirrored, best);
    out->half_turn = false;
    snprintf(out->mend, sizeof out->mend,
             "%sit is turned by %.0f degrees %s in the plane of the picture",
             mirrored ? "y is negated and " : "", fabs(at),
             at > 0.0 ? "counter-clockwise" : "clockwise");
}

// ---------------------------------------------------------------- order

static int nearest(const struct comparison *c, vec3 seen, double *angle)
{
    int found = -1;
    *angle = 180.0;
    for (int k = 0; k < c->n; k++) {
        const double a = vec3_angle(direction_of(c, k), seen) * DEGREES;
        if (a < *angle) {
            *angle = a;
            found = k;
        }
    }
    return found;
}

// The median angle from a light of the list to its nearest one.
static double spacing(struct comparison *c)
{
    for (int i = 0; i < c->n; i++) {
        c->angle[i] = 180.0;
        for (int k = 0; k < c->n; k++)
            if (k != i)
                c->angle[i] =
                    fmin(c->angle[i],
                         vec3_angle(vec3_unit(c->list[i]), vec3_unit(c->list[k])) * DEGREES);
    }
    return sort_angles(c);
}

// Every light that was seen gets the nearest one of the list, then the offset is fitted to these
// pairs; infinite where several are nearest to the same.
static double try_order(struct comparison *c, int *partner, double apart)
{
    int alone = 0;
    c->offset = vec3_of(0, 0, 0);
    memcpy(c->turned, c->list, (size_t)c->n * sizeof *c->turned);
    for (int i = 0; i < c->n; i++)
        partner[i] = nearest(c, c->seen[i], &c->angle[i]);
    for (int i = 0; i < c->n; i++)
        c->turned[i] = c->list[partner[i]];
    for (int i = 0; i < c->n; i++) {
        int shared = 0;
        for (int k = 0; k < c->n; k++)
            shared += partner[k] == partner[i];
        alone += shared == 1;
    }
    const double off = sort_angles(c);
    return alone >= PAIRED * c->n && off < 2.0 * CLOSE * apart ? fit_offset(c) : INFINITY;
}

// ---------------------------------------------------------------- units

static double try_unit(struct comparison *c, double unit, vec3 ball)
{
    for (int i = 0; i < c->n; i++)
        c->turned[i] = vec3_sub(vec3_scale(c->list[i], unit), ball);
    return measure_angles(c, vec3_of(0, 0, 0));
}

static double find_unit(struct comparison *c, vec3 ball, double *left)
{
    double best = 1.0;
    *left = INFINITY;
    for (int k = -120; k <= 120; k++) {
        const double unit = pow(10.0, k / 20.0), off = try_unit(c, unit, ball);
        if (off < *left) {
            *left = off;
            best = unit;
        }
    }
    return best;
}

static void compare_units(struct light_match *out, struct comparison *c, vec3 ball,
                          double tolerance)
{
    double left;
    out->off = try_unit(c, 1.0, ball);
    const double unit = find_unit(c, ball, &left);
    if (out->off <= tolerance) {
        out->kind = LIGHT_MATCH_SAME;
        out->left = try_unit(c, 1.0, ball);
        return;
    }
    if (left > tolerance || out->off < 2.0 * left + 3.0)
        return;
    out->kind = LIGHT_MATCH_UNIT;
    out->unit = unit;
    out->left = left;
    snprintf(out->mend, sizeof out->mend, "positions are multiplied by %.2g", unit);
}

// ---------------------------------------------------------------- together

static bool create(struct comparison *c, const vec3 *list, const vec3 *seen, int n)
{
    const size_t most = (size_t)n;
    c->index = mem_array(most, sizeof *c->index);
    c->list = mem_array(most, sizeof *c->list);
    c->turned = mem_array(most, sizeof *c->turned);
    c->seen = mem_array(most, sizeof *c->seen);
    c->angle = mem_array(most, sizeof *c->angle);
    c->sorted = mem_array(most, sizeof *c->sorted);
    if (!c->index || !c->list || !c->turned || !c->seen || !c->angle || !c->sorted)
        return false;
    for (int i = 0; i < n; i++)
        if (!vec3_is_zero(seen[i])) {
            c->index[c->n] = i;
            c->list[c->n] = list[i];
            c->seen[c->n++] = seen[i];
        }
    return true;
}

static void destroy(struct comparison *c)
{
    mem_free(c->index);
    mem_free(c->list);
    mem_free(c->turned);
    mem_free(c->seen);
    mem_free(c->angle);
    mem_free(c->sorted);
}

static void find_nearest(const struct comparison *c, int *pair, double apart)
{
    for (int i = 0; i < c->n; i++) {
        double off;
        pair[i] = nearest(c, c->seen[i], &off);
        if (off > 0.5 * apart)
            pair[i] = -1;
    }
}

static void compare_directions(struct light_match *out, struct comparison *c, int *pair,
                               double tolerance)
{
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double best[9];
    for (int i = 0; i < c->n; i++)
        c->list[i] = vec3_unit(c->list[i]);
    const double apart = spacing(c);
    memcpy(best, identity, sizeof best);
    out->off = out->left = try_turn(c, identity);
    if (out->off > tolerance) {
        try_axes(out, c, best);
        try_turns(out, c, best);
    }
    if (out->left <= tolerance && out->off > 2.0 * out->left + 3.0)
        out->kind = LIGHT_MATCH_TURNED;
    if (out->off > tolerance) {
        const double left = try_order(c, pair, apart);
        const bool turned = out->kind == LIGHT_MATCH_TURNED;
        if (left <= fmin(turned ? 0.5 * out->left : tolerance, CLOSE * apart)) {
            *out = (struct light_match){
                .kind = LIGHT_MATCH_ORDER, .off = out->off, .left = left, .mend = REORDER};
            return;
        }
    }
    if (out->kind == LIGHT_MATCH_NONE && out->off <= LIKELY) {
        out->kind = LIGHT_MATCH_SAME;
        out->left = out->off;
    }
    if (out->kind != LIGHT_MATCH_TURNED) {
        memcpy(best, identity, sizeof best);
        *out->mend = 0;
    }
    try_turn(c, best);
    find_nearest(c, pair, apart);
}

void light_match(struct light_match *out, double *angle, int *partner, const vec3 *list,
                 const vec3 *seen, int n, double sigma, const vec3 *ball)
{
    struct comparison c = {0};
    int *pair = mem_array((size_t)n, sizeof *pair);
    *out = (struct light_match){0};
    for (int i = 0; i < n; i++) {
        angle[i] = NAN;
        partner[i] = -1;
    }
    if (pair && create(&c, list, seen, n) && c.n >= LEAST && c.n <= MOST_LIGHTS) {
        const double tolerance = fmin(fmax(LEAST_TOLERANCE, 3.0 * sigma), MOST_TOLERANCE);
        if (ball)
            compare_units(out, &c, *ball, tolerance);
        if (out->kind == LIGHT_MATCH_SAME)
            find_nearest(&c, pair, 30.0);
        else if (out->kind == LIGHT_MATCH_NONE)
            compare_directions(out, &c, pair, tolerance);
        for (int i = 0; i < c.n; i++) {
            angle[c.index[i]] = c.angle[i];
            if (out->kind != LIGHT_MATCH_UNIT)
                partner[c.index[i]] = pair[i] < 0 ? -1 : c.index[pair[i]];
        }
    }
    destroy(&c);
    mem_free(pair);
}
