// btf_render.c - relume btf render
#include "cli/materials/btf_inputs.h"

#include <string.h>

// Rectified from --eye, or a perspective view from --camera.
static relume_status parse_camera(struct relume_btf_camera *camera, const struct btf_options *o)
{
    const bool eye = given(o, &o->eye), place = given(o, &o->camera);
    const struct relume_vec3 in_front = {0.0, 0.0, 1.0};
    *camera = (struct relume_btf_camera){.eye = place ? o->camera
                                                : eye ? o->eye
                                                      : in_front,
                                         .at = o->look_at,
                                         .perspective = place,
                                         .fov_deg = o->fov > 0.0 ? o->fov : 40.0};
    if (eye && place)
        return usage_error("btf render: expected --eye or --camera; found both");
    if (given(o, &o->look_at) && !place)
        return usage_error("--look-at: works only with --camera; add --camera x,y,z");
    if (!(camera->eye.z > 0.0))
        return usage_error("%s: expected z > 0; found %g", place ? "--camera" : "--eye",
                           camera->eye.z);
    return RELUME_OK;
}

static relume_status draw(const relume_btf_surface *surface, const struct btf_options *o)
{
    const struct relume_btf_surface_info *info = relume_btf_surface_info(surface);
    const struct relume_light *lights;
    struct relume_btf_camera camera;
    struct relume_image image = {0};
    relume_rig *rig = NULL;
    int n = 0;
    relume_status status = parse_camera(&camera, o);
    int size[2] = {camera.perspective ? 640 : info->width, camera.perspective ? 400 : info->height};
    if (o->picture[0])
        memcpy(size, o->picture, sizeof size);
    if (!status)
        status = parse_lights(&o->args, &o->lighting, &rig, &lights, &n);
    if (!status)
        status = relume_image_create(&image, size[0], size[1], 3);
    if (!status)
        status =
            relume_btf_draw(&image, surface, &camera, lights, n,
                            relume_btf_draw_params(.log = o->args.log, .threads = o->args.threads));
    if (!status)
        status = relume_image_save(&image, o->output,
                                   relume_image_params(.log = o->args.log, .profile = o->icc));
    if (!status)
        status = save_lights(&o->args, &o->lighting, rig);
    relume_image_destroy(&image);
    relume_rig_destroy(&rig);
    return status;
}

relume_status btf_render(const struct args *args)
{
    const struct btf_options *o = (const void *)args;
    const char *input = args->input[0];
    struct btf_sample sample = {.btf = NULL};
    relume_btf_surface *surface = NULL;
    relume_status status = picture_name(args->log, "-o", o->output);
    if ((o->reflections || given(o, o->reflection_at)) && (o->mesh || !btf_is_objects(o)))
        return usage_error("--reflections and --reflection-at: expected a description of objects "
                           "(.json); found '%s'",
                           input);
    if (!status && btf_is_objects(o))
        return btf_render_objects(o);
    if (!status && btf_is_surface(input)) {
        status = relume_btf_surface_open(&surface, input, relume_btf_params(.log = args->log));
    } else if (!status) {
        status = btf_open_sample(&sample, input, o);
        if (!status)
            status = relume_btf_surface_create(&surface, sample.model, NULL, args->log);
    }
    if (!status)
        status = draw(surface, o);
    relume_btf_surface_destroy(&surface);
    btf_close_sample(&sample);
    return status;
}
