// shadows.h - the inside of relume_shadows
#ifndef SHADOW_SHADOWS_H
#define SHADOW_SHADOWS_H

#include "relight/shadow/moving.h"
#include "relight/shadow/stage.h"

struct relume_shadows {
    struct stage stage;
    float *matte;           // [height][width][RELUME_SHADOW_CHANNELS - 1]: colour, a, b
    relume_coder *between;  // of the captured lights: what lies between them; NULL: not needed yet
    relume_coder *summed;   // the same of highlights in a sum of lights
    int lights;
    struct relume_image gloss;  // what highlights wander by (gloss.h); nothing else is then used
    uint8_t **reached;  // [lights] -> [height][width], as relume_shadows_trace; NULL: not asked for
};

enum { SHADOWS_AROUND = 4 };  // captured lights around a direction, at most; of highlights all

// Makes what lies between the captured lights of a coder: with traced shadows s->between, else the
// one that relume_shadows_around asks. RELUME_ENOMEM.
relume_status shadows_need_between(relume_shadows *s, const struct relume_coder_info *info,
                                   bool summed);

// What a pixel of `matte` would show under a light if nothing stood in its way.
static inline float shadows_matte(const float *matte, vec3 light)
{
    const double value = (double)matte[3] + (double)matte[4] * light.x +
                         (double)matte[5] * light.y + (double)matte[6] * light.z;
    return value > 0.0 ? (float)value : 0.0f;
}

#endif
