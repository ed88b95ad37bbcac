// panel.h - the panel and what is drawn over the picture: lists, sliders, handles, help
//
// Made with Dear ImGui in panel*.cpp, the only C++ of the viewer. It knows neither windows nor
// OpenGL: events of the app go in, triangles come out, and draw_panel draws them.
#ifndef VIEWER_PANEL_H
#define VIEWER_PANEL_H

#ifdef __cplusplus
extern "C" {
#endif

#include "panel/panel_facts.h"

// Thread-safety: main thread only.
struct panel;

// `scale`: pixels per unit of the desktop, 1 on ordinary screens. `font`: a TrueType file, read
// here; NULL, or one that cannot be used: the letters that Dear ImGui brings, ASCII alone.
// RELUME_ENOMEM.
#define PANEL_SCALE_LEAST 0.5
#define PANEL_SCALE_MOST  4.0
relume_status panel_create(struct panel **out, double scale, const char *font);
void panel_destroy(struct panel **panel);
// Whether the letters are those of `font`.
bool panel_has_font(const struct panel *panel);

// Hear of an event. True when it belongs to the panel, and the app must not have it. What follows a
// press belongs to who got the press.
bool panel_takes(struct panel *panel, const struct app_event *event);
// Whether any of it is visible.
bool panel_shown(const struct app *app);

// Work through the events and make the triangles of the frame; changes `app` as the user asks.
// Returns whether the picture changed.
bool panel_build(struct panel *panel, struct app *app, const struct panel_facts *facts);
// Pixels that the panel takes beside the frame.
int panel_width(const struct panel *panel);
// Whether the histogram is open, and worth making.
bool panel_wants_histogram(const struct panel *panel);
// Whether maps are being chosen from.
bool panel_wants_maps(const struct panel *panel);
// Whether the pointer is on a control that does not say what it is for: none should be.
bool panel_is_mute(const struct panel *panel);

// The letters, one byte a pixel, to be made a texture.
struct panel_letters {
    const unsigned char *alpha;
    int width, height;
};
struct panel_letters panel_font(const struct panel *panel);

// Run `i` of the frame, false behind the last. Valid until the next panel_build.
bool panel_run_at(struct panel_run *out, const struct panel *panel, int i);

#ifdef __cplusplus
}
#endif
#endif
