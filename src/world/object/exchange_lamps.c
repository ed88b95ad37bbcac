// exchange_lamps.c - what lamps bring to a pixel of a scene with objects in it, and what becomes of
// what it shows
#include "world/object/exchange.h"

#include "core/math/random.h"
#include "core/math/scalar.h"
#include "world/object/drawn_objects.h"

static void add_lamp(struct lamps *lamps, bool let_through, double cosine, const float rgb[3])
{
    for (int c = 0; c < 3; c++) {
        lamps->all[c] += cosine * (double)rgb[c];
        lamps->let_through[c] += let_through ? cosine * (double)rgb[c] : 0.0;
    }
}

struct lit_by exchange_lamps_at(const struct exchange *e, vec3 place, vec3 normal, int every,
                                uint64_t key)
{
    const vec3 start = scenery_leave(e->scenery, place, normal);
    struct lit_by lit = {0};
    for (int i = (int)(key % (uint64_t)every); i < e->lighting.light_samples; i += every) {
        float rgb[3];
        double distance;
        vec3 towards;
        if (!relume_object_light_at(&towards, rgb, &distance, &e->lighting.light_sample[i], place))
            continue;
        const double cosine = vec3_dot(towards, normal);
        if (!(cosine > 0.0))
            continue;
        const bool through = scenery_reached(e->scenery, start, towards, distance);
        add_lamp(&lit.without, through, cosine, rgb);
        if (objects_reached(e->o, place, vec3_of(0, 0, 0), towards, distance))
            add_lamp(&lit.with, through, cosine, rgb);
    }
    return lit;
}

void exchange_put_lamps(const struct exchange *e, size_t pixel, vec3 place, vec3 normal)
{
    const struct lit_by lit = exchange_lamps_at(e, place, normal, 1, 0);
    for (size_t c = 0; c < 3; c++) {
        e->lamps[LET_THROUGH].data[3 * pixel + c] = (float)lit.without.let_through[c];
        e->lamps[LET_THROUGH_WITH].data[3 * pixel + c] = (float)lit.with.let_through[c];
        e->lamps[ALL].data[3 * pixel + c] = (float)lit.without.all[c];
        e->lamps[ALL_WITH].data[3 * pixel + c] = (float)lit.with.all[c];
    }
}

struct lit_by exchange_lamps_put(const struct exchange *e, size_t pixel)
{
    struct lit_by lit;
    for (size_t c = 0; c < 3; c++) {
        lit.without.let_through[c] = (double)e->lamps[LET_THROUGH].data[3 * pixel + c];
        lit.with.let_through[c] = (double)e->lamps[LET_THROUGH_WITH].data[3 * pixel + c];
        lit.without.all[c] = (double)e->lamps[ALL].data[3 * pixel + c];
        lit.with.all[c] = (double)e->lamps[ALL_WITH].data[3 * pixel + c];
    }
    return lit;
}

static double sum_of(const double rgb[3])
{
    return rgb[0] + rgb[1] + rgb[2];
}

bool exchange_in_shadow(const struct exchange *e, vec3 place, vec3 normal, int every, uint64_t key)
{
    return scene_share(e->o, e->lighting.light_sample, e->lighting.light_samples, place, normal,
                       every, key) < 1.0;
}

double exchange_dimmed(const void *context, vec3 place, vec3 normal, uint64_t key)
{
    const struct exchange *e = context;
    const int every = e->lighting.light_samples > ON_THE_WAY ? ON_THE_WAY : 1;
    key = random_mix(key);
    if (!exchange_in_shadow(e, place, normal, every, key))
        return 1.0;
    const struct lit_by lit = exchange_lamps_at(e, place, normal, every, key);
    const float *mean = e->world.mean;
    const double rest = (double)(mean[0] + mean[1] + mean[2]) / every;
    const double before = rest + sum_of(lit.without.let_through);
    return before > 0.0 ? (rest + sum_of(lit.with.let_through)) / before : 1.0;
}

// ---------------------------------------------------------------- what a pixel shows

// Whether lamps count that depth is thought to hide, 0 to 1. Shadows of the captured mesh lie a
// pixel beside the captured ones: no surface reflects more than all of the light, so a pixel that
// shows more than arrives is lit by them.
static double hidden_count(const double least[3], const struct lit_by *lit, const float without[3])
{
    const double gathered = (double)(without[0] + without[1] + without[2]);
    const double arrives = sum_of(lit->without.let_through) + gathered;
    return smoothstep(1.0, 1.5, arrives > 0.0 ? sum_of(least) / arrives : INFINITY);
}

static double lamp(const struct lamps *lamps, double hidden, int c)
{
    return lamps->let_through[c] + hidden * (lamps->all[c] - lamps->let_through[c]);
}

void exchange_quotient(double part[3], const float shown[3], const struct lit_by *lit,
                       const float without[3], const float with[3])
{
    const double least[3] = {(double)shown[0], (double)shown[1], (double)shown[2]};
    const double hidden = hidden_count(least, lit, without);
    for (int c = 0; c < 3; c++) {
        const double before = lamp(&lit->without, hidden, c) + (double)without[c];
        const double after = lamp(&lit->with, hidden, c) + (double)with[c];
        const double unknown = fmax(least[c] - before, 0.0);
        const bool shows = least[c] > 0.0;  // few captured lights also foretell less than none
        part[c] = shows && before + unknown > 0.0 ? (after + unknown) / (before + unknown) : 1.0;
    }
}
