// ies.c - goniometric distributions: IESNA LM-63 (1986, 1991, 1995, 2002), type C photometry
//
// After an optional version line and keyword lines comes TILT=; from there on the file is numbers
// between blanks and commas. Type C: vertical angles from the lamp's axis, horizontal ones around
// it; what is left out by symmetry is folded back when a value is asked for.
#include <relume/light.h>

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "relight/light/environment.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    MOST_ANGLES = 4096,  // in one direction; real files have up to 361
    MOST_BYTES = 32 * 1024 * 1024,
};

// How the horizontal angles of a file cover the circle.
enum fold { FOLD_ROUND, FOLD_QUARTER, FOLD_HALF, FOLD_SIDE, FOLD_NONE };

struct relume_ies {
    int verticals, horizontals;
    double *vertical, *horizontal;  // degrees, ascending
    float *value;                   // [horizontals][verticals], of the largest
    double candela;
    enum fold fold;
};

struct reader {
    const char *at;
    const char *name;
    const struct relume_log *log;
};

void relume_ies_destroy(relume_ies **ies)
{
    if (!*ies)
        return;
    mem_free((*ies)->vertical);
    mem_free((*ies)->horizontal);
    mem_free((*ies)->value);
    mem_free(*ies);
    *ies = NULL;
}

// ---------------------------------------------------------------- numbers

static relume_status take_number(struct reader *r, double *out, const char *what)
{
    char *end;
    r->at += strspn(r->at, " \t\r\n\f\v,");
    *out = strtod(r->at, &end);
    if (end == r->at)
        return log_fail(r->log, RELUME_EFORMAT, "%s: %s; expected a number, found %s%.12s", r->name,
                        what, *r->at ? "" : "the end of the file", r->at);
    if (!isfinite(*out))
        return log_fail(r->log, RELUME_EFORMAT, "%s: %s; expected a finite number, found %.12s",
                        r->name, what, r->at);
    r->at = end;
    return RELUME_OK;
}

static relume_status take_count(struct reader *r, int *out, int least, int most, const char *what)
{
    double n;
    const relume_status status = take_number(r, &n, what);
    if (status)
        return status;
    if (n != floor(n) || n < least || n > most)
        return log_fail(r->log, RELUME_EFORMAT, "%s: %s; expected %d to %d, found %g", r->name,
                        what, least, most, n);
    *out = relume_whole(n);
    return RELUME_OK;
}

static relume_status skip(struct reader *r, int count, const char *what)
{
    relume_status status = RELUME_OK;
    double unused;
    for (int i = 0; !status && i < count; i++)
        status = take_number(r, &unused, what);
    return status;
}

static relume_status take_angles(struct reader *r, double *out, int count, double most,
                                 const char *what)
{
    for (int i = 0; i < count; i++) {
        const relume_status status = take_number(r, &out[i], what);
        if (status)
            return status;
        if (out[i] < 0.0 || out[i] > most || (i && out[i] <= out[i - 1]))
            return log_fail(r->log, RELUME_EFORMAT,
                            "%s: %s; expected ascending angles in 0 to %g, found %g", r->name, what,
                            most, out[i]);
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- parts of a file

static const char *next_line(const char *at)
{
    at += strcspn(at, "\r\n");
    return at + strspn(at, "\r\n");
}

static relume_status find_tilt(struct reader *r)
{
    r->at += strspn(r->at, " \t\r\n");
    while (*r->at && strncmp(r->at, "TILT=", 5))
        r->at = next_line(r->at);
    if (!*r->at)
        return log_fail(r->log, RELUME_EFORMAT,
                        "%s: no line TILT=; expected a photometric file (IES LM-63)", r->name);
    r->at += 5;
    return RELUME_OK;
}

static bool take_word(struct reader *r, const char *word)
{
    const size_t n = strlen(word);
    if (strncmp(r->at, word, n) || (r->at[n] && !strchr(" \t\r\n", r->at[n])))
        return false;
    r->at += n;
    return true;
}

// How a lamp behaves when it is tilted does not change where its light goes: read and left out.
static relume_status skip_tilt(struct reader *r)
{
    int pairs, geometry;
    if (take_word(r, "NONE"))
        return RELUME_OK;
    if (!take_word(r, "INCLUDE"))
        return log_fail(r->log, RELUME_EUNSUPPORTED, "%s: TILT=%.*s; expected NONE or INCLUDE",
                        r->name,
                        (int)strcspn(r->at, "\r\n") < 40 ? (int)strcspn(r->at, "\r\n") : 40, r->at);
    relume_status status = take_count(r, &geometry, 1, 3, "lamp geometry");
    if (!status)
        status = take_count(r, &pairs, 0, MOST_ANGLES, "number of tilt angles");
    return status ? status : skip(r, 2 * pairs, "tilt angles and factors");
}

static relume_status check_type(struct reader *r)
{
    int type;
    const relume_status status = take_count(r, &type, 1, 3, "photometric type");
    if (status || type == 1)
        return status;
    return log_fail(r->log, RELUME_EUNSUPPORTED, "%s: photometry of type %c; expected type C (1)",
                    r->name, type == 2 ? 'B' : 'A');
}

static relume_status take_header(struct reader *r, relume_ies *ies, double *factor)
{
    int lamps;
    double ballast = 1.0;
    relume_status status = take_count(r, &lamps, 0, 1000000, "number of lamps");
    if (!status)
        status = skip(r, 1, "lumens per lamp");
    if (!status)
        status = take_number(r, factor, "candela multiplier");
    if (!status)
        status = take_count(r, &ies->verticals, 1, MOST_ANGLES, "number of vertical angles");
    if (!status)
        status = take_count(r, &ies->horizontals, 1, MOST_ANGLES, "number of horizontal angles");
    if (!status)
        status = check_type(r);
    if (!status)
        status = skip(r, 4, "unit and size of the lamp");
    if (!status)
        status = take_number(r, &ballast, "ballast factor");
    if (!status)
        status = skip(r, 2, "ballast-lamp factor and watts");
    *factor *= ballast;
    if (!status && !(*factor > 0.0 && isfinite(*factor)))
        status = log_fail(r->log, RELUME_EFORMAT,
                          "%s: candela multiplier times ballast factor; expected more than 0, "
                          "found %g",
                          r->name, *factor);
    return status;
}

// A file cannot promise more values than it has bytes to write them.
static relume_status create_table(struct reader *r, relume_ies *ies)
{
    const size_t n = (size_t)ies->verticals * (size_t)ies->horizontals;
    if (2 * n > strlen(r->at) + 1)
        return log_fail(r->log, RELUME_EDAMAGED,
                        "%s: %d x %d candela values; expected as many numbers, the file is shorter",
                        r->name, ies->verticals, ies->horizontals);
    ies->vertical = mem_array((size_t)ies->verticals, sizeof *ies->vertical);
    ies->horizontal = mem_array((size_t)ies->horizontals, sizeof *ies->horizontal);
    ies->value = mem_array(n, sizeof *ies->value);
    return ies->vertical && ies->horizontal && ies->value ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status find_fold(struct reader *r, relume_ies *ies)
{
    static const struct {
        double first, last;
        enum fold fold;
    } known[] = {
        {0, 0, FOLD_ROUND},   {0, 90, FOLD_QUARTER}, {0, 180, FOLD_HALF},
        {90, 270, FOLD_SIDE}, {0, 360, FOLD_NONE},
    };
    const double first = ies->horizontal[0], last = ies->horizontal[ies->horizontals - 1];
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (first == known[i].first && last == known[i].last) {
            ies->fold = known[i].fold;
            return RELUME_OK;
        }
    return log_fail(r->log, RELUME_EFORMAT,
                    "%s: horizontal angles %g to %g; expected 0, 0 to 90, 0 to 180, 90 to 270 or "
                    "0 to 360",
                    r->name, first, last);
}

static relume_status take_candela(struct reader *r, relume_ies *ies, double factor)
{
    const size_t n = (size_t)ies->verticals * (size_t)ies->horizontals;
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        double candela;
        const relume_status status = take_number(r, &candela, "candela values");
        if (status)
            return status;
        if (candela < 0.0 || candela > 1e30)
            return log_fail(r->log, RELUME_EFORMAT, "%s: candela; expected 0 or more, found %g",
                            r->name, candela);
        ies->value[i] = (float)candela;
        most = fmax(most, (double)ies->value[i]);
    }
    if (!(most > 0.0))
        return log_fail(r->log, RELUME_EFORMAT, "%s: all candela values are 0; expected light",
                        r->name);
    for (size_t i = 0; i < n; i++)
        ies->value[i] = (float)((double)ies->value[i] / most);
    ies->candela = most * factor;
    return RELUME_OK;
}

static relume_status check_end(struct reader *r)
{
    double more;
    struct reader quiet = {r->at, r->name, NULL};
    if (take_number(&quiet, &more, ""))
        return RELUME_OK;
    return log_fail(r->log, RELUME_EFORMAT,
                    "%s: holds more numbers than its counts promise; expected the end of the file",
                    r->name);
}

static relume_status read_all(struct reader *r, relume_ies *ies)
{
    double factor;
    relume_status status = find_tilt(r);
    if (!status)
        status = skip_tilt(r);
    if (!status)
        status = take_header(r, ies, &factor);
    if (!status)
        status = create_table(r, ies);
    if (!status)
        status = take_angles(r, ies->vertical, ies->verticals, 180.0, "vertical angles");
    if (!status)
        status = take_angles(r, ies->horizontal, ies->horizontals, 360.0, "horizontal angles");
    if (!status)
        status = find_fold(r, ies);
    if (!status)
        status = take_candela(r, ies, factor);
    return status ? status : check_end(r);
}

relume_status relume_ies_parse(relume_ies **out, const char *text, size_t size, const char *name,
                               const struct relume_log *log)
{
    char *copy = mem_array(size + 1, 1);
    *out = mem_zeroed(1, sizeof **out);
    relume_status status = copy && *out ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        memcpy(copy, text, size);
        copy[size] = '\0';
        status = read_all(&(struct reader){copy, name, log}, *out);
    }
    mem_free(copy);
    if (status)
        relume_ies_destroy(out);
    return status;
}

relume_status relume_ies_load(relume_ies **out, const char *path, const struct relume_log *log)
{
    char *text;
    size_t size;
    *out = NULL;
    relume_status status = input_load(&text, &size, path, MOST_BYTES, "a photometric file", log);
    if (!status)
        status = relume_ies_parse(out, text, size, path, log);
    mem_free(text);
    return status;
}

// ---------------------------------------------------------------- values

static double folded(enum fold fold, double degrees)
{
    double h = fmod(degrees, 360.0);
    h = h < 0.0 ? h + 360.0 : h;
    switch (fold) {
    case FOLD_ROUND: return 0.0;
    case FOLD_QUARTER: h = h > 180.0 ? 360.0 - h : h; return h > 90.0 ? 180.0 - h : h;
    case FOLD_HALF: return h > 180.0 ? 360.0 - h : h;
    case FOLD_SIDE: return h < 90.0 ? 180.0 - h : h > 270.0 ? 540.0 - h : h;
    case FOLD_NONE: break;
    }
    return h;
}

// The interval of `angle` among n ascending ones and the place in it; n = 1: always the first.
static int interval(const double *angles, int n, double angle, float *share)
{
    int low = 0, high = n - 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (angles[middle] <= angle)
            low = middle;
        else
            high = middle;
    }
    *share = high > low ? (float)((angle - angles[low]) / (angles[high] - angles[low])) : 0.0f;
    return low;
}

static float column(const relume_ies *ies, int h, int v, float share)
{
    const float *at = ies->value + (size_t)h * (size_t)ies->verticals + v;
    return share > 0.0f ? at[0] * (1.0f - share) + at[1] * share : at[0];
}

double relume_ies_value(const relume_ies *ies, double vertical_deg, double horizontal_deg)
{
    // Angles are of rays in double precision: an edge is exact to a billionth of a degree.
    const double slack = 1e-9;
    const double first = ies->vertical[0], last = ies->vertical[ies->verticals - 1];
    float down, around;
    if (!(vertical_deg >= first - slack && vertical_deg <= last + slack) ||
        !isfinite(horizontal_deg))
        return 0.0;
    const double inside = fmin(fmax(vertical_deg, first), last);
    const int v = interval(ies->vertical, ies->verticals, inside, &down);
    const int h =
        interval(ies->horizontal, ies->horizontals, folded(ies->fold, horizontal_deg), &around);
    const float a = column(ies, h, v, down);
    return (double)(around > 0.0f ? a * (1.0f - around) + column(ies, h + 1, v, down) * around : a);
}

double relume_ies_candela(const relume_ies *ies)
{
    return ies->candela;
}
