// book_options.h - the options of commands that make codebooks
#ifndef BOOK_OPTIONS_H
#define BOOK_OPTIONS_H

#include "cli.h"

struct book_options {
    int codes;  // all but this need it
    int stages, seed;
    bool share;
    unsigned start;
    double dither;
    struct book_split {
        enum relume_book_split kind;
        int groups;
    } split;
};
// Table rows for a command's options; `books` in its struct.
// clang-format off
#define BOOK_OPTIONS                                                                               \
    INT("--codebook", books.codes, "N",                                                            \
        "vector quantisation: a codebook of N vectors and an index per pixel, instead of planes",  \
        1, 65536),                                                                                 \
    BOOK_FORM_OPTIONS
#define BOOK_FORM_OPTIONS                                                                          \
    FLAG("--share", books.share, "codebooks: use one set for all views"),                              \
    INT("--stages", books.stages, "S",                                                             \
        "codebooks: S in a row, each corrects the error of those before it", 1, 8),                   \
    OWN("--split", books.split, "HOW",                                                             \
        "codebooks: none, luma (luminance, chrominance) or product:G; default: none", take_split), \
    NAME("--codebook-start", books.start, "S", "codebooks: split or random; default: split",       \
         RELUME_START_RANDOM, "random", "split"),                                                  \
    NUMBER("--dither", books.dither, "D",                                                          \
           "codebooks: dither against banding, with at most this share of the index bytes", 0, 1), \
    INT("--seed", books.seed, "S", "codebooks: seed of the random choices; default: 0",            \
        0, 2147483647)
// clang-format on
// How numbers are stored: "8", "half", ...
// What --domain takes.
struct domain_choice {
    enum relume_domain domain;
    struct relume_transfer display;
};
enum { MOST_DOMAINS = 8 };
// What a list of them takes: "linear,log".
struct domain_choices {
    int count;
    struct domain_choice item[MOST_DOMAINS];
};
relume_status take_domains(void *choices, const struct option *option, const char *text,
                           const struct relume_log *log);
relume_status take_domain(void *choice, const struct option *option, const char *text,
                          const struct relume_log *log);
relume_status take_bits(void *storage, const struct option *option, const char *text,
                        const struct relume_log *log);
relume_status take_split(void *split, const struct option *option, const char *text,
                         const struct relume_log *log);

// What the options ask for, of --codebook N or another `wanted`.
relume_status parse_books(const struct args *args, const struct book_options *books, bool wanted,
                          struct relume_books_params *out);

#endif
