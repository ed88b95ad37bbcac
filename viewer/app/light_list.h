// light_list.h - the list of lights: what shines, add and remove, arrangements
#ifndef VIEWER_LIGHT_LIST_H
#define VIEWER_LIGHT_LIST_H

#include "app/state.h"

// The factor of a light's value; 0 for one that does not shine (it is off, or another is solo).
double light_list_factor(const struct app_state *state, int light);

// The lights that shine with the values that they have; returns how many. Fills out[state->lights].
int light_list_shining(const struct app_state *state, struct relume_light *out);
// How many near lights uniforms.
int light_list_near(const struct app_state *state);

// `to`, which is released, becomes `from` with lists of its own. False when memory is short; then
// `to` is as before.
bool light_list_copy(struct app_state *to, const struct app_state *from);
// Free the lists.
void light_list_release(struct app_state *state);

// Append and select. False when the list is full or memory is short.
bool light_list_add(struct app_state *state, const struct relume_light *light, int entry);
// The last light stays. False when nothing was removed.
bool light_list_remove(struct app_state *state, int light);

// Remove the near lights; a list of nothing else becomes one light from the front.
void light_list_drop_near(struct app_state *state);

// Let one light come from `direction` (unit, world): near ones move on a sphere about `middle` and
// turn with it, environments turn about y.
void light_list_aim(struct app_state *state, int light, struct relume_vec3 direction,
                    struct relume_vec3 middle);
// Where it comes from as seen from `middle`, unit.
struct relume_vec3 light_list_direction(const struct relume_light *light,
                                        struct relume_vec3 middle);

// Make a light of another kind of it (directional, point, spot or area) that comes from where it
// came from: near ones stand `far` from `middle` and shine towards it.
void light_list_change_kind(struct app_state *state, int light, enum relume_light_kind kind,
                            struct relume_vec3 middle, double far);

// "directional", "point", ... for people.
const char *light_list_kind_words(enum relume_light_kind kind);
// What can be said of a kind beside its direction and value; CHANGE: it can become another kind.
enum {
    LIGHT_FIELD_TURN = 1,
    LIGHT_FIELD_PLACE = 2,
    LIGHT_FIELD_AXIS = 4,
    LIGHT_FIELD_ANGLE = 8,
    LIGHT_FIELD_EDGES = 16,
    LIGHT_FIELD_CHANGE = 32
};
unsigned light_list_fields(enum relume_light_kind kind);

// Arrangements of directional lights that replace the list. `up` is the pole of the file: z for
// planar files and slabs, y for panoramas.
struct light_preset {
    const char *name, *what;
    int lights;
    double azimuth[8], elevation[8];  // degrees; from x towards y, above the picture
    bool rakes;                       // as low as lights show relief, where that is known
};
extern const struct light_preset light_presets[];  // ends with a NULL name
void light_list_arrange(struct app_state *state, const struct light_preset *preset, bool pole_y);
// Moves the lights of a raking arrangement to captured ones that show relief. The first one goes to
// the lowest on `side` (relume_relief_lowest). All other lights are turned from it as in the
// preset.
void light_list_rake(struct app_state *state, const struct light_preset *preset,
                     const struct relume_relief *relief, struct relume_vec3 side);

#endif
