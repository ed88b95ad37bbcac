// oiio_load.c - opens the module that knows OpenImageIO when the first image needs it
#include "base/log.h"
#include "base/module.h"
#include "base/outfile.h"
#include "image/oiio.h"

#include <pthread.h>
#include <string.h>
#include <strings.h>

static const struct oiio_bridge *bridge;
static char why_not[MODULE_WHY];

static void load(void)
{
    bridge = module_open("oiio", why_not);
}

static relume_status need_bridge(const char *path, const struct relume_log *log)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, load);
    if (bridge)
        return RELUME_OK;
    return log_fail(log, RELUME_EIO, "%s: the module for image formats cannot be loaded; %s", path,
                    why_not);
}

relume_status oiio_open(oiio_reader **out, const char *path, const struct relume_limits *limits,
                        const struct relume_log *log)
{
    *out = NULL;
    const relume_status status = need_bridge(path, log);
    return status ? status : bridge->open(out, path, limits, log);
}

const struct oiio_info *oiio_info_of(const oiio_reader *reader)
{
    return bridge->info_of(reader);
}

relume_status oiio_read_floats(oiio_reader *reader, int row, int rows, float *out)
{
    return bridge->read_floats(reader, row, rows, out);
}

relume_status oiio_read_bytes(oiio_reader *reader, int row, int rows, uint8_t *out)
{
    return bridge->read_bytes(reader, row, rows, out);
}

void oiio_notes(const oiio_reader *reader, struct relume_notes *out)
{
    bridge->notes(reader, out);
}

const void *oiio_profile(const oiio_reader *reader, size_t *size)
{
    return bridge->profile(reader, size);
}

const char *oiio_error(const oiio_reader *reader)
{
    return bridge->error(reader);
}

void oiio_close(oiio_reader **reader)
{
    if (*reader)
        bridge->close(reader);
}

bool oiio_writes_floats(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && (strcasecmp(dot, ".hdr") == 0 || strcasecmp(dot, ".pfm") == 0);
}

relume_status oiio_write_bytes(const char *path, int width, int height, int channels,
                               const uint8_t *samples, const struct relume_log *log)
{
    const relume_status status = need_bridge(path, log);
    return status ? status
                  : bridge->write_bytes(path, width, height, channels, samples, outfile_save, log);
}

relume_status oiio_write_floats(const char *path, int width, int height, int channels,
                                const float *samples, const struct relume_log *log)
{
    const relume_status status = need_bridge(path, log);
    return status ? status
                  : bridge->write_floats(path, width, height, channels, samples, outfile_save, log);
}
