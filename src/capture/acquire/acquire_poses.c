// acquire_poses.c - lights at which a camera stood that is tied to the lamp (Wong 1998, 10.2)
//
// A model of COLMAP holds the object's camera (a photograph of the list, all being from one place)
// and one photograph from the lamp for every light. The model's unit becomes that of the capture,
// whose window is 2 wide, by the median distance of the points that the object's camera sees: that
// is where z = 0.
#include "capture/acquire/acquire.h"

#include "capture/multiview/views_colmap.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/tree.h"
#include "core/math/sort.h"

#include <string.h>

bool acquire_has_poses(const char *path)
{
    return tree_is_folder(path);
}

static bool is_photograph(const struct acquisition *s, const char *name)
{
    for (int i = 0; i < s->photographs.count; i++)
        if (!strcmp(path_name(s->photographs.path[i]), path_name(name)))
            return true;
    return false;
}

static vec3 seen_from(const struct posed_camera *c, vec3 point)
{
    const vec3 d = vec3_sub(point, c->place);
    const double *r = c->rotation;
    return vec3_of(vec3_dot(vec3_of(r[0], r[1], r[2]), d), vec3_dot(vec3_of(r[3], r[4], r[5]), d),
                   vec3_dot(vec3_of(r[6], r[7], r[8]), d));
}

// Median over the points in its picture; 0: there are none.
static relume_status find_distance(double *out, const struct posed_model *model,
                                   const struct posed_camera *camera)
{
    double *z = mem_array(model->points + 1, sizeof *z), xy[2];
    size_t n = 0;
    *out = 0.0;
    if (!z)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < model->points; i++) {
        const vec3 p = seen_from(camera, model->point[i]);
        if (posed_project(xy, camera, p) && xy[0] >= 0.0 && xy[1] >= 0.0 && xy[0] < camera->width &&
            xy[1] < camera->height)
            z[n++] = p.z;
    }
    sort_doubles(z, n);
    *out = n ? z[n / 2] : 0.0;
    mem_free(z);
    return RELUME_OK;
}

// The object's camera, and light i's in lamp[i].
static relume_status tell_apart(const struct acquisition *s, const struct posed_model *model,
                                const struct posed_camera **object,
                                const struct posed_camera **lamp)
{
    int lamps = 0;
    *object = NULL;
    for (int i = 0; i < model->count; i++) {
        const struct posed_camera *c = &model->camera[i];
        if (!is_photograph(s, c->name))
            lamp[lamps++] = c;
        else if (!*object)
            *object = c;
    }
    if (!*object)
        return log_fail(
            s->p.log, RELUME_EUNFIT,
            "%s: has a pose for none of the photographs; expected '%s' or another of them",
            s->p.lights, path_name(s->photographs.path[0]));
    if (lamps == s->photographs.count)
        return RELUME_OK;
    return log_fail(s->p.log, RELUME_EUNFIT,
                    "%s: poses of %d photograph%s from the lamp; expected %d, one for each of the "
                    "object",
                    s->p.lights, lamps, relume_plural(lamps), s->photographs.count);
}

static void place_object(struct acquisition *s, const struct posed_camera *object,
                         const struct posed_camera *const *lamp, double distance)
{
    const double eye = 2.0 * object->focal[0] / object->width, scale = eye / distance;
    s->p.fov_deg = 2.0 * atan(1.0 / eye) * 180.0 / M_PI;
    for (int i = 0; i < s->shots; i++) {
        struct shot *shot = &s->shot[i];
        const vec3 p = seen_from(object, lamp[shot->number]->place);
        shot->position = vec3_of(scale * p.x, -scale * p.y, eye - scale * p.z);
        shot->direction = vec3_unit(shot->position);
    }
}

relume_status acquire_lights_from_poses(struct acquisition *s)
{
    struct posed_model model;
    const struct posed_camera *object, **lamp;
    double distance = 0.0;
    relume_status status = posed_model_read(&model, s->p.lights, s->p.log);
    if (status)
        return status;
    lamp = mem_array((size_t)model.count + 1, sizeof(struct posed_camera *));
    status = lamp ? tell_apart(s, &model, &object, lamp) : RELUME_ENOMEM;
    if (!status)
        status = find_distance(&distance, &model, object);
    if (!status && !(distance > 0.0))
        status = log_fail(s->p.log, RELUME_EUNFIT,
                          "%s: no points that '%s' sees; expected some on the object, to know its "
                          "distance",
                          s->p.lights, object->name);
    if (!status)
        place_object(s, object, lamp, distance);
    mem_free(lamp);
    posed_model_free(&model);
    return status;
}
