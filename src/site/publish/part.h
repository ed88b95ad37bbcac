// part.h - a site shows a part of a file
#ifndef PUBLISH_PART_H
#define PUBLISH_PART_H

#include "site/publish/site.h"

#include <relume/exchange/notes.h>
#include <relume/pack.h>

// Crops an open file, of which nothing was read yet, and the notes on it, as site->params->crop and
// crop_auto say. `crop` gets what was kept, width 0: all. Notes beside that part are left out of
// the list, which is said. RELUME_EINVAL, RELUME_EUNFIT, errors of reading, RELUME_ENOMEM.
relume_status part_keep(int crop[4], relume_pack *pack, relume_notes **notes,
                        const struct site *site);

#endif
