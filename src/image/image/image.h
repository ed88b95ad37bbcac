// image.h - how code values of a file become linear light, for whole images and for streams
#ifndef IMAGE_IMAGE_H
#define IMAGE_IMAGE_H

#include "core/kernel/kernels.h"
#include "image/image/picture.h"

#include <relume/image.h>

// Of the pixels; 0 for an empty image.
static inline uint64_t image_bytes(const struct relume_image *image)
{
    return image->data ? (uint64_t)image->width * (uint64_t)image->height *
                             (uint64_t)image->channels * sizeof *image->data
                       : 0;
}

// What `transfer` AUTO means for an open file.
struct relume_transfer image_transfer(struct relume_transfer transfer,
                                      const struct picture_info *info);

// As relume_image_create, in a temporary file beside `near` (NULL: $TMPDIR) where the image is so
// large that memory should hold no more of it than is looked at. RELUME_EIO.
relume_status image_create_large(struct relume_image *out, int width, int height, int channels,
                                 const char *near, const struct relume_log *log);
// As relume_image_load likewise.
relume_status image_load_large(struct relume_image *out, const char *path,
                               const struct relume_image_params *params, const char *near);
// Rows of such an image are not looked at for now. Of others nothing happens.
void image_forget(const struct relume_image *image, int row, int rows);

// A part of an image, which lies within it, as a new one. RELUME_ENOMEM.
relume_status image_part(struct relume_image *out, const struct relume_image *image,
                         const struct relume_rect *part);
// The image becomes that part of it.
relume_status image_crop(struct relume_image *image, const struct relume_rect *part);

enum { IMAGE_STREAM_ROWS = 16 };

// Reads rows of one file as 1 or 3 channels after a per-value function: decode by `from`, divide
// by gain[channel], encode by `to`. Bytes go through tables.
struct image_stream {
    picture_reader *reader;
    int channels;
    struct relume_transfer from, to;
    float gain[3];
    bool finite_only;     // NaN and infinity are errors; to be set after opening
    bool rounded;         // integers are rounded to half floats as linear light
    float table[3][256];  // per channel, for 8-bit files
    bool plain;           // 8-bit files: the tables are code / 255, pixels R, G, B
    const struct unpack_kernels *unpack;
    void *scratch;        // IMAGE_STREAM_ROWS rows of the file
    const uint8_t *kept;  // or all its rows, in place of reading, 8-bit files
    uint8_t *keep;        // or NULL: where all its rows go as they are read, 8-bit files
    size_t mapped;        // either is mapped from a file of so many bytes; else 0
};

// Takes over `reader`, also on failure. RELUME_ENOMEM.
relume_status image_stream_open(struct image_stream *stream, picture_reader *reader, int channels,
                                struct relume_transfer from, struct relume_transfer to,
                                const float gain[3]);
// Integers become what they are once they were linear half floats in a file.
void image_stream_round(struct image_stream *stream);
// out[row][x][channel]. Rows that are not kept come in the order of picture_read_floats; other
// orders and rows that are not there are RELUME_EINVAL. An input status; `error` has the sentence.
relume_status image_stream_read(struct image_stream *stream, int row, int rows, float *out);
// The same rows are not wanted: they are decoded only where those below need it, or are kept.
relume_status image_stream_skip(struct image_stream *stream, int row, int rows);
// 8-bit files: the same rows, at most IMAGE_STREAM_ROWS, as they are in the file, until the next
// call.
relume_status image_stream_fetch(struct image_stream *stream, int row, int rows,
                                 const uint8_t **bytes);
// Three channels of such pixels: out[channel * stride + pixel].
void image_stream_planes(const struct image_stream *stream, const uint8_t *bytes, size_t pixels,
                         float *out, size_t stride);
// Whether what went wrong is a sample that is not finite.
bool image_stream_is_broken(const struct image_stream *stream);
// What went wrong, for a sentence; belongs to the stream.
const char *image_stream_error(const struct image_stream *stream);
void image_stream_close(struct image_stream *stream);

#endif
