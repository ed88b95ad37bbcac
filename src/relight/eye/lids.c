// lids.c - lids that blink and squint, and their lashes (Ritschel 2009, 8.2.6)
//
// Lid edges are parabolas between the corners of the eye, lashes are curved, tapering strokes that
// stand on them.
#include "relight/eye/eye.h"

#include "core/math/random.h"
#include "core/math/scalar.h"
#include "relight/eye/pupil.h"

#include <math.h>

// Of an adult's open eye, mm: the upper lid just clears the widest pupil.
static const double corner_x = 15.0, corner_y = -1.0;
static const double upper_open = 4.6, lower_open = -5.8, closed = -3.5;
static const double lower_length = 0.45;  // of a picture's lashes, upper ones being 1
enum { PIECES = 3 };                      // of a lash

int lashes_count(const struct relume_subject *s, const struct lashes *image)
{
    return image->piece ? 2 * image->count : s->lids.lashes * PIECES;
}

// One blink in every interval, somewhere in its second half; lids fall twice as fast as they rise.
double lids_openness(const struct relume_subject *s, double time_s)
{
    const double interval = s->lids.blink_interval_s;
    if (!(interval > 0.0))
        return 1.0;
    const double slot = floor(time_s / interval);
    struct random random = random_stream(s->seed, (uint64_t)slot, 0x626c696eu);
    const double last = fmax(interval - s->lids.blink_s, 0.0);
    const double start = slot * interval + random_range(&random, 0.5, 1.0) * last;
    const double phase = (time_s - start) / s->lids.blink_s;
    return 1.0 -
           smoothstep(0.0, 1.0, phase / 0.35) * (1.0 - smoothstep(0.0, 1.0, (phase - 0.45) / 0.55));
}

static void set_edge(float edge[2], double middle)
{
    edge[0] = (float)middle;
    edge[1] = (float)((corner_y - middle) / (corner_x * corner_x));
}

// From the lid's edge at `root`, first along its normal `up` (1: lower lid), then bending outwards.
static void draw_lash(struct relume_eye_stroke *strokes, const struct relume_subject *s,
                      struct random *random, const float edge[2], double up)
{
    const double root = random_range(random, -7.0, 7.0);
    const double length = random_range(random, 0.5, 1.0) * (up > 0.0 ? 1.6 : 3.6);
    const double bend = random_range(random, -0.12, 0.12) + 0.1 * root / 7.0;
    double turn = 0.5 * root / 7.0 + random_range(random, -0.15, 0.15);
    double x = root, y = edge[0] + edge[1] * root * root;
    for (int i = 0; i < PIECES; i++) {
        const double nx = x + length / PIECES * sin(turn),
                     ny = y + up * length / PIECES * cos(turn);
        strokes[i] = (struct relume_eye_stroke){
            .x = {(float)x, (float)nx},
            .y = {(float)y, (float)ny},
            .width = {(float)(s->lids.lash_width_mm * (1.0 - 0.8 * i / PIECES)),
                      (float)(s->lids.lash_width_mm * (1.0 - 0.8 * (i + 1) / PIECES))},
            .opacity = 1.0f,
        };
        x = nx;
        y = ny;
        turn += bend;
    }
}

static void place_image(const struct lashes *image, const float edge[2], double up,
                        struct relume_eye_stroke *strokes)
{
    for (int i = 0; i < image->count; i++) {
        const struct lash_piece *const p = &image->piece[i];
        strokes[i] = (struct relume_eye_stroke){.opacity = 1.0f};
        for (int k = 0; k < 2; k++) {
            strokes[i].x[k] = p->x[k];
            strokes[i].y[k] = edge[0] + edge[1] * p->x[k] * p->x[k] + (float)up * p->far[k];
            strokes[i].width[k] = p->width[k];
        }
    }
}

void lids_place(const struct relume_subject *s, const struct lashes *image, double openness,
                struct relume_aperture *aperture, struct relume_eye_stroke *lashes)
{
    set_edge(aperture->upper, closed + openness * (upper_open - closed));
    set_edge(aperture->lower, closed + openness * (lower_open - closed));
    if (image->piece) {
        place_image(image, aperture->upper, -1.0, lashes);
        place_image(image, aperture->lower, lower_length, lashes + image->count);
        return;
    }
    for (int i = 0; i < s->lids.lashes; i++) {
        struct random random = random_stream(s->seed, (uint64_t)i, 0x6c617368u);
        const bool below = i % 3 == 2;
        draw_lash(lashes + PIECES * i, s, &random, below ? aperture->lower : aperture->upper,
                  below ? 1.0 : -1.0);
    }
}
