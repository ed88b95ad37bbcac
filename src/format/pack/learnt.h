// learnt.h - what was learnt of the pixels of a view, by which shadows and highlights move with the
// light, as few coded bytes
//
// Eight numbers a pixel are eight pictures of 12-bit codes, coded with loss as AV1 (lossy.h). A
// number is curve(code * scale + offset): itself, what is squared with its sign kept, or a power of
// two. Under captured lights what is lost cancels out; between them it costs a few hundredths of a
// decibel, and the pictures take a fifth of what halves without loss do, or less.
#ifndef PACK_LEARNT_H
#define PACK_LEARNT_H

#include "format/lossy/lossy.h"
#include "format/pack/views.h"

#include <relume/pack.h>

enum { LEARNT = 8 };
_Static_assert(LEARNT == (int)RELUME_SHADOW_CHANNELS && LEARNT == (int)RELUME_GLOSS_CHANNELS,
               "both models are coded by one function");

enum learnt_kind { LEARNT_SHADOW, LEARNT_GLOSS };

// What the codes of each channel mean.
struct learnt_steps {
    float scale[LEARNT], offset[LEARNT];
};

// A model as words that `steps` belong to, of at most `bytes` unless it is coarse then.
// RELUME_EINVAL for numbers that are not finite, but for thicknesses, which are 0 or more, or whose
// differences are not. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status learnt_encode(struct lossy_words *out, struct learnt_steps *steps,
                            const struct relume_image *model, enum learnt_kind kind, double bytes,
                            int threads, const struct relume_log *log);
// Into the pixels of `model`, of LEARNT channels. RELUME_EDAMAGED when the words are none of a
// model of its size, RELUME_ENOMEM.
relume_status learnt_decode(struct relume_image *model, const struct lossy_words *words,
                            const struct learnt_steps *steps, enum learnt_kind kind, int threads);

#endif
