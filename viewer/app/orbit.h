// orbit.h - the eye on its way around an object that several slabs show
#ifndef VIEWER_ORBIT_H
#define VIEWER_ORBIT_H

#include "app/view_geometry.h"

// Whether the frame is one of several slabs.
bool orbit_is(const struct app *app);
// Turn the eye about the object, degrees to the right and up. It stays where cameras see the middle
// from, once it is there, and never passes the poles.
void orbit_turn(struct app *app, double right_deg, double up_deg);
// As the object follows a drag, by how much.
void orbit_drag(double turn_deg[2], const struct app *app, double dx, double dy);
double orbit_degrees_per_pixel(const struct app *app);
// The distance from the object's middle times `factor`, between a quarter and four times that of
// the cameras.
void orbit_dolly(struct app *app, double factor);
// Eye and what it looks at go that part of the distance between them to the right and, on the
// level, ahead.
void orbit_walk(struct app *app, double right, double ahead);

// Where a point of the world lies in the frame, pixels; false behind the eye.
bool orbit_place(double xy[2], const struct app *app, struct relume_vec3 point);
// The point as far ahead as `point` that lies at (x, y).
void orbit_move(struct relume_vec3 *point, const struct app *app, double x, double y);
// The ray that (x, y) shows; zero where the eye sees nothing.
struct relume_vec3 orbit_ray(const struct app *app, double x, double y);
struct app_axes orbit_axes(const struct app *app);

#endif
