// volume.h - samples of a regular grid in memory, as those who look at them see them
#ifndef VOLUME_VOLUME_H
#define VOLUME_VOLUME_H

#include <relume/shape/volume.h>

// In memory samples are of these, of the machine's byte order; others became floats, or 16 bits.
enum volume_type { VOLUME_U8, VOLUME_U16, VOLUME_I16, VOLUME_F32, VOLUME_TYPES };

// Samples of a brick: enough for its least and largest to say something, in rows of half a word.
enum { BRICK_X = 16, BRICK_Y = 8, BRICK_Z = 8 };

// The range of values in every brick, each with the first samples of the next ones.
struct volume_index {
    int bricks[3];
    float (*range)[2];  // least, largest; x runs fastest
};

struct relume_volume {
    int size[3];
    enum volume_type type;
    void *data;     // x runs fastest
    size_t mapped;  // 0, or that many bytes of a temporary file
    float min, max;
    double spacing[3];
    const char *format;
    struct volume_index index;  // `range` is NULL: there is none
};

// A volume of samples that are set afterwards, as are `min` and `max`; errors of
// relume_volume_from.
relume_status volume_create(relume_volume **out, const int size[3], const char *type,
                            const struct relume_volume_params *params);

static inline size_t volume_at(const relume_volume *v, int x, int y, int z)
{
    return ((size_t)z * (size_t)v->size[1] + (size_t)y) * (size_t)v->size[0] + (size_t)x;
}

static inline float volume_sample(const relume_volume *v, size_t at)
{
    switch (v->type) {
    case VOLUME_U8: return ((const uint8_t *)v->data)[at];
    case VOLUME_U16: return ((const uint16_t *)v->data)[at];
    case VOLUME_I16: return ((const int16_t *)v->data)[at];
    default: return ((const float *)v->data)[at];
    }
}

#endif
