// panel_parts.h - what the files of the panel share; only they know Dear ImGui
#ifndef VIEWER_PANEL_PARTS_H
#define VIEWER_PANEL_PARTS_H

#include "panel/panel_facts.h"

extern "C" {
#include "app/gizmo.h"
#include "app/keys.h"
#include "app/light_list.h"
#include "app/way.h"
}

#include <imgui.h>

#include <functional>
#include <string>
#include <vector>

// The next edit of a material, as it is being chosen. Labels are counted from 1; 0: all.
struct panel_edit {
    int operation;  // among those that can be done
    char drawing[1024], mask[1024], folder[1024];
    double height = 0.02, at[2] = {0.5, 0.5}, size = 1;
    double factor = 1, degrees = 90, roughness = 0.5, r0 = 0.04;
    float factors[3] = {1, 1, 1}, highlight[3] = {1, 1, 1}, colour[3] = {0.5f, 0.5f, 0.5f};
    bool coloured;  // by `colour`
    int order;      // of channels
    int label, labels[2] = {1, 2};
};

struct panel {
    ImGuiContext *context;
    float scale;
    bool has_font;
    std::vector<app_event> queue;
    bool held;         // a press belongs to the panel
    bool held_by_app;  // or to the app
    bool histogram;    // is open
    bool maps;         // the list of environment maps is open
    bool browsing;     // a file is being chosen
    bool changed;      // the picture, by what the user did in this frame
    char spec[APP_SPEC];
    char environment[APP_SPEC];
    std::vector<panel_run> runs;
    char path[APP_SPEC];  // of a file to open
    std::string browsed;  // the folder that it is in
    int listed;           // the light that the list has scrolled to
    panel_edit edit;
    char reflections[APP_SPEC];  // the file to save them to
    char note[4096];             // the text of a note ...
    int noted = -1;              // ... of this number
    double ruler_mm = 10;        // of the line that sets the scale
};

// The letters of the panel, from a file (false: it is no font that can be read) or without one.
bool panel_add_font(const char *path, float scale);
void panel_add_plain_font(float scale);

// Controls: `what` each is for is said while the pointer is on it, and panel_tip says it of the
// last one of any other kind. They return whether the user changed the value, or pressed.
void panel_tip(const char *what);
bool panel_button(const char *label, const char *what);
bool panel_box(const char *label, bool *on, const char *what);
bool panel_slider(const char *label, double *value, double least, double most, const char *format,
                  const char *what, ImGuiSliderFlags flags = 0);
// One of `count` by their names, which must outlast the call of `name` alone.
bool panel_choice(const char *label, int *chosen, int count,
                  const std::function<const char *(int)> &name, const char *what);

// Sections of the panel: what they return is whether the picture changed.
bool panel_lights(panel *panel, app *app, const panel_facts *facts);
bool panel_picture(app *app, const panel_facts *facts);
bool panel_enhancement(app *app, const panel_facts *facts);
bool panel_camera(app *app);
bool panel_glare(app *app, const panel_facts *facts);
bool panel_objects(app *app, const panel_facts *facts);
bool panel_ways(app *app, const panel_facts *facts);
void panel_reflections(panel *panel, app *app, const panel_facts *facts);
bool panel_jottings(panel *panel, app *app);
void panel_edits(panel *panel, app *app, const panel_facts *facts);
void panel_histogram(const panel_facts *facts, float scale);
void panel_file(app *app, const panel_facts *facts);

// What is drawn over the picture.
void panel_help(const app *app, float scale);
void panel_notes(const app *app, const panel_facts *facts, float scale);
void panel_question(app *app, float scale);
void panel_start(app *app, float scale);
void panel_browse(panel *panel, app *app, const browser *b);
// The middle of the frame, in pixels of the window: across, down.
ImVec2 panel_frame_point(const app *app, float across, float down);
void panel_handles(const app *app, float scale);
void panel_reflection_handles(const app *app, float scale);
void panel_jotted(const app *app, float scale);
void panel_inspector(const app *app, const panel_facts *facts, float scale);

// The colour of a light's mark on discs of directions.
ImU32 panel_mark_colour(const relume_light &light, bool behind);

#endif
