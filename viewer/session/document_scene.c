// document_scene.c - scene files: several captures and objects in one world, drawn by the library
// in a thread of its own (relit/exchanger.h) for an eye that goes around in it
#include "session/session.h"

#include "app/light_list.h"
#include "cli/program/say.h"
#include "common/vec.h"

#include <relume/world/tableau.h>
#include <stdio.h>

bool session_is_scene(const char *path)
{
    return relume_tableau_is(path);
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

static void look(struct relume_camera *camera, const struct relume_camera *own)
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

// What the panel says of it.
static void describe(struct session *s, const struct relume_tableau_info *info)
{
    int n = 0;
    snprintf(s->line[n++], SESSION_TEXT, "scene: %d capture%s, %d object%s", info->captures,
             relume_plural(info->captures), info->entities - info->captures,
             relume_plural(info->entities - info->captures));
    for (int i = 0; i < info->entities && n < SESSION_LINES; i++) {
        const struct relume_tableau_entity *e = &info->entity[i];
        const enum relume_projection is =
            e->pack ? relume_pack_info(e->pack)->geometry.projection : RELUME_PLANAR;
        if (e->pack)
            snprintf(s->line[n++], SESSION_TEXT, "%.200s: %s", e->name, relume_projection_name(is));
        else
            snprintf(s->line[n++], SESSION_TEXT, "%.200s: %zu triangle%s", e->name, e->triangles,
                     relume_plural((int64_t)e->triangles));
    }
    for (int i = 0; i < n; i++)
        s->lines[i] = s->line[i];
    s->lines[n] = NULL;
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

static relume_status open_app(struct app *app, relume_slab_set **stage, struct session *s,
                              const struct app_state *start, relume_tableau *tableau)
{
    const struct relume_tableau_info *info = relume_tableau_info(tableau);
    struct app_file file = {.width = info->camera.width,
                            .height = info->camera.height,
                            .views = 1,
                            .only_colour = true,
                            .scene = true,
                            .between = info->captures && info->entities > info->captures};
    struct app_state from = *start;
    look(&from.camera, &info->camera);
    relume_status status = make_stage(stage, &file.geometry, &from.camera);
    if (status)
        return say(s->log, RELUME_EINVAL, "the eye stands where it looks");
    file.around = *stage;
    return start_app(app, s, &file, &from, relume_tableau_rig(tableau));
}

relume_status session_open_scene(struct session *s, const char *path, const struct app_state *start)
{
    relume_tableau *tableau;
    relume_slab_set *stage = NULL;
    struct app app = {.width = 0};
    relume_status status = check_asked(s, path, start);
    if (!status)
        status = relume_tableau_open(&tableau, path,
                                     relume_tableau_params(.log = s->log, .threads = s->threads));
    if (status)
        return status;
    status = open_app(&app, &stage, s, start, tableau);
    if (status) {
        app_release(&app);
        relume_slab_set_destroy(&stage);
    } else {
        session_close_file(s);
        app_release(&s->app);
        s->stage = stage;
        s->app = app;
        s->app.near_lights = true;
        s->scene = true;
        snprintf(s->file, sizeof s->file, "%s", path);
        session_set_name(s, path);
        describe(s, relume_tableau_info(tableau));
    }
    relume_tableau_destroy(&tableau);
    return status;
}

relume_status session_make_scene(struct session *s)
{
    static const double uv[1][2] = {{0.0, 0.0}};
    const struct code_source nothing = {.user = NULL};
    const struct exchange_source source = {
        .file = s->file, .scene = true, .log = s->log, .threads = s->threads};
    const relume_status status =
        gl_renderer_create(&s->renderer, &s->gl, &nothing, &s->app.file.geometry, NULL, 1, s->log);
    if (status)
        return status;
    gl_renderer_use_slabs(&s->renderer, s->stage, uv, NULL);
    gl_renderer_use_exchange(&s->renderer, &source);
    return RELUME_OK;
}
