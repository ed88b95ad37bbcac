// iiif.h - the same file for viewers of the International Image Interoperability Framework
//
// An image service of level 0 (Image API 3.0: tiles that lie there) of the still that stands for
// the file, at its full size, and a manifest (Presentation API 3.0) with scene.json, the
// coefficient layers, as a further resource.
#ifndef PUBLISH_IIIF_H
#define PUBLISH_IIIF_H

#include "publish/page.h"
#include "publish/site.h"

#include <relume/pack.h>

// The address of the file's only canvas; the caller frees it. NULL when memory is short.
char *iiif_canvas(const struct site *site, const char *name);
// `notes`: there is a page of annotations, NAME/iiif/notes.json.
relume_status iiif_write(const struct site *site, const struct page *page, relume_pack *pack,
                         bool notes);

#endif
