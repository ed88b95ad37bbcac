// light.c - light specifications in words
#include <relume/relight.h>

#include "base/log.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool take_number(const char **text, double *out)
{
    char *end;
    *out = strtod(*text, &end);
    if (end == *text || !isfinite(*out))
        return false;
    *text = end;
    return true;
}

static bool take_numbers(const char **text, double *out, int count)
{
    for (int i = 0; i < count; i++)
        if (!take_number(text, &out[i]))
            return false;
    return true;
}

static bool take_word(const char **text, const char *word)
{
    const char *t = *text + strspn(*text, " \t");
    const size_t n = strlen(word);
    if (strncmp(t, word, n) || (t[n] && !strchr(" \t", t[n])))
        return false;
    *text = t + n;
    return true;
}

relume_status relume_light_parse(struct relume_light *out, const char *spec,
                                 const struct relume_log *log)
{
    const char *t = spec;
    double d[3], rgb[3] = {1.0, 1.0, 1.0};
    *out = (struct relume_light){0};
    if (!take_word(&t, "dir"))
        return log_fail(log, RELUME_EINVAL,
                        "light '%s': unknown kind; expected \"dir x y z [rgb r g b]\"", spec);
    if (!take_numbers(&t, d, 3))
        return log_fail(log, RELUME_EINVAL, "light '%s': expected three numbers after dir", spec);
    if (!(hypot(hypot(d[0], d[1]), d[2]) > 1e-12))
        return log_fail(log, RELUME_EINVAL, "light '%s': expected a direction, found zero", spec);
    if (take_word(&t, "rgb") && !take_numbers(&t, rgb, 3))
        return log_fail(log, RELUME_EINVAL, "light '%s': expected three numbers after rgb", spec);
    if (t[strspn(t, " \t")])
        return log_fail(log, RELUME_EINVAL, "light '%s': unexpected '%s'", spec,
                        t + strspn(t, " \t"));
    *out = (struct relume_light){
        .kind = RELUME_LIGHT_DIRECTIONAL,
        .direction = {d[0], d[1], d[2]},
        .rgb = {(float)rgb[0], (float)rgb[1], (float)rgb[2]},
    };
    return RELUME_OK;
}
