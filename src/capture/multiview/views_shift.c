// views_shift.c - pictures of parallel cameras moved so that a plane stands still in them
#include "capture/multiview/views_shift.h"

#include "core/base/log.h"
#include "core/base/outdir.h"
#include "core/math/bilinear.h"

#include <math.h>

struct shifting {
    double per_unit;   // pixels a unit of u and v
    double margin[2];  // pixels lost on each side
    int width, height;
};

static double spacing(const double *values, int n)
{
    return n > 1 ? fabs(values[n - 1] - values[0]) / (n - 1) : 0.0;
}

static double reach(const double *values, int n)
{
    double most = 0.0;
    for (int i = 0; i < n; i++)
        most = fmax(most, fabs(values[i]));
    return most;
}

static relume_status save_one(const struct shifting *s, const struct photo_set *set, int camera,
                              int light, const char *name, const double move[2],
                              const outdir *folder, const struct relume_ingest_params *p)
{
    struct relume_image in, out = {0};
    relume_status status = photo_load(&in, set, camera, light, p);
    if (!status)
        status = relume_image_create(&out, s->width, s->height, 3);
    for (int y = 0; y < s->height && !status; y++)
        for (int x = 0; x < s->width; x++) {
            const struct bilinear b =
                bilinear_at(x + s->margin[0] + move[0], y + s->margin[1] + move[1], in.width,
                            in.height, EDGE_CLAMPED);
            for (size_t c = 0; c < 3; c++)
                out.data[((size_t)y * (size_t)s->width + (size_t)x) * 3 + c] =
                    bilinear_valuef(&b, in.data, 3, c);
        }
    if (!status)
        status = save_inside(folder, name, &out, true, p->log);
    relume_image_destroy(&in);
    relume_image_destroy(&out);
    return status;
}

static relume_status measure(struct shifting *s, const struct photo_set *set,
                             const struct camera_grid *g, double disparity,
                             const struct relume_ingest_params *p)
{
    const double step = g->columns > 1 ? spacing(g->u, g->columns) : spacing(g->v, g->rows);
    s->per_unit = disparity / step;
    s->margin[0] = ceil(fabs(s->per_unit) * reach(g->u, g->columns));
    s->margin[1] = ceil(fabs(s->per_unit) * reach(g->v, g->rows));
    s->width = set->width - 2 * relume_whole(fmin(s->margin[0], set->width));
    s->height = set->height - 2 * relume_whole(fmin(s->margin[1], set->height));
    if (s->width >= 2 && s->height >= 2)
        return RELUME_OK;
    return log_fail(p->log, RELUME_EUNFIT,
                    "%s: with a focus disparity of %g pixels a camera no part of the scene is seen "
                    "by all %d x %d cameras; expected a smaller one",
                    set->camera[0].name, disparity, g->columns, g->rows);
}

relume_status save_shifted(struct relume_manifest_view *view, int *width, int *height,
                           const outdir *folder, struct photo_set *set,
                           const struct camera_grid *grid, double disparity,
                           const struct relume_ingest_params *p)
{
    struct shifting s;
    relume_status status = measure(&s, set, grid, disparity, p);
    const int n = grid->rows * grid->columns;
    for (int i = 0; i < n && !status; i++) {
        // The plane lies `disparity` further left for a camera one step further right.
        const double move[2] = {-s.per_unit * grid->u[i % grid->columns],
                                s.per_unit * grid->v[i / grid->columns]};
        view[i].images = arena_array(&set->arena, (size_t)set->lights, sizeof *view[i].images);
        for (int k = 0; k < set->lights && !status; k++) {
            if (!view[i].images ||
                !(view[i].images[k] = arena_format(&set->arena, "view%03d_light%04d.exr", i, k))) {
                status = RELUME_ENOMEM;
                break;
            }
            status = save_one(&s, set, grid->camera[i], k, view[i].images[k], move, folder, p);
        }
        if (!status && !log_progress(p->log, "moving", (i + 1.0) / n))
            status = RELUME_ECANCEL;
    }
    *width = s.width;
    *height = s.height;
    return status;
}
