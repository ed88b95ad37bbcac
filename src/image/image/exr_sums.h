// exr_sums.h - the check sums of an EXR file: of its head and of each of its blocks, so that bytes
// are noticed that copying, disks or networks have changed (docs/format.md, "Check sums")
#ifndef IMAGE_EXR_SUMS_H
#define IMAGE_EXR_SUMS_H

#include <relume/base.h>

#define EXR_SUMS_PART    "sums"
#define EXR_SUMS_CHANNEL "crc32"

// The words of the part behind all others: the sum of the head, those of the blocks of all parts,
// zeros, and last of all the sum of the words before it.
struct exr_sums {
    uint32_t *word;  // [height][width], NULL: there are none
    int width, height;
    size_t *first;  // [parts + 1], of each part the word of its first block
    int parts;
};

// Sums of `parts` parts, whose blocks are counted next. RELUME_ENOMEM.
relume_status exr_sums_create(struct exr_sums *out, int parts);
// The next part has so many blocks.
void exr_sums_count(struct exr_sums *sums, size_t blocks);
// All parts are counted: the words, all of them 0. RELUME_ENOMEM.
relume_status exr_sums_finish(struct exr_sums *sums);
void exr_sums_destroy(struct exr_sums *sums);

// CRC-32, that of zlib, of `size` bytes that follow those of which `before` is the sum (0: none).
uint32_t exr_sum(uint32_t before, const void *bytes, size_t size);
// What the last word is when the others are as they were written.
uint32_t exr_sums_own(const struct exr_sums *sums);

#endif
