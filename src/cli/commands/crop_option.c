// crop_option.c - the text of --crop
#include "cli/commands/crop_option.h"

#include <stdio.h>
#include <string.h>

relume_status take_crop(void *place, const struct option *o, const char *text,
                        const struct relume_log *log)
{
    struct crop crop = {.automatic = !strcmp(text, "auto")};
    int end = -1;
    const int n = sscanf(text, "%d,%d,%d,%d%n", &crop.part[0], &crop.part[1], &crop.part[2],
                         &crop.part[3], &end);
    const bool good = n == 4 && end == (int)strlen(text) && crop.part[2] > 0 && crop.part[3] > 0;
    if (!good)
        memset(crop.part, 0, sizeof crop.part);
    memcpy(place, &crop, sizeof crop);
    return crop.automatic || good
               ? RELUME_OK
               : say(log, RELUME_EINVAL,
                     "%s: expected auto, or four whole numbers x,y,w,h; found '%s'", o->name, text);
}
