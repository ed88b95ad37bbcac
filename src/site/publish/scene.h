// scene.h - one file in the site: scene.json and the tiles of its views
#ifndef PUBLISH_SCENE_H
#define PUBLISH_SCENE_H

#include "site/publish/common.h"
#include "site/publish/details.h"
#include "site/publish/layers.h"
#include "site/publish/levels.h"
#include "site/publish/moving.h"
#include "site/publish/site.h"

#include <stdio.h>

// A file that is being published.
struct scene {
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
    bool metered;     // exposure is known
    double exposure;  // EV
    struct relume_publish_report *report;
};

// Planes, tiles and scene.json of the file, in a folder of its name.
relume_status scene_write(struct scene *s);
void scene_free(struct scene *s);

// scene.json alone, when all else is known: its members, and the file.
void scene_put_json(struct jwriter *w, const struct scene *s);
relume_status scene_write_json(const struct scene *s);

#endif
