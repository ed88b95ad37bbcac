// edit_options.c - operations on the command line, in their order
#include "edit_options.h"

#include <string.h>

// The operation that an option names; NULL: none.
static const struct relume_edit_operation *operation_of(const struct given *g)
{
    return strncmp(g->option->name, "--", 2) ? NULL
                                             : relume_edit_operation_find(g->option->name + 2);
}

// Whether an option is a parameter of any operation.
static bool is_parameter(const struct given *g)
{
    for (const struct relume_edit_operation *const *o = relume_edit_operations; *o; o++)
        for (int i = 0; relume_edit_operation_parameter(*o, i); i++)
            if (!strncmp(g->option->name, "--", 2) &&
                !strcmp(relume_edit_operation_parameter(*o, i), g->option->name + 2))
                return true;
    return false;
}

bool edit_is_asked(const struct args *args, const struct edit_options *o)
{
    bool asked = o->undo || o->redo || o->clear;
    for (int i = 0; i < args->line->given_count; i++)
        asked |= operation_of(&args->line->given[i]) || is_parameter(&args->line->given[i]);
    return asked;
}

// The edit that options are still added to.
struct pending {
    relume_edits *edits;
    struct relume_edit edit;
    const struct relume_log *log;
};

static relume_status flush(struct pending *p)
{
    const relume_status status =
        p->edit.operation ? relume_edits_add(p->edits, &p->edit, p->log) : RELUME_OK;
    relume_edit_destroy(&p->edit);
    p->edit = (struct relume_edit){.operation = NULL};
    return status;
}

static relume_status begin(struct pending *p, const struct relume_edit_operation *operation,
                           const char *text)
{
    const relume_status status = flush(p);
    p->edit = relume_edit_of(operation);
    return status ? status
                  : relume_edit_set(&p->edit, relume_edit_operation_parameter(operation, 0), text,
                                    p->log);
}

static relume_status step(struct pending *p, const char *name, bool (*move)(relume_edits *edits))
{
    const relume_status status = flush(p);
    return status || move(p->edits)
               ? status
               : usage_error("%s: there is no edit left to %s", name, name + 2);
}

static bool takes(const struct relume_edit_operation *operation, const char *parameter)
{
    for (int i = 1; relume_edit_operation_parameter(operation, i); i++)
        if (!strcmp(relume_edit_operation_parameter(operation, i), parameter))
            return true;
    return false;
}

static relume_status set(struct pending *p, const struct given *g)
{
    const char *name = g->option->name;
    if (!p->edit.operation)
        return usage_error("%s: comes after the operation that it is for", name);
    if (!takes(p->edit.operation, name + 2))
        return usage_error(
            "%s: stands behind --%s, which takes none; give it behind what it is for", name,
            relume_edit_operation_name(p->edit.operation));
    return relume_edit_set(&p->edit, name + 2, g->text, p->log);
}

relume_status edit_list_of_line(relume_edits **out, uint64_t fingerprint, const struct args *args,
                                const struct edit_options *o)
{
    relume_status status = o->clear
                               ? relume_edits_create(out, fingerprint)
                               : relume_edits_open(out, args->input[0], fingerprint, args->log);
    struct pending p = {.edits = *out, .log = args->log};
    for (int i = 0; !status && i < args->line->given_count; i++) {
        const struct given *g = &args->line->given[i];
        if (operation_of(g))
            status = begin(&p, operation_of(g), g->text);
        else if (is_parameter(g))
            status = set(&p, g);
        else if (!strcmp(g->option->name, "--undo"))
            status = step(&p, g->option->name, relume_edits_undo);
        else if (!strcmp(g->option->name, "--redo"))
            status = step(&p, g->option->name, relume_edits_redo);
    }
    if (!status)
        status = flush(&p);
    relume_edit_destroy(&p.edit);
    if (status)
        relume_edits_destroy(out);
    return status;
}

// ---------------------------------------------------------------- the list

static void print_list(const relume_edits *edits)
{
    const int count = relume_edits_count(edits);
    for (int i = 0; i < count; i++) {
        char text[512];
        relume_edit_text(relume_edits_get(edits, i), text, sizeof text);
        printf("%-3d %s%s\n", i + 1, text,
               i < count - relume_edits_undone(edits) ? "" : " (undone)");
    }
    if (!count)
        puts("no edits");
}

static void print_json(const relume_edits *edits)
{
    const int count = relume_edits_count(edits);
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_integer(&w, "edits", count);
    jput_integer(&w, "undone", relume_edits_undone(edits));
    jopen_array(&w, "list");
    for (int i = 0; i < count; i++) {
        const struct relume_edit *e = relume_edits_get(edits, i);
        char text[512];
        relume_edit_text(e, text, sizeof text);
        jopen_object(&w, NULL);
        jput_text(&w, "operation", relume_edit_operation_name(e->operation));
        jput_truth(&w, "undone", i >= count - relume_edits_undone(edits));
        jput_text(&w, "text", text);
        jclose(&w);
    }
    jend(&w);
}

relume_status edit_list_end(const relume_edits *edits, const struct args *args,
                            const struct edit_options *o)
{
    const bool changed = edit_is_asked(args, o);
    const relume_status status =
        changed ? relume_edits_save(edits, args->input[0], args->log) : RELUME_OK;
    if (status)
        return status;
    if (o->json)
        print_json(edits);
    else if (o->list)
        print_list(edits);
    const int undone = relume_edits_undone(edits), apply = relume_edits_count(edits) - undone;
    if (changed)
        announce(args, RELUME_NOTE, "%s: %d edit%s appl%s, %d undone", args->input[0], apply,
                 relume_plural(apply), apply == 1 ? "ies" : "y", undone);
    return RELUME_OK;
}
