// writer.c - coefficients become a relume file
#include "format/pack/writer.h"

#include "core/base/names.h"
#include "core/base/params.h"
#include "format/pack/format.h"
#include "format/pack/pack_write.h"
#include "format/pack/size.h"
#include "format/pack/views.h"

enum { MOST_ATTRIBUTES = 48 };

static const char *const compressions[] = {[RELUME_COMPRESS_NONE] = "none",
                                           [RELUME_COMPRESS_RLE] = "rle",
                                           [RELUME_COMPRESS_ZIP] = "zip",
                                           [RELUME_COMPRESS_PIZ] = "piz"};
static const enum exr_codec codecs[] = {[RELUME_COMPRESS_DEFAULT] = EXR_CODEC_PIZ,
                                        [RELUME_COMPRESS_NONE] = EXR_CODEC_NONE,
                                        [RELUME_COMPRESS_RLE] = EXR_CODEC_RLE,
                                        [RELUME_COMPRESS_ZIP] = EXR_CODEC_ZIP,
                                        [RELUME_COMPRESS_PIZ] = EXR_CODEC_PIZ};

relume_status relume_compression_parse(enum relume_compression *out, const char *name)
{
    const int i = name_find(name, compressions, sizeof compressions / sizeof *compressions);
    *out = (enum relume_compression)(i < 0 ? 0 : i);
    return i < 0 ? RELUME_EINVAL : RELUME_OK;
}

struct exr_part *writer_part(struct writer *w, const char *name, int width, int height)
{
    struct exr_part *part = &w->parts[w->count++];
    *part = (struct exr_part){
        .name = name,
        .width = width,
        .height = height,
        .codec = w->codec,
        .attribute = arena_array(&w->arena, MOST_ATTRIBUTES, sizeof *part->attribute),
    };
    w->failed |= !name || !part->attribute;
    return part;
}

static void add(struct exr_part *part, struct exr_attribute attribute)
{
    if (part->attribute && part->attributes < MOST_ATTRIBUTES)
        ((struct exr_attribute *)(uintptr_t)part->attribute)[part->attributes] = attribute;
    part->attributes++;
}

void writer_int(struct exr_part *part, const char *name, int value)
{
    add(part, (struct exr_attribute){.name = name, .kind = EXR_INT, .integer = value});
}

void writer_text(struct exr_part *part, const char *name, const char *text)
{
    add(part, (struct exr_attribute){.name = name, .kind = EXR_TEXT, .text = text});
}

void writer_floats(struct writer *w, struct exr_part *part, const char *name, const float *floats,
                   int count)
{
    w->failed |= !floats;
    add(part,
        (struct exr_attribute){.name = name, .kind = EXR_FLOATS, .floats = floats, .count = count});
}

void writer_doubles(struct writer *w, struct exr_part *part, const char *name, const double *from,
                    int count)
{
    float *to = arena_array(&w->arena, (size_t)count, sizeof *to);
    for (int i = 0; to && i < count; i++)
        to[i] = (float)from[i];
    writer_floats(w, part, name, to, count);
}

// "c007.R" and so on, in the order in which the file sorts them.
static const char **channel_names(struct writer *w)
{
    const struct relume_coder_info *info = w->coder;
    const char **names = arena_array(&w->arena, (size_t)info->planes, sizeof *names);
    for (int p = 0; names && p < info->planes; p++) {
        const bool colour = info->luminance && p >= info->coefficients;
        const char *name = colour
                               ? arena_format(&w->arena, "colour.%c", "RGB"[p - info->coefficients])
                           : info->joint ? arena_format(&w->arena, "c%04d", p)
                                         : arena_format(&w->arena, "c%04d.%c", p / 3, "RGB"[p % 3]);
        w->failed |= !name;
        names[format_plane(info, p)] = name;
    }
    return names;
}

static bool shares_books(const struct relume_pack_contents *c)
{
    for (int i = 0; i < c->views; i++)
        if (!c->view[i].books || c->view[i].books != c->view[0].books)
            return false;
    return true;
}

bool writer_is_coded(const struct relume_pack_contents *contents)
{
    bool coded = contents->share && contents->share->coded;
    for (int i = 0; i < contents->views; i++)
        coded |= contents->view[i].coded != NULL;
    return coded;
}

// Views whose words are not here belong to other parts.
static void add_coded(struct writer *w)
{
    const struct relume_pack_contents *c = w->contents;
    writer_add_groups(w);
    for (int i = 0; i < c->views; i++)
        if (c->view[i].coded)
            writer_add_view(w, i, false);
    for (int i = 0; i < c->views; i++)
        if (c->view[i].coded)
            writer_add_levels(w, i);
}

static relume_status add_parts(struct writer *w, const struct relume_pack_params *p)
{
    const struct relume_pack_contents *c = w->contents;
    const int first = c->share ? c->share->first : 0;
    const bool shared = c->share ? c->share->shared_books : shares_books(c);
    writer_add_header(w);
    if (writer_is_coded(c)) {
        add_coded(w);
    } else {
        if (shared)
            writer_add_books(w, c->view[first].books, -1);
        for (int i = first; i < first + (c->share ? c->share->views : c->views); i++)
            writer_add_view(w, i, shared);
    }
    relume_status status = RELUME_OK;
    for (int i = 0; !status && !c->share && i < c->views; i++)
        status = writer_add_learnt(w, i, p);
    return status;
}

// Whether a part was given more attributes than it can hold: rather no file than half of one.
static bool is_crowded(const struct writer *w)
{
    for (int i = 0; i < w->count; i++)
        if (w->parts[i].attributes > MOST_ATTRIBUTES)
            return true;
    return false;
}

// The parts of a file; `w` is to be freed also on failure.
static relume_status make_parts(struct writer *w, const struct relume_pack_contents *contents,
                                const struct relume_pack_params *p)
{
    const size_t most_parts =
        1 + (4 + RELUME_MOST_BOOKS + 2 * RELUME_MOST_LEVELS) * (size_t)contents->views;
    *w = (struct writer){
        .contents = contents,
        .coder = relume_coder_info(contents->coder),
        .codec = codecs[p->compression],
    };
    w->parts = arena_array(&w->arena, most_parts, sizeof *w->parts);
    w->channels = channel_names(w);
    w->failed |= !w->parts || !w->channels;
    const relume_status status = w->failed ? RELUME_ENOMEM : add_parts(w, p);
    return !status && (w->failed || is_crowded(w)) ? RELUME_ENOMEM : status;
}

relume_status relume_pack_write(const struct relume_pack_contents *contents, const char *path,
                                const struct relume_pack_params *params)
{
    const struct relume_pack_params p = PARAMS_WORK(relume_pack_params, params);
    struct writer w;
    if (!path && !p.writer)
        return RELUME_EINVAL;
    relume_status status = make_parts(&w, contents, &p);
    if (!status)
        status = exr_write(path, p.writer, w.parts, w.count, true, p.threads, p.log);
    arena_free(&w.arena);
    return status;
}

relume_status pack_size(uint64_t *bytes, const struct relume_pack_contents *contents,
                        const struct relume_pack_params *params)
{
    const struct relume_pack_params p = PARAMS_WORK(relume_pack_params, params);
    struct writer w;
    relume_status status = make_parts(&w, contents, &p);
    if (!status)
        status = exr_size(bytes, w.parts, w.count, p.threads, p.log);
    arena_free(&w.arena);
    return status;
}
