// session_panel.h - the panel of a session: what draws it, and what it shows besides the app
#ifndef VIEWER_SESSION_PANEL_H
#define VIEWER_SESSION_PANEL_H

#include "panel/draw_panel.h"
#include "relit/exchanger.h"
#include "session/environment_list.h"
#include "session/inspect.h"
#include "session/object_set.h"
#include "session/session_messages.h"

#include <limits.h>

struct session_panel {
    struct panel *panel;
    struct panel_drawing drawing;
    struct environment_list maps;  // environment maps to choose from, while the panel does
    struct browser browser;        // the folder that was listed last
    struct inspector inspector;    // made when first asked for
    float histogram[256][3];
    size_t material_bytes[OBJECT_MATERIALS];  // of graphics memory
    char way[EXCHANGER_SLOTS][SESSION_TEXT];  // how far pictures with gathered light are
    char font[PATH_MAX];
    bool font_warned;  // that the font is missing
};

// Makes the panel; letters and margins are `scale` times as large as usual. RELUME_ESYSTEM,
// RELUME_ENOMEM.
relume_status session_panel_create(struct session_panel *p, const struct gl *gl, double scale,
                                   const struct relume_log *log);
void session_panel_destroy(struct session_panel *p, const struct gl *gl);
// Another scale, with all else as it is. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status session_panel_resize(struct session_panel *p, const struct gl *gl, double scale,
                                   const struct relume_log *log);

#endif
