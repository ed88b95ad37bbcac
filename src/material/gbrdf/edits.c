// edits.c - a list of edits, of which the last may be undone
#include "material/gbrdf/edits.h"

#include "core/base/memory.h"
#include "material/gbrdf/drawing.h"
#include "material/gbrdf/edit_table.h"
#include "material/gbrdf/operations.h"

#include <string.h>

relume_status relume_edits_create(relume_edits **out, uint64_t fingerprint)
{
    *out = mem_zeroed(1, sizeof **out);
    if (!*out)
        return RELUME_ENOMEM;
    (*out)->fingerprint = fingerprint;
    return RELUME_OK;
}

static void forget(relume_edits *edits, int n)
{
    for (int i = 0; i < n; i++)
        relume_edit_destroy(&edits->edit[--edits->count]);
}

void relume_edits_destroy(relume_edits **edits)
{
    relume_edits *e = *edits;
    *edits = NULL;
    if (!e)
        return;
    forget(e, e->count);
    mem_free(e->edit);
    mem_free(e->file);
    mem_free(e);
}

relume_status edits_check(const relume_edits *edits, uint64_t fingerprint, const char *path,
                          const struct relume_log *log)
{
    if (edits->fingerprint == fingerprint)
        return RELUME_OK;
    return log_fail(log, RELUME_EUNFIT,
                    "%s: these edits are for another version of %s (fingerprint %016llx; found "
                    "%016llx); bring that one back, or drop the edits with --clear",
                    edits->file ? edits->file : "edits", path ? path : "what is edited",
                    (unsigned long long)edits->fingerprint, (unsigned long long)fingerprint);
}

relume_status relume_edits_add(relume_edits *edits, const struct relume_edit *edit,
                               const struct relume_log *log)
{
    const struct edit_parameter *fault = edit_fault(edit);
    struct relume_edit own = *edit;
    if (fault)
        return edit_refuse(edit->operation, fault, NULL, log);
    if (edits->count - edits->undone == RELUME_EDIT_MOST)
        return log_fail(log, RELUME_EINVAL,
                        "a list holds at most %d edits; write a file with them "
                        "and edit that",
                        RELUME_EDIT_MOST);
    own.drawing = own.mask = (struct relume_image){.width = 0};
    relume_status status = drawing_keep(&own.drawing, &edit->drawing);
    if (!status)
        status = drawing_keep(&own.mask, &edit->mask);
    if (!status) {
        forget(edits, edits->undone);
        edits->undone = 0;
        if (!mem_grow(&edits->edit, (size_t)edits->count, sizeof *edits->edit))
            status = RELUME_ENOMEM;
    }
    if (status)
        relume_edit_destroy(&own);
    else
        edits->edit[edits->count++] = own;
    return status;
}

bool relume_edits_undo(relume_edits *edits)
{
    const bool can = edits->undone < edits->count;
    edits->undone += can;
    return can;
}

bool relume_edits_redo(relume_edits *edits)
{
    const bool can = edits->undone > 0;
    edits->undone -= can;
    return can;
}

int relume_edits_count(const relume_edits *edits)
{
    return edits->count;
}

int relume_edits_undone(const relume_edits *edits)
{
    return edits->undone;
}

const struct relume_edit *relume_edits_get(const relume_edits *edits, int i)
{
    return &edits->edit[i];
}

const struct relume_log *edit_log(struct log_place *out, const relume_edits *edits, int number,
                                  const struct relume_log *to)
{
    return log_at(out, to, "%s%sedit %d, %s: ", edits->file ? edits->file : "",
                  edits->file ? ": " : "", number + 1, edits->edit[number].operation->name);
}
