// picture_info.h - what is known of an open picture
#ifndef IMAGE_PICTURE_INFO_H
#define IMAGE_PICTURE_INFO_H

#include <stdbool.h>

// An open picture file. Thread-safety: one thread at a time.
typedef struct picture_reader picture_reader;

struct picture_info {
    int width, height;
    int x, y;        // where the data window begins
    int channels;    // as read_* delivers them
    int rgb[3];      // which channel is red, green, blue; all equal for grey
    bool bytes;      // 8-bit integers: picture_read_bytes works
    bool floats;     // floating point: values do not end at 1
    bool linear;     // float samples, or an integer file that says it is linear
    bool jumps;      // rows may be read in any order, left out and read again
    char other[96];  // "", or the names of the channels, where none of them is colour
};

#endif
