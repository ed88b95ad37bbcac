// session_edits.c - edits of the g-BRDF that is shown (relume/material/edit.h), kept beside its
// file
#include "session/session.h"

#include "cli/program/say.h"

#include <relume/material/edit.h>
#include <stdio.h>
#include <string.h>

bool session_can_edit(const struct session *s)
{
    if (s->found.width)
        return true;
    return !s->pack && s->app.file.objects && s->material[0] &&
           !strcmp(relume_objects_info(s->objects)->material[0].model, "gbrdf");
}

const char *session_unquote(char *name)
{
    const size_t n = strlen(name);
    if (n < 2 || name[0] != '"' || name[n - 1] != '"')
        return name;
    name[n - 1] = '\0';
    return name + 1;
}

// The next word, which quotes may hold together; NULL at the end.
static char *next_word(char **at)
{
    char *word = *at + strspn(*at, " \t");
    if (!*word)
        return NULL;
    const bool quoted = *word == '"';
    word += quoted;
    char *end = word + strcspn(word, quoted ? "\"" : " \t");
    *at = end + (*end != '\0');
    *end = '\0';
    return word;
}

// OPERATION VALUE [PARAMETER VALUE ...]
static relume_status add_words(relume_edits *edits, char *words, const struct relume_log *log)
{
    const char *name = next_word(&words), *value = next_word(&words);
    const struct relume_edit_operation *o = name ? relume_edit_operation_find(name) : NULL;
    if (!o || !value)
        return say(log, RELUME_EINVAL,
                   "expected undo, redo or an operation with a value, as in 'roughness 0.6 label "
                   "1'; found '%s'",
                   name ? name : "");
    struct relume_edit edit = relume_edit_of(o);
    relume_status status =
        relume_edit_set(&edit, relume_edit_operation_parameter(o, 0), value, log);
    while (!status && (name = next_word(&words))) {
        value = next_word(&words);
        status = value ? relume_edit_set(&edit, name, value, log)
                       : say(log, RELUME_EINVAL, "%s: expected a value", name);
    }
    if (!status)
        status = relume_edits_add(edits, &edit, log);
    relume_edit_destroy(&edit);
    return status;
}

relume_status session_change_edits(relume_edits *edits, char *words, const struct relume_log *log)
{
    const bool undo = !strcmp(words, "undo"), redo = !strcmp(words, "redo");
    if ((undo && !relume_edits_undo(edits)) || (redo && !relume_edits_redo(edits)))
        return say(log, RELUME_EINVAL, "there is no edit left to %s", words);
    return undo || redo ? RELUME_OK : add_words(edits, words, log);
}

void session_describe_edits(struct session *s, const relume_edits *edits)
{
    const int count = relume_edits_count(edits), apply = count - relume_edits_undone(edits);
    size_t at = 0;
    snprintf(s->edits, sizeof s->edits, "no edits");
    for (int i = 0; i < count && at < sizeof s->edits; i++) {
        char text[160];
        relume_edit_text(relume_edits_get(edits, i), text, sizeof text);
        at += (size_t)snprintf(s->edits + at, sizeof s->edits - at, "%s%s%s", i ? "\n" : "", text,
                               i < apply ? "" : " (undone)");
    }
}

// Change the list as the words say, NULL: not at all; it is kept once the g-BRDF takes it.
static relume_status change_list(struct session *s, const char *words, const struct relume_log *log)
{
    char copy[APP_SPEC];
    relume_btf_fitted *model, *edited = NULL;
    relume_edits *edits = NULL;
    snprintf(copy, sizeof copy, "%s", words ? words : "");
    relume_status status = relume_btf_fitted_open(&model, s->material,
                                                  relume_btf_params(.log = log, .unedited = true));
    if (!status)
        status = relume_edits_open(&edits, s->material, relume_btf_fitted_fingerprint(model), log);
    if (!status && words)
        status = session_change_edits(edits, copy, log);
    if (!status)
        status = relume_btf_fitted_edit(&edited, model, edits, log);
    if (!status && words)
        status = relume_edits_save(edits, s->material, log);
    if (!status) {
        session_describe_edits(s, edits);
        s->edited_materials = relume_btf_fitted_info(edited)->clusters;
    }
    relume_btf_fitted_destroy(&edited);
    relume_edits_destroy(&edits);
    relume_btf_fitted_destroy(&model);
    return status;
}

// The same stage and eye, with the material as it is now.
static relume_status show_again(struct session *s, const struct relume_log *log)
{
    const char *path = s->material;
    relume_objects *objects;
    relume_status status =
        relume_objects_of_mesh(&objects, s->wanted.mesh, &path, 1, s->wanted.repeat,
                               relume_objects_params(.log = log, .threads = s->threads));
    if (status)
        return status;
    status = gl_renderer_replace_objects(&s->renderer, objects);
    relume_objects_destroy(&s->objects);
    s->objects = s->app.file.objects = objects;
    return status;
}

relume_status session_edit(struct session *s, const char *words, const struct relume_log *log)
{
    if (!session_can_edit(s))
        return say(log, RELUME_EUNFIT,
                   "edit: expected a g-BRDF to be shown alone, or a folder of maps");
    if (s->found.width)
        return session_edit_maps(s, words, log);
    const relume_status status = change_list(s, words, log);
    return status ? status : show_again(s, log);
}

void session_list_edits(struct session *s)
{
    s->edits[0] = '\0';
    if (session_can_edit(s) && !s->found.width)
        (void)!change_list(s, NULL, NULL);
}
