// btf_render.c - relume btf render
#include "btf_inputs.h"

#include <math.h>

struct swatch {
    const relume_btf *btf;  // one of the two
    const relume_btf_fitted *fitted;
    struct relume_vec3 eye;
};

static void add_light(struct relume_image *image, const struct swatch *s,
                      const struct relume_light *light)
{
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            float rgb[3];
            if (s->btf)
                relume_btf_evaluate(s->btf, x, y, s->eye, light->direction, rgb);
            else
                relume_btf_fitted_evaluate(s->fitted, x, y, s->eye, light->direction, rgb);
            float *to = image->data + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
            for (int c = 0; c < 3; c++)
                to[c] += rgb[c] * light->rgb[c];
        }
}

static struct relume_vec3 unit(struct relume_vec3 v)
{
    const double length = sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return (struct relume_vec3){v.x / length, v.y / length, v.z / length};
}

static relume_status light_swatch(struct relume_image *image, const struct swatch *s,
                                  const struct args *args)
{
    const int count = args_count(args, "--light");
    const struct relume_light *lights;
    relume_rig *rig = NULL;
    int n = 0;
    relume_status status = relume_rig_create(&rig);
    for (int i = 0; i < (count ? count : 1) && !status; i++)
        status = relume_rig_add(rig, count ? args_nth(args, "--light", i) : "dir 0 0 1", NULL,
                                args_log(args));
    if (!status)
        status = relume_rig_lights(&lights, &n, rig);
    for (int i = 0; i < n && !status; i++) {
        struct relume_light light = lights[i];
        if (light.kind != RELUME_LIGHT_DIRECTIONAL)
            status = usage_error("btf render: expected lights \"dir x y z\"; found '%s'",
                                 relume_light_kind_name(light.kind));
        light.direction = unit(light.direction);
        if (!status)
            add_light(image, s, &light);
    }
    relume_rig_destroy(&rig);
    return status;
}

relume_status btf_render(const struct args *args)
{
    struct swatch s = {.eye = {0.0, 0.0, 1.0}};
    struct relume_image image = {0};
    relume_btf *btf = NULL;
    relume_btf_fitted *fitted = NULL;
    const char *eye = args_text(args, "--eye", NULL);
    int width = 0, height = 0;
    if (btf_is_objects(args))
        return btf_render_objects(args);
    if (!args_has(args, "-o"))
        return usage_error("btf render: expected -o FILE");
    relume_status status = eye ? args_vec3(&s.eye, "--eye", eye) : RELUME_OK;
    if (!status && !(s.eye.z > 0.0))
        status = usage_error("--eye: expected a direction with z > 0; found '%s'", eye);
    if (!status && btf_is_model(args_input(args, 1))) {
        status = relume_btf_fitted_open(&fitted, args_input(args, 1),
                                        relume_btf_params(.log = args_log(args)));
        if (!status) {
            const struct relume_btf_fitted_info i = relume_btf_fitted_info(fitted);
            width = i.width, height = i.height;
        }
    } else if (!status) {
        status = btf_open(&btf, args_input(args, 1), args);
        if (!status)
            width = relume_btf_info(btf)->width, height = relume_btf_info(btf)->height;
    }
    s.btf = btf, s.fitted = fitted, s.eye = unit(s.eye);
    if (!status)
        status = relume_image_create(&image, width, height, 3);
    if (!status)
        status = light_swatch(&image, &s, args);
    if (!status)
        status = relume_image_save(&image, args_text(args, "-o", NULL),
                                   relume_image_params(.log = args_log(args)));
    relume_image_destroy(&image);
    relume_btf_fitted_destroy(&fitted);
    relume_btf_destroy(&btf);
    return status;
}
