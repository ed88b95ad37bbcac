// edits_text.c - edits of a material or of maps in words, as scripts and the panel say them
#include "session/edits_text.h"

#include "cli/program/say.h"

#include <string.h>

const char *edits_unquote(char *name)
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

relume_status edits_change(relume_edits *edits, char *words, const struct relume_log *log)
{
    const bool undo = !strcmp(words, "undo"), redo = !strcmp(words, "redo");
    if ((undo && !relume_edits_undo(edits)) || (redo && !relume_edits_redo(edits)))
        return say(log, RELUME_EINVAL, "there is no edit left to %s", words);
    return undo || redo ? RELUME_OK : add_words(edits, words, log);
}
