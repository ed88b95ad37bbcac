#include "session.h"

#include "lamps.h"
#include "say.h"

#include <relume/tone.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// ---------------------------------------------------------------- file

static struct app_file describe(const relume_pack *pack)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct app_file file = {
        .geometry = info->geometry,
        .width = info->width,
        .height = info->height,
        .views = info->views,
    };
    for (int axis = 0; axis < 2; axis++)
        file.uv_min[axis] = file.uv_max[axis] = info->uv ? info->uv[0][axis] : 0.0;
    for (int i = 1; info->uv && i < info->views; i++)
        for (int axis = 0; axis < 2; axis++) {
            file.uv_min[axis] = fmin(file.uv_min[axis], info->uv[i][axis]);
            file.uv_max[axis] = fmax(file.uv_max[axis], info->uv[i][axis]);
        }
    return file;
}

static void set_name(struct session *s, const char *path)
{
    const char *slash = strrchr(path, '/');
    snprintf(s->name, sizeof s->name, "%s", slash ? slash + 1 : path);
}

// As relume_relight says it; only for lights that were asked for, not for each one dragged there.
static void warn_below_horizon(const struct session *s)
{
    const struct relume_coder_info *info = relume_coder_info(relume_pack_info(s->pack)->coder);
    for (int i = 0; info->hemispherical && i < s->app.start.lights; i++) {
        const struct relume_vec3 d = s->app.start.light[i].direction;
        char text[128];
        if (s->app.start.light[i].kind != RELUME_LIGHT_DIRECTIONAL ||
            (info->pole_y ? d.y : d.z) >= 0.0)
            continue;
        snprintf(text, sizeof text,
                 "light %d lies below the horizon, where nothing was captured; the value at the "
                 "horizon is shown",
                 i + 1);
        s->log->message(s->log->user, RELUME_WARNING, text);
        return;
    }
}

// What the panel says of the file.
static void describe_lines(struct session *s)
{
    const struct relume_pack_info *info = relume_pack_info(s->pack);
    const struct relume_coder_info *coder = relume_coder_info(info->coder);
    int n = 0;
    snprintf(s->line[n++], SESSION_TEXT, "%s, %d x %d",
             relume_projection_name(info->geometry.projection), info->width, info->height);
    if (info->views > 1)
        snprintf(s->line[n++], SESSION_TEXT, "%d views", info->views);
    snprintf(s->line[n++], SESSION_TEXT, "%s, %d coefficients, %d lights", coder->basis->name,
             coder->coefficients, coder->lights);
    snprintf(s->line[n++], SESSION_TEXT, "%s domain%s",
             info->domain == RELUME_DOMAIN_DISPLAY ? "display" : "linear",
             info->has_depth ? ", with depth" : "");
    if (info->books)
        snprintf(s->line[n++], SESSION_TEXT, "%d codebooks, the first of %d", info->books,
                 info->codes);
    else
        snprintf(s->line[n++], SESSION_TEXT, "%s bits, %s", relume_storage_name(info->storage),
                 info->compression);
    snprintf(s->line[n++], SESSION_TEXT, "%.3f MB, %.2f bits per pixel",
             (double)info->file_bytes * 1e-6,
             8.0 * (double)info->file_bytes /
                 ((double)info->views * (double)info->width * (double)info->height));
    for (int i = 0; i < n; i++)
        s->lines[i] = s->line[i];
    s->lines[n] = NULL;
}

static relume_status check_depth(const relume_pack *pack, const struct app_state *start,
                                 const struct relume_log *log)
{
    if (start->interpolation != RELUME_INTERPOLATE_DEPTH || relume_pack_info(pack)->has_depth)
        return RELUME_OK;
    return say(log, RELUME_EDATA,
               "interpolation by depth needs to know where the surface is; expected a file with "
               "depth");
}

// Planar files without depth lie on z = 0.
static bool has_surface(const struct session *s)
{
    const struct relume_pack_info *info = relume_pack_info(s->pack);
    return info->has_depth || info->geometry.projection == RELUME_PLANAR;
}

relume_status session_compare(struct session *s, const char *capture)
{
    return relume_capture_open(&s->capture, capture, relume_capture_params(.log = s->log));
}

// The renderer first: its thread may be reading.
static void close_file(struct session *s)
{
    renderer_destroy(&s->renderer);
    pack_source_destroy(&s->source);
    relume_pack_destroy(&s->pack);
}

relume_status session_open(struct session *s, const char *path, const struct app_state *start,
                           bool look_ahead)
{
    relume_pack *pack;
    struct app app;
    relume_status status =
        relume_pack_open(&pack, path, relume_pack_params(.log = s->log, .threads = s->threads));
    if (status)
        return status;
    const struct app_file file = describe(pack);
    status = app_start(&app, &file, start, look_ahead, s->log);
    if (!status)
        status = check_depth(pack, start, s->log);
    if (status) {
        relume_pack_destroy(&pack);
        return status;
    }
    close_file(s);
    s->pack = pack;
    s->app = app;
    s->app.compared = s->capture != NULL;
    s->app.near_lights = has_surface(s);
    set_name(s, path);
    describe_lines(s);
    warn_below_horizon(s);
    return RELUME_OK;
}

// ---------------------------------------------------------------- drawing

static relume_status make_renderer(struct session *s)
{
    const struct relume_pack_info *info = relume_pack_info(s->pack);
    relume_status status = pack_source_create(&s->source, s->pack);
    if (status)
        return status;
    const struct code_source source = pack_source_codes(s->source);
    const struct depth_source depth = pack_source_depth(s->source);
    status = renderer_create(&s->renderer, &s->gl, &source, &info->geometry, info->uv, info->views,
                             s->log);
    if (status)
        return status;
    s->renderer.relighter.budget = s->vram_bytes;
    renderer_use_capture(&s->renderer, s->capture);
    if (info->has_depth)
        status = renderer_use_depth(&s->renderer, &depth);
    return status || !s->streams ? status : renderer_stream(&s->renderer);
}

relume_status session_start(struct session *s, const struct context_backend *backend, int width,
                            int height)
{
    s->backend = backend;
    relume_status status = backend->open(&s->context, width, height, s->name, s->log);
    if (!status)
        status = gl_load(&s->gl, backend->get_proc, s->log);
    if (!status)
        status = make_renderer(s);
    if (!status)
        status = panel_create(&s->panel, backend->scale(s->context));
    return status ? status : draw_panel_create(&s->drawing, &s->gl, s->panel, s->log);
}

relume_status session_drop(struct session *s, const char *path)
{
    const struct app was = s->app;
    inspect_destroy(&s->inspector);
    const struct app_state start = {
        .ball = was.now.ball,
        .auto_exposure = was.now.auto_exposure,
        .tone = was.now.tone,
        .white = was.now.white,
    };
    if (session_open(s, path, &start, true))
        return RELUME_OK;
    s->app.width = was.width;
    s->app.height = was.height;
    s->app.letterbox = was.letterbox;
    s->app.panel = was.panel;
    s->app.gizmos = was.gizmos;
    relume_capture_destroy(&s->capture);
    s->app.compared = false;
    return make_renderer(s);
}

void session_close(struct session *s)
{
    if (s->screen.texture)
        target_destroy(&s->screen, &s->gl);
    inspect_destroy(&s->inspector);
    draw_panel_destroy(&s->drawing, &s->gl);
    panel_destroy(&s->panel);
    close_file(s);
    if (s->context)
        s->backend->close(s->context);
    relume_capture_destroy(&s->capture);
    relume_rig_destroy(&s->rig);
}

static void count_histogram(struct session *s)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const struct relume_tone_params tone = {.tone = relume_tones[s->app.now.tone],
                                            .white = s->app.now.white};
    struct relume_image frame;
    memset(s->histogram, 0, sizeof s->histogram);
    if (renderer_read(&frame, &s->renderer))
        return;
    if (relume_tone_apply(&frame, &tone)) {
        relume_image_destroy(&frame);
        return;
    }
    const size_t samples = 3 * (size_t)frame.width * (size_t)frame.height;
    for (size_t i = 0; i < samples; i++) {
        const float code = relume_transfer_encode(srgb, frame.data[i]);
        s->histogram[(int)fminf(fmaxf(255 * code + 0.5f, 0), 255)][i % 3]++;
    }
    relume_image_destroy(&frame);
}

static relume_status grant_wish(struct session *s);

// The first frame is drawn once more, with the exposure that it asks for.
static relume_status meter(struct session *s)
{
    const double before = app_exposure_ev(&s->app);
    double ev;
    const relume_status status = renderer_meter(&ev, &s->renderer);
    if (status)
        return status;
    app_meter(&s->app, ev);
    return app_exposure_ev(&s->app) == before ? RELUME_OK : renderer_draw(&s->renderer, &s->app);
}

static relume_status inspect(struct session *s, bool *shown)
{
    relume_status status = RELUME_OK;
    const struct code_source source = pack_source_codes(s->source);
    if (!s->inspector.weights)
        status = inspect_create(&s->inspector, relume_pack_info(s->pack), &source, s->renderer.grid,
                                s->capture);
    if (!status)
        status = inspect_update(&s->inspector, &s->app, shown);
    if (!status && *shown)
        draw_panel_plot(&s->drawing, &s->gl, &s->inspector.plot);
    return status;
}

static relume_status build_panel(struct session *s, bool histogram)
{
    bool plot = false;
    const relume_status status = s->app.inspect ? inspect(s, &plot) : RELUME_OK;
    const struct panel_facts facts = {
        .file = s->name,
        .line = s->lines,
        .message = s->message,
        .histogram = histogram ? (const uint32_t(*)[3])s->histogram : NULL,
        .plot = plot ? &s->inspector.plot : NULL,
        .plot_text = s->inspector.text,
    };
    if (!status)
        (void)panel_build(s->panel, &s->app, &facts);
    return status;
}

// Once more, with the histogram of the frame that has just been drawn.
static relume_status add_histogram(struct session *s)
{
    if (!panel_shown(&s->app) || !panel_wants_histogram(s->panel))
        return RELUME_OK;
    count_histogram(s);
    return build_panel(s, true);
}

// A panel that has just appeared is made at once, so that the next click finds it.
bool session_send(struct session *s, const struct app_event *event)
{
    const bool shown = panel_shown(&s->app);
    if (shown && panel_takes(s->panel, event))
        return true;
    const bool changed = app_handle(&s->app, event);
    if (!shown && panel_shown(&s->app) && build_panel(s, false))
        return true;  // what went wrong goes wrong again when it is drawn, and is told there
    return changed || shown || s->app.wish;
}

relume_status session_draw(struct session *s)
{
    relume_status status = panel_shown(&s->app) ? build_panel(s, false) : RELUME_OK;
    if (!status)
        status = grant_wish(s);
    if (!status)
        status = renderer_draw(&s->renderer, &s->app);
    if (!status && s->app.now.auto_exposure)
        status = meter(s);
    return status ? status : add_histogram(s);
}

bool session_pass(struct session *s, double seconds)
{
    return app_advance(&s->app, seconds);
}

static void present_onto(struct session *s, GLuint framebuffer)
{
    renderer_present(&s->renderer, &s->app, framebuffer);
    if (panel_shown(&s->app))
        draw_panel(&s->drawing, &s->gl, s->panel, s->app.width, s->app.height);
}

void session_present(struct session *s)
{
    present_onto(s, 0);
}

// ---------------------------------------------------------------- pictures

static bool sees_something(const struct session *s)
{
    for (int i = 0; i < s->renderer.views; i++)
        if (s->renderer.needed[i])
            return true;
    return false;
}

static relume_status save(struct session *s, struct relume_image *image, const char *path)
{
    const relume_status status = relume_image_save(image, path, relume_image_params(.log = s->log));
    relume_image_destroy(image);
    return status;
}

// The last frame; `linear` or by the app's tone.
static relume_status read_frame(struct relume_image *image, struct session *s, bool linear)
{
    const struct relume_tone_params tone = {.tone = relume_tones[s->app.now.tone],
                                            .white = s->app.now.white};
    *image = (struct relume_image){0};
    if (!sees_something(s))
        return say(s->log, RELUME_EDATA, "%s: the eye sees nothing of the slab", s->name);
    relume_status status = renderer_read(image, &s->renderer);
    if (!status && !linear)
        status = relume_tone_apply(image, &tone);
    return status;
}

relume_status session_frame(struct session *s, const char *path)
{
    struct relume_image image;
    relume_status status = session_draw(s);
    if (!status)
        status = read_frame(&image, s, relume_image_saves_linear(path));
    return status ? status : save(s, &image, path);
}

static relume_status add_pictures(struct session *s, struct record *record, enum record_kind kind,
                                  int frames)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < frames; i++) {
        struct relume_image image = {0};
        status = record_pose(&s->app, kind, (double)i / frames, s->log);
        if (!status)
            status = renderer_draw(&s->renderer, &s->app);
        if (!status)
            status = read_frame(&image, s, false);
        if (!status)
            status = record_add(record, &image);
        relume_image_destroy(&image);
    }
    return status;
}

relume_status session_record(struct session *s, enum record_kind kind, const char *path, int frames)
{
    const struct app_state before = s->app.now;
    struct record *record;
    relume_status status = record_open(&record, path, s->log);
    if (status)
        return status;
    s->app.now.ball = false;
    status = add_pictures(s, record, kind, frames);
    s->app.now = before;
    if (!status)
        return record_commit(&record);
    record_abort(&record);
    return status;
}

static relume_status prepare_screen(struct session *s)
{
    if (s->screen.width == s->app.width && s->screen.height == s->app.height)
        return RELUME_OK;
    if (s->screen.texture)
        target_destroy(&s->screen, &s->gl);
    return target_create(&s->screen, &s->gl, s->app.width, s->app.height, s->log);
}

// The screen's first row is the lowest, and its values are coded.
static void turn_over_and_decode(struct relume_image *image)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const size_t row = 3 * (size_t)image->width;
    for (int y = 0; y < image->height / 2; y++) {
        float *top = image->data + (size_t)y * row;
        float *low = image->data + (size_t)(image->height - 1 - y) * row;
        for (size_t i = 0; i < row; i++) {
            const float keep = top[i];
            top[i] = low[i];
            low[i] = keep;
        }
    }
    for (size_t i = 0; i < row * (size_t)image->height; i++)
        image->data[i] = relume_transfer_decode(srgb, image->data[i]);
}

relume_status session_shot(struct session *s, const char *path)
{
    struct relume_image image;
    relume_status status = session_draw(s);
    if (!status)
        status = prepare_screen(s);
    if (status)
        return status;
    present_onto(s, s->screen.framebuffer);
    status = target_read(&image, &s->screen, &s->gl);
    if (status)
        return status;
    turn_over_and_decode(&image);
    return save(s, &image, path);
}

// ---------------------------------------------------------------- wishes

static relume_status too_many(const struct session *s)
{
    return say(s->log, RELUME_EINVAL, "lights: expected at most %d; found more", APP_LIGHTS);
}

static struct app_lamp lamp_of(const struct relume_rig_entry *e, int entry)
{
    return (struct app_lamp){
        .off = !e->on || !(e->intensity > 0),
        .solo = e->solo,
        .stops = e->intensity > 0 ? log2(e->intensity) : 0,
        .entry = entry,
    };
}

static relume_status append_entries(const struct session *s, struct app_state *to, int first)
{
    for (int i = first; i < relume_rig_count(s->rig); i++) {
        const struct relume_rig_entry *e = relume_rig_entry(s->rig, i);
        if (!lamps_add(to, &e->light, i))
            return too_many(s);
        to->lamp[to->selected] = lamp_of(e, i);
    }
    return RELUME_OK;
}

// Entries from `first` on.
static relume_status check_near(const struct session *s, int first)
{
    for (int i = first; i < relume_rig_count(s->rig); i++)
        if (!s->app.near_lights && relume_light_is_near(relume_rig_entry(s->rig, i)->light.kind))
            return say(s->log, RELUME_EDATA,
                       "light '%s': near lights need to know where the surface is; expected a file "
                       "with depth",
                       relume_rig_entry(s->rig, i)->spec);
    return RELUME_OK;
}

relume_status session_take_rig(struct session *s, relume_rig **rig, struct app_state *start)
{
    s->rig = *rig;
    *rig = NULL;
    const relume_status status = s->rig ? append_entries(s, start, 0) : relume_rig_create(&s->rig);
    start->selected = 0;
    return status;
}

relume_status session_light(struct session *s, const char *spec, bool replace)
{
    struct app_state *now = &s->app.now;
    const int entry = relume_rig_count(s->rig);
    relume_status status = relume_rig_add(s->rig, spec, NULL, s->log);
    if (!status)
        status = check_near(s, entry);
    if (status)
        return status;
    if (replace)
        now->lights = 0;
    return append_entries(s, now, entry);
}

// Its files stay with the session's own rig, which lights that were there before still need.
relume_status session_load_rig(struct session *s, const char *path)
{
    struct app_state *now = &s->app.now;
    const int first = relume_rig_count(s->rig);
    relume_rig *loaded;
    relume_status status = relume_rig_load(&loaded, path, s->log);
    for (int i = 0; !status && i < relume_rig_count(loaded); i++) {
        const struct relume_rig_entry *e = relume_rig_entry(loaded, i);
        status = relume_rig_add(s->rig, e->spec, NULL, s->log);
        if (!status)
            status = relume_rig_set(s->rig, first + i, e, s->log);
    }
    if (!status)
        status = check_near(s, first);
    if (!status && relume_rig_count(loaded) > APP_LIGHTS)
        status = too_many(s);
    if (!status && relume_rig_count(loaded) > 0) {
        now->lights = 0;
        status = append_entries(s, now, first);
        now->selected = 0;
    }
    relume_rig_destroy(&loaded);
    return status;
}

// Any light of that kind; the numbers follow.
static const char *words_of(enum relume_light_kind kind)
{
    switch (kind) {
    case RELUME_LIGHT_POINT: return "point 0 0 1";
    case RELUME_LIGHT_SPOT: return "spot 0 0 1 0 0 -1 25";
    case RELUME_LIGHT_AREA: return "area 0 0 1 1 0 0 0 1 0";
    default: return "dir 0 0 1";
    }
}

static relume_status store_light(const struct session *s, relume_rig *rig, int light)
{
    const struct app_lamp *lamp = &s->app.now.lamp[light];
    const struct relume_light *l = &s->app.now.light[light];
    const struct relume_rig_entry *from =
        lamp->entry >= 0 ? relume_rig_entry(s->rig, lamp->entry) : NULL;
    relume_status status = relume_rig_add(rig, from ? from->spec : words_of(l->kind), NULL, s->log);
    if (status)
        return status;
    struct relume_rig_entry e = *relume_rig_entry(rig, light);
    e.on = !lamp->off;
    e.solo = lamp->solo;
    e.intensity = exp2(lamp->stops);
    e.name = from ? from->name : e.name;
    e.light = *l;
    return relume_rig_set(rig, light, &e, s->log);
}

relume_status session_save_rig(struct session *s, const char *path)
{
    relume_rig *rig;
    relume_status status = relume_rig_create(&rig);
    for (int i = 0; !status && i < s->app.now.lights; i++)
        status = store_light(s, rig, i);
    if (!status)
        status = relume_rig_save(rig, path, s->log);
    relume_rig_destroy(&rig);
    return status;
}

// "NAME-0001.png" with the first number that is free.
static void free_name(char *path, size_t size, const struct session *s, const char *extension)
{
    const char *dot = strrchr(s->name, '.');
    const int stem = dot ? (int)(dot - s->name) : (int)strlen(s->name);
    for (int i = 1; i < 10000; i++) {
        snprintf(path, size, "%.*s-%04d%s", stem, s->name, i, extension);
        if (access(path, F_OK))
            return;
    }
}

static relume_status wish_picture(struct session *s, const char *extension)
{
    char path[SESSION_TEXT + 16];
    free_name(path, sizeof path, s, extension);
    const bool ball = s->app.now.ball;
    s->app.now.ball = false;
    const relume_status status = session_frame(s, path);
    s->app.now.ball = ball;
    snprintf(s->message, sizeof s->message, "%.200s %s", path,
             status ? "was not written" : "written");
    return RELUME_OK;
}

static relume_status wish_png(struct session *s)
{
    return wish_picture(s, ".png");
}

static relume_status wish_exr(struct session *s)
{
    return wish_picture(s, ".exr");
}

static relume_status wish_recording(struct session *s, enum record_kind kind, const char *ending)
{
    char path[SESSION_TEXT + 16];
    free_name(path, sizeof path, s, ending);
    const relume_status status = session_record(s, kind, path, RECORD_FRAMES);
    snprintf(s->message, sizeof s->message, "%.200s %s", path,
             status ? "was not recorded" : "recorded");
    return RELUME_OK;
}

static relume_status wish_sweep(struct session *s)
{
    return wish_recording(s, RECORD_SWEEP, "-sweep");
}

static relume_status wish_turntable(struct session *s)
{
    return wish_recording(s, RECORD_TURNTABLE, "-turntable");
}

static relume_status wish_save_rig(struct session *s)
{
    char path[SESSION_TEXT + 16];
    free_name(path, sizeof path, s, ".json");
    const relume_status status = session_save_rig(s, path);
    snprintf(s->message, sizeof s->message, "%.200s %s", path,
             status ? "was not written" : "written");
    return RELUME_OK;
}

static relume_status wish_add_light(struct session *s)
{
    const bool added = !session_light(s, s->app.spec, false);
    snprintf(s->message, sizeof s->message, added ? "added: %.200s" : "no light: %.200s",
             s->app.spec);
    return RELUME_OK;
}

// What was wished for is done once; what fails is said in the panel and in the log.
static relume_status grant_wish(struct session *s)
{
    static relume_status (*const grants[])(struct session *) = {
        [APP_WISH_PNG] = wish_png,
        [APP_WISH_EXR] = wish_exr,
        [APP_WISH_SAVE_RIG] = wish_save_rig,
        [APP_WISH_SWEEP] = wish_sweep,
        [APP_WISH_TURNTABLE] = wish_turntable,
        [APP_WISH_ADD_LIGHT] = wish_add_light,
    };
    const enum app_wish wish = s->app.wish;
    s->app.wish = APP_WISH_NONE;
    if ((size_t)wish >= sizeof grants / sizeof *grants || !grants[wish])
        return RELUME_OK;
    return grants[wish](s);
}
