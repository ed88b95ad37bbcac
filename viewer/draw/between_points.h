// between_points.h - ways that gather light from points, with what they need
#ifndef VIEWER_BETWEEN_POINTS_H
#define VIEWER_BETWEEN_POINTS_H

#include "draw/joined.h"
#include "transport/ism.h"
#include "transport/micro.h"

// How light is gathered.
enum between_way { BETWEEN_AMBIENT, BETWEEN_DIRECTIONAL, BETWEEN_MICRO, BETWEEN_ISM };

// Zeroed it holds nothing; made when first needed.
struct between_points {
    struct card_points cards;
    struct joined leaf_lamps;  // as by_lamps, at the leaves of the scene
    struct point_light light;
    struct micro micro;
    struct ism ism;
};

static inline bool between_has_points(enum between_way way)
{
    return way >= BETWEEN_MICRO;
}
void between_points_destroy(struct between_points *p, const struct gl *gl);
// Makes what a way needs for the objects, whose materials have that fingerprint, in the panorama
// that sees `places`. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status between_points_need(struct between_points *p, const struct gl *gl,
                                  const struct relume_geometry *geometry,
                                  const struct target *places, const relume_objects *objects,
                                  uint64_t materials, enum between_way way, int samples,
                                  const struct relume_log *log);
// Lights the points under a light that the panorama and its mean, and the leaves, are drawn in.
relume_status between_points_light(struct between_points *p, const struct points_view *view,
                                   enum between_way way, const struct target *panorama,
                                   const struct target *mean);
void between_points_gather(struct between_points *p, const struct points_view *view,
                           enum between_way way, const struct points_sites *sites);

#endif
