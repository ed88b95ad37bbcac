// crop.c - notes on a part of their picture
#include "exchange/notes/list.h"

#include "capture/manifest/provenance.h"
#include "core/base/memory.h"

#include <math.h>
#include <relume/pack.h>
#include <string.h>

static relume_status create(relume_notes **out, const relume_notes *like, int width, int height)
{
    const struct relume_notes_file file = {
        .name = like->name, .width = width, .height = height, .views = like->views};
    const relume_status status = relume_notes_create(out, &file);
    if (!status) {
        (*out)->inside = like->inside;
        (*out)->mm_per_pixel = like->mm_per_pixel;
    }
    return status;
}

// Returns whether the box around a note meets the part.
static bool meets(const struct relume_note *note, const struct relume_rect *part)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < note->places; i++)
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], note->place[i][k]);
            high[k] = fmax(high[k], note->place[i][k]);
        }
    return !note->places ||
           (low[0] <= part->left + part->width && low[1] <= part->top + part->height &&
            high[0] >= part->left && high[1] >= part->top);
}

// RELUME_EINVAL for a note too far from the part.
static relume_status move(relume_notes *to, const struct relume_note *note,
                          const struct relume_rect *part)
{
    struct relume_note moved = *note;
    double(*place)[2] = mem_array((size_t)note->places, sizeof *place);
    if (!place)
        return RELUME_ENOMEM;
    for (int i = 0; i < note->places; i++) {
        place[i][0] = note->place[i][0] - part->left;
        place[i][1] = note->place[i][1] - part->top;
    }
    moved.place = (const double(*)[2])place;
    const relume_status status = notes_append(to, &moved, NULL, NULL);
    mem_free(place);
    return status;
}

static relume_status keep(relume_notes *to, const struct kept_note *kept)
{
    char *raw = kept->raw ? mem_text(kept->raw) : NULL;
    relume_status status = kept->raw && !raw ? RELUME_ENOMEM : RELUME_OK;
    if (!status)
        status = notes_append(to, &kept->note, raw, NULL);
    if (status)
        mem_free(raw);
    return status;
}

relume_status relume_notes_crop(relume_notes **inside, relume_notes **outside,
                                const relume_notes *notes, const struct relume_rect *part)
{
    *inside = *outside = NULL;
    if (notes->solid || part->width < 1 || part->height < 1)
        return RELUME_EINVAL;
    relume_status status = create(inside, notes, part->width, part->height);
    if (!status)
        status = create(outside, notes, notes->width, notes->height);
    for (int i = 0; !status && i < notes->count; i++) {
        const struct kept_note *kept = &notes->note[i];
        status = meets(&kept->note, part) ? move(*inside, &kept->note, part) : RELUME_EINVAL;
        if (status == RELUME_EINVAL)
            status = keep(*outside, kept);
    }
    if (status) {
        relume_notes_destroy(inside);
        relume_notes_destroy(outside);
    }
    return status;
}

bool relume_notes_part(struct relume_rect *part, const struct relume_pack_info *from,
                       const struct relume_pack_info *to)
{
    struct provenance was, is;
    provenance_read(&was, from->provenance);
    provenance_read(&is, to->provenance);
    *part = (struct relume_rect){is.part.left - was.part.left, is.part.top - was.part.top,
                                 to->width, to->height};
    return *was.photograph && !strcmp(was.photograph, is.photograph) && from->views == to->views;
}
