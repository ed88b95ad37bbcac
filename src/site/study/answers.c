// answers.c - tables of answers: comma separated values with a line of names (RFC 4180)
#include "site/study/answers.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_COLUMNS = 32, MOST_SUBJECTS = 4096, MOST_NAMES = 256, MOST_BYTES = 64 << 20 };

int words_number(struct words *w, const char *text)
{
    for (int i = 0; i < w->count; i++)
        if (!strcmp(w->text[i], text))
            return i;
    char *copy = mem_text(text);
    if (!copy || !mem_grow(&w->text, (size_t)w->count, sizeof *w->text)) {
        mem_free(copy);
        return -1;
    }
    w->text[w->count] = copy;
    return w->count++;
}

void words_free(struct words *w)
{
    for (int i = 0; i < w->count; i++)
        mem_free(w->text[i]);
    mem_free(w->text);
    *w = (struct words){0};
}

static int by_text(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

relume_status words_sort(struct words *w, int **place)
{
    char **was = mem_copy(w->text, (size_t)w->count, sizeof *was);
    *place = mem_array((size_t)w->count, sizeof **place);
    if (!was || !*place) {
        mem_free(was);
        return RELUME_ENOMEM;
    }
    qsort(w->text, (size_t)w->count, sizeof *w->text, by_text);
    for (int i = 0; i < w->count; i++)
        (*place)[i] = words_number(w, was[i]);
    mem_free(was);
    return RELUME_OK;
}

void answers_free(struct answers *a)
{
    words_free(&a->subjects);
    words_free(&a->questions);
    words_free(&a->conditions);
    mem_free(a->answer);
    *a = (struct answers){0};
}

// Splits a line in place; quoted fields may hold commas and doubled quotes. -1: a quote is missing,
// or there are too many fields.
static int split(char *line, char *field[MOST_COLUMNS])
{
    int n = 0;
    for (char *at = line;; at++) {
        if (n == MOST_COLUMNS)
            return -1;
        char *to = at;
        field[n++] = to;
        if (*at == '"') {
            for (at++; *at && (*at != '"' || at[1] == '"'); at++) {
                at += *at == '"';
                *to++ = *at;
            }
            if (*at++ != '"')
                return -1;
        } else {
            while (*at && *at != ',')
                at++;
            to = at;
        }
        const bool more = *at == ',';
        if (*at && !more)
            return -1;
        *to = '\0';
        if (!more)
            return n;
    }
}

static int column(char *const *field, int n, const char *name)
{
    for (int i = 0; i < n; i++)
        if (!strcmp(field[i], name))
            return i;
    return -1;
}

enum { SUBJECT, QUESTION, LEFT, RIGHT, CHOSEN, CONDITION, SCORE, NAMES };
static const char *const names[NAMES] = {"subject", "question",  "left", "right",
                                         "chosen",  "condition", "score"};

struct table {
    int column[NAMES], columns;
};

static bool add_pair(struct answers *a, const struct table *t, char *const *field, bool *fits)
{
    const char *left = field[t->column[LEFT]], *right = field[t->column[RIGHT]],
               *chosen = field[t->column[CHOSEN]];
    *fits = strcmp(left, right) && (!strcmp(chosen, left) || !strcmp(chosen, right));
    if (!*fits)
        return true;
    const struct answer answer = {
        .subject = words_number(&a->subjects, field[t->column[SUBJECT]]),
        .question = words_number(&a->questions, field[t->column[QUESTION]]),
        .chosen = words_number(&a->conditions, chosen),
        .other = words_number(&a->conditions, strcmp(chosen, left) ? left : right),
    };
    if (answer.subject < 0 || answer.question < 0 || answer.chosen < 0 || answer.other < 0 ||
        !mem_grow(&a->answer, a->count, sizeof *a->answer))
        return false;
    a->answer[a->count++] = answer;
    return true;
}

static bool add_rating(struct answers *a, const struct table *t, char *const *field, bool *fits)
{
    char *end;
    const char *text = field[t->column[SCORE]];
    const double score = strtod(text, &end);
    *fits = end != text && !*end && score > -1e9 && score < 1e9;
    if (!*fits)
        return true;
    const struct answer answer = {
        .subject = words_number(&a->subjects, field[t->column[SUBJECT]]),
        .chosen = words_number(&a->conditions, field[t->column[CONDITION]]),
        .score = score,
    };
    if (answer.subject < 0 || answer.chosen < 0 ||
        !mem_grow(&a->answer, a->count, sizeof *a->answer))
        return false;
    a->answer[a->count++] = answer;
    return true;
}

static relume_status read_names(struct answers *a, struct table *t, char *line, const char *path,
                                const struct relume_log *log)
{
    char *field[MOST_COLUMNS];
    t->columns = split(line, field);
    for (int i = 0; i < NAMES; i++)
        t->column[i] = column(field, t->columns, names[i]);
    const bool pairs = t->column[SUBJECT] >= 0 && t->column[QUESTION] >= 0 &&
                       t->column[LEFT] >= 0 && t->column[RIGHT] >= 0 && t->column[CHOSEN] >= 0;
    const bool ratings =
        t->column[SUBJECT] >= 0 && t->column[CONDITION] >= 0 && t->column[SCORE] >= 0;
    if (!pairs && !ratings)
        return log_fail(log, RELUME_EFORMAT,
                        "%s: line 1: expected columns subject, question, left, right, chosen, or "
                        "subject, condition, score",
                        path);
    if (a->count && a->ratings == pairs)
        return log_fail(log, RELUME_EUNFIT, "%s: choices and ratings; expected files of one kind",
                        path);
    a->ratings = !pairs;
    return RELUME_OK;
}

static relume_status read_lines(struct answers *a, char *text, const char *path,
                                const struct relume_log *log)
{
    struct table table;
    int number = 0;
    for (char *line = text, *next; line; line = next) {
        char *field[MOST_COLUMNS];
        bool fits = false;
        next = strchr(line, '\n');
        if (next)
            *next++ = '\0';
        const size_t length = strlen(line);
        if (length && line[length - 1] == '\r')
            line[length - 1] = '\0';
        if (++number == 1) {
            const relume_status status = read_names(a, &table, line, path, log);
            if (status)
                return status;
            continue;
        }
        if (!*line)
            continue;
        if (split(line, field) == table.columns &&
            !(a->ratings ? add_rating : add_pair)(a, &table, field, &fits))
            return RELUME_ENOMEM;
        if (a->subjects.count > MOST_SUBJECTS || a->questions.count > MOST_NAMES ||
            a->conditions.count > MOST_NAMES)
            return log_fail(log, RELUME_ELIMIT,
                            "%s: line %d: too many names; expected at most %d subjects, and %d "
                            "questions and conditions",
                            path, number, MOST_SUBJECTS, MOST_NAMES);
        if (!fits)
            return log_fail(log, RELUME_EFORMAT, "%s: line %d: expected %d fields, %s", path,
                            number, table.columns,
                            a->ratings ? "the score a number"
                                       : "'chosen' being 'left' or 'right', and these different");
    }
    return RELUME_OK;
}

relume_status answers_read(struct answers *a, const char *path, const struct relume_log *log)
{
    char *text;
    size_t size;
    relume_status status =
        input_load(&text, &size, path, MOST_BYTES, "a CSV file of at most 64 MiB", log);
    if (status)
        return status;
    status = strlen(text) < size
                 ? log_fail(log, RELUME_EFORMAT, "%s: expected a CSV file, found binary data", path)
                 : read_lines(a, text, path, log);
    mem_free(text);
    return status;
}
