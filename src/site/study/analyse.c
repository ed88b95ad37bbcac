// analyse.c - choices and ratings of people in numbers (Thurstone 1927, "A law of comparative
// judgment", case V: equal spreads, no correlation)
#include "core/base/log.h"
#include "core/base/memory.h"
#include "site/study/answers.h"
#include "site/study/statistics.h"

#include <math.h>
#include <string.h>

static void free_names(char **name, int n)
{
    for (int i = 0; name && i < n; i++)
        mem_free(name[i]);
    mem_free(name);
}

static void pairs_free(struct relume_study_pairs *p)
{
    mem_free(p->question);
    free_names(p->name, p->conditions);
    mem_free(p->wins);
    mem_free(p->scale);
    mem_free(p->chi_squared);
    mem_free(p->p);
}

void relume_study_free(struct relume_study_result *result)
{
    struct relume_study_ratings *r = &result->ratings;
    for (int i = 0; i < result->questions; i++)
        pairs_free(&result->pairs[i]);
    mem_free(result->pairs);
    free_names(r->name, r->conditions);
    mem_free(r->count);
    mem_free(r->raw);
    mem_free(r->mean);
    mem_free(r->difference);
    mem_free(r->t);
    mem_free(r->positive);
    *result = (struct relume_study_result){0};
}

static relume_status copy_names(char ***name, const struct words *w)
{
    *name = mem_zeroed((size_t)w->count, sizeof **name);
    bool good = *name != NULL;
    for (int i = 0; good && i < w->count; i++)
        good = ((*name)[i] = mem_text(w->text[i])) != NULL;
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- choices

static double share_won(int won, int lost)
{
    const int n = won + lost;
    return fmin(fmax(won, 0.5), n - 0.5) / n;
}

static void scale_pairs(struct relume_study_pairs *p)
{
    const int n = p->conditions;
    for (int i = 0; i < n; i++) {
        double sum = 0.0;
        int met = 1;  // itself
        for (int j = 0; j < n; j++) {
            const int won = p->wins[i * n + j], lost = p->wins[j * n + i];
            p->p[i * n + j] = 1.0;
            if (won + lost == 0)
                continue;
            p->chi_squared[i * n + j] = (double)(won - lost) * (won - lost) / (won + lost);
            p->p[i * n + j] = relume_study_chi_squared_p(p->chi_squared[i * n + j], 1);
            sum += relume_study_normal_z(share_won(won, lost));
            met++;
        }
        p->scale[i] = sum / met;
    }
}

static relume_status count_pairs(struct relume_study_pairs *p, const struct answers *a,
                                 const int *place, int question)
{
    const size_t n = (size_t)a->conditions.count, cells = n * n;
    bool *here = mem_zeroed((size_t)a->subjects.count, sizeof *here);
    p->conditions = (int)n;
    p->question = mem_text(a->questions.text[question]);
    p->wins = mem_zeroed(cells, sizeof *p->wins);
    p->scale = mem_zeroed(n, sizeof *p->scale);
    p->chi_squared = mem_zeroed(cells, sizeof *p->chi_squared);
    p->p = mem_zeroed(cells, sizeof *p->p);
    relume_status status = here && p->question && p->wins && p->scale && p->chi_squared && p->p
                               ? RELUME_OK
                               : RELUME_ENOMEM;
    if (!status)
        status = copy_names(&p->name, &a->conditions);
    for (size_t i = 0; !status && i < a->count; i++) {
        const struct answer *x = &a->answer[i];
        if (x->question != question)
            continue;
        p->wins[(size_t)place[x->chosen] * n + (size_t)place[x->other]]++;
        p->answers++;
        p->subjects += !here[x->subject];
        here[x->subject] = true;
    }
    if (!status)
        scale_pairs(p);
    mem_free(here);
    return status;
}

static relume_status analyse_pairs(struct relume_study_result *out, const struct answers *a,
                                   const int *place)
{
    out->pairs = mem_zeroed((size_t)a->questions.count, sizeof *out->pairs);
    relume_status status = out->pairs ? RELUME_OK : RELUME_ENOMEM;
    for (int q = 0; !status && q < a->questions.count; q++) {
        out->questions = q + 1;
        status = count_pairs(&out->pairs[q], a, place, q);
    }
    return status;
}

// ---------------------------------------------------------------- ratings

struct moments {
    int n;
    double sum, squares;
};

static void add(struct moments *m, double x)
{
    m->n++;
    m->sum += x;
    m->squares += x * x;
}

static double mean_of(const struct moments *m)
{
    return m->n ? m->sum / m->n : 0.0;
}

static double variance_of(const struct moments *m)
{
    return m->n ? fmax(m->squares / m->n - mean_of(m) * mean_of(m), 0.0) : 0.0;
}

// Scores of somebody who gives the same to all say nothing: 0.
static double normalised(const struct moments *subject, double score)
{
    const double deviation = sqrt(variance_of(subject));
    return deviation > 0.0 ? (score - mean_of(subject)) / deviation : 0.0;
}

// Over the subjects who have seen both.
static void compare(struct relume_study_ratings *r, const struct moments *by, int a, int b)
{
    struct moments d = {0};
    const int n = r->conditions;
    for (int s = 0; s < r->subjects; s++) {
        const struct moments *of = by + (size_t)s * (size_t)n;
        if (!of[a].n || !of[b].n)
            continue;
        const double difference = mean_of(&of[a]) - mean_of(&of[b]);
        add(&d, difference);
        r->positive[a * n + b] += difference > 0.0;
    }
    r->difference[a * n + b] = mean_of(&d);
    const double error = d.n > 1 ? sqrt(variance_of(&d) / (d.n - 1)) : 0.0;
    r->t[a * n + b] = error > 0.0 ? mean_of(&d) / error : 0.0;
}

static relume_status analyse_ratings(struct relume_study_ratings *r, const struct answers *a,
                                     const int *place)
{
    const size_t n = (size_t)a->conditions.count, people = (size_t)a->subjects.count;
    struct moments *subject = mem_zeroed(people, sizeof *subject);
    struct moments *by = mem_zeroed(people * n, sizeof *by);
    struct moments *raw = mem_zeroed(n, sizeof *raw), *all = mem_zeroed(n, sizeof *all);
    r->count = mem_zeroed(n, sizeof *r->count);
    r->raw = mem_zeroed(n, sizeof *r->raw);
    r->mean = mem_zeroed(n, sizeof *r->mean);
    r->difference = mem_zeroed(n * n, sizeof *r->difference);
    r->t = mem_zeroed(n * n, sizeof *r->t);
    r->positive = mem_zeroed(n * n, sizeof *r->positive);
    r->conditions = (int)n;
    r->subjects = (int)people;
    relume_status status = subject && by && raw && all && r->count && r->raw && r->mean &&
                                   r->difference && r->t && r->positive
                               ? copy_names(&r->name, &a->conditions)
                               : RELUME_ENOMEM;
    for (size_t i = 0; !status && i < a->count; i++)
        add(&subject[a->answer[i].subject], a->answer[i].score);
    for (size_t i = 0; !status && i < a->count; i++) {
        const struct answer *x = &a->answer[i];
        const size_t c = (size_t)place[x->chosen];
        const double z = normalised(&subject[x->subject], x->score);
        add(&raw[c], x->score);
        add(&all[c], z);
        add(&by[(size_t)x->subject * n + c], z);
    }
    for (size_t c = 0; !status && c < n; c++) {
        r->count[c] = raw[c].n;
        r->raw[c] = mean_of(&raw[c]);
        r->mean[c] = mean_of(&all[c]);
        for (size_t d = 0; d < n; d++)
            compare(r, by, (int)c, (int)d);
    }
    mem_free(subject);
    mem_free(by);
    mem_free(raw);
    mem_free(all);
    return status;
}

relume_status relume_study_analyse(struct relume_study_result *out, const char *const *path,
                                   int paths, const struct relume_log *log)
{
    struct answers a = {0};
    int *place = NULL;
    relume_status status = paths > 0 ? RELUME_OK : RELUME_EINVAL;
    *out = (struct relume_study_result){0};
    for (int i = 0; !status && i < paths; i++)
        status = answers_read(&a, path[i], log);
    if (!status && !a.count)
        status = log_fail(log, RELUME_EUNFIT, "%s: no answers", path[0]);
    if (!status)
        status = words_sort(&a.conditions, &place);
    if (!status)
        status =
            a.ratings ? analyse_ratings(&out->ratings, &a, place) : analyse_pairs(out, &a, place);
    mem_free(place);
    answers_free(&a);
    if (status)
        relume_study_free(out);
    return status;
}
