// report_picture.h - pictures inside an HTML page
#ifndef ACQUIRE_REPORT_PICTURE_H
#define ACQUIRE_REPORT_PICTURE_H

#include <relume/image.h>
#include <stdio.h>

enum report_look { LOOK_LIGHT, LOOK_NORMAL };

// An <img> with its JPEG in it: `image` (1 or 3 channels) made fit into a square of `side` pixels,
// values times `gain`. A file of the folder `dir` is used and removed. RELUME_EIO, RELUME_ENOMEM.
relume_status report_picture(FILE *page, const char *dir, const struct relume_image *image,
                             int side, float gain, enum report_look look,
                             const struct relume_log *log);

// The gain that shows an image well: its root mean square becomes 0.35.
float report_gain(const struct relume_image *image);

#endif
