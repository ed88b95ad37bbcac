// picture_format.h - what a reader of picture files is made of
#ifndef IMAGE_PICTURE_FORMAT_H
#define IMAGE_PICTURE_FORMAT_H

#include "image/image/picture_info.h"
#include "image/image/picture_kind.h"

#include <relume/context.h>
#include <relume/image/photograph.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

struct infile;

// The functions of picture.h for one kind of files; only those that can be called.
struct picture_format {
    relume_status (*read_floats)(picture_reader *reader, int row, int rows, float *out);
    relume_status (*read_bytes)(picture_reader *reader, int row, int rows, uint8_t *out);
    // NULL: the file says nothing of itself. `out` already holds what the reader's `info` has.
    void (*notes)(const picture_reader *reader, struct relume_exif *out);
    const void *(*profile)(const picture_reader *reader, size_t *size);
    const char *(*error)(const picture_reader *reader);
    void (*close)(picture_reader *reader);
    // NULL: no file has several pages.
    relume_status (*turn)(picture_reader *reader, int page, const struct relume_limits *limits);
};

// What every reader begins with.
struct picture_reader {
    const struct picture_format *format;
    struct picture_info info;
    struct infile *exif;  // NULL, or the file `path`, for its notes: only the module knows EXIF
    const char *path;
    // Kept by picture.c.
    int next;              // row that comes next where rows do not jump
    relume_status broken;  // why no further rows can come there
    const char *misuse;    // NULL, or what was wrong with the last request
};

// What a file is; NULL where it cannot be read.
const struct picture_kind *picture_kind_at(const char *path);

// `*out` is NULL with RELUME_OK where the file is not of the plain kind: broken ones are not, and
// what is wrong with them is for the module to say. RELUME_ENOMEM, RELUME_ESYSTEM.
// All of these read `from` in place of the file `path` where that is not NULL (core/base/infile.h).
relume_status exr_picture_open(picture_reader **out, const char *path,
                               const struct relume_reader *from, const struct relume_limits *limits,
                               const struct relume_log *log);
relume_status png_picture_open(picture_reader **out, const char *path,
                               const struct relume_reader *from, const struct relume_limits *limits,
                               const struct relume_log *log);
// JPEG files of all kinds. An input status with a sentence, RELUME_ENOMEM.
relume_status jpeg_picture_open(picture_reader **out, const char *path,
                                const struct relume_reader *from,
                                const struct relume_limits *limits, const struct relume_log *log);

// Files of `kind`, by OpenImageIO in the helper; `file` is open for reading, `path` for sentences.
// An input status with a sentence, RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status helped_picture_open(picture_reader **out, int file, const char *path,
                                  const struct picture_kind *kind, uint64_t file_bytes,
                                  const struct relume_limits *limits, const struct relume_log *log);

// RELUME_EIO, RELUME_ENOMEM.
relume_status png_write(const char *path, const struct relume_writer *writer,
                        const struct picture_codes *codes, const struct relume_log *log);

typedef relume_status picture_save(const char *path, const struct relume_writer *writer,
                                   const void *bytes, size_t size, const struct relume_log *log);

// What the module exports, as `relume_oiio_bridge`.
struct oiio_bridge {
    const char *version;  // RELUME_VERSION of its build; another one's is not used
    // `file`, which the reader takes over, as `format` ("": whatever fits); `name` is the file's,
    // for its extension. Sentences have no file name. Opens no other file.
    relume_status (*open)(picture_reader **out, int file, const char *format, const char *name,
                          const struct relume_limits *limits, const struct relume_log *log);
    // `save` is the library's own outfile_save_to, for `path` and `writer`.
    relume_status (*write_codes)(const char *path, const struct relume_writer *writer,
                                 const struct picture_codes *codes, picture_save *save,
                                 const struct relume_log *log);
    relume_status (*write_floats)(const char *path, const struct relume_writer *writer, int width,
                                  int height, int channels, const float *samples,
                                  picture_save *save, const struct relume_log *log);
};

#ifdef __cplusplus
}
#endif
#endif
