// document.c - the table of kinds of documents, and what all of them share
#include "session/document.h"
#include "cli/program/output_name.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// In the order in which they are asked: the last one takes every path, and says what is wrong.
static const struct document_kind *const document_kinds[] = {
    &document_nothing, &document_scene, &document_maps, &document_objects, &document_pack,
};

const struct document_kind *document_kind_of(const char *path, const struct object_set *objects)
{
    const size_t last = sizeof document_kinds / sizeof *document_kinds - 1;
    size_t i = 0;
    while (i < last && !document_kinds[i]->is(path, objects))
        i++;
    return document_kinds[i];
}

void document_close(struct document *d)
{
    pack_source_destroy(&d->source);
    if (d->relief)
        relume_relief_destroy(d->relief);
    free(d->relief);
    relume_pack_destroy(&d->pack);
    relume_slab_set_destroy(&d->slabs);
    if (d->kind && d->kind->close)
        d->kind->close(d);
    *d = (struct document){.kind = NULL};
}

void document_set_path(struct document *d, const char *path)
{
    const char *slash = strrchr(path, '/');
    snprintf(d->path, sizeof d->path, "%s", path);
    snprintf(d->name, sizeof d->name, "%s", path_name(path));
    snprintf(d->folder, sizeof d->folder, "%.*s", slash && slash > path ? (int)(slash - path) : 1,
             slash ? path : ".");
}

void document_add_line(struct document *d, const char *format, ...)
{
    va_list args;
    if (d->lines == DOCUMENT_LINES)
        return;
    va_start(args, format);
    vsnprintf(d->line[d->lines++], DOCUMENT_TEXT, format, args);
    va_end(args);
}

void document_describe_edits(struct document *d, const relume_edits *edits)
{
    const int count = relume_edits_count(edits), apply = count - relume_edits_undone(edits);
    size_t at = 0;
    snprintf(d->edits, sizeof d->edits, "no edits");
    for (int i = 0; i < count && at < sizeof d->edits; i++) {
        char text[160];
        relume_edit_text(relume_edits_get(edits, i), text, sizeof text);
        at += (size_t)snprintf(d->edits + at, sizeof d->edits - at, "%s%s%s", i ? "\n" : "", text,
                               i < apply ? "" : " (undone)");
    }
}
