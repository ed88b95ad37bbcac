// settings.c - what the window remembers between two runs: its size, the panel, the lights
#include "session/settings.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const int largest = 16384;  // pixels of a window

// The folder for settings; false when there is no home.
static bool find_folder(char folder[SETTINGS_PATH])
{
    const char *config = getenv("XDG_CONFIG_HOME");
    const char *home = getenv("HOME");
    int n = -1;
    if (config && config[0] == '/')
        n = snprintf(folder, SETTINGS_PATH, "%s/relume", config);
    else if (home && home[0] == '/')
        n = snprintf(folder, SETTINGS_PATH, "%s/.config/relume", home);
    return n > 0 && n < SETTINGS_PATH - 16;
}

static void take_line(struct settings *s, const char *line)
{
    int a, b;
    if (sscanf(line, "size %d %d", &a, &b) == 2 && a > 0 && b > 0 && a <= largest && b <= largest) {
        s->width = a;
        s->height = b;
    }
    if (sscanf(line, "panel %d", &a) == 1)
        s->panel = a != 0;
    if (sscanf(line, "dock %d", &a) == 1 && a >= 0 && a < APP_DOCKS)
        s->dock = a;
    if (sscanf(line, "keep-lights %d", &a) == 1)
        s->keep_lights = a != 0;
}

void settings_load(struct settings *s)
{
    char folder[SETTINGS_PATH];
    char path[SETTINGS_PATH + 16];
    char line[256];
    *s = (struct settings){0};
    if (!find_folder(folder))
        return;
    snprintf(s->rig, sizeof s->rig, "%.*s/rig.json", SETTINGS_PATH - 16, folder);
    snprintf(path, sizeof path, "%s/viewer", folder);
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file))
        take_line(s, line);
    if (file)
        fclose(file);
}

// The folder and the one it is in; deeper ones belong to others.
static void make_folder(const char *folder)
{
    char parent[SETTINGS_PATH];
    snprintf(parent, sizeof parent, "%s", folder);
    *strrchr(parent, '/') = '\0';
    (void)mkdir(parent, 0700);
    (void)mkdir(folder, 0700);
}

void settings_save(const struct settings *s)
{
    char folder[SETTINGS_PATH];
    char path[SETTINGS_PATH + 16];
    char text[128];
    if (!find_folder(folder))
        return;
    make_folder(folder);
    snprintf(path, sizeof path, "%s/viewer", folder);
    const int n = snprintf(text, sizeof text, "size %d %d\npanel %d\ndock %d\nkeep-lights %d\n",
                           s->width, s->height, s->panel, s->dock, s->keep_lights);
    const relume_status ignored = relume_file_save(path, text, (size_t)n, NULL);
    (void)ignored;
}
