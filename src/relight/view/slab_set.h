// slab_set.h - several slabs: which cameras see what a ray hits
#ifndef VIEW_SLAB_SET_H
#define VIEW_SLAB_SET_H

#include "relight/view/view.h"

#include <relume/relight/slab_set.h>

// How many slabs there are.
int relume_slab_set_count(const relume_slab_set *slabs);
// Slab i in the world; it belongs to `slabs`.
const struct relume_geometry *relume_slab_set_geometry(const relume_slab_set *slabs, int i);
// In its own frame, and with the view numbers of all: what takes `views`, `needed` or disparities
// by view number takes those of the file. It belongs to `slabs`.
const relume_slab *relume_slab_set_slab(const relume_slab_set *slabs, int i);

// The middle of the uv grid of slab i.
struct relume_vec3 relume_slab_set_eye(const relume_slab_set *slabs, int i);

// False when the eye stands where it looks, looks along `up`, or something is not finite. Where
// `look_at` is aimed and has a field of view, slabs do not matter: they may be NULL.
bool relume_slab_set_window(struct relume_window *out, const relume_slab_set *slabs,
                            struct relume_vec3 eye, const struct relume_look_at *look_at, int width,
                            int height);
// The st window of a slab as seen from `eye` (world), as relume_slab_frame shows it.
struct relume_window relume_slab_window(const struct relume_geometry *slab, struct relume_vec3 eye);

// A lens before the eye, parallel to the window: a disc of the diameter `aperture`, world units,
// with the plane in focus `focus` nearer to the eye than the window's.
// Whether that can be: `aperture` not negative, the plane before the eye, all finite.
bool relume_lens_fits(const struct relume_window *window, double aperture, double focus);
// How many pinholes replace it in a picture of this width: by the blur of what lies half
// as far again as the window, 8 to 64; 1 without an aperture.
int relume_lens_points(const struct relume_window *window, double aperture, double focus,
                       int width);
// Pinhole i of n, and its window on the plane in focus.
struct relume_window relume_lens_window(const struct relume_window *window, double aperture,
                                        double focus, int i, int n);
// From the eye to the window's plane.
double relume_window_distance(const struct relume_window *window);

// How much a slab has to say of a ray that passes its uv plane in `uv` and its st plane in `st`: 1
// inside, smoothly falling towards the border of the camera grid (over the outer quarter of its
// extent, to 1e-4) and of the window (over its outer sixteenth, to 0), 0 beyond.
double relume_slab_weight(const relume_slab *slab, const double uv[2], const double st[2]);

// Mark in needed[views] what a frame of this width can touch; returns how many, 0 when
// it sees nothing.
int relume_slab_set_needs(bool *needed, const relume_slab_set *slabs,
                          const struct relume_window *window, int width,
                          const struct relume_view_params *params);

// Whether the ray through (x, y) of the window passes the camera grid of a slab. By depth a frame
// shows rays that pass none as the cameras see the surface that look most as the eye does, without
// depth the st plane.
bool relume_slab_set_passes(const relume_slab_set *slabs, const struct relume_window *window,
                            double x, double y);

// Every pixel is the weighted mean of what the slabs show in its ray (relume_slab_weight), by depth
// where disparities are given, times the share of the cameras around the ray that see the surface;
// where it passes none as relume_slab_set_passes says, params->nothing where no slab has any
// weight or no camera sees what is there. With an aperture or a focus (relume_lens_window) the mean
// of what the pinholes of that lens show, each as above, of those that show anything. `views` and
// disparities are by view number, read where needed; `out` has the wanted size already.
// RELUME_EINVAL for a needed view or disparity that is missing or of another size, for a lens that
// does not fit, and when the frame sees nothing; RELUME_ENOMEM.
relume_status relume_slab_set_frame(struct relume_image *out, const relume_slab_set *slabs,
                                    const struct relume_window *window,
                                    const struct relume_image *views,
                                    const struct relume_view_params *params);

// One ray of such a frame. Its views are those that relume_slab_set_needs marks for a window
// without extent: `corner` = eye + direction, `right` and `down` zero. RELUME_EINVAL likewise, when
// no slab has any weight, and for an aperture or a focus.
relume_status relume_slab_set_value(float rgb[3], const relume_slab_set *slabs,
                                    struct relume_vec3 eye, struct relume_vec3 direction,
                                    const struct relume_image *views,
                                    const struct relume_view_params *params);

// The view that weighs most in a ray, and the place in [0, 1] x [0, 1] of its picture, rows from
// the top, where it shows the ray's point on the st plane. False when no slab has any weight.
bool relume_slab_set_nearest(int *view, double place[2], const relume_slab_set *slabs,
                             struct relume_vec3 eye, struct relume_vec3 direction);

#endif
