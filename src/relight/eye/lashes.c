// lashes.c - lashes of a picture, as strokes: from the dark runs of one row to those of the next
// that they touch, so that edges are straight between rows and not stairs
#include "relight/eye/eye.h"

#include "core/base/log.h"
#include "core/base/memory.h"

#include <relume/image.h>

#include <math.h>

static const float picture_mm = 14.0f;  // how wide it is
static const float overlap = 0.25f;     // of a piece's length, so that no light falls between two
enum { MOST_SIDE = 2048, ROWS = 100, MOST_PIECES = 20000 };

// Dark pixels [from, to) of a row.
struct run {
    int from, to;
};
struct row {
    struct run run[MOST_SIDE / 2 + 1];
    int count;
};

static bool dark(const struct relume_image *image, int x, int y)
{
    const float *const v =
        image->data + ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
    float sum = 0.0f;
    for (int c = 0; c < 3; c++)
        sum += v[image->channels > 2 ? c : 0];
    return sum < 1.5f;
}

static void find_runs(struct row *row, const struct relume_image *image, int y)
{
    row->count = 0;
    for (int x = 0; x < image->width; x++) {
        const int from = x;
        while (x < image->width && dark(image, x, y))
            x++;
        if (x > from)
            row->run[row->count++] = (struct run){from, x};
    }
}

// From the middle of `a` at row ya to that of `b` at row yb, rows and columns in pixels.
static struct lash_piece piece_of(struct run a, float ya, struct run b, float yb, float pixel_mm,
                                  int width)
{
    const float middle = 0.5f * (float)width;
    const float xa = 0.5f * (float)(a.from + a.to), xb = 0.5f * (float)(b.from + b.to);
    const float upright = (yb - ya) / hypotf(xb - xa, yb - ya);  // of the axis: cos of its slant
    return (struct lash_piece){
        .x = {pixel_mm * (xa - middle), pixel_mm * (xb + overlap * (xb - xa) - middle)},
        .far = {pixel_mm * ya, pixel_mm * (yb + overlap * (yb - ya))},
        .width = {pixel_mm * upright * (float)(a.to - a.from),
                  pixel_mm * upright * (float)(b.to - b.from)},
    };
}

// Into `out` where it is given; returns how many pieces there are.
static int64_t find_pieces(struct lash_piece *out, struct row row[2],
                           const struct relume_image *image)
{
    const int step = (image->height + ROWS - 1) / ROWS;
    const float pixel_mm = picture_mm / (float)image->width;
    int64_t n = 0;
    find_runs(&row[0], image, 0);
    for (int k = 1, y = step; y < image->height; k = !k, y += step) {
        const struct row *const above = &row[!k];
        find_runs(&row[k], image, y);
        for (int i = 0; i < above->count; i++)
            for (int j = 0; j < row[k].count; j++) {
                const struct run a = above->run[i], b = row[k].run[j];
                if (a.from >= b.to || b.from >= a.to)
                    continue;
                if (out)
                    out[n] = piece_of(a, (float)(y - step), b, (float)y, pixel_mm, image->width);
                n++;
            }
    }
    return n;
}

static relume_status make_pieces(struct lashes *out, struct row row[2],
                                 const struct relume_image *image, const char *path,
                                 const struct relume_log *log)
{
    if (image->width > MOST_SIDE || image->height > MOST_SIDE)
        return log_fail(log, RELUME_ELIMIT,
                        "%s: lashes of %d x %d pixels; expected at most %d a side", path,
                        image->width, image->height, MOST_SIDE);
    const int64_t count = find_pieces(NULL, row, image);
    if (count < 1 || count > MOST_PIECES)
        return log_fail(log, RELUME_EUNFIT,
                        "%s: no lashes; expected dark strokes on white, in 1 to %d pieces; found "
                        "%lld",
                        path, MOST_PIECES, (long long)count);
    out->piece = mem_array((size_t)count, sizeof *out->piece);
    out->count = (int)count;
    if (!out->piece)
        return RELUME_ENOMEM;
    (void)find_pieces(out->piece, row, image);
    return RELUME_OK;
}

relume_status lashes_load(struct lashes *out, const char *path, const struct relume_log *log)
{
    struct row *const row = mem_array(2, sizeof *row);
    struct relume_image image = {0};
    *out = (struct lashes){0};
    relume_status status = row ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = relume_image_load(&image, path, relume_image_params(.log = log));
    if (!status)
        status = make_pieces(out, row, &image, path, log);
    relume_image_destroy(&image);
    mem_free(row);
    return status;
}

void lashes_destroy(struct lashes *lashes)
{
    mem_free(lashes->piece);
    *lashes = (struct lashes){0};
}
