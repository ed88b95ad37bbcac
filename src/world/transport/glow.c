// glow.c - Jensen and Buhler 2002, "A rapid hierarchical rendering technique for translucent
// materials": the light that enters is found at points first, and what leaves a place is a sum
// over them, in which pieces that are far off for their size are one point
//
// The paper wants points closer to each other than a mean free path, which large objects have
// millions of. Here a disc of `near` about the place is left out of the sum, by a smooth window w,
// and added as the integral of w R_d times the mean light of the points in it: with points that are
// farther apart shadows are blurred by their distance, but nothing flickers.
//
// The dipole knows half spaces only: of a thin plate each side would send on all that a half space
// does. No point sends more than that to the whole body.
#include "world/transport/glow.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <float.h>

#include <string.h>

struct glow_node {
    float area;
    uint32_t next;          // the node that follows when this one is not divided
    uint32_t first, count;  // points; a `count` of 0: it has nodes below
};
struct glow_sum {
    float place[3], radius;  // the middle of its light; all of it lies within
    float power[3];
};

enum { AT_THE_END = 4 };  // points that are not divided further

// ---------------------------------------------------------------- the hierarchy

static void divide(struct glow_tree *t, size_t first, size_t end, int shift)
{
    const struct spread_point *p = t->point;
    while (shift >= 0 && (p[first].cell >> shift & 7u) == (p[end - 1].cell >> shift & 7u))
        shift -= 3;
    const bool whole = end - first <= AT_THE_END || shift < 0;
    const size_t number = t->nodes++;
    double area = 0.0;
    for (size_t i = first; i < end; i++)
        area += (double)p[i].area;
    for (size_t from = first, to; !whole && from < end; from = to) {
        for (to = from + 1; to < end && p[to].cell >> shift == p[from].cell >> shift; to++)
            ;
        divide(t, from, to, shift - 3);
    }
    t->node[number] = (struct glow_node){.area = (float)area,
                                         .next = (uint32_t)t->nodes,
                                         .first = (uint32_t)first,
                                         .count = whole ? (uint32_t)(end - first) : 0};
}

static double window(double distance, double near)
{
    const double t = distance / near;
    return t < 1.0 ? (1.0 - t * t) * (1.0 - t * t) : 0.0;
}

// The integral of w R_d over a plane: by parts, so that R_d's peak may be as narrow as it likes.
static double share_near(const struct dipole *d, int colour, double near)
{
    enum { STEPS = 256 };
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++)
        sum += dipole_disc(d, colour, near * (i + 0.5) / STEPS) *
               (window(near * i / STEPS, near) - window(near * (i + 1) / STEPS, near));
    return sum;
}

// ---------------------------------------------------------------- light

relume_status glow_make(struct glow *out, const struct glow_tree *tree)
{
    *out = (struct glow){.tree = tree,
                         .light = mem_zeroed(tree->points, sizeof *out->light),
                         .sum = mem_zeroed(tree->nodes, sizeof *out->sum)};
    if (out->light && out->sum)
        return RELUME_OK;
    glow_free(out);
    return RELUME_ENOMEM;
}

void glow_free(struct glow *g)
{
    mem_free(g->light);
    mem_free(g->sum);
    *g = (struct glow){.tree = NULL};
}

// Points and middles of nodes, each by its light, or where all is dark by its area.
struct middle {
    vec3 by_light, by_area;
    double light, area;
};

static void weigh(struct middle *m, vec3 place, const float power[3], double area)
{
    const double light = (double)(power[0] + power[1] + power[2]);
    m->by_light = vec3_along(m->by_light, place, light);
    area = fmax(area, (double)FLT_MIN);
    m->by_area = vec3_along(m->by_area, place, area);
    m->light += light, m->area += area;
}

static vec3 middle_of(const struct middle *m)
{
    return m->light > 0.0 ? vec3_scale(m->by_light, 1.0 / m->light)
                          : vec3_scale(m->by_area, 1.0 / m->area);
}

static void power_of(float power[3], const struct glow *g, size_t point)
{
    for (int c = 0; c < 3; c++)
        power[c] = g->light[point][c] * g->tree->part[point][c] * g->tree->point[point].area;
}

static void sum_points(struct glow_sum *s, const struct glow *g, const struct glow_node *n)
{
    struct middle m = {.light = 0.0};
    for (size_t i = n->first; i < n->first + n->count; i++) {
        float power[3];
        power_of(power, g, i);
        weigh(&m, vec3_floats(g->tree->point[i].position), power, (double)g->tree->point[i].area);
        for (int c = 0; c < 3; c++)
            s->power[c] += power[c];
    }
    const vec3 at = middle_of(&m);
    double radius = 0.0;
    for (size_t i = n->first; i < n->first + n->count; i++)
        radius = fmax(radius, vec3_length(vec3_sub(vec3_floats(g->tree->point[i].position), at)));
    s->place[0] = (float)at.x, s->place[1] = (float)at.y, s->place[2] = (float)at.z;
    s->radius = (float)radius;
}

static void sum_nodes(struct glow_sum *s, const struct glow *g, size_t number)
{
    const struct glow_node *node = g->tree->node;
    const size_t end = node[number].next;
    struct middle m = {.light = 0.0};
    for (size_t i = number + 1; i < end; i = node[i].next) {
        weigh(&m, vec3_floats(g->sum[i].place), g->sum[i].power, (double)node[i].area);
        for (int c = 0; c < 3; c++)
            s->power[c] += g->sum[i].power[c];
    }
    const vec3 at = middle_of(&m);
    double radius = 0.0;
    for (size_t i = number + 1; i < end; i = node[i].next)
        radius = fmax(radius, vec3_length(vec3_sub(vec3_floats(g->sum[i].place), at)) +
                                  (double)g->sum[i].radius);
    s->place[0] = (float)at.x, s->place[1] = (float)at.y, s->place[2] = (float)at.z;
    s->radius = (float)radius;
}

void glow_sum_up(struct glow *g)
{
    for (size_t i = g->tree->nodes; i-- > 0;) {
        struct glow_sum *s = &g->sum[i];
        *s = (struct glow_sum){.radius = 0.0f};
        if (g->tree->node[i].count)
            sum_points(s, g, &g->tree->node[i]);
        else
            sum_nodes(s, g, i);
    }
}

// ---------------------------------------------------------------- what leaves

struct asked {
    vec3 place, normal;
    double near_area;  // of the points near by, each by the window
    float near[3];     // ... their light
    float rgb[3];
};

static void add(struct asked *a, const struct dipole *d, double distance, double part,
                const float power[3])
{
    float leaves[3];
    dipole_at(leaves, d, distance);
    for (int c = 0; c < 3; c++)
        a->rgb[c] += (float)part * leaves[c] * power[c];
}

// A point on the other side of something thin is none of those near by.
static bool is_beside(const struct asked *a, const struct glow_tree *t, size_t i)
{
    const double TURNED = -0.3;
    return t->thin[i] || vec3_dot(a->normal, vec3_floats(t->point[i].normal)) > TURNED;
}

// The other side of something thinner than points are apart: each is a disc of its area, of which a
// plane at that distance has what lies between two radii.
static void add_across(struct asked *a, const struct dipole *d, double distance, float area,
                       const float power[3])
{
    const double end = sqrt(distance * distance + (double)area / M_PI);
    for (int c = 0; c < 3; c++)
        a->rgb[c] += (float)((dipole_disc(d, c, end) - dipole_disc(d, c, distance)) *
                             (double)power[c] / fmax((double)area, (double)FLT_MIN));
}

static void add_point(struct asked *a, const struct glow *g, size_t i)
{
    const struct glow_tree *t = g->tree;
    const double distance = vec3_length(vec3_sub(vec3_floats(t->point[i].position), a->place));
    float power[3];
    power_of(power, g, i);
    if (!(distance < t->near)) {
        add(a, &t->dipole, distance, 1.0, power);
    } else if (!is_beside(a, t, i)) {
        add_across(a, &t->dipole, distance, t->point[i].area, power);
    } else {
        const double w = window(distance, t->near);
        a->near_area += w * (double)t->point[i].area;
        for (int c = 0; c < 3; c++)
            a->near[c] += (float)w * power[c];
        add(a, &t->dipole, distance, 1.0 - w, power);
    }
}

int glow_leaves(float rgb[3], const struct glow *g, vec3 place, vec3 normal, double error)
{
    const struct glow_tree *t = g->tree;
    struct asked a = {.place = place, .normal = normal};
    int pieces = 0;
    for (size_t i = 0; i < t->nodes;) {
        const struct glow_node *node = &t->node[i];
        const struct glow_sum *s = &g->sum[i];
        const double d = vec3_length(vec3_sub(vec3_floats(s->place), place));
        const double open = d - (double)s->radius;
        if (open > t->near && (open > t->reach || (double)node->area < error * d * d)) {
            add(&a, &t->dipole, d, 1.0, s->power);
            pieces++;
            i = node->next;
        } else if (node->count) {
            for (size_t k = node->first; k < node->first + node->count; k++)
                add_point(&a, g, k);
            pieces += (int)node->count;
            i = node->next;
        } else {
            i++;
        }
    }
    for (int c = 0; c < 3; c++) {
        const double even = a.near_area > 0.0 ? (double)a.near[c] / a.near_area : 0.0;
        rgb[c] = a.rgb[c] + t->near_share[c] * (float)even;
    }
    return pieces;
}

// ---------------------------------------------------------------- the whole

struct weighing {
    struct glow_tree *tree;
    struct glow even;
    struct weight {
        float part[3];
    } * of_node;
};

enum { AT_ONCE = 256 };  // nodes

// The light that the points of a node share out, in a body that is lit by 1 all over: R_d is the
// same both ways.
static void weigh_nodes(void *context, size_t item, int worker)
{
    (void)worker;
    const double COARSE = 0.5;
    const struct weighing *w = context;
    const struct glow_tree *t = w->tree;
    for (size_t i = AT_ONCE * item; i < AT_ONCE * (item + 1) && i < t->nodes; i++) {
        const struct spread_point *p = &t->point[t->node[i].first];
        float rgb[3];
        if (!t->node[i].count)
            continue;
        (void)glow_leaves(rgb, &w->even, vec3_floats(p->position), vec3_floats(p->normal), COARSE);
        for (int c = 0; c < 3; c++) {
            const double plane = dipole_disc(&t->dipole, c, INFINITY);
            w->of_node[i].part[c] = (double)rgb[c] > plane ? (float)plane / rgb[c] : 1.0f;
        }
    }
}

static relume_status weigh_points(struct glow_tree *t, int threads)
{
    struct weighing w = {.tree = t, .of_node = mem_array(t->nodes, sizeof *w.of_node)};
    relume_status status = w.of_node ? glow_make(&w.even, t) : RELUME_ENOMEM;
    for (size_t i = 0; i < t->points && !status; i++)
        for (int c = 0; c < 3; c++)
            t->part[i][c] = w.even.light[i][c] = 1.0f;
    if (!status) {
        glow_sum_up(&w.even);
        thread_for(threads, (t->nodes + AT_ONCE - 1) / AT_ONCE, weigh_nodes, &w);
    }
    for (size_t i = 0; i < t->nodes && !status; i++)
        for (size_t k = 0; k < t->node[i].count; k++)
            memcpy(t->part[t->node[i].first + k], w.of_node[i].part, sizeof *t->part);
    glow_free(&w.even);
    mem_free(w.of_node);
    return status;
}

relume_status glow_tree_make(struct glow_tree *out, const struct spread *s, const bool *thin,
                             const struct scattering *scattering, double mm, int threads)
{
    const double NEAR = 2.5, NOTHING = 12.0;
    *out = (struct glow_tree){.point = s->point,
                              .thin = thin,
                              .points = s->count,
                              .node = mem_array(2 * s->count + 1, sizeof *out->node),
                              .part = mem_array(s->count, sizeof *out->part)};
    if (!out->node || !out->part) {
        glow_tree_free(out);
        return RELUME_ENOMEM;
    }
    double area = 0.0, least = INFINITY;
    for (size_t i = 0; i < s->count; i++)
        area += (double)s->point[i].area;
    dipole_make(&out->dipole, scattering, mm);
    out->near = s->count ? NEAR * sqrt(area / (double)s->count) : 0.0;
    for (int c = 0; c < 3; c++) {
        out->near_share[c] = (float)share_near(&out->dipole, c, out->near);
        least = fmin(least, out->dipole.falloff[c]);
    }
    out->reach = least > 0.0 ? NOTHING / least : INFINITY;
    if (s->count)
        divide(out, 0, s->count, 3 * (s->levels - 1));
    const relume_status status = weigh_points(out, threads);
    if (status)
        glow_tree_free(out);
    return status;
}

void glow_tree_free(struct glow_tree *t)
{
    mem_free(t->node);
    mem_free(t->part);
    *t = (struct glow_tree){.node = NULL};
}
