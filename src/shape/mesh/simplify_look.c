// simplify_look.c - normals that show a coarse surface as the fine one was, and what is seen of the
// difference
//
// A vertex that stays stands for those that have gone around it. Its normal is the one by which the
// interpolated normals differ least from the original's, in the mean square over the triangles
// around it (the others hold still; each move does the vertex that it goes to, and a few rounds
// over all do the rest). What is left over is finer than those triangles: as a pattern whose waves
// are as long as they are wide it is seen up to some distance only, and less where the original's
// normals vary as much themselves (masking). What of it does not average out is a longer wave.
// Where the original bends much a normal is another one close by: what a pattern turns normals by
// when it lies a little beside where it was, less than the eye tells apart, does not count.
#include "shape/mesh/simplify.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846
// Lengths of waves in radii of what lies around a vertex. Of 0.4 to 3 tried, 0.8 to 1.5 took the
// fewest triangles at equal pictures.
#define WAVE      1.2
#define LONG_WAVE 4.0
// A mean of normals that is shorter says little: they point all ways.
#define LEAST_NORMAL 0.3

void look_at_vertex(const struct simplify *s, struct samples *to, uint32_t vertex)
{
    for (int i = 0; i < to->fitted; i++)
        if (to->fit[i].vertex == vertex)
            return;
    if (to->fitted == FAN)
        return;
    struct fitted *f = &to->fit[to->fitted];
    *f = (struct fitted){.vertex = vertex, .group = to->fitted};
    memcpy(f->normal, s->shown[vertex], sizeof f->normal);
    for (int i = 0; i < to->fitted; i++)  // those of one normal keep one
        if (!memcmp(f->normal, to->fit[i].normal, sizeof f->normal)) {
            f->group = to->fit[i].group;
            break;
        }
    to->fitted++;
}

void look_begin(struct samples *to)
{
    for (size_t i = 0; i < to->count; i++) {
        struct landing *l = &to->landing[i];
        for (int k = 0; k < 3; k++) {
            l->fit[k] = -1;
            for (int j = 0; j < to->fitted; j++)
                if (to->fit[j].vertex == l->corner[k])
                    l->fit[k] = (int8_t)j;
        }
    }
}

static vec3 corner_normal(const struct simplify *s, const struct samples *to,
                          const struct landing *l, int k)
{
    return vec3_floats(l->fit[k] < 0 ? s->shown[l->corner[k]] : to->fit[l->fit[k]].normal);
}

// What its own share of a landing's normal should be, weighed, and by how much.
static void add_landing(const struct simplify *s, const struct samples *to, const struct landing *l,
                        int group, vec3 *sum, double *weight)
{
    vec3 want = normal_of(s, l->vertex);
    double share = 0.0;
    for (int k = 0; k < 3; k++)
        if (l->fit[k] >= 0 && to->fit[l->fit[k]].group == group)
            share += (double)l->weight[k];
        else
            want = vec3_along(want, corner_normal(s, to, l, k), -(double)l->weight[k]);
    const double a = share * (double)s->area[l->vertex];
    *sum = vec3_along(*sum, want, a);
    *weight += a * share;
}

void look_fit(const struct simplify *s, struct samples *to)
{
    for (int g = 0; g < to->fitted; g++) {
        if (to->fit[g].group != g)
            continue;
        vec3 sum = vec3_of(0, 0, 0);
        double weight = 0.0;
        for (int i = g; i < to->fitted; i++)
            if (to->fit[i].group == g) {
                const uint32_t v = to->fit[i].vertex;
                sum = vec3_along(sum, normal_of(s, v), (double)s->area[v]);
                weight += (double)s->area[v];
            }
        for (size_t i = 0; i < to->count; i++)
            add_landing(s, to, &to->landing[i], g, &sum, &weight);
        if (!(vec3_length(sum) > LEAST_NORMAL * weight))
            continue;
        const vec3 normal = vec3_scale(sum, 1.0 / weight);
        for (int i = g; i < to->fitted; i++)
            if (to->fit[i].group == g)
                vec3_store(to->fit[i].normal, normal);
    }
}

// Sums over what lies around: of the original's normals, and of the difference to what is shown.
struct sums {
    vec3 original, off;
    double original_2, off_2, weight;
};

// The difference that is left when the pattern may lie `slip` beside where it was.
static void add(struct sums *s, vec3 shown, vec3 original, double area, double slip)
{
    const double length = vec3_length(shown);
    vec3 d = vec3_sub(vec3_scale(shown, length > 0.0 ? 1.0 / length : 0.0), original);
    const double off = vec3_length(d);
    d = vec3_scale(d, off > slip ? (off - slip) / off : 0.0);
    s->original = vec3_along(s->original, original, area);
    s->original_2 += area * vec3_dot(original, original);
    s->off = vec3_along(s->off, d, area);
    s->off_2 += area * vec3_dot(d, d);
    s->weight += area;
}

static double angle_of(double chord)
{
    return 2.0 * asin(fmin(0.5 * chord, 1.0));
}

static double turn_by_slip(const struct simplify *s, uint32_t vertex)
{
    return s->slip * (double)s->bend[s->connect.point[vertex]];
}

double look_distance(const struct simplify *s, const struct samples *to)
{
    struct sums sums = {.weight = 0.0};
    for (int i = 0; i < to->fitted; i++) {
        const uint32_t v = to->fit[i].vertex;
        add(&sums, vec3_floats(to->fit[i].normal), normal_of(s, v), (double)s->area[v],
            turn_by_slip(s, v));
    }
    for (size_t i = 0; i < to->count; i++) {
        const struct landing *l = &to->landing[i];
        vec3 n = vec3_of(0, 0, 0);
        for (int k = 0; k < 3; k++)
            n = vec3_along(n, corner_normal(s, to, l, k), (double)l->weight[k]);
        add(&sums, n, normal_of(s, l->vertex), (double)s->area[l->vertex],
            turn_by_slip(s, l->vertex));
    }
    if (!(sums.weight > 0.0))
        return 0.0;
    const double mean = vec3_length(sums.original) / sums.weight;
    const double masker = angle_of(sqrt(fmax(sums.original_2 / sums.weight - mean * mean, 0.0)));
    const double off = angle_of(sqrt(sums.off_2 / sums.weight));
    const double drift = angle_of(vec3_length(sums.off) / sums.weight);
    const double waves = fmax(WAVE * visible_finest(&s->visible, off, masker),
                              LONG_WAVE * visible_finest(&s->visible, drift, masker));
    // a wave is 180 / pi * length / distance degrees long
    return waves * sqrt(to->area / PI) * 180.0 / PI;
}
