// table.c - all images of a view read side by side, so that memory does not grow with their height
#include "capture/manifest/capture.h"
#include "capture/manifest/distant.h"
#include "capture/manifest/reflectance_table.h"
#include "capture/manifest/repair.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "image/image/encoder.h"

#include <stdio.h>
#include <string.h>

struct relume_table {
    const relume_capture *capture;
    int view, row;
    int threads;
    const struct relume_log *log;
    int open;                     // streams opened so far
    struct image_stream *stream;  // [lights]
    relume_status *status;        // [lights], of the last read
    int rows;                     // of the read in progress
    float *out;
    size_t *broken, *repaired;  // [lights]: pixels that were not finite, in one band and so far
    bool *whole;                // [lights], for repair_band
    bool near;                  // lights are near: values become those under distant ones
    struct near_view lamps;
    struct distant *distant;
    struct encoder *display;  // or NULL: linear
    bool bytes;               // all images are 8 bits and mean what they say
    const uint8_t **fetched;  // [lights]: rows fetched last, or
    float *band;              // [lights][rows][x][3]
};

static size_t file_bytes(const struct image_stream *stream)
{
    const struct picture_info *info = picture_info_of(stream->reader);
    return (size_t)info->width * (size_t)info->height * (size_t)info->channels;
}

// Rows come from memory where an earlier table has left them, else stay there if there is memory.
static void use_kept(relume_table *t, struct image_stream *stream, int light)
{
    struct image_cache *cache = t->capture->cache;
    if (!picture_info_of(stream->reader)->bytes)
        return;
    struct kept_image kept = image_cache_find(cache, t->view * t->capture->draft.m.lights + light);
    stream->kept = kept.rows;
    if (!stream->kept) {
        kept = image_cache_reserve(cache, file_bytes(stream));
        stream->keep = kept.rows;
    }
    stream->mapped = kept.mapped;
}

static void close_stream(relume_table *t, struct image_stream *stream, int light)
{
    if (stream->keep)
        image_cache_settle(t->capture->cache, t->view * t->capture->draft.m.lights + light,
                           (struct kept_image){stream->keep, stream->mapped}, file_bytes(stream),
                           t->row == t->capture->height && !t->status[light]);
    image_stream_close(stream);
}

void relume_table_destroy(relume_table **table)
{
    relume_table *t = *table;
    *table = NULL;
    if (!t)
        return;
    for (int i = 0; i < t->open; i++)
        close_stream(t, &t->stream[i], i);
    mem_free(t->stream);
    mem_free(t->status);
    mem_free(t->broken);
    mem_free(t->repaired);
    mem_free(t->whole);
    distant_destroy(&t->distant);
    near_view_close(&t->lamps);
    mem_free(t->display);
    mem_free(t->fetched);
    mem_free(t->band);
    mem_free(t);
}

static relume_status open_near(relume_table *t, struct relume_transfer display, bool keep_near)
{
    const struct relume_manifest *m = &t->capture->draft.m;
    relume_status status = near_view_open(&t->lamps, t->capture, t->view, t->log);
    if (!status && !keep_near)
        status = distant_create(&t->distant, &t->lamps, m->directions, t->threads);
    if (!status && display.curve != RELUME_CURVE_LINEAR) {
        t->display = mem_array(1, sizeof *t->display);
        status = t->display ? RELUME_OK : RELUME_ENOMEM;
        if (!status)
            encoder_init(t->display, display);
    }
    return status;
}

relume_status relume_table_open(relume_table **out, const relume_capture *capture, int view,
                                const struct relume_table_params *params)
{
    const struct relume_table_params p = PARAMS_WORK(relume_table_params, params);
    const int lights = capture->draft.m.lights;
    struct relume_transfer to = p.display;
    if (to.curve == RELUME_CURVE_AUTO)
        to.curve = RELUME_CURVE_LINEAR;
    *out = NULL;
    if (view < 0 || view >= capture->draft.m.views)
        return RELUME_EINVAL;

    relume_table *t = mem_zeroed(1, sizeof *t);
    if (!t)
        return RELUME_ENOMEM;
    t->capture = capture;
    t->view = view;
    t->threads = p.threads;
    t->log = p.log;
    t->stream = mem_zeroed((size_t)lights, sizeof *t->stream);
    t->status = mem_zeroed((size_t)lights, sizeof *t->status);
    t->broken = mem_zeroed((size_t)lights, sizeof *t->broken);
    t->repaired = mem_zeroed((size_t)lights, sizeof *t->repaired);
    t->whole = mem_zeroed((size_t)lights, sizeof *t->whole);
    t->fetched = mem_zeroed((size_t)lights, sizeof *t->fetched);
    relume_status status =
        t->stream && t->status && t->broken && t->repaired && t->whole && t->fetched
            ? RELUME_OK
            : RELUME_ENOMEM;
    t->near = near_view_applies(capture, view);
    t->bytes = !t->near;
    if (!status && t->near) {
        status = open_near(t, to, p.keep_near);
        to.curve = RELUME_CURVE_LINEAR;
    }
    while (!status && t->open < lights) {
        status = capture_stream(&t->stream[t->open], capture, view, t->open, to, p.log);
        if (!status)
            use_kept(t, &t->stream[t->open], t->open);
        t->bytes = t->bytes && !status && picture_info_of(t->stream[t->open].reader)->bytes;
        t->open += !status;
    }
    if (status)
        relume_table_destroy(&t);
    *out = t;
    return status;
}

static void read_light(void *context, size_t item, int worker)
{
    (void)worker;
    relume_table *t = context;
    const size_t pixels = (size_t)t->rows * (size_t)t->capture->width;
    float *out = t->out + 3 * item * pixels;
    t->status[item] = image_stream_read(&t->stream[item], t->row, t->rows, out);
    t->broken[item] = t->capture->repair && !t->status[item] ? repair_count(out, pixels) : 0;
}

static void repair(relume_table *t)
{
    const struct relume_manifest *m = &t->capture->draft.m;
    size_t sum = 0;
    for (int i = 0; i < m->lights; i++) {
        sum += t->broken[i];
        t->repaired[i] += t->broken[i];
    }
    if (sum)
        repair_band(t->out, t->broken, m->directions, m->lights,
                    (size_t)t->rows * (size_t)t->capture->width, t->whole);
}

// Linear values of one light are levelled and coded.
static void level_light(void *context, size_t item, int worker)
{
    (void)worker;
    relume_table *t = context;
    float *p = t->out + 3 * item * (size_t)t->rows * (size_t)t->lamps.width;
    for (int y = t->row - t->rows; y < t->row; y++)
        for (int x = 0; x < t->lamps.width; x++, p += 3) {
            double gain;
            near_view_direction(&gain, &t->lamps, (int)item, near_view_pixel(&t->lamps, x, y));
            float value[3];
            for (int c = 0; c < 3; c++)
                value[c] = p[c] * (float)gain;
            if (t->display)
                encoder_apply(t->display, value, p, 3);
            else
                memcpy(p, value, sizeof value);
        }
}

size_t relume_table_repaired(const relume_table *table, int light)
{
    return table->repaired[light];
}

// How many pixels of image `item` are not finite, the file being read once more.
static void count_broken(void *context, size_t item, int worker)
{
    (void)worker;
    relume_table *t = context;
    const relume_capture *capture = t->capture;
    const size_t width = (size_t)capture->width;
    const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};
    struct image_stream stream;
    float *band = mem_array(3 * IMAGE_STREAM_ROWS * width, sizeof *band);
    t->broken[item] = 0;
    if (band && !capture_stream(&stream, capture, t->view, (int)item, linear, NULL)) {
        stream.finite_only = false;
        for (int row = 0; row < capture->height; row += IMAGE_STREAM_ROWS) {
            const int left = capture->height - row;
            const int rows = left < IMAGE_STREAM_ROWS ? left : IMAGE_STREAM_ROWS;
            if (image_stream_read(&stream, row, rows, band))
                break;
            t->broken[item] += repair_count(band, (size_t)rows * width);
        }
        image_stream_close(&stream);
    }
    mem_free(band);
}

// The error about an image that is not finite names it and counts.
static relume_status refuse_broken(relume_table *t, int first)
{
    const struct relume_manifest *m = &t->capture->draft.m;
    char more[64] = "";
    int others = 0;
    thread_for(t->threads, (size_t)m->lights, count_broken, t);
    for (int i = 0; i < m->lights; i++)
        others += i != first && t->broken[i];
    if (others)
        snprintf(more, sizeof more, ", and some of %d more image%s", others, relume_plural(others));
    const size_t n = t->broken[first];
    if (!n)  // finite in the file, but not by the curve
        return log_fail(t->log, RELUME_EDAMAGED,
                        "%s: values are too bright to be converted; expected finite light: lower "
                        "the exposure, or another --transfer",
                        m->view[t->view].images[first]);
    return log_fail(t->log, RELUME_EDAMAGED,
                    "%s: %zu pixel%s NaN or infinite%s; expected finite radiance; 'relume "
                    "encode --repair' replaces such pixels",
                    m->view[t->view].images[first], n, n == 1 ? " is" : "s are", more);
}

static relume_status check_lights(relume_table *table)
{
    for (int i = 0; i < table->capture->draft.m.lights; i++) {
        if (relume_status_is_input(table->status[i]) && image_stream_is_broken(&table->stream[i]))
            return refuse_broken(table, i);
        if (relume_status_is_input(table->status[i]))
            return log_fail(table->log, table->status[i], "%s: %s",
                            table->capture->draft.m.view[table->view].images[i],
                            image_stream_error(&table->stream[i]));
        if (table->status[i])
            return table->status[i];
    }
    return RELUME_OK;
}

// `near` may be NULL.
static relume_status read(relume_table *table, int rows, float *out, float *near)
{
    const int lights = table->capture->draft.m.lights;
    if (rows < 1 || rows > table->capture->height - table->row)
        return RELUME_EINVAL;
    table->rows = rows;
    table->out = out;
    thread_for(table->threads, (size_t)lights, read_light, table);
    table->row += rows;
    const relume_status status = check_lights(table);
    if (status)
        return status;
    repair(table);
    if (table->near)
        thread_for(table->threads, (size_t)lights, level_light, table);
    image_forget(&table->lamps.depth, 0, table->row);
    if (near)
        memcpy(near, out,
               3 * (size_t)lights * (size_t)rows * (size_t)table->capture->width * sizeof *out);
    return table->distant ? distant_resample(table->distant, table->row - rows, rows, out)
                          : RELUME_OK;
}

relume_status relume_table_read(relume_table *table, int rows, float *out)
{
    return read(table, rows, out, NULL);
}

relume_status relume_table_read_near(relume_table *table, int rows, float *out, float *near)
{
    return read(table, rows, out, near);
}

bool relume_table_is_near(const relume_table *table)
{
    return table->near;
}

void relume_table_directions(const relume_table *table, double x, double y, int reach,
                             struct relume_vec3 *direction)
{
    const struct near_view *near = &table->lamps;
    const vec3 point = near_view_around(near, x, y, reach);
    double gain;
    for (int i = 0; i < near->lights; i++)
        direction[i] = near_view_direction(&gain, near, i, point);
}

static void fetch_light(void *context, size_t item, int worker)
{
    (void)worker;
    relume_table *t = context;
    t->status[item] = image_stream_fetch(&t->stream[item], t->row, t->rows, &t->fetched[item]);
}

static relume_status fetch_floats(relume_table *t, int rows)
{
    if (!t->band)
        t->band = mem_array((size_t)t->capture->draft.m.lights * (size_t)t->capture->width,
                            3 * RELUME_TABLE_ROWS * sizeof *t->band);
    return t->band ? relume_table_read(t, rows, t->band) : RELUME_ENOMEM;
}

relume_status relume_table_fetch(relume_table *table, int rows)
{
    if (rows < 1 || rows > RELUME_TABLE_ROWS || rows > table->capture->height - table->row)
        return RELUME_EINVAL;
    if (!table->bytes)
        return fetch_floats(table, rows);
    table->rows = rows;
    thread_for(table->threads, (size_t)table->capture->draft.m.lights, fetch_light, table);
    table->row += rows;
    return check_lights(table);
}

static void skip_light(void *context, size_t item, int worker)
{
    (void)worker;
    relume_table *t = context;
    t->status[item] = image_stream_skip(&t->stream[item], t->row, t->rows);
}

relume_status relume_table_skip(relume_table *table, int rows)
{
    if (rows < 0 || rows > table->capture->height - table->row)
        return RELUME_EINVAL;
    if (rows == 0)
        return RELUME_OK;
    table->rows = rows;
    thread_for(table->threads, (size_t)table->capture->draft.m.lights, skip_light, table);
    table->row += rows;
    return check_lights(table);
}

void relume_table_planes(const relume_table *table, int light, size_t first, size_t count,
                         float *out, size_t stride)
{
    const struct image_stream *stream = &table->stream[light];
    if (table->bytes) {
        const size_t channels = (size_t)picture_info_of(stream->reader)->channels;
        image_stream_planes(stream, table->fetched[light] + first * channels, count, out, stride);
        return;
    }
    const size_t pixels = (size_t)table->rows * (size_t)table->capture->width;
    const float *from = table->band + 3 * ((size_t)light * pixels + first);
    for (size_t x = 0; x < count; x++)
        for (size_t c = 0; c < 3; c++)
            out[c * stride + x] = from[3 * x + c];
}
