// ubo.h - what ubo.c finds in a .btf file of the University of Bonn, for ubo_values.c
//
// The matrix of all values, pairs of directions by texels, is kept as a product of two: every value
// is a scalar product of a row of each. The rows lie in the mapped file, at any byte.
#ifndef BTF_UBO_H
#define BTF_UBO_H

#include "material/btf/btf.h"

enum { UBO_COLOURS = 3, UBO_MOST_RANK = 4096 };

// One colour of one kind, or one of the decorrelated ones.
struct ubo_plane {
    const uint8_t *pair, *texel;   // the first row of each
    size_t pair_step, texel_step;  // bytes from row to row
    int rank;                      // numbers of a row
    int scalar;                    // bytes of a number: 2, 4 or 8
};

struct ubo {
    const char *path;
    const struct relume_log *log;  // names the file in what others say
    const struct relume_btf_params *params;
    struct relume_limits limits;
    const uint8_t *bytes;
    size_t size, at;
    relume_status status;  // of what was read so far
    char kind;             // 'D': colours factored each by itself; 'F': all in one matrix
    bool extended, rotated;
    bool cosine;
    vec3 *view, *light;
    int views, lights;
    int odd_view, odd_light;  // the first light that is not where the first view's is; -1: none
    int width, height;        // of the file
    int crop[4];              // x, y, width, height of what is taken
    const struct ubo_colours *colours;
    float mean[3], matrix[9];  // of colours that have their own
    struct ubo_plane plane[UBO_COLOURS];
};

// How the numbers of the planes become red, green and blue.
struct ubo_colours {
    int number;  // in the file
    const char *name;
    void (*turn)(float *const v[UBO_COLOURS], size_t n, const struct ubo *u);
};
// NULL: not known here.
const struct ubo_colours *ubo_colours_find(int number);
enum { UBO_RGB = 0, UBO_LOG_RGB = 12 };

// Multiply it out into a BTF that has its memory.
relume_status ubo_store(const struct ubo *u, relume_btf *btf);

#endif
