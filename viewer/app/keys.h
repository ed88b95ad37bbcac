// keys.h - what every key does: one table, for the app and for the list of keys that it shows
#ifndef VIEWER_KEYS_H
#define VIEWER_KEYS_H

#include "app/state.h"

struct key_binding {
    int key;
    const char *shown;  // how the key is called; NULL: as the one before, not listed
    const char *what;
    bool (*press)(struct app *app, int key);  // returns whether the picture changed
    bool repeats;                             // while it is held
};
extern const struct key_binding key_bindings[];  // ends with key 0

// Press a key, or hold it (`repeat`); a key without a meaning does nothing.
bool keys_press(struct app *app, int key, bool repeat);

#endif
