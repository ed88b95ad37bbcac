// session.h - an open file, what is drawn of it, and the panel over it
#ifndef VIEWER_SESSION_H
#define VIEWER_SESSION_H

#include "cli/program/film.h"
#include "draw/gl_renderer.h"
#include "session/document.h"
#include "session/record.h"
#include "session/session_messages.h"
#include "session/session_panel.h"
#include "session/session_window.h"

#include <relume/rig.h>

// What relights views; the library does where OpenGL is software.
enum session_relight { SESSION_AUTO, SESSION_PASSES, SESSION_LIBRARY };

// Options that hold for every document.
struct session_settings {
    int threads;                           // that read files; 0: all cores
    size_t vram_bytes;                     // for views
    enum session_relight relight, glare;   // on the GPU or by the library
    int glare_size;                        // as glare.size
    const struct relume_subject *subject;  // whose eye looks; NULL: the default one
    double ui_scale;  // of the panel, as context_backend.scale; 0: what that says
};

// Pictures that are being recorded, one a frame.
struct recording {
    struct film *film;  // NULL: none
    enum record_kind kind;
    int frame, frames;
    int posed;  // the frame that was drawn last: a picture that is drawn again is no later
    struct app_state before;  // the recording
    char path[SESSION_TEXT + 16];
};

struct session {
    struct session_settings settings;
    const struct relume_log *log;  // lasts as long: files and renderers keep it
    struct session_messages messages;
    struct document document;
    struct object_set objects;
    relume_capture *capture;  // of the file, to compare with, or NULL
    relume_rig *rig;          // owns what lights point at; the app's list says what shines
    struct app app;
    struct session_window window;
    struct gl_renderer renderer;
    struct frame_request request;  // of the frame drawn last
    struct session_panel panel;
    struct recording recording;
    struct film *film;  // of a script as it is played, or NULL
    bool finishes;      // draws a picture that is kept
    bool streams;       // frames are drawn with the views that are there
};

// Say it in the panel and, for a while, over the picture.
void session_say(struct session *s, const char *format, ...) __attribute__((format(printf, 2, 3)));

// Opens `path`, or the objects that were asked for where it is NULL, as the kind of document that
// it is, and starts the app. The session is untouched when that fails, with the errors of
// document_kind.open.
relume_status session_open(struct session *s, const char *path, const struct app_state *start,
                           bool look_ahead);
// Opens a capture to compare the file with, before session_open. An input status, RELUME_ENOMEM.
relume_status session_compare(struct session *s, const char *capture);
// For document_kind.make: a renderer without a file, and one with the slabs of the document as a
// stage. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status session_make_bare(struct session *s);
relume_status session_make_stage(struct session *s);
// Whether the library does what the GPU could.
bool session_by_library(enum session_relight by, const struct gl *gl);
// Light between objects and the scene, before a renderer takes the objects; what is said of a way
// that was chosen, where it was another one `before`; what the panel says of the pictures.
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
// Draw the frame, linear, with the panel as its events have changed the app, and do what the
// app asks for.
relume_status session_draw(struct session *s);
// Only the picture, without what session_draw does besides.
relume_status session_render(struct session *session);
// The frame and the panel onto a framebuffer of its size (0: the screen).
void session_present(struct session *s, GLuint framebuffer);
// Do what the app asks for, once. What fails is said in the panel and the log, and is no error.
relume_status session_perform_action(struct session *s);

// An action or a recording waits for session_draw.
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
// Whether the document can be edited: a g-BRDF that is shown alone, or a folder of maps.
bool session_can_edit(const struct session *s);
// Edits it in words as edits_change reads them, of maps also "write DIR" (relume_maps_write). The
// edit is kept beside the file, and shown. RELUME_EINVAL, RELUME_EUNFIT, an input status with a
// sentence.
relume_status session_edit(struct session *s, const char *words, const struct relume_log *log);
// An edit of what mirrors reflect: words of handles_say, or "save [FILE]". Statuses of handles_say,
// relume_objects_save_reflections.
relume_status session_reflect(struct session *s, const char *words, const struct relume_log *log);
// Before the mouse: the handles know the scene.
void session_lend_scene(struct session *s);
// After it: what they had to say is said in the panel.
void session_hear_handles(struct session *s);
// The file that edits are saved to when nobody names another.
void session_name_reflections(char path[APP_SPEC], const struct session *s);

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
