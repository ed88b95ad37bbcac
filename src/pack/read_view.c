// read_view.c - the samples of one view: its codes, depth and mask
#include "base/memory.h"
#include "coder/codes.h"
#include "lossy/lossy.h"
#include "pack/format.h"
#include "pack/reader.h"

#include <stdatomic.h>
#include <string.h>

// A part of numbers on its way into memory.
struct loading {
    const relume_pack *pack;
    char *data;  // [planes][height] rows
    int first, planes;
    size_t width, height;
    atomic_bool wrong;
};

static void load_rows(void *context, int row, int rows, const void *samples)
{
    struct loading *l = context;
    const enum relume_storage storage = l->pack->info.storage;
    const struct relume_coder_info *coder = relume_coder_info(l->pack->coder);
    const size_t from = l->width * exr_sample_bytes(codes_sample(storage));
    const size_t to = l->width * relume_storage_bytes(storage);
    for (int y = row; y < row + rows; y++)
        for (int c = 0; c < l->planes; c++, samples = (const char *)samples + from) {
            const int plane = l->first < 0 ? c : format_plane(coder, l->first + c) - l->first;
            char *at = l->data + ((size_t)plane * l->height + (size_t)y) * to;
            if (!codes_from_samples(at, storage, samples, l->width))
                atomic_store(&l->wrong, true);
        }
}

relume_status reader_load(relume_pack *p, int part, void *data, int planes, int first)
{
    const struct exr_part_info info = exr_part_info(p->file, part);
    struct loading l = {
        .pack = p,
        .data = data,
        .first = first,
        .planes = planes,
        .width = (size_t)info.width,
        .height = (size_t)info.height,
    };
    const relume_status status = exr_read(p->file, part, p->threads, load_rows, &l, p->log);
    if (!status && atomic_load(&l.wrong))
        return reader_bad(p, "stored codes", "finite codes of the stated type");
    return status;
}

// Steps of the planes, and of the one of the mask, whose codes are 0 and 1.
static relume_status load_steps(struct loaded *to, const relume_pack *p, int part, size_t planes)
{
    const size_t stored = (size_t)p->info.planes;
    const float *scale = reader_floats(p, part, ATTR_SCALE, p->info.planes);
    const float *offset = reader_floats(p, part, ATTR_OFFSET, p->info.planes);
    to->steps = mem_array(2 * planes, sizeof *to->steps);
    if (!to->steps)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < planes; i++) {
        to->steps[i] = i < stored ? scale[i] : 1.0f;
        to->steps[planes + i] = i < stored ? offset[i] : 0.0f;
    }
    to->codes.scale = to->steps;
    to->codes.offset = to->steps + planes;
    return RELUME_OK;
}

struct word_rows {
    uint32_t *word;
    size_t width;
};

static void load_words(void *context, int row, int rows, const void *samples)
{
    const struct word_rows *to = context;
    memcpy(to->word + (size_t)row * to->width, samples,
           (size_t)rows * to->width * sizeof *to->word);
}

// Planes that were coded with loss, black again where the mask says so.
static relume_status load_coded(relume_pack *p, int view)
{
    const int part = p->parts[view].codes;
    const struct exr_part_info info = exr_part_info(p->file, part);
    const size_t count = (size_t)info.width * (size_t)info.height;
    struct word_rows words = {mem_array(count, sizeof *words.word), (size_t)info.width};
    int *order = lossy_order(p->coder);
    const struct lossy_shape shape = {p->info.width, p->info.height, p->info.planes,
                                      lossy_in_colour(p->coder), order};
    relume_status status = words.word
                               ? exr_read(p->file, part, p->threads, load_words, &words, p->log)
                               : RELUME_ENOMEM;
    if (!status)
        status = lossy_decode(p->loaded[view].data, &shape, words.word, count, p->threads, NULL);
    if (status == RELUME_EDAMAGED)
        status = reader_bad(p, "a tile of the picture is damaged", "sound AV1 data");
    mem_free(words.word);
    mem_free(order);
    return status;
}

relume_status reader_load_planes(relume_pack *p, int view)
{
    struct loaded *to = &p->loaded[view];
    const size_t planes = (size_t)relume_coder_info(p->coder)->planes,
                 stored = (size_t)p->info.planes;
    const size_t plane_bytes =
        (size_t)p->info.width * (size_t)p->info.height * relume_storage_bytes(p->info.storage);
    const int part = p->parts[view].codes;
    to->plane = mem_array(planes, sizeof *to->plane);
    to->data = mem_array(planes, plane_bytes);
    relume_status status = to->plane && to->data ? RELUME_OK : RELUME_ENOMEM;
    for (size_t i = 0; !status && i < planes; i++)
        to->plane[i] = (const char *)to->data + i * plane_bytes;
    if (!status)
        status = p->coded ? load_coded(p, view) : reader_load(p, part, to->data, p->info.planes, 0);
    if (!status && planes > stored)
        status = reader_mask_plane(p, view, (char *)to->data + stored * plane_bytes);
    to->codes.storage = p->info.storage;
    to->codes.plane = to->plane;
    if (!status)
        status = load_steps(to, p, part, planes);
    return !status && p->coded ? reader_mask_codes(p, view) : status;
}

struct plane_sink {
    struct relume_image *image;
    enum exr_sample sample;
};

static void plane_rows(void *context, int row, int rows, const void *samples)
{
    const struct plane_sink *s = context;
    const size_t width = (size_t)s->image->width;
    exr_to_floats(s->image->data + (size_t)row * width, s->sample, samples, (size_t)rows * width);
}

static relume_status read_plane(struct relume_image *out, relume_pack *pack, int part)
{
    *out = (struct relume_image){0};
    if (part < 0)
        return RELUME_OK;
    relume_status status = relume_image_create(out, pack->info.width, pack->info.height, 1);
    if (status)
        return status;
    struct plane_sink sink = {out, exr_part_info(pack->file, part).sample};
    status = exr_read(pack->file, part, pack->threads, plane_rows, &sink, pack->log);
    const size_t n = (size_t)out->width * (size_t)out->height;
    for (size_t i = 0; !status && i < n; i++)
        if (!(out->data[i] >= 0.0f))
            status = reader_bad(pack, "depth or mask", "values of 0 or more");
    if (status)
        relume_image_destroy(out);
    return status;
}

relume_status relume_pack_depth(struct relume_image *out, relume_pack *pack, int view)
{
    *out = (struct relume_image){0};
    if (view < 0 || view >= pack->info.views)
        return RELUME_EINVAL;
    return read_plane(out, pack, pack->parts[view].depth);
}

relume_status relume_pack_mask(struct relume_image *out, relume_pack *pack, int view)
{
    *out = (struct relume_image){0};
    if (view < 0 || view >= pack->info.views)
        return RELUME_EINVAL;
    return read_plane(out, pack, pack->parts[view].mask);
}
