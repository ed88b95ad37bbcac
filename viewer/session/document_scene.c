// document_scene.c - scene files: several captures and objects in one world, drawn by the library
// in a thread of its own (relit/exchanger.h) for an eye that goes around in it
#include "session/session.h"

#include "app/light_list.h"
#include "cli/program/say.h"
#include "common/vec.h"

#include <relume/exchange.h>
#include <relume/world/tableau.h>
#include <stdio.h>

static bool is_scene(const char *path, const struct object_set *objects)
{
    (void)objects;
    return path && relume_kind_of(path) == RELUME_KIND_SCENE;
}

// What is asked for and a scene has not.
static relume_status check_asked(const struct session *s, const char *path,
                                 const struct app_state *start)
{
    const struct {
        const char *option;
        bool asked;
    } of_files[] = {
        {"--view", start->camera.framing == RELUME_FRAME_VIEW},
        {"--pan, --tilt, --zoom and --projection", start->camera.framing == RELUME_FRAME_LOOK},
        {"--interpolate", start->interpolation != RELUME_INTERPOLATE_DEFAULT},
        {"--aperture", start->aperture != 0.0},
        {"--focus", start->focused},
        {"--pass", start->pass != RELUME_PASS_COLOUR},
        {"--capture", s->capture != NULL},
    };
    for (size_t i = 0; i < sizeof of_files / sizeof *of_files; i++)
        if (of_files[i].asked)
            return say(
                s->log, RELUME_EINVAL,
                "%s: a scene file is seen by an eye in its world, sharp and in colour; leave "
                "out %s",
                path, of_files[i].option);
    return RELUME_OK;
}

// One camera below what is looked at, where no eye goes: none is held back to where cameras stand.
static relume_status make_stage(relume_slab_set **out, struct relume_geometry *g,
                                const struct relume_camera *camera)
{
    const double uv[1][2] = {{0.0, 0.0}};
    const struct relume_vec3 at = camera->look_at.at;
    const double away = vec3_length(vec3_sub(camera->eye, at));
    *g = (struct relume_geometry){
        .projection = RELUME_SLAB,
        .uv_z = away,
        .st_min = {-0.5 * away, -0.5 * away},
        .st_max = {0.5 * away, 0.5 * away},
        .pose = {.origin = at, .axis = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}},
    };
    return relume_slab_set_create(out, g, 1, uv, NULL, 1);
}

static void choose_camera(struct relume_camera *camera, const struct relume_camera *own)
{
    const struct relume_camera asked = *camera;
    *camera = *own;
    camera->width = asked.width;
    camera->height = asked.height;
    if (asked.framing == RELUME_FRAME_EYE)
        camera->eye = asked.eye;
    if (asked.look_at.aimed)
        camera->look_at.at = asked.look_at.at;
    if (vec3_length(asked.look_at.up) > 0.0)
        camera->look_at.up = asked.look_at.up;
    if (asked.look_at.field_of_view_deg != 0.0)
        camera->look_at.field_of_view_deg = asked.look_at.field_of_view_deg;
}

static void describe_scene(struct document *d, const struct relume_tableau_info *info)
{
    const int objects = info->entities - info->captures;
    document_add_line(d, "scene: %d capture%s, %d object%s", info->captures,
                      relume_plural(info->captures), objects, relume_plural(objects));
    for (int i = 0; i < info->entities; i++) {
        const struct relume_tableau_entity *e = &info->entity[i];
        if (e->pack)
            document_add_line(
                d, "%.200s: %s", e->name,
                relume_projection_name(relume_pack_info(e->pack)->geometry.projection));
        else
            document_add_line(d, "%.200s: %zu triangle%s", e->name, e->triangles,
                              relume_plural((int64_t)e->triangles));
    }
}

// The lights of the file, where nobody named any.
static relume_status start_app(struct app *app, struct session *s, const struct app_file *file,
                               const struct app_state *start, const relume_rig *rig)
{
    struct app_state from = {0};
    if (!light_list_copy(&from, start))
        return RELUME_ENOMEM;
    relume_status status = from.lights ? RELUME_OK : session_append_lights(s, &from, rig);
    const struct relume_light front = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
    if (!status && !from.lights) {  // the file has none: one that is off, to begin with
        status = light_list_add(&from, &front, -1) ? RELUME_OK : RELUME_ENOMEM;
        if (!status)
            from.light_state[0].off = true;
    }
    from.selected = 0;
    if (!status)
        status = app_start(app, file, &from, true, s->log);
    light_list_release(&from);
    return status;
}

static relume_status open_app(struct opening *out, struct session *s, const struct app_state *start,
                              relume_tableau *tableau)
{
    const struct relume_tableau_info *info = relume_tableau_info(tableau);
    struct app_file file = {.width = info->camera.width,
                            .height = info->camera.height,
                            .views = 1,
                            .only_colour = true,
                            .scene = true,
                            .between = info->captures && info->entities > info->captures};
    struct app_state from = *start;
    choose_camera(&from.camera, &info->camera);
    relume_status status = make_stage(&out->document.slabs, &file.geometry, &from.camera);
    if (status)
        return say(s->log, RELUME_EINVAL, "the eye stands where it looks");
    file.around = out->document.slabs;
    return start_app(&out->app, s, &file, &from, relume_tableau_rig(tableau));
}

static relume_status open_scene(struct opening *out, struct session *s, const char *path,
                                const struct app_state *start, bool look_ahead)
{
    relume_tableau *tableau;
    (void)look_ahead;
    relume_status status = check_asked(s, path, start);
    if (!status)
        status = relume_tableau_open(
            &tableau, path, relume_tableau_params(.log = s->log, .threads = s->settings.threads));
    if (status)
        return status;
    status = open_app(out, s, start, tableau);
    out->app.near_lights = true;
    document_set_path(&out->document, path);
    describe_scene(&out->document, relume_tableau_info(tableau));
    relume_tableau_destroy(&tableau);
    return status;
}

static relume_status make_scene(struct session *s)
{
    const struct exchange_source source = {
        .file = s->document.path, .scene = true, .log = s->log, .threads = s->settings.threads};
    const relume_status status = session_make_stage(s);
    if (!status)
        gl_renderer_use_exchange(&s->renderer, &source);
    return status;
}

const struct document_kind document_scene = {
    .is = is_scene,
    .open = open_scene,
    .make = make_scene,
};
