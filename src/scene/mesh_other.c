#include "scene/mesh_other.h"

#include "base/inputs.h"
#include "base/log.h"
#include "base/module.h"

#include <errno.h>
#include <pthread.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const struct assimp_bridge *bridge;
static char why_not[MODULE_WHY];

static void load(void)
{
    bridge = module_open("assimp", why_not);
}

static relume_status check_file(const char *path, const struct relume_log *log)
{
    static const off_t MAX_BYTES = (off_t)1 << 31;
    struct stat s;
    if (stat(path, &s) || access(path, R_OK))
        return log_fail(log, RELUME_EDATA, "%s: cannot be opened; %s", path, strerror(errno));
    if (!S_ISREG(s.st_mode) || s.st_size > MAX_BYTES)
        return log_fail(log, RELUME_EDATA, "%s: expected a regular file of at most 2 GiB", path);
    return RELUME_OK;
}

relume_status mesh_read_other(struct mesh_file *out, const char *path, const struct relume_log *log)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    char why[MESH_OTHER_WHY] = "";
    input_note(log, path);
    const relume_status status = check_file(path, log);
    if (status)
        return status;
    pthread_once(&once, load);
    if (!bridge)
        return log_fail(log, RELUME_ESYSTEM, "%s: the module for models cannot be loaded; %s", path,
                        why_not);
    if (bridge->read(out, path, why))
        return RELUME_OK;
    mesh_file_free(out);
    return why[0] ? log_fail(log, RELUME_EDATA, "%s: not read as a model; %s", path, why)
                  : RELUME_ENOMEM;
}
