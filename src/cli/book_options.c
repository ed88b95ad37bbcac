// book_options.c - the options of commands that make codebooks
#include "book_options.h"

#include <string.h>

static relume_status parse_split(const char *text, struct relume_books_params *out)
{
    char rest;
    if (!strcmp(text, "none"))
        return RELUME_OK;
    if (!strcmp(text, "luma")) {
        out->split = RELUME_SPLIT_LUMA;
        return RELUME_OK;
    }
    if (sscanf(text, "product:%d%c", &out->groups, &rest) == 1 && out->groups >= 1 &&
        out->groups <= RELUME_MOST_BOOKS) {
        out->split = RELUME_SPLIT_PRODUCT;
        return RELUME_OK;
    }
    return usage_error("--split: expected none, luma or product:G with G from 1 to %d; found '%s'",
                       RELUME_MOST_BOOKS, text);
}

static relume_status parse_start(const char *text, enum relume_codebook_start *out)
{
    static const char *const names[] = {"random", "split", NULL};
    for (int i = 0; names[i]; i++)
        if (!strcmp(text, names[i])) {
            *out = (enum relume_codebook_start)i;
            return RELUME_OK;
        }
    return unknown_name("--codebook-start", text, names);
}

relume_status parse_books(const struct args *args, const struct book_options *b, bool wanted,
                          struct relume_books_params *out)
{
    const struct {
        const void *member;
        const char *name;
    } need[] = {{&b->share, "--share"},          {&b->stages, "--stages"}, {&b->split, "--split"},
                {&b->start, "--codebook-start"}, {&b->dither, "--dither"}, {&b->seed, "--seed"}};
    *out = (struct relume_books_params){
        .codes = b->codes,
        .stages = b->stages ? b->stages : 1,
        .seed = (uint64_t)b->seed,
        .dither = (float)b->dither,
    };
    for (size_t i = 0; i < sizeof need / sizeof *need && !wanted; i++)
        if (args_given(args, need[i].member))
            return usage_error("%s: expected together with --codebook N", need[i].name);
    relume_status status = parse_split(b->split ? b->split : "none", out);
    if (!status)
        status = parse_start(b->start ? b->start : "split", &out->start);
    const int parts = out->split == RELUME_SPLIT_LUMA      ? 2
                      : out->split == RELUME_SPLIT_PRODUCT ? out->groups
                                                           : 1;
    if (!status && parts * out->stages > RELUME_MOST_BOOKS)
        return usage_error("--stages %d of %d codebooks; expected at most %d together", out->stages,
                           parts, RELUME_MOST_BOOKS);
    return status;
}
