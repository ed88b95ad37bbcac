// pattern_option.c - the --pattern option of synth and lights
#include "pattern_option.h"

relume_status choose_pattern(const struct relume_pattern **out, const char *name)
{
    name = name ? name : "hammersley";
    const char *names[16];
    int n = 0;
    for (const struct relume_pattern *const *p = relume_patterns; *p && n < 15; p++)
        names[n++] = (*p)->name;
    names[n] = NULL;
    *out = relume_pattern_find(name);
    return *out ? RELUME_OK : unknown_name("pattern", name, names);
}
