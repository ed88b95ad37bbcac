// words.h - words as the rows of a part of an EXR file
#ifndef PACK_WORDS_H
#define PACK_WORDS_H

#include "image/image/exr.h"

// Some that follow one another: in memory, or `word` is NULL and they lie in a part of another
// file.
struct word_run {
    size_t count;
    const uint32_t *word;
    const exr_file *file;
    int part;
    size_t first;
};
struct word_rows {
    const struct word_run *run;  // [runs], some of them empty
    int runs;
    const struct relume_log *log;  // for those in files
    size_t count, width;           // which words_fill counts
};
// The part gets rows, which must live as long as it.
void words_fill(struct exr_part *part, struct word_rows *words);

// The words `first` .. `first` + `count` of a part, which must be there. An input status,
// RELUME_ENOMEM.
relume_status words_read(uint32_t *to, const exr_file *file, int part, size_t first, size_t count,
                         int threads, const struct relume_log *log);

#endif
