// objects_drawer.h - objects covered with measured materials, on the GPU
//
// Their surface is drawn once into textures of places and frames; then every light sample adds what
// each material shows of it, with a shadow map of its own. So the work of a light sample is that of
// the pixels that show something, and any number of light samples will do. An environment adds what
// is looked up in its prefiltered maps, times the share of its light samples that arrives.
#ifndef VIEWER_OBJECTS_DRAWER_H
#define VIEWER_OBJECTS_DRAWER_H

#include "draw/objects_drawer_state.h"

// `gl`, `objects` and `log` must outlive it. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status objects_drawer_create(struct objects_drawer *drawer, const struct gl *gl,
                                    relume_objects *objects, const struct relume_log *log);
void objects_drawer_destroy(struct objects_drawer *drawer);

// The lights of the next frames; what they point to must live as long. RELUME_ENOMEM,
// RELUME_EINVAL.
relume_status objects_drawer_light(struct objects_drawer *drawer, const struct relume_light *lights,
                                   int n);

// Objects that have levels of detail are drawn from now on as the eye of the frame sees them.
// RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status objects_drawer_see(struct objects_drawer *drawer,
                                 const struct frame_projection *projection);
// Light the objects as seen in a frame of width x height, with all light samples, into
// drawer->shaded; `only` >= 0: with all parts in this material. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status objects_drawer_shade(struct objects_drawer *drawer,
                                   const struct frame_projection *projection, int width, int height,
                                   int only);
// What was shaded becomes the other, and the other way round.
void objects_drawer_swap(struct objects_drawer *drawer);
// What was shaded over the target in use, of the same frame, or its difference from the other;
// `scene` are the positions that the frame shows, or 0: it shows nothing else.
void objects_drawer_over(const struct objects_drawer *drawer, const struct frame_area *area,
                         GLuint scene, bool difference);

// The shadow of one light sample on the scene: adds to the target in use what `lone` shows, where
// the light sample reaches `scene`, times the light sample's share of the light of all light
// samples.
void objects_drawer_cast(struct objects_drawer *drawer, const struct frame_area *area,
                         int light_sample, GLuint scene, const struct target *lone);

// The graphics memory of a material; 0 while it was not shown.
size_t objects_drawer_bytes(const struct objects_drawer *drawer, int material);

#endif
