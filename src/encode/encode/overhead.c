// overhead.c - bytes of a lossy file other than words of planes
//
// Files are measured whose views have a word of planes each, with what is asked for beside it.
#include "encode/encode/overhead.h"

#include "core/base/memory.h"
#include "encode/levels/pyramid.h"
#include "format/pack/pack_write.h"
#include "format/pack/size.h"

enum content { HEADS, EXTRAS, PREVIEW, MODELS };

// Puts the views of the groups `first` .. `end` into the file, or only their anchors unless extras
// are measured.
static void choose_views(struct relume_pack_view *view, const struct overhead *o, int first,
                         int end, enum content with)
{
    static const uint32_t word[1];
    const struct contents *f = o->f;
    for (int i = 0; i < f->views; i++) {
        view[i] = f->view[i];
        view[i].levels = NULL;
        if (with != MODELS)
            view[i].shadow = view[i].gloss = NULL;
    }
    for (int i = o->groups->begin[first]; i < o->groups->begin[end]; i++) {
        struct relume_pack_view *v = &view[o->groups->view[i]];
        if (with == EXTRAS)
            v->levels = f->view[o->groups->view[i]].levels;
        else
            v->depth = v->mask = NULL;
        if (with == EXTRAS || !v->predicted) {
            v->coded = word;
            v->coded_words = 1;
        }
    }
}

static relume_status measure(double *bytes, const struct overhead *o, int first, int end,
                             enum content with)
{
    const struct contents *f = o->f;
    struct relume_pack_contents contents;
    struct relume_pack_view *view = mem_array((size_t)f->views, sizeof *view);
    uint64_t size = 0;
    if (!view)
        return RELUME_ENOMEM;
    choose_views(view, o, first, end, with);
    contents_describe(&contents, f);
    contents.view = view;
    contents.preview = with == PREVIEW ? relume_pack_preview : NULL;
    const relume_status status =
        pack_size(&size, &contents,
                  relume_pack_params(.log = f->p->log, .compression = f->p->compression,
                                     .threads = f->p->threads));
    *bytes = (double)size;
    mem_free(view);
    return status;
}

relume_status overhead_create(struct overhead *out, const struct contents *f,
                              const struct view_groups *groups)
{
    *out = (struct overhead){.f = f, .groups = groups};
    return measure(&out->header, out, 0, 1, HEADS);
}

relume_status overhead_heads(double *bytes, const struct overhead *o)
{
    return measure(bytes, o, 0, o->groups->count, HEADS);
}

static relume_status measure_more(double *bytes, const struct overhead *o, int group,
                                  enum content with)
{
    const relume_status status = measure(bytes, o, group, group + 1, with);
    *bytes -= o->header;
    return status;
}

relume_status overhead_extras(double *bytes, const struct overhead *o, int group)
{
    return measure_more(bytes, o, group, EXTRAS);
}

relume_status overhead_preview(double *bytes, const struct overhead *o)
{
    return measure_more(bytes, o, 0, PREVIEW);
}

relume_status overhead_models(double *bytes, const struct overhead *o)
{
    return measure_more(bytes, o, 0, MODELS);
}
