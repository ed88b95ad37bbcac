// read_books.c - codebooks and the indices into them
#include "format/pack/reader.h"

#include "core/base/memory.h"
#include "core/base/names.h"
#include "format/codebook/books.h"
#include "format/coder/codes.h"
#include "format/coder/coding.h"
#include "format/pack/format.h"

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

static void book_name(char name[48], int view, int book)
{
    if (view < 0)
        snprintf(name, 48, "book%d", book);
    else
        snprintf(name, 48, "view%04d.book%d", view, book);
}

static relume_status check_book(relume_pack *p, int part, const char *name, struct relume_book *b)
{
    const struct relume_coder_info *coder = relume_coder_info(p->coder);
    const struct exr_part_info i = exr_part_info(p->file, part);
    const char *text = exr_get_text(p->file, part, ATTR_BOOK);
    const int kind = text ? name_find(text, format_book_kinds, 3) : -1;
    b->kind = (enum relume_book_kind)kind;
    if (kind < 0 || !exr_get_int(p->file, part, ATTR_FIRST, &b->first) ||
        !exr_get_int(p->file, part, ATTR_LAST, &b->last) || b->last > coder->planes)
        return reader_bad(p, name, "planes, luma or chroma, and a range of planes");
    b->dim = relume_book_dim(b->kind, b->first, b->last);
    b->codes = i.width;
    b->storage = p->info.storage;
    if (b->dim < 1 || (coder->joint && b->kind != RELUME_BOOK_PLANES))
        return reader_bad(p, name, "planes that the basis has");
    if (i.height != 1 || i.width > 65536 ||
        (uint64_t)i.width * (uint64_t)coder->planes > p->limits.max_pixels)
        return reader_bad(p, name, "one row of at most 65536 vectors, within the limits");
    if (i.channels != b->dim || !i.uniform || i.sample != codes_sample(p->info.storage))
        return reader_bad(p, name, "one channel of the stored type for every number of a vector");
    b->scale = reader_floats(p, part, ATTR_SCALE, b->dim);
    b->offset = reader_floats(p, part, ATTR_OFFSET, b->dim);
    if (!b->scale || !b->offset)
        return reader_bad(p, name, "a finite scale and offset for every number of a vector");
    return RELUME_OK;
}

relume_status reader_find_books(relume_pack *p, int view, int *part)
{
    struct read_books *set = &p->books[view < 0 ? 0 : view];
    char name[48];
    if (!p->info.books)
        return RELUME_OK;
    if (relume_coder_info(p->coder)->luminance && p->info.books > 1)
        return reader_bad(p, ATTR_BOOKS, "one book for luminance coefficients");
    for (int b = 0; b < p->info.books; b++, ++*part) {
        book_name(name, view, b);
        const bool there =
            *part < exr_part_count(p->file) && !strcmp(exr_part_info(p->file, *part).name, name);
        if (!there && view < 0 && b == 0)
            return RELUME_OK;
        if (!there)
            return reader_bad(p, name, "a part of that name");
        const relume_status status = check_book(p, *part, name, &set->book[b]);
        if (status)
            return status;
        set->part[b] = *part;
    }
    p->info.shared = view < 0;
    p->info.codes = set->book[0].codes;
    return RELUME_OK;
}

// The mean belongs to the vectors of the first book, and to none of them that are nothing.
static void add_mean(const relume_pack *p, float *vectors, size_t codes)
{
    const size_t planes = (size_t)relume_coder_info(p->coder)->planes;
    for (size_t v = 0; planes > (size_t)p->info.planes && v < codes; v++)
        vectors[(v + 1) * planes - 1] = 1.0f;
}

static relume_status load_book(relume_pack *p, int part, const struct relume_book *b,
                               float **vectors)
{
    struct relume_book book = *b;
    const struct relume_coder_info *coder = relume_coder_info(p->coder);
    const size_t dim = (size_t)b->dim, codes = (size_t)b->codes;
    void *numbers = mem_array(dim * codes, relume_storage_bytes(b->storage));
    float *out = mem_zeroed((codes + 1) * (size_t)coder->planes, sizeof *out);
    relume_status status = numbers && out ? RELUME_OK : RELUME_ENOMEM;
    const bool of_planes = b->kind == RELUME_BOOK_PLANES;
    for (int d = b->first; !status && of_planes && d < b->last; d++)
        if (format_plane(coder, d) < b->first || format_plane(coder, d) >= b->last)
            status = reader_bad(p, "a codebook", "whole coefficients");
    if (!status)
        status = reader_load(p, part, &(struct relume_rect){0, 0, b->codes, 1}, numbers, b->dim,
                             of_planes ? b->first : -1);
    if (!status) {
        book.numbers = numbers;
        relume_book_expand(out, &book, coder->planes);
        *vectors = out;
        out = NULL;
    }
    mem_free(numbers);
    mem_free(out);
    return status;
}

struct index_sink {
    const struct relume_book *book;  // [books]
    uint16_t *index;                 // [books] of the rectangle
    int books;
    struct relume_rect rect;
    atomic_bool wrong;
};

static bool take_indices(uint16_t *to, const uint32_t *from, size_t n, uint32_t codes)
{
    unsigned wrong = 0;
    for (size_t x = 0; x < n; x++) {
        wrong |= from[x] >= codes;
        to[x] = (uint16_t)from[x];
    }
    return !wrong;
}

static void index_block(void *context, const struct relume_rect *at, const void *samples)
{
    struct index_sink *s = context;
    const struct relume_rect *r = &s->rect, some = exr_overlap(at, r);
    for (int y = some.top; y < some.top + some.height; y++)
        for (int b = 0; b < s->books; b++) {
            const void *from = exr_samples(samples, at, &some, y, s->books, b, sizeof(uint32_t));
            const size_t row = (size_t)b * (size_t)r->height + (size_t)(y - r->top);
            uint16_t *to = s->index + row * (size_t)r->width + (some.left - r->left);
            if (!take_indices(to, from, (size_t)some.width, (uint32_t)s->book[b].codes))
                atomic_store(&s->wrong, true);
        }
}

static relume_status load_books(relume_pack *p, struct read_books *set)
{
    relume_status status = RELUME_OK;
    for (int b = 0; !status && b < p->info.books; b++) {
        if (set->vectors[b])
            continue;
        status = load_book(p, set->part[b], &set->book[b], &set->vectors[b]);
        if (!status && b == 0)
            add_mean(p, set->vectors[0], (size_t)set->book[0].codes);
        set->codes[b] = set->book[b].codes + reader_has_nothing(p, set->book[b].codes);
    }
    return status;
}

relume_status reader_load_indices(struct relume_codes_part *to, relume_pack *p, int view,
                                  const struct relume_rect *rect, const struct relume_codes *like)
{
    struct read_books *set = &p->books[p->info.shared ? 0 : view];
    struct index_sink sink = {.book = set->book, .books = p->info.books, .rect = *rect};
    void *data;
    relume_status status = load_books(p, set);
    if (!status)
        status = codes_part_create(to, &data, like, rect->width, rect->height);
    if (status)
        return status;
    sink.index = data;
    status = exr_read(p->file, p->parts[view].codes, rect, p->threads, index_block, &sink, p->log);
    if (!status && atomic_load(&sink.wrong))
        return reader_bad(p, "an index", "indices below the number of code vectors");
    if (!status && p->info.has_mask)
        status = reader_mask_indices(p, view, rect, sink.index);
    to->codes.vectors = (const float *const *)set->vectors;
    to->codes.book_codes = set->codes;
    return status;
}

void reader_drop_books(struct read_books *books)
{
    for (int b = 0; b < RELUME_MOST_BOOKS; b++) {
        mem_free(books->vectors[b]);
        books->vectors[b] = NULL;
    }
}
