// moving.h - what shadows or highlights of a view move by (relume/relight/shadow.h)
//
// NAME/v0/moving.bin has the form of a tile (levels.h) with three pictures: eight numbers a pixel,
// in the order of the file's, as codes of 8 bits, and a ninth that means nothing. A number is
// curve(code scale + offset): x |x|, but 2^x of thicknesses, x of normals, roughness and share, and
// of shine its sign times max(|x| - 1/8, 0)^2. Codes of thicknesses above 247 are infinite.
#ifndef PUBLISH_MOVING_H
#define PUBLISH_MOVING_H

#include "site/publish/site.h"

#include <relume/pack.h>

enum { MOVING_NUMBERS = 8 };

// Of a view.
struct moving {
    bool there;
    float scale[MOVING_NUMBERS], offset[MOVING_NUMBERS];
};

// Writes moving.bin of a view into the folder `name` of the site, where the file has a model of it.
// Errors of reading, RELUME_EIO, RELUME_ENOMEM.
relume_status moving_write(struct moving *out, const struct site *site, const char *name,
                           relume_pack *pack, int view);

#endif
