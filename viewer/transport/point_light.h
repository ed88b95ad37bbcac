// point_light.h - what trees of points send under a light, by compute shaders; and what all ways
// that gather from points share
#ifndef VIEWER_POINT_LIGHT_H
#define VIEWER_POINT_LIGHT_H

#include "transport/card_points.h"

// Zeroed it is nothing.
struct point_light {
    const struct gl *gl;
    const struct relume_log *log;
    struct program leaves, up;
    struct target gathered, unused;  // by leaves of objects, of all light, and without objects
};

// RELUME_ESYSTEM.
relume_status point_light_create(struct point_light *p, const struct gl *gl,
                                 const struct relume_log *log);
void point_light_destroy(struct point_light *p);

// What all shaders of a frame know.
struct points_view {
    const struct card_points *points;
    struct relume_vec3 centre, eye;  // that captured the panorama; of the frame
    struct relume_vec3 middle;       // of the ball about the objects
    double radius;
    int samples, spacing, bounces;
    float sends;  // of what objects send of their own, under each light
};
// The light: what the panorama shows under it, the mean of that (a texel), and of leaves what lamps
// show a white surface that the scene lets through, without the objects and with them (lamps.frag).
struct points_lit {
    const struct target *panorama, *mean, *let_without, *let_with;
};
// Leaves of the scene send what its pixels show, dimmed by the objects' shadows, and those of
// objects nothing; all other nodes what these do. RELUME_ESYSTEM.
relume_status point_light_scene(struct point_light *p, const struct points_view *view,
                                const struct points_lit *lit);
// Leaves of objects send what they return of lamps, and of what is in `gathered`.
void point_light_objects(const struct point_light *p, const struct points_view *view,
                         const struct points_lit *lit);

// Places that gather, by their alpha, into targets that are black.
struct points_sites {
    const struct target *place, *facing;
    float kind;     // alpha
    bool of_scene;  // else of objects
    const struct target *without, *with_objects;
};
// Leaves of objects, which gather into `gathered` (black now); and the first row of them.
struct points_sites point_light_sites(int *top, const struct point_light *p,
                                      const struct points_view *view);

// The uniforms of sites, one after the other.
enum { SITE_PLACE, SITE_FACING, SITE_KIND, SITE_CENTRE, SITE_OFF, SITE_UNIFORMS };
#define SITE_NAMES "place", "facing", "kind", "centre", "off"
// Of the program in use; takes texture units 0 and 1, and images 0 and 1.
void points_use_sites(const struct gl *gl, const GLint *at, const struct points_view *view,
                      const struct points_sites *sites);
// What shaders have written can be read by others.
void points_wait(const struct gl *gl);

#endif
