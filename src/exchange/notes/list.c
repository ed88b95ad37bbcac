// list.c - a list of notes in memory
#include "exchange/notes/list.h"

#include "core/base/json.h"
#include "core/base/memory.h"
#include "core/math/fnv.h"

#include <math.h>
#include <string.h>
#include <strings.h>

static const struct {
    const char *name;
    int least, most;  // places
} kinds[] = {
    [RELUME_NOTE_POINT] = {"point", 1, 1},
    [RELUME_NOTE_LINE] = {"line", 2, RELUME_NOTE_MOST_PLACES},
    [RELUME_NOTE_POLYGON] = {"polygon", 3, RELUME_NOTE_MOST_PLACES},
    [RELUME_NOTE_VIEW] = {"view", 0, 0},
};

const char *relume_note_kind_name(enum relume_note_kind kind)
{
    return kinds[kind].name;
}

relume_status relume_note_kind_parse(enum relume_note_kind *out, const char *name)
{
    for (int k = 0; k <= RELUME_NOTE_VIEW; k++)
        if (!strcmp(name, kinds[k].name)) {
            *out = (enum relume_note_kind)k;
            return RELUME_OK;
        }
    return RELUME_EINVAL;
}

char *notes_name(const char *path)
{
    const size_t n = strlen(path);
    const bool exr = n > 4 && !strcasecmp(path + n - 4, ".exr");
    return mem_format("%.*s.notes.json", (int)(exr ? n - 4 : n), path);
}

const char *notes_scale_name(const relume_notes *notes)
{
    return notes->solid ? "relume:mmPerUnit" : "relume:mmPerPixel";
}

static double diagonal(const double box[2][3])
{
    return hypot(hypot(box[1][0] - box[0][0], box[1][1] - box[0][1]), box[1][2] - box[0][2]);
}

relume_status relume_notes_create(relume_notes **out, const struct relume_notes_file *file)
{
    *out = NULL;
    if (file->solid ? !(diagonal(file->box) > 0.0)
                    : file->width < 1 || file->height < 1 || file->views < 1)
        return RELUME_EINVAL;
    relume_notes *n = mem_zeroed(1, sizeof *n);
    if (!n)
        return RELUME_ENOMEM;
    n->width = file->width;
    n->height = file->height;
    n->views = file->views;
    n->inside = file->inside != NULL;
    n->solid = file->solid;
    memcpy(n->box, file->box, sizeof n->box);
    n->name = mem_text(file->name ? file->name : "");
    if (!n->name)
        relume_notes_destroy(&n);
    *out = n;
    return n ? RELUME_OK : RELUME_ENOMEM;
}

void notes_forget(struct kept_note *kept)
{
    const struct relume_note *n = &kept->note;
    mem_free((void *)n->place);
    mem_free((void *)n->z);
    mem_free((char *)n->text);
    mem_free((char *)n->state);
    mem_free((char *)n->creator);
    mem_free((char *)n->created);
    mem_free((char *)n->id);
    mem_free(kept->raw);
    *kept = (struct kept_note){.raw = NULL};
}

void relume_notes_destroy(relume_notes **notes)
{
    relume_notes *n = *notes;
    *notes = NULL;
    if (!n)
        return;
    for (int i = 0; i < n->count; i++)
        notes_forget(&n->note[i]);
    mem_free(n->note);
    mem_free(n->slot);
    mem_free(n->name);
    mem_free(n);
}

// ---------------------------------------------------------------- ids

static size_t slot_of(const relume_notes *n, const char *id)
{
    const uint64_t hash = fnv_of_text(id);
    return (size_t)(hash ^ hash >> 32) & (n->slots - 1);
}

// N of "nN" below a thousand million, else 0.
static int number_of(const char *id)
{
    const bool is = *id == 'n' && strspn(id + 1, "0123456789") == strlen(id + 1) && strlen(id) < 10;
    return is ? (int)strtol(id + 1, NULL, 10) : 0;
}

static void enter(relume_notes *n, int i)
{
    const char *id = n->note[i].note.id;
    size_t at = slot_of(n, id);
    while (n->slot[at])
        at = (at + 1) & (n->slots - 1);
    n->slot[at] = i + 1;
    if (number_of(id) > n->last)
        n->last = number_of(id);
}

static void enter_all(relume_notes *n)
{
    n->last = 0;
    memset(n->slot, 0, n->slots * sizeof *n->slot);
    for (int i = 0; i < n->count; i++)
        enter(n, i);
}

// Memory for one more, at most half of the slots taken.
static bool grow_slots(relume_notes *n)
{
    enum { LEAST = 64 };
    if (2 * ((size_t)n->count + 1) <= n->slots)
        return true;
    const size_t slots = n->slots ? 2 * n->slots : LEAST;
    int *slot = mem_array(slots, sizeof *slot);
    if (!slot)
        return false;
    mem_free(n->slot);
    n->slot = slot;
    n->slots = slots;
    enter_all(n);
    return true;
}

int relume_notes_find(const relume_notes *notes, const char *id)
{
    if (!notes->slots)
        return -1;
    for (size_t at = slot_of(notes, id); notes->slot[at]; at = (at + 1) & (notes->slots - 1))
        if (!strcmp(notes->note[notes->slot[at] - 1].note.id, id))
            return notes->slot[at] - 1;
    return -1;
}

// ---------------------------------------------------------------- adding

static bool text_is_good(const char *text)
{
    return !text || (strlen(text) <= RELUME_NOTE_MOST_TEXT && jvalue_may_hold(text));
}

// One size of the picture beside it: notes on a part of a picture that was cut stay.
static bool within(const struct relume_note *note, int i, const relume_notes *n)
{
    const double place[3] = {note->place[i][0], note->place[i][1], n->solid ? note->z[i] : 0.0};
    const double size[2] = {n->width, n->height}, across = diagonal(n->box);
    for (int k = 0; k < 2 + n->solid; k++) {
        const double low = n->solid ? n->box[0][k] - across : -size[k];
        const double high = n->solid ? n->box[1][k] + across : 2.0 * size[k];
        if (!(place[k] >= low && place[k] <= high))
            return false;
    }
    return true;
}

static relume_status far_beside(const struct relume_note *note, int i, const relume_notes *n,
                                const struct relume_log *log)
{
    if (n->solid)
        return log_fail(log, RELUME_EINVAL, "the place %g,%g,%g lies far beside the object",
                        note->place[i][0], note->place[i][1], note->z[i]);
    return log_fail(log, RELUME_EINVAL,
                    "the place %g,%g lies far beside the picture of %d x %d pixels",
                    note->place[i][0], note->place[i][1], n->width, n->height);
}

static relume_status check(const relume_notes *n, const struct relume_note *note,
                           const struct relume_log *log)
{
    if (n->count == RELUME_NOTES_MOST)
        return log_fail(log, RELUME_EINVAL, "a list holds at most %d notes", RELUME_NOTES_MOST);
    if (note->places < kinds[note->kind].least || note->places > kinds[note->kind].most)
        return log_fail(log, RELUME_EINVAL, "a %s has %d to %d places; found %d",
                        kinds[note->kind].name, kinds[note->kind].least, kinds[note->kind].most,
                        note->places);
    if (note->places && n->solid != (note->z != NULL))
        return log_fail(log, RELUME_EINVAL, "%s",
                        n->solid ? "a place of two coordinates; expected x, y and z of the object"
                                 : "a place in space; expected x and y of the picture");
    for (int i = 0; i < note->places; i++)
        if (!within(note, i, n))
            return far_beside(note, i, n, log);
    const char *const texts[] = {note->text, note->state, note->creator, note->created, note->id};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        if (!text_is_good(texts[i]))
            return log_fail(log, RELUME_EINVAL, "expected text in UTF-8, at most %d bytes of it",
                            RELUME_NOTE_MOST_TEXT);
    return RELUME_OK;
}

static char *new_id(const relume_notes *n)
{
    for (int number = n->last + 1;; number++) {
        char *id = mem_format("n%d", number);
        if (!id || relume_notes_find(n, id) < 0)
            return id;
        mem_free(id);
    }
}

static bool copy_text(const char **out, const char *text)
{
    *out = text ? mem_text(text) : NULL;
    return !text || *out;
}

relume_status notes_append(relume_notes *n, const struct relume_note *note, char *raw,
                           const struct relume_log *log)
{
    const relume_status status = check(n, note, log);
    if (status)
        return status;
    struct kept_note kept = {.note = {.kind = note->kind, .places = note->places}};
    struct relume_note *own = &kept.note;
    double(*place)[2] = mem_array((size_t)note->places, sizeof *place);
    for (int i = 0; place && i < note->places; i++)
        memcpy(place[i], note->place[i], sizeof place[i]);
    own->place = (const double(*)[2])place;
    own->z = note->z ? mem_copy(note->z, (size_t)note->places, sizeof *note->z) : NULL;
    own->id = note->id ? mem_text(note->id) : new_id(n);
    if (!own->place || (note->z && !own->z) || !own->id || !copy_text(&own->text, note->text) ||
        !copy_text(&own->state, note->state) || !copy_text(&own->creator, note->creator) ||
        !copy_text(&own->created, note->created) ||
        !mem_grow(&n->note, (size_t)n->count, sizeof *n->note) || !grow_slots(n)) {
        notes_forget(&kept);
        return RELUME_ENOMEM;
    }
    kept.raw = raw;
    n->note[n->count++] = kept;
    enter(n, n->count - 1);
    return RELUME_OK;
}

relume_status relume_notes_add(relume_notes *notes, const struct relume_note *note,
                               const struct relume_log *log)
{
    if (note->id && relume_notes_find(notes, note->id) >= 0)
        return log_fail(log, RELUME_EINVAL, "there is a note '%s' already", note->id);
    return notes_append(notes, note, NULL, log);
}

relume_status relume_notes_rewrite(relume_notes *notes, int i, const char *text,
                                   const struct relume_log *log)
{
    struct kept_note *kept = &notes->note[i];
    const char *copy;
    if (!text_is_good(text))
        return log_fail(log, RELUME_EINVAL, "expected text in UTF-8, at most %d bytes of it",
                        RELUME_NOTE_MOST_TEXT);
    if (!copy_text(&copy, text))
        return RELUME_ENOMEM;
    mem_free((char *)kept->note.text);
    kept->note.text = copy;
    mem_free(kept->raw);
    kept->raw = NULL;
    return RELUME_OK;
}

void relume_notes_remove(relume_notes *notes, int i)
{
    notes_forget(&notes->note[i]);
    notes->count--;
    memmove(&notes->note[i], &notes->note[i + 1], (size_t)(notes->count - i) * sizeof *notes->note);
    enter_all(notes);
}

int relume_notes_count(const relume_notes *notes)
{
    return notes->count;
}

const struct relume_note *relume_notes_get(const relume_notes *notes, int i)
{
    return &notes->note[i].note;
}

double relume_notes_scale(const relume_notes *notes)
{
    return notes->mm_per_pixel;
}

relume_status relume_notes_set_scale(relume_notes *notes, double mm_per_pixel)
{
    if (!(mm_per_pixel >= 0.0) || !isfinite(mm_per_pixel))
        return RELUME_EINVAL;
    notes->mm_per_pixel = mm_per_pixel;
    return RELUME_OK;
}
