// things.h - objects covered with measured materials, on the GPU
//
// Their surface is drawn once into textures of places and frames; then every lamp adds what each
// material shows of it, with a shadow map of its own. So the work of a lamp is that of the pixels
// that show something, and any number of lamps will do. An environment adds what is looked up in
// its prefiltered maps, times the share of its lamps that arrives.
#ifndef VIEWER_THINGS_H
#define VIEWER_THINGS_H

#include "draw/things_state.h"

// `gl`, `objects` and `log` must outlive it. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status things_create(struct things *things, const struct gl *gl, relume_objects *objects,
                            const struct relume_log *log);
void things_destroy(struct things *things);

// The lights of the next frames; what they point to must live as long. RELUME_ENOMEM,
// RELUME_EINVAL.
relume_status things_light(struct things *things, const struct relume_light *lights, int n);

// Light the objects as seen in a frame of width x height, with all lamps, into things->shaded;
// `only` >= 0: with all parts in this material. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status things_shade(struct things *things, const struct sight *sight, int width, int height,
                           int only);
// What was shaded becomes the other, and the other way round.
void things_swap(struct things *things);
// What was shaded over the target in use, of the same frame, or its difference from the other;
// `scene` are the positions that the frame shows, or 0: it shows nothing else.
void things_over(const struct things *things, const struct place *place, GLuint scene,
                 bool difference);

// The shadow of one lamp on the scene: adds to the target in use what `lone` shows, where the lamp
// reaches `scene`, times the lamp's share of the light of all lamps.
void things_cast(struct things *things, const struct place *place, int lamp, GLuint scene,
                 const struct target *lone);

// The graphics memory of a material; 0 while it was not shown.
size_t things_bytes(const struct things *things, int material);

#endif
