// module.h - parts of the library that are loaded when they are first needed
#ifndef BASE_MODULE_H
#define BASE_MODULE_H

#include <limits.h>
#include <relume/base.h>

enum { MODULE_WHY = 400 };

// Open librelume-NAME.so of this major version, found as the library itself is (run path,
// LD_LIBRARY_PATH, ld.so.conf), and return what it exports as relume_NAME_bridge: a struct whose
// first member is the RELUME_VERSION of its build. NULL with a reason in `why` when it is not there
// or of another version; `*lacks` is an errno then where the machine is short of something, or 0.
// It stays open.
const void *module_open(const char *name, char why[MODULE_WHY], int *lacks);

// The path of the program NAME that lies where modules do; false: there is none.
bool module_program(const char *name, char path[PATH_MAX]);

#endif
