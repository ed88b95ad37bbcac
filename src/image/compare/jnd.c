// jnd.c - the scale of just noticeable differences: opponent colours, contrast sensitivity, masking
// (Guthe 2008, section 10.2: Tab. 10.1; Daly 1993)
#include "image/compare/jnd.h"

#include <relume/image/jnd.h>

#include <math.h>

// Of the scale l = K ln(y + KY) of a cone's response y, cd/m^2: 1 % of daylight is one step.
#define K  100.0
#define KY 1.02

// sRGB (IEC 61966-2-1) to XYZ, and XYZ to cones (CAT02).
static const double xyz[3][3] = {
    {0.4124564, 0.3575761, 0.1804375},
    {0.2126729, 0.7151522, 0.0721750},
    {0.0193339, 0.1191920, 0.9503041},
};
static const double lms[3][3] = {
    {0.7328, 0.4296, -0.1624},
    {-0.7036, 1.6975, 0.0061},
    {0.0030, 0.0136, 0.9834},
};
static const double opponent[RELUME_OPPONENTS][3] = {
    {0.990, -0.106, -0.094},
    {-0.669, 0.742, -0.027},
    {-0.212, -0.354, 0.911},
};

static void multiply(double out[3], const double m[3][3], const double v[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
}

void relume_jnd_opponent(double out[RELUME_OPPONENTS], const double rgb[3], double white)
{
    double colour[3], cone[3], scaled[3];
    multiply(colour, xyz, rgb);
    multiply(cone, lms, colour);
    for (int i = 0; i < 3; i++)
        scaled[i] = K * log(fmin(fmax(cone[i] * white, 0.0), 1e12) + KY);
    multiply(out, opponent, scaled);
}

// Tab. 10.1: sums of Gaussians of the frequency in cycles per degree.
struct gaussian {
    double weight, sigma;
};
enum { GAUSSIANS = 3 };
static const struct gaussian achromatic[GAUSSIANS] = {
    {1.98488, 9.45161}, {1.06781, 7.07609}, {-1.18094, 3.14760}};
static const struct gaussian chromatic[GAUSSIANS] = {
    {0.27519, 7.00112}, {0.24116, 3.78524}, {0.0, 1.0}};

double relume_jnd_sensitivity(enum relume_opponent channel, double f)
{
    const struct gaussian *g = channel == RELUME_OPPONENT_WHITE ? achromatic : chromatic;
    double sum = 0.0;
    for (int i = 0; i < GAUSSIANS; i++)
        sum += g[i].weight * exp(-f * f / (g[i].sigma * g[i].sigma));
    return sum;
}

// Beyond its peak, 3.43 cycles per degree of white and 0 of colours, sensitivity falls steadily.
double relume_jnd_finest(enum relume_opponent channel, double sensitivity)
{
    double low = channel == RELUME_OPPONENT_WHITE ? 3.43 : 0.0, high = 200.0;
    if (!(relume_jnd_sensitivity(channel, low) >= sensitivity))
        return 0.0;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        if (relume_jnd_sensitivity(channel, middle) >= sensitivity)
            low = middle;
        else
            high = middle;
    }
    return low;
}

double relume_jnd_threshold(double masker)
{
    static const double K1 = 0.0152867, K2 = 392.498;  // 6^(-7/3), 6^(10/3)
    const double x = K1 * pow(K2 * masker, 0.7), square = x * x;
    return sqrt(sqrt(1.0 + square * square));
}
