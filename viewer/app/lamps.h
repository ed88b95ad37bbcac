// lamps.h - the list of lights: what shines, add and remove, arrangements
#ifndef VIEWER_LAMPS_H
#define VIEWER_LAMPS_H

#include "app/state.h"

// The factor of a light's value; 0 for one that does not shine (it is off, or another is solo).
double lamps_factor(const struct app_state *state, int light);

// The lights that shine with the values that they have; returns how many. Fills out[state->lights].
int lamps_shining(const struct app_state *state, struct relume_light *out);
// How many near lights uniforms.
int lamps_near(const struct app_state *state);

// `to`, which is released, becomes `from` with lists of its own. False when memory is short; then
// `to` is as before.
bool lamps_copy(struct app_state *to, const struct app_state *from);
// Free the lists.
void lamps_release(struct app_state *state);

// Append and select. False when the list is full or memory is short.
bool lamps_add(struct app_state *state, const struct relume_light *light, int entry);
// The last light stays. False when nothing was removed.
bool lamps_remove(struct app_state *state, int light);

// Remove the near lights; a list of nothing else becomes one light from the front.
void lamps_drop_near(struct app_state *state);

// Let one light come from `direction` (unit, world): near ones move on a sphere about `middle` and
// turn with it, environments turn about y.
void lamps_aim(struct app_state *state, int light, struct relume_vec3 direction,
               struct relume_vec3 middle);
// Where it comes from as seen from `middle`, unit.
struct relume_vec3 lamps_direction(const struct relume_light *light, struct relume_vec3 middle);

// Make a light of another kind of it (directional, point, spot or area) that comes from where it
// came from: near ones stand `far` from `middle` and shine towards it.
void lamps_change_kind(struct app_state *state, int light, enum relume_light_kind kind,
                       struct relume_vec3 middle, double far);

// "directional", "point", ... for people.
const char *lamps_kind_words(enum relume_light_kind kind);
// What can be said of a kind beside its direction and value; CHANGE: it can become another kind.
enum {
    LAMP_TURN = 1,
    LAMP_PLACE = 2,
    LAMP_AXIS = 4,
    LAMP_ANGLE = 8,
    LAMP_EDGES = 16,
    LAMP_CHANGE = 32
};
unsigned lamps_fields(enum relume_light_kind kind);

// Arrangements of directional lights that replace the list. `up` is the pole of the file: z for
// planar files and slabs, y for panoramas.
struct lamp_preset {
    const char *name, *what;
    int lights;
    double azimuth[8], elevation[8];  // degrees; from x towards y, above the picture
};
extern const struct lamp_preset lamp_presets[];  // ends with a NULL name
void lamps_arrange(struct app_state *state, const struct lamp_preset *preset, bool pole_y);

#endif
