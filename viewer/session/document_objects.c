// document_objects.c - objects: in the scene of a file, or alone on a stage that the eye goes
// around
#include "session/session.h"

#include "common/vec.h"

#include <relume/exchange.h>
#include <stdio.h>
#include <string.h>

static void say_matte(const relume_objects *objects, const struct relume_log *log)
{
    const struct relume_objects_info *info = relume_objects_info(objects);
    for (int i = 0; i < info->materials; i++)
        if (info->material[i].translucent) {
            if (log && log->message)
                log->message(log->user, RELUME_NOTE,
                             "translucent materials are shown matte by passes; relume relight and "
                             "relume btf render show light going through them");
            return;
        }
}

relume_status session_take_objects(struct session *s, const struct session_objects *wanted)
{
    const struct relume_objects_params params = {.log = s->log, .threads = s->threads};
    s->wanted = *wanted;
    s->material[0] = '\0';
    snprintf(s->described, sizeof s->described, "%s",
             wanted->description ? wanted->description : "");
    snprintf(s->reflections, sizeof s->reflections, "%s",
             wanted->reflections ? wanted->reflections : "");
    if (!wanted->description && wanted->materials == 1)
        snprintf(s->material, sizeof s->material, "%s", wanted->material[0]);
    if (wanted->description) {
        const relume_status status = relume_objects_open(&s->objects, wanted->description, &params);
        if (!status)
            say_matte(s->objects, s->log);
        return status || !wanted->reflections
                   ? status
                   : relume_objects_load_reflections(
                         s->objects, wanted->reflections,
                         relume_reflection_params(.log = s->log, .threads = s->threads));
    }
    if (wanted->materials)
        return relume_objects_of_mesh(&s->objects, wanted->mesh, wanted->material,
                                      wanted->materials, wanted->repeat, &params);
    return RELUME_OK;
}

bool session_is_material(const char *path)
{
    return relume_kind_of(path) == RELUME_KIND_MATERIAL;
}

bool session_is_description(const char *path)
{
    const char *dot = strrchr(path, '.');
    const enum relume_kind kind = relume_kind_of(path);
    return kind == RELUME_KIND_MODEL || kind == RELUME_KIND_BAKED ||
           (dot && !strcmp(dot, ".json") && kind != RELUME_KIND_CAPTURE &&
            kind != RELUME_KIND_FOREIGN);
}

bool session_is_objects(const char *path)
{
    return session_is_description(path) || session_is_material(path);
}

relume_status session_open_objects(struct session *s, const char *path,
                                   const struct app_state *start)
{
    const struct relume_objects_params params = {.log = s->log, .threads = s->threads};
    relume_objects *objects;
    relume_status status;
    if (session_is_material(path))
        status =
            relume_objects_of_mesh(&objects, s->wanted.mesh, &path, 1, s->wanted.repeat, &params);
    else
        status = relume_objects_open(&objects, path, &params);
    if (status)
        return status;
    say_matte(objects, s->log);
    relume_objects *was = s->objects;
    char material[APP_SPEC];
    memcpy(material, s->material, sizeof material);
    s->objects = objects;
    snprintf(s->material, sizeof s->material, "%s", session_is_material(path) ? path : "");
    status = session_open_stage(s, start);
    if (status) {
        s->objects = was, was = objects;
        memcpy(s->material, material, sizeof material);
    } else {
        snprintf(s->described, sizeof s->described, "%s", session_is_material(path) ? "" : path);
        s->reflections[0] = '\0';
    }
    relume_objects_destroy(&was);
    return status;
}

enum { SIDE = 640 };  // of the picture, where no size is asked for

// One camera far away before +z looks at all of the objects; the eye starts beside it.
static relume_status make_stage(relume_slab_set **out, struct relume_geometry *g,
                                struct relume_vec3 *eye, const struct relume_objects_info *info)
{
    const double uv[1][2] = {{0.0, 0.0}};
    const struct relume_vec3 extent = vec3_sub(info->max, info->min);
    const double radius = 0.5 * vec3_length(extent);
    const struct relume_vec3 middle = vec3_sub(info->max, vec3_scale(extent, 0.5));
    *g = (struct relume_geometry){
        .projection = RELUME_SLAB,
        .uv_z = 4.0 * radius,
        .st_min = {-radius, -radius},
        .st_max = {radius, radius},
        .pose = {.origin = middle, .axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    };
    *eye = (struct relume_vec3){middle.x + 1.2 * radius, middle.y + 1.2 * radius,
                                middle.z + 3.6 * radius};
    return relume_slab_set_create(out, g, 1, uv, NULL, 1);
}

// What the panel says of them.
static void describe(struct session *s, const struct relume_objects_info *info)
{
    snprintf(s->name, sizeof s->name, "objects");
    snprintf(s->line[0], SESSION_TEXT, "%zu triangle%s, %d part%s, %d material%s",
             info->triangle_count, relume_plural((int64_t)info->triangle_count), info->parts,
             relume_plural(info->parts), info->materials, relume_plural(info->materials));
    s->lines[0] = s->line[0];
    s->lines[1] = NULL;
}

// All of the objects from an eye that was asked for, as relume_objects_window sees them.
static void fit_view(struct relume_camera *camera, const struct session *s)
{
    const int width = camera->width ? camera->width : SIDE;
    const int height = camera->width ? camera->height : SIDE;
    struct relume_window w;
    if (camera->look_at.field_of_view_deg != 0.0 ||
        !relume_objects_window(&w, s->objects, camera->eye, &camera->look_at, width, height))
        return;
    const double half = 0.5 * vec3_length(w.right) / relume_window_distance(&w);
    camera->look_at.field_of_view_deg = 2.0 * atan(half) * (180.0 / 3.14159265358979323846);
}

relume_status session_open_stage(struct session *s, const struct app_state *start)
{
    const struct relume_objects_info *info = relume_objects_info(s->objects);
    struct app_file file = {.width = SIDE, .height = SIDE, .views = 1, .objects = s->objects};
    struct app_state from = *start;
    struct relume_vec3 eye;
    relume_slab_set *stage;
    struct app app;
    relume_status status = make_stage(&stage, &file.geometry, &eye, info);
    if (status)
        return status;
    file.around = stage;
    if (from.camera.framing == RELUME_FRAME_DEFAULT) {
        from.camera.framing = RELUME_FRAME_EYE;
        from.camera.eye = eye;
    } else if (from.camera.framing == RELUME_FRAME_EYE) {
        fit_view(&from.camera, s);
    }
    status = app_start(&app, &file, &from, true, s->log);
    if (status) {
        app_release(&app);
        relume_slab_set_destroy(&stage);
        return status;
    }
    session_close_file(s);
    app_release(&s->app);
    s->stage = stage;
    s->app = app;
    s->app.near_lights = true;
    describe(s, info);
    session_list_edits(s);
    return RELUME_OK;
}

relume_status session_make_stage(struct session *s)
{
    static const double uv[1][2] = {{0.0, 0.0}};
    const struct code_source nothing = {.user = NULL};
    relume_status status =
        gl_renderer_create(&s->renderer, &s->gl, &nothing, &s->app.file.geometry, NULL, 1, s->log);
    if (status)
        return status;
    gl_renderer_use_slabs(&s->renderer, s->stage, uv, NULL);
    return gl_renderer_use_objects(&s->renderer, s->objects, NULL);
}

relume_status session_add_objects(struct session *s)
{
    const struct depth_source places = pack_source_places(s->source);
    session_add_ways(s);
    return gl_renderer_use_objects(&s->renderer, s->objects, &places);
}
