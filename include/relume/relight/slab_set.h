// slab_set.h - several light slabs around an object, blended where they overlap
//
// Each slab is one of view.h in a frame of its own (struct relume_geometry, `pose`); a frame looks
// at the object from anywhere: every ray of it is looked up in the slabs whose cameras it passes.
#ifndef RELUME_SLAB_SET_H
#define RELUME_SLAB_SET_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/image.h>
#include <relume/relight/view.h>

#ifdef __cplusplus
extern "C" {
#endif

// Never changes. Thread-safety: safe.
typedef struct relume_slab_set relume_slab_set;

// View i of `views` stands at uv[i] of slab[slab_of[i]]; `slab_of` may be NULL for one slab.
// RELUME_EINVAL when a pose is no rotation or the cameras of a slab are no grid
// (relume_slab_create); RELUME_ENOMEM.
RELUME_RESULT relume_status relume_slab_set_create(relume_slab_set **out,
                                                   const struct relume_geometry *slab, int slabs,
                                                   const double (*uv)[2], const int *slab_of,
                                                   int views);
RELUME_API void relume_slab_set_destroy(relume_slab_set **slabs);

// How many slabs there are.
RELUME_API int relume_slab_set_count(const relume_slab_set *slabs);
// Slab i in the world; it belongs to `slabs`.
RELUME_API const struct relume_geometry *relume_slab_set_geometry(const relume_slab_set *slabs,
                                                                  int i);
// In its own frame, and with the view numbers of all: what takes `views`, `needed` or disparities
// by view number takes those of the file. It belongs to `slabs`.
RELUME_API const relume_slab *relume_slab_set_slab(const relume_slab_set *slabs, int i);

// The middle of the object: the mean of the middles of the st windows.
RELUME_API struct relume_vec3 relume_slab_set_middle(const relume_slab_set *slabs);
// The middle of the uv grid of slab i.
RELUME_API struct relume_vec3 relume_slab_set_eye(const relume_slab_set *slabs, int i);

// A perspective picture in the world: the eye, and the window that it looks through. Its place
// (x, y), both in [0, 1], rows from the top, is corner + x right + y down.
struct relume_window {
    // World: the eye, the upper left corner, the upper and the left edge.
    struct relume_vec3 eye, corner, right, down;
};

// Where an eye looks. All zero: at the middle of the object, +y up, through a window as large as
// the largest st window; for an eye straight before a slab it is that slab's window.
struct relume_look_at {
    bool aimed;             // at `at`; else at the middle
    struct relume_vec3 at;  // world
    struct relume_vec3 up;  // zero: +y, for an eye straight above or below -z or +z
    // horizontal, below 180, with square pixels; 0: the window above
    double field_of_view_deg;
};
// Whether anything is not zero.
RELUME_API bool relume_look_at_given(const struct relume_look_at *look_at);
// False when the eye stands where it looks, looks along `up`, or something is not finite. Where
// `look_at` is aimed and has a field of view, slabs do not matter: they may be NULL.
RELUME_API bool relume_slab_set_window(struct relume_window *out, const relume_slab_set *slabs,
                                       struct relume_vec3 eye, const struct relume_look_at *look_at,
                                       int width, int height);
// The st window of a slab as seen from `eye` (world), as relume_slab_frame shows it.
RELUME_API struct relume_window relume_slab_window(const struct relume_geometry *slab,
                                                   struct relume_vec3 eye);

// A lens before the eye, parallel to the window: a disc of the diameter `aperture`, world units,
// with the plane in focus `focus` nearer to the eye than the window's.
// Whether that can be: `aperture` not negative, the plane before the eye, all finite.
RELUME_API bool relume_lens_fits(const struct relume_window *window, double aperture, double focus);
// How many pinholes replace it in a picture of this width: by the blur of what lies half
// as far again as the window, 8 to 64; 1 without an aperture.
RELUME_API int relume_lens_points(const struct relume_window *window, double aperture, double focus,
                                  int width);
// Pinhole i of n, and its window on the plane in focus.
RELUME_API struct relume_window relume_lens_window(const struct relume_window *window,
                                                   double aperture, double focus, int i, int n);
// From the eye to the window's plane.
RELUME_API double relume_window_distance(const struct relume_window *window);

// How much a slab has to say of a ray that passes its uv plane in `uv` and its st plane in `st`: 1
// inside, smoothly falling towards the border of the camera grid (over the outer quarter of its
// extent, to 1e-4) and of the window (over its outer sixteenth, to 0), 0 beyond.
RELUME_API double relume_slab_weight(const relume_slab *slab, const double uv[2],
                                     const double st[2]);

// Mark in needed[views] what a frame of this width can touch; returns how many, 0 when
// it sees nothing.
RELUME_API int relume_slab_set_needs(bool *needed, const relume_slab_set *slabs,
                                     const struct relume_window *window, int width,
                                     const struct relume_view_params *params);

// Whether the ray through (x, y) of the window passes the camera grid of a slab. By depth a frame
// shows rays that pass none as the cameras see the surface that look most as the eye does, without
// depth the st plane.
RELUME_API bool relume_slab_set_passes(const relume_slab_set *slabs,
                                       const struct relume_window *window, double x, double y);

// Every pixel is the weighted mean of what the slabs show in its ray (relume_slab_weight), by depth
// where disparities are given, times the share of the cameras around the ray that see the surface;
// where it passes none as relume_slab_set_passes says, params->nothing where no slab has any
// weight or no camera sees what is there. With an aperture or a focus (relume_lens_window) the mean
// of what the pinholes of that lens show, each as above, of those that show anything. `views` and
// disparities are by view number, read where needed; `out` has the wanted size already.
// RELUME_EINVAL for a needed view or disparity that is missing or of another size, for a lens that
// does not fit, and when the frame sees nothing; RELUME_ENOMEM.
RELUME_RESULT relume_status relume_slab_set_frame(struct relume_image *out,
                                                  const relume_slab_set *slabs,
                                                  const struct relume_window *window,
                                                  const struct relume_image *views,
                                                  const struct relume_view_params *params);

// One ray of such a frame. Its views are those that relume_slab_set_needs marks for a window
// without extent: `corner` = eye + direction, `right` and `down` zero. RELUME_EINVAL likewise, when
// no slab has any weight, and for an aperture or a focus.
RELUME_RESULT relume_status relume_slab_set_value(float rgb[3], const relume_slab_set *slabs,
                                                  struct relume_vec3 eye,
                                                  struct relume_vec3 direction,
                                                  const struct relume_image *views,
                                                  const struct relume_view_params *params);

// The view that weighs most in a ray, and the place in [0, 1] x [0, 1] of its picture, rows from
// the top, where it shows the ray's point on the st plane. False when no slab has any weight.
RELUME_API bool relume_slab_set_nearest(int *view, double place[2], const relume_slab_set *slabs,
                                        struct relume_vec3 eye, struct relume_vec3 direction);

#ifdef __cplusplus
}
#endif
#endif
