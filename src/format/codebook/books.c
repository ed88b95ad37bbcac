// books.c - codebooks learn from a sample of the pixels of all views
//
// One book after another: each learns what those before have left, measured against the numbers as
// they are stored, so that a later book mends the rounding of an earlier one as well.
#include "format/codebook/books.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/random.h"
#include "format/codebook/drawing.h"
#include "format/coder/basis.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"

#include <math.h>
#include <string.h>

enum { DEFAULT_CODES = 256, DEFAULT_ROUNDS = 24, PER_CODE = 40, LEAST_SAMPLE = 65536 };
// Floats of a sample: a quarter of a gigabyte, and what it has anyway, for the last rounds.
static const size_t MOST_FLOATS = (size_t)1 << 26, LAST_FLOATS = (size_t)1 << 24;

void relume_books_destroy(relume_books **books)
{
    relume_books *b = *books;
    *books = NULL;
    if (!b)
        return;
    for (int i = 0; i < RELUME_MOST_BOOKS; i++) {
        mem_free(b->own[i].numbers);
        mem_free(b->own[i].scale);
        mem_free(b->own[i].offset);
        mem_free(b->own[i].vectors);
        nearest_destroy(&b->own[i].nearest);
    }
    mem_free(b);
}

const struct relume_books_info *relume_books_info(const relume_books *books)
{
    return &books->info;
}

// ---------------------------------------------------------------- what is learned from

struct sample {
    size_t n, planes;
    float *residual;  // [n][planes]
    float *part;      // [n][dim] of the book in progress
    uint16_t *index;  // [n]
};

static bool alloc_sample(struct sample *s)
{
    s->residual = mem_array(s->n * s->planes, sizeof *s->residual);
    s->part = mem_array(s->n * s->planes, sizeof *s->part);
    s->index = mem_array(s->n, sizeof *s->index);
    return s->residual && s->part && s->index;
}

// One view's rows, of which those pixels are taken that the random numbers say, if `c` holds it.
static relume_status draw_view(struct drawing *d, const relume_coefficients *c,
                               struct random *random, size_t *left, size_t *wanted, float *row,
                               void *waiting)
{
    const size_t width = (size_t)d->info->width, planes = (size_t)d->info->planes;
    relume_status status = RELUME_OK;
    for (int y = 0; !status && y < d->info->height; y++) {
        if (c)
            status = coefficients_values(c, y, waiting, row);
        for (size_t x = 0; !status && x < width; x++, --*left) {
            if ((double)*left * random_next(random) >= (double)*wanted)
                continue;
            for (size_t p = 0; c && p < planes; p++)
                d->to[d->at + d->drawn++] = row[p * width + x];
            --*wanted;
        }
    }
    return status;
}

static relume_status begin_share(void *context, int member)
{
    struct drawing *d = context;
    const int members = d->by ? d->by->team->members : 1;
    d->drawn = 0;
    return encode_share_of(&d->share, member + 1, members, d->count, BAND_ROWS) ? RELUME_OK
                                                                                : RELUME_EINVAL;
}

// Of the wanted pixels of all views, each choice equally likely (Knuth, algorithm 3.4.2 S), those
// in the views of a share, in their order.
static relume_status draw_share(void *context)
{
    struct drawing *d = context;
    const struct encode_share *share = &d->share;
    const size_t row_floats = (size_t)d->info->width * (size_t)d->info->planes;
    float *row = mem_array(row_floats, sizeof *row);
    void *waiting = mem_array(row_floats, sizeof *row);
    relume_status status = row && waiting ? RELUME_OK : RELUME_ENOMEM;
    struct random random = random_stream(d->seed, 2, 0);
    size_t left = d->pixels, wanted = d->wanted;
    for (int v = 0; !status && v < share->first + share->views; v++) {
        const bool ours = v >= share->first;
        relume_coefficients *made = NULL;
        if (ours && !d->views[v])
            status = d->by->encode(d->by->user, v, &made);
        if (!status)
            status = draw_view(d, ours ? (made ? made : d->views[v]) : NULL, &random, &left,
                               &wanted, row, waiting);
        relume_coefficients_destroy(&made);
    }
    mem_free(row);
    mem_free(waiting);
    return status;
}

static relume_status add_share(void *context)
{
    struct drawing *d = context;
    d->at += d->drawn;
    return RELUME_OK;
}

static relume_status draw_sample(struct drawing *d)
{
    static const struct team_work work = {begin_share, draw_share, add_share};
    const relume_status status =
        team_share(d->by ? d->by->team : NULL, "vectors", &work, d, &drawing_bytes, d, d->log);
    if (!status && d->at != drawing_floats(d))
        return log_fail(d->log, RELUME_EDAMAGED,
                        "what parts have drawn for the codebooks is not of this capture; remove it "
                        "and run them again");
    return status;
}

// ---------------------------------------------------------------- learning

static bool alloc_book(struct own *own, const struct relume_book *b, int planes)
{
    const size_t codes = (size_t)b->codes, dim = (size_t)b->dim;
    own->numbers = mem_array(codes * dim, relume_storage_bytes(b->storage));
    own->scale = mem_array(dim, sizeof *own->scale);
    own->offset = mem_array(dim, sizeof *own->offset);
    own->vectors = mem_array(codes * (size_t)planes, sizeof *own->vectors);
    return own->numbers && own->scale && own->offset && own->vectors &&
           !nearest_create(&own->nearest, b->codes, b->dim, 0);
}

// The numbers of the trained vectors, and all that follows from them.
static relume_status keep_vectors(relume_books *books, int i, float *vectors)
{
    struct relume_book *b = &books->book[i];
    struct own *own = &books->own[i];
    relume_status status = book_sort(vectors, b->codes, b->dim);
    if (!status && !alloc_book(own, b, books->info.planes))
        status = RELUME_ENOMEM;
    if (status)
        return status;
    book_store(own->numbers, own->scale, own->offset, vectors, b->codes, b->dim, b->storage);
    b->numbers = own->numbers;
    b->scale = own->scale;
    b->offset = own->offset;
    relume_book_expand(own->vectors, b, books->info.planes);
    books->vectors[i] = own->vectors;
    books->codes[i] = b->codes;
    for (int c = 0; c < b->codes; c++)
        for (int d = 0; d < b->dim; d++)
            vectors[(size_t)c * (size_t)b->dim + (size_t)d] = book_number(b, d, c);
    nearest_set(&own->nearest, vectors);
    return RELUME_OK;
}

struct removal {
    struct sample *sample;
    const relume_books *books;
    int book;
    double *distance;  // [n]
    float *apart;
    float *scratch;  // [workers][...]
};

enum { CHUNK = 3072 };

static void remove_chunk(void *context, size_t item, int worker)
{
    const struct removal *r = context;
    const struct own *own = &r->books->own[r->book];
    struct sample *s = r->sample;
    const size_t first = item * CHUNK, last = first + CHUNK < s->n ? first + CHUNK : s->n;
    uint32_t which[CHUNK];
    for (size_t i = first; i < last; i++)
        which[i - first] = (uint32_t)i;
    nearest_find(&own->nearest, s->part, which, last - first, s->index, r->distance, r->apart,
                 r->scratch + (size_t)worker * nearest_scratch(&own->nearest));
    for (size_t i = first; i < last; i++)
        for (size_t p = 0; p < s->planes; p++)
            s->residual[i * s->planes + p] -= own->vectors[(size_t)s->index[i] * s->planes + p];
}

// Take from the sample what the book now says.
static relume_status remove_book(struct sample *s, const relume_books *books, int i, int threads)
{
    const struct own *own = &books->own[i];
    struct removal r = {.sample = s, .books = books, .book = i};
    r.distance = mem_array(s->n, sizeof *r.distance);
    r.apart = mem_array(s->n, sizeof *r.apart);
    r.scratch = mem_array((size_t)thread_count(threads) * nearest_scratch(&own->nearest),
                          sizeof *r.scratch);
    const bool good = r.distance && r.apart && r.scratch;
    if (good)
        thread_for(threads, (s->n + CHUNK - 1) / CHUNK, remove_chunk, &r);
    mem_free(r.distance);
    mem_free(r.apart);
    mem_free(r.scratch);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// What most rounds learn from.
static size_t usual_sample(const struct relume_books_params *p, int codes)
{
    const size_t usual = (size_t)codes * PER_CODE;
    const size_t n = p->sample ? p->sample : usual > LEAST_SAMPLE ? usual : LEAST_SAMPLE;
    return n > (size_t)codes ? n : (size_t)codes;
}

static relume_status learn_book(relume_books *books, int i, struct sample *s,
                                const struct relume_books_params *p)
{
    const struct relume_book *b = &books->book[i];
    relume_codebook *trained;
    for (size_t k = 0; k < s->n; k++)
        book_project(s->part + k * (size_t)b->dim, b, s->residual + k * s->planes);
    relume_status status = relume_codebook_train(
        &trained, s->part, s->n, b->dim,
        relume_codebook_params(.log = p->log, .start = p->start, .seed = p->seed + (uint64_t)i,
                               .codes = b->codes, .threads = p->threads,
                               .sample = usual_sample(p, b->codes), .team = p->team,
                               .max_rounds = p->max_rounds ? p->max_rounds : DEFAULT_ROUNDS));
    if (status)
        return status;
    const struct relume_codebook_info *info = relume_codebook_info(trained);
    float *vectors =
        mem_copy(info->vectors, (size_t)info->codes * (size_t)info->dim, sizeof *vectors);
    status = vectors ? keep_vectors(books, i, vectors) : RELUME_ENOMEM;
    if (!status)
        status = remove_book(s, books, i, p->threads);
    mem_free(vectors);
    relume_codebook_destroy(&trained);
    return status;
}

// ---------------------------------------------------------------- forms

static void add_book(relume_books *b, enum relume_book_kind kind, int first, int last, int codes,
                     enum relume_storage storage)
{
    b->book[b->info.books++] = (struct relume_book){
        .kind = kind,
        .first = first,
        .last = last,
        .codes = codes,
        .dim = relume_book_dim(kind, first, last),
        .storage = storage,
    };
}

static int split_parts(const struct relume_books_params *p)
{
    return p->split == RELUME_SPLIT_LUMA      ? 2
           : p->split == RELUME_SPLIT_PRODUCT ? (p->groups ? p->groups : 2)
                                              : 1;
}

static void add_stage(relume_books *b, const struct relume_coder_info *coder,
                      const struct relume_books_params *p, int codes, enum relume_storage storage)
{
    const int parts = split_parts(p), each = coder->joint ? 1 : 3;
    if (p->split == RELUME_SPLIT_LUMA) {
        add_book(b, RELUME_BOOK_LUMA, 0, coder->planes, codes, storage);
        add_book(b, RELUME_BOOK_CHROMA, 0, coder->planes, codes, storage);
    } else {
        const int units = coder->planes / each;
        for (int i = 0; i < parts; i++)
            add_book(b, RELUME_BOOK_PLANES, units * i / parts * each,
                     units * (i + 1) / parts * each, codes, storage);
    }
}

static relume_status check(const struct relume_coder_info *coder,
                           const struct relume_books_params *p, int codes, size_t pixels)
{
    const int parts = split_parts(p), stages = p->stages ? p->stages : 1;
    if (codes < 1 || codes > 65536)
        return log_fail(p->log, RELUME_EINVAL, "a codebook of %d codes; expected 1 to 65536",
                        codes);
    if (stages < 1 || parts < 1 || stages > RELUME_MOST_BOOKS || parts > RELUME_MOST_BOOKS ||
        stages * parts > RELUME_MOST_BOOKS)
        return log_fail(p->log, RELUME_EINVAL,
                        "%d stages of %d codebooks; expected at most %d books together", stages,
                        parts, RELUME_MOST_BOOKS);
    if (!(p->dither >= 0.0f && p->dither <= 1.0f))
        return log_fail(p->log, RELUME_EINVAL, "dither %g; expected 0 to 1", (double)p->dither);
    if (coder->joint && p->split == RELUME_SPLIT_LUMA)
        return log_fail(p->log, RELUME_EINVAL,
                        "basis %s has no planes per colour to split into luminance and "
                        "chrominance; expected split none or product:G",
                        coder->basis->name);
    if (coder->luminance && stages * parts > 1)
        return log_fail(p->log, RELUME_EINVAL,
                        "luminance coefficients are multiplied by a colour, so that codebooks "
                        "cannot be added; expected one book");
    if (p->split == RELUME_SPLIT_PRODUCT && parts > coder->coefficients)
        return log_fail(p->log, RELUME_EINVAL, "%d groups of %d coefficients; expected at most %d",
                        parts, coder->coefficients, coder->coefficients);
    if ((size_t)codes > pixels)
        return log_fail(p->log, RELUME_EUNFIT,
                        "a codebook of %d codes for %zu pixels; expected at most as many codes as "
                        "pixels",
                        codes, pixels);
    return RELUME_OK;
}

// What is held, and the last rounds learn from.
static size_t sample_size(const struct relume_books_params *p, int codes, size_t pixels,
                          size_t planes)
{
    size_t n = usual_sample(p, codes);
    if (!p->sample && n < LAST_FLOATS / planes)
        n = LAST_FLOATS / planes;
    n = n < MOST_FLOATS / planes ? n : MOST_FLOATS / planes;
    n = n > (size_t)codes ? n : (size_t)codes;
    return n < pixels ? n : pixels;
}

relume_status books_train(relume_books **out, const relume_coefficients *const *views, int n,
                          const struct relume_books_params *params, const struct books_team *by)
{
    const struct relume_books_params p = PARAMS_WORK(relume_books_params, params);
    int first = 0;
    while (!views[first])
        first++;
    const struct relume_coefficients_info *info = &views[first]->info;
    const struct relume_coder_info *coder = relume_coder_info(info->coder);
    const int codes = p.codes ? p.codes : DEFAULT_CODES;
    const size_t pixels = (size_t)info->width * (size_t)info->height * (size_t)n;
    *out = NULL;
    relume_status status = check(coder, &p, codes, pixels);
    if (status)
        return status;
    relume_books *books = mem_zeroed(1, sizeof *books);
    if (!books)
        return RELUME_ENOMEM;
    books->info = (struct relume_books_info){
        .planes = coder->planes,
        .book = books->book,
        .vectors = books->vectors,
        .codes = books->codes,
    };
    for (int stage = 0; stage < (p.stages ? p.stages : 1); stage++)
        add_stage(books, coder, &p, codes, info->storage);

    struct sample s = {.n = sample_size(&p, codes, pixels, (size_t)coder->planes),
                       .planes = (size_t)coder->planes};
    status = alloc_sample(&s) ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = draw_sample(&(struct drawing){.views = views,
                                               .count = n,
                                               .pixels = pixels,
                                               .wanted = s.n,
                                               .seed = p.seed,
                                               .by = by,
                                               .info = info,
                                               .log = p.log,
                                               .to = s.residual});
    for (int i = 0; !status && i < books->info.books; i++)
        status = learn_book(books, i, &s, &p);
    mem_free(s.residual);
    mem_free(s.part);
    mem_free(s.index);
    if (status)
        relume_books_destroy(&books);
    *out = books;
    return status;
}

relume_status relume_books_train(relume_books **out, const relume_coefficients *const *views, int n,
                                 const struct relume_books_params *params)
{
    return books_train(out, views, n, params, NULL);
}
