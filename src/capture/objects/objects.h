// objects.h - captures of many objects being made
#ifndef OBJECTS_OBJECTS_H
#define OBJECTS_OBJECTS_H

#include "capture/acquire/acquire.h"

#include <relume/capture/objects.h>

// Fills name, photographs and path of each object that the inputs are. `dir` ends in no slash.
// RELUME_EINVAL where an output would replace photographs, RELUME_ENOTFOUND where no folder
// is left, RELUME_ENOMEM.
relume_status objects_find(struct relume_captured_objects *out, const char *dir,
                           const char *const *inputs, int count,
                           const struct relume_acquire_params *each, const struct relume_log *log);
// The same for the captures in `dir` without those of `known`; their `capture` is filled, and
// `photographs` is "". RELUME_ENOMEM.
relume_status objects_find_earlier(struct relume_captured_objects *out, const char *dir,
                                   const struct relume_captured_objects *known);

// Returns true for the folder of a finished capture.
bool object_is_capture(const char *path);
// Fills `capture` from the folder of the object's capture. RELUME_EUNFIT where it was made of other
// photographs than lie in the folder now; an input status, RELUME_ENOMEM.
relume_status object_recall(struct relume_captured_object *object, const struct relume_log *log);

// Returns an object's entry in the page: HTML, to be freed, or NULL: no memory. The folder
// `scratch` is used for temporary files.
char *object_entry(const struct relume_captured_object *object, const char *scratch,
                   const struct relume_log *log);
// The page: entries of `objects`, then of `earlier`; NULL: not yet.
struct objects_page {
    const char *dir;
    const struct relume_captured_objects *objects, *earlier;
    char **entry;
};
// Writes report.html. RELUME_EIO, RELUME_ENOMEM.
relume_status objects_page_write(const struct objects_page *page, const struct relume_log *log);
// Returns RELUME_EINVAL, and says so, where `dir` has a report.html of another kind.
relume_status objects_page_check(const char *dir, const struct relume_log *log);

#endif
