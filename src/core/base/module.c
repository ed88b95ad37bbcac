// module.c - the one file that opens shared libraries by name
#include "core/base/module.h"

#include "core/base/memory.h"

#include <dlfcn.h>
#include <errno.h>
#include <link.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define TEXT(x)  #x
#define QUOTE(x) TEXT(x)

// The linker's sentence ends in the system's, and in nothing where addresses are short.
static int shortage(const char *why)
{
    static const char no_addresses[] = "failed to map segment from shared object";
    static const int errors[] = {ENOMEM, EMFILE, ENFILE};
    const char *map = strstr(why, no_addresses);
    for (size_t i = 0; i < sizeof errors / sizeof *errors; i++)
        if (strstr(why, strerror(errors[i])))
            return errors[i];
    return map && !map[sizeof no_addresses - 1] ? ENOMEM : 0;
}

const void *module_open(const char *name, char why[MODULE_WHY], int *lacks)
{
    char file[64], symbol[64];
    snprintf(file, sizeof file, "librelume-%s.so." QUOTE(RELUME_MAJOR), name);
    snprintf(symbol, sizeof symbol, "relume_%s_bridge", name);
    void *module = dlopen(file, RTLD_LAZY | RTLD_LOCAL);
    const void *bridge = module ? dlsym(module, symbol) : NULL;
    if (!bridge) {
        snprintf(why, MODULE_WHY, "%s", dlerror());
        *lacks = shortage(why);
        return NULL;
    }
    const char *version;
    memcpy(&version, bridge, sizeof version);
    if (strcmp(version, RELUME_VERSION) == 0)
        return bridge;
    snprintf(why, MODULE_WHY, "%s is of version %s; expected %s", file, version, RELUME_VERSION);
    return NULL;
}

// The folders in which the linker looks for what the program or library that this is part of needs.
static Dl_serinfo *search_path(void)
{
    Dl_info own;
    void *object = NULL;
    Dl_serinfo size;
    if (!dladdr1((void *)(size_t)module_open, &own, &object, RTLD_DL_LINKMAP) ||
        dlinfo(object, RTLD_DI_SERINFOSIZE, &size))
        return NULL;
    Dl_serinfo *list = mem_array(size.dls_size, 1);
    if (list &&
        (dlinfo(object, RTLD_DI_SERINFOSIZE, list) || dlinfo(object, RTLD_DI_SERINFO, list))) {
        mem_free(list);
        return NULL;
    }
    return list;
}

bool module_program(const char *name, char path[PATH_MAX])
{
    Dl_serinfo *list = search_path();
    bool found = false;
    for (unsigned i = 0; list && i < list->dls_cnt && !found; i++) {
        const int n = snprintf(path, PATH_MAX, "%s/%s", list->dls_serpath[i].dls_name, name);
        found = n > 0 && n < PATH_MAX && !access(path, X_OK);
    }
    mem_free(list);
    return found;
}
