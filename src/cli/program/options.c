// options.c - a command line as a table: values are read, and refused, here alone
#include "cli/program/options.h"

#include "cli/program/output_name.h"
#include "cli/program/say.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------- names

int option_names(const char **names, int n, int most, const struct option *table)
{
    for (; table && table->name; table++)
        if (table->kind != OPTION_GROUP && n < most)
            names[n++] = table->name;
    return n;
}

relume_status unknown_word(const struct relume_log *log, const char *what, const char *given,
                           const char *const *names)
{
    const char *near = relume_name_nearest(given, names);
    char list[1024] = "", meant[120] = "";
    for (size_t n = 0; *names && n < sizeof list; names++)
        n += (size_t)snprintf(list + n, sizeof list - n, " %s", *names);
    if (near)
        snprintf(meant, sizeof meant, "did you mean '%.80s'? ", near);
    return say(log, RELUME_EINVAL, "unknown %s '%.200s'; %sxpected one of:%s", what, given,
               near ? strcat(meant, "E") : "e", list);
}

const struct option *option_find(const struct option *table, const char *name)
{
    for (; table && table->name; table++)
        if (!strcmp(table->name, name))
            return table;
    return NULL;
}

static relume_status unknown_option(const struct command_line *l, const char *given)
{
    enum { MOST = 128 };
    const char *names[MOST + 1] = {NULL};
    const char *name = l->name ? l->name : "", *colon = l->name ? ": " : "";
    int n = 0;
    for (const struct option *const *t = l->tables; *t; t++)
        n = option_names(names, n, MOST, *t);
    const char *near = relume_name_nearest(given, names);
    if (near)
        return say(l->log, RELUME_EINVAL, "%s%sunknown option '%s'; did you mean '%s'?", name,
                   colon, given, near);
    return say(l->log, RELUME_EINVAL, "%s%sunknown option '%s'; see '%s%s --help'", name, colon,
               given, l->name ? "relume " : "relume-view", name);
}

// ---------------------------------------------------------------- values

static relume_status expected(const struct command_line *l, const struct option *o,
                              const char *text, const char *what)
{
    return say(l->log, RELUME_EINVAL, "%s: expected %s; found '%s'", o->name, what, text);
}

static relume_status take_number(double *out, const struct command_line *l, const struct option *o,
                                 const char *text)
{
    char *end, what[160];
    const char *const word = o->kind == OPTION_NUMBER && o->names ? o->names[0] : NULL;
    const bool whole = o->kind == OPTION_INT, bound = o->min != 0.0 || o->max != 0.0;
    *out = (double)NAN;
    if (word && !strcmp(text, word))
        return RELUME_OK;
    *out = strtod(text, &end);
    if (end != text && !*end && isfinite(*out) && (!bound || (*out >= o->min && *out <= o->max)) &&
        (!whole || (*out == floor(*out) && fabs(*out) <= INT_MAX)))
        return RELUME_OK;
    int n = snprintf(what, sizeof what, "a%s number", whole ? " whole" : "");
    if (bound)
        n += snprintf(what + n, sizeof what - (size_t)n, " from %g to %g", o->min, o->max);
    if (word)
        snprintf(what + n, sizeof what - (size_t)n, ", or %s", word);
    return expected(l, o, text, what);
}

// Separated by commas or blanks, nothing else.
static relume_status take_numbers(double *out, const struct command_line *l, const struct option *o,
                                  const char *text)
{
    const char *at = text;
    static const char *const counts[] = {"no",   "one", "two",   "three", "four",
                                         "five", "six", "seven", "eight"};
    char what[80], *end;
    bool good = true;
    for (int i = 0; good && i < o->count; i++) {
        at += strspn(at, i ? ", \t" : " \t");
        out[i] = strtod(at, &end);
        good = end != at && isfinite(out[i]);
        at = end;
    }
    if (good && !at[strspn(at, " \t")])
        return RELUME_OK;
    snprintf(what, sizeof what, "%s numbers %s", counts[o->count], o->argument);
    return expected(l, o, text, what);
}

// A number, at `*text` and moved beyond it; 0 where there is none.
static int64_t take_side(const char **text)
{
    const size_t digits = strspn(*text, "0123456789");
    const int64_t side = digits <= 9 ? atoi(*text) : INT_MAX;
    *text += side ? digits : 0;
    return side;
}

static relume_status take_size(int out[2], const struct command_line *l, const struct option *o,
                               const char *text)
{
    const char *rest = text;
    const bool one = o->min == 0.0;
    char what[120];
    const int64_t w = take_side(&rest);
    const bool both = *rest == 'x';
    rest += both;
    const int64_t h = both ? take_side(&rest) : 0;
    out[0] = (int)w;
    out[1] = (int)h;
    if (!*rest && (one ? w || h : w && h) && w <= o->max && h <= o->max && w * h <= 1 << 30)
        return RELUME_OK;
    snprintf(what, sizeof what, "%s%s, at most %g a side and 2^30 pixels", o->argument,
             one ? ", W or xH" : "", o->max);
    return expected(l, o, text, what);
}

static relume_status take_name(int *out, const struct command_line *l, const struct option *o,
                               const char *text)
{
    int i = 0;
    while (o->names[i] && strcmp(o->names[i], text))
        i++;
    *out = i + (int)o->min;
    return o->names[i] ? RELUME_OK : unknown_word(l->log, o->name, text, o->names);
}

static const char *entry_name(const void *entry)
{
    return *(const char *const *)entry;
}

static relume_status take_entry(const void **out, const struct command_line *l,
                                const struct option *o, const char *text)
{
    const char *names[MOST_ITEMS + 1] = {o->names ? o->names[0] : NULL};
    int n = o->names != NULL;
    *out = NULL;
    if (n && !strcmp(text, names[0]))
        return RELUME_OK;
    for (const void *const *t = o->table; *t && n < MOST_ITEMS; t++) {
        names[n++] = entry_name(*t);
        if (!strcmp(entry_name(*t), text))
            *out = *t;
    }
    return *out ? RELUME_OK : unknown_word(l->log, o->name, text, names);
}

// `text` as the value of an option, or a word of its list.
static relume_status take_value(void *out, struct command_line *l, const struct option *o,
                                const char *text)
{
    double number = 0.0;
    relume_status status = RELUME_OK;
    switch (o->kind) {
    case OPTION_FLAG: *(bool *)out = true; break;
    case OPTION_INT:
        status = take_number(&number, l, o, text);
        *(int *)out = status ? 0 : (int)number;
        break;
    case OPTION_NUMBER: return take_number(out, l, o, text);
    case OPTION_NUMBERS: return take_numbers(out, l, o, text);
    case OPTION_SIZE: return take_size(out, l, o, text);
    case OPTION_NAME: return take_name(out, l, o, text);
    case OPTION_ENTRY: return take_entry(out, l, o, text);
    case OPTION_OWN: return o->take(out, o, text, l->log);
    case OPTION_BYTES:
        return relume_size_parse(out, text) ? expected(l, o, text, "a size like 500M or 4G")
                                            : status;
    case OPTION_TRANSFER:
        return relume_transfer_parse(out, text) ? expected(l, o, text, "linear, srgb or gamma:G")
                                                : status;
    default: *(const char **)out = text;
    }
    return status;
}

// The words of a comma-separated list.
static relume_status take_list(void *out, struct command_line *l, const struct option *o,
                               const char *text)
{
    int *const count = out;
    const char *const all = text;
    *count = 0;
    relume_status status = RELUME_OK;
    for (const char *end = text; !status && *end; text = end + 1) {
        char word[64];
        const size_t n = strcspn(text, ",");
        end = text + n;
        snprintf(word, sizeof word, "%.*s", (int)n, text);
        if (*count == MOST_ITEMS || n == 0 || n >= sizeof word)
            status = expected(l, o, all, "words separated by commas, at most 64");
        else if (o->kind == OPTION_ENTRY)
            status = take_value(&((struct entries *)out)->item[(*count)++], l, o, word);
        else
            status = take_value(&((struct ints *)out)->item[(*count)++], l, o, word);
    }
    return status;
}

static int occurrences(const struct command_line *l, const struct option *o)
{
    int n = 0;
    for (int i = 0; i < l->given_count; i++)
        n += l->given[i].option == o;
    return n;
}

static void take_text(struct texts *out, struct command_line *l, const struct given *g)
{
    if (!out->count) {
        out->text = l->list + l->listed;
        l->listed += occurrences(l, g->option);
    }
    l->list[out->text - l->list + out->count++] = g->text;
}

static relume_status take_point(struct points *out, struct command_line *l, const struct given *g)
{
    if (!out->count) {
        out->point = l->point + l->pointed;
        l->pointed += occurrences(l, g->option);
    }
    double v[3];
    const relume_status status = take_numbers(v, l, g->option, g->text);
    if (!status)
        l->point[out->point - l->point + out->count++] = (struct relume_vec3){v[0], v[1], v[2]};
    return status;
}

static relume_status take_given(struct command_line *l, const struct given *g)
{
    const struct option *o = g->option;
    void *member = (char *)l->values + o->offset;
    if (g->text && !*g->text)
        return say(l->log, RELUME_EINVAL, "%s: expected a value (%s); found an empty one", o->name,
                   o->argument);
    switch (o->kind) {
    case OPTION_TEXTS:
    case OPTION_FILES: take_text(member, l, g); return RELUME_OK;
    case OPTION_POINTS: return take_point(member, l, g);
    default: break;
    }
    const relume_status status = o->kind == OPTION_PICTURE  ? picture_name(l->log, o->name, g->text)
                                 : o->kind == OPTION_FLOATS ? floats_name(l->log, o->name, g->text)
                                 : o->kind == OPTION_RELUME ? relume_name(l->log, o->name, g->text)
                                 : o->kind == OPTION_RIG    ? rig_name(l->log, o->name, g->text)
                                                            : RELUME_OK;
    return status ? status : (o->list ? take_list : take_value)(member, l, o, g->text);
}

// ---------------------------------------------------------------- the line

bool option_given(const struct command_line *line, const void *member)
{
    const size_t offset = (size_t)((const char *)member - (const char *)line->values);
    for (int i = 0; i < line->given_count; i++)
        if (line->given[i].option->offset == offset)
            return true;
    return false;
}

bool is_option(const char *text)
{
    return text[0] == '-' && text[1] && !(text[1] >= '0' && text[1] <= '9') && text[1] != '.';
}

static const struct option *find_in(const struct command_line *l, const char *name)
{
    const struct option *o = NULL;
    for (const struct option *const *t = l->tables; !o && *t; t++)
        o = option_find(*t, name);
    return o;
}

// The options that a state line stands for, but for those that this command has not, or of which
// the line itself has one.
static relume_status expand_state(struct command_line *l, const char *text)
{
    enum { MOST = 256 };
    struct state_entry entry[MOST];
    int n;
    const relume_status status = state_line_read(entry, &n, MOST, l->state, text, l->log);
    for (int i = 0; !status && i < n; i++) {
        const struct option *o = find_in(l, entry[i].option);
        bool beside = !o;
        for (int k = 0; !beside && k < l->given_count; k++)
            beside = l->given[k].option == o && !l->given[k].of_state;
        if (!beside && l->given_count < MOST_ARGUMENTS)
            l->given[l->given_count++] = (struct given){o, entry[i].value, true, false};
    }
    return status;
}

// The option at argv[*i], and its value, which may be the argument behind it.
static relume_status split_option(struct command_line *l, int *i, int argc, char **argv)
{
    char name[64];
    const char *equals = strchr(argv[*i], '=');
    snprintf(name, sizeof name, "%.*s", equals ? (int)(equals - argv[*i]) : 63, argv[*i]);
    const struct option *const o = find_in(l, name);
    if (!o)
        return unknown_option(l, name);
    if (o->kind == OPTION_FLAG && equals)
        return say(l->log, RELUME_EINVAL, "%s: takes no value; found '%s'", o->name, equals + 1);
    if (o->kind != OPTION_FLAG && !equals && *i + 1 >= argc)
        return say(l->log, RELUME_EINVAL, "%s: expected a value (%s) after it; found none", o->name,
                   o->argument);
    l->given[l->given_count++] = (struct given){o,
                                                o->kind == OPTION_FLAG ? NULL
                                                : equals               ? equals + 1
                                                                       : argv[++*i],
                                                false, false};
    return RELUME_OK;
}

// Returns the option that further files may belong to; NULL: none.
static const struct option *open_option(const struct command_line *l)
{
    const struct given *last = l->given_count ? &l->given[l->given_count - 1] : NULL;
    const bool open = last && last->option->kind == OPTION_FILES && !tree_is_folder(last->text);
    return open ? last->option : NULL;
}

// Files after an OPTION_FILES are the command's where it has no other inputs.
static void settle_files(struct command_line *l)
{
    const bool inputs = l->input_count > 0;
    int n = 0;
    for (int i = 0; i < l->given_count; i++) {
        if (!inputs && l->given[i].follows)
            l->input[l->input_count++] = l->given[i].text;
        else
            l->given[n++] = l->given[i];
    }
    l->given_count = n;
}

relume_status command_line_parse(struct command_line *l, int argc, char **argv)
{
    relume_status status = relume_cpu_check(l->log);
    const struct option *files = NULL;
    bool only_inputs = false;
    l->given_count = l->input_count = l->listed = l->pointed = 0;
    for (int i = 0; !status && i < argc; i++) {
        if (l->given_count == MOST_ARGUMENTS || l->input_count == MOST_ARGUMENTS)
            return say(l->log, RELUME_EINVAL, "too many arguments");
        if (!*argv[i])
            return say(l->log, RELUME_EINVAL, "%s%sexpected a name; found an empty name",
                       l->name ? l->name : "", l->name ? ": " : "");
        if (!only_inputs && !strcmp(argv[i], "--"))
            only_inputs = true;
        else if (!only_inputs && is_option(argv[i])) {
            status = split_option(l, &i, argc, argv);
            files = status ? NULL : open_option(l);
        } else if (files && !only_inputs)
            l->given[l->given_count++] =
                (struct given){.option = files, .text = argv[i], .follows = true};
        else
            l->input[l->input_count++] = argv[i];
    }
    settle_files(l);
    const char *state = NULL;
    for (int i = 0; i < l->given_count; i++)
        if (l->given[i].option->kind == OPTION_STATE)
            state = l->given[i].text;
    if (!status && state)
        status = expand_state(l, state);
    for (int i = 0; !status && i < l->given_count; i++)
        status = take_given(l, &l->given[i]);
    return status;
}

// ---------------------------------------------------------------- help

// The rows behind `group`, and behind other headings that are the same.
static void print_group(const struct option *table, const char *group, int width)
{
    const char *within = NULL;
    for (const struct option *o = table; o->name; o++) {
        char left[64];
        if (o->kind == OPTION_GROUP)
            within = o->name;
        if (o->kind == OPTION_GROUP || !o->help || (group && strcmp(within, group) != 0))
            continue;
        snprintf(left, sizeof left, "%s%s%s", o->name, o->argument ? " " : "",
                 o->argument ? o->argument : "");
        printf("  %-*s %s\n", width, left, o->help);
    }
}

void options_print(const struct option *table, const char *groups, int width)
{
    for (const struct option *o = table, *before = table; o && o->name; o++, before = table) {
        if (o->kind != OPTION_GROUP)
            continue;
        while (before < o && (before->kind != OPTION_GROUP || strcmp(before->name, o->name) != 0))
            before++;
        if (before == o && (!groups || strstr(groups, o->name))) {
            printf(" %s:\n", o->name);
            print_group(table, o->name, width);
        }
    }
    if (table && table->kind != OPTION_GROUP)
        print_group(table, NULL, width);
}
