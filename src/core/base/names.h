// names.h - enumerations by name
#ifndef BASE_NAMES_H
#define BASE_NAMES_H

#include <relume/base.h>

// The place of `name` among `count` names, some of which may be NULL; -1 when it is none of them.
int name_find(const char *name, const char *const *names, size_t count);

#endif
