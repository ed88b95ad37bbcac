// lighting.c - all lights as they fall on objects: light samples, and environments on each material
#include "core/base/memory.h"
#include "material/model/environment.h"
#include "relight/light/environment.h"
#include "world/object/drawn_objects.h"
#include "world/object/object.h"

// Mirrors show environments as they are.
static bool needs_sky(const relume_objects *o, int material)
{
    if (o->material[material].mirror || o->material[material].translucent ||
        o->material[material].baked)
        return false;
    for (int i = 0; i < o->info.parts; i++)
        if (o->part[i].material == material)
            return true;
    return false;
}

static const relume_btf_fitted *model_of(const relume_objects *o, int material)
{
    return relume_btf_surface_info(o->material[material].surface)->model;
}

static double rim_of(const relume_objects *o, int material)
{
    return relume_btf_fitted_info(model_of(o, material))->rim;
}

// The maps of an earlier material whose lowest lights are the same, or new ones.
static relume_status find_prefiltered(relume_prefiltered_maps **out, struct sky_light *sky,
                                      const relume_objects *o, int material,
                                      const struct relume_light *light, int threads)
{
    const double rim = rim_of(o, material);
    for (int i = 0; i < material; i++)
        if (sky->prefiltered[i] && rim_of(o, i) == rim) {
            *out = sky->prefiltered[i];
            return RELUME_OK;
        }
    const relume_status status = relume_prefiltered_maps_create(
        &sky->prefiltered[material], light,
        relume_prefiltered_maps_params(.rim = rim, .threads = threads));
    *out = sky->prefiltered[material];
    return status;
}

static relume_status make_sky(struct sky_light *sky, const relume_objects *o,
                              const struct relume_light *light, int threads)
{
    const size_t materials = (size_t)o->info.materials;
    sky->prefiltered = mem_zeroed(materials, sizeof *sky->prefiltered);
    sky->sky = mem_zeroed(materials, sizeof *sky->sky);
    sky->fine = mem_array(SKY_FINE, sizeof *sky->fine);
    relume_status status = sky->prefiltered && sky->sky && sky->fine ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = relume_environment_sample(sky->fine, SKY_FINE, light, 0);
    for (int i = 0; i < o->info.materials && !status; i++) {
        relume_prefiltered_maps *prefiltered;
        if (!needs_sky(o, i))
            continue;
        status = find_prefiltered(&prefiltered, sky, o, i, light, threads);
        if (!status)
            status = relume_btf_environment_create(&sky->sky[i], model_of(o, i), prefiltered);
    }
    return status;
}

relume_status lighting_create(struct lighting *out, const relume_objects *o,
                              const struct relume_light *lights, int n,
                              const struct relume_render_params *params)
{
    *out = (struct lighting){.sends = 1.0f,
                             .surround = {.light = lights, .lights = n},
                             .materials = o->info.materials,
                             .no_shadows = params && params->no_shadows};
    relume_status status =
        relume_objects_lights(&out->light_sample, &out->light_samples, o, lights, n);
    if (!status) {
        out->sky = mem_zeroed((size_t)n, sizeof *out->sky);
        status = out->sky ? RELUME_OK : RELUME_ENOMEM;
    }
    for (int i = 0; i < n && !status; i++) {
        if (lights[i].kind != RELUME_LIGHT_ENVIRONMENT)
            continue;
        struct sky_light *sky = &out->sky[out->skies++];
        // Samples of a light follow one another, and lights in their order.
        while (sky->first < out->light_samples && out->light_sample[sky->first].number < i)
            sky->first++;
        while (sky->first + sky->light_samples < out->light_samples &&
               out->light_sample[sky->first + sky->light_samples].number == i)
            sky->light_samples++;
        status = make_sky(sky, o, &lights[i], params ? params->threads : 0);
    }
    return status ? status : lighting_bakes(out, o, params ? params->threads : 0);
}

void lighting_destroy(struct lighting *l)
{
    lighting_bakes_free(l);
    glows_free(&l->glow, l->bodies);
    glows_free(&l->gathered, l->bodies);
    for (int i = 0; i < l->skies; i++) {
        for (int k = 0; k < l->materials && l->sky[i].prefiltered && l->sky[i].sky; k++) {
            relume_btf_environment_destroy(&l->sky[i].sky[k]);
            relume_prefiltered_maps_destroy(&l->sky[i].prefiltered[k]);
        }
        mem_free(l->sky[i].prefiltered);
        mem_free(l->sky[i].sky);
        mem_free(l->sky[i].fine);
    }
    relume_image_destroy(&l->surround.panorama);
    relume_image_destroy(&l->surround.places);
    mem_free(l->sky);
    mem_free(l->light_sample);
    *l = (struct lighting){.light_sample = NULL};
}
