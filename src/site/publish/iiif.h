// iiif.h - the same file for viewers of the International Image Interoperability Framework
//
// An image service of level 0 (Image API 3.0: tiles that lie there) of the still that stands for
// the file, at its full size, and a manifest (Presentation API 3.0) with scene.json, the
// coefficient layers, as a further resource. Of a baked object a manifest with a canvas for each
// picture from around it, and object.json, the model, as a further resource.
#ifndef PUBLISH_IIIF_H
#define PUBLISH_IIIF_H

#include "site/publish/page.h"
#include "site/publish/site.h"

#include <relume/pack.h>

// The address of what notes are on, the file's only canvas or the model of an object; the caller
// frees it. NULL when memory is short.
char *iiif_target(const struct site *site, const struct page *page);
// `notes`: there is a page of annotations, NAME/iiif/notes.json.
relume_status iiif_write(const struct site *site, const struct page *page, relume_pack *pack,
                         bool notes);
// The same of an object, whose pictures turn.h names.
relume_status iiif_write_object(const struct site *site, const struct page *page, bool notes);

#endif
