// view.h - from relit views to a frame: light slabs and panoramas (Wong 1998, 6.3, 8.1, 8.2)
#ifndef RELUME_VIEW_H
#define RELUME_VIEW_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/frame.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// All but the first three is of slabs.
struct relume_view_params {
    size_t struct_size;         // filled by the macro (base.h)
    int threads;                // default: all cores
    enum relume_filter filter;  // panoramas; slabs: NEAREST is as `one`, all else linear
    bool one;                   // one ray a pixel, for what has no mean, as positions
    enum relume_interpolation interpolation;
    // Disparities by view number, read where views are. NULL: not known.
    const struct relume_image *disparity;
    const double (*range)[2];  // least and largest of these; default: looked for
    // Synthetic aperture: its diameter on the uv plane, world units, and how far the plane in focus
    // lies from the st plane (z minus st_z). With either of them not 0 all cameras within the
    // aperture are averaged in linear light, whatever `interpolation` says. Default: a pinhole, the
    // st plane in focus.
    double aperture, focus;
    // Where images (and disparities, whose `range` is then given) are parts of their views: which,
    // by view number, of width x height. Slabs without an aperture or a focus only.
    // Default: they are whole.
    const struct relume_rect *part;
    int size[2];    // width and height of the views that `part` lies in
    float nothing;  // what pixels of a frame hold that no view sees; default: black
    // Called before texels of a view are read, for images that are made where they are looked at:
    // columns x and x + 1, rows y and y + 1, each clamped to the view. For single rays, along which
    // one thread looks. Default: all texels are there.
    void (*need)(void *user, int view, int x, int y);
    void *user;
};
#define relume_view_params(...)                                                                    \
    (&(const struct relume_view_params){RELUME_SIZED(relume_view_params), __VA_ARGS__})

// Unit direction through the (fractional) position (x, y) of a width x height frame; pixel centres
// are at +0.5.
RELUME_API struct relume_vec3 relume_pan_tilt_ray(struct relume_pan_tilt look, int width,
                                                  int height, double x, double y);

// A frame; a pixel that covers several texels is the mean of rays through all of it. `out` has the
// wanted size already. RELUME_EINVAL when `image` is no panorama
// of three channels or `look` is not finite.
RELUME_RESULT relume_status relume_panorama_frame(struct relume_image *out,
                                                  const struct relume_geometry *geometry,
                                                  const struct relume_image *image,
                                                  struct relume_pan_tilt look,
                                                  const struct relume_view_params *params);

#ifdef __cplusplus
}
#endif
#endif
