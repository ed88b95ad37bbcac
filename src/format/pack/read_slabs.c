// read_slabs.c - where a slab's cameras and window lie, or those of several slabs around an object
#include "format/pack/format.h"
#include "format/pack/reader.h"
#include "image/geometry/geometry.h"

#include <stdio.h>

// The planes of slab `i` of `count`.
static relume_status read_planes(const relume_pack *p, struct relume_geometry *g, int i, int count)
{
    const float *v = reader_floats(p, 0, ATTR_SLAB, 6 * count);
    v = v ? v + 6 * i : NULL;
    if (!v || v[0] == v[1] || !(v[2] < v[4] && v[3] < v[5]))
        return reader_bad(p, ATTR_SLAB, "uv z, st z, st min, st max of every slab");
    g->uv_z = (double)v[0];
    g->st_z = (double)v[1];
    for (int axis = 0; axis < 2; axis++) {
        g->st_min[axis] = (double)v[2 + axis];
        g->st_max[axis] = (double)v[4 + axis];
    }
    return RELUME_OK;
}

static struct relume_vec3 vector_of(const float v[3])
{
    return (struct relume_vec3){(double)v[0], (double)v[1], (double)v[2]};
}

static relume_status read_several(relume_pack *p)
{
    int found;
    (void)exr_get_floats(p->file, 0, ATTR_POSE, &found);
    const float *v = reader_floats(p, 0, ATTR_POSE, found);
    if (!v || found < 12 || found % 12 || found / 12 > RELUME_MOST_SLABS)
        return reader_bad(p, ATTR_POSE, "origin and three axes of 1 to 64 slabs");
    const int n = found / 12;
    struct relume_geometry *slab = arena_array(&p->arena, (size_t)n, sizeof *slab);
    if (!slab)
        return RELUME_ENOMEM;
    for (int i = 0; i < n; i++, v += 12) {
        slab[i] = p->info.geometry;
        slab[i].pose = (struct relume_pose){vector_of(v),
                                            {vector_of(v + 3), vector_of(v + 6), vector_of(v + 9)}};
        if (!relume_pose_normalise(&slab[i].pose))
            return reader_bad(p, ATTR_POSE, "rotations: unit vectors, perpendicular, right-handed");
        const relume_status status = read_planes(p, &slab[i], i, n);
        if (status)
            return status;
    }
    p->info.slabs = n;
    p->info.slab = slab;
    p->info.geometry = slab[0];
    return RELUME_OK;
}

relume_status reader_read_slabs(relume_pack *p)
{
    int pose;
    const bool several = exr_get_floats(p->file, 0, ATTR_POSE, &pose) != NULL;
    return several ? read_several(p) : read_planes(p, &p->info.geometry, 0, 1);
}

static relume_status read_member(relume_pack *p, int *slab_of, int view)
{
    char where[32];
    snprintf(where, sizeof where, "view %d", view);
    if (!exr_get_int(p->file, p->parts[view].codes, ATTR_MEMBER, &slab_of[view]) ||
        slab_of[view] < 0 || slab_of[view] >= p->info.slabs)
        return reader_bad(p, where, ATTR_MEMBER ", which of the slabs it is of");
    return RELUME_OK;
}

relume_status reader_read_members(relume_pack *p)
{
    bool seen[RELUME_MOST_SLABS] = {false};
    if (!p->info.slabs)
        return RELUME_OK;
    int *slab_of = arena_array(&p->arena, (size_t)p->info.views, sizeof *slab_of);
    relume_status status = slab_of ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < p->info.views; i++) {
        status = read_member(p, slab_of, i);
        if (!status)
            seen[slab_of[i]] = true;
    }
    for (int i = 0; !status && i < p->info.slabs; i++)
        if (!seen[i])
            status = reader_bad(p, ATTR_MEMBER, "at least one view of every slab");
    p->info.slab_of = slab_of;
    return status;
}
