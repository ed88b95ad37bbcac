// av1.h - small pictures of 12-bit samples as an AV1 sequence: libaom writes, dav1d reads
#ifndef LOSSY_AV1_H
#define LOSSY_AV1_H

#include <relume/base.h>

enum {
    AV1_BITS = 12,
    AV1_TOP = 4095,
    AV1_STEPS = 4,
    AV1_FINEST = AV1_STEPS,
    AV1_COARSEST = 63 * AV1_STEPS,
    AV1_SLOW = 3,
    AV1_FAST = 6
};

// A sequence of pictures: samples[picture][component][height][width], each 0 .. AV1_TOP. One
// component is grey, three are a luma and two chromas at full resolution.
struct av1_shape {
    int width, height, components, pictures;
};

// `quantiser` AV1_FINEST .. AV1_COARSEST: AV1_STEPS times what libaom calls so, of whose whole
// numbers the pictures have the two nearest in turn; `speed` AV1_SLOW .. AV1_FAST, which takes a
// fifth of the time for a quarter more bytes. The bytes are malloced. They depend on the version of
// libaom, not on the machine. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status av1_encode(unsigned char **bytes, size_t *size, const uint16_t *samples,
                         const struct av1_shape *shape, int quantiser, int speed,
                         const struct relume_log *log);
// Bytes that are no such sequence are RELUME_EDAMAGED. RELUME_ENOMEM.
relume_status av1_decode(uint16_t *samples, const struct av1_shape *shape,
                         const unsigned char *bytes, size_t size);

#endif
