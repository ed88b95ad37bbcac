// write_coded.c - what is coded with loss: planes, in a part for each group of views, and what was
// learnt of the pixels of a view
#include "core/base/memory.h"
#include "format/lossy/disparity.h"
#include "format/pack/format.h"
#include "format/pack/learnt.h"
#include "format/pack/pack_write.h"
#include "format/pack/words.h"
#include "format/pack/writer.h"

#include <string.h>

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

// The words of the planes and of the depth of a view, which follow those of the last.
static void add_view(struct writer *w, struct word_run *run, int member, const char **members,
                     float *step, int index)
{
    const struct relume_pack_view *view = &w->contents->view[index];
    const struct lossy_words depth = depth_words(w, view, &step[member]);
    run[2 * member] = (struct word_run){.count = view->coded_words, .word = view->coded};
    run[2 * member + 1] = (struct word_run){.count = depth.count, .word = depth.word};
    *members = arena_format(&w->arena, FORMAT_MEMBER, *members ? *members : "", index,
                            view->coded_words, depth.count);
    w->failed |= !*members;
}

void writer_fill_words(struct writer *w, struct exr_part *part, const uint32_t *word, size_t count)
{
    struct word_rows *words = arena_array(&w->arena, 1, sizeof *words);
    struct word_run *run = arena_array(&w->arena, 1, sizeof *run);
    w->failed |= !words || !run;
    if (w->failed)
        return;
    *run = (struct word_run){.count = count, .word = word};
    *words = (struct word_rows){.run = run, .runs = 1};
    words_fill(part, words);
}

// Which tiles of its views a part of the work has.
static void add_tiles(struct writer *w, struct exr_part *part, const struct relume_pack_view *view)
{
    struct lossy_held held;
    w->failed |= lossy_look(&held, view->coded, view->coded_words) != RELUME_OK;
    writer_doubles(w, part, ATTR_TILES, (const double[]){held.first, held.end, held.count}, 3);
}

// The anchor and the views that are predicted from it.
static void add_group(struct writer *w, int group, int anchor)
{
    const struct relume_pack_contents *c = w->contents;
    struct word_rows *words = arena_array(&w->arena, 1, sizeof *words);
    float *step = arena_array(&w->arena, (size_t)c->views, sizeof *step);
    struct word_run *run = arena_array(&w->arena, 2 * (size_t)c->views, sizeof *run);
    struct exr_part *part = writer_part(w, arena_format(&w->arena, "group%04d", group), 1, 1);
    const char *members = NULL;
    int count = 0;
    w->failed |= !words || !step || !run;
    if (w->failed)
        return;
    add_view(w, run, count++, &members, step, anchor);
    for (int v = 0; v < c->views; v++)
        if (c->view[v].predicted && c->view[v].anchor == anchor && c->view[v].coded)
            add_view(w, run, count++, &members, step, v);
    *words = (struct word_rows){.run = run, .runs = 2 * count};
    words_fill(part, words);
    writer_text(part, ATTR_GROUP, members);
    writer_floats(w, part, ATTR_STEP, step, count);
    if (c->slabs)
        writer_int(part, ATTR_MEMBER, c->view[anchor].slab);
    if (c->share)
        add_tiles(w, part, &c->view[anchor]);
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
