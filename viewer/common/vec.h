// vec.h - vectors of the viewer, and a number between two
#ifndef VIEWER_VEC_H
#define VIEWER_VEC_H

#define RELUME_VEC3_SHORT
#include <relume/core/vec.h>

static inline double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

#endif
