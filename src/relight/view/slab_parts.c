// slab_parts.c - what of its views a frame of a slab reads: a few columns and rows of each
//
// u depends on s alone and v on t alone, so the columns that a frame reads of a view follow from
// the frame's columns and the view's column of the grid, and its rows likewise: near the cameras a
// frame touches many views, but only the rectangle of each that looks through the cells around it.
#include "relight/view/slab.h"

#include "core/base/memory.h"
#include "relight/view/view.h"

#include <math.h>
#include <string.h>

// Texels beside the one that a ray hits: those of its mean; by depth also as far as the surface is
// moved while it is placed between texels (slab_depth.c).
enum { BESIDE = 2, BESIDE_BY_DEPTH = 8 };

// Columns (rows) of a view that are read, for each line of the grid; high < low: none.
struct span {
    int low, high;
};

struct reading {
    struct slab_frame frame;
    struct relume_image out;  // of which only the size is known
    bool constant;
    double range[2];  // of disparities; 0 and 0: all lie on the st plane
    int margin;
};

static void widen(struct span *s, double place, int margin)
{
    const int at = relume_whole(floor(fmin(fmax(place, -1e6), 1e6)));
    s->low = at - margin < s->low ? at - margin : s->low;
    s->high = at + margin > s->high ? at + margin : s->high;
}

// What a ray of the frame reads of the cameras around it, along one axis.
static void add_ray(struct span *spans, const struct reading *r, int axis, double x)
{
    const struct slab_frame *f = &r->frame;
    const struct slab_ray ray = slab_ray_of(f, axis == 0 ? x : 0.0, axis == 1 ? x : 0.0);
    const double *lines = axis == 0 ? f->slab->u : f->slab->v;
    const struct neighbours n = axis == 0 ? slab_columns_at(f->slab, r->constant, ray.at[0])
                                          : slab_rows_at(f->slab, r->constant, ray.at[1]);
    for (int i = 0; i < n.count; i++) {
        const double at = lines[n.index[i]];
        double shift[2];
        slab_shift(shift, f, &ray, at, at);
        for (int k = 0; k < 2; k++)
            widen(&spans[n.index[i]], ray.texel[axis] + r->range[k] * shift[axis], r->margin);
    }
}

static void find_spans(struct span *spans, const struct reading *r, int axis)
{
    const struct slab_frame *f = &r->frame;
    const int texels = axis == 0 ? f->width : f->height;
    const int pixels = axis == 0 ? r->out.width : r->out.height;
    const int lines = axis == 0 ? f->slab->columns : f->slab->rows;
    const struct footprint side = slab_footprint(&f->params, (double)texels / pixels);
    for (int i = 0; i < lines; i++)
        spans[i] = (struct span){texels, -1};
    for (int i = 0; i < pixels * side.count; i++)
        add_ray(spans, r, axis, i / side.count + 0.5 + footprint_place(side, i % side.count));
    for (int i = 0; i < lines; i++) {
        spans[i].low = spans[i].low > 0 ? spans[i].low : 0;
        spans[i].high = spans[i].high < texels ? spans[i].high : texels - 1;
    }
}

static void find_range(struct reading *r)
{
    if (!r->frame.params.range)
        return;
    slab_depth_range(r->range, &r->frame);
    r->range[0] = fmin(r->range[0], 0.0);  // background is taken where the st plane is
    r->range[1] = fmax(r->range[1], 0.0);
    r->margin = BESIDE_BY_DEPTH;
}

static void put_parts(struct relume_rect *part, const struct reading *r, const struct span *across,
                      const struct span *down)
{
    const relume_slab *slab = r->frame.slab;
    for (int i = 0; i < slab->columns * slab->rows; i++) {
        const struct span x = across[i % slab->columns], y = down[i / slab->columns];
        if (r->frame.needed[slab->view[i]] && x.low <= x.high && y.low <= y.high)
            part[slab->view[i]] =
                (struct relume_rect){x.low, y.low, x.high - x.low + 1, y.high - y.low + 1};
    }
}

int relume_slab_parts(struct relume_rect *part, const relume_slab *slab, struct relume_vec3 eye,
                      const int frame[2], const struct relume_view_params *params)
{
    const bool constant = params->interpolation == RELUME_INTERPOLATE_CONSTANT;
    struct reading r = {
        .out = {frame[0], frame[1], 3, NULL}, .constant = constant, .margin = BESIDE};
    bool *needed = mem_zeroed((size_t)slab->views, sizeof *needed);
    struct span *spans = mem_array((size_t)slab->columns + (size_t)slab->rows, sizeof *spans);
    int n = needed && spans ? 0 : -1;
    memset(part, 0, (size_t)slab->views * sizeof *part);
    r.frame = (struct slab_frame){.slab = slab,
                                  .out = &r.out,
                                  .width = params->size[0],
                                  .height = params->size[1],
                                  .eye = eye,
                                  .params = *params,
                                  .needed = needed};
    if (n == 0 && slab_reach(&r.frame.reach, slab, eye))
        n = relume_slab_needs(needed, slab, eye, params);
    if (n > 0) {
        find_range(&r);
        find_spans(spans, &r, 0);
        find_spans(spans + slab->columns, &r, 1);
        put_parts(part, &r, spans, spans + slab->columns);
    }
    mem_free(needed);
    mem_free(spans);
    return n;
}
