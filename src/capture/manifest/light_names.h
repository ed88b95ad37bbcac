// light_names.h - photographs and lights are paired by the names that a list gives
#ifndef CAPTURE_LIGHT_NAMES_H
#define CAPTURE_LIGHT_NAMES_H

#include <relume/base.h>

// The names in a list of lights. Borrowed.
struct light_names {
    const char *path;         // of the list
    int count;                // lights
    const char *const *name;  // [count], or NULL: it has no names
    const int *line;          // [count], or NULL: lights are counted from 1
    bool numbered;            // the names may be an index and no names
};

// order[photographs] becomes the light of each photograph by its name, -1 for photographs that the
// list does not name. Case never counts. Names are compared by folder and file name first, then by
// file name, then without its ending. Last, marks on Latin letters (composed or not) and a number
// in front of a name do not count. *matched is the number of photographs with a light.
// RELUME_EUNFIT with a message if a name is listed twice, or an index neither rises nor names the
// photographs; RELUME_ENOMEM.
relume_status light_names_pair(int *order, int *matched, const struct light_names *list,
                               const char *const *photograph, int photographs,
                               const struct relume_log *log);

// The same for a list that must suit all photographs: where no name matches, order[i] = i, with a
// warning if the list has names. RELUME_EUNFIT where this leaves another number of lights than
// photographs.
relume_status light_names_pair_all(int *order, int *matched, const struct light_names *list,
                                   const char *const *photograph, int photographs,
                                   const struct relume_log *log);

// Fails with a message that names the first photographs without a light and the first lights
// without a photograph; `advice` ends it. RELUME_EUNFIT.
relume_status light_names_refuse(const struct light_names *list, const int *order,
                                 const char *const *photograph, int photographs, const char *advice,
                                 const struct relume_log *log);

// The file name of a path with slashes or backslashes.
const char *light_names_base(const char *path);
// The file's name ends as pictures do, upper and lower case alike.
bool light_names_is_picture(const char *name);

#endif
