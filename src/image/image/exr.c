// exr.c - the one file that knows OpenEXR (its C core)
#include "image/image/exr.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "core/base/thread.h"
#include "core/base/half.h"
#include "image/image/exr_sums.h"
#include "image/image/piz.h"

#include <relume/context.h>

#include <errno.h>
#include <openexr.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "EXR samples are little endian");

size_t exr_sample_bytes(enum exr_sample sample)
{
    return sample == EXR_SAMPLE_HALF ? 2 : 4;
}

void exr_to_floats(float *out, enum exr_sample sample, const void *samples, size_t n)
{
    const uint16_t *halves = samples;
    const uint32_t *uints = samples;
    if (sample == EXR_SAMPLE_FLOAT)
        memcpy(out, samples, n * sizeof *out);
    for (size_t i = 0; sample == EXR_SAMPLE_HALF && i < n; i++)
        out[i] = float_from_half(halves[i]);
    for (size_t i = 0; sample == EXR_SAMPLE_UINT && i < n; i++)
        out[i] = (float)uints[i];
}

void exr_from_floats(void *samples, enum exr_sample sample, const float *numbers, size_t n)
{
    uint16_t *halves = samples;
    uint32_t *uints = samples;
    if (sample == EXR_SAMPLE_FLOAT)
        memcpy(samples, numbers, n * sizeof *numbers);
    for (size_t i = 0; sample == EXR_SAMPLE_HALF && i < n; i++)
        halves[i] = half_from_float(numbers[i]);
    for (size_t i = 0; sample == EXR_SAMPLE_UINT && i < n; i++)
        uints[i] = (uint32_t)numbers[i];
}

static const struct {
    exr_compression_t exr;
    const char *name;
    int rows;  // per block
} codecs[] = {
    [EXR_CODEC_NONE] = {EXR_COMPRESSION_NONE, "none", 1},
    [EXR_CODEC_RLE] = {EXR_COMPRESSION_RLE, "rle", 1},
    [EXR_CODEC_ZIP] = {EXR_COMPRESSION_ZIP, "zip", 16},
    [EXR_CODEC_PIZ] = {EXR_COMPRESSION_PIZ, "piz", 32},
};

static const exr_pixel_type_t pixel_types[] = {
    [EXR_SAMPLE_UINT] = EXR_PIXEL_UINT,
    [EXR_SAMPLE_HALF] = EXR_PIXEL_HALF,
    [EXR_SAMPLE_FLOAT] = EXR_PIXEL_FLOAT,
};

// The whole numbers with which a block begins: its part, its place, how many bytes follow.
struct lead {
    int32_t number[6];
    size_t count;
};

static struct lead lead_of(const exr_chunk_info_t *chunk, int part, size_t size)
{
    if (chunk->type == EXR_STORAGE_TILED)
        return (struct lead){
            {part, chunk->start_x, chunk->start_y, chunk->level_x, chunk->level_y, (int32_t)size},
            6};
    return (struct lead){{part, chunk->start_y, (int32_t)size}, 3};
}

// Bytes of that of rows, check sums among them, and of a tile.
enum { ROWS_LEAD = 12, TILE_LEAD = 24 };

static uint32_t sum_of(const struct lead *lead, const void *packed, size_t size)
{
    return exr_sum(exr_sum(0, lead->number, lead->count * sizeof *lead->number), packed, size);
}

static int tiles_across(int width, int tile)
{
    return (width + tile - 1) / tile;
}

// Of a strip of tiles, filled by one thread at a time.
enum { STRIP_ROWS = 16 };

// The core prints errors itself unless a handler takes them; the sentences are ours.
static void ignore_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context, (void)code, (void)message;
}

static exr_context_initializer_t initial(void *user)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = ignore_error;
    init.alloc_fn = mem_lend;
    init.free_fn = mem_free;
    init.user_data = user;
    return init;
}

// ---------------------------------------------------------------- writing

struct pipeline {
    exr_encode_pipeline_t exr;  // first: the core hands back a pointer to it
    exr_result_t (*compress)(exr_encode_pipeline_t *pipeline);  // the library's
    piz *piz;
};

struct writing {
    exr_context_t exr;
    outfile *file;
    relume_status io;  // what the stream saw
    const struct exr_part *part;
    int index, block_rows;
    int tile_row;  // of tiles: the row of them that is written, ...
    char *strip;   // ... and its samples
    pthread_mutex_t lock;
    pthread_cond_t turn;
    int next_block;
    relume_status status;        // the first failure of any block
    struct pipeline *pipelines;  // one a worker
    struct exr_sums sums;        // of what is written, where they are asked for, ...
    uint32_t *bytes;             // ... and how long each block is
    struct relume_buffer head;   // the headers of all parts
    bool heading;                // they are being written
};

static int64_t write_stream(exr_const_context_t context, void *user, const void *buffer,
                            uint64_t size, uint64_t offset, exr_stream_error_func_ptr_t error)
{
    (void)context, (void)error;
    struct writing *w = user;
    if (!w->io)
        w->io = outfile_write(w->file, buffer, size, (off_t)offset);
    if (!w->io && w->heading) {
        const struct relume_writer head = relume_buffer_writer(&w->head);
        w->io = head.write(head.user, buffer, size, offset) ? RELUME_OK : RELUME_ENOMEM;
    }
    return w->io ? -1 : (int64_t)size;
}

static exr_result_t set_attribute(exr_context_t exr, int part, const struct exr_attribute *a)
{
    switch (a->kind) {
    case EXR_INT: return exr_attr_set_int(exr, part, a->name, a->integer);
    case EXR_TEXT: return exr_attr_set_string(exr, part, a->name, a->text);
    case EXR_FLOATS: return exr_attr_set_float_vector(exr, part, a->name, a->count, a->floats);
    }
    return EXR_ERR_INVALID_ARGUMENT;
}

static exr_attr_box2i_t window_of(const struct exr_part *p)
{
    exr_attr_box2i_t window = {.max.x = p->width - 1};
    window.max.y = p->height - 1;
    return window;
}

// OpenEXR's C++ library refuses files whose parts do not share one display window, so that is the
// first part's for all of them; data windows may be smaller or larger.
static exr_result_t declare_part(exr_context_t exr, const struct exr_part *p,
                                 const struct exr_part *first)
{
    const exr_attr_box2i_t display = window_of(first), data = window_of(p);
    const exr_attr_v2f_t centre = {.x = 0.0f};
    int index;
    exr_result_t r =
        exr_add_part(exr, p->name, p->tile ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &index);
    if (!r)
        r = exr_initialize_required_attr(exr, index, &display, &data, 1.0f, &centre, 1.0f,
                                         EXR_LINEORDER_INCREASING_Y, codecs[p->codec].exr);
    if (!r && p->tile)
        r = exr_set_tile_descriptor(exr, index, (uint32_t)p->tile, (uint32_t)p->tile,
                                    EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN);
    for (int i = 0; !r && i < p->channels; i++)
        r = exr_add_channel(exr, index, p->channel[i], pixel_types[p->sample],
                            EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (int i = 0; !r && i < p->attributes; i++)
        r = set_attribute(exr, index, &p->attribute[i]);
    return r;
}

// Our samples are in file order already: this stage has nothing to convert.
static exr_result_t already_packed(exr_encode_pipeline_t *pipeline)
{
    pipeline->packed_bytes = pipeline->chunk.unpacked_size;
    return EXR_ERR_SUCCESS;
}

static bool lend(void **buffer, size_t *capacity, size_t size)
{
    if (*capacity >= size)
        return true;
    mem_free(*buffer);
    *buffer = mem_lend(size);
    *capacity = *buffer ? size : 0;
    return *buffer;
}

// By our own code, or by the library what that does not do.
static exr_result_t compress_once(struct pipeline *p)
{
    exr_encode_pipeline_t *e = &p->exr;
    const exr_coding_channel_info_t *c = e->channels;
    if (!p->piz)
        return p->compress(e);
    if (!lend(&e->scratch_buffer_1, &e->scratch_alloc_size_1, e->packed_bytes) ||
        !lend(&e->compressed_buffer, &e->compressed_alloc_size, piz_bound(e->packed_bytes)))
        return EXR_ERR_OUT_OF_MEMORY;
    e->compressed_bytes = piz_compress(p->piz, e->compressed_buffer, e->scratch_buffer_1,
                                       e->packed_buffer, c->width, c->height, e->channel_count);
    return e->compressed_bytes ? EXR_ERR_SUCCESS : p->compress(e);
}

// A block whose compressed size equals its plain size means "stored plain" to every reader, but
// OpenEXR 3.1 stores the compressed bytes then; only larger ones it replaces.
static exr_result_t compress(exr_encode_pipeline_t *pipeline)
{
    const exr_result_t r = compress_once((struct pipeline *)pipeline);
    const size_t plain = pipeline->packed_bytes;
    if (r || pipeline->compressed_bytes < plain || pipeline->compressed_alloc_size < plain)
        return r;
    memcpy(pipeline->compressed_buffer, pipeline->packed_buffer, plain);
    pipeline->compressed_bytes = plain;
    return r;
}

// The sum of a block that is about to be written.
static void sum_block(struct writing *w, int index, int block, const exr_chunk_info_t *chunk,
                      const void *packed, size_t size)
{
    if (!w->sums.word || index >= w->sums.parts)
        return;
    const size_t word = w->sums.first[index] + (size_t)block;
    const struct lead lead = lead_of(chunk, index, size);
    w->sums.word[word] = sum_of(&lead, packed, size);
    w->bytes[word] = (uint32_t)(lead.count * sizeof *lead.number + size);
}

struct block_turn {
    struct writing *w;
    int block;
};

// Blocks are compressed in parallel and must be written in order.
static exr_result_t await_turn(exr_encode_pipeline_t *pipeline)
{
    const struct block_turn *t = pipeline->encoding_user_data;
    sum_block(t->w, t->w->index, t->block, &pipeline->chunk, pipeline->compressed_buffer,
              pipeline->compressed_bytes);
    pthread_mutex_lock(&t->w->lock);
    while (t->w->next_block != t->block)
        pthread_cond_wait(&t->w->turn, &t->w->lock);
    const bool failed = t->w->status != RELUME_OK;
    pthread_mutex_unlock(&t->w->lock);
    return failed ? EXR_ERR_UNKNOWN : EXR_ERR_SUCCESS;
}

static void end_turn(struct writing *w, int block, relume_status status)
{
    pthread_mutex_lock(&w->lock);
    while (w->next_block != block)
        pthread_cond_wait(&w->turn, &w->lock);
    if (!w->status)
        w->status = status;
    w->next_block++;
    pthread_cond_broadcast(&w->turn);
    pthread_mutex_unlock(&w->lock);
}

// Of a part, by the number of the block.
static exr_result_t written_chunk(exr_chunk_info_t *out, const struct writing *w,
                                  const struct exr_part *part, int index, int block)
{
    const int across = part->tile ? tiles_across(part->width, part->tile) : 1;
    return part->tile
               ? exr_write_tile_chunk_info(w->exr, index, block % across, block / across, 0, 0, out)
               : exr_write_scanline_chunk_info(w->exr, index, block * codecs[part->codec].rows,
                                               out);
}

static relume_status prepare_pipeline(struct writing *w, struct pipeline *p, int block, void *turn)
{
    exr_encode_pipeline_t *pipeline = &p->exr;
    exr_chunk_info_t chunk;
    if (written_chunk(&chunk, w, w->part, w->index, block))
        return RELUME_ENOMEM;
    if (pipeline->channels) {
        if (exr_encoding_update(w->exr, w->index, &chunk, pipeline))
            return RELUME_ENOMEM;
    } else {
        static const uint8_t placeholder;  // the core wants pointers that our packing never reads
        if (exr_encoding_initialize(w->exr, w->index, &chunk, pipeline))
            return RELUME_ENOMEM;
        for (int i = 0; i < pipeline->channel_count; i++) {
            exr_coding_channel_info_t *c = &pipeline->channels[i];
            c->encode_from_ptr = &placeholder;
            c->user_bytes_per_element = (int16_t)exr_sample_bytes(w->part->sample);
            c->user_data_type = (uint16_t)pixel_types[w->part->sample];
            c->user_pixel_stride = c->user_bytes_per_element;
            c->user_line_stride = c->user_pixel_stride * w->part->width;
        }
        if (exr_encoding_choose_default_routines(w->exr, w->index, pipeline))
            return RELUME_ENOMEM;
        p->compress = pipeline->compress_fn;
        if (p->compress)
            pipeline->compress_fn = compress;
        if (w->part->codec == EXR_CODEC_PIZ && w->part->sample == EXR_SAMPLE_HALF &&
            !(p->piz = piz_create()))
            return RELUME_ENOMEM;
        pipeline->convert_and_pack_fn = already_packed;
        pipeline->yield_until_ready_fn = await_turn;
    }
    pipeline->encoding_user_data = turn;
    return lend(&pipeline->packed_buffer, &pipeline->packed_alloc_size, chunk.unpacked_size)
               ? RELUME_OK
               : RELUME_ENOMEM;
}

// The samples of a tile out of the strip of its row.
static void cut_tile(char *to, const struct writing *w, int column, int rows)
{
    const struct exr_part *p = w->part;
    const size_t sample = exr_sample_bytes(p->sample), width = (size_t)p->width;
    const size_t left = (size_t)column * (size_t)p->tile, tile = (size_t)p->tile;
    const size_t n = (width - left < tile ? width - left : tile) * sample;
    const char *from = w->strip + left * sample;
    for (size_t i = 0; i < (size_t)rows * (size_t)p->channels; i++, to += n, from += width * sample)
        memcpy(to, from, n);
}

static void write_block(void *context, size_t item, int worker)
{
    struct writing *w = context;
    const int first = w->tile_row * w->block_rows;
    const int row = w->part->tile ? first : (int)item * w->block_rows;
    const int left = w->part->height - row;
    const int rows = left < w->block_rows ? left : w->block_rows;
    const int across = w->part->tile ? tiles_across(w->part->width, w->part->tile) : 0;
    struct pipeline *pipeline = &w->pipelines[worker];
    struct block_turn turn = {w, w->tile_row * across + (int)item};

    relume_status status = prepare_pipeline(w, pipeline, turn.block, &turn);
    if (!status && w->part->tile)
        cut_tile(pipeline->exr.packed_buffer, w, (int)item, rows);
    else if (!status)
        status = w->part->rows(w->part->context, row, rows, pipeline->exr.packed_buffer);
    // samples are sound: what fails without the stream is memory, which zlib's callers name
    // otherwise
    if (!status && exr_encoding_run(w->exr, w->index, &pipeline->exr))
        status = w->io ? w->io : RELUME_ENOMEM;
    end_turn(w, turn.block, status);
}

// A few rows of the strip.
static void fill_strip(void *context, size_t item, int worker)
{
    struct writing *w = context;
    const struct exr_part *p = w->part;
    const int row = w->tile_row * p->tile + (int)item * STRIP_ROWS, end = row + STRIP_ROWS;
    const int limit = w->tile_row * p->tile + p->tile;
    const int last = limit < p->height ? limit : p->height;
    const size_t bytes = (size_t)p->width * (size_t)p->channels * exr_sample_bytes(p->sample);
    (void)worker;
    const relume_status status = row < last
                                     ? p->rows(p->context, row, (end < last ? end : last) - row,
                                               w->strip + item * STRIP_ROWS * bytes)
                                     : RELUME_OK;
    pthread_mutex_lock(&w->lock);
    if (!w->status)
        w->status = status;
    pthread_mutex_unlock(&w->lock);
}

static void write_tiles(struct writing *w, int threads)
{
    const struct exr_part *p = w->part;
    const size_t row = (size_t)p->width * (size_t)p->channels * exr_sample_bytes(p->sample);
    w->strip = mem_array((size_t)p->tile, row);
    if (!w->strip)
        w->status = RELUME_ENOMEM;
    for (w->tile_row = 0; !w->status && w->tile_row * p->tile < p->height; w->tile_row++) {
        thread_for(threads, ((size_t)p->tile + STRIP_ROWS - 1) / STRIP_ROWS, fill_strip, w);
        if (!w->status)
            thread_for(threads, (size_t)tiles_across(p->width, p->tile), write_block, w);
    }
    mem_free(w->strip);
}

static relume_status read_packed(const exr_file *file, int part, exr_chunk_info_t *chunk, int block,
                                 void **packed, size_t *capacity, const struct relume_log *log);

int exr_block_rows(enum exr_codec codec)
{
    return codecs[codec].rows;
}

static int blocks_of(const struct exr_part *p)
{
    const int rows = p->tile ? p->tile : codecs[p->codec].rows;
    return (p->height + rows - 1) / rows * (p->tile ? tiles_across(p->width, p->tile) : 1);
}

// Where the block of a part lies that is copied.
static struct exr_copied source_of(const struct exr_part *part, int *block)
{
    const int rows = codecs[part->codec].rows;
    struct exr_copied s = {part->from, part->from_part, 0, 0};
    for (int i = 0; i < part->sources && part->source[i].row <= *block * rows; i++)
        s = part->source[i];
    *block -= part->sources ? (s.row - s.from_row) / rows : 0;
    return s;
}

// Blocks go from file to file as they are.
static relume_status copy_part(struct writing *w, const struct exr_part *part, int index,
                               const struct relume_log *log)
{
    void *packed = NULL;
    size_t capacity = 0;
    const int across = part->tile ? tiles_across(part->width, part->tile) : 1;
    for (int block = 0; !w->status && block < blocks_of(part); block++) {
        exr_chunk_info_t chunk, to;
        int there = block;
        const struct exr_copied s = source_of(part, &there);
        w->status = read_packed(s.from, s.from_part, &chunk, there, &packed, &capacity, log);
        exr_result_t e = w->status ? 0 : written_chunk(&to, w, part, index, block);
        if (!w->status && !e)
            sum_block(w, index, block, &to, packed, chunk.packed_size);
        if (!w->status && !e && part->tile)
            e = exr_write_tile_chunk(w->exr, index, block % across, block / across, 0, 0, packed,
                                     chunk.packed_size);
        else if (!w->status && !e)
            e = exr_write_scanline_chunk(w->exr, index, to.start_y, packed, chunk.packed_size);
        if (!w->status && e)
            w->status = w->io ? w->io : RELUME_ENOMEM;
    }
    mem_free(packed);
    return w->status;
}

static relume_status write_part(struct writing *w, const struct exr_part *part, int index,
                                int threads, const struct relume_log *log)
{
    if (part->from)
        return copy_part(w, part, index, log);
    w->part = part;
    w->index = index;
    w->block_rows = part->tile ? part->tile : codecs[part->codec].rows;
    w->tile_row = 0;
    w->next_block = 0;
    w->pipelines = mem_zeroed((size_t)threads, sizeof *w->pipelines);
    if (!w->pipelines)
        return RELUME_ENOMEM;
    if (part->tile)
        write_tiles(w, threads);
    else
        thread_for(threads, (size_t)blocks_of(part), write_block, w);
    for (int i = 0; i < threads; i++) {
        exr_encoding_destroy(w->exr, &w->pipelines[i].exr);
        piz_destroy(&w->pipelines[i].piz);
    }
    mem_free(w->pipelines);
    return w->status;
}

static relume_status sums_rows(void *context, int row, int rows, void *samples)
{
    const struct exr_sums *s = context;
    memcpy(samples, s->word + (size_t)row * (size_t)s->width,
           (size_t)rows * (size_t)s->width * sizeof *s->word);
    return RELUME_OK;
}

static struct exr_part sums_part(const struct exr_sums *s)
{
    static const char *const channel[] = {EXR_SUMS_CHANNEL};
    return (struct exr_part){
        .name = EXR_SUMS_PART,
        .width = s->width,
        .height = s->height,
        .sample = EXR_SAMPLE_UINT,
        .codec = EXR_CODEC_NONE,
        .channels = 1,
        .channel = channel,
        .rows = sums_rows,
        .context = (void *)(uintptr_t)s,
    };
}

static relume_status prepare_sums(struct writing *w, const struct exr_part *parts, int count)
{
    relume_status status = exr_sums_create(&w->sums, count);
    for (int i = 0; !status && i < count; i++)
        exr_sums_count(&w->sums, (size_t)blocks_of(&parts[i]));
    if (!status)
        status = exr_sums_finish(&w->sums);
    if (!status)
        w->bytes = mem_zeroed(w->sums.first[count], sizeof *w->bytes);
    return w->bytes ? RELUME_OK : RELUME_ENOMEM;
}

// Headers, and behind them the tables, where each block begins: of all parts, then of the sums.
// Blocks follow one another without gaps.
static uint32_t sum_of_head(const struct writing *w)
{
    const struct exr_sums *s = &w->sums;
    const size_t end = s->first[s->parts], blocks = end - 1 + (size_t)s->height;
    const size_t row = ROWS_LEAD + (size_t)s->width * sizeof *s->word;
    uint32_t sum = exr_sum(0, w->head.data, w->head.size);
    uint64_t at = w->head.size + blocks * sizeof at;
    for (size_t i = 0; i < blocks; i++) {
        sum = exr_sum(sum, &at, sizeof at);
        at += i + 1 < end ? w->bytes[i + 1] : row;
    }
    return sum;
}

static relume_status write_sums(struct writing *w, const struct relume_log *log)
{
    struct exr_sums *s = &w->sums;
    const struct exr_part part = sums_part(s);
    s->word[0] = sum_of_head(w);
    s->word[(size_t)s->width * (size_t)s->height - 1] = exr_sums_own(s);
    return write_part(w, &part, s->parts, 1, log);
}

static exr_result_t write_headers(struct writing *w, const struct exr_part *parts, int count)
{
    exr_result_t r = EXR_ERR_SUCCESS;
    for (int i = 0; !r && i < count; i++)
        r = declare_part(w->exr, &parts[i], parts);
    const struct exr_part sums = sums_part(&w->sums);
    if (!r && w->sums.word)
        r = declare_part(w->exr, &sums, parts);
    w->heading = w->sums.word != NULL;
    if (!r)
        r = exr_write_header(w->exr);
    w->heading = false;
    return r;
}

// The headers of all parts; `path` is what messages call the file.
static relume_status begin_file(struct writing *w, const char *path, const struct exr_part *parts,
                                int count, bool sums, const struct relume_log *log)
{
    exr_context_initializer_t init = initial(w);
    init.write_fn = write_stream;
    path = infile_name(path);
    const relume_status status = sums ? prepare_sums(w, parts, count) : RELUME_OK;
    exr_result_t r = status ? 0 : exr_start_write(&w->exr, path, EXR_WRITE_FILE_DIRECTLY, &init);
    if (!status && !r)
        r = write_headers(w, parts, count);
    return !r                           ? status
           : w->io                      ? w->io
           : r == EXR_ERR_OUT_OF_MEMORY ? RELUME_ENOMEM
                                        : log_fail(log, RELUME_EIO, "%s: header refused; %s", path,
                                                   exr_get_default_error_message(r));
}

static bool end_file(struct writing *w)
{
    exr_sums_destroy(&w->sums);
    relume_buffer_destroy(&w->head);
    mem_free(w->bytes);
    return !w->exr || !exr_finish(&w->exr);
}

relume_status exr_write(const char *path, const struct relume_writer *writer,
                        const struct exr_part *parts, int count, bool sums, int threads,
                        const struct relume_log *log)
{
    threads = thread_count(threads);
    struct writing w = {.lock = PTHREAD_MUTEX_INITIALIZER, .turn = PTHREAD_COND_INITIALIZER};
    relume_status status = outfile_open(&w.file, path, writer, log);
    if (status)
        return status;
    status = begin_file(&w, path, parts, count, sums, log);
    for (int i = 0; !status && i < count; i++) {
        status = write_part(&w, &parts[i], i, threads, log);
        if (!status && !log_progress(log, "writing", (i + 1.0) / count))
            status = RELUME_ECANCEL;
    }
    if (!status && sums)
        status = write_sums(&w, log);
    if (!end_file(&w) && !status)
        status = w.io ? w.io : RELUME_EIO;
    if (!status)
        return outfile_commit(&w.file);
    outfile_abort(&w.file);
    return status;
}

// ---------------------------------------------------------------- size

static bool count_bytes(void *user, const void *bytes, size_t size, uint64_t offset)
{
    uint64_t *end = user;
    (void)bytes;
    *end = offset + size > *end ? offset + size : *end;
    return true;
}

// What is not blocks of the parts: headers, tables, sums.
static relume_status frame_size(uint64_t *bytes, const struct exr_part *parts, int count,
                                const struct relume_log *log)
{
    uint64_t end = 0;
    const struct relume_writer counting = {count_bytes, NULL, &end};
    struct writing w = {.lock = PTHREAD_MUTEX_INITIALIZER, .turn = PTHREAD_COND_INITIALIZER};
    relume_status status = outfile_open(&w.file, NULL, &counting, log);
    if (status)
        return status;
    status = begin_file(&w, NULL, parts, count, true, log);
    if (!status) {
        const size_t rows = (size_t)w.sums.height, blocks = w.sums.first[count] - 1 + rows;
        *bytes = w.head.size + blocks * sizeof *bytes +
                 rows * (ROWS_LEAD + (size_t)w.sums.width * sizeof *w.sums.word);
    }
    (void)end_file(&w);
    outfile_abort(&w.file);
    return status;
}

static bool is_plain(const struct exr_part *part)
{
    return part->codec == EXR_CODEC_NONE && !part->from && !part->sources;
}

static uint64_t plain_size(const struct exr_part *part)
{
    return (uint64_t)blocks_of(part) * (part->tile ? TILE_LEAD : ROWS_LEAD) +
           (uint64_t)part->width * (uint64_t)part->height * (uint64_t)part->channels *
               exr_sample_bytes(part->sample);
}

// Blocks of compressed parts, whose size nothing but packing them says.
static relume_status packed_size(uint64_t *bytes, const struct exr_part *parts, int count,
                                 int threads, const struct relume_log *log)
{
    uint64_t frame = 0, end = 0;
    const struct relume_writer counting = {count_bytes, NULL, &end};
    relume_status status = count ? frame_size(&frame, parts, count, log) : RELUME_OK;
    if (!status && count)
        status = exr_write(NULL, &counting, parts, count, true, threads, log);
    *bytes = end - frame;
    return status;
}

relume_status exr_size(uint64_t *bytes, const struct exr_part *parts, int count, int threads,
                       const struct relume_log *log)
{
    struct exr_part *packed = mem_array((size_t)count, sizeof *packed);
    uint64_t plain = 0, frame = 0, blocks = 0;
    int n = 0;
    for (int i = 0; packed && i < count; i++)
        if (is_plain(&parts[i]))
            plain += plain_size(&parts[i]);
        else
            packed[n++] = parts[i];
    relume_status status = packed ? frame_size(&frame, parts, count, log) : RELUME_ENOMEM;
    if (!status)
        status = packed_size(&blocks, packed, n, threads, log);
    *bytes = frame + plain + blocks;
    mem_free(packed);
    return status;
}

// ---------------------------------------------------------------- reading

struct exr_file {
    exr_context_t exr;
    char *path;
    struct infile in;
    int parts;             // without the sums
    struct exr_sums sums;  // with which blocks are compared, or empty
};

static int64_t read_stream(exr_const_context_t context, void *user, void *buffer, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t error)
{
    exr_file *file = user;
    const ssize_t n = infile_read(&file->in, buffer, (size_t)size, offset);
    if (n < 0)
        (void)error(context, EXR_ERR_READ_IO, "cannot be read");
    return n;
}

static int64_t stream_size(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((exr_file *)user)->in.size;
}

struct relume_rect exr_overlap(const struct relume_rect *at, const struct relume_rect *rect)
{
    const int left = at->left > rect->left ? at->left : rect->left;
    const int top = at->top > rect->top ? at->top : rect->top;
    const int right = at->left + at->width, bottom = at->top + at->height;
    const int most_right = rect->left + rect->width, most_bottom = rect->top + rect->height;
    const struct relume_rect both = {left, top, (right < most_right ? right : most_right) - left,
                                     (bottom < most_bottom ? bottom : most_bottom) - top};
    return both.width > 0 && both.height > 0 ? both : (struct relume_rect){left, top, 0, 0};
}

uint64_t exr_bytes(const exr_file *file)
{
    return file->in.size;
}

void exr_close(exr_file **file)
{
    if (!*file)
        return;
    if ((*file)->exr)
        exr_finish(&(*file)->exr);
    infile_close(&(*file)->in);
    exr_sums_destroy(&(*file)->sums);
    mem_free((*file)->path);
    mem_free(*file);
    *file = NULL;
}

// What parts claim, before anything is set aside for them: not more than a picture of one colour
// comes to (64 MiB always), not more than memory holds.
static relume_status check_bytes(const exr_file *file, const struct relume_limits *limits,
                                 const struct relume_log *log)
{
    static const uint64_t ratio = 20000, always = 64 << 20;
    const uint64_t most = limits_or_default(limits).max_memory, size = exr_bytes(file);
    for (int i = 0; i < exr_part_count(file); i++) {
        const struct exr_part_info part = exr_part_info(file, i);
        const uint64_t planes = (uint64_t)part.channels;
        const uint64_t bytes = (uint64_t)part.width * (uint64_t)part.height * planes * 4;
        if (bytes > always && bytes / ratio > size)
            return log_fail(log, RELUME_EDAMAGED,
                            "%s: part %d claims %d x %d pixels of %d channel%s in %llu bytes; "
                            "damaged, or made to fill memory",
                            file->path, i, part.width, part.height, part.channels,
                            relume_plural(part.channels), (unsigned long long)size);
        if (bytes > most && !part.tile)  // of tiles no more is read than what is asked for
            return log_fail(log, RELUME_ELIMIT,
                            "%s: part %d of %d x %d pixels and %d channels takes %s; expected at "
                            "most %s (--max-memory)",
                            file->path, i, part.width, part.height, part.channels,
                            memory_text(bytes, most).text, memory_text(most, bytes).text);
    }
    return RELUME_OK;
}

// The side of square tiles without reduced levels; 0: scanlines; -1: anything else.
static int tile_of(const exr_file *file, int part)
{
    exr_storage_t storage;
    uint32_t side[2];
    exr_tile_level_mode_t levels;
    exr_tile_round_mode_t round;
    if (exr_get_storage(file->exr, part, &storage))
        return -1;
    if (storage == EXR_STORAGE_SCANLINE)
        return 0;
    if (storage != EXR_STORAGE_TILED ||
        exr_get_tile_descriptor(file->exr, part, &side[0], &side[1], &levels, &round))
        return -1;
    return levels == EXR_TILE_ONE_LEVEL && side[0] == side[1] && side[0] >= 16 && side[0] <= 4096
               ? (int)side[0]
               : -1;
}

// Everything later code relies on: kinds of blocks, channels, a size within the limits.
static relume_status check_parts(const exr_file *file, const struct relume_limits *limits,
                                 const struct relume_log *log)
{
    const int count = exr_part_count(file);
    if (count < 1)
        return log_fail(log, RELUME_EFORMAT, "%s: no parts; expected an EXR image", file->path);
    for (int i = 0; i < count; i++) {
        const exr_attr_chlist_t *channels;
        exr_attr_box2i_t box;
        if (tile_of(file, i) < 0)
            return log_fail(log, RELUME_EUNSUPPORTED,
                            "%s: part %d is deep or has mipmaps; expected scanlines or plain tiles",
                            file->path, i);
        if (exr_get_channels(file->exr, i, &channels) || channels->num_channels < 1)
            return log_fail(log, RELUME_EDAMAGED, "%s: part %d has no channels", file->path, i);
        if (exr_get_data_window(file->exr, i, &box))
            return log_fail(log, RELUME_EDAMAGED, "%s: part %d has no data window", file->path, i);
        const relume_status allowed =
            limits_picture(limits, file->path, (int64_t)box.max.x - box.min.x + 1,
                           (int64_t)box.max.y - box.min.y + 1, log);
        if (allowed)
            return allowed;
    }
    return check_bytes(file, limits, log);
}

// What decoding blocks of a part needs to know of it.
struct layout {
    const exr_file *file;
    int part, first_row, width, height, block_rows, channels;
    int tile, across;  // side of the tiles, and how many there are in a row; 0: runs of rows
    size_t blocks;
    size_t row_bytes;  // of one channel
};

static bool find_layout(struct layout *out, const exr_file *file, int part)
{
    const struct exr_part_info info = exr_part_info(file, part);
    int32_t block_rows = info.tile;
    if (!info.tile && exr_get_scanlines_per_chunk(file->exr, part, &block_rows))
        return false;
    if (block_rows < 1)
        return false;
    *out = (struct layout){.file = file,
                           .part = part,
                           .first_row = info.y,
                           .width = info.width,
                           .height = info.height,
                           .block_rows = block_rows,
                           .channels = info.channels,
                           .tile = info.tile,
                           .across = info.tile ? tiles_across(info.width, info.tile) : 1,
                           .row_bytes = (size_t)info.width * exr_sample_bytes(info.sample)};
    out->blocks =
        ((size_t)info.height + (size_t)block_rows - 1) / (size_t)block_rows * (size_t)out->across;
    return true;
}

// Where the block of number `item` lies.
static struct relume_rect rect_of(const struct layout *l, size_t item)
{
    const int column = (int)(item % (size_t)l->across), row = (int)(item / (size_t)l->across);
    const struct relume_rect all = {0, 0, l->width, l->height};
    const struct relume_rect at = {column * l->tile, row * l->block_rows,
                                   l->tile ? l->tile : l->width, l->block_rows};
    return exr_overlap(&at, &all);
}

static exr_result_t find_chunk(exr_chunk_info_t *out, const struct layout *l, size_t item)
{
    const int column = (int)(item % (size_t)l->across), row = (int)(item / (size_t)l->across);
    return l->tile ? exr_read_tile_chunk_info(l->file->exr, l->part, column, row, 0, 0, out)
                   : exr_read_scanline_chunk_info(l->file->exr, l->part,
                                                  l->first_row + row * l->block_rows, out);
}

// All parts of the container, the sums among them.
static int count_parts(const exr_file *file)
{
    int count;
    return exr_get_count(file->exr, &count) ? 0 : count;
}

// Parts are written one after the other, so a file cut anywhere lacks the last block of some part,
// or some of the check sums, which need not be read for that.
static relume_status check_ends(const exr_file *file, const struct relume_log *log)
{
    const uint64_t size = exr_bytes(file);
    uint64_t end = 0;
    int part = 0;
    bool whole = true;
    for (; whole && part < file->parts; part += whole) {
        exr_chunk_info_t last;
        struct layout layout;
        whole = find_layout(&layout, file, part) &&
                !find_chunk(&last, &layout, layout.blocks - 1) && last.data_offset <= size &&
                last.packed_size <= size - last.data_offset;
        end = whole ? last.data_offset + last.packed_size : 0;
    }
    if (whole && exr_has_sums(file)) {
        const struct exr_part_info sums = exr_part_info(file, part);
        const uint64_t row = ROWS_LEAD + 4 * (uint64_t)sums.width;
        whole = (uint64_t)sums.height * row <= size - end;
    }
    return whole ? RELUME_OK
                 : log_fail(log, RELUME_EDAMAGED,
                            "%s: truncated or damaged in part %d; expected %d rows", file->path,
                            part, exr_part_info(file, part).height);
}

// The library says "error reading from stream" of a folder, and of a text that its header is bad.
static const char *why_unread(exr_file *file, exr_result_t r)
{
    char magic[4];
    const ssize_t n = infile_read(&file->in, magic, sizeof magic, 0);
    if (n <= 0)
        return "it is empty, or a folder";
    if (n < (ssize_t)sizeof magic || memcmp(magic, "\x76\x2f\x31\x01", sizeof magic))
        return "it is a file of another kind";
    return r == EXR_ERR_READ_IO || r == EXR_ERR_FILE_BAD_HEADER || r == EXR_ERR_MISSING_REQ_ATTR
               ? "it is damaged or cut off in its header"
               : exr_get_default_error_message(r);
}

// Whether a part is what exr_write puts behind the others.
static bool is_sums(const exr_file *file, int part)
{
    const struct exr_part_info info = exr_part_info(file, part);
    return part > 0 && !strcmp(info.name, EXR_SUMS_PART) && info.channels == 1 && !info.tile &&
           info.uniform && info.sample == EXR_SAMPLE_UINT &&
           !strcmp(exr_channel_name(file, part, 0), EXR_SUMS_CHANNEL);
}

static relume_status start_read(exr_file *file, const struct relume_limits *limits,
                                const struct relume_log *log)
{
    exr_context_initializer_t init = initial(file);
    init.read_fn = read_stream;
    init.size_fn = stream_size;
    const exr_result_t r = exr_start_read(&file->exr, file->path, &init);
    if (r == EXR_ERR_OUT_OF_MEMORY)
        return RELUME_ENOMEM;
    if (r)
        return log_fail(log,
                        r == EXR_ERR_FILE_BAD_HEADER           ? RELUME_EFORMAT
                        : r == EXR_ERR_FEATURE_NOT_IMPLEMENTED ? RELUME_EUNSUPPORTED
                                                               : RELUME_EDAMAGED,
                        "%s: cannot be read as OpenEXR; %s", file->path, why_unread(file, r));
    file->parts = count_parts(file);
    const relume_status status = check_parts(file, limits, log);
    file->parts -= !status && is_sums(file, file->parts - 1);
    return status;
}

relume_status exr_open_damaged(exr_file **out, const char *path, const struct relume_reader *from,
                               const struct relume_limits *limits, const struct relume_log *log)
{
    *out = NULL;
    exr_file *file = mem_zeroed(1, sizeof *file);
    if (!file || !(file->path = mem_text(infile_name(path)))) {
        mem_free(file);
        return RELUME_ENOMEM;
    }
    const relume_status status =
        infile_open(&file->in, path, from, log)
            ? start_read(file, limits, log)
            : relume_input_fail(log, file->path, "cannot be opened", errno);
    if (status)
        exr_close(&file);
    *out = file;
    return status;
}

relume_status exr_open(exr_file **out, const char *path, const struct relume_reader *from,
                       const struct relume_limits *limits, const struct relume_log *log)
{
    relume_status status = exr_open_damaged(out, path, from, limits, log);
    if (!status)
        status = check_ends(*out, log);
    if (status)
        exr_close(out);
    return status;
}

int exr_part_count(const exr_file *file)
{
    return file->parts;
}

bool exr_has_sums(const exr_file *file)
{
    return file->parts < count_parts(file);
}

static const exr_attr_chlist_t *channel_list(const exr_file *file, int part)
{
    const exr_attr_chlist_t *list = NULL;
    (void)!exr_get_channels(file->exr, part, &list);  // there are some: exr_open has looked
    return list;
}

static const char *codec_name(const exr_file *file, int part)
{
    exr_compression_t compression;
    if (!exr_get_compression(file->exr, part, &compression))
        for (size_t i = 0; i < sizeof codecs / sizeof *codecs; i++)
            if (codecs[i].exr == compression)
                return codecs[i].name;
    return "other";
}

struct exr_part_info exr_part_info(const exr_file *file, int part)
{
    const exr_attr_chlist_t *list = channel_list(file, part);
    exr_attr_box2i_t box;
    memset(&box, 0, sizeof box);
    (void)!exr_get_data_window(file->exr, part, &box);
    const char *name = NULL;
    if (exr_get_name(file->exr, part, &name) || !name)
        name = "";
    struct exr_part_info info = {
        .name = name,
        .width = box.max.x - box.min.x + 1,
        .height = box.max.y - box.min.y + 1,
        .x = box.min.x,
        .y = box.min.y,
        .sample = (enum exr_sample)list->entries[0].pixel_type,
        .uniform = true,
        .channels = list->num_channels,
        .codec = codec_name(file, part),
        .tile = tile_of(file, part),
    };
    for (int i = 0; i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *e = &list->entries[i];
        info.subsampled |= e->x_sampling != 1 || e->y_sampling != 1;
        info.uniform &= e->pixel_type == list->entries[0].pixel_type && !info.subsampled;
    }
    return info;
}

const char *exr_channel_name(const exr_file *file, int part, int channel)
{
    return channel_list(file, part)->entries[channel].name.str;
}

int exr_channel_step(const exr_file *file, int part, int channel)
{
    const exr_attr_chlist_entry_t *e = &channel_list(file, part)->entries[channel];
    return e->x_sampling == e->y_sampling ? e->x_sampling : 0;
}

// Whether EXR itself asks for an attribute.
static bool is_required(const char *name)
{
    static const char *const known[] = {"channels",
                                        "chunkCount",
                                        "compression",
                                        "dataWindow",
                                        "displayWindow",
                                        "lineOrder",
                                        "name",
                                        "type",
                                        "version",
                                        "pixelAspectRatio",
                                        "screenWindowCenter",
                                        "screenWindowWidth"};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (!strcmp(name, known[k]))
            return true;
    return false;
}

bool exr_is_plain(const exr_file *file, int part)
{
    int32_t count;
    bool plain = !exr_get_attribute_count(file->exr, part, &count);
    for (int32_t i = 0; plain && i < count; i++) {
        const exr_attribute_t *a;
        plain = !exr_get_attribute_by_index(file->exr, part, EXR_ATTR_LIST_FILE_ORDER, i, &a) &&
                is_required(a->name);
    }
    return plain;
}

// False for kinds that exr_write does not make.
static bool attribute_again(struct exr_attribute *out, const exr_attribute_t *a)
{
    *out = (struct exr_attribute){.name = a->name};
    switch (a->type) {
    case EXR_ATTR_INT:
        out->kind = EXR_INT;
        out->integer = a->i;
        return true;
    case EXR_ATTR_STRING:
        out->kind = EXR_TEXT;
        out->text = a->string->str;
        return true;
    case EXR_ATTR_FLOAT_VECTOR:
        out->kind = EXR_FLOATS;
        out->floats = a->floatvector->arr;
        out->count = a->floatvector->length;
        return true;
    default: return false;
    }
}

static relume_status attributes_again(struct exr_part *out, const exr_file *file, int part,
                                      struct arena *arena)
{
    int32_t count;
    if (exr_get_attribute_count(file->exr, part, &count))
        return RELUME_EDAMAGED;
    struct exr_attribute *own = arena_array(arena, (size_t)count, sizeof *own);
    if (!own)
        return RELUME_ENOMEM;
    out->attribute = own;
    for (int32_t i = 0; i < count; i++) {
        const exr_attribute_t *a;
        if (exr_get_attribute_by_index(file->exr, part, EXR_ATTR_LIST_FILE_ORDER, i, &a))
            return RELUME_EDAMAGED;
        out->attributes += !is_required(a->name) && attribute_again(&own[out->attributes], a);
    }
    return RELUME_OK;
}

static bool codec_again(enum exr_codec *out, const char *name)
{
    for (size_t i = 0; i < sizeof codecs / sizeof *codecs; i++)
        if (!strcmp(codecs[i].name, name)) {
            *out = (enum exr_codec)i;
            return true;
        }
    return false;
}

relume_status exr_part_again(struct exr_part *out, const exr_file *file, int part,
                             struct arena *arena)
{
    const struct exr_part_info info = exr_part_info(file, part);
    const char **channel = arena_array(arena, (size_t)info.channels, sizeof *channel);
    *out = (struct exr_part){
        .name = info.name,
        .width = info.width,
        .height = info.height,
        .sample = info.sample,
        .tile = info.tile,
        .channels = info.channels,
        .channel = channel,
        .from = file,
        .from_part = part,
    };
    if (!channel)
        return RELUME_ENOMEM;
    for (int i = 0; i < info.channels; i++)
        channel[i] = exr_channel_name(file, part, i);
    if (!codec_again(&out->codec, info.codec) || !info.uniform || info.x || info.y)
        return RELUME_EDAMAGED;
    return attributes_again(out, file, part, arena);
}

bool exr_get_int(const exr_file *file, int part, const char *name, int *value)
{
    int32_t v;
    if (exr_attr_get_int(file->exr, part, name, &v))
        return false;
    *value = v;
    return true;
}

const char *exr_get_text(const exr_file *file, int part, const char *name)
{
    int32_t length;
    const char *text;
    return exr_attr_get_string(file->exr, part, name, &length, &text) ? NULL : text;
}

bool exr_get_chromaticities(const exr_file *file, int part, float xy[8])
{
    exr_attr_chromaticities_t c;
    if (exr_attr_get_chromaticities(file->exr, part, "chromaticities", &c))
        return false;
    const float found[8] = {c.red_x,  c.red_y,  c.green_x, c.green_y,
                            c.blue_x, c.blue_y, c.white_x, c.white_y};
    memcpy(xy, found, sizeof found);
    bool good = true;
    for (int i = 0; i < 8; i++)
        good &= xy[i] > -2 && xy[i] < 2 && (i % 2 == 0 || xy[i] > 1e-3f);
    return good;
}

const float *exr_get_floats(const exr_file *file, int part, const char *name, int *count)
{
    int32_t n;
    const float *floats;
    if (exr_attr_get_float_vector(file->exr, part, name, &n, &floats))
        return NULL;
    *count = n;
    return floats;
}

// Whether a block that has been read is not the one that was written.
static bool is_changed(const struct layout *l, size_t item, const exr_chunk_info_t *chunk,
                       const void *packed)
{
    const struct exr_sums *s = &l->file->sums;
    if (!s->word || l->part >= s->parts)
        return false;
    const struct lead lead = lead_of(chunk, l->part, chunk->packed_size);
    return sum_of(&lead, packed, chunk->packed_size) != s->word[s->first[l->part] + item];
}

// A block as it is packed, into *packed, which grows.
static relume_status read_packed(const exr_file *file, int part, exr_chunk_info_t *chunk, int block,
                                 void **packed, size_t *capacity, const struct relume_log *log)
{
    struct layout layout = {.across = 1};
    const bool found = find_layout(&layout, file, part) &&
                       !find_chunk(chunk, &layout, (size_t)block) &&
                       chunk->packed_size <= chunk->unpacked_size;
    if (found && chunk->packed_size > *capacity) {
        mem_free(*packed);
        *capacity = 0;
        *packed = mem_array(chunk->packed_size, 1);
        if (!*packed)
            return RELUME_ENOMEM;
        *capacity = chunk->packed_size;
    }
    if (found && !exr_read_chunk(file->exr, part, chunk, *packed) &&
        !is_changed(&layout, (size_t)block, chunk, *packed))
        return RELUME_OK;
    const struct relume_rect at = rect_of(&layout, (size_t)block);
    return log_fail(log, RELUME_EDAMAGED,
                    "%s: damaged in part '%s', rows %d to %d; run this part again", file->path,
                    exr_part_info(file, part).name, at.top, at.top + at.height - 1);
}

// The core's pipeline, and our own code beside its.
struct unpacking {
    exr_decode_pipeline_t exr;  // first: the core hands back a pointer to it
    exr_result_t (*decompress)(exr_decode_pipeline_t *pipeline);
    piz_decoder *piz;
    const struct piz_conversion *to;  // or NULL
    bool converted;                   // the present block
};

static void end_unpacking(const exr_file *file, struct unpacking *u)
{
    exr_decoding_destroy(file->exr, &u->exr);
    piz_decoder_destroy(&u->piz);
}

// Bytes of a sample where all channels of a block are alike, 0 where they differ.
static int bytes_of_all(const exr_decode_pipeline_t *p)
{
    const exr_coding_channel_info_t *c = p->channels;
    bool alike = p->channel_count > 0;
    for (int i = 1; i < p->channel_count; i++)
        alike &= c[i].width == c->width && c[i].height == c->height &&
                 c[i].bytes_per_element == c->bytes_per_element;
    return alike ? c->bytes_per_element : 0;
}

// By our own code, or by the library what that does not know.
static exr_result_t decompress(exr_decode_pipeline_t *p)
{
    struct unpacking *u = (struct unpacking *)p;
    const exr_coding_channel_info_t *c = p->channels;
    const int bytes = bytes_of_all(p);
    const uint64_t samples =
        bytes ? (uint64_t)c->width * (uint64_t)c->height * (uint64_t)p->channel_count : 0;
    const struct piz_conversion *to = u->to && u->to->bytes <= 2 ? u->to : NULL;
    if (!samples || p->chunk.packed_size >= p->chunk.unpacked_size ||
        samples * (uint64_t)bytes != p->chunk.unpacked_size || !p->unpacked_buffer)
        return u->decompress(p);
    if (!piz_decoder_reserve(u->piz, (size_t)c->width * (size_t)c->height, bytes / 2))
        return EXR_ERR_OUT_OF_MEMORY;
    if (!piz_decompress(u->piz, p->unpacked_buffer, p->packed_buffer, p->chunk.packed_size,
                        c->width, c->height, p->channel_count, bytes / 2, to))
        return u->decompress(p);
    u->converted = to != NULL;
    return EXR_ERR_SUCCESS;
}

// A block, decoded.
struct block {
    struct relume_rect at;
    void *samples;  // the pipeline's
};

// Hands the decompressed rows on as they are. The core leaves a block unset that has no bytes, and
// one that is not compressed and has too many.
static exr_result_t deliver(exr_decode_pipeline_t *pipeline)
{
    struct block *b = pipeline->decoding_user_data;
    void *samples = pipeline->unpacked_buffer ? pipeline->unpacked_buffer : pipeline->packed_buffer;
    const bool whole = pipeline->decompress_fn
                           ? pipeline->chunk.packed_size > 0
                           : pipeline->chunk.packed_size == pipeline->chunk.unpacked_size;
    if (!samples || !whole)
        return EXR_ERR_CORRUPT_CHUNK;
    b->samples = samples;
    return EXR_ERR_SUCCESS;
}

// The core says that memory is short of codes that end too early as well: whether it was is in
// errno, which an allocation that fails sets.
static relume_status block_error(exr_result_t e)
{
    return e == EXR_ERR_OUT_OF_MEMORY && errno == ENOMEM ? RELUME_ENOMEM : RELUME_EDAMAGED;
}

static exr_result_t begin_unpacking(struct unpacking *u, const struct layout *l,
                                    const exr_chunk_info_t *chunk)
{
    exr_decode_pipeline_t *pipeline = &u->exr;
    exr_result_t e = exr_decoding_initialize(l->file->exr, l->part, chunk, pipeline);
    if (!e)
        e = exr_decoding_choose_default_routines(l->file->exr, l->part, pipeline);
    u->decompress = pipeline->decompress_fn;
    if (!e && u->decompress && chunk->compression == EXR_COMPRESSION_PIZ) {
        u->piz = piz_decoder_create();
        pipeline->decompress_fn = decompress;
        e = u->piz ? e : EXR_ERR_OUT_OF_MEMORY;
    }
    return e;
}

// The block of number `item`. RELUME_EDAMAGED: truncated or damaged; RELUME_ENOMEM.
static relume_status decode(struct block *out, const struct layout *l, struct unpacking *unpacking,
                            size_t item)
{
    exr_decode_pipeline_t *pipeline = &unpacking->exr;
    unpacking->converted = false;
    const exr_const_context_t exr = l->file->exr;
    exr_chunk_info_t chunk;
    errno = 0;
    exr_result_t e = find_chunk(&chunk, l, item);
    if (!e)
        e = pipeline->channels ? exr_decoding_update(exr, l->part, &chunk, pipeline)
                               : begin_unpacking(unpacking, l, &chunk);
    pipeline->decoding_user_data = out;
    pipeline->unpack_and_convert_fn = deliver;
    if (!e)
        e = exr_decoding_run(exr, l->part, pipeline);
    if (e)
        return block_error(e);
    if (is_changed(l, item, &pipeline->chunk, pipeline->packed_buffer))
        return RELUME_EDAMAGED;
    out->at = rect_of(l, item);
    return RELUME_OK;
}

// Codes are no larger than samples, over which they are written.
static bool convert(const struct block *block, const struct unpacking *u)
{
    const exr_coding_channel_info_t *c = u->exr.channels;
    const size_t samples = (size_t)c->width * (size_t)c->height * (size_t)u->exr.channel_count;
    return u->converted || !u->to ||
           (bytes_of_all(&u->exr) >= (int)u->to->bytes &&
            u->to->convert(u->to->context, block->samples, block->samples, samples));
}

struct reading {
    struct layout layout;
    void (*sink)(void *, const struct relume_rect *, const void *);
    void *context;
    size_t first, across;         // block; blocks of a row of them that are wanted
    struct unpacking *pipelines;  // one a worker
    atomic_int status;            // the last failure of any block
    atomic_bool wrong;
};

static void read_block(void *context, size_t item, int worker)
{
    struct reading *r = context;
    struct block block = {0};
    const size_t row = item / r->across, column = item % r->across;
    if (atomic_load(&r->status))
        return;
    const relume_status status = decode(&block, &r->layout, &r->pipelines[worker],
                                        r->first + row * (size_t)r->layout.across + column);
    if (status)
        atomic_store(&r->status, (int)status);
    else if (convert(&block, &r->pipelines[worker]))
        r->sink(r->context, &block.at, block.samples);
    else
        atomic_store(&r->wrong, true);
}

relume_status exr_read(const exr_file *file, int part, const struct relume_rect *rect, int threads,
                       void (*sink)(void *, const struct relume_rect *, const void *),
                       void *context, const struct relume_log *log)
{
    bool wrong;
    return exr_read_codes(file, part, rect, threads, NULL, &wrong, sink, context, log);
}

relume_status exr_read_codes(const exr_file *file, int part, const struct relume_rect *rect,
                             int threads, const struct piz_conversion *to, bool *wrong,
                             void (*sink)(void *, const struct relume_rect *, const void *),
                             void *context, const struct relume_log *log)
{
    *wrong = false;
    threads = thread_count(threads);
    struct reading r = {.sink = sink, .context = context};
    struct layout *l = &r.layout;
    if (!find_layout(l, file, part))
        return log_fail(log, RELUME_EDAMAGED, "%s: part %d is broken", file->path, part);
    const struct relume_rect at = rect ? *rect : (struct relume_rect){0, 0, l->width, l->height};
    const int rows = l->block_rows, side = l->tile ? l->tile : l->width;
    const int top = at.top / rows, left = at.left / side;
    r.pipelines = mem_zeroed((size_t)threads, sizeof *r.pipelines);
    if (!r.pipelines)
        return RELUME_ENOMEM;
    for (int i = 0; i < threads; i++)
        r.pipelines[i].to = to;
    r.first = (size_t)top * (size_t)l->across + (size_t)left;
    r.across = (size_t)((at.left + at.width - 1) / side + 1 - left);
    thread_for(threads, r.across * (size_t)((at.top + at.height - 1) / rows + 1 - top), read_block,
               &r);
    for (int i = 0; i < threads; i++)
        end_unpacking(file, &r.pipelines[i]);
    mem_free(r.pipelines);
    const relume_status status = (relume_status)atomic_load(&r.status);
    *wrong = atomic_load(&r.wrong);
    if (status == RELUME_EDAMAGED)
        return log_fail(log, RELUME_EDAMAGED,
                        "%s: truncated or damaged in part '%s'; expected %d rows", file->path,
                        exr_part_info(file, part).name, r.layout.height);
    return status;
}

struct finding {
    struct layout layout;
    struct unpacking *pipelines;  // one a worker
    bool *damaged;                // of each block
    atomic_bool short_of_memory;
};

static void try_block(void *context, size_t item, int worker)
{
    struct finding *f = context;
    struct block block = {0};
    const relume_status status = decode(&block, &f->layout, &f->pipelines[worker], item);
    f->damaged[item] = status == RELUME_EDAMAGED;
    if (status == RELUME_ENOMEM)
        atomic_store(&f->short_of_memory, true);
}

// Tiles each; of runs of rows those that follow each other as one.
static void report_runs(const struct finding *f, void (*found)(void *, const struct relume_rect *),
                        void *context)
{
    const struct layout *l = &f->layout;
    for (size_t i = 0; i < l->blocks; i++) {
        struct relume_rect at = rect_of(l, i);
        if (!f->damaged[i])
            continue;
        for (; !l->tile && i + 1 < l->blocks && f->damaged[i + 1]; i++)
            at.height += rect_of(l, i + 1).height;
        found(context, &at);
    }
}

relume_status exr_find_damage(const exr_file *file, int part, int threads,
                              void (*found)(void *, const struct relume_rect *), void *context,
                              const struct relume_log *log)
{
    threads = thread_count(threads);
    struct finding f = {0};
    if (!find_layout(&f.layout, file, part))
        return log_fail(log, RELUME_EDAMAGED, "%s: part %d is broken", file->path, part);
    f.pipelines = mem_zeroed((size_t)threads, sizeof *f.pipelines);
    f.damaged = mem_zeroed(f.layout.blocks, sizeof *f.damaged);
    if (f.pipelines && f.damaged) {
        thread_for(threads, f.layout.blocks, try_block, &f);
        report_runs(&f, found, context);
    }
    for (int i = 0; f.pipelines && i < threads; i++)
        end_unpacking(file, &f.pipelines[i]);
    const bool done = f.pipelines && f.damaged && !atomic_load(&f.short_of_memory);
    mem_free(f.pipelines);
    mem_free(f.damaged);
    return done ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- check sums

static void take_words(void *context, const struct relume_rect *at, const void *samples)
{
    const struct exr_sums *s = context;
    memcpy(s->word + (size_t)at->top * (size_t)s->width, samples,
           (size_t)at->height * (size_t)s->width * sizeof *s->word);
}

// The words that the file has; `*whole` where they are those that were written.
static relume_status read_words(struct exr_sums *out, bool *whole, const exr_file *file)
{
    const struct exr_part_info info = exr_part_info(file, file->parts);
    relume_status status = exr_sums_create(out, file->parts);
    struct layout layout = {.blocks = 0};
    bool fits = true;
    for (int i = 0; !status && i < file->parts; i++) {
        fits &= find_layout(&layout, file, i);
        exr_sums_count(out, layout.blocks);
    }
    fits &= !status && out->first[file->parts] < exr_bytes(file) / sizeof *out->word;
    if (!status && fits)
        status = exr_sums_finish(out);
    fits &= info.width == out->width && info.height == out->height;
    if (!status && fits)
        status = exr_read(file, file->parts, NULL, 1, take_words, out, NULL);
    *whole = !status && fits &&
             exr_sums_own(out) == out->word[(size_t)out->width * (size_t)out->height - 1];
    return status == RELUME_EDAMAGED ? RELUME_OK : status;
}

// All that comes before the first block.
static relume_status sum_head(uint32_t *out, exr_file *file)
{
    enum { PIECE = 1 << 16 };
    struct layout layout;
    exr_chunk_info_t first;
    char *piece = mem_array(PIECE, 1);
    *out = 0;
    if (!piece)
        return RELUME_ENOMEM;
    uint64_t left = 0;
    if (find_layout(&layout, file, 0) && !find_chunk(&first, &layout, 0))
        left = first.data_offset - 4 * lead_of(&first, 0, 0).count;
    for (uint64_t at = 0; left > 0;) {
        const ssize_t n = infile_read(&file->in, piece, left < PIECE ? left : PIECE, at);
        if (n <= 0)
            break;
        *out = exr_sum(*out, piece, (size_t)n);
        at += (uint64_t)n;
        left -= (uint64_t)n;
    }
    mem_free(piece);
    return RELUME_OK;
}

relume_status exr_use_sums(exr_file *file, enum exr_sums_found *found)
{
    struct exr_sums sums = {.word = NULL};
    uint32_t head = 0;
    bool whole = false;
    *found = EXR_SUMS_NONE;
    if (!exr_has_sums(file))
        return RELUME_OK;
    relume_status status = read_words(&sums, &whole, file);
    if (!status && whole)
        status = sum_head(&head, file);
    if (status || !whole) {
        exr_sums_destroy(&sums);
        *found = EXR_SUMS_DAMAGED;
        return status;
    }
    file->sums = sums;
    *found = head == sums.word[0] ? EXR_SUMS_WHOLE : EXR_SUMS_HEAD_CHANGED;
    return RELUME_OK;
}

struct exr_blocks {
    struct layout layout;
    struct unpacking pipeline;
    struct block block;  // the last one decoded
};

relume_status exr_blocks_open(exr_blocks **out, const exr_file *file, int part)
{
    exr_blocks *b = mem_zeroed(1, sizeof *b);
    *out = NULL;
    if (!b)
        return RELUME_ENOMEM;
    if (!find_layout(&b->layout, file, part) || b->layout.tile) {
        mem_free(b);
        return RELUME_EDAMAGED;
    }
    *out = b;
    return RELUME_OK;
}

static relume_status find_block(exr_blocks *b, int row)
{
    relume_status status = RELUME_OK;
    if (row < b->block.at.top || row >= b->block.at.top + b->block.at.height)
        status = decode(&b->block, &b->layout, &b->pipeline, (size_t)(row / b->layout.block_rows));
    if (status)
        b->block.at.height = 0;
    return status;
}

relume_status exr_blocks_row(exr_blocks *b, int row, const void **samples)
{
    const relume_status status = find_block(b, row);
    if (status)
        return status;
    const size_t bytes = (size_t)b->layout.channels * b->layout.row_bytes;
    *samples = (const uint8_t *)b->block.samples + (size_t)(row - b->block.at.top) * bytes;
    return RELUME_OK;
}

// Samples of a channel in row `y` of the data window.
static size_t samples_in(const exr_attr_chlist_entry_t *e, const struct exr_part_info *info, int y)
{
    const int first = info->x, last = first + info->width - 1, step = e->x_sampling;
    const int before = first - 1 - ((first - 1) % step + step) % step;
    return y % e->y_sampling ? 0 : (size_t)((last - before) / step);
}

relume_status exr_blocks_channel(exr_blocks *b, int row, int channel, float *out)
{
    const struct exr_part_info info = exr_part_info(b->layout.file, b->layout.part);
    const exr_attr_chlist_entry_t *entry = channel_list(b->layout.file, b->layout.part)->entries;
    const relume_status status = find_block(b, row);
    if (status)
        return status;
    const uint8_t *from = b->block.samples;
    for (int y = b->block.at.top; y <= row; y++)
        for (int c = 0; c < (y < row ? info.channels : channel); c++)
            from += samples_in(&entry[c], &info, info.y + y) *
                    exr_sample_bytes((enum exr_sample)entry[c].pixel_type);
    exr_to_floats(out, (enum exr_sample)entry[channel].pixel_type, from,
                  samples_in(&entry[channel], &info, info.y + row));
    return RELUME_OK;
}

void exr_blocks_close(exr_blocks **blocks)
{
    if (!*blocks)
        return;
    end_unpacking((*blocks)->layout.file, &(*blocks)->pipeline);
    mem_free(*blocks);
    *blocks = NULL;
}
