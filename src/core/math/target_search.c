// target_search.c - where an increasing function reaches a target
#include "core/math/target_search.h"

#include <math.h>

static void add_trial(struct target_bracket *b, const struct target_search *s)
{
    const bool is_low = s->may_equal ? b->value <= s->target : b->value < s->target;
    *(is_low ? &b->low : &b->high) = b->at;
    *(is_low ? &b->low_value : &b->high_value) = b->value;
    b->trials++;
}

relume_status target_search(struct target_bracket *b, const struct target_search *s)
{
    b->low_value = b->high_value = (double)NAN;
    b->trials = 0;
    while (b->high - b->low > s->narrow && (!s->most_trials || b->trials < s->most_trials)) {
        const relume_status status = s->measure(s->context, b->at, &b->value);
        if (status)
            return status;
        add_trial(b, s);
        if (s->is_close && s->is_close(s->context, b))
            break;
        b->at = s->guess ? s->guess(s->context, b) : 0.5 * (b->low + b->high);
    }
    return RELUME_OK;
}
