// png_rows.c - the rows of a PNG file, filtered and deflated on several threads
//
// Each row has the filter of the least sum of sizes, as the PNG specification proposes and libpng
// does. Strips of rows are deflated each by itself, with the rows above as dictionary, and follow
// one another as one stream (M. Adler, pigz).
#include "image/image/png_rows.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <string.h>
#include <zlib.h>

enum { FILTERS = 5, STRIP = 1 << 18, WINDOW = 1 << 15, WINDOW_BITS = 15, MEMORY_LEVEL = 8 };
enum { HEAD = 2, FOOT = 4 };  // of the stream

struct strips {
    const struct picture_array *array;
    size_t row, pixel;                // bytes
    int effort, rows, before, count;  // rows of a strip, and of its dictionary
    struct png_piece *piece;
    uLong *sum;  // Adler-32 of each strip
    bool *failed;
};

// ---------------------------------------------------------------- filters

static size_t size_of(const uint8_t *filtered, size_t n)
{
    size_t sum = 0;
    while (n) {
        const size_t some = n < 4096 ? n : 4096;
        unsigned part = 0;
        for (size_t i = 0; i < some; i++)
            part += filtered[i] < 128 ? filtered[i] : 256u - filtered[i];
        sum += part;
        filtered += some;
        n -= some;
    }
    return sum;
}

static int distance(int a, int b)
{
    return a < b ? b - a : a - b;
}

// The one of three neighbours that is nearest to left + up - corner.
static int paeth(int left, int up, int corner)
{
    const int to_left = distance(up, corner), to_up = distance(left, corner);
    const int to_corner = distance(left + up, 2 * corner);
    const int other = to_up <= to_corner ? up : corner;
    return to_left <= to_up && to_left <= to_corner ? left : other;
}

// `left` and `corner` begin a pixel before `at` and `up`, where 0 stands.
static void filter_row(uint8_t *const out[FILTERS], const uint8_t *at, const uint8_t *up,
                       size_t pixel, size_t n)
{
    const uint8_t *left = at - pixel, *corner = up - pixel;
    memcpy(out[0], at, n);
    for (size_t i = 0; i < n; i++)
        out[1][i] = (uint8_t)(at[i] - left[i]);
    for (size_t i = 0; i < n; i++)
        out[2][i] = (uint8_t)(at[i] - up[i]);
    for (size_t i = 0; i < n; i++)
        out[3][i] = (uint8_t)(at[i] - (left[i] + up[i]) / 2);
    for (size_t i = 0; i < n; i++)
        out[4][i] = (uint8_t)(at[i] - paeth(left[i], up[i], corner[i]));
}

// The first of them that is smallest, behind its number.
static void put_smallest(uint8_t *to, uint8_t *const out[FILTERS], size_t n)
{
    size_t least = SIZE_MAX;
    int best = 0;
    for (int f = 0; f < FILTERS; f++) {
        const size_t size = size_of(out[f], n);
        best = size < least ? f : best;
        least = size < least ? size : least;
    }
    *to = (uint8_t)best;
    memcpy(to + 1, out[best], n);
}

// A row as PNG has it, the higher byte first.
static void take_row(uint8_t *to, const struct strips *s, int y)
{
    const uint8_t *from = (const uint8_t *)s->array->data + (size_t)y * s->row;
    if (s->array->bytes == 1)
        memcpy(to, from, s->row);
    for (size_t i = 0; s->array->bytes == 2 && i < s->row; i += 2) {
        uint16_t word;
        memcpy(&word, from + i, sizeof word);
        to[i] = (uint8_t)(word >> 8);
        to[i + 1] = (uint8_t)word;
    }
}

// Rows `first` .. `end` to out[end - first][1 + row]; `work` holds FILTERS + 2 rows and
// pixels.
static void filter_rows(uint8_t *out, uint8_t *work, const struct strips *s, int first, int end)
{
    const size_t whole = s->pixel + s->row;
    uint8_t *up = work, *at = work + whole, *filtered[FILTERS];
    memset(work, 0, 2 * whole);
    for (size_t f = 0; f < FILTERS; f++)
        filtered[f] = work + 2 * whole + f * s->row;
    if (first)
        take_row(up + s->pixel, s, first - 1);
    for (int y = first; y < end; y++, out += 1 + s->row) {
        take_row(at + s->pixel, s, y);
        filter_row(filtered, at + s->pixel, up + s->pixel, s->pixel, s->row);
        put_smallest(out, filtered, s->row);
        uint8_t *const last = up;
        up = at;
        at = last;
    }
}

// ---------------------------------------------------------------- strips

// Deflates data[size] behind `before` bytes of it that are known already.
static bool deflate_strip(struct png_piece *piece, const uint8_t *data, size_t before, size_t size,
                          int effort, bool last)
{
    z_stream z = {.next_in = (Bytef *)(uintptr_t)(data + before), .avail_in = (uInt)size};
    const size_t known = before < WINDOW ? before : WINDOW;
    if (deflateInit2(&z, effort, Z_DEFLATED, -WINDOW_BITS, MEMORY_LEVEL, Z_FILTERED))
        return false;
    const size_t room = deflateBound(&z, (uLong)size) + 16;
    piece->data = mem_array(HEAD + room + FOOT, 1);
    z.next_out = piece->data + HEAD;
    z.avail_out = (uInt)room;
    bool good =
        piece->data && (!known || !deflateSetDictionary(&z, data + before - known, (uInt)known));
    if (good)
        good = deflate(&z, last ? Z_FINISH : Z_SYNC_FLUSH) == (last ? Z_STREAM_END : Z_OK) &&
               !z.avail_in && z.avail_out;
    piece->size = good ? (size_t)(z.next_out - piece->data) : 0;
    deflateEnd(&z);
    return good;
}

static void make_strip(void *context, size_t item, int worker)
{
    const struct strips *s = context;
    (void)worker;
    const int row = (int)item * s->rows, first = row > s->before ? row - s->before : 0;
    const int end = s->array->height - row < s->rows ? s->array->height : row + s->rows;
    const size_t line = 1 + s->row, before = (size_t)(row - first) * line,
                 size = (size_t)(end - row) * line;
    uint8_t *data = mem_array(before + size, 1);
    uint8_t *work = mem_array(FILTERS + 2, s->pixel + s->row);
    s->failed[item] = !data || !work;
    if (data && work) {
        filter_rows(data, work, s, first, end);
        s->sum[item] = adler32(1, data + before, (uInt)size);
        s->failed[item] =
            !deflate_strip(&s->piece[item], data, before, size, s->effort, end == s->array->height);
    }
    mem_free(work);
    mem_free(data);
}

// The first piece has the head of the stream, a window of 32 kB and how much effort was made; the
// last its check sum.
static void frame_stream(const struct strips *s)
{
    struct png_piece *first = &s->piece[0], *last = &s->piece[s->count - 1];
    const int level = s->effort < 2 ? 0 : s->effort < 6 ? 1 : s->effort == 6 ? 2 : 3;
    const int head = 0x78 << 8 | level << 6;
    uLong sum = s->sum[0];
    for (int i = 1; i < s->count; i++) {
        const int rows = i < s->count - 1 ? s->rows : s->array->height - i * s->rows;
        sum = adler32_combine(sum, s->sum[i], (z_off_t)((size_t)rows * (1 + s->row)));
        memmove(s->piece[i].data, s->piece[i].data + HEAD, s->piece[i].size - HEAD);
        s->piece[i].size -= HEAD;
    }
    first->data[0] = (uint8_t)(head >> 8);
    first->data[1] = (uint8_t)(head + (31 - head % 31));
    for (int i = FOOT; i-- > 0;)
        last->data[last->size++] = (uint8_t)(sum >> 8 * i);
}

void png_rows_destroy(struct png_piece **pieces, size_t count)
{
    for (size_t i = 0; *pieces && i < count; i++)
        mem_free((*pieces)[i].data);
    mem_free(*pieces);
    *pieces = NULL;
}

relume_status png_rows_deflate(struct png_piece **out, size_t *count,
                               const struct picture_array *array, int effort, int threads)
{
    struct strips s = {.array = array, .effort = effort};
    s.pixel = (size_t)array->channels * array->bytes;
    s.row = (size_t)array->width * s.pixel;
    s.rows = s.row < STRIP ? (int)(STRIP / (1 + s.row)) : 1;
    s.rows = s.rows < 1 ? 1 : s.rows;
    s.before = (int)((WINDOW + s.row) / (1 + s.row));
    s.count = (array->height + s.rows - 1) / s.rows;
    *count = (size_t)s.count;
    *out = s.piece = mem_zeroed(*count, sizeof *s.piece);
    s.sum = mem_array(*count, sizeof *s.sum);
    s.failed = mem_zeroed(*count, sizeof *s.failed);
    bool good = s.piece && s.sum && s.failed;
    if (good)
        thread_for(threads, *count, make_strip, &s);
    for (size_t i = 0; good && i < *count; i++)
        good = !s.failed[i];
    if (good)
        frame_stream(&s);
    else
        png_rows_destroy(out, *count);
    mem_free(s.sum);
    mem_free(s.failed);
    return good ? RELUME_OK : RELUME_ENOMEM;
}
