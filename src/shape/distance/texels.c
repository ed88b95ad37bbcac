// texels.c - rectangles on planes, and what their texels show
#include "shape/distance/texels.h"

#include "core/math/scalar.h"
#include "shape/distance/lod.h"

#include <stdlib.h>

// ---------------------------------------------------------------- the least rectangle

static int by_place(const void *a, const void *b)
{
    const vec3 *const p = a, *const q = b;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    return (p->y > q->y) - (p->y < q->y);
}

static double turn(vec3 a, vec3 b, vec3 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The convex hull of `n` points of a plane (Andrew 1979), in place of them; how many it has.
// `hull` holds n + 1.
static size_t hull_of(vec3 *point, size_t n, vec3 *hull)
{
    size_t k = 0;
    qsort(point, n, sizeof *point, by_place);
    for (size_t i = 0; i < n; i++) {
        while (k >= 2 && turn(hull[k - 2], hull[k - 1], point[i]) <= 0.0)
            k--;
        hull[k++] = point[i];
    }
    for (size_t i = n - 1, lower = k + 1; i-- > 0;) {
        while (k >= lower && turn(hull[k - 2], hull[k - 1], point[i]) <= 0.0)
            k--;
        hull[k++] = point[i];
    }
    return k > 1 ? k - 1 : k;
}

struct box {
    vec3 x;  // unit, its axis in the plane's coordinates
    struct range across, up;
};

static double box_area(const struct box *b)
{
    return (b->across.high - b->across.low) * (b->up.high - b->up.low);
}

static struct box box_along(const vec3 *hull, size_t n, vec3 x)
{
    struct box b = {x, range_none, range_none};
    for (size_t i = 0; i < n; i++) {
        range_add(&b.across, x.x * hull[i].x + x.y * hull[i].y);
        range_add(&b.up, x.x * hull[i].y - x.y * hull[i].x);
    }
    return b;
}

// One side of it lies on the hull (Freeman and Shapira 1975).
static struct box least_box(const vec3 *hull, size_t n)
{
    struct box best = box_along(hull, n, vec3_of(1, 0, 0));
    for (size_t i = 0; i < n; i++) {
        const vec3 edge = vec3_sub(hull[(i + 1) % n], hull[i]);
        if (!(vec3_length(edge) > 0.0))
            continue;
        const struct box b = box_along(hull, n, vec3_unit(edge));
        if (box_area(&b) < box_area(&best) * (1.0 - 1e-9))
            best = b;
    }
    return best;
}

void texels_lay(struct relume_billboard *out, const struct soup *s, const struct partition *p,
                size_t number, vec3 *scratch)
{
    const struct plane *plane = &p->plane[number];
    struct range height = range_none;
    size_t n = 0;
    for (uint32_t t = p->head[number]; t != NOBODY; t = p->next[t])
        for (int k = 0; k < 3; k++) {
            const vec3 at = s->corner[t][k];
            range_add(&height, vec3_dot(at, plane->normal));
            scratch[n++] = vec3_of(vec3_dot(at, plane->x), vec3_dot(at, plane->y), 0);
        }
    vec3 *const hull = scratch + n;
    const struct box b = least_box(hull, hull_of(scratch, n, hull));
    const vec3 across = vec3_along(vec3_scale(plane->x, b.x.x), plane->y, b.x.y);
    const vec3 up = vec3_cross(plane->normal, across);
    const double middle = 0.5 * (height.low + height.high);
    vec3 corner = vec3_along(s->middle, plane->normal, middle);
    corner = vec3_along(vec3_along(corner, across, b.across.low), up, b.up.low);
    *out = (struct relume_billboard){.error = (float)(0.5 * (height.high - height.low))};
    vec3_store(out->corner, corner);
    // their lengths, until there are texels
    vec3_store(out->across,
               vec3_scale(across, fmax(b.across.high - b.across.low, 1e-6 * s->longest)));
    vec3_store(out->up, vec3_scale(up, fmax(b.up.high - b.up.low, 1e-6 * s->longest)));
    vec3_store(out->normal, plane->normal);
}

// A rectangle of whole texels is no larger for rounding.
static double texels_in(double length, double side)
{
    return fmax(ceil(length / side - 1e-5), 1.0);
}

bool texels_size(struct relume_billboard *b, double side, size_t most)
{
    const vec3 across = vec3_floats(b->across), up = vec3_floats(b->up);
    const double w = vec3_length(across), h = vec3_length(up);
    const double columns = texels_in(w, side), rows = texels_in(h, side);
    if (!(columns * rows <= (double)most))
        return false;
    b->width = (int)columns;
    b->height = (int)rows;
    const vec3 x = vec3_unit(across), y = vec3_unit(up);
    vec3_store(b->corner,
               vec3_along(vec3_along(vec3_floats(b->corner), x, -0.5 * (columns * side - w)), y,
                          -0.5 * (rows * side - h)));
    vec3_store(b->across, x);
    vec3_store(b->up, y);
    return true;
}

// ---------------------------------------------------------------- what a texel shows

struct polygon {
    vec3 p[10];  // z: the height above the plane
    int n;
};

static double along(vec3 p, int axis)
{
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

// What lies where sign * its coordinate <= sign * limit (Sutherland and Hodgman 1974).
static void clip(struct polygon *poly, int axis, double sign, double limit)
{
    struct polygon out = {.n = 0};
    for (int i = 0; i < poly->n; i++) {
        const vec3 a = poly->p[i], b = poly->p[(i + 1) % poly->n];
        const double da = sign * (along(a, axis) - limit), db = sign * (along(b, axis) - limit);
        if (da <= 0.0)
            out.p[out.n++] = a;
        if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0))
            out.p[out.n++] = vec3_along(a, vec3_sub(b, a), da / (da - db));
    }
    *poly = out;
}

// Its area, and the middle of it.
static double middle_of(const struct polygon *poly, vec3 *middle)
{
    double twice = 0.0;
    vec3 sum = {0, 0, 0};
    for (int i = 2; i < poly->n; i++) {
        const double part = fabs(turn(poly->p[0], poly->p[i - 1], poly->p[i]));
        const vec3 corners = vec3_add(vec3_add(poly->p[0], poly->p[i - 1]), poly->p[i]);
        sum = vec3_along(sum, corners, part / 3.0);
        twice += part;
    }
    *middle = twice > 0.0 ? vec3_scale(sum, 1.0 / twice) : sum;
    return 0.5 * twice;
}

// A billboard that is being filled.
struct canvas {
    struct relume_billboard_texel *texel;
    const struct relume_billboard *b;
    const struct soup *s;
    float *shown;  // of each texel: the height of what it shows so far, and its area
    bool behind;   // what is drawn now fills gaps
    double reach;  // how far from the plane it is drawn
};

static void set_source(struct relume_billboard_texel *t, const vec3 p[3], uint32_t number, vec3 at)
{
    const double all = turn(p[0], p[1], p[2]);
    const double second = turn(p[0], at, p[2]) / all, third = turn(p[0], p[1], at) / all;
    t->triangle = number;
    t->weight[0] = (float)fmin(fmax(second, 0.0), 1.0);
    t->weight[1] = (float)fmin(fmax(third, 0.0), 1.0 - (double)t->weight[0]);
}

// Of two triangles that fill a good part of a texel the higher one is seen; else the larger part.
static bool is_seen(const struct canvas *c, size_t place, double area, double height)
{
    const double GOOD_PART = 0.25;
    const float *const shown = &c->shown[2 * place];
    if (c->texel[place].triangle == RELUME_BILLBOARD_NONE)
        return true;
    if ((double)shown[1] < GOOD_PART)
        return area > (double)shown[1];
    return !c->behind && area >= GOOD_PART && height > (double)shown[0];
}

static void show(struct canvas *c, size_t place, const vec3 p[3], uint32_t number, double area,
                 vec3 middle)
{
    struct relume_billboard_texel *const t = &c->texel[place];
    const bool seen = is_seen(c, place, area, middle.z);
    t->coverage = (float)fmin((double)t->coverage + area, 1.0);
    if (!seen)
        return;
    c->shown[2 * place] = (float)middle.z;
    c->shown[2 * place + 1] = (float)area;
    set_source(t, p, number, middle);
}

// The corners in texels, and heights.
static void project(vec3 out[3], const struct canvas *c, size_t triangle, double side)
{
    const struct relume_billboard *const b = c->b;
    for (int k = 0; k < 3; k++) {
        const vec3 at =
            vec3_sub(vec3_add(c->s->corner[triangle][k], c->s->middle), vec3_floats(b->corner));
        out[k] =
            vec3_of(vec3_dot(at, vec3_floats(b->across)) / side,
                    vec3_dot(at, vec3_floats(b->up)) / side, vec3_dot(at, vec3_floats(b->normal)));
    }
}

static int cell(double v, int most)
{
    return (int)fmin(fmax(floor(v), 0.0), most);
}

static void draw(struct canvas *c, const vec3 p[3], uint32_t number)
{
    struct range x = range_none, y = range_none;
    for (int k = 0; k < 3; k++) {
        range_add(&x, p[k].x);
        range_add(&y, p[k].y);
    }
    if (fabs(turn(p[0], p[1], p[2])) < 1e-12 || x.high <= 0.0 || y.high <= 0.0 ||
        x.low >= c->b->width || y.low >= c->b->height)
        return;
    for (int row = cell(y.low, c->b->height - 1); row <= cell(y.high, c->b->height - 1); row++) {
        struct polygon band = {{p[0], p[1], p[2]}, 3};
        clip(&band, 1, -1.0, row);
        clip(&band, 1, 1.0, row + 1);
        clip(&band, 2, -1.0, -c->reach);
        clip(&band, 2, 1.0, c->reach);
        x = range_none;
        for (int i = 0; i < band.n; i++)
            range_add(&x, band.p[i].x);
        for (int i = cell(x.low, c->b->width - 1); band.n && i <= cell(x.high, c->b->width - 1);
             i++) {
            struct polygon part = band;
            vec3 middle;
            clip(&part, 0, -1.0, i);
            clip(&part, 0, 1.0, i + 1);
            const double area = middle_of(&part, &middle);
            if (area > 1e-9)
                show(c, (size_t)row * (size_t)c->b->width + (size_t)i, p, number, area, middle);
        }
    }
}

// Whether a triangle of another plane may be shown on this one, too.
static bool lies_near(const struct soup *s, size_t triangle, const struct plane *p, double error,
                      double least_cosine)
{
    struct fit f = fit_none();
    fit_add(&f, s, triangle, p->normal);
    return f.least_cosine >= least_cosine && f.height.low <= p->offset + error &&
           f.height.high >= p->offset - error;
}

void texels_fill(struct relume_billboards *cloud, size_t number, const struct soup *s,
                 const struct partition *p, const struct filling *f)
{
    const struct relume_billboard *const b = &cloud->billboard[number];
    const size_t texels = (size_t)b->width * (size_t)b->height;
    struct canvas c = {cloud->texel + b->first, b, s, f->shown, false, INFINITY};
    struct plane plane = p->plane[number];
    plane.offset = vec3_dot(vec3_sub(vec3_floats(b->corner), s->middle), plane.normal);
    vec3 corner[3];
    for (size_t i = 0; i < texels; i++)
        c.texel[i] = (struct relume_billboard_texel){.triangle = RELUME_BILLBOARD_NONE};
    for (uint32_t t = p->head[number]; t != NOBODY; t = p->next[t]) {
        cloud->owner[s->number[t]] = (uint32_t)number;
        project(corner, &c, t, (double)cloud->side);
        draw(&c, corner, s->number[t]);
    }
    c.behind = true;
    c.reach = f->error;
    for (size_t t = 0; t < s->count; t++)
        if (f->owner[t] != number && lies_near(s, t, &plane, f->error, f->least_cosine)) {
            project(corner, &c, t, (double)cloud->side);
            draw(&c, corner, s->number[t]);
        }
}
