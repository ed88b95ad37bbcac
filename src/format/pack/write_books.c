// write_books.c - codebooks, and the indices into them
#include "format/codebook/books.h"
#include "format/coder/codes.h"
#include "format/coder/coding.h"
#include "format/pack/format.h"
#include "format/pack/pack_write.h"
#include "format/pack/writer.h"

static relume_status index_rows(void *context, int row, int rows, void *samples)
{
    const struct relume_pack_view *view = context;
    const size_t width = (size_t)relume_coefficients_info(view->coefficients)->width;
    const int books = relume_books_info(view->books)->books;
    uint32_t *out = samples;
    for (size_t y = (size_t)row; y < (size_t)(row + rows); y++)
        for (int b = 0; b < books; b++)
            for (size_t x = 0; x < width; x++)
                *out++ = view->index[b][y * width + x];
    return RELUME_OK;
}

void writer_fill_indices(struct exr_part *part, const struct relume_pack_view *view)
{
    static const char *const names[RELUME_MOST_BOOKS] = {"i0", "i1", "i2", "i3",
                                                         "i4", "i5", "i6", "i7"};
    part->sample = EXR_SAMPLE_UINT;
    part->channels = relume_books_info(view->books)->books;
    part->channel = names;
    part->rows = index_rows;
    part->context = (void *)(uintptr_t)view;
}

struct book_source {
    const struct relume_book *book;
    const struct relume_coder_info *coder;
};

static relume_status book_row(void *context, int row, int rows, void *samples)
{
    const struct book_source *s = context;
    const struct relume_book *b = s->book;
    const size_t codes = (size_t)b->codes, number = codes * relume_storage_bytes(b->storage);
    const size_t sample = codes * exr_sample_bytes(codes_sample(b->storage));
    (void)row, (void)rows;
    for (int d = 0; d < b->dim; d++) {
        const int channel =
            b->kind == RELUME_BOOK_PLANES ? format_plane(s->coder, b->first + d) - b->first : d;
        codes_to_samples((char *)samples + (size_t)channel * sample, b->storage,
                         (const char *)b->numbers + (size_t)d * number, codes);
    }
    return RELUME_OK;
}

// Channels of a codebook: those of its planes, or c0000.Y, or c0000.U, c0000.V, ...
static const char *const *book_channels(struct writer *w, const struct relume_book *book)
{
    if (book->kind == RELUME_BOOK_PLANES)
        return w->channels + book->first;
    const char **names = arena_array(&w->arena, (size_t)book->dim, sizeof *names);
    const bool luma = book->kind == RELUME_BOOK_LUMA;
    w->failed |= !names;
    for (int d = 0; names && d < book->dim; d++) {
        names[d] = arena_format(&w->arena, "c%04d.%c", book->first / 3 + (luma ? d : d / 2),
                                luma ? 'Y' : "UV"[d % 2]);
        w->failed |= !names[d];
    }
    return names;
}

static void add_book(struct writer *w, const char *name, const struct relume_book *book)
{
    struct exr_part *part = writer_part(w, name, book->codes, 1);
    struct book_source *source = arena_array(&w->arena, 1, sizeof *source);
    w->failed |= !source;
    if (source)
        *source = (struct book_source){book, w->coder};
    part->sample = codes_sample(book->storage);
    part->channels = book->dim;
    part->channel = book_channels(w, book);
    part->rows = book_row;
    part->context = source;
    writer_text(part, ATTR_BOOK, format_book_kinds[book->kind]);
    writer_int(part, ATTR_FIRST, book->first);
    writer_int(part, ATTR_LAST, book->last);
    writer_floats(w, part, ATTR_SCALE, book->scale, book->dim);
    writer_floats(w, part, ATTR_OFFSET, book->offset, book->dim);
}

void writer_add_books(struct writer *w, const relume_books *books, int view)
{
    const struct relume_books_info *info = relume_books_info(books);
    for (int i = 0; i < info->books; i++)
        add_book(w,
                 view < 0 ? arena_format(&w->arena, "book%d", i)
                          : arena_format(&w->arena, "view%04d.book%d", view, i),
                 &info->book[i]);
}
