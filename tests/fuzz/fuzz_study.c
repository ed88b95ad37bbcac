// fuzz_study.c - tables of answers (CSV) made of noise; what they say must be numbers
#include "fuzz.h"

#include <math.h>
#include <relume/site/study.h>

static const char *const words[] = {"subject", "question", "left",  "right", "chosen", "condition",
                                    "score",   "trial",    "\"",    "\"\"",  ",",      "\n",
                                    "\r\n",    "1e9",      "-1e-9", "nan",   "0x1p3",  NULL};

static void check(const double *x, int n)
{
    for (int i = 0; i < n; i++)
        if (!isfinite(x[i]))
            abort();
}

static void look(const struct relume_study_result *r)
{
    const struct relume_study_ratings *s = &r->ratings;
    for (int q = 0; q < r->questions; q++) {
        const struct relume_study_pairs *p = &r->pairs[q];
        check(p->scale, p->conditions);
        check(p->chi_squared, p->conditions * p->conditions);
        check(p->p, p->conditions * p->conditions);
    }
    check(s->raw, s->conditions);
    check(s->mean, s->conditions);
    check(s->difference, s->conditions * s->conditions);
    check(s->t, s->conditions * s->conditions);
}

static bool one(struct fuzz *f, struct bytes b)
{
    struct relume_study_result r;
    const char *path = f->path;
    fuzz_store(path, b);
    const relume_status status = relume_study_analyse(&r, &path, 1, NULL);
    if (!status)
        look(&r);
    relume_study_free(&r);
    return !status;
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    fuzz_begin(&f, "fuzz_study", argc, argv);
    fuzz_add_text(
        &f, "subject,trial,question,scene,left,right,chosen,seconds\n1,1,which?,a,none,static,"
            "static,2.5\n1,2,which?,a,dynamic,static,dynamic,1\n2,1,which?,a,none,dynamic,none,3\n"
            "2,2,\"brighter, or \"\"not\"\"?\",a,none,dynamic,none,3\n");
    fuzz_add_text(
        &f, "subject,condition,score\r\n1,a,4\r\n1,b,2\r\n2,a,5\r\n2,b,3.5\r\n3,a,1\r\n3,b,-2\r\n");
    return fuzz_run(&f, argc, argv, one);
}
