// near_view.h - lights that stand near: what each pixel sees of them
#ifndef CAPTURE_NEAR_VIEW_H
#define CAPTURE_NEAR_VIEW_H

#include "capture/manifest/capture.h"
#include "core/math/vec.h"

// Where the pixels of one view lie, and the lights around them.
struct near_view {
    int lights, width, height;
    const vec3 *position;  // [lights]
    bool falls;            // light falls with the square of the distance
    struct relume_geometry geometry;
    double uv[2];
    struct relume_image depth;  // or empty
    double assumed;             // depth of all pixels where there is none; below 0: the plane z = 0
};

// Whether the lights are near and the places of the pixels are known: planar views and slabs (by
// depth, else on the plane z = 0, the st plane), spheres and cylinders with depth.
bool near_view_applies(const relume_capture *capture, int view);
// Warn of views whose surfaces are not known well enough.
void near_view_warn(const relume_capture *capture, const struct relume_log *log);
relume_status near_view_open(struct near_view *out, const relume_capture *capture, int view,
                             const struct relume_log *log);
void near_view_close(struct near_view *near);

// The world point at a (fractional) place of the picture, pixel centres at +0.5. Where `depth` says
// background, and depth < 0 (not given), that of the plane z = 0 (slabs: the st plane); panoramas:
// the world's origin, from where directions and brightness are those of distant lights.
vec3 near_view_point(const struct near_view *near, double x, double y, double depth);
vec3 near_view_pixel(const struct near_view *near, int x, int y);
// The same for a place that may lie beside the picture, with the mean of the finite depths up to
// `reach` pixels away.
vec3 near_view_around(const struct near_view *near, double x, double y, int reach);

// The unit direction from `point` to a light, and the factor that makes the pixel's value that
// under a light as bright as this one is at the world's origin.
vec3 near_view_direction(double *gain, const struct near_view *near, int light, vec3 point);

// Multiply one image (three channels) by these gains.
void near_view_level(const struct near_view *near, int light, struct relume_image *image);

#endif
