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

relume_status parse_books(const struct args *args, struct relume_books_params *out, bool *wanted)
{
    static const char *const need[] = {"--share",  "--stages", "--split", "--codebook-start",
                                       "--dither", "--seed",   NULL};
    *wanted = args_has(args, "--codebook");
    *out = (struct relume_books_params){
        .codes = args_int(args, "--codebook", 0),
        .stages = args_int(args, "--stages", 1),
        .seed = (uint64_t)args_int(args, "--seed", 0),
        .dither = (float)args_number(args, "--dither", 0.0),
    };
    for (int i = 0; need[i] && !*wanted; i++)
        if (args_has(args, need[i]))
            return usage_error("%s: expected together with --codebook N", need[i]);
    relume_status status = parse_split(args_text(args, "--split", "none"), out);
    if (!status)
        status = parse_start(args_text(args, "--codebook-start", "split"), &out->start);
    const int parts = out->split == RELUME_SPLIT_LUMA      ? 2
                      : out->split == RELUME_SPLIT_PRODUCT ? out->groups
                                                           : 1;
    if (!status && parts * out->stages > RELUME_MOST_BOOKS)
        return usage_error("--stages %d of %d codebooks; expected at most %d together", out->stages,
                           parts, RELUME_MOST_BOOKS);
    return status;
}
