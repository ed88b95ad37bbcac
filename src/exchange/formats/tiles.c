// tiles.c - plane JPEGs cut into DeepZoom pyramids, as OpenLIME's layout "deepzoom" reads them
#include "exchange/formats/tiles.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "core/math/scalar.h"
#include "exchange/formats/tile_pyramid.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

// Tiles of 256 pixels with their overlap, whole blocks, or a little less.
enum { MOST_TILE = 254, LEAST_TILE = 240, OVERLAP = 1 };

// A sheet on its way into DeepZoom tiles.
struct sheet_tiles {
    struct sheet sheet;  // all of it, at full size
    double step;
    const char *folder;  // of the levels
    int finest;          // number of the level of full size in names
    const struct relume_log *log;
};

static relume_status encode_tile(void *user, const struct tile *tile, struct tile_file *files)
{
    const struct sheet_tiles *t = user;
    const size_t pixels = (size_t)tile->at.width * (size_t)tile->at.height;
    struct sheet sheet = t->sheet;
    struct sheet_result result;
    float *values = mem_array(pixels * (size_t)sheet.planes, sizeof *values);
    if (!values)
        return RELUME_ENOMEM;
    sheet.width = tile->at.width;
    sheet.height = tile->at.height;
    for (int p = 0; p < sheet.planes; p++) {
        sheet.plane[p] = values + (size_t)p * pixels;
        tile_copy(values + (size_t)p * pixels, tile, p);
    }
    const relume_status status = sheet_encode(&result, &sheet, t->step);
    if (!status)
        files[0] = (struct tile_file){result.bytes, result.size};
    mem_free(values);
    return status;
}

static relume_status make_folder(const char *path, const struct relume_log *log)
{
    return mkdir(path, 0777) && errno != EEXIST
               ? log_fail(log, RELUME_EIO, "%s: cannot be created; %s", path, strerror(errno))
               : RELUME_OK;
}

static relume_status save_tile(void *user, const struct tile *tile, int number,
                               const struct tile_file *file)
{
    (void)number;
    const struct sheet_tiles *t = user;
    char *folder = mem_format("%s/%d", t->folder, t->finest - tile->level->number);
    char *name = mem_format("%s/%d_%d.jpg", folder, tile->column, tile->row);
    const bool is_first = !tile->column && !tile->row;
    relume_status status = folder && name ? RELUME_OK : RELUME_ENOMEM;
    if (!status && is_first)
        status = make_folder(folder, t->log);
    if (!status)
        status = outfile_save(name, file->bytes, file->size, t->log);
    mem_free(folder);
    mem_free(name);
    return status;
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
    struct sheet_tiles t = {.sheet = web_sheet(w, index), .step = step, .log = log};
    const int side = tile_side(t.sheet.width, t.sheet.height);
    char *dzi = mem_format("%s/plane_%d.dzi", path, index);
    char *files = mem_format("%s/plane_%d_files", path, index);
    t.folder = files;
    t.finest = finest_level(larger_of(t.sheet.width, t.sheet.height), side);
    relume_status status = dzi && files ? write_dzi(dzi, &t.sheet, side, log) : RELUME_ENOMEM;
    if (!status)
        status = make_folder(files, log);
    if (!status)
        status = tile_pyramid_write(&(struct tile_pyramid){
            .plane = t.sheet.plane,
            .planes = t.sheet.planes,
            .width = t.sheet.width,
            .height = t.sheet.height,
            .levels = t.finest + 1,
            .side = side,
            .overlap = OVERLAP,
            .threads = threads,
            .user = &t,
            .encode = encode_tile,
            .save = save_tile,
        });
    mem_free(dzi);
    mem_free(files);
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
