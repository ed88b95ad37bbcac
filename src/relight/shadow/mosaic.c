// mosaic.c - small pieces from all over a planar capture, as a capture of its own
//
// What neighbours are to each other is kept within a piece. Whether a sample clips has to be told
// from the mosaic as well: samples are those of the photographs over their white, 16 bits of a
// display curve, which are finer than theirs; floating-point numbers stay such.
#include "relight/shadow/mosaic.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <math.h>

enum { PIECE = 8, PIECES = 8 };  // pixels along a side, pieces along a side

static int side_of(int whole)
{
    return whole < PIECE * PIECES ? whole : PIECE * PIECES;
}

// Pieces lie in the middle of equal parts of the whole.
static void place_piece(int *at, int n, int whole)
{
    for (int i = 0; i < n; i++)
        at[i] =
            n == whole ? i : (2 * (i / PIECE) + 1) * whole / (2 * PIECES) - PIECE / 2 + i % PIECE;
}

struct taking {
    const relume_table *table;
    struct relume_transfer coded;
    float (*white)[3];  // [lights]
};

static void take_sample(const struct mosaic *m, size_t to, float value, float white,
                        struct relume_transfer coded)
{
    if (isinf(white))
        ((float *)m->pictures)[to] = relume_transfer_encode(coded, value);
    else
        ((uint16_t *)m->pictures)[to] = (uint16_t)lrintf(
            65535.0f * relume_transfer_encode(coded, fminf(fmaxf(value / white, 0.0f), 1.0f)));
}

// A row of the mosaic under a light, among those fetched last.
static void take_row(const struct mosaic *m, const struct taking *t, int light, int y, int row,
                     int width)
{
    size_t to = 3 * ((size_t)light * (size_t)m->rows + (size_t)y) * (size_t)m->columns;
    for (int x = 0, n; x < m->columns; x += n) {
        float rgb[3][PIECE];
        n = m->columns - x < PIECE ? m->columns - x : PIECE;
        relume_table_planes(t->table, light, (size_t)row * (size_t)width + (size_t)m->x[x],
                            (size_t)n, rgb[0], PIECE);
        for (int i = 0; i < n; i++)
            for (int c = 0; c < 3; c++, to++)
                take_sample(m, to, rgb[c][i], t->white[light][c], t->coded);
    }
}

static relume_status take_mask(struct mosaic *m, const relume_capture *capture,
                               const struct relume_log *log)
{
    struct relume_image whole = {0};
    relume_status status = relume_capture_mask(&whole, capture, 0, log);
    if (!status && whole.data &&
        !(m->mask = mem_array((size_t)m->rows * (size_t)m->columns, sizeof *m->mask)))
        status = RELUME_ENOMEM;
    for (int y = 0; m->mask && y < m->rows; y++)
        for (int x = 0; x < m->columns; x++)
            m->mask[y * m->columns + x] =
                whole.data[(size_t)m->y[y] * (size_t)whole.width + (size_t)m->x[x]];
    relume_image_destroy(&whole);
    return status;
}

// Rows of pieces are read, and those between them left out.
static relume_status take_rows(struct mosaic *m, relume_table *table, const relume_capture *capture,
                               const struct taking *t, const struct relume_log *log)
{
    const int lights = relume_capture_manifest(capture)->lights;
    relume_status status = RELUME_OK;
    for (int y = 0, at = 0, n; !status && y < m->rows; y += n, at = m->y[y - 1] + 1) {
        n = m->rows - y < PIECE ? m->rows - y : PIECE;
        if (!log_progress(log, "judging highlights", 0.3 * y / m->rows))
            return RELUME_ECANCEL;
        status = relume_table_skip(table, m->y[y] - at);
        if (!status)
            status = relume_table_fetch(table, n);
        for (int i = 0; !status && i < n; i++)
            for (int light = 0; light < lights; light++)
                take_row(m, t, light, y + i, i, relume_capture_width(capture));
    }
    return status;
}

// `bright[lights]`: what their white was divided by.
static relume_status take_all(struct mosaic *m, const relume_capture *capture, float (*bright)[3],
                              struct relume_transfer coded, const struct relume_log *log)
{
    const int lights = relume_capture_manifest(capture)->lights;
    struct taking t = {.coded = coded, .white = mem_array((size_t)lights, sizeof *t.white)};
    relume_table *table = NULL;
    relume_status status = t.white ? take_mask(m, capture, log) : RELUME_ENOMEM;
    for (int i = 0; t.white && i < lights; i++) {
        relume_capture_white(capture, i, t.white[i]);
        for (int c = 0; c < 3; c++)
            bright[i][c] = isinf(t.white[i][c]) ? 1.0f : 1.0f / t.white[i][c];
    }
    if (!status)
        status = relume_table_open(&table, capture, 0, relume_table_params(.log = log));
    t.table = table;
    if (!status)
        status = take_rows(m, table, capture, &t, log);
    relume_table_destroy(&table);
    mem_free(t.white);
    return status;
}

relume_status mosaic_open(struct mosaic *m, const relume_capture *capture,
                          const struct relume_log *log)
{
    const struct relume_manifest *of = relume_capture_manifest(capture);
    const int width = relume_capture_width(capture), height = relume_capture_height(capture);
    *m = (struct mosaic){.columns = side_of(width), .rows = side_of(height)};
    const size_t n = (size_t)of->lights * (size_t)m->rows * (size_t)m->columns;
    float white[3];
    relume_capture_white(capture, 0, white);
    const bool floats = isinf(white[0]);
    float(*bright)[3] = mem_array((size_t)of->lights, sizeof *bright);
    m->x = mem_array((size_t)m->columns, sizeof *m->x);
    m->y = mem_array((size_t)m->rows, sizeof *m->y);
    m->pictures = mem_array(3 * n, floats ? sizeof(float) : sizeof(uint16_t));
    struct relume_manifest manifest = {
        .transfer = of->transfer.curve == RELUME_CURVE_GAMMA
                        ? of->transfer
                        : (struct relume_transfer){.curve = floats ? RELUME_CURVE_LINEAR
                                                                   : RELUME_CURVE_SRGB},
        .geometry = relume_geometry_default(RELUME_PLANAR, m->columns, m->rows),
        .lights = of->lights,
        .directions = of->directions,
        .intensities = (const float(*)[3])bright};
    relume_status status = bright && m->x && m->y && m->pictures ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        place_piece(m->x, m->columns, width);
        place_piece(m->y, m->rows, height);
        status = take_all(m, capture, bright, manifest.transfer, log);
    }
    if (!status) {
        const struct relume_pictures pictures = {.sample = floats ? RELUME_SAMPLE_FLOAT
                                                                  : RELUME_SAMPLE_16,
                                                 .width = m->columns,
                                                 .height = m->rows,
                                                 .channels = 3,
                                                 .data = m->pictures,
                                                 .mask = m->mask};
        status = relume_capture_create(&m->capture, &manifest, &pictures,
                                       relume_capture_params(.log = log));
    }
    mem_free(bright);
    return status;
}

void mosaic_close(struct mosaic *m)
{
    relume_capture_destroy(&m->capture);
    mem_free(m->x);
    mem_free(m->y);
    mem_free(m->pictures);
    mem_free(m->mask);
}
