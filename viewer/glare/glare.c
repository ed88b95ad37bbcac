// glare.c - the frame as a living eye sees it: the eye in time, its pattern, the picture
#include "glare/glare.h"

#include "glare/glare_view.h"
#include "relight/eye/pupil.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LIBRARY_SIZE = 512, GPU_SIZE = 1536 };
static const double field_deg = 4;  // of the pattern: the ring of the lens's fibres is within
static const double most_nits = 1e12;
static const double shortest_s = 0.1;  // of a loop: three patterns

void glare_begin(struct glare *g, const struct gl *gl, const struct relume_log *log)
{
    *g = (struct glare){.gl = gl, .log = log};
}

static void forget_loop(struct glare *g)
{
    if (!g->loop.cycle)
        return;
    relume_psf_cycle_destroy(&g->loop.cycle);
    relume_eye_destroy(&g->eye);
    g->loop = (struct glare_loop){0};
}

static void forget_pattern(struct glare *g)
{
    forget_loop(g);
    relume_psf_destroy(&g->library.psf);
    relume_glare_destroy(&g->library.work);
    relume_image_destroy(&g->library.frame);
    if (g->gl)
        gl_glare_destroy(&g->card, g->gl);
    g->ready = g->fresh = false;
}

void glare_end(struct glare *g)
{
    forget_pattern(g);
    relume_eye_destroy(&g->eye);
    if (g->seen.texture)
        target_destroy(&g->seen, g->gl);
    *g = (struct glare){0};
}

// ---------------------------------------------------------------- who does it

// From now on, and said once.
static void leave_it_to_library(struct glare *g, const char *why)
{
    char text[160];
    g->by_library = true;
    snprintf(text, sizeof text, "%s; the library computes glare", why);
    if (g->log && g->log->message)
        g->log->message(g->log->user, RELUME_WARNING, text);
}

static struct relume_psf_params pattern_of(const struct glare *g, const struct observer *observer,
                                           bool by_gpu)
{
    return (struct relume_psf_params){.log = g->log,
                                      .threads = g->threads,
                                      .size = g->size  ? g->size
                                              : by_gpu ? GPU_SIZE
                                                       : LIBRARY_SIZE,
                                      .half_field_deg = g->field_deg > 0 ? g->field_deg : field_deg,
                                      .parts_off = observer->parts_off};
}

static bool can_use_gpu(struct glare *g, const struct observer *observer)
{
    const struct relume_psf_params params = pattern_of(g, observer, true);

    if (!g->by_library && !g->gl->compute)
        leave_it_to_library(g, "OpenGL has no compute passes here (version 4.3)");
    else if (!g->by_library && !gl_psf_fits(g->gl, &params))
        leave_it_to_library(g, "the graphics card has no room for the pattern");
    return !g->by_library;
}

static relume_status prepare_eye(struct glare *g, const struct observer *observer, bool by_gpu)
{
    if (g->ready && g->by_gpu == by_gpu && g->parts_off == observer->parts_off)
        return RELUME_OK;
    const struct relume_psf_params params = pattern_of(g, observer, by_gpu);
    forget_pattern(g);
    relume_status status =
        by_gpu ? gl_glare_prepare(&g->card, g->gl, &params) : relume_glare_create(&g->library.work);
    if (!status && !by_gpu)
        status = relume_psf_create(&g->library.psf, &params);
    g->ready = !status;
    g->by_gpu = by_gpu;
    g->parts_off = observer->parts_off;
    return status;
}

// ---------------------------------------------------------------- the eye

static double squint_of(const struct glare *g, const struct observer *observer)
{
    const double own = g->subject ? g->subject->lids.squint : 0;
    return fmin(fmax(own, observer->squint), 0.99);
}

// Live on; `*moved`: it is not as it was.
static relume_status advance_eye(struct glare *g, const struct frame_request *q, double luminance,
                                 bool *moved)
{
    const double squint = squint_of(g, &q->observer);
    relume_status status = RELUME_OK;
    *moved = !g->eye || q->eye_s > g->eye_s;
    if (!g->eye)
        status = relume_eye_create(&g->eye, g->subject, luminance);
    else if (*moved)
        status = relume_eye_advance(g->eye, q->eye_s - g->eye_s, luminance);
    g->eye_s = q->eye_s;
    if (status || relume_eye_subject(g->eye)->lids.squint == squint)
        return status;
    relume_eye_squint(g->eye, squint);
    *moved = true;
    return RELUME_OK;
}

// Of an eye that opens now, adapted to that luminance.
static relume_status begin_loop(struct glare *g, const struct observer *observer, double luminance)
{
    const double squint = squint_of(g, observer);
    forget_loop(g);
    relume_eye_destroy(&g->eye);
    relume_status status = relume_eye_create(&g->eye, g->subject, luminance);
    if (status)
        return status;
    relume_eye_squint(g->eye, squint);
    status = relume_psf_cycle_create(
        &g->loop.cycle, g->library.psf, g->eye,
        relume_psf_cycle_params(.log = g->log, .seconds = fmax(observer->cycle_s, shortest_s),
                                .luminance = luminance));
    g->loop.seconds = observer->cycle_s;
    g->loop.squint = squint;
    return status;
}

static relume_status go_around(struct glare *g, const struct frame_request *q, double luminance)
{
    const struct observer *observer = &q->observer;
    relume_status status = RELUME_OK;
    if (!g->loop.cycle || g->loop.seconds != observer->cycle_s ||
        g->loop.squint != squint_of(g, observer))
        status = begin_loop(g, observer, luminance);
    else if (g->fresh && q->eye_s == g->eye_s)
        return RELUME_OK;
    g->fresh = false;
    g->eye_s = q->eye_s;
    return status ? status : relume_psf_cycle_show(g->library.psf, g->loop.cycle, q->eye_s);
}

static relume_status live_and_update(struct glare *g, const struct frame_request *q,
                                     double luminance)
{
    const double nits = luminance / (double)q->exposure * observer_nits(&q->observer);
    const double seen = nits >= 0 ? fmin(nits, most_nits) : 0;
    bool moved;
    if (q->observer.cycle_s > 0)
        return go_around(g, q, seen);
    forget_loop(g);
    relume_status status = advance_eye(g, q, seen, &moved);
    if (status || (!moved && g->fresh))
        return status;
    g->fresh = false;
    return g->by_gpu ? gl_glare_update(&g->card, g->gl, g->eye, g->log)
                     : relume_psf_update(g->library.psf, g->eye);
}

static relume_status need_seen(struct glare *g, int width, int height)
{
    if (g->seen.width == width && g->seen.height == height)
        return RELUME_OK;
    if (g->seen.texture)
        target_destroy(&g->seen, g->gl);
    g->fresh = false;
    return target_create(&g->seen, g->gl, width, height, g->log);
}

static bool same_view(const struct relume_glare_params *a, const struct relume_glare_params *b)
{
    return a->fov_deg == b->fov_deg && a->magnify == b->magnify && a->mode == b->mode &&
           a->no_veil == b->no_veil;
}

// ---------------------------------------------------------------- by the library

// Pixels that are no numbers would be logged in every frame.
static void say_once(void *user, enum relume_level level, const char *text)
{
    struct glare *g = user;
    if (level == RELUME_WARNING && g->warned)
        return;
    g->warned |= level == RELUME_WARNING;
    if (g->log && g->log->message)
        g->log->message(g->log->user, level, text);
}

static bool same_pixels(const struct relume_image *a, const struct relume_image *b)
{
    return a->data && a->width == b->width && a->height == b->height &&
           !memcmp(a->data, b->data, 3 * (size_t)a->width * (size_t)a->height * sizeof *a->data);
}

static relume_status take_frame(struct glare *g, const struct target *frame, bool *same)
{
    struct relume_image image;
    const relume_status status = target_read(&image, frame, g->gl);
    if (status)
        return status;
    *same = same_pixels(&g->library.frame, &image);
    relume_image_destroy(&g->library.frame);
    g->library.frame = image;
    return RELUME_OK;
}

// Few bright pixels by themselves and a coarse veil of the rest are faster for large frames.
static enum relume_glare_mode mode_of(const struct observer *observer, const struct target *frame)
{
    enum { LARGE = 640 * 360 };
    switch (observer->mode) {
    case OBSERVER_FFT: return RELUME_GLARE_FFT;
    case OBSERVER_BILLBOARD: return RELUME_GLARE_BILLBOARD;
    case OBSERVER_HYBRID: return RELUME_GLARE_HYBRID;
    default: break;
    }
    return frame->width * frame->height > LARGE ? RELUME_GLARE_HYBRID : RELUME_GLARE_FFT;
}

static relume_status apply(struct glare *g, const struct relume_glare_params *view, bool same)
{
    const struct relume_log log = {.message = say_once, .user = g};
    struct relume_glare_params params = *view;
    struct relume_image out;
    params.log = &log;
    params.threads = g->threads;
    const relume_status status =
        relume_glare_apply(&out, g->library.work, &g->library.frame, same, g->library.psf, &params);
    if (!status)
        target_write(&g->seen, g->gl, &out);
    relume_image_destroy(&out);
    return status;
}

static relume_status see_by_library(struct glare *g, const struct target *frame,
                                    const struct frame_request *q)
{
    bool same = false;
    relume_status status = take_frame(g, frame, &same);
    if (!status)
        status = live_and_update(g, q, relume_glare_luminance(&g->library.frame));
    if (status)
        return status;
    struct relume_glare_params view = glare_view(q, relume_psf_shape(g->library.psf));
    view.mode = mode_of(&q->observer, frame);
    if (g->fresh && same && same_view(&view, &g->view))
        return RELUME_OK;
    g->view = view;
    return apply(g, &view, same);
}

// ---------------------------------------------------------------- on the GPU

static relume_status see_by_gpu(struct glare *g, const struct target *frame,
                                const struct frame_request *q, bool *fits)
{
    struct gl_glare_facts facts;
    *fits = true;
    relume_status status = gl_glare_watch(&facts, &g->card, g->gl, frame, g->log);
    if (!status)
        status = live_and_update(g, q, facts.luminance);
    if (status)
        return status;
    const struct relume_glare_params view = glare_view(q, &g->card.psf.shape);
    if (g->fresh && facts.same && same_view(&view, &g->view))
        return RELUME_OK;
    g->view = view;
    return gl_glare_apply(&g->card, g->gl, &g->seen, frame, &facts, g->eye, &view, fits, g->log);
}

relume_status glare_see(struct glare *g, const struct target *frame, const struct frame_request *q)
{
    const bool by_gpu = !q->observer.cycle_s &&
                        (q->observer.mode == OBSERVER_AUTO || q->observer.mode == OBSERVER_FFT) &&
                        can_use_gpu(g, &q->observer);
    bool fits = true;
    relume_status status = need_seen(g, frame->width, frame->height);
    if (!status)
        status = prepare_eye(g, &q->observer, by_gpu);
    if (!status)
        status = by_gpu ? see_by_gpu(g, frame, q, &fits) : see_by_library(g, frame, q);
    g->fresh = !status;
    if (status || fits)
        return status;
    leave_it_to_library(g, "the graphics card has no room for the frame");
    return glare_see(g, frame, q);
}
