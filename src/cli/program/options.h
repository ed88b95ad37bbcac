// options.h - a command line as a table: each row says what an option takes, and what of it goes
// into which member of a struct. Values are read, and refused, here alone
#ifndef PROGRAM_OPTIONS_H
#define PROGRAM_OPTIONS_H

#include "cli/program/state_line.h"

#include <relume/image.h>
#include <stddef.h>

// OPTION_OUTPUT and those behind it are text that names what is written; Inputs and
// OPTION_TEXT, OPTION_TEXTS and OPTION_FILES that name a file or folder are taken as read: no
// output replaces it. OPTION_PROSE names none.
enum option_kind {
    OPTION_GROUP,    // no option: the heading of the rows that follow
    OPTION_FLAG,     // bool
    OPTION_INT,      // int
    OPTION_NUMBER,   // double; NaN for the first of `names`
    OPTION_NUMBERS,  // double[count], "x,y,z"
    OPTION_POINTS,   // struct points: may be repeated
    OPTION_SIZE,     // int[2], "WxH"; where min is 0 one side may be left out and is 0
    OPTION_NAME,     // int or an enum: the place in `names`, counted from min
    OPTION_ENTRY,  // the entry of a table that begins with this name; NULL for the first of `names`
    OPTION_OWN,    // what `take` makes of it
    OPTION_BYTES,  // uint64_t, "500M"
    OPTION_TRANSFER,  // struct relume_transfer
    OPTION_TEXT,
    OPTION_TEXTS,  // struct texts: may be repeated
    OPTION_FILES,  // the same: takes several files after it
    OPTION_PROSE,  // text for people
    OPTION_STATE,  // a line of other options (state_line.h), before which those beside it count
    OPTION_OUTPUT,
    OPTION_PICTURE,  // a picture of any format, by the ending of its name
    OPTION_FLOATS,   // a picture of values that are no light
    OPTION_RELUME,   // a relume file
    OPTION_RIG,      // lights
};

struct option {
    const char *name;  // "--size" or "-o"; of a group its heading
    enum option_kind kind;
    bool needed;           // the command does nothing without it
    bool list;             // several, separated by commas: struct ints, or struct entries
    int count;             // of OPTION_NUMBERS
    size_t offset;         // of the member of the struct that holds the value
    const char *argument;  // how help calls the value: "N"
    const char *help;      // NULL: not shown, an old spelling
    double min, max;       // range of numbers; both 0: any
    const char *const *names;
    const void *const *table;  // NULL-terminated; entries are structs that begin with their name
    relume_status (*take)(void *member, const struct option *option, const char *text,
                          const struct relume_log *log);
};

// Of options that may be repeated.
struct texts {
    int count;
    const char *const *text;
};
struct points {
    int count;
    const struct relume_vec3 *point;
};
enum { MOST_ITEMS = 64 };
struct ints {
    int count;
    int item[MOST_ITEMS];
};
struct entries {
    int count;
    const void *item[MOST_ITEMS];
};

// Rows of a table. OPTIONS is the struct that they fill.
// clang-format off
#define OPTION_AT(type, member) \
    _Generic(((OPTIONS *)NULL)->member, type: offsetof(OPTIONS, member))
#define ROW(n, k, at, a, h) .name = n, .kind = k, .offset = at, .argument = a, .help = h
#define NAMES(...) (const char *const[]){__VA_ARGS__, NULL}

#define GROUP(heading) {.name = heading, .kind = OPTION_GROUP}
#define FLAG(name, member, help) {ROW(name, OPTION_FLAG, OPTION_AT(bool, member), NULL, help)}
#define INT(name, member, argument, help, low, high) \
    {ROW(name, OPTION_INT, OPTION_AT(int, member), argument, help), .min = low, .max = high}
#define NUMBER(name, member, argument, help, low, high) \
    {ROW(name, OPTION_NUMBER, OPTION_AT(double, member), argument, help), .min = low, .max = high}
#define NUMBERS(name, member, argument, help, n) \
    {ROW(name, OPTION_NUMBERS, OPTION_AT(double *, member), argument, help), .count = n}
#define POINT(name, member, argument, help) \
    {ROW(name, OPTION_NUMBERS, OPTION_AT(struct relume_vec3, member), argument, help), .count = 3}
#define POINTS(name, member, argument, help) \
    {ROW(name, OPTION_POINTS, OPTION_AT(struct points, member), argument, help), .count = 3}
#define SIZE(name, member, argument, help, low, high) \
    {ROW(name, OPTION_SIZE, OPTION_AT(int *, member), argument, help), .min = low, .max = high}
// One of names; `from` is the number of the first one.
#define NAME(name, member, argument, help, from, ...) \
    {ROW(name, OPTION_NAME, OPTION_WORD(member), argument, help), .min = from, \
     .names = NAMES(__VA_ARGS__)}
#define OPTION_WORD(member) \
    _Generic(((OPTIONS *)NULL)->member, int: offsetof(OPTIONS, member), \
             unsigned: offsetof(OPTIONS, member))
// An entry of a table, or one of other names.
#define ENTRY(name, member, argument, help, list_of, others) \
    {ROW(name, OPTION_ENTRY, offsetof(OPTIONS, member), argument, help), \
     .table = (const void *const *)(list_of), .names = others}
#define ENTRIES(name, member, argument, help, list_of, others) \
    {ROW(name, OPTION_ENTRY, OPTION_AT(struct entries, member), argument, help), \
     .table = (const void *const *)(list_of), .names = others, .list = true}
// A list of names or numbers.
#define WORDS(name, member, argument, help, kind, ...) \
    {ROW(name, kind, OPTION_AT(struct ints, member), argument, help), .list = true, __VA_ARGS__}
#define OWN(name, member, argument, help, function) \
    {ROW(name, OPTION_OWN, offsetof(OPTIONS, member), argument, help), .take = function}
#define BYTES(name, member, argument, help) \
    {ROW(name, OPTION_BYTES, OPTION_AT(uint64_t, member), argument, help)}
#define TRANSFER(name, member, help) \
    {ROW(name, OPTION_TRANSFER, OPTION_AT(struct relume_transfer, member), "T", help)}
#define TEXTS(name, member, argument, help) \
    {ROW(name, OPTION_TEXTS, OPTION_AT(struct texts, member), argument, help)}
// Files up to the next option belong to it, where inputs are left; a folder stands alone.
#define FILES(name, member, argument, help) \
    {ROW(name, OPTION_FILES, OPTION_AT(struct texts, member), argument, help)}
#define TEXT(name, member, argument, help) TEXT_AS(OPTION_TEXT, name, member, argument, help)
#define PROSE(name, member, argument, help) TEXT_AS(OPTION_PROSE, name, member, argument, help)
#define TEXT_AS(kind, name, member, argument, help) \
    {ROW(name, kind, OPTION_AT(const char *, member), argument, help)}
// -o of what does nothing without it
#define OUTPUT(kind, member, argument, help) \
    {ROW("-o", kind, OPTION_AT(const char *, member), argument, help), .needed = true}
// clang-format on

enum { MOST_ARGUMENTS = 4096 };

struct given {
    const struct option *option;
    const char *text;  // NULL of a flag
    bool of_state;     // from the line of an OPTION_STATE
    bool follows;      // one more file of the OPTION_FILES before it
};

// A command line and what it was split into. The texts are those of `argv`.
struct command_line {
    const char *name;                // that sentences begin with; NULL: none
    const struct option *tables[3];  // NULL-terminated
    void *values;                    // the struct that they fill
    const struct relume_log *log;
    int given_count, input_count, listed, pointed;
    struct given given[MOST_ARGUMENTS];
    const char *input[MOST_ARGUMENTS];
    const char *list[MOST_ARGUMENTS];  // of options that may be repeated
    struct relume_vec3 point[MOST_ARGUMENTS];
    char state[STATE_LINE_MOST];  // values of the last OPTION_STATE
};

// Fills `values` and `input` of a line whose first four members are set. RELUME_EINVAL with a
// sentence; the status of an option's own function.
relume_status command_line_parse(struct command_line *line, int argc, char **argv);
// Whether an option was given that fills `member` of the struct.
bool option_given(const struct command_line *line, const void *member);
const struct option *option_find(const struct option *table, const char *name);
// "-5" and "-.5" are values, "-o" is an option.
bool is_option(const char *text);
// The next "names": an array of `most` names that `n` are in already. Returns how many there are.
int option_names(const char **names, int n, int most, const struct option *table);
// RELUME_EINVAL and "unknown WHAT 'given'; did you mean ...? Expected one of ...".
relume_status unknown_word(const struct relume_log *log, const char *what, const char *given,
                           const char *const *names);

// As help shows them, names and arguments `width` wide: groups in the order of their first rows,
// those alone that `groups` names, NULL: all.
void options_print(const struct option *table, const char *groups, int width);

#endif
