// document_nothing.c - no file: a page that says how to open one
#include "session/session.h"

static bool is_nothing(const char *path, const struct object_set *objects)
{
    return !path && !objects->objects;
}

static relume_status open_nothing(struct opening *out, struct session *s, const char *path,
                                  const struct app_state *start, bool look_ahead)
{
    const struct app_file file = {
        .geometry = {.projection = RELUME_PLANAR, .window_min = {-1, -1}, .window_max = {1, 1}},
        .width = 960,
        .height = 600,
        .views = 1,
        .empty = true,
    };
    (void)path, (void)look_ahead;
    document_set_path(&out->document, "no file");
    return app_start(&out->app, &file, start, true, s->log);
}

static relume_status make_nothing(struct session *s)
{
    const relume_status status = session_make_bare(s);
    s->renderer.empty = true;
    return status;
}

const struct document_kind document_nothing = {
    .is = is_nothing,
    .open = open_nothing,
    .make = make_nothing,
};
