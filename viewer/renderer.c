#include "renderer.h"

#include "say.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------- making

static relume_status create_programs(struct renderer *r)
{
    const struct {
        struct program *program;
        relume_status (*create)(struct program *, const struct gl *, const struct relume_log *);
    } list[] = {
        {&r->picture, draw_picture_create},   {&r->slab, draw_slab_create},
        {&r->panorama, draw_panorama_create}, {&r->ball, draw_ball_create},
        {&r->present, draw_present_create},
    };
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && i < sizeof list / sizeof *list; i++)
        status = list[i].create(list[i].program, r->gl, r->log);
    return status;
}

relume_status renderer_create(struct renderer *r, const struct gl *gl,
                              const struct code_source *source,
                              const struct relume_geometry *geometry, const double (*uv)[2],
                              int views, const struct relume_log *log)
{
    *r = (struct renderer){.gl = gl, .log = log, .geometry = *geometry, .views = views};
    gl->GenVertexArrays(1, &r->vertices);
    r->uv = calloc((size_t)views, sizeof *r->uv);
    if (r->uv && uv)
        memcpy(r->uv, uv, (size_t)views * sizeof *r->uv);
    r->needed = calloc((size_t)views, sizeof *r->needed);
    r->relit = calloc((size_t)views, sizeof *r->relit);
    relume_status status = r->uv && r->needed && r->relit ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = relighter_create(&r->relighter, gl, source, views, log);
    if (!status)
        status = create_programs(r);
    if (!status && geometry->projection == RELUME_SLAB) {
        status = relume_slab_create(&r->grid, geometry, uv, views);
        if (status == RELUME_EINVAL)
            status = say(log, RELUME_EDATA, "the slab's cameras do not stand on a grid");
    }
    if (status)
        renderer_destroy(r);
    return status;
}

void renderer_destroy(struct renderer *r)
{
    if (!r->gl)
        return;
    struct program *const programs[] = {&r->picture, &r->slab, &r->panorama, &r->ball, &r->present};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        program_destroy(programs[i], r->gl);
    relighter_destroy(&r->relighter);
    target_destroy(&r->frame, r->gl);
    r->gl->DeleteVertexArrays(1, &r->vertices);
    relume_slab_destroy(&r->grid);
    free(r->uv);
    free(r->needed);
    free(r->relit);
    *r = (struct renderer){0};
}

// ---------------------------------------------------------------- framings

static void mark_view(struct renderer *r, const struct app *app)
{
    r->needed[app->now.camera.view] = true;
}

static void mark_eye(struct renderer *r, const struct app *app)
{
    (void)relume_slab_needs(r->needed, r->grid, app->now.camera.eye, NULL);
}

static void mark_look(struct renderer *r, const struct app *app)
{
    (void)app;
    r->needed[0] = true;
}

static void draw_framed_view(const struct renderer *r, const struct app *app,
                             const struct place *place)
{
    draw_picture(&r->picture, r->gl, place, r->relit[app->now.camera.view]);
}

static void draw_framed_eye(const struct renderer *r, const struct app *app,
                            const struct place *place)
{
    bool any = false;
    for (int i = 0; i < r->views; i++)
        any |= r->needed[i];
    if (any)
        draw_slab(&r->slab, r->gl, place, r->grid, &r->geometry, app->now.camera.eye, r->relit);
}

static void draw_framed_look(const struct renderer *r, const struct app *app,
                             const struct place *place)
{
    draw_panorama(&r->panorama, r->gl, place, &r->geometry, app->now.camera.look, r->relit[0]);
}

// Which views a framing needs, and how it is drawn from them.
static const struct framing {
    void (*mark)(struct renderer *r, const struct app *app);
    void (*draw)(const struct renderer *r, const struct app *app, const struct place *place);
} framings[] = {
    [RELUME_FRAME_VIEW] = {mark_view, draw_framed_view},
    [RELUME_FRAME_EYE] = {mark_eye, draw_framed_eye},
    [RELUME_FRAME_LOOK] = {mark_look, draw_framed_look},
};

// ---------------------------------------------------------------- frame

static relume_status prepare_frame(struct renderer *r, int width, int height)
{
    if (r->frame.width == width && r->frame.height == height)
        return RELUME_OK;
    target_destroy(&r->frame, r->gl);
    return target_create(&r->frame, r->gl, width, height, r->log);
}

// How far apart the cameras of two views stand, squared.
static double apart(const struct renderer *r, int a, int b)
{
    const double du = r->uv[a][0] - r->uv[b][0], dv = r->uv[a][1] - r->uv[b][1];
    return du * du + dv * dv;
}

// The view on the GPU that stands nearest to a missing one, or -1.
static int nearest_present(const struct renderer *r, int missing)
{
    int nearest = -1;
    for (int i = 0; i < r->views; i++)
        if (relighter_has(&r->relighter, i) &&
            (nearest < 0 || apart(r, i, missing) < apart(r, nearest, missing)))
            nearest = i;
    return nearest;
}

static relume_status stand_in(struct renderer *r)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < r->views; i++) {
        if (!r->needed[i] || r->relit[i])
            continue;
        const int nearest = nearest_present(r, i);
        status = nearest < 0 ? relighter_wait(&r->relit[i], &r->relighter, i)
                             : relighter_view(&r->relit[i], &r->relighter, nearest);
    }
    return status;
}

static relume_status relight_needed(struct renderer *r, const struct app *app)
{
    const struct framing *framing = &framings[app->now.camera.framing];
    memset(r->needed, 0, (size_t)r->views * sizeof *r->needed);
    framing->mark(r, app);
    relume_status status = relighter_begin(&r->relighter, app->now.light, app->now.lights);
    for (int i = 0; !status && i < r->views; i++) {
        r->relit[i] = NULL;
        if (r->needed[i])
            status = relighter_view(&r->relit[i], &r->relighter, i);
    }
    return status ? status : stand_in(r);
}

relume_status renderer_draw(struct renderer *r, const struct app *app)
{
    const struct place place = {
        .width = app->width,
        .height = app->height,
        .picture = app_picture(app),
        .exposure = (float)exp2(app->now.exposure_ev),
    };
    relume_status status = prepare_frame(r, app->width, app->height);
    if (!status)
        status = relight_needed(r, app);
    if (status)
        return status;
    r->gl->BindVertexArray(r->vertices);
    target_begin(&r->frame, r->gl);
    framings[app->now.camera.framing].draw(r, app, &place);
    if (app->now.ball)
        draw_ball(&r->ball, r->gl, &place, app_seen_light(app, 0), app->now.light[0].rgb);
    return gl_check(r->gl, "drawing", r->log);
}

relume_status renderer_stream(struct renderer *r)
{
    return relighter_stream(&r->relighter);
}

bool renderer_is_pending(const struct renderer *r)
{
    return r->relighter.pending;
}

relume_status renderer_read(struct relume_image *out, const struct renderer *r)
{
    return target_read(out, &r->frame, r->gl);
}

void renderer_present(const struct renderer *r)
{
    draw_present(&r->present, r->gl, &r->frame);
}
