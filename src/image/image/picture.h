// picture.h - picture files of every format, row by row
//
// JPEG files and EXR and PNG files of the plain kind, which are most, are read by jpeg.c, exr.c and
// png.c; all others of the formats that picture_kind.c lists, and EXIF, by OpenImageIO in a process
// of their own (core/base/helper.h). That one brings over 200 shared libraries, a third of a second
// at every start: so the C++ that knows it (oiio.cpp) is a module, librelume-oiio.so. The helper
// opens it when the first file asks for it, picture.c before it writes one; nobody else notices.
#ifndef IMAGE_PICTURE_H
#define IMAGE_PICTURE_H

#include "image/image/picture_info.h"

#include <relume/context.h>
#include <relume/image/photograph.h>

#ifdef __cplusplus
extern "C" {
#endif

// The file `path`, or what `from` reads (core/base/infile.h). An input status with a sentence that
// names the file.
relume_status picture_open(picture_reader **out, const char *path, const struct relume_reader *from,
                           const struct relume_limits *limits, const struct relume_log *log);

// Samples in memory, row 0 at the top, of 1, 2 or 4 bytes (floats); channels are grey, or red,
// green and blue and one that is not looked at. Borrowed.
struct picture_array {
    const void *data;
    size_t bytes;  // of a sample
    int width, height, channels;
    bool halves;  // those of 2 bytes are half floats, no codes
};
// The same for those. RELUME_ENOMEM.
relume_status array_picture_open(picture_reader **out, const struct picture_array *array);
// The reader becomes one of a part of its picture, whose notes and profile are left out.
// RELUME_EINVAL for a part that does not lie within it, RELUME_ENOMEM: the reader stays as it is.
relume_status picture_crop(picture_reader **reader, const struct relume_rect *part);
const struct picture_info *picture_info_of(const picture_reader *reader);
// Code values of `rows` rows from `row` on, out[row][x][channel]: as they are from files of bytes;
// as floats from all others, integers map to [0, 1]. With `info.jumps` rows come in any order and
// again. Without it they come from the top on, once each. RELUME_EINVAL for another order, for rows
// that are not there and for the other type: nothing is written, and the next rows can be read.
// After an input status or RELUME_ENOMEM a reader without `info.jumps` fails alike from then on.
// No log: threads that read must not speak; picture_error has the sentence.
relume_status picture_read_floats(picture_reader *reader, int row, int rows, float *out);
relume_status picture_read_bytes(picture_reader *reader, int row, int rows, uint8_t *out);
bool picture_has_rows(const struct picture_info *info, int row, int rows);
// Another page of a file that has several (TIFF), counted from 0; the reader's info becomes that
// page's, and its rows are asked for from the top on. RELUME_ENOTFOUND where there is no such page;
// no log, as above.
relume_status picture_turn(picture_reader *reader, int page, const struct relume_limits *limits);
// What the camera noted: all but the profile; EXIF of files only. RELUME_ESYSTEM without the
// helper, where it takes that.
relume_status picture_notes(const picture_reader *reader, struct relume_exif *out,
                            const struct relume_log *log);
// The ICC profile, NULL when there is none; belongs to the reader.
const void *picture_profile(const picture_reader *reader, size_t *size);
// An input status with a sentence that names the channels, when none of them is colour.
relume_status picture_need_colour(const picture_reader *reader, const char *path,
                                  const struct relume_log *log);
// Which of `info->channels` are colour, by their names: red, green and blue, else luminance, else
// the only one unless it is depth or coverage. Without names (NULL): the first ones.
void picture_find_colour(struct picture_info *info, const char *const *names);
// Whether first bytes, `n` of them or those of a file, are a relume file's; a picture's too, its
// preview.
bool picture_head_is_relume(const char *head, size_t n);
bool picture_is_relume(const char *path, const struct relume_log *log);
// What went wrong last, for a sentence; "" when nothing did. Belongs to the reader.
const char *picture_error(const picture_reader *reader);
void picture_close(picture_reader **reader);

// Write interleaved samples to `path` or `writer`, whole or not at all: floats for formats that
// hold them, else bytes. RELUME_EINVAL for an extension that nobody writes, RELUME_EIO.
bool picture_writes_floats(const char *path);
bool picture_writes_bytes(const char *path);
relume_status picture_write_bytes(const char *path, const struct relume_writer *writer, int width,
                                  int height, int channels, const uint8_t *samples,
                                  const struct relume_log *log);
// Samples of 1 or 2 bytes as they stand in a file.
struct picture_codes {
    struct picture_array array;
    bool data;            // values that are no sRGB codes
    const void *profile;  // ICC, which formats without one leave out; NULL: none
    size_t profile_size;
    int threads;  // of PNG; up to 1: one
};
// Writes these likewise. picture_writes_words names the formats of 2 bytes.
bool picture_writes_words(const char *path);
relume_status picture_write_codes(const char *path, const struct relume_writer *writer,
                                  const struct picture_codes *codes, const struct relume_log *log);
relume_status picture_write_floats(const char *path, const struct relume_writer *writer, int width,
                                   int height, int channels, const float *samples,
                                   const struct relume_log *log);

#ifdef __cplusplus
}
#endif
#endif
