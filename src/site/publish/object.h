// object.h - a baked object (bake.h) in the site: object.json and the numbers that it tells of
#ifndef PUBLISH_OBJECT_H
#define PUBLISH_OBJECT_H

#include "site/publish/page.h"

// The object of a file: its folder with poster, notes and manifest, but not its page, of which the
// sizes are set. An input status with a sentence, RELUME_EUNSUPPORTED (wavelets, views apart, what
// is too large for a page), RELUME_ENOMEM, RELUME_EIO.
relume_status object_write(const struct site *site, struct page *page, const char *path,
                           struct relume_publish_report *report);

#endif
