// av1.h - small pictures of 12-bit samples as AV1 sequences: libaom writes, dav1d reads
//
// A preset says how libaom codes and with how many bits a sample. With fewer than 12 bits, samples
// are rounded before they are coded, so that 0 and AV1_TOP, and the middle of a chroma, stay.
#ifndef LOSSY_AV1_H
#define LOSSY_AV1_H

#include <relume/base.h>

enum {
    AV1_BITS = 12,
    AV1_TOP = 4095,
    AV1_MIDDLE = 2048,  // of a chroma
    AV1_STEPS = 4,
    AV1_FINEST = 3 * AV1_STEPS,
    AV1_COARSEST = 63 * AV1_STEPS,
    AV1_MOST_MEMBERS = 25
};

// Rows of av1_presets, the slowest first of each usage.
enum av1_preset_number {
    AV1_GOOD_2_SCREEN,
    AV1_GOOD_3_SCREEN,
    AV1_GOOD_6_SCREEN,
    AV1_GOOD_4,
    AV1_GOOD_6,
    AV1_INTRA_6,
    AV1_INTRA_9,
    AV1_REALTIME_5_12,
    AV1_REALTIME_6_12,
    AV1_REALTIME_6,
    AV1_REALTIME_7,
    AV1_REALTIME_8,
    AV1_REALTIME_9,
    AV1_REALTIME_10,
    AV1_PRESETS
};
enum av1_usage { AV1_GOOD, AV1_INTRA, AV1_REALTIME };
// One way of libaom. `speed` is what it calls cpu-used; `screen`: it also tries palettes and copies
// of blocks, as of pictures of screens.
struct av1_preset {
    const char *name;
    enum av1_usage usage;
    int speed, bits;  // 8 .. 12
    bool screen;
};
extern const struct av1_preset av1_presets[AV1_PRESETS];

// A sequence of pictures: samples[picture][component][height][width], each 0 .. AV1_TOP. One
// component is grey, three are a luma and two chromas at full resolution.
struct av1_shape {
    int width, height, components, pictures;
    // [pictures], or NULL: how often the step of a picture's samples was halved against the
    // largest. Its quantiser is coarser by as much.
    const unsigned char *halved;
};

// `quantiser` AV1_FINEST .. AV1_COARSEST: AV1_STEPS times what libaom calls so, of whose whole
// numbers the pictures have the two nearest in turn. Below the finest libaom 3.6 makes blocks of
// some pictures of 12 bits black or white.
struct av1_effort {
    int quantiser;
    enum av1_preset_number preset;
};
// The step of a quantiser, on orthonormal transforms of samples of 12 bits that are coded in
// `bits`.
double av1_step(int quantiser, int bits);

struct av1_bytes {
    unsigned char *byte;  // [size], mem_free
    size_t size, capacity;
};

// How many sequences can be one group.
int av1_most_members(int pictures);
// A group of sequences, out[members] of samples[members]. The first is decoded alone. Each picture
// of another one is predicted from the first one's picture of that number and the one before, and
// from its own last. The bytes depend on the version of libaom, not on the machine or `threads`,
// which are at least two. libaom runs in a process of relume-helper where that program is found,
// or in this one. RELUME_ENOMEM; RELUME_ESYSTEM and RELUME_ECODER (the process ended) with a
// message. Thread-safety: safe.
relume_status av1_encode(struct av1_bytes *out, const uint16_t *const *samples, int members,
                         const struct av1_shape *shape, const struct av1_effort *effort,
                         int threads, const struct relume_log *log);
// `first` is the group's first sequence where `bytes` are another one, else NULL. Bytes that are no
// such sequence are RELUME_EDAMAGED. RELUME_ENOMEM.
relume_status av1_decode(uint16_t *samples, const struct av1_shape *shape,
                         const struct av1_bytes *bytes, const struct av1_bytes *first);
// The same picture by picture: each is put into samples[component][height][width], then taken.
struct av1_pictures {
    uint16_t *samples;
    void (*take)(void *user, int picture);
    void *user;
};
relume_status av1_decode_each(const struct av1_pictures *to, const struct av1_shape *shape,
                              const struct av1_bytes *bytes, const struct av1_bytes *first);

#endif
