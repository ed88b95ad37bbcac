// apply.c - all edits of a list, to a g-BRDF and to maps
#include "material/gbrdf/apply.h"

#include "core/base/log.h"
#include "core/math/fnv.h"
#include "material/gbrdf/edits.h"
#include "material/gbrdf/operations.h"

relume_status edit_gbrdf(struct gbrdf_maps *maps, const relume_edits *edits,
                         const struct relume_log *log)
{
    struct edited_gbrdf g = {.maps = *maps};
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < relume_edits_count(edits) - relume_edits_undone(edits); i++) {
        const struct relume_edit *e = relume_edits_get(edits, i);
        struct log_place own;
        g.log = edit_log(&own, edits, i, log);
        status = e->operation->gbrdf(&g, e);
    }
    for (int k = 0; !status && k < g.maps.materials; k++)
        if (g.touched[k])
            gbrdf_limit_material(&g.maps, k);
    *maps = g.maps;
    return status;
}

uint64_t relume_maps_fingerprint(const struct relume_maps *maps)
{
    const struct relume_image *const images[] = {
        &maps->normal,   &maps->base_color, &maps->roughness, &maps->metallic,
        &maps->specular, &maps->height_map, &maps->occlusion};
    const size_t pixels = (size_t)maps->width * (size_t)maps->height;
    const int32_t size[2] = {maps->width, maps->height};
    uint64_t hash = fnv_of(FNV_START, size, sizeof size);
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        hash = fnv_of(hash, images[i]->data, pixels * (size_t)images[i]->channels * sizeof(float));
    return hash;
}

relume_status relume_maps_edit(struct relume_maps *maps, const relume_edits *edits, int threads,
                               const struct relume_log *log)
{
    relume_status status = edits_check(edits, relume_maps_fingerprint(maps), NULL, log);
    for (int i = 0; !status && i < edits->count - edits->undone; i++) {
        const struct relume_edit *e = &edits->edit[i];
        struct log_place own;
        const struct relume_log *to = edit_log(&own, edits, i, log);
        status = e->operation->maps
                     ? e->operation->maps(maps, e, threads, to)
                     : log_fail(to, RELUME_EUNFIT, "maps have nothing that it changes");
    }
    return status;
}
