// write_coded.c - what is coded with loss: planes, in a part for each group of views, and what was
// learnt of the pixels of a view
#include "base/memory.h"
#include "lossy/disparity.h"
#include "pack/format.h"
#include "pack/learnt.h"
#include "pack/writer.h"

#include <string.h>

// What a part holds: the words of the planes and of the depth of a view, view after view.
struct words {
    struct lossy_words *run;  // [runs], some of them empty
    int runs;
    size_t count, width;
};

// Rows are short, so that few more are read than a view needs, and the part is not too high.
enum { ROW_WORDS = 2048, MOST_ROWS = 65536 };

static size_t rows_of(size_t words)
{
    const size_t rows = (words + ROW_WORDS - 1) / ROW_WORDS;
    return rows < MOST_ROWS ? rows : MOST_ROWS;
}

static relume_status words_rows(void *context, int row, int rows, void *samples)
{
    const struct words *w = context;
    const size_t from = (size_t)row * w->width, to = from + (size_t)rows * w->width;
    uint32_t *out = samples;
    size_t at = 0;
    memset(out, 0, (to - from) * sizeof *out);
    for (int i = 0; i < w->runs; at += w->run[i++].count) {
        const size_t begin = at > from ? at : from;
        const size_t end = at + w->run[i].count < to ? at + w->run[i].count : to;
        if (begin < end)
            memcpy(out + begin - from, w->run[i].word + begin - at, (end - begin) * sizeof *out);
    }
    return RELUME_OK;
}

// Words become the writer's.
static struct lossy_words keep(struct writer *w, struct lossy_words *made)
{
    struct lossy_words kept = {arena_array(&w->arena, made->count, sizeof *kept.word), made->count};
    w->failed |= !kept.word;
    if (kept.word)
        memcpy(kept.word, made->word, made->count * sizeof *kept.word);
    mem_free(made->word);
    return kept.word ? kept : (struct lossy_words){0};
}

// Depth that is coded; the words are the writer's.
static struct lossy_words depth_words(struct writer *w, const struct relume_pack_view *view,
                                      float *step)
{
    const struct relume_pack_contents *c = w->contents;
    struct lossy_words made = {0};
    struct relume_image depth = {0};
    if (!view->depth || !(view->depth_step > 0.0f))
        return made;
    *step = view->depth_step;
    relume_status status = relume_image_create(&depth, view->depth->width, view->depth->height, 1);
    if (!status) {
        memcpy(depth.data, view->depth->data,
               (size_t)depth.width * (size_t)depth.height * sizeof *depth.data);
        format_turn_depth(&depth, c->slabs ? &c->slab[view->slab] : &c->geometry, view->uv, true);
        status = disparity_encode(&made, step, &depth);
    }
    relume_image_destroy(&depth);
    w->failed |= status != RELUME_OK;
    return status ? made : keep(w, &made);
}

static void add_view(struct writer *w, struct words *to, const char **members, float *step,
                     int index)
{
    const struct relume_pack_view *view = &w->contents->view[index];
    const int member = to->runs / 2;
    struct lossy_words *run = to->run + to->runs;
    run[0] = (struct lossy_words){(uint32_t *)(uintptr_t)view->coded, view->coded_words};
    run[1] = depth_words(w, view, &step[member]);
    to->runs += 2;
    to->count += run[0].count + run[1].count;
    *members = arena_format(&w->arena, FORMAT_MEMBER, *members ? *members : "", index, run[0].count,
                            run[1].count);
    w->failed |= !*members;
}

static void fill(struct exr_part *part, struct words *words)
{
    static const char *const channel[] = {CODING_AV1};
    const size_t rows = rows_of(words->count);
    words->width = (words->count + rows - 1) / rows;
    part->codec = EXR_CODEC_NONE;
    part->sample = EXR_SAMPLE_UINT;
    part->width = (int)words->width;
    part->height = (int)rows;
    part->channels = 1;
    part->channel = channel;
    part->rows = words_rows;
    part->context = words;
}

void writer_fill_words(struct writer *w, struct exr_part *part, const uint32_t *word, size_t count)
{
    struct words *words = arena_array(&w->arena, 1, sizeof *words);
    struct lossy_words *run = arena_array(&w->arena, 1, sizeof *run);
    w->failed |= !words || !run;
    if (w->failed)
        return;
    *run = (struct lossy_words){(uint32_t *)(uintptr_t)word, count};
    *words = (struct words){.run = run, .runs = 1, .count = count};
    fill(part, words);
}

// The anchor and the views that are predicted from it.
static void add_group(struct writer *w, int group, int anchor)
{
    const struct relume_pack_contents *c = w->contents;
    struct words *words = arena_array(&w->arena, 1, sizeof *words);
    float *step = arena_array(&w->arena, (size_t)c->views, sizeof *step);
    struct lossy_words *run = arena_array(&w->arena, 2 * (size_t)c->views, sizeof *run);
    struct exr_part *part = writer_part(w, arena_format(&w->arena, "group%04d", group), 1, 1);
    const char *members = NULL;
    w->failed |= !words || !step || !run;
    if (w->failed)
        return;
    words->run = run;
    add_view(w, words, &members, step, anchor);
    for (int v = 0; v < c->views; v++)
        if (c->view[v].predicted && c->view[v].anchor == anchor && c->view[v].coded)
            add_view(w, words, &members, step, v);
    fill(part, words);
    writer_text(part, ATTR_GROUP, members);
    writer_floats(w, part, ATTR_STEP, step, words->runs / 2);
    if (c->slabs)
        writer_int(part, ATTR_MEMBER, c->view[anchor].slab);
}

void writer_add_groups(struct writer *w)
{
    int groups = w->contents->share ? w->contents->share->group : 0;
    for (int v = 0; v < w->contents->views; v++)
        if (!w->contents->view[v].predicted && w->contents->view[v].coded)
            add_group(w, groups++, v);
}

// What a model may take where nobody says it, of the bytes of a pixel.
static const double USUAL_BYTES = 0.5;

static relume_status add_learnt(struct writer *w, const char *name, int view,
                                const struct relume_image *model, enum learnt_kind kind,
                                const struct relume_pack_params *p)
{
    struct learnt_steps *steps = model ? arena_array(&w->arena, 1, sizeof *steps) : NULL;
    struct lossy_words words;
    if (!steps)
        return model ? RELUME_ENOMEM : RELUME_OK;
    const double asked = w->contents->view[view].model_bytes;
    const double bytes = asked > 0.0 ? asked : USUAL_BYTES * model->width * model->height;
    const relume_status status =
        learnt_encode(&words, steps, model, kind, bytes, p->threads, p->log);
    if (status)
        return status;
    words = keep(w, &words);
    struct exr_part *part =
        writer_part(w, arena_format(&w->arena, "view%04d.%s", view, name), 1, 1);
    writer_fill_words(w, part, words.word, words.count);
    writer_floats(w, part, ATTR_SCALE, steps->scale, LEARNT);
    writer_floats(w, part, ATTR_OFFSET, steps->offset, LEARNT);
    return RELUME_OK;
}

relume_status writer_add_learnt(struct writer *w, int index, const struct relume_pack_params *p)
{
    const struct relume_pack_view *view = &w->contents->view[index];
    const relume_status status = add_learnt(w, "shadows", index, view->shadow, LEARNT_SHADOW, p);
    return status ? status : add_learnt(w, "highlights", index, view->gloss, LEARNT_GLOSS, p);
}
