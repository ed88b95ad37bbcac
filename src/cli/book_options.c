// book_options.c - the options of commands that make codebooks
#include "book_options.h"

#include <string.h>

relume_status take_bits(void *storage, const struct option *o, const char *text,
                        const struct relume_log *log)
{
    static const char *const names[] = {"8", "10", "12", "16", "half", "log", "float", NULL};
    return relume_storage_parse(storage, text) ? unknown_word(log, o->name, text, names)
                                               : RELUME_OK;
}

relume_status take_domain(void *choice, const struct option *o, const char *text,
                          const struct relume_log *log)
{
    static const char *const names[] = {"auto", "linear", "display", "log", "log:DELTA", NULL};
    struct domain_choice *const c = choice;
    if (!relume_domain_parse(&c->domain, &c->display, text))
        return RELUME_OK;
    if (strncmp(text, "log:", 4))
        return unknown_word(log, o->name, text, names);
    return say(log, RELUME_EINVAL, "%s: expected log:DELTA with DELTA from 1e-6 to 1; found '%s'",
               o->name, text);
}

relume_status take_domains(void *choices, const struct option *o, const char *text,
                           const struct relume_log *log)
{
    struct domain_choices *const c = choices;
    relume_status status = RELUME_OK;
    c->count = 0;
    for (const char *at = text; !status && at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        char word[32];
        snprintf(word, sizeof word, "%.*s", (int)strcspn(at, ","), at);
        if (c->count == MOST_DOMAINS)
            return say(log, RELUME_EINVAL, "%s: expected at most %d; found '%s'", o->name,
                       MOST_DOMAINS, text);
        status = take_domain(&c->item[c->count++], o, word, log);
    }
    return status;
}

relume_status take_split(void *split, const struct option *o, const char *text,
                         const struct relume_log *log)
{
    struct book_split *const s = split;
    char rest;
    *s = (struct book_split){0};
    if (!strcmp(text, "none"))
        return RELUME_OK;
    if (!strcmp(text, "luma")) {
        s->kind = RELUME_SPLIT_LUMA;
        return RELUME_OK;
    }
    s->kind = RELUME_SPLIT_PRODUCT;
    if (sscanf(text, "product:%d%c", &s->groups, &rest) == 1 && s->groups >= 1 &&
        s->groups <= RELUME_MOST_BOOKS)
        return RELUME_OK;
    return say(log, RELUME_EINVAL,
               "%s: expected none, luma or product:G with G from 1 to %d; found '%s'", o->name,
               RELUME_MOST_BOOKS, text);
}

relume_status parse_books(const struct args *args, const struct book_options *b, bool wanted,
                          struct relume_books_params *out)
{
    const size_t from = (size_t)((const char *)b - (const char *)args);
    *out = (struct relume_books_params){
        .codes = b->codes,
        .stages = b->stages ? b->stages : 1,
        .seed = (uint64_t)b->seed,
        .dither = (float)b->dither,
        .split = b->split.kind,
        .groups = b->split.groups,
        .start = given(args, &b->start) ? b->start : RELUME_START_SPLIT,
    };
    for (int i = 0; !wanted && i < args->line->given_count; i++) {
        const struct option *o = args->line->given[i].option;
        if (o->offset >= from && o->offset < from + sizeof *b)
            return usage_error("%s: expected together with --codebook N", o->name);
    }
    const int parts = out->split == RELUME_SPLIT_LUMA      ? 2
                      : out->split == RELUME_SPLIT_PRODUCT ? out->groups
                                                           : 1;
    if (parts * out->stages > RELUME_MOST_BOOKS)
        return usage_error("--stages %d of %d codebooks; expected at most %d together", out->stages,
                           parts, RELUME_MOST_BOOKS);
    return RELUME_OK;
}
