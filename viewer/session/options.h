// options.h - the command line of relume-view
#ifndef VIEWER_OPTIONS_H
#define VIEWER_OPTIONS_H

#include "app/app.h"
#include "session/record.h"
#include "session/session.h"

#include <relume/relight/tone.h>
#include <relume/rig.h>

struct options {
    bool help;         // was asked for, and nothing else is known
    const char *file;  // NULL: `stage`, or a window without a file
    bool stage;        // there are objects alone
    struct object_options objects;
    const char *offscreen;  // picture to write without a window, or NULL
    const char *script;     // events to play, or NULL
    const char *capture;    // to compare with, or NULL
    const char *state;      // read as other options; NULL: not given
    bool record;            // a recording of `kind` into `output`, `frames` long
    enum record_kind kind;
    const char *output;
    int frames;
    bool no_config;
    bool window;  // play them in a window
    bool panel;   // begin with the panel
    bool keep_lights;
    bool docked;  // --dock was given
    enum app_dock dock;
    double ui_scale;  // of the panel; 0: the desktop's
    struct app_state start;
    relume_rig *rig;  // of --rig and --light, NULL without either
    int size[2];      // of --size, 0: not given
    const struct relume_tone *tone;
    const struct relume_transport *transport;  // NULL: not given
    int samples, bounces;                      // of it
    int projection;                            // of a look into a panorama
    int backend;
    const char *gl;  // what offscreen frames are drawn by: a name that context_offscreen knows
    int threads;     // that read files; 0: all cores
    struct relume_limits limits;
    double vram_mb;  // graphics memory for views
    enum session_relight relight, glare;
    int glare_size;
    struct relume_subject subject;
};

// RELUME_EINVAL with a sentence in `log`: unknown options, wrong values, no FILE. An input status,
// RELUME_ENOMEM: a file that a light needs. In every case options_release comes after it.
relume_status options_parse(struct options *options, int argc, char **argv,
                            const struct relume_log *log);
void options_release(struct options *options);
void options_help(void);

#endif
