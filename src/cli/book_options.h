// book_options.h - the options of commands that make codebooks
#ifndef BOOK_OPTIONS_H
#define BOOK_OPTIONS_H

#include "cli.h"

struct book_options {
    bool share;
    int codes, stages, seed;
    const char *split, *start;
    double dither;
};
// Table rows for a command's options; `books` in its struct.
// clang-format off
#define BOOK_OPTIONS                                                                               \
    INT("--codebook", books.codes, "codebooks", "N",                                                 \
        "vector quantisation: a codebook of N vectors and an index per pixel, instead of planes",  \
        1, 65536),                                                                                 \
    BOOK_FORM_OPTIONS
#define BOOK_FORM_OPTIONS                                                                          \
    FLAG("--share", books.share, "codebooks", "codebooks: one set for all views"),                   \
    INT("--stages", books.stages, "codebooks", "S",                                                  \
        "codebooks: S in a row, each codes the error of those before it", 1, 8),                   \
    TEXT("--split", books.split, "codebooks", "HOW",                                                 \
         "codebooks: none, luma (luminance, chrominance) or product:G; default: none"),            \
    TEXT("--codebook-start", books.start, "codebooks", "S",                                          \
         "codebooks: split or random; default: split"),                                            \
    NUMBER("--dither", books.dither, "codebooks", "D",                                               \
           "codebooks: share of the index bytes that dithering may spend against banding", 0, 1),  \
    INT("--seed", books.seed, "codebooks", "S", "codebooks: seed of the random choices; default: 0", \
        0, 2147483647)
// clang-format on

// What the options ask for; all but `codes` need --codebook, which was given or not.
relume_status parse_books(const struct args *args, const struct book_options *books, bool wanted,
                          struct relume_books_params *out);

#endif
