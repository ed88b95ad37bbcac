// books.c - codebooks on the GPU: indices stay, the vectors are relit for every light
#include "relit/books.h"

#include "gl/target.h"
#include "relight/light/refit.h"

#include <stdlib.h>
#include <string.h>

void books_forget(struct relume_codes *kept)
{
    for (int b = 0; kept->vectors && b < kept->books; b++)
        free((void *)(uintptr_t)kept->vectors[b]);
    free((void *)(uintptr_t)kept->vectors);
    free((void *)(uintptr_t)kept->book_codes);
    *kept = (struct relume_codes){0};
}

relume_status books_keep(struct relume_codes *kept, const struct relume_codes *codes)
{
    const size_t books = (size_t)codes->books;
    float **vectors = calloc(books, sizeof *vectors);
    int *counts = calloc(books, sizeof *counts);
    bool good = vectors && counts;
    *kept = *codes;
    kept->index = NULL;
    kept->vectors = (const float *const *)vectors;
    kept->book_codes = counts;
    for (size_t b = 0; good && b < books; b++) {
        const size_t bytes = (size_t)codes->book_codes[b] * (size_t)codes->planes * sizeof(float);
        counts[b] = codes->book_codes[b];
        vectors[b] = malloc(bytes);
        good = vectors[b] != NULL;
        if (good)
            memcpy(vectors[b], codes->vectors[b], bytes);
    }
    if (!good)
        books_forget(kept);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

size_t books_bytes(const struct relume_codes *codes)
{
    return (size_t)codes->books * (size_t)codes->width * (size_t)codes->height * sizeof(uint16_t);
}

void books_upload(const struct gl *gl, const struct relume_codes *codes)
{
    gl->TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R16UI, codes->width, codes->height, codes->books, 0,
                   GL_RED_INTEGER, GL_UNSIGNED_SHORT, NULL);
    texture_settings(gl, GL_TEXTURE_2D_ARRAY);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int b = 0; b < codes->books; b++)
        gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, b, codes->width, codes->height, 1,
                          GL_RED_INTEGER, GL_UNSIGNED_SHORT, codes->index[b]);
}

relume_status books_relight(const struct gl *gl, const struct relume_codes *codes,
                            const struct relume_light *lights, int n,
                            const relume_weight_grid *grid)
{
    int rows = 1;
    for (int b = 0; b < codes->books; b++) {
        const int needs = (codes->book_codes[b] + TABLE_WIDTH - 1) / TABLE_WIDTH;
        rows = needs > rows ? needs : rows;
    }
    float *table = calloc((size_t)rows * TABLE_WIDTH, 3 * sizeof *table);
    if (!table)
        return RELUME_ENOMEM;
    gl->TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGB32F, TABLE_WIDTH, rows, codes->books, 0, GL_RGB,
                   GL_FLOAT, NULL);
    texture_settings(gl, GL_TEXTURE_2D_ARRAY);
    relume_status status = RELUME_OK;
    for (int b = 0; !status && b < codes->books; b++) {
        status =
            relume_relight_book(table, codes, b, lights, n, relume_relight_params(.grid = grid));
        if (!status)
            gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, b, TABLE_WIDTH, rows, 1, GL_RGB,
                              GL_FLOAT, table);
    }
    free(table);
    return status;
}
