// segments.h - lines of a surface across one rectangle whose sides are crossed at most once
//
// The rectangle lies in a plane across axis a, its sides along axes u and v, where u, v, a are
// right-handed. Inside is to the left of a line, seen from where a points (Wong 1998, 4.4).
#ifndef ISOSURFACE_SEGMENTS_H
#define ISOSURFACE_SEGMENTS_H

#include <stdbool.h>

// The sides: at the lower and higher v along u, at the lower and higher u along v.
enum side { SIDE_B, SIDE_R, SIDE_T, SIDE_L };

struct segments {
    int count;
    unsigned char from[2], to[2];  // sides
};

// Corners are bits: (u0, v0) 1, (u1, v0) 2, (u1, v1) 4, (u0, v1) 8. `middle`: whether the middle is
// inside, which counts for 5 and 10 alone.
static inline bool segments_open(int corners)
{
    return corners == 5 || corners == 10;
}

static inline struct segments segments_of(int corners, bool middle)
{
    static const struct segments table[16] = {
        {0, {0, 0}, {0, 0}},
        {1, {SIDE_B, 0}, {SIDE_L, 0}},
        {1, {SIDE_R, 0}, {SIDE_B, 0}},
        {1, {SIDE_R, 0}, {SIDE_L, 0}},
        {1, {SIDE_T, 0}, {SIDE_R, 0}},
        {2, {SIDE_B, SIDE_T}, {SIDE_L, SIDE_R}},
        {1, {SIDE_T, 0}, {SIDE_B, 0}},
        {1, {SIDE_T, 0}, {SIDE_L, 0}},
        {1, {SIDE_L, 0}, {SIDE_T, 0}},
        {1, {SIDE_B, 0}, {SIDE_T, 0}},
        {2, {SIDE_R, SIDE_L}, {SIDE_B, SIDE_T}},
        {1, {SIDE_R, 0}, {SIDE_T, 0}},
        {1, {SIDE_L, 0}, {SIDE_R, 0}},
        {1, {SIDE_B, 0}, {SIDE_R, 0}},
        {1, {SIDE_L, 0}, {SIDE_B, 0}},
        {0, {0, 0}, {0, 0}},
    };
    static const struct segments middle_inside[2] = {
        {2, {SIDE_B, SIDE_T}, {SIDE_R, SIDE_L}},  // 5
        {2, {SIDE_L, SIDE_R}, {SIDE_B, SIDE_T}},  // 10
    };
    return middle && segments_open(corners) ? middle_inside[corners == 10] : table[corners];
}

#endif
