// light_list.c - the list of lights: what shines, add and remove, arrangements
#include "app/light_list.h"

#include "common/vec.h"

#include <stdlib.h>
#include <string.h>

static bool any_solo(const struct app_state *state)
{
    for (int i = 0; i < state->lights; i++)
        if (state->light_state[i].solo)
            return true;
    return false;
}

static double factor_of(const struct app_light_state *light, bool solo)
{
    return light->off || (solo && !light->solo) ? 0.0 : exp2(light->stops);
}

double light_list_factor(const struct app_state *state, int light)
{
    return factor_of(&state->light_state[light], any_solo(state));
}

int light_list_shining(const struct app_state *state, struct relume_light *out)
{
    const bool solo = any_solo(state);
    int n = 0;
    for (int i = 0; i < state->lights; i++) {
        const double factor = factor_of(&state->light_state[i], solo);
        if (factor == 0.0)
            continue;
        out[n] = state->light[i];
        for (int c = 0; c < 3; c++)
            out[n].rgb[c] *= (float)factor;
        n++;
    }
    return n;
}

int light_list_near(const struct app_state *state)
{
    const bool solo = any_solo(state);
    int n = 0;
    for (int i = 0; i < state->lights; i++)
        n += factor_of(&state->light_state[i], solo) != 0.0 &&
             relume_light_is_near(state->light[i].kind);
    return n;
}

// ---------------------------------------------------------------- list

static bool grow_lights(struct app_state *state, int capacity)
{
    struct relume_light *light = realloc(state->light, (size_t)capacity * sizeof *light);
    if (light)
        state->light = light;
    struct app_light_state *own =
        light ? realloc(state->light_state, (size_t)capacity * sizeof *own) : NULL;
    if (!own)
        return false;
    state->light_state = own;
    state->capacity = capacity;
    return true;
}

bool light_list_copy(struct app_state *to, const struct app_state *from)
{
    struct app_state made = *from;
    made.light = NULL;
    made.light_state = NULL;
    if (!grow_lights(&made, from->lights ? from->lights : 1)) {
        light_list_release(&made);
        return false;
    }
    for (int i = 0; i < from->lights; i++) {
        made.light[i] = from->light[i];
        made.light_state[i] = from->light_state[i];
    }
    light_list_release(to);
    *to = made;
    return true;
}

void light_list_release(struct app_state *state)
{
    free(state->light);
    free(state->light_state);
    state->light = NULL;
    state->light_state = NULL;
    state->lights = state->capacity = 0;
}

bool light_list_add(struct app_state *state, const struct relume_light *light, int entry)
{
    const struct relume_light copy = *light;  // it may stand in the list that moves
    if (state->lights == APP_LIGHTS ||
        (state->lights == state->capacity && !grow_lights(state, 2 * state->capacity + 8)))
        return false;
    state->selected = state->lights++;
    state->light[state->selected] = copy;
    state->light_state[state->selected] = (struct app_light_state){.entry = entry};
    return true;
}

bool light_list_remove(struct app_state *state, int light)
{
    if (state->lights < 2)
        return false;
    const size_t behind = (size_t)(state->lights - 1 - light);
    memmove(&state->light[light], &state->light[light + 1], behind * sizeof *state->light);
    memmove(&state->light_state[light], &state->light_state[light + 1],
            behind * sizeof *state->light_state);
    state->lights--;
    if (state->selected >= state->lights || state->selected > light)
        state->selected--;
    return true;
}

void light_list_drop_near(struct app_state *state)
{
    for (int i = state->lights - 1; i >= 0; i--)
        if (relume_light_is_near(state->light[i].kind) && !light_list_remove(state, i)) {
            state->light[0] = (struct relume_light){.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
            state->light_state[0] = (struct app_light_state){.entry = -1};
        }
}

// ---------------------------------------------------------------- directions

struct relume_vec3 light_list_direction(const struct relume_light *light, struct relume_vec3 middle)
{
    const double turn = light->rotate_deg * M_PI / 180;
    struct relume_vec3 d = light->direction;
    if (light->kind == RELUME_LIGHT_ENVIRONMENT)
        d = (struct relume_vec3){sin(turn), 0, -cos(turn)};
    else if (relume_light_is_near(light->kind))
        d = vec3_sub(light->position, middle);
    const double n = vec3_length(d);
    return n > 0 ? (struct relume_vec3){d.x / n, d.y / n, d.z / n} : (struct relume_vec3){0, 0, 1};
}

// Turns `v` as the shortest way takes unit `from` to unit `to`.
static struct relume_vec3 turned(struct relume_vec3 v, struct relume_vec3 from,
                                 struct relume_vec3 to)
{
    const struct relume_vec3 axis = vec3_cross(from, to);
    const double c = vec3_dot(from, to);
    if (c < -1 + 1e-9)
        return (struct relume_vec3){-v.x, -v.y, -v.z};
    const double k = vec3_dot(axis, v) / (1 + c);
    const struct relume_vec3 side = vec3_cross(axis, v);
    return (struct relume_vec3){c * v.x + side.x + k * axis.x, c * v.y + side.y + k * axis.y,
                                c * v.z + side.z + k * axis.z};
}

static void aim_near(struct relume_light *l, struct relume_vec3 direction,
                     struct relume_vec3 middle)
{
    const struct relume_vec3 was = light_list_direction(l, middle);
    const double far = vec3_length(vec3_sub(l->position, middle));
    l->position = (struct relume_vec3){
        middle.x + far * direction.x,
        middle.y + far * direction.y,
        middle.z + far * direction.z,
    };
    l->direction = turned(l->direction, was, direction);
    l->u = turned(l->u, was, direction);
    l->v = turned(l->v, was, direction);
}

void light_list_aim(struct app_state *state, int light, struct relume_vec3 direction,
                    struct relume_vec3 middle)
{
    struct relume_light *l = &state->light[light];
    if (l->kind == RELUME_LIGHT_DIRECTIONAL)
        l->direction = direction;
    else if (l->kind == RELUME_LIGHT_ENVIRONMENT)
        l->rotate_deg = atan2(direction.x, -direction.z) * 180 / M_PI;
    else
        aim_near(l, direction, middle);
}

void light_list_change_kind(struct app_state *state, int light, enum relume_light_kind kind,
                            struct relume_vec3 middle, double far)
{
    struct relume_light *l = &state->light[light];
    const struct relume_vec3 d = light_list_direction(l, middle);
    const struct relume_vec3 pole =
        fabs(d.y) < 0.9 ? (struct relume_vec3){0, 1, 0} : (struct relume_vec3){0, 0, 1};
    const struct relume_vec3 side = vec3_cross(d, pole);
    const struct relume_vec3 right = vec3_scale(side, 1 / vec3_length(side));
    struct relume_light made = {.kind = kind, .direction = d, .half_angle_deg = 25};
    if (relume_light_is_near(kind)) {
        made.position =
            (struct relume_vec3){middle.x + far * d.x, middle.y + far * d.y, middle.z + far * d.z};
        made.direction = vec3_scale(d, -1);
        made.nofall = true;  // as bright as it was
        made.u = vec3_scale(right, 0.25 * far);
        made.v = vec3_cross(made.u, d);  // u x v is -d
    }
    memcpy(made.rgb, l->rgb, sizeof made.rgb);
    made.nofall &= kind != RELUME_LIGHT_AREA;
    *l = made;
    state->light_state[light].entry = -1;
}

// ---------------------------------------------------------------- kinds

static const struct {
    const char *words;
    unsigned fields;
} kinds[] = {
    [RELUME_LIGHT_DIRECTIONAL] = {"directional", LIGHT_FIELD_CHANGE},
    [RELUME_LIGHT_ENVIRONMENT] = {"environment", LIGHT_FIELD_TURN},
    [RELUME_LIGHT_POINT] = {"point", LIGHT_FIELD_PLACE | LIGHT_FIELD_CHANGE},
    [RELUME_LIGHT_SPOT] = {"spot", LIGHT_FIELD_PLACE | LIGHT_FIELD_AXIS | LIGHT_FIELD_ANGLE |
                                       LIGHT_FIELD_CHANGE},
    [RELUME_LIGHT_SLIDE] = {"slide", LIGHT_FIELD_PLACE | LIGHT_FIELD_AXIS | LIGHT_FIELD_ANGLE},
    [RELUME_LIGHT_AREA] = {"area", LIGHT_FIELD_PLACE | LIGHT_FIELD_EDGES | LIGHT_FIELD_CHANGE},
    [RELUME_LIGHT_IES] = {"ies", LIGHT_FIELD_PLACE | LIGHT_FIELD_AXIS},
    [RELUME_LIGHT_GONIO] = {"gonio", LIGHT_FIELD_PLACE | LIGHT_FIELD_AXIS},
};

const char *light_list_kind_words(enum relume_light_kind kind)
{
    return kinds[kind].words;
}

unsigned light_list_fields(enum relume_light_kind kind)
{
    return kinds[kind].fields;
}

// ---------------------------------------------------------------- arrangements

const struct light_preset light_presets[] = {
    {"raking",
     "one light from the selected light's side, as low as the captured ones that show relief",
     1,
     {180},
     {12},
     true},
    {"double raking",
     "two such lights, the second a quarter turn to the right",
     2,
     {180, 90},
     {12, 12},
     true},
    {"dome",
     "eight lights all around, 45 degrees",
     8,
     {0, 45, 90, 135, 180, 225, 270, 315},
     {45, 45, 45, 45, 45, 45, 45, 45},
     false},
    {NULL, NULL, 0, {0}, {0}, false},
};

void light_list_arrange(struct app_state *state, const struct light_preset *preset, bool pole_y)
{
    state->lights = 0;
    for (int i = 0; i < preset->lights; i++) {
        const double a = preset->azimuth[i] * M_PI / 180;
        const double e = preset->elevation[i] * M_PI / 180;
        const double x = cos(e) * cos(a);
        const double y = cos(e) * sin(a);
        const double z = sin(e);
        const float value = preset->lights > 2 ? 2.0f / (float)preset->lights : 1.0f;
        const struct relume_light light = {
            .direction = pole_y ? (struct relume_vec3){x, z, -y} : (struct relume_vec3){x, y, z},
            .rgb = {value, value, value},
        };
        light_list_add(state, &light, -1);
    }
    state->selected = 0;
}

static struct relume_vec3 turned_side(struct relume_vec3 side, double degrees)
{
    const double a = degrees * M_PI / 180;
    return (struct relume_vec3){side.x * cos(a) - side.y * sin(a),
                                side.x * sin(a) + side.y * cos(a), side.z};
}

void light_list_rake(struct app_state *state, const struct light_preset *preset,
                     const struct relume_relief *relief, struct relume_vec3 side)
{
    struct relume_vec3 *const first = &state->light[0].direction;
    int place = relume_relief_lowest(relief, side, -1);
    if (place < 0)
        return;
    state->raked_from = side;
    state->raked_to = *first = relief->direction[place];
    for (int i = 1; i < preset->lights && place >= 0; i++) {
        const double turn = preset->azimuth[i] - preset->azimuth[0];
        place = relume_relief_lowest(relief, turned_side(*first, turn), place);
        if (place >= 0)
            state->light[i].direction = relief->direction[place];
    }
}
