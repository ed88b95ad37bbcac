// luma_chroma.h - EXR pictures of luminance and coarser colour
#ifndef IMAGE_LUMA_CHROMA_H
#define IMAGE_LUMA_CHROMA_H

#include "image/image/exr.h"

// Thread-safety: one thread at a time.
typedef struct luma_chroma luma_chroma;

// Part 0 of `file`, which must outlive it; `*out` is NULL with RELUME_OK where it is no such
// picture. RELUME_ENOMEM, RELUME_EDAMAGED.
relume_status luma_chroma_open(luma_chroma **out, const exr_file *file);
// The next row from the top on, rgb[x][3], linear. An input status where the file is truncated or
// damaged, RELUME_ENOMEM.
relume_status luma_chroma_next(luma_chroma *picture, float *rgb);
void luma_chroma_close(luma_chroma **picture);

#endif
