// btf_render.c - relume btf render
#include "commands/btf_inputs.h"
#include "output_name.h"

#include <math.h>

static relume_status parse_pair(int out[2], const char *option, const char *text, int most)
{
    char rest;
    if (sscanf(text, "%6dx%6d%c", &out[0], &out[1], &rest) == 2 && out[0] >= 1 && out[1] >= 1 &&
        out[0] <= most && out[1] <= most)
        return RELUME_OK;
    return usage_error("%s: expected WxH, 1 to %d; found '%s'", option, most, text);
}

relume_status btf_pair(int out[2], const char *option, const char *text, int most)
{
    return text ? parse_pair(out, option, text, most) : RELUME_OK;
}

// Rectified from --eye, or a perspective view from --camera.
static relume_status parse_camera(struct relume_btf_camera *camera, const struct btf_options *o)
{
    const char *eye = o->eye, *place = o->camera;
    const char *at = o->look_at;
    *camera = (struct relume_btf_camera){.eye = {0.0, 0.0, 1.0},
                                         .perspective = place != NULL,
                                         .fov_deg = o->fov > 0.0 ? o->fov : 40.0};
    if (eye && place)
        return usage_error("btf render: expected --eye or --camera; found both");
    if (at && !place)
        return usage_error("--look-at: works only with --camera; add --camera x,y,z");
    relume_status status = RELUME_OK;
    if (eye || place)
        status = args_vec3(&camera->eye, eye ? "--eye" : "--camera", eye ? eye : place);
    if (!status && at)
        status = args_vec3(&camera->at, "--look-at", at);
    if (!status && !(camera->eye.z > 0.0))
        status = usage_error("%s: expected z > 0; found '%s'", eye ? "--eye" : "--camera",
                             eye ? eye : place);
    return status;
}

static relume_status draw(const relume_btf_surface *surface, const struct btf_options *o)
{
    const struct relume_btf_surface_info info = relume_btf_surface_info(surface);
    const struct relume_light *lights;
    struct relume_btf_camera camera;
    struct relume_image image = {0};
    relume_rig *rig = NULL;
    int n = 0;
    relume_status status = parse_camera(&camera, o);
    int size[2] = {camera.perspective ? 640 : info.width, camera.perspective ? 400 : info.height};
    if (!status)
        status = btf_pair(size, "--picture", o->picture, 65536);
    if (!status)
        status = relume_rig_create(&rig);
    const int count = o->lighting.light.count;
    for (int i = 0; i < (count ? count : 1) && !status; i++)
        status =
            relume_rig_add(rig, count ? o->lighting.light.text[i] : "dir 0 0 1", NULL, o->args.log);
    if (!status)
        status = relume_rig_lights(&lights, &n, rig);
    if (!status)
        status = relume_image_create(&image, size[0], size[1], 3);
    if (!status)
        status =
            relume_btf_draw(&image, surface, &camera, lights, n,
                            relume_btf_draw_params(.log = o->args.log, .threads = o->args.threads));
    if (!status)
        status = relume_image_save(&image, o->output, relume_image_params(.log = o->args.log));
    relume_image_destroy(&image);
    relume_rig_destroy(&rig);
    return status;
}

relume_status btf_render(const struct args *args)
{
    const struct btf_options *o = (const void *)args;
    struct btf_sample sample;
    relume_btf_surface *surface = NULL;
    if (btf_is_objects(o))
        return btf_render_objects(o);
    if (!o->output)
        return usage_error("btf render: expected -o FILE");
    relume_status status = picture_name("-o", o->output);
    if (status)
        return status;
    if (btf_is_surface(o->args.input[0])) {
        status = relume_btf_surface_open(&surface, o->args.input[0],
                                         relume_btf_params(.log = o->args.log));
        if (!status)
            status = draw(surface, o);
        relume_btf_surface_destroy(&surface);
        return status;
    }
    status = btf_open_sample(&sample, o->args.input[0], o);
    if (!status)
        status = relume_btf_surface_create(&surface, sample.model, NULL, o->args.log);
    if (!status)
        status = draw(surface, o);
    relume_btf_surface_destroy(&surface);
    btf_close_sample(&sample);
    return status;
}
