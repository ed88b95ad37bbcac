// piz.c - OpenEXR's PIZ compression, byte for byte, several times as fast as its library
//
// The values that occur are numbered in their order; the planes of numbers become Haar wavelets in
// place (each pair its mean and difference, along rows and columns, then the means of pairs, and so
// on); these become a canonical Huffman code with a symbol for runs, the largest + 1 (F. Kainz,
// R. Bogart, 'Technical introduction to OpenEXR'; the library's internal_piz.c and internal_huf.c
// are the reference, tests/unit/test_piz.c compares). Here the wavelet's first level runs in vector
// registers, lengths of codes come from a tree, and symbols go out without a branch but for runs.
#include "image/image/piz.h"

#include "core/base/memory.h"

#include <stdbool.h>
#include <string.h>

enum { VALUES = 1 << 16, SYMBOLS = VALUES + 1, MOST_NUMBERS = 1 << 14, TABLES = 2 };
enum { BITMAP = VALUES / 8, HEAD = 20 };  // bytes

struct piz {
    uint8_t seen[VALUES];
    uint16_t number[VALUES];
    uint32_t count[TABLES][SYMBOLS];
    uint64_t code[SYMBOLS];  // << 6 | length; 0: does not occur
    uint64_t heap[SYMBOLS];  // count << 17 | symbol
    uint32_t node[SYMBOLS];  // of the tree: where the symbol's part of it begins
    uint32_t parent[2 * SYMBOLS];
    uint32_t symbol[SYMBOLS];  // those that occur, ascending
};

piz *piz_create(void)
{
    return mem_zeroed(1, sizeof(piz));
}

void piz_destroy(piz **p)
{
    mem_free(*p);
    *p = NULL;
}

// An optimal code of n symbols takes no more than log2 n + 1 bits for each on average.
size_t piz_bound(size_t bytes)
{
    return bytes + bytes / 16 + 8 + 2 * sizeof(uint32_t) + BITMAP + HEAD + SYMBOLS;
}

// ---------------------------------------------------------------- bits

struct bits {
    uint8_t *out;
    uint64_t some;  // the lowest `count` are not out yet
    int count;      // at most 7 between calls
};

enum { MOST_BITS = 57 };  // at once

static inline void put(struct bits *b, uint64_t bits, int n)
{
    b->some = b->some << n | bits;
    b->count += n;
    const uint64_t turned = __builtin_bswap64(b->some << (-b->count & 63));
    memcpy(b->out, &turned,
           sizeof turned);  // what is behind them is written again, or not looked at
    b->out += b->count / 8;
    b->count %= 8;
}

static uint8_t *put_number(uint8_t *out, uint32_t v, int bytes)
{
    for (int i = 0; i < bytes; i++)
        *out++ = (uint8_t)(v >> 8 * i);
    return out;
}

// ---------------------------------------------------------------- values

// How many numbers there are; 0 is always one.
static int number_values(piz *p, const uint16_t *words, size_t n)
{
    int numbers = 0;
    memset(p->seen, 0, sizeof p->seen);
    for (size_t i = 0; i < n; i++)
        p->seen[words[i]] = 1;
    p->seen[0] = 1;
    for (int v = 0; v < VALUES; v++)
        if (p->seen[v])
            p->number[v] = (uint16_t)numbers++;
    return numbers;
}

// The bytes of the bitmap from the first to the last that are not 0; 0 itself is left out.
static uint8_t *put_bitmap(const piz *p, uint8_t *out)
{
    uint8_t bitmap[BITMAP] = {0};
    int first = BITMAP - 1, last = 0;
    for (int v = 1; v < VALUES; v++)
        bitmap[v / 8] |= (uint8_t)(p->seen[v] << v % 8);
    for (int i = 0; i < BITMAP; i++)
        if (bitmap[i]) {
            first = first < i ? first : i;
            last = i;
        }
    out = put_number(out, (uint32_t)first, 2);
    out = put_number(out, (uint32_t)last, 2);
    for (int i = first; i <= last; i++)
        *out++ = bitmap[i];
    return out;
}

static void number_plane(const piz *p, uint16_t *to, const uint16_t *words, size_t width,
                         size_t rows, size_t stride)
{
    for (size_t y = 0; y < rows; y++, to += width, words += stride)
        for (size_t x = 0; x < width; x++)
            to[x] = p->number[words[x]];
}

// ---------------------------------------------------------------- wavelets

// Of numbers below 2^14 neither leaves 16 bits, nor does either of means, nor of differences.
struct pair {
    int16_t mean, difference;
};

static inline struct pair pair_of(int16_t a, int16_t b)
{
    return (struct pair){(int16_t)((int16_t)(a + b) >> 1), (int16_t)(a - b)};
}

// `n` squares of four samples, `step` apart in both directions, 2 `step` from square to square.
static inline void transform_squares(int16_t *restrict top, int16_t *restrict low, size_t n,
                                     size_t step)
{
    for (size_t i = 0; i < n; i++) {
        const size_t x = 2 * step * i;
        const struct pair t = pair_of(top[x], top[x + step]), l = pair_of(low[x], low[x + step]);
        const struct pair mean = pair_of(t.mean, l.mean);
        const struct pair difference = pair_of(t.difference, l.difference);
        top[x] = mean.mean;
        low[x] = mean.difference;
        top[x + step] = difference.mean;
        low[x + step] = difference.difference;
    }
}

static void transform_pair(int16_t *a, int16_t *b)
{
    const struct pair p = pair_of(*a, *b);
    *a = p.mean;
    *b = p.difference;
}

static void transform_level(int16_t *plane, size_t width, size_t rows, size_t step)
{
    const size_t squares = width / (2 * step), end = 2 * step * squares;
    size_t y = 0;
    for (; y + 2 * step <= rows; y += 2 * step) {
        int16_t *top = plane + y * width, *low = top + step * width;
        if (step == 1)
            transform_squares(top, low, squares, 1);
        else
            transform_squares(top, low, squares, step);
        if (width & step)
            transform_pair(top + end, low + end);
    }
    for (size_t x = 0; rows & step && x < end; x += 2 * step)
        transform_pair(plane + y * width + x, plane + y * width + x + step);
}

static void transform(uint16_t *plane, size_t width, size_t rows)
{
    const size_t least = width < rows ? width : rows;
    for (size_t step = 1; 2 * step <= least; step *= 2)
        transform_level((int16_t *)plane, width, rows, step);
}

// ---------------------------------------------------------------- the code

// Neighbours that are equal would wait for each other in one table.
static void count_symbols(piz *p, const uint16_t *words, size_t n)
{
    size_t i = 0;
    for (; i + TABLES <= n; i += TABLES)
        for (int t = 0; t < TABLES; t++)
            p->count[t][words[i + (size_t)t]]++;
    for (; i < n; i++)
        p->count[0][words[i]]++;
}

static void sink(uint64_t *heap, size_t n, size_t at)
{
    const uint64_t v = heap[at];
    for (size_t child; (child = 2 * at + 1) < n; at = child) {
        child += child + 1 < n && heap[child + 1] < heap[child];
        if (v <= heap[child])
            break;
        heap[at] = heap[child];
    }
    heap[at] = v;
}

// The two rarest symbols become one, which keeps the name of the second, until one is left. The
// length of a symbol's code is how deep it then lies in the tree.
static void find_lengths(piz *p, size_t n)
{
    enum { NAME = 17 };
    const uint64_t name = (1u << NAME) - 1;
    uint32_t next = (uint32_t)n;
    for (size_t i = 0; i < n; i++) {
        p->heap[i] = (uint64_t)p->count[0][p->symbol[i]] << NAME | p->symbol[i];
        p->node[p->symbol[i]] = (uint32_t)i;
    }
    for (size_t i = n / 2; i-- > 0;)
        sink(p->heap, n, i);
    for (size_t left = n; left > 1; next++) {
        const uint64_t rarest = p->heap[0];
        p->heap[0] = p->heap[--left];
        sink(p->heap, left, 0);
        p->parent[p->node[rarest & name]] = p->parent[p->node[p->heap[0] & name]] = next;
        p->node[p->heap[0] & name] = next;
        p->heap[0] += rarest & ~name;
        sink(p->heap, left, 0);
    }
    uint32_t *depth = p->parent;  // of what is above is known already
    depth[next - 1] = 0;
    for (size_t i = next - 1; i-- > 0;)
        depth[i] = depth[depth[i]] + 1;
    for (size_t i = 0; i < n; i++)
        p->code[p->symbol[i]] = depth[i];
}

// Longer codes have lower values, and those of one length ascend with their symbols.
static void number_codes(piz *p, size_t n)
{
    uint64_t next[64] = {0}, first = 0;
    for (size_t i = 0; i < n; i++)
        next[p->code[p->symbol[i]]]++;
    for (int length = 63; length > 0; length--) {
        const uint64_t after = (first + next[length]) >> 1;
        next[length] = first;
        first = after;
    }
    for (size_t i = 0; i < n; i++) {
        uint64_t *code = &p->code[p->symbol[i]];
        *code |= next[*code]++ << 6;
    }
}

// Returns how many symbols there are; the last is that of runs, which counts as one.
static size_t make_code(piz *p)
{
    size_t n = 0;
    for (uint32_t s = 0; s < VALUES; s++) {
        for (int t = 1; t < TABLES; t++)
            p->count[0][s] += p->count[t][s];
        if (p->count[0][s])
            p->symbol[n++] = s;
    }
    p->symbol[n] = p->symbol[n - 1] + 1;
    p->count[0][p->symbol[n]] = 1;
    n++;
    memset(p->code, 0, sizeof p->code);
    find_lengths(p, n);
    number_codes(p, n);
    return n;
}

static int length_of(uint64_t code)
{
    return (int)(code & 63);
}

// Lengths of 6 bits each; 59 to 62 are two to five zeros, 63 with 8 bits more are six or more.
static uint8_t *put_lengths(const piz *p, uint8_t *out, uint32_t first, uint32_t last)
{
    enum { SHORT = 59, LONG = 63, LEAST_LONG = 6, MOST_LONG = 255 + LEAST_LONG };
    struct bits b = {.out = out};
    for (uint32_t s = first; s <= last;) {
        uint32_t zeros = 0;
        while (zeros < MOST_LONG && s + zeros <= last && !p->code[s + zeros])
            zeros++;
        s += zeros ? zeros : 1;
        if (zeros < 2)
            put(&b, (uint64_t)length_of(p->code[s - 1]), 6);
        else if (zeros < LEAST_LONG)
            put(&b, SHORT + zeros - 2, 6);
        else
            put(&b, (uint64_t)LONG << 8 | (zeros - LEAST_LONG), 14);
    }
    return b.out + (b.count > 0);
}

static void put_code(struct bits *b, uint64_t code)
{
    put(b, code >> 6, length_of(code));
}

// A symbol and how often it follows itself: as a run where that is shorter. The code of runs is as
// long as any that occurs twice, so less than three followers are no run: four symbols that do not
// begin four equal ones go out alone.
static void put_run(struct bits *b, uint64_t code, uint64_t run, int followers)
{
    if (length_of(code) + length_of(run) + 8 < length_of(code) * followers) {
        put_code(b, code);
        put_code(b, run);
        put(b, (uint64_t)followers, 8);
        return;
    }
    for (int i = 0; i <= followers; i++)
        put_code(b, code);
}

enum { FOUR = 4 };

static uint64_t four_words(const uint16_t *words)
{
    uint64_t four;
    memcpy(&four, words, sizeof four);
    return four;
}

// Whether four words are equal from any of the first four on.
static bool holds_run(const uint16_t *words)
{
    const uint64_t w = four_words(words), ones = 0x0001000100010001u;
    const uint64_t differ =
        (w ^ four_words(words + 1)) | (w ^ four_words(words + 2)) | (w ^ four_words(words + 3));
    return (differ - ones) & ~differ & ones << 15;
}

// False, having put nothing, where they are too many bits at once.
static bool put_four(struct bits *b, const uint64_t *code, const uint16_t *words)
{
    const uint64_t c[FOUR] = {code[words[0]], code[words[1]], code[words[2]], code[words[3]]};
    const int last = length_of(c[3]), end = length_of(c[2]) + last;
    const int n = length_of(c[0]) + length_of(c[1]) + end;
    if (n > MOST_BITS)
        return false;
    const uint64_t begin = c[0] >> 6 << length_of(c[1]) | c[1] >> 6;
    put(b, begin << end | c[2] >> 6 << last | c[3] >> 6, n);
    return true;
}

// How often the first word follows itself at once.
static int followers_of(const uint16_t *words, size_t n)
{
    enum { MOST = 255 };
    size_t k = 1;
    while (k <= MOST && k < n && words[k] == words[0])
        k++;
    return (int)k - 1;
}

static uint64_t put_symbols(const piz *p, uint8_t *out, const uint16_t *words, size_t n,
                            uint32_t of_runs)
{
    struct bits b = {.out = out};
    for (size_t i = 0; i < n;) {
        if (i + 2 * FOUR <= n && !holds_run(words + i) && put_four(&b, p->code, words + i)) {
            i += FOUR;
            continue;
        }
        const int followers = followers_of(words + i, n - i);
        put_run(&b, p->code[words[i]], p->code[of_runs], followers);
        i += (size_t)followers + 1;
    }
    return 8 * (uint64_t)(b.out - out) + (uint64_t)b.count;
}

// ---------------------------------------------------------------- the whole

size_t piz_compress(piz *p, uint8_t *out, uint16_t *work, const uint16_t *words, int width,
                    int rows, int channels)
{
    const size_t line = (size_t)width, plane = line * (size_t)rows, n = plane * (size_t)channels;
    uint8_t *const start = out;
    if (number_values(p, words, n) > MOST_NUMBERS)
        return 0;
    memset(p->count, 0, sizeof p->count);
    for (size_t c = 0; c < (size_t)channels; c++) {  // a plane stays in the cache
        uint16_t *to = work + c * plane;
        number_plane(p, to, words + c * line, line, (size_t)rows, line * (size_t)channels);
        transform(to, line, (size_t)rows);
        count_symbols(p, to, plane);
    }
    const size_t symbols = make_code(p);
    const uint32_t first = p->symbol[0], last = p->symbol[symbols - 1];
    uint8_t *const size = put_bitmap(p, out), *const head = size + 4, *const table = head + HEAD;
    uint8_t *const data = put_lengths(p, table, first, last);
    const uint64_t bits = put_symbols(p, data, work, n, last);
    out = put_number(head, first, 4);
    out = put_number(out, last, 4);
    out = put_number(out, (uint32_t)(data - table), 4);
    out = put_number(out, (uint32_t)bits, 4);
    put_number(out, 0, 4);
    out = data + (bits + 7) / 8;
    put_number(size, (uint32_t)(out - head), 4);
    return (size_t)(out - start);
}
