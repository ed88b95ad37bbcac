// ptm.h - polynomial texture maps: .ptm files, version 1.2 and before (Malzbender and Gelb 2001)
#ifndef EXCHANGE_PTM_H
#define EXCHANGE_PTM_H

#include "exchange/foreign/foreign.h"

#include <relume/context.h>

// PTM_FORMAT_RGB, LRGB, JPEG_RGB and JPEG_LRGB. An input status with a sentence.
relume_status ptm_read(struct foreign *out, const char *path, const struct relume_limits *limits,
                       const struct relume_log *log);

// Raw PTM_FORMAT_RGB (channels) or PTM_FORMAT_LRGB (luminance) of six terms whose codes have
// ptm_quantiser's scales and offsets. RELUME_EIO.
relume_status ptm_write(const struct foreign *f, const char *path,
                        const struct relume_writer *writer, const struct relume_log *log);

// The same as PTM_FORMAT_JPEG_RGB or PTM_FORMAT_JPEG_LRGB.
struct ptm_jpeg {
    uint8_t *bytes;  // the file, from malloc
    size_t size;
    uint8_t *codes;           // [planes][height][width] of `f` as readers decode them, from malloc
    int predicted, inverted;  // planes
    size_t records;           // pixels of the side information
};

// `step`: of the quantisers, in units of the picture's error (1 is white); `quality`: what the file
// says of itself. RELUME_ENOMEM.
relume_status ptm_encode_jpeg(struct ptm_jpeg *out, const struct foreign *f, double step,
                              int quality, int threads);
void ptm_jpeg_free(struct ptm_jpeg *file);

// A coefficient in 0..255 is (code - bias) * scale with a whole bias: the finest scale whose codes
// hold [min, max].
struct ptm_quantiser {
    double scale;
    int bias;
};
struct ptm_quantiser ptm_quantiser(double min, double max);

#endif
