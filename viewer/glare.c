#include "glare.h"

#include "glare_view.h"

#include <math.h>
#include <string.h>

enum { LIBRARY_SIZE = 512 };
static const double most_nits = 1e12;

void glare_begin(struct glare *g, const struct gl *gl, const struct relume_log *log)
{
    *g = (struct glare){.gl = gl, .log = log};
}

void glare_end(struct glare *g)
{
    relume_eye_destroy(&g->eye);
    relume_psf_destroy(&g->psf);
    relume_glare_destroy(&g->work);
    relume_image_destroy(&g->frame);
    if (g->seen.texture)
        target_destroy(&g->seen, g->gl);
    *g = (struct glare){0};
}

// ---------------------------------------------------------------- log

// Pixels that are no numbers would be told of in every frame.
static void say_once(void *user, enum relume_level level, const char *text)
{
    struct glare *g = user;
    if (level == RELUME_WARNING && g->warned)
        return;
    g->warned |= level == RELUME_WARNING;
    if (g->log && g->log->message)
        g->log->message(g->log->user, level, text);
}

// ---------------------------------------------------------------- the eye

static double field_luminance(const struct relume_image *frame, const struct app *app,
                              double exposure)
{
    const double nits = relume_glare_luminance(frame) / exposure * sight_nits(&app->now.sight);
    return nits >= 0 ? fmin(nits, most_nits) : 0;
}

// Live on; `*moved`: it is not as it was.
static relume_status live(struct glare *g, const struct app *app, double luminance, bool *moved)
{
    const double squint = app->now.sight.squint;
    relume_status status = RELUME_OK;
    *moved = true;
    if (!g->eye) {
        status = relume_eye_create(&g->eye, g->subject, luminance);
        g->eye_s = app->eye_s;
    } else if (app->eye_s > g->eye_s) {
        status = relume_eye_advance(g->eye, app->eye_s - g->eye_s, luminance);
        g->eye_s = app->eye_s;
    } else {
        *moved = false;
    }
    if (status)
        return status;
    const double own = g->subject ? g->subject->lids.squint : 0;
    const double wanted = fmin(fmax(own, squint), 0.99);
    if (relume_eye_subject(g->eye)->lids.squint != wanted) {
        relume_eye_squint(g->eye, wanted);
        *moved = true;
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- by the library

static relume_status prepare(struct glare *g, unsigned parts_off, bool *made)
{
    relume_status status = g->work ? RELUME_OK : relume_glare_create(&g->work);
    *made = false;
    if (status || (g->psf && g->parts_off == parts_off))
        return status;
    relume_psf_destroy(&g->psf);
    g->parts_off = parts_off;
    *made = true;
    return relume_psf_create(&g->psf, relume_psf_params(.log = g->log, .threads = g->threads,
                                                        .size = g->size ? g->size : LIBRARY_SIZE,
                                                        .parts_off = parts_off));
}

static bool same_view(const struct relume_glare_params *a, const struct relume_glare_params *b)
{
    return a->fov_deg == b->fov_deg && a->magnify == b->magnify && a->mode == b->mode &&
           a->no_veil == b->no_veil;
}

static bool same_pixels(const struct relume_image *a, const struct relume_image *b)
{
    return a->data && a->width == b->width && a->height == b->height &&
           !memcmp(a->data, b->data, 3 * (size_t)a->width * (size_t)a->height * sizeof *a->data);
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

static relume_status apply(struct glare *g, bool same)
{
    const struct relume_log log = {.message = say_once, .user = g};
    struct relume_image out;
    g->view.log = &log;
    const relume_status status =
        relume_glare_apply(&out, g->work, &g->frame, same, g->psf, &g->view);
    g->view.log = NULL;
    if (!status)
        target_write(&g->seen, g->gl, &out);
    relume_image_destroy(&out);
    return status;
}

relume_status glare_see(struct glare *g, const struct target *frame, const struct app *app,
                        double exposure)
{
    struct relume_image image;
    bool made, moved;
    relume_status status = need_seen(g, frame->width, frame->height);
    if (!status)
        status = target_read(&image, frame, g->gl);
    if (status)
        return status;
    const bool same = same_pixels(&g->frame, &image);
    relume_image_destroy(&g->frame);
    g->frame = image;
    status = live(g, app, field_luminance(&g->frame, app, exposure), &moved);
    if (!status)
        status = prepare(g, app->now.sight.parts_off, &made);
    if (!status && (made || moved))
        status = relume_psf_update(g->psf, g->eye);
    if (status)
        return status;
    struct relume_glare_params view = glare_view(app, relume_psf_shape(g->psf));
    view.threads = g->threads;
    if (g->fresh && same && !made && !moved && same_view(&view, &g->view))
        return RELUME_OK;
    g->view = view;
    status = apply(g, same);
    g->fresh = !status;
    return status;
}
