// study_run.c - relume study run: the page on which a subject chooses
#include "cli/studies/study_tasks.h"

struct run_options {
    struct args args;
    const char *output;
    int subject;
};
#define OPTIONS struct run_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "PAGE.html", "the page: one file, for any browser, offline"),
    GROUP("study"),
    INT("--subject", subject, "N", "number of the person, who gets an order of their own", 0,
        2147483647),
    {0},
};

static relume_status run_study_run(const struct args *args)
{
    const struct run_options *o = (const void *)args;
    return relume_study_page(o->output, args->input[0], o->subject,
                             relume_study_params(.log = args->log));
}

const struct command study_task_run = {
    COMMAND(run_study_run, "study run", "DIR -o PAGE.html [--subject N]",
            "make the page on which a person chooses; it saves the answers as CSV",
            "relume study run study --subject 7 -o subject7.html", 1, 1),
};
