// settings.h - what the window remembers between two runs: its size, the panel, the lights
//
// Kept in $XDG_CONFIG_HOME/relume (else ~/.config/relume): `viewer`, lines of words and numbers,
// and `rig.json`. Nothing here fails: what cannot be read is forgotten, what cannot be written is
// not.
#ifndef VIEWER_SETTINGS_H
#define VIEWER_SETTINGS_H

#include "app/app.h"

enum { SETTINGS_PATH = 4096 };

struct settings {
    int width, height;  // 0: not known
    bool panel;
    int dock;  // enum app_dock
    bool keep_lights;
    char rig[SETTINGS_PATH];  // where the lights are kept; "": nowhere
};

void settings_load(struct settings *settings);
// `settings->rig` is not written here.
void settings_save(const struct settings *settings);

#endif
