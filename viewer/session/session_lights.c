// session_lights.c - between rigs, which own files and know words, and the list of lights that
// shines
#include "session/session.h"

#include "app/light_list.h"
#include "cli/program/say.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static relume_status too_many(const struct session *s)
{
    return say(s->log, RELUME_EINVAL, "lights: expected at most %d; found more", APP_LIGHTS);
}

static struct app_light_state state_of(const struct relume_rig_entry *e, int entry)
{
    return (struct app_light_state){
        .off = !e->on || !(e->intensity > 0),
        .solo = e->solo,
        .stops = e->intensity > 0 ? log2(e->intensity) : 0,
        .entry = entry,
    };
}

static relume_status append_entries(const struct session *s, struct app_state *to, int first)
{
    for (int i = first; i < relume_rig_count(s->rig); i++) {
        const struct relume_rig_entry *e = relume_rig_entry(s->rig, i);
        if (!light_list_add(to, &e->light, i))
            return to->lights < APP_LIGHTS ? RELUME_ENOMEM : too_many(s);
        to->light_state[to->selected] = state_of(e, i);
    }
    return RELUME_OK;
}

// Entries from `first` on.
static relume_status check_near(const struct session *s, int first)
{
    for (int i = first; i < relume_rig_count(s->rig); i++)
        if (!s->app.near_lights && relume_light_is_near(relume_rig_entry(s->rig, i)->light.kind))
            return say(s->log, RELUME_EUNFIT,
                       "light '%s': near lights need to know how far the surface is; use a file "
                       "with depth",
                       relume_rig_entry(s->rig, i)->spec);
    return RELUME_OK;
}

relume_status session_take_rig(struct session *s, relume_rig **rig, struct app_state *start)
{
    s->rig = *rig;
    *rig = NULL;
    const relume_status status = s->rig ? append_entries(s, start, 0) : relume_rig_create(&s->rig);
    start->selected = 0;
    return status;
}

relume_status session_light(struct session *s, const char *spec, bool replace)
{
    struct app_state *now = &s->app.now;
    const int entry = relume_rig_count(s->rig);
    relume_status status = relume_rig_add(s->rig, spec, NULL, s->log);
    if (!status)
        status = check_near(s, entry);
    if (status)
        return status;
    if (replace)
        now->lights = 0;
    return append_entries(s, now, entry);
}

relume_status session_map(struct session *s, const char *path)
{
    struct app_state *now = &s->app.now;
    const int old = now->selected;
    const bool replaces = now->light[old].kind == RELUME_LIGHT_ENVIRONMENT;
    const char *quote = strchr(path, '\'') ? "\"" : "'";
    char spec[APP_SPEC + 16];
    snprintf(spec, sizeof spec, "env %s%s%s", quote, path, quote);
    const relume_status status = session_light(s, spec, false);
    if (status || !replaces)
        return status;
    now->light[old].environment = now->light[now->selected].environment;
    now->light_state[old].entry = now->light_state[now->selected].entry;
    (void)light_list_remove(now, now->selected);
    now->selected = old;
    return RELUME_OK;
}

const char *session_map_in_use(const struct session *s)
{
    const struct app_state *now = &s->app.now;
    const int entry = now->light_state[now->selected].entry;
    return now->light[now->selected].kind == RELUME_LIGHT_ENVIRONMENT && entry >= 0
               ? relume_rig_entry(s->rig, entry)->file
               : NULL;
}

static relume_status add_rig(const struct session *s, const relume_rig *rig)
{
    const int first = relume_rig_count(s->rig);
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < relume_rig_count(rig); i++) {
        const struct relume_rig_entry *e = relume_rig_entry(rig, i);
        status = relume_rig_add(s->rig, e->spec, NULL, s->log);
        if (!status)
            status = relume_rig_set(s->rig, first + i, e, s->log);
    }
    return status;
}

relume_status session_append_lights(struct session *s, struct app_state *to, const relume_rig *rig)
{
    const int first = relume_rig_count(s->rig);
    const relume_status status = add_rig(s, rig);
    return status ? status : append_entries(s, to, first);
}

// Its files stay with the session's own rig, which lights that were there before still need.
relume_status session_load_rig(struct session *s, const char *path)
{
    struct app_state *now = &s->app.now;
    const int first = relume_rig_count(s->rig);
    struct relume_log saves = *s->log;
    saves.leave_unnoted = true;  // lights may be saved where they came from
    relume_rig *loaded;
    relume_status status = relume_rig_load(&loaded, path, &saves);
    if (!status)
        status = add_rig(s, loaded);
    if (!status)
        status = check_near(s, first);
    if (!status && relume_rig_count(loaded) > APP_LIGHTS)
        status = too_many(s);
    if (!status && relume_rig_count(loaded) > 0) {
        now->lights = 0;
        status = append_entries(s, now, first);
        now->selected = 0;
    }
    relume_rig_destroy(&loaded);
    return status;
}

// Any light of that kind; the numbers follow.
static const char *words_of(enum relume_light_kind kind)
{
    switch (kind) {
    case RELUME_LIGHT_POINT: return "point 0 0 1";
    case RELUME_LIGHT_SPOT: return "spot 0 0 1 0 0 -1 25";
    case RELUME_LIGHT_AREA: return "area 0 0 1 1 0 0 0 1 0";
    default: return "dir 0 0 1";
    }
}

static relume_status store_light(const struct session *s, relume_rig *rig, int light)
{
    const struct app_light_state *state = &s->app.now.light_state[light];
    const struct relume_light *l = &s->app.now.light[light];
    const struct relume_rig_entry *from =
        state->entry >= 0 ? relume_rig_entry(s->rig, state->entry) : NULL;
    relume_status status = relume_rig_add(rig, from ? from->spec : words_of(l->kind), NULL, s->log);
    if (status)
        return status;
    struct relume_rig_entry e = *relume_rig_entry(rig, light);
    e.on = !state->off;
    e.solo = state->solo;
    e.intensity = exp2(state->stops);
    e.name = from ? from->name : e.name;
    e.light = *l;
    return relume_rig_set(rig, light, &e, s->log);
}

relume_status session_rig(relume_rig **out, const struct session *s)
{
    relume_status status = relume_rig_create(out);
    for (int i = 0; !status && i < s->app.now.lights; i++)
        status = store_light(s, *out, i);
    if (status)
        relume_rig_destroy(out);
    return status;
}

relume_status session_save_rig(struct session *s, const char *path)
{
    relume_rig *rig;
    relume_status status = session_rig(&rig, s);
    if (!status)
        status = relume_rig_save(rig, path, s->log);
    relume_rig_destroy(&rig);
    return status;
}
