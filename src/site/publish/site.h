// site.h - a site on its way: where its files go
#ifndef PUBLISH_SITE_H
#define PUBLISH_SITE_H

#include <relume/publish.h>

#include "site/publish/text.h"

struct site {
    const char *path;  // the folder that is being made
    const struct relume_publish_params *params;
    const struct relume_log *log;
};

// A file by its name below the site, in folders that are made where they are not there.
relume_status site_save(const struct site *site, const char *name, const void *bytes, size_t size);
// The same of what the page's script reads: with its script copy NAME.js, as the target asks.
relume_status site_save_data(const struct site *site, const char *name, const void *bytes,
                             size_t size);
// Either of a text that is closed here, and freed.
relume_status site_save_text(const struct site *site, const char *name, bool data, struct text *t);
// Either of a JSON text, the file `name` in a folder of the site. Frees what the writer holds.
relume_status site_save_json(const struct site *site, const char *folder, const char *name,
                             bool data, struct jwriter *w);

// Where a file of the site will be, for others: below its address, or relative where nobody knows.
void site_put_address(FILE *f, const struct site *site, const char *name);

#endif
