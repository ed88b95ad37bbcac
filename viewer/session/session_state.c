// session_state.c - how the file is seen now, in the line that pages and the tool read (--state)
#include "session/session.h"

#include "cli/program/state_line.h"

#include <relume/relight/tone.h>
#include <relume/rig.h>

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

struct line {
    char *text;
    size_t size;
    bool fits;
};

__attribute__((format(printf, 3, 4))) static void add(struct line *l, const char *name,
                                                      const char *format, ...)
{
    char value[APP_SPEC];
    va_list list;
    va_start(list, format);
    const int n = vsnprintf(value, sizeof value, format, list);
    va_end(list);
    l->fits = l->fits && n >= 0 && (size_t)n < sizeof value &&
              state_line_add(l->text, l->size, name, value);
}

static void add_point(struct line *l, const char *name, struct relume_vec3 p)
{
    add(l, name, "%.6g %.6g %.6g", p.x, p.y, p.z);
}

static void add_camera(struct line *l, const struct app *app)
{
    static const struct relume_vec3 none;
    const struct relume_camera *c = &app->now.camera;
    const struct relume_look_at *at = &c->look_at;
    switch (c->framing) {
    case RELUME_FRAME_VIEW:
        if (app->file.views > 1 || app->file.geometry.projection != RELUME_PLANAR)
            add(l, "view", "%d", c->view);
        break;
    case RELUME_FRAME_EYE:
        add_point(l, "eye", c->eye);
        if (at->aimed)
            add_point(l, "look-at", at->at);
        if (memcmp(&at->up, &none, sizeof none) != 0)
            add_point(l, "up", at->up);
        if (at->field_of_view_deg > 0.0)
            add(l, "fov", "%.6g", at->field_of_view_deg);
        break;
    case RELUME_FRAME_LOOK:
        add(l, "pan", "%.6g", c->look.pan_deg);
        add(l, "tilt", "%.6g", c->look.tilt_deg);
        add(l, "zoom", "%.6g", c->look.zoom);
        if (c->look.stereographic)
            add(l, "projection", "stereographic");
        break;
    case RELUME_FRAME_DEFAULT: break;
    }
}

static void add_number(struct line *l, const char *name, double value)
{
    if (value != 0.0)
        add(l, name, "%.6g", value);
}

static void add_pass(struct line *l, const struct app_state *now)
{
    const struct relume_pass_params *p = &now->enhance;
    if (now->pass == RELUME_PASS_COLOUR)
        return;
    add(l, "pass", "%s", relume_pass_name(now->pass));
    if (now->pass == RELUME_PASS_DIFFUSE_GAIN || now->pass == RELUME_PASS_UNSHARP)
        add_number(l, "gain", p->gain);
    if (now->pass == RELUME_PASS_SPECULAR) {
        add_number(l, "highlight", p->specular);
        add_number(l, "exponent", p->exponent);
    }
    if (now->pass == RELUME_PASS_UNSHARP)
        add_number(l, "radius", p->radius);
    if (now->pass == RELUME_PASS_FALSE_COLOUR && p->top > p->low)
        add(l, "range", "%.6g %.6g", p->low, p->top);
}

// Colours with the stops of the viewer in them; lights that do not shine stay away.
static relume_status add_lights(struct line *l, struct session *s)
{
    relume_rig *rig;
    bool solo = false;
    const relume_status status = session_rig(&rig, s);
    for (int i = 0; !status && i < relume_rig_count(rig); i++)
        solo = solo || (relume_rig_entry(rig, i)->on && relume_rig_entry(rig, i)->solo);
    for (int i = 0; !status && i < relume_rig_count(rig); i++) {
        const struct relume_rig_entry *e = relume_rig_entry(rig, i);
        double rgb[3];
        for (int c = 0; c < 3; c++)
            rgb[c] = e->intensity * (double)e->light.rgb[c];
        if (!e->on || (solo && !e->solo))
            continue;
        if (rgb[0] == 1.0 && rgb[1] == 1.0 && rgb[2] == 1.0)
            add(l, "light", "%s", e->spec);
        else
            add(l, "light", "%s rgb %.6g %.6g %.6g", e->spec, rgb[0], rgb[1], rgb[2]);
    }
    relume_rig_destroy(&rig);
    return status;
}

relume_status session_state_line(char *text, size_t size, struct session *s)
{
    static const char *const interpolations[] = {[RELUME_INTERPOLATE_CONSTANT] = "constant",
                                                 [RELUME_INTERPOLATE_LINEAR] = "linear",
                                                 [RELUME_INTERPOLATE_DEPTH] = "depth"};
    const struct app_state *now = &s->app.now;
    struct line l = {text, size, true};
    *text = '\0';
    add_camera(&l, &s->app);
    const relume_status status = add_lights(&l, s);
    if (now->interpolation != RELUME_INTERPOLATE_DEFAULT)
        add(&l, "interpolate", "%s", interpolations[now->interpolation]);
    add_number(&l, "aperture", now->aperture);
    if (now->focused)
        add(&l, "focus", "%.6g", now->focus_z);
    if (now->auto_exposure)
        add(&l, "exposure", "auto");
    else
        add_number(&l, "exposure", now->exposure_ev);
    if (now->tone)
        add(&l, "tone", "%s", relume_tones[now->tone]->name);
    if (now->white != RELUME_TONE_WHITE)
        add_number(&l, "white", now->white);
    add_pass(&l, now);
    return status ? status : l.fits ? RELUME_OK : RELUME_ELIMIT;
}
