// sight.h - what can be chosen of the eye that looks at the frame (glare), in numbers and in words
//
// No OpenGL: part of the app's state. Glare itself is drawn by glare.h.
#ifndef VIEWER_SIGHT_H
#define VIEWER_SIGHT_H

#include <relume/glare.h>

enum sight_mode {
    SIGHT_AUTO = 0,  // what suits the frame
    SIGHT_FFT,
    SIGHT_BILLBOARD,
    SIGHT_HYBRID,
    SIGHT_MODES
};

// All zero: no glare, and the default of everything.
struct sight {
    bool on;
    bool paused;   // its time stands still
    bool sources;  // lights that are in view are drawn as small sources
    enum sight_mode mode;
    double magnify;      // of the pattern, [0.01, 1000]; 0: 1
    double nits;         // cd/m^2 of a pixel of value 1, [1e-6, 1e9]; 0: 100
    double squint;       // [0, 0.95]; where it is more than the subject's own
    unsigned parts_off;  // RELUME_EYE_*
};

double sight_magnify(const struct sight *sight);
double sight_nits(const struct sight *sight);
// Whether time passes in it.
static inline bool sight_lives(const struct sight *sight)
{
    return sight->on && !sight->paused;
}

// The parts of an eye by name, and what is said of them: ends with a NULL name.
struct sight_part {
    const char *name, *what;
    unsigned part;
};
extern const struct sight_part sight_parts[];
const char *sight_mode_name(enum sight_mode mode);

// One thing as a script says it: "on", "off", "pause", "run", "sources on", "magnify 3", "nits 50",
// "squint 0.4", "mode hybrid", "lens off". False where `words` are none of them; `*expected` says
// what would be one.
bool sight_say(struct sight *sight, const char *words, const char **expected);

#endif
