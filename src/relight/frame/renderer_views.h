// renderer_views.h - parts of frames and rays, by a renderer that is kept
#ifndef FRAME_RENDERER_VIEWS_H
#define FRAME_RENDERER_VIEWS_H

#include <relume/renderer.h>

// A rectangle of a captured view, in its own size, under the renderer's lights: `*out` is created.
// Without a pass no more of the file is read than the rows that hold it, however large the view.
// RELUME_EINVAL where the view has no such part, errors of relume_frame.
relume_status relume_renderer_part(struct relume_image *out, relume_renderer *renderer, int view,
                                   const struct relume_rect *rect);

// Where the surface is instead of light, `*out` created likewise: world positions, background far
// along its ray, NaN where no view sees. Lights and pass are not looked at.
relume_status relume_renderer_places(struct relume_image *out, relume_renderer *renderer,
                                     const struct relume_camera *camera);

// relume_query_rays with the renderer's lights. One ray costs the texels it needs.
relume_status relume_renderer_rays(float (*rgb)[3], relume_renderer *renderer,
                                   const struct relume_ray *rays, int n);

// The value along the ray of one place of a frame of the camera's size; pixel centres are at +0.5.
// It is that pixel of relume_renderer_frame wherever a pixel is no mean of several texels.
// RELUME_EUNFIT when the file holds no such ray.
relume_status relume_renderer_pixel(float rgb[3], relume_renderer *renderer,
                                    const struct relume_camera *camera, double x, double y);

#endif
