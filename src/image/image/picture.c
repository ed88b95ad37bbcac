// picture.c - which reader and writer a picture file gets; opens the module that knows OpenImageIO
// when the first file is written by it
#include "image/image/picture.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/module.h"
#include "core/base/outfile.h"
#include "image/image/picture_format.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static const struct oiio_bridge *bridge;
static char why_not[MODULE_WHY];
static int lacks;

static void load(void)
{
    bridge = module_open("oiio", why_not, &lacks);
}

static relume_status need_bridge(const char *path, const struct relume_log *log)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, load);
    if (bridge)
        return RELUME_OK;
    if (lacks)
        return relume_input_fail(log, path, "cannot be written", lacks);
    return log_fail(log, RELUME_EIO, "%s: the module for image formats cannot be loaded; %s", path,
                    why_not);
}

// ---------------------------------------------------------------- reading

// An open file and what it is.
struct opening {
    const char *path;                  // also a name
    const struct relume_reader *from;  // or NULL
    struct infile in;
    struct picture_look look;
    const struct picture_kind *kind;
};

static relume_status look(struct opening *s, const struct relume_log *log)
{
    if (!infile_open(&s->in, s->path, s->from, log))
        return errno == ENOENT
                   ? log_fail(log, RELUME_ENOTFOUND, "%s: no such file; expected an image", s->path)
                   : relume_input_fail(log, s->path, "cannot be opened", errno);
    const uint64_t size = s->in.size;
    if (!s->in.regular || size == 0)
        return log_fail(log, RELUME_EFORMAT, "%s: empty file or folder; expected an image",
                        s->path);
    s->look.bytes = size;
    const uint64_t foot = size > PICTURE_FOOT ? size - PICTURE_FOOT : 0;
    if (infile_read(&s->in, s->look.head, PICTURE_HEAD, 0) < 0 ||
        infile_read(&s->in, s->look.foot, PICTURE_FOOT, foot) < 0)
        return relume_input_fail(log, s->path, "cannot be read", errno);
    s->kind = picture_kind_of(&s->look, s->path);
    return RELUME_OK;
}

const struct picture_kind *picture_kind_at(const char *path)
{
    struct opening s = {.path = path};
    const relume_status status = look(&s, NULL);
    infile_close(&s.in);
    return status ? NULL : s.kind;
}

// The first part's attributes follow each other from the start.
bool picture_head_is_relume(const char *head, size_t n)
{
    static const char magic[] = "\x76\x2f\x31\x01", attributes[] = "relume.";
    return n > 4 && !memcmp(head, magic, 4) && memmem(head, n, attributes, strlen(attributes));
}

bool picture_is_relume(const char *path, const struct relume_log *log)
{
    char head[4096];
    struct infile in;
    if (!infile_open(&in, path, NULL, log))
        return false;
    const int64_t n = infile_read(&in, head, sizeof head, 0);
    infile_close(&in);
    return n > 0 && picture_head_is_relume(head, (size_t)n);
}

static relume_status open_inside(picture_reader **out, const struct opening *s,
                                 const struct relume_limits *limits, const struct relume_log *log)
{
    if (!s->kind->inside)
        return RELUME_OK;
    if (!strcmp(s->kind->reader, "openexr"))
        return exr_picture_open(out, s->path, s->from, limits, log);
    if (!strcmp(s->kind->reader, "png"))
        return png_picture_open(out, s->path, s->from, limits, log);
    return jpeg_picture_open(out, s->path, s->from, limits, log);
}

static relume_status open_helped(picture_reader **out, struct opening *s,
                                 const struct relume_limits *limits, const struct relume_log *log)
{
    static const char expected[] = "a photograph (JPEG, PNG, TIFF, EXR, HDR, RAW ...)";
    const struct picture_kind *k = s->kind;
    if (!k->listed && !(k->reader && limits && limits->any_format))
        return log_fail(log, k->what ? RELUME_EUNSUPPORTED : RELUME_EFORMAT,
                        "%s: not a readable image%s%s; expected %s; %s", s->path,
                        k->what ? " but " : "", k->what ? k->what : "", expected, k->advice);
    const int file = infile_descriptor(&s->in);
    if (file < 0)
        return relume_input_fail(log, s->path, "cannot be read", errno);
    const relume_status status =
        helped_picture_open(out, file, s->path, k, s->look.bytes, limits, log);
    close(file);
    return status;
}

// What a header claims, before anything is set aside for it.
static relume_status check_size(const picture_reader *reader, const struct opening *s,
                                const struct relume_limits *limits, const struct relume_log *log)
{
    const struct picture_info *i = &reader->info;
    const uint64_t bytes =
        (uint64_t)i->width * (uint64_t)i->height * (uint64_t)i->channels * (i->bytes ? 1 : 4);
    const struct relume_limits most = limits_or_default(limits);
    if (!picture_kind_is_likely(s->kind, s->look.bytes, bytes))
        return log_fail(
            log, RELUME_EDAMAGED,
            "%s: claims %d x %d pixels of %d channel%s in %llu bytes; damaged, or made to "
            "fill memory",
            s->path, i->width, i->height, i->channels, relume_plural(i->channels),
            (unsigned long long)s->look.bytes);
    if (bytes > most.max_memory)
        return log_fail(log, RELUME_ELIMIT,
                        "%s: %d x %d pixels of %d channel%s are %s; expected at most %s "
                        "(--max-memory)",
                        s->path, i->width, i->height, i->channels, relume_plural(i->channels),
                        memory_text(bytes, most.max_memory).text,
                        memory_text(most.max_memory, bytes).text);
    return RELUME_OK;
}

relume_status picture_open(picture_reader **out, const char *path, const struct relume_reader *from,
                           const struct relume_limits *limits, const struct relume_log *log)
{
    struct opening s = {.path = infile_name(path), .from = from};
    *out = NULL;
    limits = limits_of(limits, log);
    relume_status status = look(&s, log);
    if (!status)
        status = open_inside(out, &s, limits, log);
    if (!status && !*out)
        status = open_helped(out, &s, limits, log);
    if (!status)
        status = check_size(*out, &s, limits, log);
    if (status)
        picture_close(out);
    infile_close(&s.in);
    return status;
}

const struct picture_info *picture_info_of(const picture_reader *reader)
{
    return &reader->info;
}

bool picture_has_rows(const struct picture_info *info, int row, int rows)
{
    return row >= 0 && rows >= 1 && row < info->height && rows <= info->height - row;
}

// Decoders that go from the top on take no notice of `row`: they would give others.
static const char *why_not_now(const picture_reader *reader, int row, int rows, bool bytes)
{
    const struct picture_info *info = &reader->info;
    if (bytes != info->bytes)
        return "its samples are of the other type";
    if (!picture_has_rows(info, row, rows))
        return "it has no such rows";
    if (!info->jumps && !reader->broken && row != reader->next)
        return "its rows can only be read from the top on, once each";
    return NULL;
}

static relume_status begin_read(picture_reader *reader, int row, int rows, bool bytes)
{
    reader->misuse = why_not_now(reader, row, rows, bytes);
    return reader->misuse ? RELUME_EINVAL : reader->broken;
}

static relume_status end_read(picture_reader *reader, int rows, relume_status status)
{
    if (!reader->info.jumps) {
        reader->broken = status;
        reader->next += rows;
    }
    return status;
}

relume_status picture_read_floats(picture_reader *reader, int row, int rows, float *out)
{
    const relume_status status = begin_read(reader, row, rows, false);
    return status ? status
                  : end_read(reader, rows, reader->format->read_floats(reader, row, rows, out));
}

relume_status picture_read_bytes(picture_reader *reader, int row, int rows, uint8_t *out)
{
    const relume_status status = begin_read(reader, row, rows, true);
    return status ? status
                  : end_read(reader, rows, reader->format->read_bytes(reader, row, rows, out));
}

relume_status picture_turn(picture_reader *reader, int page, const struct relume_limits *limits)
{
    if (!reader->format->turn)
        return page ? RELUME_ENOTFOUND : RELUME_OK;
    reader->next = 0;
    reader->broken = RELUME_OK;
    reader->misuse = NULL;
    return reader->format->turn(reader, page, limits);
}

static relume_status exif_notes(const picture_reader *of, struct relume_exif *out,
                                const struct relume_log *log)
{
    static const struct picture_kind jpeg = {.what = "JPEG", .reader = "jpeg", .listed = true};
    picture_reader *reader;
    const int file = infile_descriptor(of->exif);
    if (file < 0)
        return relume_input_fail(log, of->path, "cannot be read", errno);
    const relume_status status =
        helped_picture_open(&reader, file, of->path, &jpeg, of->exif->size, NULL, log);
    close(file);
    if (status)
        return status;
    reader->format->notes(reader, out);
    picture_close(&reader);
    return RELUME_OK;
}

relume_status picture_notes(const picture_reader *reader, struct relume_exif *out,
                            const struct relume_log *log)
{
    const struct picture_info *info = &reader->info;
    relume_status status = RELUME_OK;
    *out = (struct relume_exif){0};
    if (reader->format->notes)
        reader->format->notes(reader, out);
    if (reader->exif)
        status = exif_notes(reader, out, log);
    out->width = info->width;
    out->height = info->height;
    out->linear = info->linear;
    out->bytes = info->bytes;
    out->floats = info->floats;
    if (out->orientation < 1 || out->orientation > 8)
        out->orientation = 1;
    return status;
}

const void *picture_profile(const picture_reader *reader, size_t *size)
{
    *size = 0;
    return reader->format->profile ? reader->format->profile(reader, size) : NULL;
}

relume_status picture_need_colour(const picture_reader *reader, const char *path,
                                  const struct relume_log *log)
{
    const struct picture_info *info = picture_info_of(reader);
    if (!info->other[0])
        return RELUME_OK;
    return log_fail(log, RELUME_EUNSUPPORTED,
                    "%s: has no colour channels, only %s; expected R, G, B or Y", path,
                    info->other);
}

const char *picture_error(const picture_reader *reader)
{
    return reader->misuse ? reader->misuse : reader->format->error(reader);
}

void picture_close(picture_reader **reader)
{
    if (*reader)
        (*reader)->format->close(*reader);
    *reader = NULL;
}

// ---------------------------------------------------------------- writing

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

relume_status picture_write_bytes(const char *path, const struct relume_writer *writer, int width,
                                  int height, int channels, const uint8_t *samples,
                                  const struct relume_log *log)
{
    const struct picture_codes codes = {
        .array = {
            .data = samples, .bytes = 1, .width = width, .height = height, .channels = channels}};
    return picture_write_codes(path, writer, &codes, log);
}

bool picture_writes_words(const char *path)
{
    static const char *const words[] = {".png", ".tif", ".tiff", NULL};
    return has_one_of(path, words);
}

relume_status picture_write_codes(const char *path, const struct relume_writer *writer,
                                  const struct picture_codes *codes, const struct relume_log *log)
{
    if (picture_has_extension(path, ".png"))
        return png_write(path, writer, codes, log);
    const relume_status status = need_bridge(path, log);
    return status ? status : bridge->write_codes(path, writer, codes, outfile_save_to, log);
}

// Which OpenImageIO reads and does not write: rows from the bottom up, the sign says little endian.
static relume_status write_pfm(const char *path, const struct relume_writer *writer, int width,
                               int height, int channels, const float *samples,
                               const struct relume_log *log)
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
    const relume_status status = outfile_save_to(path, writer, bytes, (size_t)(to - bytes), log);
    mem_free(bytes);
    return status;
}

relume_status picture_write_floats(const char *path, const struct relume_writer *writer, int width,
                                   int height, int channels, const float *samples,
                                   const struct relume_log *log)
{
    if (picture_has_extension(path, ".pfm"))
        return write_pfm(path, writer, width, height, channels, samples, log);
    const relume_status status = need_bridge(path, log);
    return status ? status
                  : bridge->write_floats(path, writer, width, height, channels, samples,
                                         outfile_save_to, log);
}
