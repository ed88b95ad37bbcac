// script.h - a text file of events, played as if a user made them
#ifndef VIEWER_SCRIPT_H
#define VIEWER_SCRIPT_H

#include "app/state.h"

// Who acts on what a script says. `user` is handed to every function; statuses other than RELUME_OK
// end the script.
struct script_host {
    void *user;
    struct app *app;
    void (*send)(void *user, const struct app_event *event);
    // `light SPEC` (in place of all lights) and `add SPEC`, and the lights of a rig file; what is
    // wrong goes to `log`, which says where.
    relume_status (*light)(void *user, const char *spec, bool replace,
                           const struct relume_log *log);
    relume_status (*rig)(void *user, const char *path, const struct relume_log *log);
    // Show another file.
    relume_status (*open)(void *user, const char *path, const struct relume_log *log);
    // Let time pass: `seconds` of it, or until nothing moves when negative.
    relume_status (*wait)(void *user, double seconds);
    relume_status (*frame)(void *user, const char *path);  // the picture alone
    relume_status (*shot)(void *user, const char *path);   // with all that is drawn over it
    const struct relume_log *log;
    // What an eye shall do (observer_say); what is wrong is an input status with what was expected.
    relume_status (*glare)(void *user, const char *words, const char **expected);
    // Edit the g-BRDF that is shown.
    relume_status (*edit)(void *user, const char *words, const struct relume_log *log);
    // Edit what mirrors reflect.
    relume_status (*reflect)(void *user, const char *words, const struct relume_log *log);
};

// An open script. Thread-safety: one thread at a time.
struct script;

// An input status, RELUME_ENOMEM.
relume_status script_open(struct script **out, const char *path, const struct script_host *host);
// Play one line; `*more` is false behind the last. An input status names the line and column that
// are wrong.
relume_status script_step(struct script *script, bool *more);
// Whether the last event was Esc: a script that ends so leaves the window.
bool script_leaves(const struct script *script);
void script_close(struct script **script);

// All of it, or until an event quits the app.
relume_status script_play(const char *path, const struct script_host *host);

#endif
