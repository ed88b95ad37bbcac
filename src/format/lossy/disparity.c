// disparity.c - whole steps foretold by their neighbours; what they differ by goes to a range coder
#include "format/lossy/disparity.h"

#include "core/base/memory.h"
#include "format/lossy/entropy.h"
#include "format/lossy/slopes.h"

#include <math.h>
#include <zlib.h>

// Words at the head, before the coded bytes: their number and CRC-32.
enum { WORD_MAGIC, WORD_BYTES, WORD_CRC, HEAD_WORDS };
enum { MAGIC = 0x33444C52, MOST_STEPS = 65535 };  // "RLD3"

// ---------------------------------------------------------------- what is foretold

// Left, above, above to the left and to the right; what the picture lacks is as its neighbour.
struct around {
    int a, b, c, d;
};

static struct around around(const uint16_t *row, const uint16_t *above, size_t x, size_t width)
{
    struct around n;
    n.a = x ? row[x - 1] : above ? above[x] : 0;
    n.b = above ? above[x] : n.a;
    n.c = above && x ? above[x - 1] : n.b;
    n.d = above && x + 1 < width ? above[x + 1] : n.b;
    return n;
}

// The least or the most of left and above across an edge, else the plane through all three
// (Weinberger et al. 2000, LOCO-I, whose contexts these are, too).
static int foretold(struct around n)
{
    const int least = n.a < n.b ? n.a : n.b, most = n.a < n.b ? n.b : n.a;
    return n.c >= most ? least : n.c <= least ? most : n.a + n.b - n.c;
}

enum { CLASSES = 7, CONTEXTS = CLASSES * CLASSES * CLASSES, EVEN = CONTEXTS / 2 };

// -3 .. 3 by how steep it is.
static int slope(int difference)
{
    const int much = difference < 0 ? -difference : difference;
    const int class = much > 2 ? 3 : much;
    return difference < 0 ? -class : class;
}

// What the three slopes are; a mirrored one is the same with the other sign.
static int context_of(struct around n, bool *mirrored)
{
    const int sum =
        (slope(n.a - n.c) * CLASSES + slope(n.c - n.b)) * CLASSES + slope(n.b - n.d) + EVEN;
    *mirrored = sum > EVEN;
    return *mirrored ? 2 * EVEN - sum : sum;
}

// ---------------------------------------------------------------- differences

struct model {
    struct entropy_chance any[CONTEXTS], sign[CONTEXTS], more[2][ENTROPY_BITS + 1];
};

static void begin_model(struct model *m)
{
    for (int i = 0; i < CONTEXTS; i++)
        m->any[i] = m->sign[i] = ENTROPY_EVEN;
    for (int i = 0; i <= ENTROPY_BITS; i++)
        m->more[0][i] = m->more[1][i] = ENTROPY_EVEN;
}

static struct entropy_whole chances(struct model *m, int context)
{
    return (struct entropy_whole){&m->any[context], &m->sign[context], m->more[context != EVEN]};
}

// ---------------------------------------------------------------- maps

static uint16_t steps_of(float depth, float step)
{
    if (isinf(depth))
        return 0;
    const double steps = rint(1.0 / ((double)depth * step));
    return (uint16_t)(steps < 1.0 ? 1.0 : steps > MOST_STEPS ? MOST_STEPS : steps);
}

static void put_all(struct entropy_writer *w, struct model *m, const uint16_t *steps,
                    const struct relume_image *depth)
{
    const size_t width = (size_t)depth->width;
    const uint16_t *above = NULL, *row = steps;
    for (int y = 0; y < depth->height; y++, above = row, row += width)
        for (size_t x = 0; x < width; x++) {
            const struct around n = around(row, above, x, width);
            bool mirrored;
            const int context = context_of(n, &mirrored);
            const int difference = row[x] - foretold(n);
            const struct entropy_whole by = chances(m, context);
            entropy_put_whole(w, &by, mirrored ? -difference : difference);
        }
    entropy_end(w);
}

static void get_all(uint16_t *steps, struct entropy_reader *r, struct model *m,
                    const struct relume_image *depth)
{
    const size_t width = (size_t)depth->width;
    const uint16_t *above = NULL;
    uint16_t *row = steps;
    for (int y = 0; y < depth->height; y++, above = row, row += width)
        for (size_t x = 0; x < width; x++) {
            const struct around n = around(row, above, x, width);
            bool mirrored;
            const struct entropy_whole by = chances(m, context_of(n, &mirrored));
            const int difference = entropy_get_whole(r, &by);
            row[x] = (uint16_t)(foretold(n) + (mirrored ? -difference : difference));
        }
}

static float nearest(const struct relume_image *depth)
{
    const size_t n = (size_t)depth->width * (size_t)depth->height;
    float least = INFINITY;
    for (size_t i = 0; i < n; i++)
        least = depth->data[i] > 0.0f && depth->data[i] < least ? depth->data[i] : least;
    return least;
}

static relume_status to_words(struct lossy_words *out, const struct entropy_writer *w)
{
    const size_t count = HEAD_WORDS + (w->size + 3) / 4;
    uint32_t *word = w->failed ? NULL : mem_zeroed(count, sizeof *word);
    if (!word)
        return RELUME_ENOMEM;
    word[WORD_MAGIC] = MAGIC;
    word[WORD_BYTES] = (uint32_t)w->size;
    word[WORD_CRC] = (uint32_t)crc32(0, w->byte, (uInt)w->size);
    lossy_put_bytes(word + HEAD_WORDS, w->byte, w->size);
    *out = (struct lossy_words){word, count};
    return RELUME_OK;
}

relume_status disparity_encode(struct lossy_words *out, float *step,
                               const struct relume_image *depth)
{
    const size_t pixels = (size_t)depth->width * (size_t)depth->height;
    const float least = 1.0f / nearest(depth) / MOST_STEPS;
    struct model *model = mem_array(1, sizeof *model);
    uint16_t *steps = mem_array(pixels, sizeof *steps);
    struct entropy_writer w = entropy_write();
    relume_status status = model && steps ? RELUME_OK : RELUME_ENOMEM;
    *step = *step > least ? *step : least > 0.0f ? least : 1.0f;
    *out = (struct lossy_words){0};
    if (!status) {
        for (size_t i = 0; i < pixels; i++)
            steps[i] = steps_of(depth->data[i], *step);
        begin_model(model);
        put_all(&w, model, steps, depth);
        status = to_words(out, &w);
    }
    mem_free(w.byte);
    mem_free(model);
    mem_free(steps);
    return status;
}

static relume_status decode_steps(uint16_t *steps, const struct relume_image *depth,
                                  const struct lossy_words *words)
{
    const size_t size = words->word[WORD_BYTES];
    struct model *model = mem_array(1, sizeof *model);
    unsigned char *byte = mem_array(size, 1);
    relume_status status = model && byte ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        lossy_take_bytes(byte, words->word + HEAD_WORDS, size);
        if (crc32(0, byte, (uInt)size) != words->word[WORD_CRC])
            status = RELUME_EDAMAGED;
    }
    if (!status) {
        struct entropy_reader r = entropy_read(byte, size);
        begin_model(model);
        get_all(steps, &r, model, depth);
    }
    mem_free(model);
    mem_free(byte);
    return status;
}

relume_status disparity_decode(struct relume_image *depth, const struct lossy_words *words,
                               float step)
{
    const size_t pixels = (size_t)depth->width * (size_t)depth->height;
    if (words->count < HEAD_WORDS || words->word[WORD_MAGIC] != MAGIC ||
        words->word[WORD_BYTES] > 4 * (words->count - HEAD_WORDS))
        return RELUME_EDAMAGED;
    uint16_t *steps = mem_array(pixels, sizeof *steps);
    relume_status status = steps ? decode_steps(steps, depth, words) : RELUME_ENOMEM;
    if (!status)
        status = slopes_of_steps(depth, steps);
    for (size_t i = 0; !status && i < pixels; i++)
        depth->data[i] = steps[i] ? (float)(1.0 / ((double)depth->data[i] * step)) : INFINITY;
    mem_free(steps);
    return status;
}
