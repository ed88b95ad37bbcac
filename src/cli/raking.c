// raking.c - raking light in words
#include "raking.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double low_deg = 12.0;

enum { SIDES = 8 };
// Counter-clockwise.
static const char *const sides[SIDES] = {"right", "upper right", "top",    "upper left",
                                         "left",  "lower left",  "bottom", "lower right"};

static const char *skip_blanks(const char *t)
{
    return t + strspn(t, " \t");
}

// The words follow `*text`, which moves behind them.
static bool take_words(const char **text, const char *words)
{
    const char *t = skip_blanks(*text);
    const size_t n = strlen(words);
    if (strncmp(t, words, n) || (t[n] && !strchr(" \t", t[n])))
        return false;
    *text = skip_blanks(t + n);
    return true;
}

bool raking_is(const char *spec)
{
    return take_words(&spec, "raking");
}

static bool take_side(const char **text, struct relume_vec3 *side)
{
    for (int i = 0; i < SIDES; i++)
        if (take_words(text, sides[i])) {
            *side = (struct relume_vec3){cos(i * M_PI / 4), sin(i * M_PI / 4), 0};
            return true;
        }
    return false;
}

static bool take_vector(const char **text, struct relume_vec3 *side)
{
    char *end;
    side->x = strtod(*text, &end);
    if (end == *text)
        return false;
    const char *const second = end;
    side->y = strtod(second, &end);
    const bool good = end != second && (!*end || strchr(" \t", *end)) && isfinite(side->x) &&
                      isfinite(side->y) && hypot(side->x, side->y) > 1e-9;
    *text = skip_blanks(end);
    return good;
}

relume_status raking_parse(struct raking *out, const char *spec, const struct relume_log *log)
{
    const char *t = spec;
    out->side = (struct relume_vec3){-M_SQRT1_2, M_SQRT1_2, 0};
    (void)take_words(&t, "raking");
    bool good = true;
    if (*t && strncmp(t, "rgb", 3))
        good = take_side(&t, &out->side) || take_vector(&t, &out->side);
    out->rest = t;
    if (good && (!*t || !strncmp(t, "rgb", 3)))
        return RELUME_OK;
    return say(log, RELUME_EINVAL,
               "light '%.200s': expected \"raking [left | upper left | ... | x y] [rgb r g b]\", "
               "found '%.40s'",
               spec, *t ? t : "the end");
}

struct relume_vec3 raking_stand_in(struct relume_vec3 side)
{
    const double low = low_deg * M_PI / 180, wide = cos(low) / hypot(side.x, side.y);
    return (struct relume_vec3){wide * side.x, wide * side.y, sin(low)};
}

const char *raking_side_name(struct relume_vec3 side)
{
    const int eighth = (int)lround(atan2(side.y, side.x) / (M_PI / 4));
    return sides[(eighth + SIDES) % SIDES];
}
