// answers.h - tables of answers (CSV), and words with numbers
#ifndef STUDY_ANSWERS_H
#define STUDY_ANSWERS_H

#include <relume/site/study.h>
#include <stddef.h>

// Different texts, each with a number.
struct words {
    int count;
    char **text;
};
// The number of `text`, which is added when it is new; -1 when memory is short.
int words_number(struct words *w, const char *text);
void words_free(struct words *w);
// From their numbers now to those in the order of the alphabet, in which they are put.
// RELUME_ENOMEM.
relume_status words_sort(struct words *w, int **place);

// One row; texts are numbers of words. Of ratings: subject, condition, score.
struct answer {
    int subject, question, chosen, other;
    double score;
};
struct answers {
    bool ratings;
    struct words subjects, questions, conditions;
    size_t count;
    struct answer *answer;
};
relume_status answers_read(struct answers *a, const char *path, const struct relume_log *log);
void answers_free(struct answers *a);

#endif
