// field.c - views with depth fused in a volume of signed distances (Curless, Levoy 1996)
//
// Blocks of 8 x 8 x 8 voxels that are nowhere near what a view sees are not looked at voxel by
// voxel: their middle says whether they are before all surfaces or not. Samples of the volume are
// written once, layer by layer, so that it may be larger than memory.
#include "shape/fusion/field.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"

#include <string.h>

enum { SIDE = 8, MOST_VOXELS = 512, MOST_STEPS = 4096 };

// ---------------------------------------------------------------- where it lies

static int compare(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

// How far apart neighbouring pixels see, of some thousand pixels of all views.
static double median_step(const struct field *f, float step[MOST_STEPS])
{
    size_t count = 0, pixels = 0;
    for (int i = 0; i < f->witnesses; i++)
        pixels += (size_t)f->witness[i].depth.width * (size_t)f->witness[i].depth.height;
    const size_t every = pixels / MOST_STEPS + 1;
    size_t at = 0;
    for (int i = 0; i < f->witnesses; i++) {
        const struct witness *s = &f->witness[i];
        const size_t own = (size_t)s->depth.width * (size_t)s->depth.height;
        for (; at < own && count < MOST_STEPS; at += every) {
            const int x = (int)(at % (size_t)s->depth.width),
                      y = (int)(at / (size_t)s->depth.width);
            vec3 a, b;
            if (x + 1 < s->depth.width && witness_place(&a, s, x, y) &&
                witness_place(&b, s, x + 1, y))
                step[count++] = (float)vec3_length(vec3_sub(b, a));
        }
        at = at > own ? at - own : 0;
    }
    qsort(step, count, sizeof *step, compare);
    return count ? (double)step[count / 2] : 0.0;
}

static bool find_bounds(const struct field *f, vec3 *low, vec3 *high)
{
    vec3 p;
    *low = vec3_of(INFINITY, INFINITY, INFINITY);
    *high = vec3_scale(*low, -1.0);
    for (int i = 0; i < f->witnesses; i++)
        for (int y = 0; y < f->witness[i].depth.height; y++)
            for (int x = 0; x < f->witness[i].depth.width; x++)
                if (witness_place(&p, &f->witness[i], x, y)) {
                    *low = vec3_of(fmin(low->x, p.x), fmin(low->y, p.y), fmin(low->z, p.z));
                    *high = vec3_of(fmax(high->x, p.x), fmax(high->y, p.y), fmax(high->z, p.z));
                }
    return low->x <= high->x;
}

relume_status field_plan(struct field *f, double voxel, const struct relume_log *log)
{
    float step[MOST_STEPS];
    vec3 low, high;
    if (!find_bounds(f, &low, &high))
        return log_fail(log, RELUME_EUNFIT, "none of the depth is finite; expected a surface");
    const vec3 extent = vec3_sub(high, low);
    const double longest = fmax(extent.x, fmax(extent.y, extent.z));
    f->voxel = voxel > 0.0 ? voxel : fmax(median_step(f, step), longest / MOST_VOXELS);
    const double most = longest / f->voxel + 2 * FIELD_BAND + 4;
    if (!(f->voxel > 0.0))
        return log_fail(log, RELUME_EUNFIT,
                        "all of the depth lies at one place; expected a surface");
    if (!(most < 65536.0))
        return log_fail(log, RELUME_EINVAL,
                        "voxels of a side of %g are too fine for a scene that is %g long; expected "
                        "at least %.3g, 65536 of them along a side",
                        f->voxel, longest, longest / 65000.0);
    const double margin = (FIELD_BAND + 1) * f->voxel, e[3] = {extent.x, extent.y, extent.z};
    f->origin = vec3_sub(low, vec3_of(margin, margin, margin));
    for (int c = 0; c < 3; c++)
        f->size[c] = relume_whole(ceil(e[c] / f->voxel)) + 2 * (FIELD_BAND + 1) + 1;
    return RELUME_OK;
}

// ---------------------------------------------------------------- blocks near a surface

struct fusing {
    struct field *f;
    int blocks[3];
    uint8_t *near;  // [blocks]
};

static void mark_row(struct fusing *k, const struct witness *s, int y)
{
    const struct field *f = k->f;
    for (int x = 0; x < s->depth.width; x++) {
        vec3 p;
        int from[3], to[3];
        if (!witness_place(&p, s, x, y))
            continue;
        const double at[3] = {p.x - f->origin.x, p.y - f->origin.y, p.z - f->origin.z};
        for (int c = 0; c < 3; c++) {
            const double v = at[c] / f->voxel;
            from[c] = relume_whole(floor((v - FIELD_BAND - 1) / SIDE));
            to[c] = relume_whole(floor((v + FIELD_BAND + 1) / SIDE));
            from[c] = from[c] < 0 ? 0 : from[c];
            to[c] = to[c] >= k->blocks[c] ? k->blocks[c] - 1 : to[c];
        }
        for (int bz = from[2]; bz <= to[2]; bz++)
            for (int by = from[1]; by <= to[1]; by++)
                for (int bx = from[0]; bx <= to[0]; bx++)
                    __atomic_store_n(&k->near[((size_t)bz * (size_t)k->blocks[1] + (size_t)by) *
                                                  (size_t)k->blocks[0] +
                                              (size_t)bx],
                                     1, __ATOMIC_RELAXED);
    }
}

static void mark_view(void *context, size_t view, int worker)
{
    (void)worker;
    struct fusing *k = context;
    const struct witness *s = &k->f->witness[view];
    for (int y = 0; y < s->depth.height; y++)
        mark_row(k, s, y);
}

// ---------------------------------------------------------------- voxels

// The mean of what the views say, of views that see it well more so. What is far behind all
// surfaces, or seen by nobody, is inside.
static uint16_t value_at(const struct field *f, vec3 place)
{
    const double band = FIELD_BAND * f->voxel;
    double sum = 0.0, weights = 0.0;
    for (int i = 0; i < f->witnesses; i++) {
        struct sighting s;
        if (!witness_ask(&s, &f->witness[i], place, band) || s.distance > band)
            continue;
        const double weight = s.cosine * s.cosine;
        sum += weight * fmax(s.distance / band, -1.0);
        weights += weight;
    }
    const double mean = weights > 0.0 ? sum / weights : 1.0;
    return (uint16_t)relume_whole(mean * 32767.0 + FIELD_SURFACE + 0.5);
}

static vec3 voxel_place(const struct field *f, double x, double y, double z)
{
    return vec3_add(f->origin, vec3_of(x * f->voxel, y * f->voxel, z * f->voxel));
}

static void fuse_block(struct fusing *k, const int block[3])
{
    const struct field *f = k->f;
    uint16_t *data = f->volume->data;
    int end[3];
    for (int c = 0; c < 3; c++)
        end[c] = (block[c] + 1) * SIDE < f->size[c] ? (block[c] + 1) * SIDE : f->size[c];
    const size_t number =
        ((size_t)block[2] * (size_t)k->blocks[1] + (size_t)block[1]) * (size_t)k->blocks[0] +
        (size_t)block[0];
    const bool near = k->near[number];
    const double half = 0.5 * (SIDE - 1);
    const uint16_t middle =
        near ? 0
             : value_at(f, voxel_place(f, block[0] * SIDE + half, block[1] * SIDE + half,
                                       block[2] * SIDE + half));
    const uint16_t all = middle > 32767 ? UINT16_MAX : 0;
    for (int z = block[2] * SIDE; z < end[2]; z++)
        for (int y = block[1] * SIDE; y < end[1]; y++)
            for (int x = block[0] * SIDE; x < end[0]; x++)
                data[volume_at(f->volume, x, y, z)] =
                    near ? value_at(f, voxel_place(f, x, y, z)) : all;
}

static void fuse_layer(void *context, size_t z, int worker)
{
    (void)worker;
    struct fusing *k = context;
    for (int y = 0; y < k->blocks[1]; y++)
        for (int x = 0; x < k->blocks[0]; x++)
            fuse_block(k, (const int[3]){x, y, (int)z});
}

relume_status field_fuse(struct field *f, const struct relume_volume_params *params)
{
    struct fusing k = {.f = f};
    size_t blocks = 1;
    for (int c = 0; c < 3; c++) {
        k.blocks[c] = (f->size[c] + SIDE - 1) / SIDE;
        blocks *= (size_t)k.blocks[c];
    }
    relume_status status = volume_create(&f->volume, f->size, "u16", params);
    if (status)
        return status;
    k.near = mem_zeroed(blocks, 1);
    if (!k.near)
        return RELUME_ENOMEM;
    struct thread_told told = {params->log, "fusing", 0.0, 0.1};
    bool whole = thread_for_told(f->threads, (size_t)f->witnesses, mark_view, &k, &told);
    told = (struct thread_told){params->log, "fusing", 0.1, 1.0};
    whole = whole && thread_for_told(f->threads, (size_t)k.blocks[2], fuse_layer, &k, &told);
    mem_free(k.near);
    if (!whole)
        return RELUME_ECANCEL;
    f->volume->min = 0.0f;
    f->volume->max = UINT16_MAX;
    return RELUME_OK;
}
