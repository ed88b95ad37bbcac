// edits_file.c - a list of edits on disk (docs/editing.md)
//
// Drawings and masks are in the file, not beside it: a list stays what it is when pictures change,
// and names no file.
#include "material/gbrdf/edits.h"

#include "core/base/infile.h"
#include "core/base/json.h"
#include "core/base/json_write.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "material/gbrdf/drawing.h"
#include "material/gbrdf/edit_table.h"
#include "material/gbrdf/operations.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { VERSION = 1 };

char *edits_name(const char *path)
{
    const size_t n = strlen(path);
    return n > 4 && !strcasecmp(path + n - 4, ".exr")
               ? mem_format("%.*s.edits.json", (int)(n - 4), path)
               : mem_format("%s/edits.json", path);
}

// ---------------------------------------------------------------- writing

static void put_picture(struct jwriter *w, const char *key, const struct relume_image *image)
{
    char *text = drawing_text(image);
    if (!text)
        jfail(w, RELUME_ENOMEM);
    jopen_object(w, key);
    jput_integer(w, "width", image->width);
    jput_integer(w, "height", image->height);
    jput_text(w, "packed", text);
    jclose(w);
    mem_free(text);
}

static void put_labels(struct jwriter *w, const char *key, const int *label, int count)
{
    if (count == 1) {
        jput_integer(w, key, *label);
        return;
    }
    jopen_array(w, key);
    for (int i = 0; i < count; i++)
        jput_integer(w, NULL, label[i]);
    jclose(w);
}

static void put_value(struct jwriter *w, const struct edit_parameter *p,
                      const struct relume_edit *edit)
{
    const void *value = parameter_of(p, edit);
    switch (p->kind) {
    case PARAMETER_NUMBERS:
        if (p->count > 1)
            jput_numbers(w, p->name, value, (size_t)p->count, 0);
        else
            jput_number(w, p->name, *(const double *)value, 0);
        break;
    case PARAMETER_LABELS: put_labels(w, p->name, value, p->count); break;
    case PARAMETER_CHANNELS: jput_text(w, p->name, value); break;
    case PARAMETER_PICTURE: put_picture(w, p->name, value); break;
    }
}

static void put_edit(struct jwriter *w, const struct relume_edit *edit)
{
    const struct relume_edit_operation *o = edit->operation;
    jgap(w, "\n");
    jopen_object(w, NULL);
    jput_text(w, "operation", o->name);
    for (int k = 0; k < MOST_PARAMETERS && o->parameter[k]; k++)
        if (!o->parameter[k]->optional || parameter_given(o->parameter[k], edit))
            put_value(w, o->parameter[k], edit);
    jclose(w);
}

relume_status relume_edits_save(const relume_edits *edits, const char *path,
                                const struct relume_log *log)
{
    char *name = edits_name(path), fingerprint[17];
    struct jwriter w = {.status = name ? RELUME_OK : RELUME_ENOMEM};
    snprintf(fingerprint, sizeof fingerprint, "%016llx", (unsigned long long)edits->fingerprint);
    jopen_object(&w, NULL);
    jput_integer(&w, "relumeEdits", VERSION);
    jput_text(&w, "fingerprint", fingerprint);
    jput_integer(&w, "undone", edits->undone);
    jgap(&w, "\n");
    jopen_array(&w, "operations");
    for (int i = 0; i < edits->count; i++)
        put_edit(&w, &edits->edit[i]);
    const relume_status status = jsave(&w, name, log);
    mem_free(name);
    return status;
}

// ---------------------------------------------------------------- reading

static relume_status read_picture(struct relume_image *out, const jvalue *value,
                                  const struct edit_parameter *p, const struct relume_log *log)
{
    const char *text = jvalue_text(jvalue_member(value, "packed"));
    int width = 0, height = 0;
    relume_status status;
    if (!text || !jvalue_whole(jvalue_member(value, "width"), 1, RELUME_EDIT_MOST_SIDE, &width) ||
        !jvalue_whole(jvalue_member(value, "height"), 1, RELUME_EDIT_MOST_SIDE, &height) ||
        !drawing_from_text(out, width, height, text, &status))
        return log_wrong(log, NULL, p->name,
                         "width and height up to 1024, and so many packed pixels");
    return status;
}

static bool read_labels(int *out, const jvalue *value, int count)
{
    for (int i = 0; i < count; i++)
        if (!jvalue_whole(count > 1 ? jvalue_item(value, (size_t)i) : value, 0,
                          GBRDF_MOST_MATERIALS - 1, &out[i]))
            return false;
    return count == 1 || jvalue_count(value) == (size_t)count;
}

static relume_status read_value(struct relume_edit *edit, const jvalue *value,
                                const struct edit_parameter *p, const struct relume_log *log)
{
    void *out = parameter_of(p, edit);
    const char *text = jvalue_text(value);
    bool good = false;
    switch (p->kind) {
    case PARAMETER_NUMBERS:
        good =
            p->count > 1 ? jvalue_numbers(value, out, (size_t)p->count) : jvalue_number(value, out);
        break;
    case PARAMETER_LABELS: good = read_labels(out, value, p->count); break;
    case PARAMETER_CHANNELS: good = text && snprintf(out, 4, "%s", text) == 3; break;
    case PARAMETER_PICTURE: return read_picture(out, value, p, log);
    }
    return good && parameter_is_good(p, edit) ? RELUME_OK : log_wrong(log, NULL, p->name, p->form);
}

// What is not known would be lost, or mean something else.
static relume_status check_members(const jvalue *value, const struct relume_edit_operation *o,
                                   const struct relume_log *log)
{
    const char *known[MOST_PARAMETERS + 2] = {"operation"};
    for (int k = 0; k < MOST_PARAMETERS && o->parameter[k]; k++)
        known[k + 1] = o->parameter[k]->name;
    const char *other = jvalue_unknown(value, known);
    return other ? log_fail(log, RELUME_EFORMAT, "has no '%s'; made by a newer relume?", other)
                 : RELUME_OK;
}

static relume_status read_edit(struct relume_edit *edit, size_t number, const jvalue *value,
                               const struct relume_log *log)
{
    const char *name = jvalue_text(jvalue_member(value, "operation"));
    const struct relume_edit_operation *o = name ? relume_edit_operation_find(name) : NULL;
    if (!o)
        return log_fail(log, RELUME_EFORMAT,
                        "edit %zu: operation; expected the name of one that this relume has%s%s%s",
                        number, name ? "; found '" : "", name ? name : "", name ? "'" : "");
    struct log_place place;
    const struct relume_log *at = log_at(&place, log, "edit %zu, %s: ", number, name);
    *edit = relume_edit_of(o);
    relume_status status = check_members(value, o, at);
    for (int k = 0; !status && k < MOST_PARAMETERS && o->parameter[k]; k++) {
        const struct edit_parameter *p = o->parameter[k];
        const jvalue *member = jvalue_member(value, p->name);
        if (member || !p->optional)
            status = read_value(edit, member, p, at);
    }
    return status;
}

static bool read_fingerprint(uint64_t *out, const jvalue *root)
{
    const char *text = jvalue_text(jvalue_member(root, "fingerprint"));
    unsigned long long number = 0;
    if (!text || strlen(text) != 16 || strspn(text, "0123456789abcdef") != 16 ||
        sscanf(text, "%llx", &number) != 1)
        return false;
    *out = number;
    return true;
}

static relume_status read_list(relume_edits *edits, const jvalue *root,
                               const struct relume_log *log)
{
    const jvalue *operations = jvalue_member(root, "operations");
    int version = 0;
    if (!jvalue_whole(jvalue_member(root, "relumeEdits"), 1, 1000, &version))
        return log_wrong(log, NULL, "no list of edits", "\"relumeEdits\": 1");
    if (version != VERSION)
        return log_fail(log, RELUME_EUNSUPPORTED, "expected version %d; found %d", VERSION,
                        version);
    if (!read_fingerprint(&edits->fingerprint, root))
        return log_wrong(log, NULL, "fingerprint", "16 hexadecimal digits");
    if (!jvalue_is_array(operations) || jvalue_count(operations) > RELUME_EDIT_MOST)
        return log_wrong(log, NULL, "operations", "a list of at most 256");
    if (!jvalue_whole(jvalue_member(root, "undone"), 0, (long long)jvalue_count(operations),
                      &edits->undone))
        return log_wrong(log, NULL, "undone", "at most as many as there are operations");
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && i < jvalue_count(operations); i++) {
        if (!mem_grow(&edits->edit, i, sizeof *edits->edit))
            return RELUME_ENOMEM;
        edits->edit[i] = (struct relume_edit){.operation = NULL};
        edits->count++;
        status = read_edit(&edits->edit[i], i + 1, jvalue_item(operations, i), log);
    }
    return status;
}

relume_status relume_edits_open(relume_edits **out, const char *path, uint64_t fingerprint,
                                const struct relume_log *log)
{
    jvalue *root = NULL;
    relume_status status = relume_edits_create(out, fingerprint);
    if (status)
        return status;
    char *name = (*out)->file = edits_name(path);
    struct log_place place;
    struct relume_log quiet = log ? *log : (struct relume_log){0};
    quiet.leave_unnoted = true;  // the next list takes its place
    if (!name)
        status = RELUME_ENOMEM;
    else if (input_exists(name, log)) {
        status = jvalue_load(&root, name, &quiet);
        if (!status)
            status = read_list(*out, root, log_at(&place, log, "%s: ", name));
        if (!status)
            status = edits_check(*out, fingerprint, path, log);
    }
    jvalue_free(&root);
    if (status)
        relume_edits_destroy(out);
    return status;
}
