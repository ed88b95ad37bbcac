// observer.c - what can be chosen of the eye that looks at the frame (glare), in numbers and in
// words
#include "app/observer.h"
#include "relight/eye/pupil.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static const double usual_nits = 100;  // white of an ordinary screen

double observer_magnify(const struct observer *s)
{
    return s->magnify > 0 ? s->magnify : 1;
}

double observer_nits(const struct observer *s)
{
    return s->nits > 0 ? s->nits : usual_nits;
}

const struct observer_part observer_parts[] = {
    {"cornea", "flat cells of the cornea", RELUME_EYE_CORNEA},
    {"fibres", "fibres of the lens: the coloured ring", RELUME_EYE_FIBRES},
    {"lens", "particles of the lens: the needles", RELUME_EYE_LENS},
    {"vitreous", "particles of the vitreous body, which lag behind", RELUME_EYE_VITREOUS},
    {"lids", "lids and lashes: streaks, blinks", RELUME_EYE_LIDS},
    {NULL, NULL, 0},
};

static const char *const mode_names[] = {"auto", "fft", "billboard", "hybrid"};

const char *observer_mode_name(enum observer_mode mode)
{
    return mode_names[mode];
}

// ---------------------------------------------------------------- words

static bool word_is(const char **text, const char *word)
{
    const size_t n = strlen(word);
    const char *at = *text + strspn(*text, " \t");
    if (strncmp(at, word, n) || (at[n] && !strchr(" \t", at[n])))
        return false;
    *text = at + n;
    return true;
}

static bool at_end(const char *text)
{
    return text[strspn(text, " \t")] == '\0';
}

static bool take_switch(bool *out, const char *text)
{
    *out = word_is(&text, "on");
    return (*out || word_is(&text, "off")) && at_end(text);
}

static bool take_number(double *out, const char *text, double least, double most)
{
    char *end;
    const double n = strtod(text, &end);
    if (end == text || !at_end(end) || !(n >= least && n <= most))
        return false;
    *out = n;
    return true;
}

static bool take_mode(struct observer *s, const char *text)
{
    for (int i = 0; i < OBSERVER_MODES; i++) {
        const char *at = text;
        if (word_is(&at, mode_names[i]) && at_end(at)) {
            s->mode = (enum observer_mode)i;
            return true;
        }
    }
    return false;
}

static const struct number {
    const char *name, *expected;
    size_t offset;
    double least, most;
} numbers[] = {
    {"magnify", "a magnification from 0.01 to 1000", offsetof(struct observer, magnify), 0.01,
     1000},
    {"nits", "cd/m^2 of a pixel of value 1, 1e-6 to 1e9", offsetof(struct observer, nits), 1e-6,
     1e9},
    {"squint", "how far the lids are closed, 0 to 0.95", offsetof(struct observer, squint), 0,
     0.95},
    {"cycle", "seconds of a loop, 0 (none) to 10", offsetof(struct observer, cycle_s), 0, 10},
};

bool observer_say(struct observer *s, const char *words, const char **expected)
{
    bool on;
    *expected = "on or off";
    if (take_switch(&on, words)) {
        s->on = on;
        return true;
    }
    for (const struct observer_part *p = observer_parts; p->name; p++) {
        if (!word_is(&words, p->name))
            continue;
        if (!take_switch(&on, words))
            return false;
        s->parts_off = on ? s->parts_off & ~p->part : s->parts_off | p->part;
        return true;
    }
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        if (!word_is(&words, numbers[i].name))
            continue;
        *expected = numbers[i].expected;
        return take_number((double *)(void *)((char *)s + numbers[i].offset), words,
                           numbers[i].least, numbers[i].most);
    }
    if (word_is(&words, "sources"))
        return take_switch(&s->sources, words);
    if (word_is(&words, "mode")) {
        *expected = "auto, fft, billboard or hybrid";
        return take_mode(s, words);
    }
    *expected =
        "on, off, pause, run, sources, magnify, nits, squint, cycle, mode, cornea, fibres, lens, "
        "vitreous or lids";
    const bool pause = word_is(&words, "pause");
    if ((!pause && !word_is(&words, "run")) || !at_end(words))
        return false;
    s->paused = pause;
    return true;
}
