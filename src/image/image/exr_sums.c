// exr_sums.c - the check sums of an EXR file
#include "image/image/exr_sums.h"

#include "core/base/memory.h"

#include <zlib.h>

// Of a row of the part, so that it is not too high; and the most rows.
enum { ROW_WORDS = 2048, MOST_ROWS = 65536 };

relume_status exr_sums_create(struct exr_sums *out, int parts)
{
    *out = (struct exr_sums){.first = mem_zeroed((size_t)parts + 1, sizeof *out->first)};
    if (!out->first)
        return RELUME_ENOMEM;
    out->first[0] = 1;
    return RELUME_OK;
}

void exr_sums_count(struct exr_sums *s, size_t blocks)
{
    s->first[s->parts + 1] = s->first[s->parts] + blocks;
    s->parts++;
}

relume_status exr_sums_finish(struct exr_sums *s)
{
    const size_t words = s->first[s->parts] + 1, rows = (words + ROW_WORDS - 1) / ROW_WORDS;
    s->height = (int)(rows < MOST_ROWS ? rows : MOST_ROWS);
    s->width = (int)((words + (size_t)s->height - 1) / (size_t)s->height);
    s->word = mem_zeroed((size_t)s->width * (size_t)s->height, sizeof *s->word);
    return s->word ? RELUME_OK : RELUME_ENOMEM;
}

void exr_sums_destroy(struct exr_sums *s)
{
    mem_free(s->word);
    mem_free(s->first);
    *s = (struct exr_sums){.word = NULL};
}

uint32_t exr_sum(uint32_t before, const void *bytes, size_t size)
{
    return (uint32_t)crc32_z(before, bytes, size);
}

uint32_t exr_sums_own(const struct exr_sums *s)
{
    const size_t words = (size_t)s->width * (size_t)s->height;
    return exr_sum(0, s->word, (words - 1) * sizeof *s->word);
}
