// fibres.c - the fibres of the lens cortex: a grating that makes the lenticular halo
//
// Fibres run inwards from the equator. As printed there are 200 of them, evenly around; the ring of
// a grating stands at lambda / spacing, so 200 make one of half a degree. A halo of a given angle
// wants fibres of one spacing everywhere: they are laid in narrow rings, each with as many as its
// circumference holds.
#include "relight/eye/eye.h"

#include "core/math/random.h"
#include "relight/eye/pupil.h"

#include <math.h>

enum { MOST = 40000 };
static const double ring_mm = 0.1;
static const double wavelength_mm = 575e-6;

struct rings {
    int count;
    double step, spacing;
};

static struct rings rings_of(const struct relume_subject *s)
{
    const double span = s->fibres.outer_mm - s->fibres.inner_mm;
    if (!(span > 0.0))
        return (struct rings){0};
    if (s->fibres.halo_deg <= 0.0)
        return (struct rings){.count = s->fibres.spokes > 0, .step = span};
    const int count = relume_whole(ceil(span / ring_mm));
    return (struct rings){count, span / count,
                          wavelength_mm / sin(s->fibres.halo_deg * M_PI / 180.0)};
}

static int around(const struct relume_subject *s, const struct rings *rings, int ring)
{
    if (rings->spacing <= 0.0)
        return s->fibres.spokes;
    const double middle = s->fibres.inner_mm + (ring + 0.5) * rings->step;
    return relume_whole(2.0 * M_PI * middle / rings->spacing);
}

int fibres_count(const struct relume_subject *s)
{
    const struct rings rings = rings_of(s);
    int count = 0;
    for (int ring = 0; ring < rings.count; ring++)
        count += around(s, &rings, ring);
    return count < MOST ? count : MOST;
}

void fibres_draw(const struct relume_subject *s, struct relume_eye_stroke *strokes)
{
    const struct rings rings = rings_of(s);
    const int most = fibres_count(s);
    int made = 0;
    for (int ring = 0; ring < rings.count; ring++) {
        struct random random = random_stream(s->seed, (uint64_t)ring, 0x66696272u);
        const double from = s->fibres.inner_mm + ring * rings.step, to = from + rings.step;
        const double start = random_next(&random);
        const int count = around(s, &rings, ring);
        for (int i = 0; i < count && made < most; i++) {
            const double phi = 2.0 * M_PI * (i + start) / count;
            const double x = cos(phi), y = sin(phi);
            strokes[made++] = (struct relume_eye_stroke){
                .x = {(float)(from * x), (float)(to * x)},
                .y = {(float)(from * y), (float)(to * y)},
                .width = {(float)s->fibres.width_mm, (float)s->fibres.width_mm},
                .opacity = (float)s->fibres.opacity,
            };
        }
    }
}
