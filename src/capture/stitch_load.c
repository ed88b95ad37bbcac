// stitch_load.c - opens the module that knows OpenCV when photographs are to be stitched
#include "base/log.h"
#include "capture/stitch.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#define TEXT(x)  #x
#define QUOTE(x) TEXT(x)
static const char module_name[] = "librelume-stitch.so." QUOTE(RELUME_MAJOR);

static const struct stitch_bridge *bridge;
static char why_not[400];

static void load(void)
{
    void *module = dlopen(module_name, RTLD_LAZY | RTLD_LOCAL);
    const struct stitch_bridge *found = module ? dlsym(module, "relume_stitch_bridge") : NULL;
    if (!found)
        snprintf(why_not, sizeof why_not, "%s", dlerror());
    else if (strcmp(found->version, RELUME_VERSION) != 0)
        snprintf(why_not, sizeof why_not, "%s is of version %s; expected %s", module_name,
                 found->version, RELUME_VERSION);
    else
        bridge = found;
}

relume_status stitch_find(struct stitch_pose *poses, int *stray, char *why,
                          const struct stitch_picture *pictures, int n,
                          const struct relume_log *log)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, load);
    if (bridge)
        return bridge->find(poses, stray, why, pictures, n);
    return log_fail(log, RELUME_EIO,
                    "stitching: the module for it cannot be loaded; expected a build with OpenCV "
                    "('make deps-stitch', then 'make'); %s",
                    why_not);
}
