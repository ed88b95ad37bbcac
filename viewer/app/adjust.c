// adjust.c - numbers that sliders change, by name: `set NAME VALUE` of scripts
#include "app/adjust.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 3 };  // values of one name

static bool set_gain(struct app_state *s, const double *v)
{
    s->enhance.gain = (float)v[0];
    return true;
}

static bool set_highlight(struct app_state *s, const double *v)
{
    s->enhance.specular = (float)v[0];
    return true;
}

static bool set_exponent(struct app_state *s, const double *v)
{
    s->enhance.exponent = (float)v[0];
    return true;
}

static bool set_radius(struct app_state *s, const double *v)
{
    s->enhance.radius = (int)v[0];
    return v[0] == floor(v[0]);
}

static bool set_range(struct app_state *s, const double *v)
{
    s->enhance.low = (float)v[0];
    s->enhance.top = (float)v[1];
    return v[0] < v[1] || (v[0] == 0 && v[1] == 0);
}

static bool set_exposure(struct app_state *s, const double *v)
{
    s->exposure_ev = v[0];
    return true;
}

static bool set_eye(struct app_state *s, const double *v)
{
    s->camera.eye = (struct relume_vec3){v[0], v[1], v[2]};
    return s->camera.framing == RELUME_FRAME_EYE;
}

static bool set_aperture(struct app_state *s, const double *v)
{
    s->aperture = v[0];
    return s->camera.framing == RELUME_FRAME_EYE;
}

static bool set_focus(struct app_state *s, const double *v)
{
    s->focus_z = v[0];
    return s->camera.framing == RELUME_FRAME_EYE;
}

static bool set_pan(struct app_state *s, const double *v)
{
    s->camera.look.pan_deg = v[0];
    return s->camera.framing == RELUME_FRAME_LOOK;
}

static bool set_tilt(struct app_state *s, const double *v)
{
    s->camera.look.tilt_deg = v[0];
    return s->camera.framing == RELUME_FRAME_LOOK;
}

static bool set_zoom(struct app_state *s, const double *v)
{
    if (s->camera.framing == RELUME_FRAME_LOOK)
        s->camera.look.zoom = v[0];
    else
        s->zoom = v[0];
    return true;
}

static const struct adjustment {
    const char *name;
    int count;
    double least, most;
    const char *expected;
    bool (*set)(struct app_state *s, const double *values);
} adjustments[] = {
    {"gain", 1, 1, 20, "gain G, from 1 to 20", set_gain},
    {"highlight", 1, 0.01, 10, "highlight V, from 0.01 to 10", set_highlight},
    {"exponent", 1, 1, 1000, "exponent N, from 1 to 1000", set_exponent},
    {"radius", 1, 1, 64, "radius PIXELS, a whole number from 1 to 64", set_radius},
    {"range", 2, 0, 1e6, "range LOW HIGH, or 0 0: from the picture", set_range},
    {"exposure", 1, -100, 100, "exposure EV, from -100 to 100", set_exposure},
    {"eye", 3, -1e9, 1e9, "eye X Y Z, of a slab", set_eye},
    {"aperture", 1, 0, 1e9, "aperture A, of a slab", set_aperture},
    {"focus", 1, -1e9, 1e9, "focus Z, of a slab", set_focus},
    {"pan", 1, -36000, 36000, "pan DEG, of a panorama", set_pan},
    {"tilt", 1, -90, 90, "tilt DEG from -90 to 90, of a panorama", set_tilt},
    {"zoom", 1, 0.01, 1000, "zoom F, from 0.01 to 1000", set_zoom},
};

static bool read_values(const struct adjustment *a, const char *text, double values[MOST])
{
    for (int i = 0; i < a->count; i++) {
        char *end;
        values[i] = strtod(text, &end);
        if (end == text || !(values[i] >= a->least && values[i] <= a->most))
            return false;
        text = end;
    }
    return text[strspn(text, " \t")] == '\0';
}

bool adjust_say(struct app_state *state, const char *words, const char **expected)
{
    words += strspn(words, " \t");
    const size_t length = strcspn(words, " \t");
    *expected =
        "gain, highlight, exponent, radius, range, exposure, eye, aperture, focus, pan, tilt "
        "or zoom, then its value";
    for (size_t i = 0; i < sizeof adjustments / sizeof *adjustments; i++) {
        const struct adjustment *a = &adjustments[i];
        struct app_state next = *state;
        double values[MOST];
        if (strlen(a->name) != length || strncmp(a->name, words, length))
            continue;
        *expected = a->expected;
        if (!read_values(a, words + length, values) || !a->set(&next, values))
            return false;
        *state = next;  // the lists of lights are the same
        return true;
    }
    return false;
}
