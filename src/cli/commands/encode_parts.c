// encode_parts.c - encode shared by several machines
#include "encode_parts.h"

#include <string.h>

relume_status take_part(void *which, const struct option *o, const char *text,
                        const struct relume_log *log)
{
    struct which_part *const w = which;
    char rest;
    if (sscanf(text, "%d/%d%c", &w->part, &w->parts, &rest) == 2 && w->part >= 1 &&
        w->part <= w->parts && w->parts <= MOST_ARGUMENTS)
        return RELUME_OK;
    return say(log, RELUME_EINVAL, "%s: expected part I of N, such as 3/8; found '%s'", o->name,
               text);
}

bool is_part(struct relume_pack_part *out, const char *path)
{
    return !relume_pack_part_read(out, path, NULL);
}

// ---------------------------------------------------------------- what was asked for

static bool is_among(const char *name, const char *const *names)
{
    while (*names && strcmp(*names, name) != 0)
        names++;
    return *names != NULL;
}

relume_status options_text(struct options_text *out, const struct args *args,
                           const struct option *table, const char *const *but)
{
    const struct command_line *line = args->line;
    size_t n = 0;
    out->text[0] = 0;
    for (const struct option *o = table; o->name; o++)
        for (int i = 0; i < line->given_count && n < sizeof out->text; i++)
            if (line->given[i].option == o && !is_among(o->name, but)) {
                const char *value = line->given[i].text;
                n += (size_t)snprintf(out->text + n, sizeof out->text - n, "%s%s%s%s", n ? " " : "",
                                      o->name, value ? " " : "", value ? value : "");
            }
    return n < sizeof out->text ? RELUME_OK
                                : usage_error("the options are too long to be stored in a part; "
                                              "expected fewer than %zu letters",
                                              sizeof out->text);
}

// ---------------------------------------------------------------- lines for the shell

// A word as the shell takes it for one.
static void print_word(const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_-+=./:,@%";
    putchar(' ');
    if (word[strspn(word, plain)] == 0) {
        fputs(word, stdout);
        return;
    }
    putchar('\'');
    for (; *word; word++)
        fputs(*word == '\'' ? "'\\''" : (const char[]){*word, 0}, stdout);
    putchar('\'');
}

// "statue.exr" as the word "statue" with another ending.
static void print_beside(const char *output, const char *ending)
{
    char word[4096];
    const size_t stem = strlen(output) - strlen(name_ending(output));
    snprintf(word, sizeof word, "%.*s%s", (int)stem, output, ending);
    print_word(word);
}

static void print_part_name(const char *output, int part, int parts)
{
    char ending[64];
    snprintf(ending, sizeof ending, ".%dof%d.part", part, parts);
    print_beside(output, ending);
}

static void print_encode(const struct args *args)
{
    const struct command_line *line = args->line;
    fputs(args->program, stdout);
    fputs(" encode", stdout);
    print_word(args->input[0]);
    for (int i = 0; i < line->given_count; i++) {
        const struct given *g = &line->given[i];
        if (!strcmp(g->option->name, "-o") || !strcmp(g->option->name, "--commands"))
            continue;
        print_word(g->option->name);
        if (g->text)
            print_word(g->text);
    }
}

void print_commands_of_parts(const struct args *args, const char *output, int parts, bool learns)
{
    for (int i = 1; i <= parts; i++) {
        print_encode(args);
        if (learns) {
            fputs(" --learnt", stdout);
            print_beside(output, ".learnt");
        }
        printf(" --part %d/%d -o", i, parts);
        print_part_name(output, i, parts);
        putchar('\n');
    }
    printf("%s join", args->program);
    for (int i = 1; i <= parts; i++)
        print_part_name(output, i, parts);
    fputs(" -o", stdout);
    print_word(output);
    putchar('\n');
}
