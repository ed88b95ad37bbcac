// field.h - the inside of relume_reflection
#ifndef REFLECT_FIELD_H
#define REFLECT_FIELD_H

#include "world/reflect/reflection.h"
#include "world/reflect/rotation.h"

#include <relume/world/reflection.h>

// Constraints that count together: those of a region, or all.
struct gathered {
    int *member;  // numbers of constraints
    int members;
    struct rotation only;  // of a single one
};

struct relume_reflection {
    struct relume_reflection_edit edit;  // points to what is below
    struct relume_reflection_constraint *constraint;
    struct relume_reflection_region *region;
    struct gathered *gathered;  // [regions], or one
    float **along;              // [constraints]: distances of the vertices; NULL: straight
    float **region_along;       // [regions]: likewise, of geodesic ones
    size_t vertices;            // of each
    double edge;                // of the surface's triangles, mean; 0: no surface
    double least;               // of all distances to constraints
};

static inline int gathered_count(const struct relume_reflection *f)
{
    return f->edit.regions ? f->edit.regions : 1;
}

// The smooth step from 1 at `radius` to 0 at `radius` + `border`.
static inline double falling(double distance, double radius, double border)
{
    const double t = border > 0.0 ? fmin(fmax((radius + border - distance) / border, 0.0), 1.0)
                                  : (double)(distance <= radius);
    return t * t * (3.0 - 2.0 * t);
}

#endif
