// light_columns.c - titles of columns, as programs and people write them
#include "capture/manifest/light_columns.h"

#include "core/base/log.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum column {
    COLUMN_OTHER,
    COLUMN_NAME,
    COLUMN_INDEX,
    COLUMN_X,
    COLUMN_Y,
    COLUMN_Z,
    COLUMN_THETA,
    COLUMN_AZIMUTH,
    COLUMN_ELEVATION,
    COLUMN_RADIANS,
    COLUMNS
};

static const struct {
    const char *key;
    enum column column;
} titles[] = {
    {"name", COLUMN_NAME},
    {"filename", COLUMN_NAME},
    {"file", COLUMN_NAME},
    {"image", COLUMN_NAME},
    {"imagename", COLUMN_NAME},
    {"imagefile", COLUMN_NAME},
    {"img", COLUMN_NAME},
    {"photo", COLUMN_NAME},
    {"photograph", COLUMN_NAME},
    {"picture", COLUMN_NAME},
    {"path", COLUMN_NAME},
    {"filepath", COLUMN_NAME},
    {"imagepath", COLUMN_NAME},
    {"frame", COLUMN_NAME},
    {"light", COLUMN_NAME},
    {"lightname", COLUMN_NAME},
    {"lamp", COLUMN_NAME},
    {"led", COLUMN_NAME},
    {"index", COLUMN_INDEX},
    {"id", COLUMN_INDEX},
    {"no", COLUMN_INDEX},
    {"nr", COLUMN_INDEX},
    {"number", COLUMN_INDEX},
    {"num", COLUMN_INDEX},
    {"theta", COLUMN_THETA},
    {"zenith", COLUMN_THETA},
    {"polar", COLUMN_THETA},
    {"phi", COLUMN_AZIMUTH},
    {"azimuth", COLUMN_AZIMUTH},
    {"az", COLUMN_AZIMUTH},
    {"elevation", COLUMN_ELEVATION},
    {"el", COLUMN_ELEVATION},
    {"elev", COLUMN_ELEVATION},
    {"altitude", COLUMN_ELEVATION},
};

// Words that a title adds to the letter of an axis.
static const char *const affixes[] = {
    "",
    "l",
    "d",
    "p",
    "v",
    "dir",
    "direction",
    "pos",
    "position",
    "light",
    "lightdir",
    "lightpos",
    "vec",
    "vector",
    "led",
    "lamp",
    "lightdirection",
    "lightposition",
};

static bool is_affix(const char *text, size_t length)
{
    for (size_t i = 0; i < sizeof affixes / sizeof *affixes; i++)
        if (strlen(affixes[i]) == length && !strncmp(affixes[i], text, length))
            return true;
    return false;
}

static bool cut_ending(char *key, const char *ending)
{
    const size_t n = strlen(key), m = strlen(ending);
    const bool has = n > m && !strcmp(key + n - m, ending);
    if (has)
        key[n - m] = '\0';
    return has;
}

// Only letters and digits, in lower case: "Light_X [mm]" is "lightxmm".
static void make_key(char key[48], const struct light_word *word)
{
    int n = 0;
    for (int i = 0; i < word->length && n < 47; i++)
        if (isalnum((unsigned char)word->text[i]))
            key[n++] = (char)tolower((unsigned char)word->text[i]);
    key[n] = '\0';
}

static enum column column_of(const struct light_word *word)
{
    char key[48];
    make_key(key, word);
    const bool radians = cut_ending(key, "radians") || cut_ending(key, "rad");
    if (!cut_ending(key, "degrees") && !cut_ending(key, "deg") && !cut_ending(key, "mm"))
        (void)cut_ending(key, "cm");
    for (size_t i = 0; i < sizeof titles / sizeof *titles; i++)
        if (!strcmp(key, titles[i].key))
            return radians ? COLUMN_RADIANS : titles[i].column;
    const size_t n = strlen(key);
    if (n && key[n - 1] >= 'x' && key[n - 1] <= 'z' && is_affix(key, n - 1))
        return (enum column)(COLUMN_X + key[n - 1] - 'x');
    if (n && key[0] >= 'x' && key[0] <= 'z' && is_affix(key + 1, n - 1))
        return (enum column)(COLUMN_X + key[0] - 'x');
    return COLUMN_OTHER;
}

static char delimiter_of(const struct light_line *line)
{
    static const char delimiters[] = ";\t,";
    for (const char *d = delimiters; *d; d++)
        if (memchr(line->start, *d, (size_t)(line->end - line->start)))
            return *d;
    return ' ';
}

static void split(struct light_row *row, const struct light_line *line, char delimiter)
{
    if (delimiter == ' ')
        light_row_split(row, line, false);
    else
        light_row_fields(row, line, delimiter);
}

// Finds the first and second column of each kind, -1 without one. Returns the number of unknown
// ones.
static int sort_titles(int at[COLUMNS], int twice[COLUMNS], const struct light_row *row)
{
    int unknown = 0;
    for (int c = 0; c < COLUMNS; c++)
        at[c] = twice[c] = -1;
    for (int i = 0; i < row->count; i++) {
        const enum column c = column_of(&row->word[i]);
        unknown += c == COLUMN_OTHER;
        if (at[c] < 0)
            at[c] = i;
        else if (twice[c] < 0)
            twice[c] = i;
    }
    return unknown;
}

static bool has_vector(struct light_columns *out, const int at[COLUMNS])
{
    const bool xyz = at[COLUMN_X] >= 0 && at[COLUMN_Y] >= 0 && at[COLUMN_Z] >= 0;
    out->elevation = at[COLUMN_ELEVATION] >= 0 && at[COLUMN_THETA] < 0;
    out->polar =
        !xyz && at[COLUMN_AZIMUTH] >= 0 && (at[COLUMN_ELEVATION] >= 0 || at[COLUMN_THETA] >= 0);
    if (out->polar) {
        out->vector[0] = out->elevation ? at[COLUMN_ELEVATION] : at[COLUMN_THETA];
        out->vector[1] = at[COLUMN_AZIMUTH];
    } else if (xyz) {
        memcpy(out->vector, &at[COLUMN_X], sizeof out->vector);
    }
    out->name = at[COLUMN_NAME];
    out->index = at[COLUMN_INDEX];
    return xyz || out->polar;
}

static relume_status refuse_twice(const struct light_columns *c, const struct light_row *row,
                                  const int at[COLUMNS], const int twice[COLUMNS], const char *path,
                                  const struct relume_log *log)
{
    static const enum column cartesian[] = {COLUMN_X, COLUMN_Y, COLUMN_Z},
                             polar[] = {COLUMN_THETA, COLUMN_AZIMUTH, COLUMN_ELEVATION};
    for (int i = 0; i < 3; i++) {
        const enum column k = c->polar ? polar[i] : cartesian[i];
        if (twice[k] < 0)
            continue;
        const struct light_word *one = &row->word[at[k]], *two = &row->word[twice[k]];
        return log_fail(log, RELUME_EFORMAT,
                        "%s: line %d; expected one column for each coordinate; found '%.*s' and "
                        "'%.*s'",
                        path, c->line, one->length < 32 ? one->length : 32, one->text,
                        two->length < 32 ? two->length : 32, two->text);
    }
    return RELUME_OK;
}

relume_status light_columns_find(struct light_columns *out, const struct light_line *line,
                                 const char *path, const struct relume_log *log)
{
    struct light_line titled = *line;
    struct light_row row;
    int at[COLUMNS], twice[COLUMNS];
    const bool comment = light_line_comment(line, &titled.start);
    if (!comment)
        titled.start = line->start;
    *out = (struct light_columns){.delimiter = delimiter_of(&titled), .line = line->number};
    split(&row, &titled, out->delimiter);
    const int unknown = sort_titles(at, twice, &row);
    out->count = row.count;
    if (row.numbers)
        return RELUME_OK;
    if (!has_vector(out, at) || (comment && unknown)) {
        if (at[COLUMN_RADIANS] < 0)
            return RELUME_OK;
        return log_fail(log, RELUME_EFORMAT,
                        "%s: line %d; expected angles in degrees; found a column in radians", path,
                        line->number);
    }
    const int *v = out->vector;
    out->found = !comment || out->polar || v[1] != v[0] + 1 || v[2] != v[1] + 1;
    return out->found ? refuse_twice(out, &row, at, twice, path, log) : RELUME_OK;
}
