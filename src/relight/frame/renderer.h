// renderer.h - a file under lights, as the files that make frames of it share it
#ifndef FRAME_RENDERER_H
#define FRAME_RENDERER_H

#include "core/base/budget.h"
#include "core/math/vec.h"
#include "relight/frame/relighter.h"
#include "relight/shadow/moving.h"
#include "relight/view/view.h"

#include <relume/relight/slab_set.h>
#include <relume/renderer.h>

// What is noted of a frame, once: the same words are not said of the next.
enum note { NOTE_BESIDE, NOTE_BORDERS, NOTES };

// What a frame shows of its views.
enum shown { SHOWN_LIGHT, SHOWN_PLACES, SHOWN };

// Of one view.
struct kept {
    uint64_t lit;                 // the lighting that its picture shows; 0: none
    uint64_t partly;              // the lighting that it shows at some texels; 0: none
    uint32_t *texel;              // [texels]: the lighting that each shows
    struct relume_image surface;  // for near lights; empty: not asked for
    relume_shadows *shadows;      // NULL: not asked for
    uint64_t code_bytes;          // that the pack holds for it
    bool changed;                 // its bytes must be counted again
};

struct relume_renderer {
    relume_pack *pack;
    const struct relume_pack_info *info;
    struct relume_frame_params params;
    struct relume_view_params view;  // of the present frame
    struct relume_light *lights;
    int light_count;
    uint64_t lighting;  // counts: lights, or what else pictures depend on, have changed
    bool said;          // what there is to say of these lights
    bool is_part;       // others are seen beside it: black does not mean that something is missing
    char note[NOTES][200];
    enum shown shown;
    relume_relighter *relighter;
    struct kept *kept;                  // [views]
    struct budget memory;               // of the views, a round for each frame, except ...
    int *changed, changes;              // ... [views]: those whose bytes have changed
    struct relume_image *image[SHOWN];  // [views]
    struct relume_image *disparity;     // [views]
    double (*range)[2];                 // [views]: of whole disparities; NaN: not known yet
    bool *needed;                       // [views]: by the present frame
    struct parts *parts;                // parts.h; NULL: not needed yet
    relume_status texels;               // of renderer_texels
    relume_slab *slab;                  // of a single slab, ...
    relume_slab_set *slabs;             // ... of several; NULL: not needed yet
    // Draws a frame of light with what stands in the scene; NULL: nothing does.
    relume_status (*draw_over)(struct relume_image *out, relume_renderer *r,
                               const struct relume_camera *camera);
    void *over;  // of it
    void (*free_over)(void *over);
};

__attribute__((format(printf, 3, 4))) void renderer_note(relume_renderer *r, enum note note,
                                                         const char *format, ...);

// Bytes that are kept between frames, at most.
uint64_t renderer_memory(const relume_renderer *r);
// The present frame needs `view`: its bytes may change.
void renderer_use(relume_renderer *r, int view);
// Lets go of codes of other views than `view` while more than that is kept: what they were read for
// is relit.
void renderer_save_memory(relume_renderer *r, int view);
// Where the pixels of a view lie, if near lights ask for it and `out` is empty.
relume_status renderer_surface(struct relume_image *out, relume_renderer *r, int view);
// What the shadows of directional lights in a view are traced with, if there are such lights and
// the file has it; else NULL.
relume_status renderer_shadows(relume_shadows **out, relume_renderer *r, int view);
// Whether the lights can be shown of some texels without the others.
bool renderer_goes_by_texels(const relume_renderer *r);
// Begin a frame that shows light or places: trims what is kept.
void renderer_begin(relume_renderer *r, enum shown shown);
// The image of `view` as the frame shows it, in r->image[r->shown][view], ...
relume_status renderer_need(relume_renderer *r, int view);
// The same for few rays: the image is there, its texels are found when renderer_texels asks for
// them, with errors in r->texels.
relume_status renderer_need_partly(relume_renderer *r, int view);
void renderer_texels(void *renderer, int view, int x, int y);  // relume_view_params.need
// ... and its disparities.
relume_status renderer_need_disparity(relume_renderer *r, int view);
// Every view that r->needed marks, with disparities where `by_depth`.
relume_status renderer_need_all(relume_renderer *r, bool by_depth);
// The present lights in a view, into an image of the caller's (empty: it is created).
relume_status renderer_relight(relume_renderer *r, int view, struct relume_image *out);
// What relighting a view takes.
relume_status renderer_relit(struct relume_relit *relit, relume_renderer *r, int view);

// r->slab, or r->slabs.
relume_status renderer_need_slab(relume_renderer *r);
relume_status renderer_need_slabs(relume_renderer *r);

// Refuses interpolation by depth where there is none.
relume_status renderer_check_depth(const relume_renderer *r);
// The file has depth, and no other interpolation was asked for: several slabs and free eyes go by
// it.
bool renderer_may_take_depth(const relume_renderer *r);
// So does one slab, but for a lens.
bool renderer_takes_depth(const relume_renderer *r);

// relume_renderer_frame without what stands in the scene.
relume_status renderer_bare_frame(struct relume_image *out, relume_renderer *r,
                                  const struct relume_camera *camera);
// A frame of camera->width x camera->height of a slab, or of several: `*out` is created.
relume_status frame_eye(relume_renderer *r, const struct relume_camera *camera,
                        struct relume_image *out);
relume_status frame_around(relume_renderer *r, const struct relume_camera *camera,
                           struct relume_image *out);

// The parts of views that a frame of a slab from `eye` reads, relit, in r->parts; true in *whole,
// and no parts, where they are most of the views. Draw with frame_parts_params then.
relume_status frame_parts(bool *whole, relume_renderer *r, vec3 eye, const int frame[2],
                          bool by_depth);
// A rectangle of a view, or of a reduced level, under distant lights, of which nothing is kept;
// `out` is created.
relume_status frame_rows(struct relume_image *out, relume_renderer *r, int view, int level,
                         const struct relume_rect *rect);
// A whole view under distant lights, band by band, of which nothing is kept: whether that shows
// what the frame asks for; `out` is created (bands.c).
bool frame_bands_suit(const relume_renderer *r);
relume_status frame_bands(struct relume_image *out, relume_renderer *r, int view);
// Pictures of a view in another size.
struct relume_scale_params frame_scaling(const relume_renderer *r);
// A rectangle of a view, smaller, band by band: whether that saves reading or memory and shows what
// the frame asks for; `out` is created (detail.c).
bool frame_detail_suits(const relume_renderer *r, const struct relume_rect *rect, int width,
                        int height);
relume_status frame_detail(struct relume_image *out, relume_renderer *r, int view,
                           const struct relume_rect *rect, int width, int height);
struct relume_view_params frame_parts_params(const relume_renderer *r, bool by_depth);

// ---------------------------------------------------------------- one ray
// Bilinear in linear light with the border clamped; pixel centres are at +0.5.
void ray_sample(float rgb[3], const struct relume_image *image, double x, double y);
// Where the line of the ray crosses the plane z; false when it never does.
bool ray_crosses_plane(vec3 eye, vec3 direction, double z, double xy[2]);
bool ray_goes_towards(vec3 eye, vec3 direction, double z);
// Pixel position of a point of a window; false outside.
bool ray_window_pixel(const double min[2], const double max[2], int width, int height,
                      const double at[2], double xy[2]);

#endif
