// part.c - a site shows a part of a file: as it is given, or the object, found by its relief
#include "site/publish/part.h"

#include "capture/acquire/object.h"
#include "capture/manifest/provenance.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "format/pack/views.h"
#include "site/publish/picture.h"

#include <relume/format/coder.h>
#include <relume/image/directions.h>
#include <string.h>

enum { LIGHTS = 24, SIDE = 192 };

// Some of the lights that the file was made of, or such that stand in for them.
static relume_status choose_lights(struct relume_vec3 *light, const relume_pack *pack)
{
    const struct relume_coder_info *info = relume_coder_info(relume_pack_info(pack)->coder);
    for (int i = 0; info->lights >= LIGHTS && i < LIGHTS; i++)
        light[i] = info->directions[(long long)i * info->lights / LIGHTS];
    return info->lights >= LIGHTS
               ? RELUME_OK
               : relume_directions_make(
                     light, LIGHTS, relume_pattern_find("spiral"),
                     relume_directions_params(.hemisphere = true, .pole_y = info->pole_y));
}

static relume_status find_object(struct relume_rect *out, relume_pack *pack,
                                 const struct site *site)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct relume_image small[LIGHTS] = {{.data = NULL}};
    const struct relume_image *at[LIGHTS];
    struct relume_vec3 light[LIGHTS];
    struct provenance from;
    bool relief = false;
    *out = (struct relume_rect){.width = 0};
    provenance_read(&from, info->provenance);
    relume_status status = choose_lights(light, pack);
    for (int i = 0; !status && i < LIGHTS; i++) {
        status = picture_lit(&small[i], pack, SIDE, false, light[i], site);
        at[i] = &small[i];
    }
    const struct object_search search = {.small = at,
                                         .count = LIGHTS,
                                         .step = (double)info->width / small[0].width,
                                         .width = info->width,
                                         .height = info->height,
                                         .ball = from.ball,
                                         .balls = from.balls};
    if (!status)
        status = object_find(out, &relief, &search);
    if (!status && !out->width)
        log_line(site->log, RELUME_NOTE, "--crop auto: %s; nothing is cropped",
                 relief ? "the object fills the picture" : "no relief is found");
    for (int i = 0; i < LIGHTS; i++)
        relume_image_destroy(&small[i]);
    return status;
}

static relume_status crop_notes(relume_notes **notes, const struct relume_rect *part,
                                const struct site *site)
{
    relume_notes *inside = NULL, *outside = NULL;
    const relume_status status = relume_notes_crop(&inside, &outside, *notes, part);
    const int left_out = status ? 0 : relume_notes_count(outside);
    if (left_out)
        log_line(
            site->log, RELUME_WARNING,
            "%d note%s beside the part that is shown: left out of the site, kept in the file's "
            "own list",
            left_out, left_out == 1 ? " lies" : "s lie");
    relume_notes_destroy(&outside);
    if (!status) {
        relume_notes_destroy(notes);
        *notes = inside;
    }
    return status;
}

relume_status part_keep(int crop[4], relume_pack *pack, relume_notes **notes,
                        const struct site *site)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const struct relume_publish_params *p = site->params;
    const int whole[2] = {info->width, info->height};
    struct relume_rect part = {p->crop[0], p->crop[1], p->crop[2], p->crop[3]};
    relume_status status = RELUME_OK;
    memset(crop, 0, 4 * sizeof *crop);
    if (p->crop_auto && info->geometry.projection <= RELUME_SLAB) {
        status = find_object(&part, pack, site);
        if (status || !part.width)
            return status;
    }
    if (!p->crop_auto && !part.width && !part.height)
        return RELUME_OK;
    status = relume_pack_crop(pack, &part);
    if (!status)
        status = crop_notes(notes, &part, site);
    if (status)
        return status;
    memcpy(crop, (const int[]){part.left, part.top, part.width, part.height}, 4 * sizeof *crop);
    log_line(site->log, RELUME_NOTE, "cropped to %d,%d,%d,%d of %d x %d pixels", part.left,
             part.top, part.width, part.height, whole[0], whole[1]);
    return RELUME_OK;
}
