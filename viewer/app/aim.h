// aim.h - where lights come from, as the viewer sees it
#ifndef VIEWER_AIM_H
#define VIEWER_AIM_H

#include "app/light_list.h"
#include "app/view_geometry.h"

struct app_axes app_frame_axes(const struct app *app);

// The direction of `light` as the viewer sees it: x right, y up, z towards the viewer.
struct relume_vec3 app_light_direction(const struct app *app, int light);
// Let it come from there (unit). Near lights move on a sphere about app_middle.
void app_aim_light(struct app *app, int light, struct relume_vec3 seen);
// Let it come from (x, y) of a unit ball seen from the front, on the half that it came from.
void app_point_light(struct app *app, int light, double x, double y);
// Turn the selected light about the frame's up (> 0: to the right) and right (> 0: down).
void app_turn_light(struct app *app, double yaw_deg, double pitch_deg);

// Lets an arrangement replace the lights. A raking one comes from the side of the selected light;
// pressed again, from the side that it had before.
void app_arrange_lights(struct app *app, const struct light_preset *preset);

#endif
