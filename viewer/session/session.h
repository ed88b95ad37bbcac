// session.h - an open file, what is drawn of it, and the panel over it
#ifndef VIEWER_SESSION_H
#define VIEWER_SESSION_H

#include "draw/gl_renderer.h"
#include "panel/draw_panel.h"
#include "relit/pack_source.h"
#include "session/inspect.h"
#include "session/environment_list.h"
#include "cli/program/film.h"
#include "session/record.h"
#include "window/context.h"

#include <relume/material/edit.h>
#include <relume/material/maps.h>
#include <relume/pack.h>
#include <relume/rig.h>
#include <relume/world/object.h>

enum { SESSION_LINES = 10, SESSION_TEXT = 256 };

// What relights views; the library does where OpenGL is software.
enum session_relight { SESSION_AUTO, SESSION_PASSES, SESSION_LIBRARY };

// Pictures that are being recorded, one a frame.
struct recording {
    struct film *film;  // NULL: none
    enum record_kind kind;
    int frame, frames;
    int posed;  // the frame that was drawn last: a picture that is drawn again is no later
    struct app_state before;  // the recording
    char path[SESSION_TEXT + 16];
};

// Objects that are asked for: a description, or materials on a mesh (NULL: on a cushion).
enum { SESSION_MATERIALS = 32 };
struct session_objects {
    const char *description, *mesh, *reflections;  // NULL: none
    const char *material[SESSION_MATERIALS];
    int materials;
    double repeat;  // 0: 1
};

struct session {
    const struct context_backend *backend;
    void *context;
    struct gl gl;
    relume_pack *pack;              // NULL: there are objects alone, on a stage
    relume_objects *objects;        // or NULL
    struct session_objects wanted;  // that it was started with; its mesh may be shown otherwise
    char material[APP_SPEC];        // the file of the only one, "": there is none, or more
    char described[APP_SPEC];       // the file that describes the objects, "": none
    char reflections[APP_SPEC];     // of their edits, "": none yet
    struct relume_maps found;       // a folder of maps as edited; empty: none is shown
    char found_path[APP_SPEC];      // it
    char edits[1024];               // of material or maps (session_can_edit), for the panel
    int edited_materials;           // that it has with them
    bool scene;                     // it is a scene file, on a stage
    relume_slab_set *stage;         // what the eye goes around there
    relume_slab_set *around;        // of it, where there are several
    struct pack_source *source;     // of it, for the renderer and its threads
    relume_capture *capture;        // of the file, to compare with, or NULL
    relume_rig *rig;                // owns what lights point at; the app's list says what shines
    struct app app;
    struct gl_renderer renderer;
    struct frame_request request;  // of the frame drawn last
    struct panel *panel;
    struct panel_drawing drawing;
    struct maps maps;            // to choose from, while the panel does
    struct browser browser;      // the folder that was listed last
    struct inspector inspector;  // made when first asked for
    struct recording recording;
    struct film *film;     // of a script as it is played, or NULL
    struct target screen;  // of shots without a window
    float histogram[256][3];
    char name[SESSION_TEXT];                   // of the file, for the title
    char file[APP_SPEC];                       // as it was opened ...
    bool sphere;                               // ... as a panorama
    char folder[APP_SPEC];                     // that it is in
    size_t material_bytes[SESSION_MATERIALS];  // of graphics memory
    char line[SESSION_LINES][SESSION_TEXT];
    char way[EXCHANGER_SLOTS][SESSION_TEXT];  // how far their pictures are
    const char *lines[SESSION_LINES + 1];     // what the panel says of the file
    char message[SESSION_TEXT];               // what was said last
    bool full_screen;
    double ui_scale;            // of the panel, as context_backend.scale; 0: what that says
    char font[PATH_MAX];        // of the panel
    bool font_warned;           // that it is missing
    bool beside_warned;         // that the eye stands beside all camera grids of this file
    char notice[SESSION_TEXT];  // by the log while a file was opened
    bool listens;               // to it
    int threads;                // that read files
    size_t vram_bytes;          // for views
    enum session_relight relight;
    enum session_relight glare;            // by passes or by the library, likewise
    int glare_size;                        // as glare.size
    const struct relume_subject *subject;  // whose eye looks; NULL: the default one
    bool finishes;                         // draws a picture that is kept
    bool streams;                          // frames are drawn with the views that are there
    const struct relume_log *log;          // lasts as long: files and renderers keep it
    const struct relume_log *listener;     // hears what `log` would say, for a while; or NULL
};

// Say it in the panel and, for a while, over the picture.
void session_say(struct session *s, const char *format, ...) __attribute__((format(printf, 2, 3)));

// Open `path`, also a description of objects, or a material for the mesh that was asked for or a
// cushion, and
// start the app; the session is untouched when that fails.
relume_status session_open(struct session *s, const char *path, const struct app_state *start,
                           bool look_ahead);
// A capture to compare the file with, before session_open. An input status, RELUME_ENOMEM.
relume_status session_compare(struct session *s, const char *capture);
// Objects to show, before session_open: in the scene of the file, or alone when its path is NULL.
// What relume_objects_open says.
relume_status session_take_objects(struct session *s, const struct session_objects *wanted);
// For session_open: what is no relume file, and objects on a stage of their own in place of what is
// shown.
bool session_is_objects(const char *path);
// Whether it is a material: relume_kind_of.
bool session_is_material(const char *path);
// Whether it is, by its name, a description of objects: a .json that is nothing else.
bool session_is_description(const char *path);
relume_status session_open_objects(struct session *s, const char *path,
                                   const struct app_state *start);
void session_close_file(struct session *s);
// For session_open: no file, but a page that says how to open one.
relume_status session_open_nothing(struct session *s, const struct app_state *start);
// For session_open: the app of a stage.
relume_status session_open_stage(struct session *s, const struct app_state *start);
// For session_open: a folder of maps (docs/maps.md), as the edits that are kept with it make them.
// Errors of relume_maps_open, relume_edits_open, relume_maps_edit; RELUME_EUNFIT.
bool session_is_maps(const char *path);
relume_status session_open_maps(struct session *s, const char *path, const struct app_state *start);
// The renderer of one. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status session_make_maps(struct session *s);
// For session_open: a scene file (relume/world/tableau.h), under its own lights where none are
// named. RELUME_EINVAL with a sentence, errors of relume_tableau_open. Then the renderer of one.
bool session_is_scene(const char *path);
relume_status session_open_scene(struct session *s, const char *path,
                                 const struct app_state *start);
relume_status session_make_scene(struct session *s);
// The name of what is shown, for the title.
void session_set_name(struct session *s, const char *path);
// The renderer of a stage, and objects in the renderer of a file. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status session_make_stage(struct session *s);
relume_status session_add_objects(struct session *s);
// Light between them and the scene, from session_add_objects on; what is said of a way that was
// chosen, where it was another one `before`; what the panel says of the pictures.
void session_add_ways(struct session *s);
void session_hear_ways(struct session *s, const struct app_state *before);
void session_describe_ways(struct session *s);
// Get OpenGL and make what draws. RELUME_ESYSTEM, RELUME_ENOMEM, an input status.
relume_status session_start(struct session *s, const struct context_backend *backend, int width,
                            int height);
// Letters and margins of the panel for another screen: `scale` as context_backend.scale.
// RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status session_scale(struct session *s, double scale);
// Show another file in the same window; one that cannot be opened is only complained about.
relume_status session_drop(struct session *s, const char *path);
// The same, and then an input status.
relume_status session_show(struct session *s, const char *path);
void session_close(struct session *s);

// The panel as its events have changed the app, with the histogram of the last frame or without;
// the same once more, with it, where the panel shows one. RELUME_ENOMEM, an input status.
relume_status session_build_panel(struct session *s, bool histogram);
relume_status session_add_histogram(struct session *s);
// Hand an event to the panel, else to the app; returns whether something may look different.
bool session_send(struct session *s, const struct app_event *event);
// Draw the frame, linear, with the panel as its events have changed the app, and do what was
// wished.
relume_status session_draw(struct session *s);
// Only the picture, without what session_draw does besides.
relume_status session_render(struct session *session);
// The frame and the panel onto a framebuffer of its size (0: the screen).
void session_present(struct session *s, GLuint framebuffer);
// Do what the app wishes for, once. What fails is said in the panel and the log, and is no error.
relume_status session_grant_wish(struct session *s);

// A wish or a recording waits for session_draw.
bool session_is_busy(const struct session *s);

// Let time pass for what moves by itself; returns whether the picture changed.
bool session_pass(struct session *s, double seconds);

// Draw and write: the picture alone, or as the screen would show it.
relume_status session_frame(struct session *s, const char *path);
relume_status session_shot(struct session *s, const char *path);

// The last frame; `linear` or by the app's tone. RELUME_EUNFIT when the eye sees nothing.
relume_status session_read(struct relume_image *image, struct session *s, bool linear);

// Record a round of `frames` pictures: session_draw draws and adds one at a time, and the app is as
// before afterwards. Until then events wait, but for Esc and a new size of the frame, which end the
// recording with what there is of it. Errors of film.h.
relume_status session_record_begin(struct session *s, enum record_kind kind, const char *path,
                                   int frames);
// A picture into a film. Destroys it; RELUME_ECANCEL: somebody asked to stop.
relume_status session_film_add(struct session *s, struct film *film, struct relume_image *image);
bool session_records(const struct session *s);
// A picture of the screen into s->film.
relume_status session_film(struct session *s);
// The next picture. On failure nothing is recorded any more, and nothing is left of it.
relume_status session_record_step(struct session *s);
void session_record_stop(struct session *s);
// All of it at once. Errors of film.h and session_draw.
relume_status session_record(struct session *s, enum record_kind kind, const char *path,
                             int frames);

// List a folder to choose a file from; "": the one that was listed last, else that of the file.
// RELUME_ENOMEM.
relume_status session_browse(struct session *s, const char *folder);

// A light from words, in place of all or beside them. RELUME_EINVAL, an input status with a
// sentence.
relume_status session_light(struct session *s, const char *spec, bool replace);
// The environment map `path` in place of the selected light's, else as one more light. The same.
relume_status session_map(struct session *s, const char *path);
// The file of the selected environment, else NULL.
const char *session_map_in_use(const struct session *s);
// Whether a g-BRDF is shown alone, or a folder of maps, which can be edited.
bool session_can_edit(const struct session *s);
// "undo", "redo" or an operation of relume/material/edit.h: "OPERATION VALUE [PARAMETER VALUE
// ...]", quotes around what holds blanks. It is kept beside the file, and shown. RELUME_EINVAL,
// RELUME_EUNFIT, an input status with a sentence.
relume_status session_edit(struct session *s, const char *words, const struct relume_log *log);
// The same of maps; "write DIR" writes them as they are now (relume_maps_write).
relume_status session_edit_maps(struct session *s, const char *words, const struct relume_log *log);
// Change a list as words say; cuts them up. RELUME_EINVAL with a sentence, an input status.
relume_status session_change_edits(relume_edits *edits, char *words, const struct relume_log *log);
// A name without the quotes around it, which are cut off in place.
const char *session_unquote(char *name);
// What the panel shows of a list.
void session_describe_edits(struct session *s, const relume_edits *edits);
// An edit of what mirrors reflect: words of handles_say, or "save [FILE]". Statuses of handles_say,
// relume_objects_save_reflections.
relume_status session_reflect(struct session *s, const char *words, const struct relume_log *log);
// Before the mouse: the handles know the scene.
void session_lend_scene(struct session *s);
// After it: what they had to say is said in the panel.
void session_hear_handles(struct session *s);
// The file that edits are saved to when nobody names another.
void session_name_reflections(char path[APP_SPEC], const struct session *s);
// What the panel says of edits; for session_open_stage.
void session_list_edits(struct session *s);

// The lights of a rig file in place of all; the present ones as a rig file.
relume_status session_load_rig(struct session *s, const char *path);
relume_status session_save_rig(struct session *s, const char *path);
// They as a rig, which the caller destroys. RELUME_ENOMEM.
relume_status session_rig(relume_rig **out, const struct session *s);
// How the file is seen now, as `--state` and the pages read it (cli/program/state_line.h);
// RELUME_ELIMIT when it does not fit, RELUME_ENOMEM.
relume_status session_state_line(char *text, size_t size, struct session *s);

// Notes on the file: shown, or no longer; what is drawn becomes one, or this view; the list goes to
// disk; back to the state of the chosen one. What goes wrong is said. RELUME_ENOMEM.
relume_status session_notes_show(struct session *s);
relume_status session_notes_add(struct session *s);
relume_status session_notes_save(struct session *s);
relume_status session_notes_back(struct session *s);

// Begin with the lights of `rig`, which becomes the session's; NULL: none. RELUME_EINVAL when there
// are more than APP_LIGHTS, RELUME_ENOMEM.
relume_status session_take_rig(struct session *s, relume_rig **rig, struct app_state *start);
// The lights of a rig at the end of a list; their files belong to the session. The same errors.
relume_status session_append_lights(struct session *s, struct app_state *to, const relume_rig *rig);

#endif
