// turn.c - the rotation at a place, and what it does to a reflection
#include "world/reflect/field.h"
#include "world/reflect/reflection.h"

// ---------------------------------------------------------------- distances

static double straight(vec3 a, vec3 b)
{
    return vec3_length(vec3_sub(a, b));
}

// Between vertices, distances along the surface are interpolated, which is wrong by up to half an
// edge about their origin: so near it is straight.
static double along_surface(const relume_reflection *f, const float *distance, vec3 from,
                            const struct relume_reflection_place *place)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++)
        if (place->weight[k] > 0.0)
            sum += place->weight[k] * (double)distance[place->vertex[k]];
    const double near = falling(sum, 2.0 * f->edge, 2.0 * f->edge);
    return near > 0.0 ? near * straight(from, place->position) + (1.0 - near) * sum : sum;
}

static double to_stroke(const struct relume_reflection_region *region, vec3 place)
{
    double least = straight(region->stroke[0], place);
    for (int i = 0; i + 1 < region->points; i++) {
        const vec3 a = region->stroke[i], ab = vec3_sub(region->stroke[i + 1], a);
        const double length = vec3_dot(ab, ab);
        const double t = length > 0.0 ? vec3_dot(vec3_sub(place, a), ab) / length : 0.0;
        least = fmin(least, straight(vec3_along(a, ab, fmin(fmax(t, 0.0), 1.0)), place));
    }
    return least;
}

double relume_reflection_weight(const relume_reflection *f, int number,
                                const struct relume_reflection_place *place)
{
    const struct relume_reflection_region *region = &f->region[number];
    const double distance = region->shape == RELUME_REFLECTION_STROKES
                                ? to_stroke(region, place->position)
                            : region->shape == RELUME_REFLECTION_GEODESIC
                                ? along_surface(f, f->region_along[number], region->centre, place)
                                : straight(region->centre, place->position);
    return falling(distance, region->radius, region->border);
}

// ---------------------------------------------------------------- rotations

// Eq. 7.5 of the constraints that count together. Weights are relative to the nearest one's, so
// that none overflows.
static struct rotation rotation_of(const relume_reflection *f, const struct gathered *g,
                                   const struct relume_reflection_place *place)
{
    double squared[RELUME_REFLECTION_CONSTRAINTS_MOST], least = INFINITY;
    struct rotation sum = {{vec3_of(0, 0, 0), vec3_of(0, 0, 0), vec3_of(0, 0, 0)}};
    if (g->members == 1)
        return g->only;
    for (int i = 0; i < g->members; i++) {
        const int n = g->member[i];
        const vec3 at = f->constraint[n].position;
        const double d = f->edit.geodesic ? along_surface(f, f->along[n], at, place)
                                          : straight(at, place->position);
        squared[i] = fmax(d, f->least) * fmax(d, f->least);
        least = fmin(least, squared[i]);
    }
    for (int i = 0; i < g->members; i++) {
        const struct relume_reflection_constraint *c = &f->constraint[g->member[i]];
        if (squared[i] < INFINITY)
            add_outer(&sum, least / squared[i], c->edited, c->original);
    }
    return rotation_nearest(&sum);
}

vec3 relume_reflection_turn(const relume_reflection *f, const struct relume_reflection_place *place,
                            vec3 r)
{
    struct rotation sum = {{vec3_of(0, 0, 0), vec3_of(0, 0, 0), vec3_of(0, 0, 0)}}, last = sum;
    double total = 0.0;
    int counted = 0;
    for (int i = 0; i < gathered_count(f); i++) {
        const struct gathered *g = &f->gathered[i];
        const double a = g->members == 0   ? 0.0
                         : f->edit.regions ? relume_reflection_weight(f, i, place)
                                           : 1.0;
        if (!(a > 0.0))
            continue;
        last = rotation_of(f, g, place);
        for (int k = 0; k < 3; k++)
            sum.row[k] = vec3_along(sum.row[k], last.row[k], a);
        total += a;
        counted++;
    }
    if (!counted)
        return r;
    if (counted > 1 || total < 1.0) {
        if (total < 1.0)
            add_outer(&sum, 1.0 - total, r, r);
        last = rotation_nearest(&sum);
    }
    return rotate(&last, r);
}

vec3 relume_reflection_original(const relume_reflection *f, vec3 position, vec3 normal, vec3 eye)
{
    const vec3 from = f && f->edit.frozen ? f->edit.eye : eye, way = vec3_sub(position, from);
    if (!(vec3_length(way) > 0.0))
        return normal;
    const vec3 i = vec3_unit(way);
    return vec3_along(i, normal, -2.0 * vec3_dot(i, normal));
}
