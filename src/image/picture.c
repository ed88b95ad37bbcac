// picture.c - which reader and writer a picture file gets; opens the module that knows OpenImageIO
// when the first file needs it
#include "image/picture.h"

#include "base/inputs.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/module.h"
#include "base/outfile.h"
#include "image/picture_format.h"

#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

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

// ---------------------------------------------------------------- reading

enum { MAGIC = 8 };

// The first bytes of the file, 0 where it has fewer.
static relume_status look(char bytes[MAGIC], const char *path, const struct relume_log *log)
{
    struct stat s;
    memset(bytes, 0, MAGIC);
    if (stat(path, &s))
        return log_fail(log, RELUME_EDATA, "%s: no such file; expected an image", path);
    if (!S_ISREG(s.st_mode) || s.st_size == 0)
        return log_fail(log, RELUME_EDATA, "%s: empty file or folder; expected an image", path);
    FILE *f = input_open(path, log);
    if (!f)
        return log_fail(log, RELUME_EDATA, "%s: cannot be opened; %s", path, strerror(errno));
    if (fread(bytes, 1, MAGIC, f) < MAGIC)
        memset(bytes, 0, MAGIC);
    fclose(f);
    return RELUME_OK;
}

relume_status picture_open(picture_reader **out, const char *path,
                           const struct relume_limits *limits, const struct relume_log *log)
{
    char bytes[MAGIC];
    *out = NULL;
    relume_status status = look(bytes, path, log);
    if (!status && !memcmp(bytes, "\x76\x2f\x31\x01", 4))
        status = exr_picture_open(out, path, limits);
    else if (!status && !memcmp(bytes, "\x89PNG\r\n\x1a\n", MAGIC))
        status = png_picture_open(out, path, limits);
    else if (!status && !memcmp(bytes, "\xff\xd8\xff", 3))
        status = jpeg_picture_open(out, path, limits, log);
    if (!*out && !status)
        status = need_bridge(path, log);
    return *out || status ? status : bridge->open(out, path, limits, log);
}

const struct picture_info *picture_info_of(const picture_reader *reader)
{
    return &reader->info;
}

relume_status picture_read_floats(picture_reader *reader, int row, int rows, float *out)
{
    return reader->format->read_floats(reader, row, rows, out);
}

relume_status picture_read_bytes(picture_reader *reader, int row, int rows, uint8_t *out)
{
    return reader->format->read_bytes(reader, row, rows, out);
}

static relume_status exif_notes(const char *path, struct relume_notes *out,
                                const struct relume_log *log)
{
    picture_reader *reader;
    relume_status status = need_bridge(path, log);
    if (!status)
        status = bridge->open(&reader, path, NULL, log);
    if (status)
        return status;
    reader->format->notes(reader, out);
    picture_close(&reader);
    return RELUME_OK;
}

relume_status picture_notes(const picture_reader *reader, struct relume_notes *out,
                            const struct relume_log *log)
{
    const struct picture_info *info = &reader->info;
    *out = (struct relume_notes){.width = info->width,
                                 .height = info->height,
                                 .orientation = 1,
                                 .linear = info->linear,
                                 .bytes = info->bytes,
                                 .floats = info->floats};
    if (reader->format->notes)
        reader->format->notes(reader, out);
    return reader->exif ? exif_notes(reader->exif, out, log) : RELUME_OK;
}

const void *picture_profile(const picture_reader *reader, size_t *size)
{
    *size = 0;
    return reader->format->profile ? reader->format->profile(reader, size) : NULL;
}

const char *picture_error(const picture_reader *reader)
{
    return reader->format->error(reader);
}

void picture_close(picture_reader **reader)
{
    if (*reader)
        (*reader)->format->close(*reader);
    *reader = NULL;
}

// ---------------------------------------------------------------- writing

bool picture_has_extension(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, extension) == 0;
}

static bool has_one_of(const char *path, const char *const *extensions)
{
    while (*extensions && !picture_has_extension(path, *extensions))
        extensions++;
    return *extensions != NULL;
}

bool picture_writes_floats(const char *path)
{
    static const char *const floats[] = {".hdr", ".rgbe", ".pfm", NULL};
    return has_one_of(path, floats);
}

// What relume reads again as a matter of course. OpenImageIO writes more kinds; grey ones (.pgm),
// palettes (.gif) and those that it cannot read back are not for pictures of light.
bool picture_writes_bytes(const char *path)
{
    static const char *const bytes[] = {
        ".png", ".jpg", ".jpeg", ".jpe", ".tif", ".tiff", ".bmp",  ".tga",  ".targa",
        ".ppm", ".pnm", ".webp", ".jp2", ".j2k", ".avif", ".heic", ".heif", NULL,
    };
    return has_one_of(path, bytes);
}

relume_status picture_write_bytes(const char *path, int width, int height, int channels,
                                  const uint8_t *samples, const struct relume_log *log)
{
    if (picture_has_extension(path, ".png"))
        return png_write(path, width, height, channels, samples, log);
    const relume_status status = need_bridge(path, log);
    return status ? status
                  : bridge->write_bytes(path, width, height, channels, samples, outfile_save, log);
}

// Which OpenImageIO reads and does not write: rows from the bottom up, the sign says little endian.
static relume_status write_pfm(const char *path, int width, int height, int channels,
                               const float *samples, const struct relume_log *log)
{
    enum { HEAD = 64 };
    const size_t row = (size_t)width * (size_t)channels;
    char *bytes = mem_array(row * (size_t)height * sizeof *samples + HEAD, 1);
    if (!bytes)
        return RELUME_ENOMEM;
    const char *scale = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? "-1.0" : "1.0";
    const int head =
        snprintf(bytes, HEAD, "P%c\n%d %d\n%s\n", channels == 3 ? 'F' : 'f', width, height, scale);
    char *to = bytes + head;
    for (int y = height; y-- > 0; to += row * sizeof *samples)
        memcpy(to, samples + (size_t)y * row, row * sizeof *samples);
    const relume_status status = outfile_save(path, bytes, (size_t)(to - bytes), log);
    free(bytes);
    return status;
}

relume_status picture_write_floats(const char *path, int width, int height, int channels,
                                   const float *samples, const struct relume_log *log)
{
    if (picture_has_extension(path, ".pfm"))
        return write_pfm(path, width, height, channels, samples, log);
    const relume_status status = need_bridge(path, log);
    return status ? status
                  : bridge->write_floats(path, width, height, channels, samples, outfile_save, log);
}
