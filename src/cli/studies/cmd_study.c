// cmd_study.c - relume study: asking people, and what their answers say
#include "cli/studies/study_tasks.h"

#include <math.h>

static void put_counts(struct jwriter *w, const char *name, const int *count, int n)
{
    jopen_array(w, name);
    for (int i = 0; i < n; i++)
        jput_integer(w, NULL, count[i]);
    jclose(w);
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

static void put_pairs(struct jwriter *w, const struct relume_study_pairs *p)
{
    const int n = p->conditions, all = n * n;
    jopen_object(w, NULL);
    jput_text(w, "question", p->question);
    jput_integer(w, "answers", p->answers);
    jput_integer(w, "subjects", p->subjects);
    jput_texts(w, "conditions", (const char *const *)p->name, (size_t)n);
    jput_numbers(w, "z", p->scale, (size_t)n, 9);
    put_counts(w, "wins", p->wins, all);
    jput_numbers(w, "chi_squared", p->chi_squared, (size_t)all, 9);
    jput_numbers(w, "p", p->p, (size_t)all, 9);
    jclose(w);
}

static void print_pairs_json(const struct relume_study_result *r)
{
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jopen_array(&w, "questions");
    for (int q = 0; q < r->questions; q++)
        put_pairs(&w, &r->pairs[q]);
    jend(&w);
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
    const size_t n = (size_t)r->conditions;
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_integer(&w, "subjects", r->subjects);
    jput_texts(&w, "conditions", (const char *const *)r->name, n);
    jput_numbers(&w, "score", r->raw, n, 9);
    jput_numbers(&w, "z", r->mean, n, 9);
    jput_numbers(&w, "difference", r->difference, n * n, 9);
    jput_numbers(&w, "t", r->t, n * n, 9);
    jend(&w);
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

static relume_status run_study_analyse(const struct args *args)
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
    COMMAND(run_study_analyse, "study analyse", "ANSWERS.csv ... [--json]",
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
