// published.h - one file in the site: scene.json and the tiles of its views
#ifndef PUBLISH_PUBLISHED_H
#define PUBLISH_PUBLISHED_H

#include "site/publish/common.h"
#include "site/publish/details.h"
#include "site/publish/layers.h"
#include "site/publish/levels.h"
#include "site/publish/moving.h"
#include "site/publish/site.h"

#include <relume/relight/relief.h>
#include <stdio.h>

// A file that is being published.
struct published {
    const struct site *site;
    relume_pack *pack;
    const char *name;  // of its page and folder
    struct details details;
    double mm_per_pixel;  // 0: not known
    bool notes;           // there are some
    struct common common;
    struct levels levels;
    struct layers *layers;      // [views]
    struct moving *moving;      // [views]
    double *minimum, *maximum;  // [planes]
    bool usual;                 // the step is that of nobody's wish
    int first_level;
    bool metered;                 // exposure is known
    double exposure;              // EV
    struct relume_relief relief;  // captured lights that show it
    struct relume_publish_report *report;
};

// Planes, tiles and scene.json of the file, in a folder of its name.
relume_status published_write(struct published *f);
void published_free(struct published *f);

// scene.json alone, when all else is known: its members, and the file.
void published_put_json(struct jwriter *w, const struct published *f);
relume_status published_write_json(const struct published *f);

#endif
