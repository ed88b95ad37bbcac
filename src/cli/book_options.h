// book_options.h - the options of commands that make codebooks
#ifndef BOOK_OPTIONS_H
#define BOOK_OPTIONS_H

#include "cli.h"

// clang-format off
#define BOOK_OPTIONS                                                                               \
    {"--codebook", OPTION_INT, "N",                                                                \
     "vector quantisation: a codebook of N vectors and an index per pixel, instead of planes",     \
     1, 65536},                                                                                    \
    BOOK_FORM_OPTIONS
#define BOOK_FORM_OPTIONS                                                                          \
    {"--share", OPTION_FLAG, NULL, "codebooks: one set for all views", 0, 0},                      \
    {"--stages", OPTION_INT, "S",                                                                  \
     "codebooks: S in a row, each codes the error of those before it", 1, 8},                      \
    {"--split", OPTION_TEXT, "HOW",                                                                \
     "codebooks: none, luma (luminance, chrominance) or product:G; default: none", 0, 0},          \
    {"--codebook-start", OPTION_TEXT, "S", "codebooks: split or random; default: split", 0, 0},    \
    {"--dither", OPTION_NUMBER, "D",                                                               \
     "codebooks: share of the index bytes that dithering may spend against banding", 0, 1},        \
    {"--seed", OPTION_INT, "S", "codebooks: seed of the random choices; default: 0", 0, 2147483647}
// clang-format on

// What the options ask for; *wanted is false when there is no --codebook.
relume_status parse_books(const struct args *args, struct relume_books_params *out, bool *wanted);

#endif
