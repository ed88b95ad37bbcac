// main.c - relume-view: a file in a window, or in pictures written without one
#include "context_offscreen.h"
#include "options.h"
#include "renderer.h"
#include "say.h"
#include "script.h"

#include <relume/pack.h>

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

// A file that is open, and what is drawn of it.
struct viewer {
    const struct context_backend *backend;
    void *context;
    struct gl gl;
    relume_pack *pack;
    struct app app;
    struct renderer renderer;
    char name[256];  // of the file, for the title
    int threads;     // that read files
    size_t vram_bytes;
    bool streams;  // frames are drawn with the views that are there
    const struct relume_log *log;
};

static void on_message(void *user, enum relume_level level, const char *text)
{
    (void)user;
    fprintf(stderr, "relume-view: %s%s\n", level == RELUME_WARNING ? "warning: " : "", text);
}

static int exit_code(relume_status status)
{
    switch (status) {
    case RELUME_OK: return 0;
    case RELUME_EDATA: return 1;
    case RELUME_EINVAL: return 2;
    case RELUME_ENOMEM: fputs("relume-view: out of memory\n", stderr); return 3;
    default: return 3;
    }
}

// ---------------------------------------------------------------- file

static relume_status pack_codes(const struct relume_codes **out, void *user, int view)
{
    return relume_pack_codes(out, user, view);
}

static void pack_drop(void *user, int view)
{
    relume_pack_drop(user, view);
}

static relume_status pack_surface(struct relume_image *out, void *user, int view)
{
    const struct relume_pack_info *info = relume_pack_info(user);
    struct relume_image depth;
    relume_status status = relume_pack_depth(&depth, user, view);
    if (!status)
        status = relume_surface(out, &info->geometry, info->uv[view], depth.data ? &depth : NULL,
                                info->width, info->height);
    relume_image_destroy(&depth);
    return status;
}

static struct app_file describe(const relume_pack *pack)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct app_file file = {info->geometry, info->width, info->height, info->views, {0}, {0}};
    for (int axis = 0; axis < 2; axis++)
        file.uv_min[axis] = file.uv_max[axis] = info->uv ? info->uv[0][axis] : 0.0;
    for (int i = 1; info->uv && i < info->views; i++)
        for (int axis = 0; axis < 2; axis++) {
            file.uv_min[axis] = fmin(file.uv_min[axis], info->uv[i][axis]);
            file.uv_max[axis] = fmax(file.uv_max[axis], info->uv[i][axis]);
        }
    return file;
}

static void set_name(struct viewer *v, const char *path)
{
    const char *slash = strrchr(path, '/');
    snprintf(v->name, sizeof v->name, "%s", slash ? slash + 1 : path);
}

// As relume_relight says it; only for lights that were asked for, not for each one dragged there.
static void warn_below_horizon(const struct viewer *v)
{
    const struct relume_coder_info *info = relume_coder_info(relume_pack_info(v->pack)->coder);
    for (int i = 0; info->hemispherical && i < v->app.start.lights; i++) {
        const struct relume_vec3 d = v->app.start.light[i].direction;
        char text[128];
        if ((info->pole_y ? d.y : d.z) >= 0.0)
            continue;
        snprintf(text, sizeof text,
                 "light %d lies below the horizon, where nothing was captured; the value at the "
                 "horizon is shown",
                 i + 1);
        v->log->message(v->log->user, RELUME_WARNING, text);
        return;
    }
}

// Open `path` and start the app; `v` is untouched when that fails.
static relume_status open_file(struct viewer *v, const char *path, const struct app_state *start,
                               bool look_ahead)
{
    relume_pack *pack;
    struct app app;
    relume_status status =
        relume_pack_open(&pack, path, relume_pack_params(.log = v->log, .threads = v->threads));
    if (status)
        return status;
    const struct app_file file = describe(pack);
    status = app_start(&app, &file, start, look_ahead, v->log);
    if (status) {
        relume_pack_destroy(&pack);
        return status;
    }
    renderer_destroy(&v->renderer);  // its thread may be reading the old file
    relume_pack_destroy(&v->pack);
    v->pack = pack;
    v->app = app;
    set_name(v, path);
    warn_below_horizon(v);
    return RELUME_OK;
}

static relume_status make_renderer(struct viewer *v)
{
    const struct relume_pack_info *info = relume_pack_info(v->pack);
    const struct code_source source = {pack_codes, pack_drop, v->pack, pack_surface};
    const relume_status status = renderer_create(&v->renderer, &v->gl, &source, &info->geometry,
                                                 info->uv, info->views, v->log);
    if (status)
        return status;
    v->renderer.relighter.budget = v->vram_bytes;
    return v->streams ? renderer_stream(&v->renderer) : RELUME_OK;
}

static relume_status open_context(struct viewer *v, const struct context_backend *backend,
                                  int width, int height)
{
    v->backend = backend;
    relume_status status = backend->open(&v->context, width, height, v->name, v->log);
    if (!status)
        status = gl_load(&v->gl, backend->get_proc, v->log);
    return status ? status : make_renderer(v);
}

static void close_viewer(struct viewer *v)
{
    renderer_destroy(&v->renderer);
    if (v->context)
        v->backend->close(v->context);
    relume_pack_destroy(&v->pack);
}

// ---------------------------------------------------------------- without a window

static bool sees_something(const struct viewer *v)
{
    for (int i = 0; i < v->renderer.views; i++)
        if (v->renderer.needed[i])
            return true;
    return false;
}

static relume_status save_frame(void *user, const struct app *app, const char *path)
{
    struct viewer *v = user;
    struct relume_image image;
    relume_status status = renderer_draw(&v->renderer, app);
    if (status)
        return status;
    if (!sees_something(v))
        return say(v->log, RELUME_EDATA, "%s: the eye sees nothing of the slab", v->name);
    status = renderer_read(&image, &v->renderer);
    if (!status)
        status = relume_image_save(&image, path, relume_image_params(.log = v->log));
    relume_image_destroy(&image);
    return status;
}

static relume_status run_offscreen(struct viewer *v, const struct options *o)
{
    relume_status status = open_file(v, o->file, &o->start, false);
    if (!status)
        status = open_context(v, context_offscreen(o->gl), v->app.width, v->app.height);
    if (!status && o->script)
        status = script_play(&v->app, o->script, save_frame, v, v->log);
    if (!status && o->offscreen)
        status = save_frame(v, &v->app, o->offscreen);
    return status;
}

// ---------------------------------------------------------------- in a window

// Without --size: the picture's own size, scaled to be neither a stamp nor larger than a desk.
static void choose_size(struct app *app, bool sized)
{
    const double least = 512;
    const double most[2] = {1280, 900};
    if (sized)
        return;
    double scale = fmax(1.0, least / fmax(app->width, app->height));
    scale = fmin(scale, fmin(most[0] / app->width, most[1] / app->height));
    app->width = (int)fmax(1.0, app->width * scale);
    app->height = (int)fmax(1.0, app->height * scale);
}

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static relume_status show_frame(struct viewer *v)
{
    char title[320];
    const double start = now_ms();
    const relume_status status = renderer_draw(&v->renderer, &v->app);
    if (status)
        return status;
    renderer_present(&v->renderer);
    v->gl.Finish();
    snprintf(title, sizeof title, "%s - %.1f ms - relume-view", v->name, now_ms() - start);
    v->backend->show(v->context, title);
    return RELUME_OK;
}

// A dropped file takes the place of the open one; one that cannot be opened is only complained
// about.
static relume_status drop_file(struct viewer *v, const char *path)
{
    struct app_state start = {.ball = v->app.now.ball};
    const int width = v->app.width;
    const int height = v->app.height;
    if (open_file(v, path, &start, true))
        return RELUME_OK;
    v->app.width = width;
    v->app.height = height;
    v->app.letterbox = true;
    return make_renderer(v);
}

static relume_status take_event(struct viewer *v, const struct context_event *event, bool *changed)
{
    if (event->kind == CONTEXT_CLOSE)
        v->app.quit = true;
    if (event->kind == CONTEXT_INPUT)
        *changed |= app_handle(&v->app, &event->input);
    if (event->kind != CONTEXT_DROP)
        return RELUME_OK;
    *changed = true;
    return drop_file(v, event->dropped);
}

static relume_status run_window(struct viewer *v, const struct options *o)
{
    struct app_state start = o->start;
    start.ball = true;
    v->streams = true;
    relume_status status = open_file(v, o->file, &start, true);
    if (status)
        return status;
    choose_size(&v->app, o->sized);
    v->app.letterbox = true;
    status = open_context(v, &context_glfw, v->app.width, v->app.height);
    if (status)
        return status;
    v->backend->size(v->context, &v->app.width, &v->app.height);
    bool changed = true;
    while (!status && !v->app.quit) {
        struct context_event event;
        while (!status && !v->app.quit && v->backend->next(v->context, &event, !changed))
            status = take_event(v, &event, &changed);
        if (!status && changed && !v->app.quit)
            status = show_frame(v);
        changed = !status && renderer_is_pending(&v->renderer);
    }
    return status;
}

int main(int argc, char **argv)
{
    static const struct relume_log log = {.message = on_message};
    struct options options;
    struct viewer viewer = {.log = &log};
    signal(SIGXFSZ, SIG_IGN);  // a file size limit is a write error, not a death
    signal(SIGPIPE, SIG_IGN);
    relume_status status = options_parse(&options, argc, argv, &log);
    viewer.threads = options.threads;
    viewer.vram_bytes = (size_t)(options.vram_mb * 1048576.0);
    if (!status && !options.file)
        options_help();
    else if (!status)
        status =
            (options.offscreen || options.script ? run_offscreen : run_window)(&viewer, &options);
    close_viewer(&viewer);
    return exit_code(status);
}
