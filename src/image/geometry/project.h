// project.h - where a camera sees a place: the inverse of its rays (camera.h)
#ifndef GEOMETRY_PROJECT_H
#define GEOMETRY_PROJECT_H

#include "image/geometry/camera.h"

// The pixel position, from the upper left corner, that shows a place, and how far along its ray the
// place lies. False when the camera does not see that way. Not of `rectified` cameras.
bool camera_project(double xy[2], double *distance, const struct camera *camera, vec3 place);

#endif
