// picture.h - ordinary pictures in the site
#ifndef PUBLISH_PICTURE_H
#define PUBLISH_PICTURE_H

#include "site/publish/site.h"

#include <relume/image.h>
#include <relume/pack.h>

// An ordinary picture of a file, linear, at most `side` pixels wide and high (0: as it is), which
// the caller destroys: what a camera in the middle sees, lit from the front; a panorama unfolded,
// lit from above, or with `look` a look into it. Errors of relume_frame.
relume_status picture_still(struct relume_image *out, relume_pack *pack, int side, bool look,
                            const struct site *site);
// The same lit from a direction of length 1.
relume_status picture_lit(struct relume_image *out, relume_pack *pack, int side, bool look,
                          struct relume_vec3 direction, const struct site *site);
// A rectangle of a linear picture as a JPEG of the site, coded as sRGB.
relume_status picture_save_jpeg(const struct site *site, const char *name,
                                const struct relume_image *picture, const struct relume_rect *at);
// Bytes of 1 or 3 channels as PNG, with its script copy.
relume_status picture_save_png(const struct site *site, const char *name, int width, int height,
                               int channels, const uint8_t *samples);

#endif
