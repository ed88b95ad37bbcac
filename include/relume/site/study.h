// study.h - asking people: pairs of pictures of which one has to be chosen, and what the answers
// say
//
// Stimuli are pictures, or films of them, of the same scenes under several conditions (no glare,
// static, dynamic; materials; levels of detail). Two-alternative forced choice, as in Ritschel,
// Ihrke, Frisvad, Coppens, Myszkowski, Seidel 2009, "Temporal glare"; ratings as in Meseth 2008,
// section 13.4.2.
#ifndef RELUME_STUDY_H
#define RELUME_STUDY_H

#include <relume/base.h>

#ifdef __cplusplus
extern "C" {
#endif

// One way in which all scenes are shown.
struct relume_study_condition {
    const char *name;    // of letters, digits, '-', '_' and '.'
    const char *folder;  // a picture, or a folder of the frames of a film, for each scene
};
enum { RELUME_STUDY_CONDITIONS = 32, RELUME_STUDY_QUESTIONS = 16 };

// Parameters of relume_study_make; 0 is the default of each field.
struct relume_study_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    const char *const *question;  // default: one, "Which picture do you prefer?"
    int questions;                // at most RELUME_STUDY_QUESTIONS
    double frames_per_second;     // of films, (0, 120]; default 24
    uint64_t seed;                // of the orders
    bool force;                   // replace a folder that relume made
};
#define relume_study_params(...)                                                                   \
    (&(const struct relume_study_params){RELUME_SIZED(relume_study_params), __VA_ARGS__})

// Make the folder of a study: stimuli as PNG, all of one size, CONDITION/SCENE.png or
// CONDITION/SCENE/NNNN.png, and study.json. Scenes are the names that the first condition's folder
// has, without endings; every condition must have each. The same inputs give the same bytes. An
// input status with a sentence, RELUME_EINVAL, RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_study_make(const char *folder,
                                              const struct relume_study_condition *condition,
                                              int conditions,
                                              const struct relume_study_params *params);
// Write the page for one subject: a single HTML file that needs no server and no network. It shows
// every pair of conditions of every scene once for each question, in an order and with sides that
// depend on the seed and the subject, and ends with a CSV file: subject, trial, question, scene,
// left, right, chosen, seconds. Of `params` the log alone counts. Statuses as above.
RELUME_RESULT relume_status relume_study_page(const char *page, const char *folder, int subject,
                                              const struct relume_study_params *params);

// How many of the pairs each condition won, of one question. Free with relume_study_free.
struct relume_study_pairs {
    char *question;
    int conditions;
    char **name;  // [conditions], in the order of the alphabet
    int *wins;    // [conditions][conditions]: row was chosen, column was not
    int answers, subjects;
    double *scale;  // [conditions]: Thurstone 1927, case V, mean 0: in standard deviations of a
                    // difference. Shares of 0 and 1 of n count as 1 / 2n from there
    double *chi_squared, *p;  // [conditions][conditions] against even chances, 1 degree of freedom
};
// Scores of pictures by people, normalised by subject (each one's mean and population standard
// deviation).
struct relume_study_ratings {
    int conditions;
    char **name;         // [conditions], in the order of the alphabet
    int *count;          // [conditions] of scores
    double *raw, *mean;  // [conditions]: of scores, of normalised scores
    int subjects;
    double *difference;  // [conditions][conditions]: row - column, mean over subjects of the
                         // difference of their mean normalised scores
    double *t;           // paired t of that, subjects - 1 degrees of freedom
    int *positive;       // subjects whose difference is above 0
};
// What a CSV file of answers says: as many questions as it has, or one set of ratings where its
// first line is subject, condition, image, run, score (any order, more columns may stand between).
struct relume_study_result {
    int questions;
    struct relume_study_pairs *pairs;     // [questions]
    struct relume_study_ratings ratings;  // where questions is 0
};
// Several files are one study. An input status with a sentence that names the line, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_study_analyse(struct relume_study_result *out,
                                                 const char *const *path, int paths,
                                                 const struct relume_log *log);
RELUME_API void relume_study_free(struct relume_study_result *result);

#ifdef __cplusplus
}
#endif
#endif
