// relit.c - maps under a light
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "material/maps/maps.h"

struct relighting {
    const struct relume_maps *maps;
    const struct maps_light *light;
    struct near_view flat;  // where pixels lie, without depth
    struct relume_image *out;
};

static void find_light(struct look *k, const struct relighting *r, int x, int y)
{
    const struct near_view *near = r->light->near ? r->light->near : &r->flat;
    const vec3 point = near_view_pixel(near, x, y);
    double gain;
    const vec3 l = r->light->near ? near_view_direction(&gain, near, r->light->light, point)
                                  : r->light->direction;
    photos_look_from(k, near, point);
    k->towards[0][0] = (float)l.x, k->towards[1][0] = (float)l.y, k->towards[2][0] = (float)l.z;
    look_halve(k);
}

static void do_row(void *context, size_t item, int worker)
{
    (void)worker;
    const struct relighting *r = context;
    const struct relume_maps *m = r->maps;
    const int width = m->width;
    float memory[LOOK_ARRAYS * LOOK_LANES];
    struct look k;
    look_place(&k, memory, 1);
    for (int x = 0; x < width; x++) {
        const size_t at = item * (size_t)width + (size_t)x;
        const float *specular = m->specular.data + 3 * at, *colour = m->base_color.data + 3 * at;
        find_light(&k, r, x, (int)item);
        look_turn(&k, m->normal.data + 3 * at, m->roughness.data[at]);
        for (int c = 0; c < 3; c++) {
            const struct gloss g = {m->metallic.data[at] > 0.5f, specular[c],
                                    m->roughness.data[at]};
            look_gloss(&k, &g);
            r->out->data[3 * at + (size_t)c] =
                (k.base[0] + colour[c] * k.slope[0]) / (float)m->gain;
        }
    }
}

relume_status maps_relight(struct relume_image *out, const struct relume_maps *maps,
                           const struct maps_light *light, int threads)
{
    struct relighting r = {
        .maps = maps,
        .light = light,
        .flat = {.width = maps->width,
                 .height = maps->height,
                 .geometry = maps->geometry,
                 .uv = {maps->uv[0], maps->uv[1]},
                 .assumed = -1.0},
        .out = out,
    };
    const relume_status status = relume_image_create(out, maps->width, maps->height, 3);
    if (!status)
        thread_for(threads, (size_t)maps->height, do_row, &r);
    return status;
}

relume_status relume_maps_relight(struct relume_image *out, const struct relume_maps *maps,
                                  struct relume_vec3 direction, int threads)
{
    *out = (struct relume_image){0};
    if (!(vec3_length(direction) > 0.0) || !isfinite(vec3_length(direction)))
        return RELUME_EINVAL;
    return maps_relight(out, maps, &(struct maps_light){.direction = vec3_unit(direction)},
                        threads);
}
