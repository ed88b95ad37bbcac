// cmd_study.c - relume study: asking people, and what their answers say
#include "cli/studies/study_tasks.h"

#include <math.h>

static void print_names(char *const *name, int n)
{
    printf("\"conditions\": [");
    for (int i = 0; i < n; i++) {
        printf("%s", i ? ", " : "");
        json_text(stdout, name[i]);
    }
    printf("]");
}

static void print_numbers(const char *name, const double *value, int n)
{
    printf(", \"%s\": [", name);
    for (int i = 0; i < n; i++) {
        printf("%s", i ? ", " : "");
        json_number(stdout, value[i]);
    }
    printf("]");
}

static void print_pairs(const struct relume_study_pairs *p)
{
    struct shown name[2];
    const int n = p->conditions;
    printf("%s\n%d answers of %d subject%s\n\n%-20s %8s\n", shown(&name[0], p->question),
           p->answers, p->subjects, relume_plural(p->subjects), "condition", "z");
    for (int i = 0; i < n; i++)
        printf("%-20s %8.3f\n", shown(&name[0], p->name[i]), p->scale[i]);
    printf("\n%-20s %-20s %6s %6s %8s %9s\n", "condition", "over", "won", "lost", "chi2", "p");
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++)
            if (p->wins[i * n + j] + p->wins[j * n + i])
                printf("%-20s %-20s %6d %6d %8.2f %9.2g\n", shown(&name[0], p->name[i]),
                       shown(&name[1], p->name[j]), p->wins[i * n + j], p->wins[j * n + i],
                       p->chi_squared[i * n + j], p->p[i * n + j]);
    puts("");
}

static void print_pairs_json(const struct relume_study_result *r)
{
    printf("{\"questions\": [");
    for (int q = 0; q < r->questions; q++) {
        const struct relume_study_pairs *p = &r->pairs[q];
        printf("%s{\"question\": ", q ? ", " : "");
        json_text(stdout, p->question);
        printf(", \"answers\": %d, \"subjects\": %d, ", p->answers, p->subjects);
        print_names(p->name, p->conditions);
        print_numbers("z", p->scale, p->conditions);
        printf(", \"wins\": [");
        for (int i = 0; i < p->conditions * p->conditions; i++)
            printf("%s%d", i ? ", " : "", p->wins[i]);
        printf("]");
        print_numbers("chi_squared", p->chi_squared, p->conditions * p->conditions);
        print_numbers("p", p->p, p->conditions * p->conditions);
        printf("}");
    }
    puts("]}");
}

static void print_ratings(const struct relume_study_ratings *r)
{
    struct shown name[2];
    const int n = r->conditions;
    printf("%d subject%s\n\n%-20s %6s %8s %8s\n", r->subjects, relume_plural(r->subjects),
           "condition", "n", "score", "z");
    for (int i = 0; i < n; i++)
        printf("%-20s %6d %8.2f %8.3f\n", shown(&name[0], r->name[i]), r->count[i], r->raw[i],
               r->mean[i]);
    printf("\n%-20s %-20s %8s %8s %s\n", "condition", "less", "z", "t", "subjects above");
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++)
            printf("%-20s %-20s %8.3f %8.2f %d\n", shown(&name[0], r->name[i]),
                   shown(&name[1], r->name[j]), r->difference[i * n + j], r->t[i * n + j],
                   r->positive[i * n + j]);
}

static void print_ratings_json(const struct relume_study_ratings *r)
{
    printf("{\"subjects\": %d, ", r->subjects);
    print_names(r->name, r->conditions);
    print_numbers("score", r->raw, r->conditions);
    print_numbers("z", r->mean, r->conditions);
    print_numbers("difference", r->difference, r->conditions * r->conditions);
    print_numbers("t", r->t, r->conditions * r->conditions);
    puts("}");
}

// ---------------------------------------------------------------- analyse

struct analyse_options {
    struct args args;
    bool json;
};
#define OPTIONS struct analyse_options

static const struct option options[] = {
    GROUP("output"),
    FLAG("--json", json, "one JSON object"),
    {0},
};

static relume_status run(const struct args *args)
{
    const struct analyse_options *o = (const void *)args;
    struct relume_study_result result;
    const relume_status status =
        relume_study_analyse(&result, args->input, args->inputs, args->log);
    if (status)
        return status;
    if (!result.questions)
        (o->json ? print_ratings_json : print_ratings)(&result.ratings);
    else if (o->json)
        print_pairs_json(&result);
    for (int q = 0; !o->json && q < result.questions; q++)
        print_pairs(&result.pairs[q]);
    relume_study_free(&result);
    return RELUME_OK;
}

static const struct command analyse = {
    COMMAND("study analyse", "ANSWERS.csv ... [--json]",
            "say which condition people choose, how much more often, and how sure that is",
            "relume study analyse subject*.csv", 1, 4096),
};

static const struct command *const tasks[] = {&study_task_make, &study_task_run, &analyse, NULL};

const struct command command_study = {
    .name = "study",
    .usage = "make|run|analyse ...",
    .summary = "ask people which picture they choose, and analyse their answers",
    .example =
        "relume study make none=plain static=glare -o study --question \"Which is brighter?\"",
    .tasks = tasks,
};
