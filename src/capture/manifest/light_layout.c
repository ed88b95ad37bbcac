// light_layout.c - all lines of a list vote on which of their numbers are x, y and z
#include "capture/manifest/light_layout.h"

#include "core/base/log.h"
#include "core/math/vec.h"

#include <stdio.h>
#include <string.h>

enum { RUNS = 3, OFFSETS = 16, GUESSES = RUNS * OFFSETS * 2 };

static const double UNIT = 0.02;    // lengths of directions that were rounded
static const double LEAD = 0.1;     // share of the lines by which one layout must lead
static const double ALIKE = 0.995;  // mean of unit vectors: lights never lie within 6 degrees
static const double UNEVEN = 0.25;  // standard deviation of the lengths of positions / mean
static const double CLEARLY = 1.5;  // times as even as the next layout

// Sums of one layout over all lines.
struct guess {
    struct light_layout layout;
    int fits, units, usable;
    double sum, squares;  // of the lengths
    vec3 unit_sum;
    bool dropped;
};

struct vote {
    struct guess guess[GUESSES];
    int lines, shortest[RUNS], longest[RUNS];  // of the sequences
    double first, last;                        // first number of the first sequence
    bool counts;                               // these numbers count the lines
};

// The next sequence of three and more numbers from word `from` on: its length, 0 at the end.
static int next_run(const struct light_row *row, int from, int *start)
{
    for (int i = from; i < row->count; i++) {
        int n = 0;
        while (i + n < row->count && row->word[i + n].number)
            n++;
        *start = i;
        if (n >= 3)
            return n;
        i += n;
    }
    return 0;
}

int light_layout_at(const struct light_layout *layout, const struct light_row *row)
{
    int start = 0, length = next_run(row, 0, &start);
    for (int r = 0; r < layout->run && length; r++)
        length = next_run(row, start + length, &start);
    if (length < 3 + layout->offset)
        return -1;
    return start + (layout->from_end ? length - 3 - layout->offset : layout->offset);
}

static void count_vector(struct guess *g, const struct light_word *x)
{
    vec3 v = vec3_of(x[0].value, x[1].value, x[2].value);
    const double length = vec3_length(v);
    g->fits++;
    if (!isfinite(length) || !(length > 0.0))
        return;
    g->usable++;
    g->units += fabs(length - 1.0) <= UNIT;
    g->sum += length;
    g->squares += length * length;
    g->unit_sum = vec3_add(g->unit_sum, vec3_scale(v, 1.0 / length));
}

static void count_line(struct vote *v, const struct light_row *row)
{
    int start = 0, length = 0;
    for (int r = 0; r < RUNS; r++) {
        length = next_run(row, start + length, &start);
        if (!length)
            return;
        if (!r) {
            const double value = row->word[start].value;
            v->counts =
                v->lines ? v->counts && value == v->last + 1.0 : value == 0.0 || value == 1.0;
            v->last = value;
            v->lines++;
        }
        v->shortest[r] = v->shortest[r] && v->shortest[r] < length ? v->shortest[r] : length;
        v->longest[r] = v->longest[r] > length ? v->longest[r] : length;
        for (int k = 0; k < OFFSETS && k + 3 <= length; k++) {
            struct guess *g = &v->guess[(r * OFFSETS + k) * 2];
            count_vector(&g[0], &row->word[start + k]);
            count_vector(&g[1], &row->word[start + length - 3 - k]);
        }
    }
}

static void count_lines(struct vote *v, struct light_line line, bool commas)
{
    struct light_row row;
    *v = (struct vote){0};
    for (int i = 0; i < GUESSES; i++)
        v->guess[i].layout =
            (struct light_layout){commas, i / (2 * OFFSETS), i / 2 % OFFSETS, i % 2};
    while (light_line_next(&line))
        if (!light_line_comment(&line, NULL)) {
            light_row_split(&row, &line, commas);
            count_line(v, &row);
        }
}

static int most_fits(const struct vote *v)
{
    int most = 0;
    for (int i = 0; i < GUESSES; i++)
        most = v->guess[i].fits > most ? v->guess[i].fits : most;
    return most;
}

// Layouts that fewer lines have, or that name the same numbers as another.
static void drop_misfits(struct vote *v)
{
    const int most = most_fits(v);
    for (int i = 0; i < GUESSES; i++) {
        struct guess *g = &v->guess[i];
        const int run = g->layout.run;
        g->dropped = g->fits < most || (g->layout.from_end && v->shortest[run] == v->longest[run]);
    }
}

// An index is no coordinate, and lights differ from each other.
static bool is_implausible(const struct vote *v, const struct guess *g)
{
    const bool index =
        v->counts && v->lines >= 3 && !g->layout.run && !g->layout.offset && !g->layout.from_end;
    return index || (g->usable > 1 && vec3_length(g->unit_sum) > ALIKE * g->usable);
}

static int count_left(const struct vote *v)
{
    int n = 0;
    for (int i = 0; i < GUESSES; i++)
        n += !v->guess[i].dropped;
    return n;
}

static void drop_implausible(struct vote *v)
{
    int good = 0;
    for (int i = 0; i < GUESSES; i++)
        good += !v->guess[i].dropped && !is_implausible(v, &v->guess[i]);
    for (int i = 0; good && i < GUESSES; i++)
        v->guess[i].dropped |= is_implausible(v, &v->guess[i]);
}

static double unevenness(const struct guess *g)
{
    const double mean = g->sum / g->usable;
    return g->usable ? sqrt(fmax(g->squares / g->usable - mean * mean, 0.0)) / mean : INFINITY;
}

static bool is_better(const struct guess *a, const struct guess *b)
{
    return a->units != b->units ? a->units > b->units : unevenness(a) < unevenness(b);
}

// The two best that are left.
static void find_best(const struct vote *v, const struct guess *best[2])
{
    best[0] = best[1] = NULL;
    for (int i = 0; i < GUESSES; i++) {
        const struct guess *g = &v->guess[i];
        if (g->dropped)
            continue;
        if (!best[0] || is_better(g, best[0])) {
            best[1] = best[0];
            best[0] = g;
        } else if (!best[1] || is_better(g, best[1])) {
            best[1] = g;
        }
    }
}

static bool is_clear(const struct guess *best, const struct guess *next)
{
    if (2 * best->units > best->fits)
        return next->units < best->units &&
               (best->units == best->fits || best->units - next->units >= LEAD * best->fits);
    return next->units == best->units && best->usable > 1 && unevenness(best) < UNEVEN &&
           unevenness(next) > CLEARLY * unevenness(best) + UNIT;
}

static const char *describe(char text[96], const struct light_layout *l)
{
    char run[32] = "";
    if (l->run)
        snprintf(run, sizeof run, " of sequence %d", l->run + 1);
    if (!l->from_end)
        snprintf(text, 96, "numbers %d to %d%s", l->offset + 1, l->offset + 3, run);
    else if (l->offset)
        snprintf(text, 96, "the three before the last %d%s", l->offset, run);
    else
        snprintf(text, 96, "the last three%s", run);
    return text;
}

relume_status light_layout_find(struct light_layout *out, struct light_line first, const char *path,
                                const struct relume_log *log)
{
    struct vote vote, commas;
    const struct guess *best[2];
    char text[2][96];
    count_lines(&vote, first, false);
    count_lines(&commas, first, true);
    if (most_fits(&commas) > most_fits(&vote))
        vote = commas;
    *out = (struct light_layout){0};
    if (!vote.lines)
        return RELUME_OK;
    drop_misfits(&vote);
    if (count_left(&vote) > 1)
        drop_implausible(&vote);
    find_best(&vote, best);
    *out = best[0]->layout;
    if (!best[1] || is_clear(best[0], best[1]))
        return RELUME_OK;
    return log_fail(log, RELUME_EFORMAT,
                    "%s: its lines hold more than three numbers, and %s fit a light as well as %s; "
                    "expected lines 'name x y z', or a first line that names the columns, "
                    "'name,x,y,z,...'",
                    path, describe(text[0], &best[0]->layout), describe(text[1], &best[1]->layout));
}
