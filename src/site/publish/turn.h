// turn.h - still pictures of a baked object: its poster, and from around it
#ifndef PUBLISH_TURN_H
#define PUBLISH_TURN_H

#include "site/publish/page.h"

enum {
    POSTER_WIDTH = 640,
    POSTER_HEIGHT = 480,
    TURN_WIDTH = 400,
    TURN_HEIGHT = 300,
    TURN_STEPS = 8
};

// NAME/poster.jpg and, seen from every further step around the vertical axis, the smaller
// NAME/iiif/turn-N.jpg, N being 1 to TURN_STEPS - 1. RELUME_EFORMAT for an object without extent,
// an input status, RELUME_ENOMEM, RELUME_EIO.
relume_status turn_write(const struct site *site, struct page *page, const char *path);

#endif
