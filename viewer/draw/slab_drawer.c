// slab_drawer.c - frames of an eye in front of one slab, or of several
#include "draw/slab_drawer.h"
#include "relight/view/slab_set.h"

enum { MOVING_SHARE = 8 };  // of the pinholes of a lens, while something moves

relume_status slab_drawer_create(struct slab_drawer *d, const struct gl *gl,
                                 const struct relume_log *log)
{
    *d = (struct slab_drawer){.gl = gl, .log = log};
    const struct fragment_program list[] = {
        {&d->slab, &draw_slab_fragment},
        {&d->slab_depth, &draw_slab_depth_fragment},
        {&d->slab_lens, &draw_slab_lens_fragment},
        {&d->slabs, &draw_slabs_fragment},
        {&d->slabs_depth, &draw_slabs_depth_fragment},
        {&d->mean, &draw_mean_fragment},
    };
    return program_create_fragments(list, sizeof list / sizeof *list, gl, log);
}

void slab_drawer_destroy(struct slab_drawer *d)
{
    if (!d->gl)
        return;
    struct program *const programs[] = {&d->slab,  &d->slab_depth,  &d->slab_lens,
                                        &d->slabs, &d->slabs_depth, &d->mean};
    struct target *const targets[] = {&d->sum, &d->beside, &d->pinholes};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        program_destroy(programs[i], d->gl);
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++)
        target_destroy(targets[i], d->gl);
    *d = (struct slab_drawer){.gl = NULL};
}

// A frame as it is drawn.
struct slab_frame {
    struct file_views *views;
    const struct frame_request *request;
    const struct frame_area *area;
    const struct target *target;
};

static relume_status need(struct slab_drawer *d, struct target *target, const struct slab_frame *f)
{
    return target_need(target, d->gl, f->area->width, f->area->height, d->log);
}

static bool takes_nearest(const struct frame_request *q)
{
    return q->view.interpolation == RELUME_INTERPOLATE_CONSTANT;
}

// ---------------------------------------------------------------- one slab

static relume_status draw_lens(struct slab_drawer *d, const struct slab_frame *f,
                               const struct slab_inputs *in)
{
    const struct relume_view_params *view = &f->request->view;
    const relume_status status = need(d, &d->sum, f);
    if (status)
        return status;
    target_begin(&d->sum, d->gl);
    draw_slab_lens(&d->slab_lens, d->gl, f->area, in, view->aperture, view->focus);
    target_resume(f->target, d->gl);
    draw_mean(&d->mean, d->gl, f->area, &d->sum);
    return RELUME_OK;
}

static relume_status draw_depth(struct slab_drawer *d, const struct slab_frame *f,
                                const struct slab_inputs *in)
{
    struct depths *depths = &f->views->depths;
    double range[2];
    const relume_status status = in->part
                                     ? depths_use_parts(depths, f->views->needed, in->part, range)
                                     : depths_use(depths, f->views->needed, range);
    if (!status)
        draw_slab_depth(&d->slab_depth, d->gl, f->area, in, depths->texture, range);
    return status;
}

// ---------------------------------------------------------------- several slabs

// The mean of `in`, by way of `sum`, added to what `onto` holds.
static void add_mean(const struct slab_drawer *d, const struct slab_frame *f,
                     const struct frame_area *area, const struct target *onto,
                     const struct slabs_inputs *in, const struct target *sum)
{
    target_begin(sum, d->gl);
    if (in->disparity)
        draw_slabs_depth(&d->slabs_depth, d->gl, area, in);
    else
        draw_slabs(&d->slabs, d->gl, area, in, takes_nearest(f->request));
    target_resume(onto, d->gl);
    d->gl->Enable(GL_BLEND);
    draw_mean(&d->mean, d->gl, area, sum);
    d->gl->Disable(GL_BLEND);
}

// Whether there are rays that pass the cameras of no slab, looked for at a lattice of points.
static bool has_others(const relume_slab_set *slabs, const struct relume_window *window)
{
    enum { POINTS = 32 };
    for (int i = 0; i < POINTS * POINTS; i++)
        if (!relume_slab_set_passes(slabs, window, (i % POINTS + 0.5) / POINTS,
                                    (i / POINTS + 0.5) / POINTS))
            return true;
    return false;
}

// All slabs through one window, added to what `onto` holds.
static relume_status add_around(struct slab_drawer *d, const struct slab_frame *f,
                                const struct frame_area *area, const struct target *onto,
                                const struct relume_window *window, bool by_depth)
{
    const struct file_views *v = f->views;
    struct slabs_inputs in = {
        .slabs = v->around,
        .window = window,
        .views = v->relit,
        .disparity = by_depth ? v->depths.texture : NULL,
        .range = (const double(*)[2])v->depths.range,
        .others = has_others(v->around, window),
    };
    add_mean(d, f, area, onto, &in, &d->sum);
    if (!in.others)
        return RELUME_OK;
    const relume_status status = need(d, &d->beside, f);
    in.passed = &d->sum;
    if (!status)
        add_mean(d, f, area, onto, &in, &d->beside);
    return status;
}

// The mean over the pinholes that show anything. Twin: relume_slab_set_frame.
static relume_status draw_around_lens(struct slab_drawer *d, const struct slab_frame *f,
                                      bool by_depth)
{
    const struct frame_request *q = f->request;
    const struct relume_window *window = &q->window;
    const double aperture = q->view.aperture, focus = q->view.focus;
    struct frame_area plain = *f->area;
    relume_status status = need(d, &d->pinholes, f);
    if (status || !relume_lens_fits(window, aperture, focus))
        return status;
    plain.exposure = 1;
    target_begin(&d->pinholes, d->gl);
    const int all = relume_lens_points(window, aperture, focus, file_views_picture_width(q));
    const int n = q->moves ? (all + MOVING_SHARE - 1) / MOVING_SHARE : all;
    for (int i = 0; !status && i < n; i++) {
        const struct relume_window from = relume_lens_window(window, aperture, focus, i, n);
        status = add_around(d, f, &plain, &d->pinholes, &from, by_depth);
    }
    target_resume(f->target, d->gl);
    draw_mean(&d->mean, d->gl, f->area, &d->pinholes);
    return status;
}

static relume_status draw_around(struct slab_drawer *d, const struct slab_frame *f)
{
    const struct frame_request *q = f->request;
    double range[2];
    relume_status status = need(d, &d->sum, f);
    const bool by_depth = file_views_take_depth(f->views, q);
    if (!status && by_depth)
        status = depths_use(&f->views->depths, f->views->needed, range);
    if (status || !q->has_window)
        return status;
    return file_views_take_lens(q) ? draw_around_lens(d, f, by_depth)
                                   : add_around(d, f, f->area, f->target, &q->window, by_depth);
}

relume_status slab_drawer_draw(struct slab_drawer *d, struct file_views *views,
                               const struct view_parts *parts, const struct frame_request *q,
                               const struct frame_area *area, const struct target *frame)
{
    const struct slab_frame f = {views, q, area, frame};
    const struct slab_inputs in = {views->grid,
                                   &views->geometry,
                                   q->camera.eye,
                                   views->relit,
                                   parts->in_use ? parts->rect : NULL,
                                   {parts->size[0], parts->size[1]}};
    if (!file_views_needed(views))
        return RELUME_OK;
    if (views->around)
        return draw_around(d, &f);
    if (file_views_take_lens(q))
        return draw_lens(d, &f, &in);
    if (file_views_take_depth(views, q))
        return draw_depth(d, &f, &in);
    draw_slab(&d->slab, d->gl, area, &in, takes_nearest(q));
    return RELUME_OK;
}
