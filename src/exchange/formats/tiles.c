// tiles.c - plane JPEGs cut into DeepZoom pyramids, as OpenLIME's layout "deepzoom" reads them
#include "exchange/formats/tiles.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Tiles of 256 pixels with their overlap, whole blocks, or a little less.
enum { MOST_TILE = 254, LEAST_TILE = 240, OVERLAP = 1 };

// One level of one sheet.
struct level {
    struct sheet sheet;        // all of it
    float *own[SHEET_PLANES];  // NULL for the finest, which is the planes' own
    double step;
    int side;  // of a tile without its overlap
    const char *folder;
    int columns, rows;
    relume_status *status;  // [columns x rows]
    struct sheet_result *tile;
};

static relume_status cut(const struct level *l, int column, int row, struct sheet *tile,
                         float **room)
{
    const struct sheet *s = &l->sheet;
    const int x = larger_of(column * l->side - OVERLAP, 0),
              y = larger_of(row * l->side - OVERLAP, 0);
    *tile = *s;
    tile->width = smaller_of((column + 1) * l->side + OVERLAP, s->width) - x;
    tile->height = smaller_of((row + 1) * l->side + OVERLAP, s->height) - y;
    const size_t width = (size_t)tile->width, pixels = width * (size_t)tile->height;
    *room = mem_array(pixels * (size_t)s->planes, sizeof **room);
    if (!*room)
        return RELUME_ENOMEM;
    for (int p = 0; p < s->planes; p++) {
        float *to = *room + (size_t)p * pixels;
        tile->plane[p] = to;
        for (int i = 0; i < tile->height; i++)
            memcpy(to + (size_t)i * width,
                   s->plane[p] + (size_t)(y + i) * (size_t)s->width + (size_t)x,
                   width * sizeof *to);
    }
    return RELUME_OK;
}

static void encode_tile(void *context, size_t item, int worker)
{
    (void)worker;
    const struct level *l = context;
    struct sheet tile;
    float *room = NULL;
    l->status[item] = cut(l, (int)item % l->columns, (int)item / l->columns, &tile, &room);
    if (!l->status[item])
        l->status[item] = sheet_encode(&l->tile[item], &tile, l->step);
    mem_free(room);
}

static relume_status make_folder(const char *path, const struct relume_log *log)
{
    return mkdir(path, 0777) && errno != EEXIST
               ? log_fail(log, RELUME_EIO, "%s: cannot be created; %s", path, strerror(errno))
               : RELUME_OK;
}

static relume_status write_tiles(const struct level *l, const struct relume_log *log)
{
    relume_status status = make_folder(l->folder, log);
    for (int i = 0; !status && i < l->columns * l->rows; i++) {
        char *name = mem_format("%s/%d_%d.jpg", l->folder, i % l->columns, i / l->columns);
        status = name ? outfile_save(name, l->tile[i].bytes, l->tile[i].size, log) : RELUME_ENOMEM;
        mem_free(name);
    }
    return status;
}

static relume_status write_level(struct level *l, int threads, const struct relume_log *log)
{
    l->columns = (l->sheet.width + l->side - 1) / l->side;
    l->rows = (l->sheet.height + l->side - 1) / l->side;
    const size_t n = (size_t)l->columns * (size_t)l->rows;
    l->status = mem_zeroed(n, sizeof *l->status);
    l->tile = mem_zeroed(n, sizeof *l->tile);
    relume_status status = l->status && l->tile ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        thread_for(threads, n, encode_tile, l);
    for (size_t i = 0; !status && i < n; i++)
        status = l->status[i];
    if (!status)
        status = write_tiles(l, log);
    for (size_t i = 0; l->tile && i < n; i++)
        mem_free(l->tile[i].bytes);
    mem_free(l->tile);
    mem_free(l->status);
    return status;
}

static relume_status go_up(struct level *l)
{
    for (int p = 0; p < l->sheet.planes; p++) {
        float *half = plane_halved(l->sheet.plane[p], l->sheet.width, l->sheet.height);
        if (!half)
            return RELUME_ENOMEM;
        mem_free(l->own[p]);
        l->own[p] = half;
        l->sheet.plane[p] = half;
    }
    l->sheet.width = (l->sheet.width + 1) / 2;
    l->sheet.height = (l->sheet.height + 1) / 2;
    return RELUME_OK;
}

static relume_status write_dzi(const char *path, const struct sheet *s, int side,
                               const struct relume_log *log)
{
    char *text = mem_format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                            "<Image xmlns=\"http://schemas.microsoft.com/deepzoom/2008\" "
                            "Format=\"jpg\" Overlap=\"%d\" TileSize=\"%d\">\n"
                            "  <Size Width=\"%d\" Height=\"%d\"/>\n</Image>\n",
                            OVERLAP, side, s->width, s->height);
    const relume_status status = text ? outfile_save(path, text, strlen(text), log) : RELUME_ENOMEM;
    mem_free(text);
    return status;
}

// Levels are numbered as OpenLIME asks for them: from 0, which is one tile, to the whole picture.
// (DeepZoom's own levels begin with a single pixel; OpenLIME calls that layout deepzoom1px, and its
// RTI layer does not take it.) OpenLIME counts ceil(log2(longer side / tile)) + 1 of them: none for
// a picture below half a tile, whose tile is therefore as large as the picture.
static int finest_level(int longer, int tile)
{
    int level = 0;
    for (int side = longer; side > tile; side = (side + 1) / 2)
        level++;
    return level;
}

// OpenLIME counts the tiles of a level by sides rounded down; these, as in DeepZoom, are rounded
// up. A last tile that holds only what was rounded up is never asked for, and the others are
// stretched.
static bool has_sliver(int length, int side, int finest)
{
    for (int up = 0; up <= finest; up++) {
        const int lower = length >> up, upper = lower + (length > lower << up);
        if ((lower + side - 1) / side != (upper + side - 1) / side)
            return true;
    }
    return false;
}

// The largest that leaves no sliver: one length in 120 has one at MOST_TILE, and of 200 000 random
// sizes none went below 252.
static int tile_side(int width, int height)
{
    const int longer = larger_of(width, height), most = smaller_of(longer, MOST_TILE);
    for (int side = most; longer > MOST_TILE && side >= LEAST_TILE; side--) {
        const int finest = finest_level(longer, side);
        if (!has_sliver(width, side, finest) && !has_sliver(height, side, finest))
            return side;
    }
    return most;
}

static relume_status write_sheet(const struct web_folder *w, int index, double step,
                                 const char *path, int threads, const struct relume_log *log)
{
    struct level l = {.sheet = web_sheet(w, index), .step = step};
    const int longer = larger_of(l.sheet.width, l.sheet.height);
    char *dzi = mem_format("%s/plane_%d.dzi", path, index);
    char *files = mem_format("%s/plane_%d_files", path, index);
    char *jpeg = mem_format("%s/plane_%d.jpg", path, index);
    l.side = tile_side(l.sheet.width, l.sheet.height);
    relume_status status =
        dzi && files && jpeg ? write_dzi(dzi, &l.sheet, l.side, log) : RELUME_ENOMEM;
    if (!status)
        status = make_folder(files, log);
    for (int level = finest_level(longer, l.side); !status && level >= 0; level--) {
        char *folder = mem_format("%s/%d", files, level);
        l.folder = folder;
        status = folder ? write_level(&l, threads, log) : RELUME_ENOMEM;
        mem_free(folder);
        if (!status && level > 0)
            status = go_up(&l);
    }
    if (!status && unlink(jpeg))
        status = log_fail(log, RELUME_EIO, "%s: cannot be removed; %s", jpeg, strerror(errno));
    for (int p = 0; p < SHEET_PLANES; p++)
        mem_free(l.own[p]);
    mem_free(dzi);
    mem_free(files);
    mem_free(jpeg);
    return status;
}

relume_status tiles_write(const struct web_folder *w, double step, const char *path, int threads,
                          const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < w->kept; i++)
        status = write_sheet(w, i, step, path, threads, log);
    return status;
}
