// codes.c - stored coefficients: the kinds of codes by name and bound, and codes as numbers. Nobody
// else needs to know how a code lies in memory.
#include <relume/coder.h>

#include "base/memory.h"
#include "coder/codes.h"
#include "image/half.h"

#include <string.h>

static const struct {
    const char *name;
    int top;
} kinds[] = {
    [RELUME_STORE_8] = {"8", 255},     [RELUME_STORE_10] = {"10", 1023},
    [RELUME_STORE_12] = {"12", 4095},  [RELUME_STORE_16] = {"16", 65535},
    [RELUME_STORE_HALF] = {"half", 0}, [RELUME_STORE_FLOAT] = {"float", 0},
    [RELUME_STORE_LOG] = {"log", 0},
};

const char *relume_storage_name(enum relume_storage storage)
{
    return kinds[storage].name;
}

int relume_storage_top(enum relume_storage storage)
{
    return kinds[storage].top;
}

relume_status relume_storage_parse(enum relume_storage *out, const char *name)
{
    for (size_t i = 1; i < sizeof kinds / sizeof *kinds; i++)
        if (!strcmp(kinds[i].name, name)) {
            *out = (enum relume_storage)i;
            return RELUME_OK;
        }
    return RELUME_EINVAL;
}

void codes_restore(float *out, enum relume_storage storage, const void *codes, size_t first,
                   size_t n, float scale, float offset)
{
    const uint8_t *bytes = (const uint8_t *)codes + first;
    const uint16_t *words = (const uint16_t *)codes + first;
    const float *floats = (const float *)codes + first;
    if (storage == RELUME_STORE_8)
        for (size_t i = 0; i < n; i++)
            out[i] = bytes[i];
    else if (storage == RELUME_STORE_HALF)
        for (size_t i = 0; i < n; i++)
            out[i] = float_from_half(words[i]);
    else if (storage == RELUME_STORE_FLOAT)
        memcpy(out, floats, n * sizeof *out);
    else
        for (size_t i = 0; i < n; i++)
            out[i] = words[i];
    for (size_t i = 0; i < n; i++)
        out[i] = out[i] * scale + offset;
}

void relume_codes_plane(const struct relume_codes *codes, int plane, size_t first, size_t n,
                        float *out)
{
    if (!codes->books) {
        codes_restore(out, codes->storage, codes->plane[plane], first, n, codes->scale[plane],
                      codes->offset[plane]);
        return;
    }
    memset(out, 0, n * sizeof *out);
    for (int b = 0; b < codes->books; b++) {
        const uint16_t *index = codes->index[b] + first;
        const float *vectors = codes->vectors[b] + plane;
        for (size_t i = 0; i < n; i++)
            out[i] += vectors[(size_t)index[i] * (size_t)codes->planes];
    }
}

// ---------------------------------------------------------------- some of the pixels

void relume_codes_part_destroy(struct relume_codes_part *part)
{
    free(part->memory);
    *part = (struct relume_codes_part){.memory = NULL};
}

relume_status relume_codes_pick(struct relume_codes_part *out, const struct relume_codes *codes,
                                size_t first, size_t step, size_t n)
{
    const bool books = codes->books;
    const size_t size = books ? sizeof(uint16_t) : relume_storage_bytes(codes->storage);
    const size_t rows = (size_t)(books ? codes->books : codes->planes);
    const size_t row = (n * size + 3) / 4 * 4;  // rows of floats are aligned
    char *memory = mem_array(rows, sizeof(void *) + row);
    *out = (struct relume_codes_part){*codes, memory};
    out->codes.width = (int)n;
    out->codes.height = 1;
    if (!memory)
        return RELUME_ENOMEM;
    const void **plane = (const void **)(void *)memory;
    for (size_t r = 0; r < rows; r++) {
        char *to = memory + rows * sizeof *plane + r * row;
        const char *from = books ? (const char *)codes->index[r] : codes->plane[r];
        from += first * size;
        if (step == 1)
            memcpy(to, from, n * size);
        for (size_t i = 0; step != 1 && i < n; i++)
            memcpy(to + i * size, from + i * step * size, size);
        plane[r] = to;
    }
    if (books)
        out->codes.index = (const uint16_t *const *)(void *)memory;
    else
        out->codes.plane = plane;
    return RELUME_OK;
}
