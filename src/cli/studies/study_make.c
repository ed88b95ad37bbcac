// study_make.c - relume study make: stimuli of several conditions in one folder
#include "cli/studies/study_tasks.h"

#include <string.h>

struct make_options {
    struct args args;
    const char *output;
    struct texts question;
    double rate;
    int seed;
    bool force;
};
#define OPTIONS struct make_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "DIR", "the folder of the study"),
    FLAG("--force", force, "replace a folder that relume made"),
    GROUP("study"),
    TEXTS("--question", question, "TEXT",
          "what is asked of each pair; may be repeated; default: Which picture do you prefer?"),
    NUMBER("--rate", rate, "FPS", "frames per second of films; default: 24", 1, 120),
    INT("--seed", seed, "S", "of the orders in which subjects see the pairs; default: 0", 0,
        2147483647),
    {0},
};

// NAME=FOLDER
static relume_status take_condition(struct relume_study_condition *c, char *name, size_t size,
                                    const char *text)
{
    const char *equals = strchr(text, '=');
    const size_t length = equals ? (size_t)(equals - text) : 0;
    if (!length || length >= size || !equals[1])
        return usage_error("%s: expected NAME=FOLDER, a condition and its pictures", text);
    memcpy(name, text, length);
    name[length] = '\0';
    *c = (struct relume_study_condition){.name = name, .folder = equals + 1};
    return RELUME_OK;
}

static relume_status run_study_make(const struct args *args)
{
    const struct make_options *o = (const void *)args;
    struct relume_study_condition condition[RELUME_STUDY_CONDITIONS];
    char name[RELUME_STUDY_CONDITIONS][200];
    for (int i = 0; i < args->inputs; i++) {
        const relume_status status =
            take_condition(&condition[i], name[i], sizeof name[i], args->input[i]);
        if (status)
            return status;
    }
    if (o->question.count > RELUME_STUDY_QUESTIONS)
        return usage_error("--question: at most %d of them", RELUME_STUDY_QUESTIONS);
    return relume_study_make(
        o->output, condition, args->inputs,
        relume_study_params(.log = args->log, .limits = &args->limits,
                            .question = o->question.count ? o->question.text : NULL,
                            .questions = o->question.count, .frames_per_second = o->rate,
                            .seed = (uint64_t)o->seed, .force = o->force));
}

const struct command study_task_make = {
    .names_built_in = true,
    COMMAND(run_study_make, "study make", "NAME=FOLDER NAME=FOLDER ... -o DIR [OPTION ...]",
            "gather pictures, or folders of frames, of the same scenes under several conditions",
            "relume study make none=plain static=glare moving=films -o study", 2,
            RELUME_STUDY_CONDITIONS),
};
