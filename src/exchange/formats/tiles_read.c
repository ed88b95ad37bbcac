// tiles_read.c - a DeepZoom pyramid becomes one picture again
#include "exchange/formats/tiles.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/scalar.h"
#include "exchange/formats/bytes.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { VALUE = 16, MOST_DZI = 1 << 16 };

struct pyramid {
    const char *folder;
    int image;
    int width, height, tile, overlap;
    char suffix[VALUE];
    int level;  // the finest
    const struct relume_limits *limits;
    const struct relume_log *log;
};

static int tiles_of(const struct pyramid *p, int side)
{
    return (side + p->tile - 1) / p->tile;
}

// The value of NAME="..." or NAME='...', whichever element it stands in; false when it is absent or
// long.
static bool get_attribute(const char *text, const char *name, char value[VALUE])
{
    const size_t n = strlen(name);
    for (const char *at = strstr(text, name); at; at = strstr(at + n, name)) {
        const char quote = at[n] == '=' ? at[n + 1] : '\0';
        const char *from = at + n + 2;
        const char *end = quote == '"' || quote == '\'' ? strchr(from, quote) : NULL;
        if (end && end - from < VALUE && (at == text || strchr(" \t\r\n", at[-1]))) {
            memcpy(value, from, (size_t)(end - from));
            value[end - from] = '\0';
            return true;
        }
    }
    return false;
}

static bool get_whole(const char *text, const char *name, int low, int high, int *out)
{
    char value[VALUE];
    int used = 0;
    return get_attribute(text, name, value) && strlen(value) < 8 &&
           sscanf(value, "%d%n", out, &used) == 1 && !value[used] && *out >= low && *out <= high;
}

static relume_status parse(struct pyramid *p, const char *path, const char *text)
{
    if (!get_whole(text, "TileSize", 1, 1 << 16, &p->tile) ||
        !get_whole(text, "Overlap", 0, p->tile, &p->overlap) ||
        !get_whole(text, "Width", 1, 1 << 20, &p->width) ||
        !get_whole(text, "Height", 1, 1 << 20, &p->height))
        return log_fail(p->log, RELUME_EFORMAT,
                        "%s: not a DeepZoom description; expected TileSize, Overlap, Width and "
                        "Height",
                        path);
    if (!get_attribute(text, "Format", p->suffix) ||
        (strcmp(p->suffix, "jpg") && strcmp(p->suffix, "jpeg")))
        return log_fail(p->log, RELUME_EUNSUPPORTED, "%s: tiles of another format; expected jpg",
                        path);
    if (!limits_allow(p->limits, p->width, p->height))
        return log_fail(p->log, RELUME_ELIMIT, "%s: %d x %d pixels are over the limits", path,
                        p->width, p->height);
    return RELUME_OK;
}

static relume_status read_description(struct pyramid *p)
{
    struct bytes b = {0};
    char *path = mem_format("%s/plane_%d.dzi", p->folder, p->image);
    relume_status status = path ? bytes_load(&b, path, p->log) : RELUME_ENOMEM;
    if (!status && b.size > MOST_DZI)
        status = log_fail(p->log, RELUME_ELIMIT, "%s: too long for a DeepZoom description", path);
    char *text = status ? NULL : mem_format("%.*s", (int)b.size, (const char *)b.data);
    if (!status)
        status = text ? parse(p, path, text) : RELUME_ENOMEM;
    mem_free(text);
    mem_free(path);
    bytes_free(&b);
    return status;
}

static char *tile_path(const struct pyramid *p, int level, int column, int row)
{
    return mem_format("%s/plane_%d_files/%d/%d_%d.%s", p->folder, p->image, level, column, row,
                      p->suffix);
}

// 0: no such tile; below 0: no memory.
static int is_there(const struct pyramid *p, int level, int column, int row)
{
    char *path = tile_path(p, level, column, row);
    const int found = !path ? -1 : input_exists(path, p->log);
    mem_free(path);
    return found;
}

// How often the picture must be halved until nothing is larger than `side`.
static int halvings(const struct pyramid *p, int side)
{
    int n = 0;
    for (int longer = larger_of(p->width, p->height); longer > side; longer = (longer + 1) / 2)
        n++;
    return n;
}

// Levels are counted from one tile, or from one pixel. Every tile of the finest must be there
// before allocating what the description promises.
static relume_status find_tiles(struct pyramid *p)
{
    const int from_pixel = halvings(p, 1);
    const int found = is_there(p, from_pixel, 0, 0);
    p->level = found > 0 ? from_pixel : halvings(p, p->tile);
    const int columns = tiles_of(p, p->width), rows = tiles_of(p, p->height);
    for (int i = 0; i < columns * rows; i++) {
        const int there = is_there(p, p->level, i % columns, i / columns);
        if (there > 0)
            continue;
        char *path = there < 0 ? NULL : tile_path(p, p->level, i % columns, i / columns);
        const relume_status status =
            path ? log_fail(p->log, RELUME_ENOTFOUND, "%s: no such tile; expected %d x %d of them",
                            path, columns, rows)
                 : RELUME_ENOMEM;
        mem_free(path);
        return status;
    }
    return RELUME_OK;
}

static relume_status place_tile(const struct pyramid *p, int column, int row,
                                const struct jpeg_codes *tile, const char *path,
                                struct jpeg_codes *out)
{
    const int x = column * p->tile, y = row * p->tile;
    const int left = larger_of(x - p->overlap, 0), top = larger_of(y - p->overlap, 0);
    const int right = smaller_of(x + p->tile, p->width),
              bottom = smaller_of(y + p->tile, p->height);
    const int width = smaller_of(right + p->overlap, p->width) - left;
    const int height = smaller_of(bottom + p->overlap, p->height) - top;
    if (tile->width != width || tile->height != height || tile->planes != 3)
        return log_fail(p->log, RELUME_EDAMAGED,
                        "%s: %d x %d pixels, %d components; expected %d x %d and 3", path,
                        tile->width, tile->height, tile->planes, width, height);
    for (size_t c = 0; c < 3; c++)
        for (int i = y; i < bottom; i++)
            memcpy(out->data + (c * (size_t)p->height + (size_t)i) * (size_t)p->width + x,
                   tile->data + (c * (size_t)height + (size_t)(i - top)) * (size_t)width +
                       (x - left),
                   (size_t)(right - x));
    return RELUME_OK;
}

static relume_status read_tile(const struct pyramid *p, int column, int row, struct jpeg_codes *out)
{
    struct jpeg_codes tile = {0};
    char *path = tile_path(p, p->level, column, row);
    relume_status status = path ? jpeg_read(&tile, path, p->limits, p->log) : RELUME_ENOMEM;
    if (!status)
        status = place_tile(p, column, row, &tile, path, out);
    jpeg_codes_free(&tile);
    mem_free(path);
    return status;
}

relume_status tiles_read(struct jpeg_codes *out, const char *folder, int image,
                         const struct relume_limits *limits, const struct relume_log *log)
{
    struct pyramid p = {.folder = folder, .image = image, .limits = limits, .log = log};
    *out = (struct jpeg_codes){0};
    relume_status status = read_description(&p);
    if (!status)
        status = find_tiles(&p);
    if (status)
        return status;
    *out = (struct jpeg_codes){.width = p.width, .height = p.height, .planes = 3};
    out->data = mem_array((size_t)p.width * (size_t)p.height, 3);
    if (!out->data)
        return RELUME_ENOMEM;
    const int columns = tiles_of(&p, p.width), rows = tiles_of(&p, p.height);
    for (int i = 0; !status && i < columns * rows; i++)
        status = read_tile(&p, i % columns, i / columns, out);
    if (status)
        jpeg_codes_free(out);
    return status;
}
