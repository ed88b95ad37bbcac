// observer.h - what can be chosen of the eye that looks at the frame (glare), in numbers and in
// words
//
// No OpenGL: part of the app's state. Glare itself is drawn by glare.h.
#ifndef VIEWER_OBSERVER_H
#define VIEWER_OBSERVER_H

#include <relume/relight/glare.h>

enum observer_mode {
    OBSERVER_AUTO = 0,  // what suits the frame
    OBSERVER_FFT,
    OBSERVER_BILLBOARD,
    OBSERVER_HYBRID,
    OBSERVER_MODES
};

// All zero: no glare, and the default of everything.
struct observer {
    bool on;
    bool paused;   // its time stands still
    bool sources;  // lights that are in view are drawn as small sources
    enum observer_mode mode;
    double magnify;      // of the pattern, [0.01, 1000]; 0: 1
    double nits;         // cd/m^2 of a pixel of value 1, [1e-6, 1e9]; 0: 100
    double squint;       // [0, 0.95]; where it is more than the subject's own
    double cycle_s;      // up to 10: a loop of so many seconds, at least 0.1, is computed once; 0:
                         // it lives on
    unsigned parts_off;  // RELUME_EYE_*
};

double observer_magnify(const struct observer *observer);
double observer_nits(const struct observer *observer);
// Whether time passes in it.
static inline bool observer_lives(const struct observer *observer)
{
    return observer->on && !observer->paused;
}

// The parts of an eye by name, and what is said of them: ends with a NULL name.
struct observer_part {
    const char *name, *what;
    unsigned part;
};
extern const struct observer_part observer_parts[];
const char *observer_mode_name(enum observer_mode mode);

// One thing as a script says it: "on", "off", "pause", "run", "sources on", "magnify 3", "nits 50",
// "squint 0.4", "cycle 4", "mode hybrid", "lens off". False where `words` are none of them;
// `*expected` says what would be one.
bool observer_say(struct observer *observer, const char *words, const char **expected);

#endif
