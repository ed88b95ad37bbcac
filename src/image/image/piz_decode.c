// piz_decode.c - OpenEXR's PIZ compression undone, several times as fast as its library
//
// The reverse of piz.c. A table looks up all symbols whose codes fit its bits at once. A channel's
// plane stays in the cache from its symbols to its samples. The wavelet's last level, three
// quarters of the work, runs in vector registers. Blocks that piz.c would not make are left to the
// library, which knows whether they are damaged.
#include "image/image/piz.h"

#include "core/base/memory.h"

#include <string.h>

enum { VALUES = 1 << 16, SYMBOLS = VALUES + 1, BITMAP = VALUES / 8, HEAD = 20 };
enum { INDEX = 12, AT_ONCE = 4, LOOKUPS = 4, MAX_LENGTH = 58, MAX_NUMBERS = 1 << 14 };

// The symbols that begin the bits of an index, stored together.
struct entry {
    uint16_t symbol[AT_ONCE];
};
// The number of symbols, 0 for a longer code or a run, and the bits they take. The next look-up
// waits for it, so it has a small table of its own, which stays in the fastest cache.
enum { COUNT_SHIFT = 4, LENGTH_MASK = (1 << COUNT_SHIFT) - 1 };

struct piz_decoder {
    uint8_t step[1 << INDEX];  // count << COUNT_SHIFT | length
    struct entry entry[1 << INDEX];
    uint16_t value[VALUES];           // of each number
    int values;                       // in use, before zeroes
    uint8_t length[SYMBOLS];          // of each symbol's code; 0: does not occur
    uint32_t sorted[SYMBOLS];         // symbols in the order of their lengths
    uint64_t first[MAX_LENGTH + 1];   // code of each length, at the top of 64 bits
    uint32_t before[MAX_LENGTH + 1];  // symbols of shorter codes
    int shortest;
    uint32_t of_runs;
    uint8_t code[2 * VALUES];  // of each number, converted; 0 of those that are not in use
    uint16_t *plane;           // [capacity]
    size_t capacity;
};

piz_decoder *piz_decoder_create(void)
{
    return mem_zeroed(1, sizeof(piz_decoder));
}

void piz_decoder_destroy(piz_decoder **d)
{
    if (*d)
        mem_free((*d)->plane);
    mem_free(*d);
    *d = NULL;
}

bool piz_decoder_reserve(piz_decoder *d, size_t samples, int words)
{
    const size_t size = 2 * samples * (size_t)words;
    if (d->capacity >= size)
        return true;
    mem_free(d->plane);
    d->plane = mem_array(size, sizeof *d->plane);
    d->capacity = d->plane ? size : 0;
    return d->plane != NULL;
}

// ---------------------------------------------------------------- bytes and bits

struct bytes {
    const uint8_t *at, *end;
};

static bool take_number(uint32_t *out, struct bytes *b, int bytes)
{
    *out = 0;
    if (b->end - b->at < bytes)
        return false;
    for (int i = 0; i < bytes; i++)
        *out |= (uint32_t)*b->at++ << 8 * i;
    return true;
}

// The next bits are the highest ones of `some`, `count` of which are there. Behind the end all are
// 0, and `count` goes on.
struct bits {
    struct bytes from;
    uint64_t some;
    int count;
};

// At least 56 bits where 8 bytes are left. Bits beyond `count` are right already.
static inline void refill(struct bits *b)
{
    uint64_t next;
    memcpy(&next, b->from.at, sizeof next);
    b->some |= __builtin_bswap64(next) >> b->count;
    b->from.at += (63 - b->count) >> 3;
    b->count |= 56;
}

static void refill_slowly(struct bits *b)
{
    if (b->from.end - b->from.at >= 8) {
        refill(b);
        return;
    }
    for (; b->count <= 56 && b->from.at < b->from.end; b->count += 8)
        b->some |= (uint64_t)*b->from.at++ << (56 - b->count);
}

static inline void drop(struct bits *b, int n)
{
    b->some <<= n;
    b->count -= n;
}

// False where they are not there.
static bool take_bits(uint32_t *out, struct bits *b, int n)
{
    refill_slowly(b);
    *out = (uint32_t)(b->some >> (64 - n));
    drop(b, n);
    return b->count >= 0;
}

// ---------------------------------------------------------------- values

// The values that the bitmap names, in their order. False where there are more than the wavelet of
// 14 bits can take.
static bool take_values(piz_decoder *d, struct bytes *b)
{
    uint32_t first, last;
    int values = 1;
    if (!take_number(&first, b, 2) || !take_number(&last, b, 2) || last >= BITMAP)
        return false;
    if (first <= last && (size_t)(b->end - b->at) < last - first + 1)
        return false;
    d->value[0] = 0;
    for (uint32_t i = first; i <= last; i++) {
        const uint8_t byte = *b->at++;
        for (uint32_t bit = 0; byte && bit < 8; bit++)
            if (byte >> bit & 1 && 8 * i + bit)
                d->value[values++] = (uint16_t)(8 * i + bit);
    }
    for (int i = values; i < d->values; i++)
        d->value[i] = 0;
    memset(d->code, 0, 2 * (size_t)d->values);
    d->values = values;
    return values <= MAX_NUMBERS;
}

// ---------------------------------------------------------------- the code

// Lengths of 6 bits each; 59 to 62 are two to five zeros, 63 with 8 bits more are six or more.
static bool take_lengths(piz_decoder *d, struct bytes *b, uint32_t first, uint32_t last)
{
    enum { SHORT = 59, LONG = 63, LEAST_LONG = 6 };
    struct bits bits = {.from = *b};
    memset(d->length, 0, sizeof d->length);
    for (uint32_t s = first; s <= last;) {
        uint32_t length, zeros;
        if (!take_bits(&length, &bits, 6))
            return false;
        if (length < SHORT) {
            d->length[s++] = (uint8_t)length;
            continue;
        }
        zeros = length - SHORT + 2;
        if (length == LONG) {
            if (!take_bits(&zeros, &bits, 8))
                return false;
            zeros += LEAST_LONG;
        }
        if (zeros > last + 1 - s)
            return false;
        s += zeros;
    }
    b->at = bits.from.at - bits.count / 8;
    return true;
}

// Longer codes have lower values, and those of one length ascend with their symbols. False unless
// every row of bits begins with just one code.
static bool number_codes(piz_decoder *d, uint32_t first, uint32_t last)
{
    uint32_t count[MAX_LENGTH + 1] = {0}, next[MAX_LENGTH + 1];
    uint64_t code = 0;
    for (uint32_t s = first; s <= last; s++)
        count[d->length[s]]++;
    for (int length = MAX_LENGTH; length > 0; length--) {
        d->shortest = count[length] ? length : d->shortest;
        d->first[length] = code << (64 - length);
        code += count[length];
        if (code & 1)
            return false;
        code >>= 1;
    }
    for (int length = 1, before = 0; length <= MAX_LENGTH; length++) {
        next[length] = d->before[length] = (uint32_t)before;
        before += (int)count[length];
    }
    for (uint32_t s = first; s <= last; s++)
        if (d->length[s])
            d->sorted[next[d->length[s]]++] = s;
    return code == 1;
}

// The symbol whose code the bits begin with.
static uint32_t find_symbol(const piz_decoder *d, uint64_t bits, int *length)
{
    int l = d->shortest;
    while (bits < d->first[l])
        l++;
    *length = l;
    return d->sorted[d->before[l] + (uint32_t)((bits - d->first[l]) >> (64 - l))];
}

static void fill_single(piz_decoder *d)
{
    for (int i = 0; i < 1 << INDEX; i++) {
        const uint64_t bits = (uint64_t)i << (64 - INDEX);
        int length;
        d->step[i] = 0;
        if (bits < d->first[INDEX])
            continue;
        const uint32_t symbol = find_symbol(d, bits, &length);
        if (length > INDEX || symbol == d->of_runs)
            continue;
        d->entry[i].symbol[0] = (uint16_t)symbol;
        d->step[i] = (uint8_t)(1 << COUNT_SHIFT | length);
    }
}

static void fill_entries(piz_decoder *d)
{
    uint8_t single[1 << INDEX];
    fill_single(d);
    memcpy(single, d->step, sizeof single);
    for (int i = 0; i < 1 << INDEX; i++) {
        int count = single[i] >> COUNT_SHIFT, length = single[i] & LENGTH_MASK;
        while (count && count < AT_ONCE) {
            const int next = i << length & ((1 << INDEX) - 1), more = single[next] & LENGTH_MASK;
            if (!more || length + more > INDEX)
                break;
            d->entry[i].symbol[count++] = d->entry[next].symbol[0];
            length += more;
        }
        d->step[i] = (uint8_t)(count << COUNT_SHIFT | length);
    }
}

// ---------------------------------------------------------------- symbols

struct stream {
    struct bits bits;
    uint32_t run;  // how often `last` still follows
    uint16_t last;
    bool begun;
};

static uint16_t *put_run(struct stream *s, uint16_t *to, const uint16_t *end)
{
    for (; s->run && to < end; s->run--)
        *to++ = s->last;
    return to;
}

// Takes one symbol, or a run of the one before. NULL when the bits have ended.
static uint16_t *take_symbol(const piz_decoder *d, struct stream *s, uint16_t *to,
                             const uint16_t *end)
{
    int length;
    refill_slowly(&s->bits);
    const uint32_t symbol = find_symbol(d, s->bits.some, &length);
    drop(&s->bits, length);
    if (s->bits.count < 0)
        return NULL;
    if (symbol != d->of_runs) {
        s->begun = true;
        s->last = *to = (uint16_t)symbol;
        return to + 1;
    }
    return s->begun && take_bits(&s->run, &s->bits, 8) ? put_run(s, to, end) : NULL;
}

// Entries that hold no symbol take no bits either: only the last one of several is looked at.
static bool take_symbols(const piz_decoder *d, struct stream *s, uint16_t *to, size_t n)
{
    enum { ROOM = LOOKUPS * AT_ONCE + 1 };
    const uint16_t *const end = to + n;
    to = put_run(s, to, end);
    while (to < end) {
        const uint16_t *const begin = to;
        struct bits b = s->bits;
        for (int step = 1; step && end - to >= ROOM && b.from.end - b.from.at >= 8;) {
            refill(&b);
            for (int k = 0; k < LOOKUPS; k++) {
                const size_t index = b.some >> (64 - INDEX);
                step = d->step[index];
                memcpy(to, &d->entry[index], sizeof *d->entry);
                to += step >> COUNT_SHIFT;
                drop(&b, step & LENGTH_MASK);
            }
        }
        s->bits = b;
        if (to > begin) {
            s->begun = true;
            s->last = to[-1];
        }
        if (!(to = take_symbol(d, s, to, end)))
            return false;
    }
    return true;
}

// ---------------------------------------------------------------- wavelets

struct two {
    int16_t a, b;
};

static inline struct two two_of(int16_t mean, int16_t difference)
{
    const int16_t a = (int16_t)(mean + (difference & 1) + (difference >> 1));
    return (struct two){a, (int16_t)(a - difference)};
}

// `n` squares of four samples, `step` apart in both directions, 2 `step` from square to square.
static inline void restore_squares(int16_t *restrict top, int16_t *restrict low, size_t n,
                                   size_t step)
{
    for (size_t i = 0; i < n; i++) {
        const size_t x = 2 * step * i;
        const struct two mean = two_of(top[x], low[x]);
        const struct two difference = two_of(top[x + step], low[x + step]);
        const struct two t = two_of(mean.a, difference.a), l = two_of(mean.b, difference.b);
        top[x] = t.a;
        top[x + step] = t.b;
        low[x] = l.a;
        low[x + step] = l.b;
    }
}

static void restore_two(int16_t *a, int16_t *b)
{
    const struct two t = two_of(*a, *b);
    *a = t.a;
    *b = t.b;
}

static void restore_level(int16_t *plane, size_t width, size_t rows, size_t step)
{
    const size_t squares = width / (2 * step), end = 2 * step * squares;
    size_t y = 0;
    for (; y + 2 * step <= rows; y += 2 * step) {
        int16_t *top = plane + y * width, *low = top + step * width;
        if (step == 1)
            restore_squares(top, low, squares, 1);
        else
            restore_squares(top, low, squares, step);
        if (width & step)
            restore_two(top + end, low + end);
    }
    for (size_t x = 0; rows & step && x < end; x += 2 * step)
        restore_two(plane + y * width + x, plane + y * width + x + step);
}

static void restore(uint16_t *plane, size_t width, size_t rows)
{
    const size_t least = width < rows ? width : rows;
    size_t step = 1;
    while (4 * step <= least)
        step *= 2;
    for (; 2 * step <= least && step; step /= 2)
        restore_level((int16_t *)plane, width, rows, step);
}

// ---------------------------------------------------------------- the whole

static bool take_code(piz_decoder *d, struct bytes *b, uint32_t *bits)
{
    uint32_t size, first, last, ignored;
    if (!take_number(&size, b, 4) || (size_t)(b->end - b->at) < size)
        return false;
    b->end = b->at + size;
    if (!take_number(&first, b, 4) || !take_number(&last, b, 4) || !take_number(&ignored, b, 4) ||
        !take_number(bits, b, 4) || !take_number(&ignored, b, 4) || first > last || last >= SYMBOLS)
        return false;
    d->of_runs = last;
    if (!take_lengths(d, b, first, last) || !number_codes(d, first, last))
        return false;
    fill_entries(d);
    return *bits <= 8 * (uint64_t)(b->end - b->at);
}

// Words of samples of two lie one beside the other, and become planes of their own.
static void split(uint16_t *to, const uint16_t *from, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++) {
        to[i] = from[2 * i];
        to[pixels + i] = from[2 * i + 1];
    }
}

static bool is_zero(const uint16_t *word, size_t n)
{
    unsigned all = 0;
    for (size_t i = 0; i < n; i++)
        all |= word[i];
    return !all;
}

// Each of the values as a sample, converted, into d->code.
static bool convert_values(piz_decoder *d, int words, const struct piz_conversion *to)
{
    enum { SOME = 512 };
    uint32_t wide[SOME];
    for (int at = 0; at < d->values; at += SOME) {
        const int n = d->values - at < SOME ? d->values - at : SOME;
        for (int i = 0; i < n; i++)
            wide[i] = d->value[at + i];
        const void *samples = words == 1 ? (const void *)(d->value + at) : wide;
        if (!to->convert(to->context, d->code + (size_t)at * to->bytes, samples, (size_t)n))
            return false;
    }
    return true;
}

// The layout of a block's samples.
struct placing {
    void *out;
    size_t line, rows, channels, words;
    const struct piz_conversion *to;
};

static void put_row(void *out, const piz_decoder *d, const uint16_t *plane, size_t n, size_t step)
{
    uint16_t *to = out;
    for (size_t x = 0; x < n; x++)
        to[x * step] = d->value[plane[x]];
}

static void put_bytes(uint8_t *to, const piz_decoder *d, const uint16_t *plane, size_t n)
{
    for (size_t x = 0; x < n; x++)
        to[x] = d->code[plane[x]];
}

static void put_words(uint16_t *to, const piz_decoder *d, const uint16_t *plane, size_t n)
{
    const uint16_t *code = (const uint16_t *)(const void *)d->code;
    for (size_t x = 0; x < n; x++)
        to[x] = code[plane[x]];
}

// A channel's planes of words.
static bool put_channel(const piz_decoder *d, const struct placing *p, const uint16_t *planes,
                        size_t channel)
{
    const size_t pixels = p->line * p->rows;
    if (p->to && p->words == 2 && !is_zero(planes + pixels, pixels))
        return false;
    for (size_t y = 0; y < p->rows; y++) {
        const size_t at = (y * p->channels + channel) * p->line;
        const uint16_t *from = planes + y * p->line;
        for (size_t w = 0; !p->to && w < p->words; w++)
            put_row((uint16_t *)p->out + at * p->words + w, d, from + w * pixels, p->line,
                    p->words);
        if (p->to && p->to->bytes == 1)
            put_bytes((uint8_t *)p->out + at, d, from, p->line);
        else if (p->to)
            put_words((uint16_t *)p->out + at, d, from, p->line);
    }
    return true;
}

bool piz_decompress(piz_decoder *d, void *out, const uint8_t *packed, size_t size, int width,
                    int rows, int channels, int words, const struct piz_conversion *to)
{
    const struct placing p = {out, (size_t)width, (size_t)rows, (size_t)channels, (size_t)words,
                              to};
    const size_t pixels = p.line * p.rows, n = pixels * p.words;
    struct bytes b = {packed, packed + size};
    uint32_t bits;
    if (d->capacity < 2 * n || !take_values(d, &b) || !take_code(d, &b, &bits))
        return false;
    if (to && !convert_values(d, words, to))
        return false;
    struct stream s = {.bits.from = b};
    for (size_t c = 0; c < p.channels; c++) {
        uint16_t *const planes = d->plane + (words == 2 ? n : 0);
        if (!take_symbols(d, &s, d->plane, n))
            return false;
        if (words == 2)
            split(planes, d->plane, pixels);
        for (size_t w = 0; w < p.words; w++)
            restore(planes + w * pixels, p.line, p.rows);
        if (!put_channel(d, &p, planes, c))
            return false;
    }
    return !s.run && 8 * (uint64_t)(s.bits.from.at - b.at) - (uint64_t)s.bits.count == bits;
}
