// details.h - what visitors of a site read: from options, and from a JSON file
#ifndef PUBLISH_DETAILS_H
#define PUBLISH_DETAILS_H

#include <relume/publish.h>

#include "core/base/json.h"

// Texts are borrowed; NULL: nothing is said.
struct details {
    const char *title, *maker, *licence, *object, *description;
};

// The file of `params->metadata`, NULL where there is none. What it says of the site and of the
// files is checked, and what it says of others is a warning. `stems`: names without folder and
// ending, NULL ends them. An input status with a sentence, RELUME_ENOMEM.
relume_status details_load(jvalue **root, const struct relume_publish_params *params,
                           const char *const *stems);
// Of the site; its title may be NULL.
struct details details_of_site(const jvalue *root, const struct relume_publish_params *params);
// Of a file by its stem, which is its title where nothing else is. `only`:
// it is the only one, and what is said of the site is said of it.
struct details details_of_file(const jvalue *root, const struct relume_publish_params *params,
                               const char *stem, bool only);
#endif
