// panel_facts.h - what goes into the panel and comes out of it: facts in, triangles out
#ifndef VIEWER_PANEL_FACTS_H
#define VIEWER_PANEL_FACTS_H

#ifdef __cplusplus
extern "C" {
#endif

#include "app/app.h"
#include "panel/browse.h"

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
    const char *ways[2];      // how far each way of light is, or NULL
    const char *edits;        // of the g-BRDF or maps shown, one a line; NULL: none can be ...
    bool edits_maps;          // ... of maps ...
    int edited_materials;     // ... and how many materials a g-BRDF has
    const char *reflections;  // the file to save edited reflections to; NULL: there is no mirror
    const char *eye;          // what is known of the eye that looks, or NULL
    float range[2];           // of false colour, as it was drawn last
    const struct browser *browser;  // to choose a file from, or NULL
    const char *recording;          // where pictures go, or NULL ...
    double recorded_s, round_s;     // ... how many seconds of them there are, and will be
};

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

#ifdef __cplusplus
}
#endif
#endif
