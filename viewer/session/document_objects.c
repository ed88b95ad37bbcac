// document_objects.c - objects alone, on a stage that the eye goes around
#include "session/edits_text.h"
#include "session/session.h"

#include "cli/program/say.h"
#include "common/vec.h"
#include "relight/view/slab_set.h"

#include <stdio.h>
#include <string.h>

// Those of the command line are shown where no file is named.
static bool is_objects(const char *path, const struct object_set *objects)
{
    return path ? object_file_is_description(path) || object_file_is_material(path)
                : objects->objects != NULL;
}

// ---------------------------------------------------------------- the stage

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

// All of the objects from an eye that was asked for, as relume_objects_window sees them.
static void fit_view(struct relume_camera *camera, relume_objects *objects)
{
    const int width = camera->width ? camera->width : SIDE;
    const int height = camera->width ? camera->height : SIDE;
    struct relume_window w;
    if (camera->look_at.field_of_view_deg != 0.0 ||
        !relume_objects_window(&w, objects, camera->eye, &camera->look_at, width, height))
        return;
    const double half = 0.5 * vec3_length(w.right) / relume_window_distance(&w);
    camera->look_at.field_of_view_deg = 2.0 * atan(half) * (180.0 / 3.14159265358979323846);
}

static relume_status open_stage(struct opening *out, struct session *s,
                                const struct app_state *start)
{
    relume_objects *objects = out->objects.objects;
    struct app_file file = {.width = SIDE, .height = SIDE, .views = 1, .objects = objects};
    struct app_state from = *start;
    struct relume_vec3 eye;
    relume_status status =
        make_stage(&out->document.slabs, &file.geometry, &eye, relume_objects_info(objects));
    if (status)
        return status;
    file.around = out->document.slabs;
    if (from.camera.framing == RELUME_FRAME_DEFAULT) {
        from.camera.framing = RELUME_FRAME_EYE;
        from.camera.eye = eye;
    } else if (from.camera.framing == RELUME_FRAME_EYE) {
        fit_view(&from.camera, objects);
    }
    status = app_start(&out->app, &file, &from, true, s->log);
    out->app.near_lights = true;
    return status;
}

static relume_status open_objects(struct opening *out, struct session *s, const char *path,
                                  const struct app_state *start, bool look_ahead)
{
    (void)look_ahead;
    snprintf(out->document.name, sizeof out->document.name, "objects");
    const relume_status status =
        path ? object_set_replace(&out->objects, path, s->settings.threads, s->log) : RELUME_OK;
    return status ? status : open_stage(out, s, start);
}

static relume_status make_objects(struct session *s)
{
    const relume_status status = session_make_stage(s);
    return status ? status : gl_renderer_use_objects(&s->renderer, s->objects.objects, NULL);
}

// ---------------------------------------------------------------- edits of a g-BRDF

static bool can_edit_objects(const struct session *s)
{
    return s->objects.material[0] &&
           !strcmp(relume_objects_info(s->objects.objects)->material[0].model, "gbrdf");
}

// Changes the list as the words say, NULL: not at all. It is kept once the g-BRDF takes it.
static relume_status change_list(struct session *s, const char *words, const struct relume_log *log)
{
    char copy[APP_SPEC];
    relume_btf_fitted *model, *edited = NULL;
    relume_edits *edits = NULL;
    snprintf(copy, sizeof copy, "%s", words ? words : "");
    relume_status status = relume_btf_fitted_open(&model, s->objects.material,
                                                  relume_btf_params(.log = log, .unedited = true));
    if (!status)
        status = relume_edits_open(&edits, s->objects.material,
                                   relume_btf_fitted_fingerprint(model), log);
    if (!status && words)
        status = edits_change(edits, copy, log);
    if (!status)
        status = relume_btf_fitted_edit(&edited, model, edits, log);
    if (!status && words)
        status = relume_edits_save(edits, s->objects.material, log);
    if (!status) {
        document_describe_edits(&s->document, edits);
        s->document.edited_materials = relume_btf_fitted_info(edited)->clusters;
    }
    relume_btf_fitted_destroy(&edited);
    relume_edits_destroy(&edits);
    relume_btf_fitted_destroy(&model);
    return status;
}

// The same stage and eye, with the material as it is now.
static relume_status show_again(struct session *s, const struct relume_log *log)
{
    const char *path = s->objects.material;
    relume_objects *objects;
    relume_status status =
        relume_objects_of_mesh(&objects, s->objects.wanted.mesh, &path, 1, s->objects.wanted.repeat,
                               relume_objects_params(.log = log, .threads = s->settings.threads));
    if (status)
        return status;
    status = gl_renderer_replace_objects(&s->renderer, objects);
    relume_objects_destroy(&s->objects.objects);
    s->objects.objects = s->app.file.objects = objects;
    return status;
}

static relume_status edit_objects(struct session *s, const char *words,
                                  const struct relume_log *log)
{
    const relume_status status = change_list(s, words, log);
    return status ? status : show_again(s, log);
}

static void describe_objects(struct session *s)
{
    const struct relume_objects_info *info = relume_objects_info(s->objects.objects);
    document_add_line(&s->document, "%zu triangle%s, %d part%s, %d material%s",
                      info->triangle_count, relume_plural((int64_t)info->triangle_count),
                      info->parts, relume_plural(info->parts), info->materials,
                      relume_plural(info->materials));
    if (can_edit_objects(s))
        (void)!change_list(s, NULL, NULL);
}

const struct document_kind document_objects = {
    .is = is_objects,
    .open = open_objects,
    .make = make_objects,
    .describe = describe_objects,
    .can_edit = can_edit_objects,
    .edit = edit_objects,
};
