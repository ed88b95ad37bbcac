// directions.c - the direction sets of the Bonn laboratory and dome, and a coarse one for trials
#include "core/math/vec.h"
#include "material/btf/values.h"

#include <relume/material/btf.h>
#include <string.h>

static const struct relume_btf_set bonn = {
    .name = "bonn",
    .summary = "81 directions of the Bonn laboratory",
    .count = 81,
    .rings = 6,
    .ring = {{0, 0, 1}, {15, 0, 6}, {30, 0, 12}, {45, 0, 18}, {60, 0, 20}, {75, 0, 24}},
};

static const struct relume_btf_set dome = {
    .name = "dome",
    .summary = "151 directions of the Bonn camera dome",
    .count = 151,
    .rings = 10,
    .ring = {{0, 0, 1},
             {11, 15, 6},
             {23.5, 0, 12},
             {30, 15, 12},
             {37.5, 0, 12},
             {45, 0, 18},
             {52.5, 7.5, 18},
             {60, 0, 24},
             {67.5, 7.5, 24},
             {75, 0, 24}},
};

static const struct relume_btf_set coarse = {
    .name = "coarse",
    .summary = "19 directions, for trials",
    .count = 19,
    .rings = 3,
    .ring = {{0, 0, 1}, {35, 0, 6}, {70, 0, 12}},
};

const struct relume_btf_set *const relume_btf_sets[] = {&bonn, &dome, &coarse, NULL};

const struct relume_btf_set *relume_btf_set_find(const char *name)
{
    for (const struct relume_btf_set *const *s = relume_btf_sets; *s; s++)
        if (!strcmp((*s)->name, name))
            return *s;
    return NULL;
}

void relume_btf_set_directions(const struct relume_btf_set *set, struct relume_vec3 *out)
{
    for (int r = 0; r < set->rings; r++) {
        const struct relume_btf_ring *ring = &set->ring[r];
        const double theta = ring->theta_deg * M_PI / 180.0;
        for (int i = 0; i < ring->count; i++) {
            const double phi = (ring->first_phi_deg + 360.0 * i / ring->count) * M_PI / 180.0;
            *out++ = vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
        }
    }
}
