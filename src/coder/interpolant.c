// interpolant.c - the interpolants behind relume_interpolants
#include "coder/interpolant.h"

#include "base/memory.h"
#include "coder/basis.h"

#include <string.h>

const struct relume_interpolant *const relume_interpolants[] = {
    &interpolant_chord,    &interpolant_angular,    &interpolant_tps,
    &interpolant_rbf,      &interpolant_natural,    &interpolant_hsh,
    &interpolant_delaunay, &interpolant_octahedral, NULL,
};

const struct relume_interpolant *relume_interpolant_find(const char *name)
{
    for (const struct relume_interpolant *const *i = relume_interpolants; *i; i++)
        if (!strcmp((*i)->name, name))
            return *i;
    return NULL;
}
