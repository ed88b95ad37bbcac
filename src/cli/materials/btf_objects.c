// btf_objects.c - relume btf render --mesh, or of a description of objects
#include "cli/materials/btf_inputs.h"
#include "cli/frame_options.h"

#include <math.h>
#include <relume/core/vec.h>
#include <relume/exchange.h>
#include <relume/world/bake.h>
#include <stdio.h>
#include <string.h>

bool btf_is_objects(const struct btf_options *o)
{
    const char *name = o->args.input[0], *dot = strrchr(name, '.');
    const bool json = dot && !strcmp(dot, ".json");  // of another kind: its reader says so
    const enum relume_kind kind = relume_kind_of(name);
    return o->mesh || json || kind == RELUME_KIND_MODEL || kind == RELUME_KIND_BAKED;
}

relume_status objects_open(relume_objects **out, const char *path, const char *reflections,
                           const struct args *args)
{
    const relume_status status = relume_objects_open(
        out, path, relume_objects_params(.log = args->log, .threads = args->threads));
    return status || !reflections
               ? status
               : relume_objects_load_reflections(
                     *out, reflections,
                     relume_reflection_params(.log = args->log, .threads = args->threads));
}

relume_status objects_tell_reflection(const relume_objects *objects, struct relume_vec3 eye,
                                      struct relume_vec3 direction)
{
    struct relume_object_reflection r;
    if (!relume_objects_reflect(&r, objects, eye, direction))
        return usage_error("--reflection-at: expected a pixel that shows an object");
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_vector(&w, "position", r.place.position, 6);
    jput_vector(&w, "eye", eye, 9);
    jput_vector(&w, "direction", r.edited, 6);
    return jend(&w);
}

static relume_status open_them(relume_objects **out, const struct btf_options *o)
{
    const char *input = o->args.input[0], *mesh = o->mesh;
    *out = NULL;
    if (!mesh)
        return objects_open(out, input, o->reflections, &o->args);
    return relume_objects_of_mesh(
        out, mesh, &input, 1, o->repeat,
        relume_objects_params(.log = o->args.log, .threads = o->args.threads));
}

static relume_status find_window(struct relume_window *out, const int size[2],
                                 const relume_objects *objects, const struct btf_options *o)
{
    const struct relume_objects_info *i = relume_objects_info(objects);
    const double extent = sqrt(pow(i->max.x - i->min.x, 2) + pow(i->max.y - i->min.y, 2) +
                               pow(i->max.z - i->min.z, 2));
    const struct relume_vec3 before = {0.5 * (i->min.x + i->max.x),
                                       0.5 * (i->min.y + i->max.y) + 0.6 * extent,
                                       0.5 * (i->min.z + i->max.z) + 1.8 * extent};
    const struct relume_look_at look_at = {given(o, &o->look_at), o->look_at, o->up, o->fov};
    if (relume_objects_window(out, objects, given(o, &o->eye) ? o->eye : before, &look_at, size[0],
                              size[1]))
        return RELUME_OK;
    return usage_error("--eye: expected a point away from --look-at, and not straight above or "
                       "below it along --up");
}

static relume_status render(struct relume_image *image, const relume_objects *objects,
                            const struct relume_window *window, const struct btf_options *o)
{
    relume_rig *rig = NULL;
    const struct relume_light *lights;
    int count;
    relume_status status = parse_lights(&o->args, &o->lighting, &rig, &lights, &count);
    if (!status)
        status = relume_objects_render(
            image, objects, window, lights, count,
            relume_render_params(.log = o->args.log, .samples = o->samples,
                                 .no_shadows = o->no_shadows, .threads = o->args.threads));
    if (!status)
        status = save_lights(&o->args, &o->lighting, rig);
    relume_rig_destroy(&rig);
    return status;
}

relume_status btf_render_objects(const struct btf_options *o)
{
    relume_objects *objects = NULL;
    struct relume_window window = {.eye = {0, 0, 0}};
    struct relume_image image = {0};
    const int size[2] = {o->picture[0] ? o->picture[0] : 512, o->picture[1] ? o->picture[1] : 512};
    relume_status status = open_them(&objects, o);
    if (!status)
        status = find_window(&window, size, objects, o);
    if (!status && given(o, o->reflection_at)) {
        const double *at = o->reflection_at;
        const struct relume_vec3 on = relume_vec3_along(
            relume_vec3_along(window.corner, window.right, (at[0] + 0.5) / size[0]), window.down,
            (at[1] + 0.5) / size[1]);
        status = objects_tell_reflection(objects, window.eye, relume_vec3_sub(on, window.eye));
    }
    if (!status)
        status = relume_image_create(&image, size[0], size[1], 3);
    if (!status)
        status = render(&image, objects, &window, o);
    if (!status)
        status = relume_image_save(&image, o->output,
                                   relume_image_params(.log = o->args.log, .profile = o->icc));
    relume_image_destroy(&image);
    relume_objects_destroy(&objects);
    return status;
}
