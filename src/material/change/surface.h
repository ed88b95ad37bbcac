// surface.h - what a capture says of its object's surface, and how surely
#ifndef CHANGE_SURFACE_H
#define CHANGE_SURFACE_H

#include <relume/capture.h>
#include <relume/image.h>

// Colours are cube roots of linear light, turned: brightness, red less green, both less blue.
struct surface {
    int width, height;
    struct relume_image normal;  // unit, 0 where nothing is known
    struct relume_image colour;
    // What two halves of the lights differ in, halved: noise of the same size as that of the mean.
    struct relume_image normal_noise, colour_noise;
    // How bright highlights are, first of three channels; second: 1 where enough lamps of each half
    // stand near the mirror direction to tell. Without data where no gloss was looked for.
    struct relume_image gloss, gloss_noise;
};

// RELUME_EUNFIT with a sentence, an input status, RELUME_ENOMEM, RELUME_ECANCEL; empty on failure.
relume_status surface_fit(struct surface *out, const relume_capture *capture, int view, int threads,
                          const struct relume_log *log);
void surface_free(struct surface *surface);

void colour_code(float code[3], const float linear[3]);
void colour_linear(float linear[3], const float code[3]);

static inline bool surface_knows_gloss(const struct surface *s, size_t at)
{
    return s->gloss.data && s->gloss.data[3 * at + 1] > 0.5f;
}

static inline bool surface_knows(const struct surface *s, size_t at)
{
    const float *n = s->normal.data + 3 * at;
    return n[0] != 0.0f || n[1] != 0.0f || n[2] != 0.0f;
}

#endif
