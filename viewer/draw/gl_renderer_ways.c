// gl_renderer_ways.c - frames with light between the scene and the objects in it: as the library
// makes them in a thread of its own, and until then with the hard shadows of gl_renderer_objects.c
#include "app/way.h"
#include "cli/program/clock.h"
#include "draw/gl_renderer.h"
#include "draw/gl_renderer_parts.h"
#include "world/transport/gl_version.h"

#include <relume/world/transport.h>

#include <math.h>
#include <string.h>

void gl_renderer_use_exchange(struct gl_renderer *r, const struct exchange_source *exchange)
{
    r->exchange.source = *exchange;
    r->stage |= exchange->scene;
}

void gl_renderer_ways_destroy(struct gl_renderer *r)
{
    exchanger_destroy(&r->exchange.exchanger);
    for (int i = 0; i < EXCHANGER_SLOTS; i++)
        target_destroy(&r->exchange.way[i], r->gl);
    target_destroy(&r->exchange.beside, r->gl);
    between_destroy(&r->exchange.between);
}

void gl_renderer_let_go(struct gl_renderer *r)
{
    if (r->exchange.exchanger)
        exchanger_rest(r->exchange.exchanger);
}

bool gl_renderer_expects(const struct gl_renderer *r)
{
    return r->exchange.exchanger && exchanger_is_busy(r->exchange.exchanger);
}

bool gl_renderer_has_news(const struct gl_renderer *r)
{
    return r->exchange.exchanger && exchanger_has_news(r->exchange.exchanger);
}

relume_status gl_renderer_wait(struct gl_renderer *r)
{
    return exchanger_wait(r->exchange.exchanger);
}

// ---------------------------------------------------------------- asking

// Ways that are drawn, too (gl_renderer_between.c): those of relume_transports that say so.
static const struct drawn_way {
    const char *way;
    enum between_way as;
} drawn_ways[] = {{"ssdo", BETWEEN_DIRECTIONAL},
                  {"ssao", BETWEEN_AMBIENT},
                  {"micro", BETWEEN_MICRO},
                  {"ism", BETWEEN_ISM}};

// They gather from points.
static bool need_compute(const struct drawn_way *p)
{
    return relume_transport_gl_version(relume_transport_find(p->way)) > 33;
}

// NULL: there are none of that way; for any of them (NULL), what stands in for it.
static const struct drawn_way *drawn_way_of(const struct light_exchange *x, const char *way)
{
    for (size_t i = 0; i < sizeof drawn_ways / sizeof *drawn_ways && !x->by_library; i++)
        if ((!way || !strcmp(drawn_ways[i].way, way)) &&
            !(need_compute(&drawn_ways[i]) && x->no_points))
            return &drawn_ways[i];
    return NULL;
}

// Two ways, or two materials; the latter are compared in hard shadows. Of a scene file hard shadows
// are the library's, too.
enum { NO_WAY = -1 };
static bool goes_between(const struct light_exchange *x, const struct frame_request *q, int way)
{
    return x->source.file && way != NO_WAY && (x->source.scene || way_gathers(way)) &&
           q->pass == RELUME_PASS_COLOUR && q->split == APP_SPLIT_NONE;
}

// Pixels of the whole picture: as the frame shows them, but of an enlarged one no more than four
// frames would have.
static void find_size(struct relume_camera *camera, const struct frame_request *q)
{
    const double wide = q->picture.right - q->picture.left,
                 high = q->picture.bottom - q->picture.top;
    const double most = 4.0 * q->width * q->height;
    const double scale = fmin(1.0, sqrt(most / fmax(wide * high, 1.0)));
    camera->width = (int)fmax(1.0, lround(scale * wide));
    camera->height = (int)fmax(1.0, lround(scale * high));
}

// Looks into a panorama with depth.
static bool takes_passes(const struct gl_renderer *r, const struct frame_request *q)
{
    return !r->exchange.by_library && r->exchange.with_depth &&
           q->camera.framing == RELUME_FRAME_LOOK && !q->camera.look.stereographic &&
           r->views.count == 1;
}

static bool is_drawn_by_passes(const struct gl_renderer *r, const struct frame_request *q, int way)
{
    return takes_passes(r, q) && drawn_way_of(&r->exchange, way_name(way));
}

// Own draws, or some that stand in until the library is done.
static bool wants_passes(const struct gl_renderer *r, const struct frame_request *q, int way)
{
    return goes_between(&r->exchange, q, way) && takes_passes(r, q) &&
           (!r->exchange.waits || is_drawn_by_passes(r, q, way));
}

// Where OpenGL cannot do it, as it has said then, the library does.
static relume_status leave_to_library(struct gl_renderer *r, bool *left, relume_status status)
{
    if (status != RELUME_ESYSTEM)
        return status;
    r->log->message(r->log->user, RELUME_NOTE,
                    "light between objects and scene is gathered by the library, not by passes");
    *left = true;
    return RELUME_OK;
}

static void do_without_compute(struct gl_renderer *r)
{
    r->log->message(r->log->user, RELUME_NOTE,
                    "micro and ism are gathered by the library: passes of theirs need OpenGL 4.3");
    r->exchange.no_points = true;
}

static relume_status check_points(struct gl_renderer *r, const struct frame_request *q, int way)
{
    const struct drawn_way *by = way == NO_WAY ? NULL : drawn_way_of(&r->exchange, way_name(way));
    if (!by || !need_compute(by) || !wants_passes(r, q, way))
        return RELUME_OK;
    if (r->gl->compute)
        return leave_to_library(r, &r->exchange.no_points, gl_renderer_need_points(r, q, by->as));
    do_without_compute(r);
    return RELUME_OK;
}

static relume_status check_passes(struct gl_renderer *r, const struct frame_request *q,
                                  const struct frame_area *area)
{
    if (!wants_passes(r, q, q->way) && !wants_passes(r, q, q->other_way))
        return RELUME_OK;
    relume_status status =
        leave_to_library(r, &r->exchange.by_library, gl_renderer_need_between(r, q, area));
    if (!status)
        status = check_points(r, q, q->way);
    return status || q->ways == APP_SPLIT_NONE ? status : check_points(r, q, q->other_way);
}

static relume_status ask(struct gl_renderer *r, const struct frame_request *q, int slot, int way,
                         const struct relume_light *lights, int count)
{
    if (!goes_between(&r->exchange, q, way) || is_drawn_by_passes(r, q, way))
        return r->exchange.exchanger ? exchanger_ask(r->exchange.exchanger, slot, NULL) : RELUME_OK;
    struct exchange_request request = {
        .transport = relume_transports[way],
        .samples = q->way_samples,
        .bounces = q->bounces,
        .camera = q->camera,
        .lights = lights,
        .count = count,
        .moves = q->moves,
        .waits = r->exchange.waits,
    };
    if (!r->exchange.source.scene) {  // whose captures are sharp
        request.interpolation = q->view.interpolation;
        request.aperture = q->view.aperture;
        request.focus = q->view.focus;
    }
    find_size(&request.camera, q);
    const relume_status status =
        r->exchange.exchanger ? RELUME_OK
                              : exchanger_create(&r->exchange.exchanger, &r->exchange.source);
    return status ? status : exchanger_ask(r->exchange.exchanger, slot, &request);
}

// Where somebody waits, a way that cannot be drawn is an error.
static relume_status wait_for_all(struct gl_renderer *r)
{
    struct exchange_state state[EXCHANGER_SLOTS];
    relume_status status = exchanger_wait(r->exchange.exchanger);
    for (int i = 0; i < EXCHANGER_SLOTS && !status; i++) {
        exchanger_state(&state[i], r->exchange.exchanger, i);
        status = state[i].status;
    }
    return status;
}

// ---------------------------------------------------------------- drawing

static relume_status show_picture(bool *shown, struct gl_renderer *r, const struct frame_area *area,
                                  int slot)
{
    const struct relume_image *image;
    struct target *target = &r->exchange.way[slot];
    bool fresh;
    *shown = exchanger_show(&image, &fresh, r->exchange.exchanger, slot) != EXCHANGE_NONE;
    if (!*shown)
        return RELUME_OK;
    const bool other = target->width != image->width || target->height != image->height;
    const relume_status status = target_need(target, r->gl, image->width, image->height, r->log);
    if (status)
        return status;
    if (fresh || other)
        target_write(target, r->gl, image);
    r->gl->BindVertexArray(r->vertices);
    target_begin(&r->frame, r->gl);
    draw_picture(&r->programs.picture, r->gl, area, target);
    return RELUME_OK;
}

static relume_status draw_passes(bool *drawn, struct gl_renderer *r, const struct frame_request *q,
                                 const struct frame_area *area, const struct relume_light *lights,
                                 int count, double *ms, const struct drawn_way *by)
{
    if (q->timed)
        r->gl->Finish();
    const double start = now_s();
    const relume_status status = gl_renderer_draw_between(drawn, r, q, area, lights, count, by->as);
    if (q->timed)
        r->gl->Finish();
    *ms = *drawn ? 1e3 * (now_s() - start) : 0.0;
    return status;
}

static relume_status draw_way(struct gl_renderer *r, const struct frame_request *q,
                              const struct frame_area *area, const struct relume_light *lights,
                              int count, int slot, int way)
{
    const struct drawn_way *own = drawn_way_of(&r->exchange, way_name(way)),
                           *stand_in = drawn_way_of(&r->exchange, NULL);
    const bool between = goes_between(&r->exchange, q, way);
    const bool by_passes = between && is_drawn_by_passes(r, q, way);
    bool shown = false;
    relume_status status = RELUME_OK;
    if (between && !by_passes)
        status = show_picture(&shown, r, area, slot);
    double ms = 0.0;
    if (!status && !shown && between && stand_in)
        status = draw_passes(&shown, r, q, area, lights, count, &ms, own ? own : stand_in);
    r->exchange.draws_ms[slot] = by_passes ? ms : 0.0;
    if (status || shown)
        return status;
    if (!r->exchange.source.scene)
        return gl_renderer_draw_objects(r, q, area, lights, count);
    target_begin(&r->frame, r->gl);
    return RELUME_OK;
}

// r->frame is the other way. The first one comes into its left half, with a line between.
static void draw_sides(const struct gl_renderer *r, const struct frame_area *area)
{
    const struct gl *gl = r->gl;
    const int middle = area->width / 2;
    const struct frame_area whole = {
        area->width, area->height, {0, 0, area->width, area->height}, 1};
    gl->BindVertexArray(r->vertices);
    target_resume(&r->frame, gl);
    draw_picture_within(&r->programs.picture, gl, &whole, &r->exchange.beside,
                        (struct app_rectangle){0, 0, middle, area->height});
    gl->Enable(GL_SCISSOR_TEST);
    gl->Scissor(middle - 1, 0, 2, area->height);
    gl->ClearColor(0.5f, 0.5f, 0.5f, 1.0f);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    gl->Disable(GL_SCISSOR_TEST);
}

// A frame cannot be drawn from itself: what becomes of both is r->objects.lit, which takes its
// place.
static relume_status draw_difference(struct gl_renderer *r, const struct frame_area *area)
{
    const relume_status status = gl_renderer_need(&r->objects.lit, r, area);
    if (status)
        return status;
    r->gl->BindVertexArray(r->vertices);
    target_begin(&r->objects.lit, r->gl);
    draw_apart(&r->programs.apart, r->gl, area, &r->frame, &r->exchange.beside);
    target_swap(&r->frame, &r->objects.lit);
    return RELUME_OK;
}

relume_status gl_renderer_draw_ways(struct gl_renderer *r, const struct frame_request *q,
                                    const struct frame_area *area,
                                    const struct relume_light *lights, int count)
{
    const bool both = q->ways != APP_SPLIT_NONE && (!r->stage || r->exchange.source.scene);
    relume_status status = check_passes(r, q, area);
    if (!status)
        status = ask(r, q, 0, q->way, lights, count);
    if (!status)
        status = ask(r, q, 1, both ? q->other_way : NO_WAY, lights, count);
    if (!status && r->exchange.exchanger && r->exchange.waits)
        status = wait_for_all(r);
    if (r->exchange.exchanger)
        exchanger_speak(r->exchange.exchanger);
    if (!status)
        status = draw_way(r, q, area, lights, count, 0, q->way);
    if (status || !both)
        return status;
    status = gl_renderer_need(&r->exchange.beside, r, area);
    if (status)
        return status;
    target_swap(&r->frame, &r->exchange.beside);
    status = draw_way(r, q, area, lights, count, 1, q->other_way);
    if (status)
        return status;
    if (q->ways == APP_SPLIT_DIFFERENCE)
        return draw_difference(r, area);
    draw_sides(r, area);
    return RELUME_OK;
}
