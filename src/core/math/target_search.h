// target_search.h - where an increasing function reaches a target, by few trials
//
// A trial takes seconds: something is coded and judged. The search keeps the nearest trials on both
// sides of the target. Where to try next is the caller's, who knows how the function runs: a line
// through both trials, or a step worth a known number of decibels; the middle is always right. It
// ends when the two are close to each other, when a trial is close enough to the target, or with
// the last trial that is allowed.
//
// Searches by it: the quantiser of planes (encode/encode/rate.c), the step and the quality of web
// folders (exchange/formats/web_step.c), the quantiser of an AVIF sheet (site/publish/avif.c).
//
// The search for a visible difference (encode/encode/jnd_search.c) is another: its two sides may
// cross, since that difference does not always fall with the quality, and it keeps the best file.
#ifndef MATH_TARGET_SEARCH_H
#define MATH_TARGET_SEARCH_H

#include <relume/base.h>

// State of a search.
struct target_bracket {
    double low, high;              // the target is passed between them
    double low_value, high_value;  // of the function there; NaN: a bound that was not tried
    double at, value;              // the last trial
    int trials;
};

struct target_search {
    double target;
    bool may_equal;   // a value equal to the target counts as low, not as high
    double narrow;    // high - low that is close enough
    int most_trials;  // 0: no limit
    // The function at `at`. What it returns but RELUME_OK ends the search.
    relume_status (*measure)(void *context, double at, double *value);
    // Returns true if the last trial is close enough. NULL: always false.
    bool (*is_close)(void *context, const struct target_bracket *b);
    // Returns the next argument, between low and high. NULL: their middle.
    double (*guess)(void *context, const struct target_bracket *b);
    void *context;
};

// Searches from the bounds `low` and `high` and the first trial `at` of `b`, and fills its other
// members. Returns RELUME_OK or a status of `measure`.
relume_status target_search(struct target_bracket *b, const struct target_search *s);

#endif
