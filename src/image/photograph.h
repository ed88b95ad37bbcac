// photograph.h - what the camera noted in a file that is open
#ifndef IMAGE_PHOTOGRAPH_H
#define IMAGE_PHOTOGRAPH_H

#include "image/picture.h"

#include <relume/photograph.h>

void photograph_notes(struct relume_notes *out, const picture_reader *reader);

#endif
