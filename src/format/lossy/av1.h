// av1.h - small pictures of 12-bit samples as AV1 sequences: libaom writes, dav1d reads
#ifndef LOSSY_AV1_H
#define LOSSY_AV1_H

#include <relume/base.h>

enum {
    AV1_BITS = 12,
    AV1_TOP = 4095,
    AV1_STEPS = 4,
    AV1_FINEST = 3 * AV1_STEPS,
    AV1_COARSEST = 63 * AV1_STEPS,
    AV1_SLOW = 2,
    AV1_USUAL = 3,
    AV1_FAST = 6,
    AV1_MOST_MEMBERS = 25
};

// A sequence of pictures: samples[picture][component][height][width], each 0 .. AV1_TOP. One
// component is grey, three are a luma and two chromas at full resolution.
struct av1_shape {
    int width, height, components, pictures;
};

// `quantiser` AV1_FINEST .. AV1_COARSEST: AV1_STEPS times what libaom calls so, of whose whole
// numbers the pictures have the two nearest in turn. Below the finest libaom 3.6 makes blocks of
// some pictures of 12 bits black or white. `speed` AV1_SLOW .. AV1_FAST: compared with
// the slow one the usual takes less than half of the time for 6 % more bytes, the fast a sixth of
// it for 18 %.
struct av1_effort {
    int quantiser, speed;
};
struct av1_bytes {
    unsigned char *byte;  // [size], mem_free
    size_t size, capacity;
};

// How many sequences can be one group.
int av1_most_members(int pictures);
// A group of sequences, out[members] of samples[members]. The first is decoded alone. Each picture
// of another one is predicted from the first one's picture of that number and the one before, and
// from its own last. The bytes depend on the version of libaom, not on the machine or `threads`,
// which are at least two. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status av1_encode(struct av1_bytes *out, const uint16_t *const *samples, int members,
                         const struct av1_shape *shape, const struct av1_effort *effort,
                         int threads, const struct relume_log *log);
// `first` is the group's first sequence where `bytes` are another one, else NULL. Bytes that are no
// such sequence are RELUME_EDAMAGED. RELUME_ENOMEM.
relume_status av1_decode(uint16_t *samples, const struct av1_shape *shape,
                         const struct av1_bytes *bytes, const struct av1_bytes *first);

#endif
