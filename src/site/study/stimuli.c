// stimuli.c - reading the folder of a study
#include "site/study/stimuli.h"

#include "core/base/json.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <string.h>

bool study_is_name(const char *name)
{
    static const char allowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                  "-_.";
    return name && name[0] && name[0] != '.' && strlen(name) < 200 &&
           strspn(name, allowed) == strlen(name);
}

void study_free(struct study *s)
{
    jvalue *root = s->root;
    jvalue_free(&root);
    memset(s, 0, sizeof *s);
}

// Texts of an array, all names where they must be.
static int texts(const char **to, const jvalue *array, size_t most, bool names)
{
    const size_t n = jvalue_count(array);
    if (n < 1 || n > most)
        return 0;
    for (size_t i = 0; i < n; i++) {
        to[i] = jvalue_text(jvalue_item(array, i));
        if (!to[i] || (names && !study_is_name(to[i])))
            return 0;
    }
    return (int)n;
}

static bool read_frames(struct study *s, const jvalue *frames)
{
    for (int i = 0; i < s->scenes; i++) {
        const jvalue *row = jvalue_item(frames, (size_t)i);
        if (jvalue_count(row) != (size_t)s->conditions)
            return false;
        for (int c = 0; c < s->conditions; c++)
            if (!jvalue_whole(jvalue_item(row, (size_t)c), 0, STUDY_FRAMES, &s->frames[i][c]))
                return false;
    }
    return true;
}

relume_status study_read(struct study *s, const char *folder, const struct relume_log *log)
{
    char *path = mem_format("%s/study.json", folder);
    jvalue *root = NULL;
    long long seed = 0;
    memset(s, 0, sizeof *s);
    if (!path)
        return RELUME_ENOMEM;
    relume_status status = jvalue_load(&root, path, log);
    if (!status)
        status = jvalue_check_format(root, path, "relume-study", 1, log);
    if (!status) {
        s->root = root;
        s->conditions =
            texts(s->condition, jvalue_member(root, "conditions"), RELUME_STUDY_CONDITIONS, true);
        s->scenes = texts(s->scene, jvalue_member(root, "scenes"), STUDY_SCENES, true);
        s->questions =
            texts(s->question, jvalue_member(root, "questions"), RELUME_STUDY_QUESTIONS, false);
        const bool good =
            s->conditions > 1 && s->scenes && s->questions &&
            read_frames(s, jvalue_member(root, "frames")) &&
            jvalue_number(jvalue_member(root, "frames_per_second"), &s->frames_per_second) &&
            s->frames_per_second > 0.0 && s->frames_per_second <= 120.0 &&
            jvalue_integer(jvalue_member(root, "seed"), &seed);
        s->seed = (uint64_t)seed;
        if (!good)
            status = log_fail(log, RELUME_EDAMAGED,
                              "%s: expected conditions, scenes, questions, frames, "
                              "frames_per_second and seed, as 'relume study make' writes them",
                              path);
    } else {
        jvalue_free(&root);
    }
    if (status)
        study_free(s);
    mem_free(path);
    return status;
}
