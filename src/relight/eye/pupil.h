// pupil.h - the pupil and the aperture of an eye
#ifndef EYE_PUPIL_H
#define EYE_PUPIL_H

#include <relume/relight/eye.h>

// Parts of the eye: bits.
enum relume_eye_part {
    RELUME_EYE_CORNEA = 1 << 0,
    RELUME_EYE_FIBRES = 1 << 1,
    RELUME_EYE_LENS = 1 << 2,
    RELUME_EYE_VITREOUS = 1 << 3,
    RELUME_EYE_LIDS = 1 << 4,  // and lashes
    RELUME_EYE_ALL = (1 << 5) - 1,
};

// A round particle of the aperture.
struct relume_eye_disc {
    float x, y, radius;  // mm
    float opacity;       // the amplitude behind it is multiplied by 1 - opacity
    float depth;         // mm behind the pupil; 0 for all but the vitreous body
};
// A straight stroke whose width changes evenly from one end to the other; ends are cut square.
struct relume_eye_stroke {
    float x[2], y[2];  // mm
    float width[2];    // mm
    float opacity;     // the amplitude behind it is multiplied by 1 - opacity
};
// The discs and strokes of one part, [first, first + count).
struct relume_eye_range {
    int first;  // index
    int count;  // how many
};
// What stands in the way at one moment. The transmittance of a point is the product over all that
// cover it: the pupil (1 inside), every disc and stroke (1 - opacity inside), the lids (0 beyond).
struct relume_aperture {
    float pupil_radius;  // mm, centred at 0, 0
    const struct relume_eye_disc *disc;
    const struct relume_eye_stroke *stroke;
    // Cornea and fibres come first and never change during the life of an eye.
    struct relume_eye_range cornea, lens, vitreous;  // of disc
    struct relume_eye_range fibres, lashes;          // of stroke
    // The open part lies between the parabolas y = lower[0] + lower[1] x^2 and
    // y = upper[0] + upper[1] x^2, mm.
    float lower[2], upper[2];
};

// Hold the lids closed by another amount from now on, [0, 0.99]; what lies outside is taken as the
// nearest.
void relume_eye_squint(relume_eye *eye, double squint);

// Valid until the eye advances or ends.
const struct relume_aperture *relume_eye_aperture(const relume_eye *eye);

// The mean diameter p in mm for a field luminance in cd/m^2 (Eq. 8.2): as the thesis prints it, or
// as Moon and Spencer measured it (their millilamberts turned into cd/m^2).
double relume_pupil_mm(double luminance, bool moon_spencer);

#endif
