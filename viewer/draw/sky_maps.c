// sky_maps.c - prefiltered environments as textures, kept by environment: turning or dimming one
// changes none
#include "draw/sky_maps.h"

#include "gl/target.h"
#include "material/model/environment.h"
#include "relight/light/environment.h"
#include "relit/light_uniforms.h"

#include <stdlib.h>
#include <string.h>

// One below the other: the diffuse map, then those of the exponents.
static relume_status upload(struct sky_map *map, const struct gl *gl, const struct relume_log *log)
{
    const struct relume_prefiltered_maps_info *i = relume_prefiltered_maps_info(map->prefiltered);
    const size_t plane = 3 * (size_t)i->width * (size_t)i->height;
    float *texels = malloc((RELUME_PREFILTERED_EXPONENTS + 1) * plane * sizeof *texels);
    if (!texels)
        return RELUME_ENOMEM;
    memcpy(texels, i->diffuse, plane * sizeof *texels);
    memcpy(texels + plane, i->specular, RELUME_PREFILTERED_EXPONENTS * plane * sizeof *texels);
    gl->GenTextures(1, &map->texture);
    light_uniforms_upload(gl, 0, map->texture, GL_RGB32F, GL_RGB, i->width,
                          (RELUME_PREFILTERED_EXPONENTS + 1) * i->height, texels);
    free(texels);
    return gl_check(gl, "uploading an environment", log);
}

static void destroy(struct sky_map *map, const struct gl *gl)
{
    gl->DeleteTextures(1, &map->texture);
    relume_prefiltered_maps_destroy(&map->prefiltered);
    free(map);
}

relume_status sky_maps_find(const struct sky_map **out, struct sky_maps *maps,
                            const struct relume_light *light, double rim)
{
    const uint64_t of = relume_environment_fingerprint(light->environment);
    for (*out = maps->map; *out; *out = (*out)->next)
        if ((*out)->of == of && (*out)->rim == rim)
            return RELUME_OK;
    struct sky_map *map = calloc(1, sizeof *map);
    if (!map)
        return RELUME_ENOMEM;
    const struct relume_light plain = {.kind = RELUME_LIGHT_ENVIRONMENT,
                                       .environment = light->environment,
                                       .rgb = {1.0f, 1.0f, 1.0f}};
    map->of = of;
    map->rim = rim;
    relume_status status = relume_prefiltered_maps_create(
        &map->prefiltered, &plain, relume_prefiltered_maps_params(.log = maps->log, .rim = rim));
    if (!status)
        status = upload(map, maps->gl, maps->log);
    if (status) {
        destroy(map, maps->gl);
        return status;
    }
    map->next = maps->map;
    *out = maps->map = map;
    return RELUME_OK;
}

void sky_maps_forget(struct sky_maps *maps)
{
    while (maps->map) {
        struct sky_map *map = maps->map;
        maps->map = map->next;
        destroy(map, maps->gl);
    }
}
