// session_ways.c - light between the objects and the scene: what the renderer must know for it, and
// what is said of it
#include "session/session.h"

#include "app/way.h"

#include <stdio.h>

static void let_go(void *user)
{
    struct session *s = user;
    gl_renderer_let_go(&s->renderer);
}

void session_add_ways(struct session *s)
{
    const struct exchange_source source = {.file = s->document.path,
                                           .sphere = s->document.as_panorama,
                                           .objects = s->objects.objects,
                                           .log = s->log,
                                           .threads = s->settings.threads};
    gl_renderer_use_exchange(&s->renderer, &source);
    s->renderer.exchange.with_depth = relume_pack_info(s->document.pack)->has_depth;
    s->renderer.exchange.by_library = session_by_library(s->settings.relight, &s->window.gl);
    s->app.lookers = (struct app_lookers){s, let_go};
}

void session_hear_ways(struct session *s, const struct app_state *before)
{
    const struct app_state *now = &s->app.now;
    if (now->ways != before->ways && now->ways != APP_SPLIT_NONE)
        session_say(s, "light between objects and scene: %s %s %s", way_name(now->way),
                    now->ways == APP_SPLIT_SIDES ? "beside" : "less", way_name(now->other_way));
    else if (now->way != before->way || now->ways != before->ways)
        session_say(s, "light between objects and scene: %s", way_name(now->way));
}

static void describe_exchange(char text[SESSION_TEXT], struct exchanger *e, int slot)
{
    struct exchange_state state;
    exchanger_state(&state, e, slot);
    int n = 0;
    if (state.status)
        n = snprintf(text, SESSION_TEXT, "cannot be drawn here");
    else if (state.width)
        n = snprintf(text, SESSION_TEXT, "%d x %d in %.2g s", state.width, state.height,
                     state.seconds);
    if (state.works)
        snprintf(text + n, (size_t)(SESSION_TEXT - n), "%sgathering light, %.0f %%", n ? "; " : "",
                 100.0 * state.done);
}

static void describe_way(char text[SESSION_TEXT], const struct gl_renderer *r, int slot, int way)
{
    char more[SESSION_TEXT] = "";
    if (r->exchange.draws_ms[slot] > 0.0)
        snprintf(more, sizeof more, "by passes, %.1f ms a frame", r->exchange.draws_ms[slot]);
    else if (r->exchange.exchanger)
        describe_exchange(more, r->exchange.exchanger, slot);
    text[0] = '\0';
    if (more[0])
        snprintf(text, SESSION_TEXT, "%s: %.200s", way_name(way), more);
}

void session_describe_ways(struct session *s)
{
    const struct app_state *now = &s->app.now;
    const int way[EXCHANGER_SLOTS] = {now->way, now->other_way};
    for (int i = 0; i < EXCHANGER_SLOTS; i++) {
        const bool shown = i == 0 || now->ways != APP_SPLIT_NONE;
        s->panel.way[i][0] = '\0';
        if (shown && way_gathers(way[i]))
            describe_way(s->panel.way[i], &s->renderer, i, way[i]);
    }
}
