// panel.h - the panel and what is drawn over the picture: lists, sliders, handles, help
//
// Made with Dear ImGui in panel*.cpp, the only C++ of the viewer. It knows neither windows nor
// OpenGL: events of the app go in, triangles come out, and draw_panel draws them.
#ifndef VIEWER_PANEL_H
#define VIEWER_PANEL_H

#ifdef __cplusplus
extern "C" {
#endif

#include "app/app.h"
#include "panel/browse.h"

// Thread-safety: main thread only.
struct panel;

// `scale`: pixels per unit of the desktop, 1 on ordinary screens. RELUME_ENOMEM.
relume_status panel_create(struct panel **out, double scale);
void panel_destroy(struct panel **panel);

// Hear of an event. True when it belongs to the panel, and the app must not have it. What follows a
// press belongs to who got the press.
bool panel_takes(struct panel *panel, const struct app_event *event);
// Whether something of it is to be seen.
bool panel_shown(const struct app *app);

// What the panel shows and the app does not know.
struct panel_facts {
    const char *file;                 // its name
    const char *const *line;          // what is known of the file, ends with NULL
    const char *message;              // the last thing said to the user, or NULL
    const float (*histogram)[3];      // [256] of display values, as high as they are drawn, 0 to
                                      // 1; NULL: none
    const struct relume_image *plot;  // of the inspector, drawn as PANEL_PLOT; NULL: none
    const char *plot_text;
    const char *map_folder;  // of environment maps to choose from, or NULL
    const char *const *map;  // their names, ends with NULL
    const char *map_in_use;  // of the selected light, or NULL
    // Of objects, else NULL: the graphics memory of each of their first `materials` materials, 0
    // where it was not shown, and the time that both halves of the last frame took.
    const size_t *material_bytes;
    int materials;
    const double *objects_ms;
    const char *eye;                // what is known of the eye that looks, or NULL
    float range[2];                 // of false colour, as it was drawn last
    const struct browser *browser;  // to choose a file from, or NULL
    const char *recording;          // where pictures go, or NULL ...
    double recorded_s, round_s;     // ... how many seconds of them there are, and will be
};
// Work through the events and make the triangles of the frame; changes `app` as the user asks.
// Returns whether the picture changed.
bool panel_build(struct panel *panel, struct app *app, const struct panel_facts *facts);
// Pixels that the panel takes beside the frame.
int panel_width(const struct panel *panel);
// Whether the histogram is open, and worth making.
bool panel_wants_histogram(const struct panel *panel);
// Whether maps are being chosen from.
bool panel_wants_maps(const struct panel *panel);

// The letters, one byte a pixel, to be made a texture.
struct panel_letters {
    const unsigned char *alpha;
    int width, height;
};
struct panel_letters panel_font(const struct panel *panel);

struct panel_vertex {
    float x, y;  // pixels of the frame
    float u, v;
    unsigned char rgba[4];  // as the screen shows it
};
enum panel_texture { PANEL_LETTERS = 1, PANEL_PLOT };
// Triangles of one texture within one rectangle: left, top, right, bottom.
struct panel_run {
    const struct panel_vertex *vertex;
    const unsigned short *index;
    int vertices, indices;
    int first, count;  // of `index`
    float clip[4];
    enum panel_texture texture;
};
// Run `i` of the frame, false behind the last. Valid until the next panel_build.
bool panel_run_at(struct panel_run *out, const struct panel *panel, int i);

#ifdef __cplusplus
}
#endif
#endif
