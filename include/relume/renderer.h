// renderer.h - a file under lights, drawn again and again: what one frame has worked out, the next
// uses
//
// What depends on the file alone stays from frame to frame - weight grids, refits, where pixels
// lie, disparities - and so do relit views, until the lights change. Views that frames have not
// used for the longest time leave when all of it takes more than `memory` (frame.h).
#ifndef RELUME_RENDERER_H
#define RELUME_RENDERER_H

#include <relume/base.h>
#include <relume/frame.h>
#include <relume/image.h>
#include <relume/light.h>
#include <relume/pack.h>
#include <relume/rig.h>

#ifdef __cplusplus
extern "C" {
#endif

// Thread-safety: one thread at a time, and no other that uses the pack meanwhile. Several renderers
// of one pack may take turns.
typedef struct relume_renderer relume_renderer;

// Of an open file, without a light. `pack` and what `params` points at must outlive the renderer;
// the struct itself is copied. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_renderer_create(relume_renderer **out, relume_pack *pack,
                                                   const struct relume_frame_params *params);
RELUME_API void relume_renderer_destroy(relume_renderer **renderer);
// The pack that it draws, borrowed.
RELUME_API relume_pack *relume_renderer_pack(const relume_renderer *renderer);

// How frames are made from now on. What still holds is kept: another lens relights nothing.
// Threads, cpu_off, once and log stay those of relume_renderer_create.
RELUME_API void relume_renderer_set(relume_renderer *renderer,
                                    const struct relume_frame_params *params);

// The lights from now on, which are copied; what they point at (pictures, maps) is borrowed until
// the next call. RELUME_ENOMEM; then the lights are as before. They are checked when they are
// drawn.
RELUME_RESULT relume_status relume_renderer_set_lights(relume_renderer *renderer,
                                                       const struct relume_light *lights, int n);
// Those that shine of a rig, which must outlive them.
RELUME_RESULT relume_status relume_renderer_set_rig(relume_renderer *renderer, relume_rig *rig);

// They belong to the renderer, until they are set again.
RELUME_API const struct relume_light *relume_renderer_lights(int *n,
                                                             const relume_renderer *renderer);

// A picture in memory of the caller. Row y begins `stride` bytes after row y - 1 (below zero: the
// rows go upwards from `data`).
enum relume_target_format {
    RELUME_TARGET_RGB = 0,  // three floats, linear
    RELUME_TARGET_RGBA,     // four floats; alpha is 1 in the picture, 0 beside it
    RELUME_TARGET_RGBA8,    // four bytes: times 2^exposure_ev, clipped to [0, 1], sRGB-coded; alpha
                            // 255 and 0
};
// Where a frame is drawn to. The caller owns it all.
struct relume_target {
    void *data;                        // aligned to 4 bytes, as `stride` is
    enum relume_target_format format;  // of the pixels
    int width, height;
    ptrdiff_t stride;   // default: rows without a gap
    float exposure_ev;  // RGBA8
};

// Draw what the camera sees; the target's size counts, not the camera's. A captured view in its own
// size without a pass goes straight from the codes into RGB or RGBA8 whose rows have no gap. Errors
// of relume_frame; RELUME_EINVAL for a target without memory or size. After an error the target
// holds nothing of use.
RELUME_RESULT relume_status relume_renderer_draw(relume_renderer *renderer,
                                                 const struct relume_camera *camera,
                                                 const struct relume_target *target);

// relume_frame with the renderer's lights: `*out` is created.
RELUME_RESULT relume_status relume_renderer_frame(struct relume_image *out,
                                                  relume_renderer *renderer,
                                                  const struct relume_camera *camera);

// The same in another size. Of a view with reduced levels no more is read than what the rectangle
// has in the one that is fine enough. RELUME_EINVAL also for sizes below 1.
RELUME_RESULT relume_status relume_renderer_detail(struct relume_image *out,
                                                   relume_renderer *renderer, int view,
                                                   const struct relume_rect *rect, int width,
                                                   int height);

// Bytes that are kept, the codes of views included.
RELUME_API uint64_t relume_renderer_bytes(const relume_renderer *renderer);
// Let go of everything that is kept.
RELUME_API void relume_renderer_forget(relume_renderer *renderer);

#ifdef __cplusplus
}
#endif
#endif
