// file_views.c - the views of a file: where their cameras stand, which of them a frame needs, and
// their pictures under its lights
#include "draw/file_views.h"

#include "cli/program/say.h"
#include "image/geometry/geometry.h"
#include "relight/view/slab_set.h"
#include "relight/view/view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

relume_status file_views_create(struct file_views *v, const struct relume_geometry *geometry,
                                const double (*uv)[2], int count, const struct relume_log *log)
{
    *v = (struct file_views){.geometry = *geometry, .count = count};
    v->uv = calloc((size_t)count, sizeof *v->uv);
    v->needed = calloc((size_t)count, sizeof *v->needed);
    v->relit = calloc((size_t)count, sizeof *v->relit);
    if (!v->uv || !v->needed || !v->relit)
        return RELUME_ENOMEM;
    if (uv)
        memcpy(v->uv, uv, (size_t)count * sizeof *v->uv);
    if (!uv || geometry->projection != RELUME_SLAB)
        return RELUME_OK;
    const relume_status status = relume_slab_create(&v->grid, geometry, uv, count);
    return status == RELUME_EINVAL
               ? say(log, RELUME_EUNFIT, "the slab's cameras do not stand on a grid")
               : status;
}

void file_views_destroy(struct file_views *v)
{
    if (v->depths.views)
        depths_destroy(&v->depths);
    relume_slab_destroy(&v->grid);
    free(v->uv);
    free(v->needed);
    free(v->relit);
    *v = (struct file_views){.count = 0};
}

void file_views_use_slabs(struct file_views *v, const relume_slab_set *slabs, const double (*uv)[2],
                          const int *slab_of)
{
    v->around = slabs;
    v->slab_of = slab_of;
    memcpy(v->uv, uv, (size_t)v->count * sizeof *v->uv);
}

relume_status file_views_use_depth(struct file_views *v, const struct gl *gl,
                                   const struct depth_source *source, size_t budget)
{
    const relume_slab *slab[RELUME_MOST_SLABS] = {v->grid};
    int slabs = v->grid != NULL;
    for (; v->around && slabs < relume_slab_set_count(v->around); slabs++)
        slab[slabs] = relume_slab_set_slab(v->around, slabs);
    if (!slabs)
        return RELUME_OK;
    const relume_status status = depths_create(&v->depths, gl, slab, slabs, source);
    v->depths.memory.most = budget;
    return status;
}

// ---------------------------------------------------------------- what a frame needs

int file_views_picture_width(const struct frame_request *q)
{
    return (int)lround(q->picture.right - q->picture.left);
}

static void mark_eye(struct file_views *v, const struct frame_request *q)
{
    if (!v->around)
        (void)relume_slab_needs(v->needed, v->grid, q->camera.eye, &q->view);
    else if (q->has_window)
        (void)relume_slab_set_needs(v->needed, v->around, &q->window, file_views_picture_width(q),
                                    &q->view);
}

void file_views_mark(struct file_views *v, const struct frame_request *q)
{
    if (q->camera.framing == RELUME_FRAME_EYE)
        mark_eye(v, q);
    else
        v->needed[q->camera.framing == RELUME_FRAME_VIEW ? q->camera.view : 0] = true;
}

int file_views_needed(const struct file_views *v)
{
    int n = 0;
    for (int i = 0; i < v->count; i++)
        n += v->needed[i];
    return n;
}

bool file_views_take_lens(const struct frame_request *q)
{
    return q->view.aperture != 0.0 || q->view.focus != 0.0;
}

// An eye at a slab's camera sees its view alone, whatever the depth.
bool file_views_take_depth(const struct file_views *v, const struct frame_request *q)
{
    const enum relume_interpolation i = q->view.interpolation;
    return v->depths.views &&
           (v->around || (file_views_needed(v) > 1 && !file_views_take_lens(q))) &&
           (i == RELUME_INTERPOLATE_DEFAULT || i == RELUME_INTERPOLATE_DEPTH);
}

// ---------------------------------------------------------------- views that are still being read

// Squared distance between the cameras of two views.
static double squared_distance(const struct file_views *v, int a, int b)
{
    const double du = v->uv[a][0] - v->uv[b][0], dv = v->uv[a][1] - v->uv[b][1];
    return du * du + dv * dv;
}

// The view on the GPU that stands nearest to a missing one of the same slab, or -1.
static int nearest_present(const struct file_views *v, const struct gl_relighter *relighter,
                           int missing)
{
    int nearest = -1;
    for (int i = 0; i < v->count; i++)
        if (gl_relighter_has(relighter, i) &&
            (!v->slab_of || v->slab_of[i] == v->slab_of[missing]) &&
            (nearest < 0 ||
             squared_distance(v, i, missing) < squared_distance(v, nearest, missing)))
            nearest = i;
    return nearest;
}

// Of several slabs those that are not there yet say nothing while others do.
relume_status file_views_stand_in(struct file_views *v, struct gl_relighter *relighter)
{
    relume_status status = RELUME_OK;
    bool any = false;
    for (int i = 0; v->slab_of && i < v->count; i++)
        any |= v->relit[i] != NULL;
    for (int i = 0; !status && i < v->count; i++) {
        if (!v->needed[i] || v->relit[i])
            continue;
        const int nearest = nearest_present(v, relighter, i);
        if (nearest < 0 && any)
            continue;
        status = nearest < 0 ? gl_relighter_wait(&v->relit[i], relighter, i)
                             : gl_relighter_view(&v->relit[i], relighter, nearest);
    }
    return status;
}
