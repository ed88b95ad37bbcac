// lossy.c - tiles of a view, and the colour of their pictures
#include "format/lossy/lossy.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "format/coder/coding.h"

#include <math.h>
#include <string.h>
#include <zlib.h>

// Words at the head, before two for each tile: bytes of its sequence, and their CRC-32.
enum { WORD_MAGIC, WORD_TILE, WORD_TILES, HEAD_WORDS };
enum { MAGIC = 0x31564C52, TILE = 512, GRANULE = 8, LEAST_SIDE = 16 };  // "RLV1"

// A tile of a group is in memory while it is coded: smaller ones where it would take more than
// this.
enum { MOST_SAMPLES = 1 << 28, LEAST_TILE = 128 };

struct tiles {
    struct lossy_shape shape;
    int size, across, count;
};

struct tile {
    int x, y, width, height;
    struct av1_shape video;  // whole blocks: edges are repeated
};

static struct tiles tiles_of(const struct lossy_shape *shape, int size)
{
    const int across = (shape->width + size - 1) / size;
    const int down = (shape->height + size - 1) / size;
    return (struct tiles){*shape, size, across, across * down};
}

static int padded(int side)
{
    const int whole = (side + GRANULE - 1) / GRANULE * GRANULE;
    return whole > LEAST_SIDE ? whole : LEAST_SIDE;
}

static struct tile tile_in(const struct lossy_shape *shape, const struct relume_rect *at)
{
    const int components = shape->colour ? 3 : 1;
    return (struct tile){at->left, at->top, at->width, at->height,
                         .video = {padded(at->width), padded(at->height), components,
                                   shape->planes / components, shape->halved}};
}

static struct tile tile_at(const struct tiles *t, int index)
{
    const int x = index % t->across * t->size, y = index / t->across * t->size;
    const struct relume_rect at = {x, y, smaller_of(t->size, t->shape.width - x),
                                   smaller_of(t->size, t->shape.height - y)};
    return tile_in(&t->shape, &at);
}

static uint16_t *tile_samples(const struct tile *t)
{
    return mem_array((size_t)t->video.components * (size_t)t->video.pictures,
                     (size_t)t->video.width * (size_t)t->video.height * sizeof(uint16_t));
}

// ---------------------------------------------------------------- colour

// Rec. 709 luma and its colour differences, in 1 / 65536; codes are around 2048.
enum { ONE = 65536, HALF_CODE = 2048, KR = 13933, KG = 46871, KB = 4732 };

static uint16_t to_code(int64_t v)
{
    return (uint16_t)(v < 0 ? 0 : v > AV1_TOP ? AV1_TOP : v);
}

// v / d, to the nearest.
static int64_t divided(int64_t v, int64_t d)
{
    return (v >= 0 ? v + d / 2 : v - d / 2) / d;
}

static void to_luma(uint16_t *s, size_t plane)
{
    for (size_t i = 0; i < plane; i++) {
        const int64_t r = s[i], g = s[plane + i], b = s[2 * plane + i];
        const int64_t y = KR * r + KG * g + KB * b;
        s[i] = to_code(divided(y, ONE));
        s[plane + i] = to_code(HALF_CODE + divided(b * ONE - y, 2 * (ONE - KB)));
        s[2 * plane + i] = to_code(HALF_CODE + divided(r * ONE - y, 2 * (ONE - KR)));
    }
}

static void from_luma(uint16_t *s, size_t plane)
{
    for (size_t i = 0; i < plane; i++) {
        const int64_t y = (int64_t)s[i] * ONE;
        const int64_t r = y + (s[2 * plane + i] - HALF_CODE) * 2 * (int64_t)(ONE - KR);
        const int64_t b = y + (s[plane + i] - HALF_CODE) * 2 * (int64_t)(ONE - KB);
        s[i] = to_code(divided(r, ONE));
        s[plane + i] = to_code(divided(y * ONE - KR * r - KB * b, (int64_t)KG * ONE));
        s[2 * plane + i] = to_code(divided(b, ONE));
    }
}

static void convert(uint16_t *samples, const struct av1_shape *s,
                    void (*colour)(uint16_t *, size_t))
{
    const size_t plane = (size_t)s->width * (size_t)s->height;
    for (int p = 0; s->components == 3 && p < s->pictures; p++)
        colour(samples + 3 * (size_t)p * plane, plane);
}

// ---------------------------------------------------------------- pictures

bool lossy_in_colour(const relume_coder *coder)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    return !info->joint && !info->luminance;
}

// From each light to the nearest that is left: its picture is predicted from the last one's.
static void chain(int *order, const struct relume_vec3 *d, int n)
{
    for (int i = 0; i < n; i++)
        order[i] = i;
    for (int i = 1; i < n; i++) {
        const struct relume_vec3 from = d[order[i - 1]];
        int best = i;
        double closest = -2.0;
        for (int k = i; k < n; k++) {
            const struct relume_vec3 to = d[order[k]];
            const double cosine = from.x * to.x + from.y * to.y + from.z * to.z;
            best = cosine > closest ? k : best;
            closest = cosine > closest ? cosine : closest;
        }
        const int light = order[best];
        memmove(order + i + 1, order + i, (size_t)(best - i) * sizeof *order);
        order[i] = light;
    }
}

int *lossy_order(const relume_coder *coder)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    if (!info->interpolant || info->joint || info->lights != info->coefficients)
        return NULL;
    int *order = mem_array((size_t)info->lights, sizeof *order);
    if (order)
        chain(order, info->directions, info->lights);
    return order;
}

// Which plane is component c of picture p.
static size_t plane_of(const struct lossy_shape *s, int p, int c)
{
    const int picture = s->order ? s->order[p] : p;
    return (size_t)(s->colour ? 3 * picture + c : picture);
}

static void repeat_edges(uint16_t *plane, const struct tile *t)
{
    const size_t stride = (size_t)t->video.width;
    for (size_t y = 0; y < (size_t)t->height; y++)
        for (size_t x = (size_t)t->width; x < stride; x++)
            plane[y * stride + x] = plane[y * stride + x - 1];
    for (size_t y = (size_t)t->height; y < (size_t)t->video.height; y++)
        memcpy(plane + y * stride, plane + (y - 1) * stride, stride * sizeof *plane);
}

// ---------------------------------------------------------------- encoding

struct encoding {
    struct tiles tiles;
    relume_coefficients *const *from;  // [views], or ...
    const uint16_t *codes;             // [planes][height][width] of one
    int views, first, end;             // which tiles
    int each;                          // threads for each of them
    const struct av1_effort *effort;
    const struct relume_log *log;
    relume_status *status;    // [end - first]
    struct av1_bytes *bytes;  // [end - first][views]
};

// Rows of a coefficient are [row][plane][x].
static relume_status gather(uint16_t *samples, const relume_coefficients *from,
                            const struct lossy_shape *s, const struct tile *t)
{
    const size_t width = (size_t)s->width, stride = (size_t)t->video.width;
    const size_t plane = stride * (size_t)t->video.height;
    uint16_t *row = mem_array((size_t)s->planes, width * sizeof *row);
    relume_status status = row ? RELUME_OK : RELUME_ENOMEM;
    for (int y = 0; !status && y < t->height; y++) {
        status = relume_coefficients_read(from, t->y + y, 1, row);
        for (int p = 0; !status && p < t->video.pictures; p++)
            for (int c = 0; c < t->video.components; c++)
                memcpy(samples + (size_t)(p * t->video.components + c) * plane + (size_t)y * stride,
                       row + plane_of(s, p, c) * width + t->x, (size_t)t->width * sizeof *row);
    }
    for (int p = 0; !status && p < s->planes; p++)
        repeat_edges(samples + (size_t)p * plane, t);
    mem_free(row);
    return status;
}

// The same of codes in memory, without an order of their own.
static void cut(uint16_t *samples, const uint16_t *codes, const struct lossy_shape *s,
                const struct tile *t)
{
    const size_t width = (size_t)s->width, stride = (size_t)t->video.width;
    for (int p = 0; p < s->planes; p++) {
        uint16_t *to = samples + (size_t)p * stride * (size_t)t->video.height;
        const uint16_t *from =
            codes + ((size_t)p * (size_t)s->height + (size_t)t->y) * width + (size_t)t->x;
        for (size_t y = 0; y < (size_t)t->height; y++)
            memcpy(to + y * stride, from + y * width, (size_t)t->width * sizeof *to);
        repeat_edges(to, t);
    }
}

static relume_status take_view(uint16_t *samples, const struct encoding *e, int view,
                               const struct tile *t)
{
    if (!e->codes)
        return gather(samples, e->from[view], &e->tiles.shape, t);
    cut(samples, e->codes, &e->tiles.shape, t);
    return RELUME_OK;
}

static void encode_tile(void *context, size_t item, int worker)
{
    struct encoding *e = context;
    const struct tile t = tile_at(&e->tiles, e->first + (int)item);
    uint16_t *samples[AV1_MOST_MEMBERS] = {0};
    relume_status status = RELUME_OK;
    (void)worker;
    for (int v = 0; !status && v < e->views; v++) {
        samples[v] = tile_samples(&t);
        status = samples[v] ? take_view(samples[v], e, v, &t) : RELUME_ENOMEM;
        if (!status)
            convert(samples[v], &t.video, to_luma);
    }
    if (!status)
        status = av1_encode(e->bytes + item * (size_t)e->views, (const uint16_t *const *)samples,
                            e->views, &t.video, e->effort, e->each, e->log);
    e->status[item] = status;
    for (int v = 0; v < e->views; v++)
        mem_free(samples[v]);
}

size_t lossy_words_for(size_t bytes)
{
    return (bytes + 3) / 4;
}

size_t lossy_words_of(const struct lossy_cut *cut)
{
    return HEAD_WORDS + 2 * (size_t)cut->count;
}

void lossy_put_bytes(uint32_t *word, const unsigned char *bytes, size_t size)
{
    memset(word, 0, 4 * lossy_words_for(size));
    for (size_t i = 0; i < size; i++)
        word[i / 4] |= (uint32_t)bytes[i] << 8 * (i % 4);
}

void lossy_take_bytes(unsigned char *bytes, const uint32_t *word, size_t size)
{
    for (size_t i = 0; i < size; i++)
        bytes[i] = (unsigned char)(word[i / 4] >> 8 * (i % 4));
}

relume_status lossy_join(struct lossy_words *out, const struct lossy_cut *cut,
                         const struct av1_bytes *sequence, size_t stride)
{
    const size_t tiles = (size_t)cut->count;
    size_t at = lossy_words_of(cut), count = at;
    for (size_t i = 0; i < tiles; i++)
        count += lossy_words_for(sequence[i * stride].size);
    uint32_t *word = mem_array(count, sizeof *word);
    if (!word)
        return RELUME_ENOMEM;
    word[WORD_MAGIC] = MAGIC;
    word[WORD_TILE] = (uint32_t)cut->side;
    word[WORD_TILES] = (uint32_t)tiles;
    for (size_t i = 0; i < tiles; i++) {
        const struct av1_bytes *b = &sequence[i * stride];
        word[HEAD_WORDS + 2 * i] = (uint32_t)b->size;
        word[HEAD_WORDS + 2 * i + 1] = b->size ? (uint32_t)crc32(0, b->byte, (uInt)b->size) : 0;
        lossy_put_bytes(word + at, b->byte, b->size);
        at += lossy_words_for(b->size);
    }
    *out = (struct lossy_words){word, count};
    return RELUME_OK;
}

relume_status lossy_look(struct lossy_held *out, const uint32_t *head, size_t words)
{
    const struct lossy_words some = {(uint32_t *)(uintptr_t)head, words};
    *out = (struct lossy_held){.side = lossy_side(&some)};
    if (!out->side || lossy_head(head) > words || head[WORD_TILES] > INT32_MAX)
        return RELUME_EDAMAGED;
    const uint32_t *size = head + HEAD_WORDS;
    out->count = (int)head[WORD_TILES];
    out->words = lossy_head(head);
    for (out->first = 0; out->first < out->count && !size[2 * (size_t)out->first];)
        out->first++;
    for (out->end = out->first; out->end < out->count && size[2 * (size_t)out->end]; out->end++)
        out->words += lossy_words_for(size[2 * (size_t)out->end]);
    for (int i = out->end; i < out->count; i++)
        if (size[2 * (size_t)i])
            return RELUME_EDAMAGED;
    return RELUME_OK;
}

void lossy_add_tiles(uint32_t *head, const uint32_t *other, const struct lossy_held *held)
{
    const size_t at = HEAD_WORDS + 2 * (size_t)held->first;
    memcpy(head + at, other + at, 2 * (size_t)(held->end - held->first) * sizeof *head);
}

relume_status lossy_keep_tiles(struct lossy_words *out, const struct lossy_words *words, int first,
                               int end)
{
    const uint32_t *from = words->word;
    const size_t tiles = from[WORD_TILES], head = HEAD_WORDS + 2 * tiles;
    size_t at = head, before = head, kept = 0;
    for (size_t i = 0; i < (size_t)end; i++) {
        const size_t count = lossy_words_for(from[HEAD_WORDS + 2 * i]);
        before += i < (size_t)first ? count : 0;
        kept += i < (size_t)first ? 0 : count;
    }
    uint32_t *word = mem_zeroed(head + kept, sizeof *word);
    if (!word)
        return RELUME_ENOMEM;
    memcpy(word, from, HEAD_WORDS * sizeof *word);
    memcpy(word + HEAD_WORDS + 2 * first, from + HEAD_WORDS + 2 * first,
           2 * (size_t)(end - first) * sizeof *word);
    memcpy(word + at, from + before, kept * sizeof *word);
    *out = (struct lossy_words){word, head + kept};
    return RELUME_OK;
}

int lossy_most_views(const relume_coder *coder)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    return av1_most_members(lossy_in_colour(coder) ? info->planes / 3 : info->planes);
}

static int tile_side(const struct lossy_shape *shape, int views)
{
    int side = TILE;
    while (side > LEAST_TILE &&
           (double)side * side * shape->planes * views * sizeof(uint16_t) > MOST_SAMPLES)
        side /= 2;
    return side;
}

// bytes[end - first][views] of the tiles `first` .. `end`, without any on failure.
static relume_status encode_tiles(struct encoding *e, int threads)
{
    const size_t n = (size_t)(e->end - e->first), sequences = n * (size_t)e->views;
    e->status = mem_zeroed(n + 1, sizeof *e->status);
    e->each = n ? thread_count(threads) / (int)n : 1;
    relume_status status = e->status ? RELUME_OK : RELUME_ENOMEM;
    memset(e->bytes, 0, sequences * sizeof *e->bytes);
    if (!status)
        thread_for(threads, n, encode_tile, e);
    for (size_t i = 0; !status && i < n; i++)
        status = e->status[i];
    for (size_t i = 0; status && i < sequences; i++) {
        mem_free(e->bytes[i].byte);
        e->bytes[i] = (struct av1_bytes){0};
    }
    mem_free(e->status);
    return status;
}

static relume_status encode_all(struct lossy_words *out, struct encoding *e, int threads)
{
    const struct lossy_cut cut = {e->tiles.size, e->tiles.across, e->tiles.count};
    const size_t views = (size_t)e->views, sequences = (size_t)cut.count * views;
    e->end = cut.count;
    e->bytes = mem_zeroed(sequences, sizeof *e->bytes);
    memset(out, 0, views * sizeof *out);
    relume_status status = e->bytes ? encode_tiles(e, threads) : RELUME_ENOMEM;
    for (size_t v = 0; !status && v < views; v++)
        status = lossy_join(&out[v], &cut, e->bytes + v, views);
    for (size_t i = 0; e->bytes && i < sequences; i++)
        mem_free(e->bytes[i].byte);
    mem_free(e->bytes);
    return status;
}

// Halvings of the step of each plane against the largest one; NULL: none, or memory is short, which
// costs bytes alone.
static unsigned char *halvings_of(const struct relume_coefficients_info *info)
{
    unsigned char *halved =
        lossy_in_colour(info->coder) ? NULL : mem_array((size_t)info->planes, sizeof *halved);
    float most = 0.0f;
    bool any = false;
    for (int p = 0; p < info->planes; p++)
        most = fmaxf(most, info->scale[p]);
    for (int p = 0; halved && p < info->planes; p++) {
        halved[p] = (unsigned char)lrintf(log2f(most / info->scale[p]));
        any |= halved[p] > 0;
    }
    if (!any) {
        mem_free(halved);
        halved = NULL;
    }
    return halved;
}

static struct lossy_shape shape_of(const struct relume_coefficients_info *info)
{
    return (struct lossy_shape){info->width,
                                info->height,
                                info->planes,
                                lossy_in_colour(info->coder),
                                lossy_order(info->coder),
                                halvings_of(info)};
}

static void shape_destroy(const struct lossy_shape *shape)
{
    mem_free((int *)(uintptr_t)shape->order);
    mem_free((unsigned char *)(uintptr_t)shape->halved);
}

struct lossy_cut lossy_cut_of(const relume_coder *coder, int width, int height, int views)
{
    const struct lossy_shape shape = {
        .width = width, .height = height, .planes = relume_coder_info(coder)->planes};
    const struct tiles t = tiles_of(&shape, tile_side(&shape, views));
    return (struct lossy_cut){t.size, t.across, t.count};
}

static struct encoding encoding_of(const struct lossy_shape *shape,
                                   relume_coefficients *const *from, int views,
                                   const struct av1_effort *effort, const struct relume_log *log)
{
    return (struct encoding){.tiles = tiles_of(shape, tile_side(shape, views)),
                             .from = from,
                             .views = views,
                             .effort = effort,
                             .log = log};
}

relume_status lossy_encode_tiles(struct av1_bytes *sequence, relume_coefficients *const *from,
                                 int views, int first, int end, const struct av1_effort *effort,
                                 int threads, const struct relume_log *log)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(from[0]);
    const struct lossy_shape shape = shape_of(info);
    struct encoding e = encoding_of(&shape, from, views, effort, log);
    e.first = first;
    e.end = end;
    e.bytes = sequence;
    const relume_status status = encode_tiles(&e, threads);
    shape_destroy(&shape);
    return status;
}

relume_status lossy_encode(struct lossy_words *out, relume_coefficients *const *from, int views,
                           const struct av1_effort *effort, int threads,
                           const struct relume_log *log)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(from[0]);
    const struct lossy_shape shape = shape_of(info);
    struct encoding e = encoding_of(&shape, from, views, effort, log);
    const relume_status status = encode_all(out, &e, threads);
    shape_destroy(&shape);
    return status;
}

relume_status lossy_encode_codes(struct lossy_words *out, const uint16_t *codes,
                                 const struct lossy_shape *shape, const struct av1_effort *effort,
                                 int threads, const struct relume_log *log)
{
    struct encoding e = encoding_of(shape, NULL, 1, effort, log);
    e.codes = codes;
    return encode_all(out, &e, threads);
}

// ---------------------------------------------------------------- decoding

// Words whose tiles are known.
struct found {
    const uint32_t *word;
    size_t *at;  // [tiles]: where the words of each begin
};

struct decoding {
    struct tiles tiles;
    struct found view, anchor;
    const struct relume_rect *rect;  // of the view
    int across, count, first;        // tiles that it touches: so many across, which is the first
    uint16_t *codes;                 // of the rectangle
    relume_status *status;           // [count]
};

static struct tile tile_of_item(const struct decoding *d, int item)
{
    return tile_at(&d->tiles, d->first + item / d->across * d->tiles.across + item % d->across);
}

static void choose_tiles(struct decoding *d)
{
    const int size = d->tiles.size, left = d->rect->left / size, top = d->rect->top / size;
    const int right = (d->rect->left + d->rect->width - 1) / size;
    const int bottom = (d->rect->top + d->rect->height - 1) / size;
    d->across = right - left + 1;
    d->count = d->across * (bottom - top + 1);
    d->first = top * d->tiles.across + left;
}

// What of a tile is in the rectangle.
static struct relume_rect seen_of(const struct relume_rect *r, const struct tile *t)
{
    const int left = t->x > r->left ? t->x : r->left, top = t->y > r->top ? t->y : r->top;
    return (struct relume_rect){left, top, smaller_of(t->x + t->width, r->left + r->width) - left,
                                smaller_of(t->y + t->height, r->top + r->height) - top};
}

int lossy_side(const struct lossy_words *words)
{
    const uint32_t *word = words->word;
    const bool good = words->count >= HEAD_WORDS && word[WORD_MAGIC] == MAGIC &&
                      word[WORD_TILE] >= LEAST_SIDE && word[WORD_TILE] <= 4096;
    return good ? (int)word[WORD_TILE] : 0;
}

// Of `words` that are tiles of such a view, all within the words.
static relume_status find_tiles(struct found *f, struct tiles *tiles,
                                const struct lossy_shape *shape, const struct lossy_words *words)
{
    const uint32_t *word = words->word;
    f->word = word;
    if (!lossy_side(words))
        return RELUME_EDAMAGED;
    *tiles = tiles_of(shape, (int)word[WORD_TILE]);
    size_t at = HEAD_WORDS + 2 * (size_t)tiles->count;
    if (word[WORD_TILES] != (uint32_t)tiles->count || words->count < at)
        return RELUME_EDAMAGED;
    f->at = mem_array((size_t)tiles->count, sizeof *f->at);
    if (!f->at)
        return RELUME_ENOMEM;
    for (int i = 0; i < tiles->count; i++) {
        f->at[i] = at;
        at += lossy_words_for(word[HEAD_WORDS + 2 * i]);
    }
    return at <= words->count ? RELUME_OK : RELUME_EDAMAGED;
}

size_t lossy_head(const uint32_t word[3])
{
    return HEAD_WORDS + 2 * (size_t)word[WORD_TILES];
}

// The tiles of a row lie one behind the other.
relume_status lossy_needs(const struct lossy_shape *shape, const struct relume_rect *rect,
                          const struct lossy_words *words,
                          relume_status (*need)(void *user, size_t first, size_t count), void *user)
{
    struct decoding d = {.rect = rect};
    relume_status status = find_tiles(&d.view, &d.tiles, shape, words);
    if (!status)
        choose_tiles(&d);
    for (int i = d.first; !status && i < d.first + d.count / d.across * d.tiles.across;
         i += d.tiles.across) {
        const int last = i + d.across - 1;
        const size_t end =
            d.view.at[last] + lossy_words_for(words->word[HEAD_WORDS + 2 * (size_t)last]);
        status = need(user, d.view.at[i], end - d.view.at[i]);
    }
    mem_free(d.view.at);
    return status;
}

// Copies the share of a rectangle in a picture of a tile to codes[planes][rect height][rect width].
static void scatter_picture(uint16_t *codes, const struct relume_rect *r,
                            const struct lossy_shape *shape, const struct tile *t, int picture,
                            const uint16_t *samples)
{
    const struct relume_rect seen = seen_of(r, t);
    const size_t width = (size_t)r->width, stride = (size_t)t->video.width;
    const size_t from = (size_t)(seen.top - t->y) * stride + (size_t)(seen.left - t->x);
    const size_t to = (size_t)(seen.top - r->top) * width + (size_t)(seen.left - r->left);
    for (int c = 0; c < t->video.components; c++) {
        uint16_t *plane = codes + plane_of(shape, picture, c) * width * (size_t)r->height;
        for (size_t y = 0; y < (size_t)seen.height; y++)
            memcpy(plane + to + y * width, samples + from + y * stride,
                   (size_t)seen.width * sizeof *plane);
        samples += stride * (size_t)t->video.height;
    }
}

static size_t picture_size(const struct tile *t)
{
    return (size_t)t->video.components * (size_t)t->video.width * (size_t)t->video.height;
}

static void scatter(uint16_t *codes, const struct relume_rect *r, const struct lossy_shape *shape,
                    const struct tile *t, const uint16_t *samples)
{
    for (int p = 0; p < t->video.pictures; p++)
        scatter_picture(codes, r, shape, t, p, samples + (size_t)p * picture_size(t));
}

// The sequence of a tile, when its checksum agrees; the bytes are freed by the caller.
static relume_status tile_bytes(struct av1_bytes *out, const struct found *f, size_t tile)
{
    const uint32_t *head = f->word + HEAD_WORDS + 2 * tile, *from = f->word + f->at[tile];
    out->size = head[0];
    out->byte = mem_array(out->size, 1);
    if (!out->byte)
        return RELUME_ENOMEM;
    lossy_take_bytes(out->byte, from, out->size);
    return crc32(0, out->byte, (uInt)out->size) == head[1] ? RELUME_OK : RELUME_EDAMAGED;
}

// A tile whose pictures are put where they belong as they come.
struct placing {
    const struct decoding *d;
    const struct tile *tile;
    uint16_t *samples;  // of a picture
};

static void place_picture(void *user, int picture)
{
    const struct placing *p = user;
    const struct tile *t = p->tile;
    if (t->video.components == 3)
        from_luma(p->samples, picture_size(t) / 3);
    scatter_picture(p->d->codes, p->d->rect, &p->d->tiles.shape, t, picture, p->samples);
}

// Takes away what the pictures before the damaged one have put there.
static void clear_tile(const struct placing *p)
{
    memset(p->samples, 0, picture_size(p->tile) * sizeof *p->samples);
    for (int k = 0; k < p->tile->video.pictures; k++)
        scatter_picture(p->d->codes, p->d->rect, &p->d->tiles.shape, p->tile, k, p->samples);
}

static void decode_tile(void *context, size_t item, int worker)
{
    struct decoding *d = context;
    const struct tile t = tile_of_item(d, (int)item);
    const size_t tile = (size_t)(t.y / d->tiles.size * d->tiles.across + t.x / d->tiles.size);
    struct av1_bytes bytes = {0}, first = {0};
    struct placing placing = {d, &t, mem_array(picture_size(&t), sizeof(uint16_t))};
    relume_status status = placing.samples ? tile_bytes(&bytes, &d->view, tile) : RELUME_ENOMEM;
    (void)worker;
    if (!status && d->anchor.word)
        status = tile_bytes(&first, &d->anchor, tile);
    if (!status) {
        const struct av1_pictures to = {placing.samples, place_picture, &placing};
        status = av1_decode_each(&to, &t.video, &bytes, d->anchor.word ? &first : NULL);
        if (status)
            clear_tile(&placing);
    }
    d->status[item] = status;
    mem_free(placing.samples);
    mem_free(bytes.byte);
    mem_free(first.byte);
}

static relume_status decode_all(struct decoding *d, int threads, const struct lossy_lost *lost)
{
    thread_for(threads, (size_t)d->count, decode_tile, d);
    for (int i = 0; i < d->count; i++) {
        const struct tile t = tile_of_item(d, i);
        const struct relume_rect seen = seen_of(d->rect, &t);
        if (d->status[i] == RELUME_EDAMAGED && lost)
            lost->tile(lost->user, &seen);
        else if (d->status[i])
            return d->status[i];
    }
    return RELUME_OK;
}

relume_status lossy_decode(uint16_t *codes, const struct lossy_shape *shape,
                           const struct relume_rect *rect, const struct lossy_words *words,
                           const struct lossy_words *anchor, int threads,
                           const struct lossy_lost *lost)
{
    const size_t pixels = (size_t)rect->width * (size_t)rect->height;
    struct decoding d = {.codes = codes, .rect = rect};
    struct tiles of_anchor = {.size = 0};
    relume_status status = find_tiles(&d.view, &d.tiles, shape, words);
    if (!status && anchor)
        status = find_tiles(&d.anchor, &of_anchor, shape, anchor);
    if (!status && anchor && of_anchor.size != d.tiles.size)
        status = RELUME_EDAMAGED;
    if (!status) {
        choose_tiles(&d);
        d.status = mem_zeroed((size_t)d.count, sizeof *d.status);
        memset(codes, 0, (size_t)shape->planes * pixels * sizeof *codes);
        status = d.status ? decode_all(&d, threads, lost) : RELUME_ENOMEM;
    }
    mem_free(d.view.at);
    mem_free(d.anchor.at);
    mem_free(d.status);
    return status;
}

relume_status lossy_try(uint16_t *before, uint16_t *after, size_t *bytes, relume_coefficients *from,
                        const struct relume_rect *at, const struct av1_effort *effort, int threads,
                        const struct relume_log *log)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(from);
    const struct lossy_shape shape = shape_of(info);
    const struct tile t = tile_in(&shape, at);
    struct av1_bytes sequence = {0};
    uint16_t *samples = tile_samples(&t);
    relume_status status = samples ? gather(samples, from, &shape, &t) : RELUME_ENOMEM;
    if (!status) {
        scatter(before, at, &shape, &t, samples);
        convert(samples, &t.video, to_luma);
        const uint16_t *const member = samples;
        status = av1_encode(&sequence, &member, 1, &t.video, effort, threads, log);
    }
    if (!status)
        status = av1_decode(samples, &t.video, &sequence, NULL);
    if (!status) {
        convert(samples, &t.video, from_luma);
        scatter(after, at, &shape, &t, samples);
    }
    *bytes = sequence.size;
    mem_free(sequence.byte);
    mem_free(samples);
    shape_destroy(&shape);
    return status;
}
