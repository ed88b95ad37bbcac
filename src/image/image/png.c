// png.c - the one file that knows libpng: grey or colour, perhaps with alpha; reads 8 bits, writes
// 16
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "image/image/picture.h"
#include "image/image/picture_format.h"
#include "image/image/png_rows.h"

#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

// libpng's errors end here; its warnings are nobody's business.
struct trap {
    jmp_buf jump;
    char text[128];
    bool short_of_memory;  // which libpng takes for damage here and there
};

static void on_error(png_structp png, png_const_charp text)
{
    struct trap *trap = png_get_error_ptr(png);
    snprintf(trap->text, sizeof trap->text, "%s", text);
    longjmp(trap->jump, 1);
}

static png_voidp allocate(png_structp png, png_alloc_size_t size)
{
    struct trap *trap = png_get_mem_ptr(png);
    void *memory = mem_array(size, 1);
    trap->short_of_memory |= !memory;
    return memory;
}

static void release(png_structp png, png_voidp memory)
{
    (void)png;
    mem_free(memory);
}

static void on_warning(png_structp png, png_const_charp text)
{
    (void)png, (void)text;
}

// ---------------------------------------------------------------- reading

struct png_picture {
    picture_reader reader;  // first
    FILE *file;
    png_structp png;
    png_infop info;
    struct trap trap;
    char why[160];
};

static uint32_t big_endian(const uint8_t *b)
{
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

enum { HEAD = 48 };  // bytes of a chunk that are looked at

static bool starts(const uint8_t *data, uint32_t size, const char *with, size_t n)
{
    return size >= n && !memcmp(data, with, n);
}

// Chunks that change nothing here: sRGB's own numbers, resolution, significant bits, words about
// software. `data` is the first HEAD bytes.
static bool is_harmless(const char type[4], uint32_t size, const uint8_t *data)
{
    static const char *const kinds[] = {"IDAT", "IEND", "sRGB", "cHRM", "pHYs", "sBIT"};
    static const char *const words[] = {"Software",    "Comment",        "jpeg:subsampling",
                                        "date:create", "date:timestamp", "date:modify"};
    static const char srgb[] = "oiio:ColorSpace\0sRGB";
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (!memcmp(type, kinds[i], 4))
            return true;
    if (!memcmp(type, "gAMA", 4))
        return size == 4 && big_endian(data) == 45455;
    if (!memcmp(type, "oFFs", 4))
        return size == 9 && !big_endian(data) && !big_endian(data + 4);
    if (memcmp(type, "tEXt", 4))
        return false;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (starts(data, size, words[i], strlen(words[i]) + 1))
            return true;
    return size == sizeof srgb - 1 && starts(data, size, srgb, sizeof srgb - 1);
}

static bool is_plain_header(const uint8_t *data, uint32_t size)
{
    static const bool kind[7] = {[PNG_COLOR_TYPE_GRAY] = true,
                                 [PNG_COLOR_TYPE_RGB] = true,
                                 [PNG_COLOR_TYPE_GRAY_ALPHA] = true,
                                 [PNG_COLOR_TYPE_RGB_ALPHA] = true};
    return size == 13 && data[8] == 8 && data[9] < 7 && kind[data[9]] &&
           data[12] == PNG_INTERLACE_NONE;
}

// Whether all chunks are there, to the last, and none that matters is unknown here.
static bool is_plain(FILE *f)
{
    uint8_t head[8], data[HEAD];
    if (fseek(f, 8, SEEK_SET))
        return false;
    for (int i = 0; fread(head, 1, 8, f) == 8; i++) {
        const uint32_t size = big_endian(head), look = size < HEAD ? size : HEAD;
        const char *type = (const char *)head + 4;
        memset(data, 0, sizeof data);
        if (fread(data, 1, look, f) != look || size > INT32_MAX - 4)
            return false;
        if (i == 0 ? memcmp(type, "IHDR", 4) || !is_plain_header(data, size)
                   : !is_harmless(type, size, data))
            return false;
        if (fseek(f, (long)(size - look) + 3, SEEK_CUR) || getc(f) == EOF)  // the check sum
            return false;
        if (!memcmp(type, "IEND", 4))
            return true;
    }
    return false;
}

static relume_status read_bytes(picture_reader *reader, int row, int rows, uint8_t *out)
{
    struct png_picture *p = (struct png_picture *)reader;
    const size_t width = (size_t)reader->info.width * (size_t)reader->info.channels;
    (void)row;
    if (setjmp(p->trap.jump)) {
        snprintf(p->why, sizeof p->why, "truncated or damaged; %s", p->trap.text);
        return p->trap.short_of_memory ? RELUME_ENOMEM : RELUME_EDAMAGED;
    }
    for (int y = 0; y < rows; y++)
        png_read_row(p->png, out + (size_t)y * width, NULL);
    return RELUME_OK;
}

static const char *error(const picture_reader *reader)
{
    return ((const struct png_picture *)reader)->why;
}

static void close(picture_reader *reader)
{
    struct png_picture *p = (struct png_picture *)reader;
    if (p->png)
        png_destroy_read_struct(&p->png, &p->info, NULL);
    if (p->file)
        fclose(p->file);
    mem_free(p);
}

static const struct picture_format format = {
    .read_bytes = read_bytes, .error = error, .close = close};

static bool read_header(struct png_picture *p)
{
    if (setjmp(p->trap.jump))
        return false;
    rewind(p->file);
    png_init_io(p->png, p->file);
    png_read_info(p->png, p->info);
    const int channels = png_get_channels(p->png, p->info), last = channels >= 3 ? 2 : 0;
    p->reader = (picture_reader){.format = &format,
                                 .info = {.width = (int)png_get_image_width(p->png, p->info),
                                          .height = (int)png_get_image_height(p->png, p->info),
                                          .channels = channels,
                                          .rgb = {0, last ? 1 : 0, last},
                                          .bytes = true}};
    return true;
}

relume_status png_picture_open(picture_reader **out, const char *path,
                               const struct relume_reader *from, const struct relume_limits *limits,
                               const struct relume_log *log)
{
    struct png_picture *p = mem_zeroed(1, sizeof *p);
    *out = NULL;
    if (!p)
        return RELUME_ENOMEM;
    relume_status status = RELUME_OK;
    p->file = infile_stream(NULL, path, from, log);
    if (!p->file)
        status = relume_input_fail(log, path, "cannot be opened", errno);
    const bool plain = p->file && is_plain(p->file);
    if (plain) {
        p->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &p->trap, on_error, on_warning,
                                          &p->trap, allocate, release);
        p->info = p->png ? png_create_info_struct(p->png) : NULL;
        status = p->info ? RELUME_OK : RELUME_ENOMEM;
    }
    if (plain && !status && read_header(p) &&
        limits_allow(limits, p->reader.info.width, p->reader.info.height))
        *out = &p->reader;
    else {
        status = p->trap.short_of_memory ? RELUME_ENOMEM : status;
        close(&p->reader);
    }
    return status;
}

// ---------------------------------------------------------------- writing

struct writer {
    png_structp png;
    png_infop info;
    struct trap trap;
    struct relume_buffer out;
    struct png_piece *piece;  // [pieces], of the rows
    size_t pieces;
};

static void append(png_structp png, png_bytep bytes, size_t n)
{
    struct writer *w = png_get_io_ptr(png);
    const struct relume_writer to = relume_buffer_writer(&w->out);
    if (!to.write(to.user, bytes, n, w->out.size)) {
        w->trap.short_of_memory = true;
        png_error(png, "");
    }
}

static void no_flush(png_structp png)
{
    (void)png;
}

// Of photographs more effort gains 4 % of the bytes in five times as long.
enum { EFFORT = 2 };

static bool encode(struct writer *w, const struct picture_codes *codes)
{
    const struct picture_array *a = &codes->array;
    static const uint8_t data[] = "IDAT", end[] = "IEND";
    if (setjmp(w->trap.jump))
        return false;
    png_set_write_fn(w->png, w, append, no_flush);
    png_set_IHDR(w->png, w->info, (png_uint_32)a->width, (png_uint_32)a->height, 8 * (int)a->bytes,
                 a->channels == 4   ? PNG_COLOR_TYPE_RGB_ALPHA
                 : a->channels == 3 ? PNG_COLOR_TYPE_RGB
                                    : PNG_COLOR_TYPE_GRAY,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!codes->data)
        png_set_sRGB(w->png, w->info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(w->png, w->info);
    for (size_t i = 0; i < w->pieces; i++)
        png_write_chunk(w->png, data, w->piece[i].data, w->piece[i].size);
    png_write_chunk(w->png, end, NULL, 0);
    return true;
}

relume_status png_write(const char *path, const struct relume_writer *writer,
                        const struct picture_codes *codes, const struct relume_log *log)
{
    struct writer *w = mem_zeroed(1, sizeof *w);
    if (w)
        w->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &w->trap, on_error, on_warning,
                                           &w->trap, allocate, release);
    if (w && w->png)
        w->info = png_create_info_struct(w->png);
    relume_status status = w && w->info ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = png_rows_deflate(&w->piece, &w->pieces, &codes->array, EFFORT,
                                  codes->threads > 1 ? codes->threads : 1);
    if (!status && !encode(w, codes))
        status = w->trap.short_of_memory
                     ? RELUME_ENOMEM
                     : log_fail(log, RELUME_EIO, "%s: cannot be written; %s", path, w->trap.text);
    if (!status)
        status = outfile_save_to(path, writer, w->out.data, w->out.size, log);
    if (w && w->png)
        png_destroy_write_struct(&w->png, &w->info);
    if (w) {
        png_rows_destroy(&w->piece, w->pieces);
        relume_buffer_destroy(&w->out);
    }
    mem_free(w);
    return status;
}
