// picture_kind.h - what a file is by its first bytes, and which pictures are read at all
#ifndef IMAGE_PICTURE_KIND_H
#define IMAGE_PICTURE_KIND_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PICTURE_HEAD = 264, PICTURE_FOOT = 18 };

// The beginning and the end of a file; zeros where it is shorter.
struct picture_look {
    uint8_t head[PICTURE_HEAD], foot[PICTURE_FOOT];
    uint64_t bytes;  // of the whole file
};

struct picture_kind {
    const char *what;    // "a TIFF image"; NULL: nobody knows
    const char *reader;  // OpenImageIO's name for its format; "": any; NULL: it reads no such files
    bool inside;         // read by our own reader where the file is of the plain kind
    bool listed;         // read without being asked to; others by --any-format
    uint32_t ratio;      // a byte of the file is at most so many of samples
    const char *advice;  // for those that are not listed
};

// Whether a name ends in ".png", in any case.
bool picture_has_extension(const char *path, const char *extension);
// Whether a name ends as those of cameras' raw photographs do: ".dng", ".nef", ...
bool picture_is_raw_name(const char *path);

// Never NULL; `path` counts where first bytes say too little: TGA, and RAW that looks like TIFF.
const struct picture_kind *picture_kind_of(const struct picture_look *look, const char *path);

// Whether a file of so many bytes can be worth so many bytes of samples: 64 MiB always, beyond
// that the kind's ratio. What claims more is damaged, or made to fill memory.
bool picture_kind_is_likely(const struct picture_kind *kind, uint64_t file_bytes,
                            uint64_t sample_bytes);

#endif
