// renderer.h - a file under lights, as the files that make frames of it share it
#ifndef FRAME_RENDERER_H
#define FRAME_RENDERER_H

#include "math/vec.h"

#include <relume/frame.h>
#include <relume/slabs.h>

// What all views of a frame use; made when first needed.
struct shared {
    relume_weight_grid *grid;
    relume_refit *learned;  // of the first view of the display domain under an environment
};

struct renderer {
    relume_pack *pack;
    const struct relume_pack_info *info;
    const struct relume_light *lights;
    int light_count;
    struct relume_frame_params params;
    struct relume_view_params view;
    struct shared *shared;
};

relume_status renderer_relight(const struct renderer *r, int view, struct relume_image *out);

// The views of a slab that a frame needs, relit, and their disparities where it takes depth.
struct gathered {
    bool *needed;                    // [views]
    struct relume_image *images;     // [views]
    struct relume_image *disparity;  // [views], or NULL
    int views;
};
relume_status gathered_create(struct gathered *g, const struct renderer *r);
void gathered_destroy(struct gathered *g);
// Relight what is marked. `slab_of` gives the slab of a view.
relume_status gathered_fill(struct gathered *g, const struct renderer *r, bool by_depth,
                            const relume_slab *(*slab_of)(const void *slabs, int view),
                            const void *slabs);
// The file has depth, and no other interpolation was asked for: several slabs and free eyes go by
// it.
bool renderer_may_take_depth(const struct renderer *r);
// So does one slab, but for a lens.
bool renderer_takes_depth(const struct renderer *r);

// Of a slab, or of several.
relume_status frame_eye(const struct renderer *r, const struct relume_camera *camera,
                        struct relume_image *out);
relume_status frame_around(const struct renderer *r, const struct relume_camera *camera,
                           struct relume_image *out);
// The cameras of the file. RELUME_EDATA with a sentence, RELUME_ENOMEM.
relume_status renderer_slab(relume_slab **slab, const struct renderer *r);
relume_status renderer_slabs(relume_slabs **slabs, const struct renderer *r);
// RELUME_EDATA when depth is asked for that the file does not have.
relume_status renderer_check_depth(const struct renderer *r);
relume_status renderer_disparity(struct relume_image *out, const struct renderer *r,
                                 const relume_slab *slab, int view);
// As relume_query_rays.
relume_status query_rays(float (*rgb)[3], const struct renderer *r, const struct relume_ray *rays,
                         int n);

// Put the picture into its place of a frame, with black beside it.
relume_status frame_put(struct relume_image *image, const struct relume_place *place,
                        const int frame[2], const struct renderer *r);

// ---------------------------------------------------------------- one ray
// Bilinear in linear light with the border clamped; pixel centres are at +0.5.
void ray_sample(float rgb[3], const struct relume_image *image, double x, double y);
// Where the line of the ray meets the plane z; false when it never does.
bool ray_meets_plane(vec3 eye, vec3 direction, double z, double xy[2]);
bool ray_goes_towards(vec3 eye, vec3 direction, double z);
// Pixel position of a point of a window; false outside.
bool ray_window_pixel(const double min[2], const double max[2], int width, int height,
                      const double at[2], double xy[2]);

#endif
