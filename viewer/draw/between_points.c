// between_points.c - ways that gather light from points, with what they need
#include "draw/between_points.h"

void between_points_destroy(struct between_points *p, const struct gl *gl)
{
    joined_destroy(&p->leaf_lamps, gl);
    point_light_destroy(&p->light);
    micro_destroy(&p->micro);
    ism_destroy(&p->ism);
    card_points_destroy(&p->cards);
}

static relume_status need_way(struct between_points *p, const struct gl *gl, enum between_way way,
                              int samples, const struct relume_log *log)
{
    relume_status status = p->light.gl ? RELUME_OK : point_light_create(&p->light, gl, log);
    if (!status && way == BETWEEN_MICRO && !p->micro.gl)
        status = micro_create(&p->micro, gl, log);
    if (!status && way == BETWEEN_ISM && !p->ism.gl)
        status = ism_create(&p->ism, gl, log);
    if (status)
        return status;
    return way == BETWEEN_ISM ? ism_need(&p->ism, samples) : micro_need(&p->micro, samples);
}

relume_status between_points_need(struct between_points *p, const struct gl *gl,
                                  const struct relume_geometry *geometry,
                                  const struct target *places, const relume_objects *objects,
                                  uint64_t materials, enum between_way way, int samples,
                                  const struct relume_log *log)
{
    const struct joined *lamps = &p->leaf_lamps;
    const struct target *leaf = &p->cards.leaf_place;
    relume_status status = need_way(p, gl, way, samples, log);
    if (!status)
        status = card_points_need(&p->cards, gl, geometry, places, objects, materials, log);
    if (status || (lamps->count && lamps->target[0].width == leaf->width &&
                   lamps->target[0].height == leaf->height))
        return status;
    return joined_create(&p->leaf_lamps, gl, JOINED_MAX, leaf->width, leaf->height, log);
}

relume_status between_points_light(struct between_points *p, const struct points_view *view,
                                   enum between_way way, const struct target *panorama,
                                   const struct target *mean)
{
    const struct points_lit lit = {.panorama = panorama,
                                   .mean = mean,
                                   .let_without = &p->leaf_lamps.target[0],
                                   .let_with = &p->leaf_lamps.target[1]};
    return way == BETWEEN_ISM ? ism_light(&p->ism, &p->light, view, &lit)
                              : micro_light(&p->micro, &p->light, view, &lit);
}

void between_points_gather(struct between_points *p, const struct points_view *view,
                           enum between_way way, const struct points_sites *sites)
{
    if (way == BETWEEN_ISM)
        ism_gather(&p->ism, view, sites);
    else
        micro_gather(&p->micro, view, sites);
}
