// module.c - the one file that opens shared libraries by name
#include "base/module.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

#define TEXT(x)  #x
#define QUOTE(x) TEXT(x)

const void *module_open(const char *name, char why[MODULE_WHY])
{
    char file[64], symbol[64];
    snprintf(file, sizeof file, "librelume-%s.so." QUOTE(RELUME_MAJOR), name);
    snprintf(symbol, sizeof symbol, "relume_%s_bridge", name);
    void *module = dlopen(file, RTLD_LAZY | RTLD_LOCAL);
    const void *bridge = module ? dlsym(module, symbol) : NULL;
    if (!bridge) {
        snprintf(why, MODULE_WHY, "%s", dlerror());
        return NULL;
    }
    const char *version;
    memcpy(&version, bridge, sizeof version);
    if (strcmp(version, RELUME_VERSION) == 0)
        return bridge;
    snprintf(why, MODULE_WHY, "%s is of version %s; expected %s", file, version, RELUME_VERSION);
    return NULL;
}
