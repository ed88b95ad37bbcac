// jnd.h - the steps of the visible differences model
#ifndef COMPARE_JND_H
#define COMPARE_JND_H

#include <relume/image/jnd.h>

// The opponent channels.
enum relume_opponent {
    RELUME_OPPONENT_WHITE,   // white to black
    RELUME_OPPONENT_RED,     // red to green
    RELUME_OPPONENT_YELLOW,  // blue to yellow
    RELUME_OPPONENTS
};

// Linear sRGB times the luminance that a screen gives white, cd/m^2, as opponent responses. Below 0
// is taken as 0.
void relume_jnd_opponent(double out[RELUME_OPPONENTS], const double rgb[3], double white_cd_m2);
// The sensitivity to a grating of that many cycles per degree, 1 / JND; at most 2.224, for
// RELUME_OPPONENT_WHITE at 3.43 cycles per degree.
double relume_jnd_sensitivity(enum relume_opponent channel, double cycles_per_degree);
// The finest pattern, cycles per degree, whose sensitivity is still `sensitivity`, > 0; 0 where
// none is so well seen.
double relume_jnd_finest(enum relume_opponent channel, double sensitivity);
// The threshold beside a masker whose amplitude is `masker` JND: 1 without one. Daly 1993,
// Eq. 14.11: (1 + (k1 (k2 m)^s)^b)^(1/b), k1 = 6^(-7/3), k2 = 6^(10/3), s = 0.7, b = 4.
double relume_jnd_threshold(double masker);

#endif
