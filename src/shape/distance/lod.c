// lod.c - how much of a surface is needed at a distance (Meseth 2008, chapter 6: errors as they are
// seen)
#include "shape/distance/lod.h"

#include <math.h>

double relume_lod_pixels(double error, double distance, double view_rad, int height)
{
    return distance > 0.0 ? error * height / (2.0 * distance * tan(0.5 * view_rad)) : INFINITY;
}

int relume_lod_choose(const double *error, int n, double pixels, double distance, double view_rad,
                      int height)
{
    int level = 0;
    while (level + 1 < n &&
           relume_lod_pixels(error[level + 1], distance, view_rad, height) <= pixels)
        level++;
    return level;
}

double relume_lod_priority(double current, double target, bool seen)
{
    const double p = fmax(current / target, target / current);
    return seen ? p : 1.0 - 1.0 / p;
}
