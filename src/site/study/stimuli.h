// stimuli.h - the folder of a study: study.json, and pictures in CONDITION/SCENE.png or, of films,
// CONDITION/SCENE/NNNN.png
#ifndef STUDY_STIMULI_H
#define STUDY_STIMULI_H

#include <relume/site/study.h>

enum { STUDY_SCENES = 1024, STUDY_FRAMES = 2048 };

// What study.json says; texts belong to `root`.
struct study {
    void *root;
    int conditions, scenes, questions;
    const char *condition[RELUME_STUDY_CONDITIONS], *question[RELUME_STUDY_QUESTIONS];
    const char *scene[STUDY_SCENES];
    int frames[STUDY_SCENES][RELUME_STUDY_CONDITIONS];  // 0: a picture
    double frames_per_second;
    uint64_t seed;
};
relume_status study_read(struct study *s, const char *folder, const struct relume_log *log);
void study_free(struct study *s);

// Whether names of conditions and scenes are of letters, digits, '-', '_' and '.'.
bool study_is_name(const char *name);

#endif
