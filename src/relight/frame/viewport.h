// viewport.h - points and lights in a frame
#ifndef FRAME_VIEWPORT_H
#define FRAME_VIEWPORT_H

#include <relume/relight/viewport.h>

// Pictures without perspective are looked at as a screen is: that wide, degrees across.
#define RELUME_SCREEN_DEG 45.0

// The rectangle of the plane z = 0 that a planar file shows, from its camera.
struct relume_window relume_planar_window(const struct relume_geometry *planar);

// Where a point of the world appears, inside the frame or not; false behind the eye.
bool relume_viewport_project(double xy[2], const struct relume_viewport *viewport,
                             struct relume_vec3 point);
// The solid angle of a pixel there.
double relume_viewport_solid_angle(const struct relume_viewport *viewport, double x, double y);
// Whether a surface at `surface`, in the line of sight to `point`, hides it: it is nearer by more
// than a fiftieth of the distance. Positions that are not finite hide nothing.
bool relume_viewport_hides(const struct relume_viewport *viewport, struct relume_vec3 surface,
                           struct relume_vec3 point);

// A light in the frame, shared out among the four pixels around its place.
struct relume_visible_light {
    double x, y;
    float rgb[3];  // the sum over its pixels
};
enum { RELUME_VISIBLE_LIGHTS_MOST = 8192 };

// The sources among `n` lights, at most RELUME_VISIBLE_LIGHTS_MOST; returns how many. A light of
// value E at the eye sends it pi E (light.h), which a pixel of solid angle w shows as pi E / w:
// near lights at their places, areas in 8 x 8 pieces, distant ones a million times as far as the
// picture is wide, but not in parallel rays; environments are left out. Of what `hides` says that
// it hides at its place in the frame, nothing is seen; NULL: nothing hides.
int relume_viewport_lights(struct relume_visible_light *out, const struct relume_viewport *viewport,
                           const struct relume_light *lights, int n,
                           bool (*hides)(void *user, const double xy[2], struct relume_vec3 point),
                           void *user);
// Add `n` sources to a linear frame of three channels.
void relume_visible_lights_draw(struct relume_image *frame,
                                const struct relume_visible_light *sources, int n);

#endif
