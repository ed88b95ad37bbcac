// preview.c - what ordinary EXR viewers show of a relume file: its middle view, relit
#include <relume/encode/pack_encode.h>

#include "core/base/memory.h"
#include "encode/levels/pyramid.h"
#include "format/codebook/books.h"
#include "format/coder/coding.h"
#include "format/pack/pack_write.h"

#include <relume/relight/relight.h>
#include <string.h>

// Rows of the planes, one plane behind the other; `*memory` is the caller's to free.
static relume_status read_planes(struct relume_codes *codes, void **memory,
                                 const relume_coefficients *coefficients, int row)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(coefficients);
    const size_t planes = (size_t)info->planes, rows = (size_t)codes->height;
    const size_t line = (size_t)info->width * relume_storage_bytes(info->storage);
    const void **plane = mem_array(planes, sizeof *plane + (rows + 1) * line);
    if (!(*memory = plane))
        return RELUME_ENOMEM;
    char *data = (char *)(plane + planes), *read = data + planes * rows * line;
    relume_status status = RELUME_OK;
    for (size_t y = 0; !status && y < rows; y++) {
        status = relume_coefficients_read(coefficients, row + (int)y, 1, read);
        for (size_t p = 0; !status && p < planes; p++)
            memcpy(data + (p * rows + y) * line, read + p * line, line);
    }
    for (size_t p = 0; p < planes; p++)
        plane[p] = data + p * rows * line;
    codes->storage = info->storage;
    codes->scale = info->scale;
    codes->offset = info->offset;
    codes->plane = plane;
    return status;
}

static void point_to_books(struct relume_codes *codes, const uint16_t **index,
                           const struct relume_pack_view *view, int row)
{
    const struct relume_books_info *info = relume_books_info(view->books);
    for (int b = 0; b < info->books; b++)
        index[b] = view->index[b] + (size_t)row * (size_t)codes->width;
    codes->books = info->books;
    codes->index = index;
    codes->vectors = info->vectors;
    codes->book_codes = info->codes;
}

static struct relume_vec3 front_of(const struct relume_pack_contents *c, int slab)
{
    const bool pole_y = relume_coder_info(c->coder)->pole_y;
    return c->slabs ? c->slab[slab].pose.axis[2] : (struct relume_vec3){0.0, pole_y, !pole_y};
}

relume_status relume_pack_preview(void *contents, int row, int rows, float *rgb)
{
    const struct relume_pack_contents *c = contents;
    const struct relume_pack_view *view = &c->view[c->views / 2];
    const struct relume_light light = {.direction = front_of(c, view->slab), .rgb = {1, 1, 1}};
    const int level = relume_pack_shown(view);
    const relume_coefficients *coefficients =
        level ? view->levels->level[level - 1] : view->coefficients;
    const struct relume_image *mask = level ? &view->levels->share[level - 1] : view->mask;
    const struct relume_coefficients_info *info = relume_coefficients_info(coefficients);
    const size_t width = (size_t)info->width, pixels = (size_t)rows * width;
    struct relume_image out = {info->width, rows, 3, .data = rgb};
    struct relume_codes codes = {
        .coder = c->coder,
        .domain = c->domain,
        .display = c->display,
        .width = info->width,
        .height = rows,
        .planes = info->planes,
    };
    const uint16_t *index[RELUME_MOST_BOOKS];
    void *memory = NULL;
    relume_status status = RELUME_OK;
    if (view->books && !level)
        point_to_books(&codes, index, view, row);
    else
        status = read_planes(&codes, &memory, coefficients, row);
    if (!status)
        status = relume_relight(&out, &codes, &light, 1,
                                relume_relight_params(.threads = 1, .cpu_off = ~0u));
    for (size_t i = 0; mask && mask->data && i < pixels; i++)
        if (!(mask->data[(size_t)row * width + i] > 0.5f))
            memset(rgb + 3 * i, 0, 3 * sizeof *rgb);
    mem_free(memory);
    return status;
}
