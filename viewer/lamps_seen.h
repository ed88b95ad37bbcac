// lamps_seen.h - the lights that are in view, as small sources that send the eye what lights send
//
// A light of value E at the eye (light.h) sends it pi E, which a pixel of solid angle w shows as
// pi E / w. Panels of light are spread over as many pieces. The surface hides what lies behind it,
// as the nearest view knows it.
#ifndef VIEWER_LAMPS_SEEN_H
#define VIEWER_LAMPS_SEEN_H

#include "app.h"
#include "loader.h"

enum { LAMPS_SEEN_MOST = 8192 };

struct lamp_seen {
    double x, y;   // pixels of the frame
    float rgb[3];  // the sum over its pixels
};

// Where views stand, and where their pixels lie. `source` and `uv` must outlive it.
struct lamp_scene {
    struct code_source source;
    const double (*uv)[2];  // [views], of a slab
    int views;
    int view;  // that `surface` is of
    bool known;
    struct relume_image surface;  // no data: nothing is known of the view
};
void lamp_scene_forget(struct lamp_scene *scene);

// The sources among `n` lights, at most LAMPS_SEEN_MOST; returns how many. Without `scene` nothing
// is hidden.
int lamps_seen(struct lamp_seen *out, const struct app *app, const struct relume_light *lights,
               int n, struct lamp_scene *scene);

#endif
