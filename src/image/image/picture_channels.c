// picture_channels.c - which channels of a picture are its colour
#include "image/image/picture.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

static int find(const char *const *names, int n, const char *name)
{
    for (int i = 0; i < n; i++)
        if (!strcasecmp(names[i], name))
            return i;
    return -1;
}

// Made by libraries for channels that have none.
static bool has_no_name(const char *name)
{
    return !name[0] || !strncasecmp(name, "channel", 7);
}

// What a single channel may be that is no brightness.
static bool is_measure(const char *name)
{
    static const char *const measures[] = {"Z", "ZBack", "depth", "A", "alpha", "id", NULL};
    const char *dot = strrchr(name, '.');
    for (const char *const *m = measures; *m; m++)
        if (!strcasecmp(dot ? dot + 1 : name, *m))
            return true;
    return false;
}

static void list_names(struct picture_info *info, const char *const *names)
{
    enum { MOST = 8 };
    size_t n = 0;
    for (int i = 0; i < info->channels && i < MOST && n < sizeof info->other; i++)
        n += (size_t)snprintf(info->other + n, sizeof info->other - n, "%s%s", i ? ", " : "",
                              names[i]);
    if (info->channels > MOST)
        snprintf(info->other, sizeof info->other, "%s, %s, %s, ... (%d channels)", names[0],
                 names[1], names[2], info->channels);
}

static void use(struct picture_info *info, int r, int g, int b)
{
    info->rgb[0] = r;
    info->rgb[1] = g;
    info->rgb[2] = b;
}

void picture_find_colour(struct picture_info *info, const char *const *names)
{
    const int n = info->channels;
    info->other[0] = '\0';
    if (!names || has_no_name(names[0])) {
        use(info, 0, n >= 3 ? 1 : 0, n >= 3 ? 2 : 0);
        return;
    }
    const int r = find(names, n, "R"), g = find(names, n, "G"), b = find(names, n, "B");
    // X, Y, Z are places, or colours of CIE: no luminance alone
    const int luminance = find(names, n, "X") < 0 ? find(names, n, "Y") : -1;
    use(info, 0, 0, 0);
    if (r >= 0 && g >= 0 && b >= 0)
        use(info, r, g, b);
    else if (luminance >= 0 && find(names, n, "RY") < 0 && find(names, n, "Cb") < 0)
        use(info, luminance, luminance, luminance);
    else if (n > 1 || is_measure(names[0]))
        list_names(info, names);
}
