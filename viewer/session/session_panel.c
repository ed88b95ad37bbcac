// session_panel.c - the panel of a session: making and ending it
#include "session/session_panel.h"

#include <string.h>
#include <unistd.h>

// Beside the program, else where its package puts it.
static void find_font(char path[PATH_MAX])
{
    static const char name[] = "DejaVuSans.ttf";
    const ssize_t n = readlink("/proc/self/exe", path, PATH_MAX - sizeof name);
    path[n > 0 ? n : 0] = '\0';
    char *slash = strrchr(path, '/');
    if (slash) {
        strcpy(slash + 1, name);
        if (!access(path, R_OK))
            return;
    }
    strcat(strcpy(path, "/usr/share/fonts/truetype/dejavu/"), name);
}

relume_status session_panel_create(struct session_panel *p, const struct gl *gl, double scale,
                                   const struct relume_log *log)
{
    find_font(p->font);
    const relume_status status = panel_create(&p->panel, scale, p->font);
    return status ? status : draw_panel_create(&p->drawing, gl, p->panel, log);
}

static void destroy_drawing(struct session_panel *p, const struct gl *gl)
{
    draw_panel_destroy(&p->drawing, gl);
    panel_destroy(&p->panel);
}

relume_status session_panel_resize(struct session_panel *p, const struct gl *gl, double scale,
                                   const struct relume_log *log)
{
    destroy_drawing(p, gl);
    return session_panel_create(p, gl, scale, log);
}

void session_panel_destroy(struct session_panel *p, const struct gl *gl)
{
    environment_list_destroy(&p->maps);
    browse_destroy(&p->browser);
    inspect_destroy(&p->inspector);
    destroy_drawing(p, gl);
}
