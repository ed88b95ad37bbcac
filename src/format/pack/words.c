// words.c - words as the rows of a part of an EXR file
#include "format/pack/words.h"

#include "format/pack/format.h"

#include <string.h>

// Rows are short, so that few more are read than a view needs, and the part is not too high.
enum { ROW_WORDS = 2048, MOST_ROWS = 65536 };

static size_t rows_of(size_t words)
{
    const size_t rows = (words + ROW_WORDS - 1) / ROW_WORDS;
    return rows < MOST_ROWS ? rows : MOST_ROWS;
}

static relume_status fill_rows(void *context, int row, int rows, void *samples)
{
    const struct word_rows *w = context;
    const size_t from = (size_t)row * w->width, to = from + (size_t)rows * w->width;
    uint32_t *out = samples;
    size_t at = 0;
    relume_status status = RELUME_OK;
    memset(out, 0, (to - from) * sizeof *out);
    for (int i = 0; !status && i < w->runs; at += w->run[i++].count) {
        const struct word_run *run = &w->run[i];
        const size_t begin = at > from ? at : from;
        const size_t end = at + run->count < to ? at + run->count : to;
        if (begin >= end)
            continue;
        if (run->word)
            memcpy(out + begin - from, run->word + begin - at, (end - begin) * sizeof *out);
        else
            status = words_read(out + begin - from, run->file, run->part, run->first + begin - at,
                                end - begin, 1, w->log);
    }
    return status;
}

void words_fill(struct exr_part *part, struct word_rows *words)
{
    static const char *const channel[] = {CODING_AV1};
    words->count = 0;
    for (int i = 0; i < words->runs; i++)
        words->count += words->run[i].count;
    const size_t rows = rows_of(words->count);
    words->width = (words->count + rows - 1) / rows;
    part->codec = EXR_CODEC_NONE;
    part->sample = EXR_SAMPLE_UINT;
    part->width = (int)words->width;
    part->height = (int)rows;
    part->channels = 1;
    part->channel = channel;
    part->rows = fill_rows;
    part->context = words;
}

struct reading {
    uint32_t *word;  // [count]
    size_t first, count, width;
};

static void load_words(void *context, const struct relume_rect *at, const void *samples)
{
    const struct reading *to = context;
    const size_t from = (size_t)at->top * to->width, last = to->first + to->count;
    const size_t begin = from > to->first ? from : to->first;
    const size_t rows_end = from + (size_t)at->height * to->width;
    const size_t end = rows_end < last ? rows_end : last;
    if (begin < end)
        memcpy(to->word + (begin - to->first), (const uint32_t *)samples + (begin - from),
               (end - begin) * sizeof *to->word);
}

relume_status words_read(uint32_t *to, const exr_file *file, int part, size_t first, size_t count,
                         int threads, const struct relume_log *log)
{
    const size_t width = (size_t)exr_part_info(file, part).width;
    const size_t row = first / width, end = (first + count + width - 1) / width;
    const struct relume_rect rows = {0, (int)row, (int)width, (int)(end - row)};
    struct reading reading = {to, first, count, width};
    return count ? exr_read(file, part, &rows, threads, load_words, &reading, log) : RELUME_OK;
}
