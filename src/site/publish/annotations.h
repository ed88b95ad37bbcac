// annotations.h - notes that lie beside a file, or inside it, go into the site
#ifndef PUBLISH_ANNOTATIONS_H
#define PUBLISH_ANNOTATIONS_H

#include "site/publish/page.h"

#include <relume/exchange/notes.h>
#include <relume/pack.h>

// What the list of `path` says; empty where there is none. As relume_notes_open.
relume_status annotations_open(relume_notes **out, const struct site *site, const char *path,
                               relume_pack *pack);
// As NAME/notes.json, and for IIIF as NAME/iiif/notes.json; `inside`: relume_pack_info.notes.
// `moved` notes are written again.
// RELUME_EIO, RELUME_ENOMEM, and where the list cannot be read again an input status.
relume_status annotations_write(const struct site *site, const relume_notes *notes,
                                const char *path, const char *inside, const struct page *page,
                                bool moved);

#endif
