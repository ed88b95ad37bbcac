// assets.h - what every site holds: the viewer, its core, the style of the pages; made of web/ by
// make/web.mk
#ifndef PUBLISH_ASSETS_H
#define PUBLISH_ASSETS_H

#include <stddef.h>

struct asset {
    const char *name;  // in the folder relume/ of the site
    const unsigned char *bytes;
    size_t size;
};
// Which of them pages load as they load data, and only when a file is dropped onto one.
#define ASSET_OPEN "relume-open.wasm"
// What sites with objects have for their pages.
#define ASSET_OBJECT "relume-object.js"
extern const struct asset site_assets[];  // NULL ends the list

#endif
