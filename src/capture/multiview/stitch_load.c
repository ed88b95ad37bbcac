// stitch_load.c - opens the module that knows OpenCV when photographs are stitched
#include "capture/multiview/stitch.h"
#include "core/base/inputs.h"
#include "core/base/log.h"
#include "core/base/module.h"

#include <pthread.h>

static const struct stitch_bridge *bridge;
static char why_not[MODULE_WHY];
static int lacks;

static void load(void)
{
    bridge = module_open("stitch", why_not, &lacks);
}

relume_status stitch_find(struct stitch_pose *poses, int *stray, char *why,
                          const struct stitch_picture *pictures, int n,
                          const struct relume_log *log)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, load);
    if (bridge)
        return bridge->find(poses, stray, why, pictures, n);
    if (lacks)
        return relume_input_fail(log, "stitching", "its module cannot be loaded", lacks);
    return log_fail(log, RELUME_EIO,
                    "stitching: the module for it cannot be loaded; expected a build with OpenCV "
                    "('make deps-stitch', then 'make'); %s",
                    why_not);
}
