// cli.h - what the commands of the tool share: options, messages, exit status
#ifndef CLI_H
#define CLI_H

#include <relume/relume.h>
#include <stddef.h>
#include <stdio.h>

// OPTION_OUTPUT and those behind it are text that names what is written; any other text, and any
// input, that names a file or folder is taken as read: no output replaces it. The endings of the
// last three are looked at before a command runs.
enum option_kind {
    OPTION_FLAG,
    OPTION_INT,
    OPTION_NUMBER,
    OPTION_TEXT,
    OPTION_TEXTS,  // may be repeated
    OPTION_OUTPUT,
    OPTION_PICTURE,  // a picture of any format
    OPTION_FLOATS,   // a picture of values that are no light
    OPTION_RELUME,   // a relume file
};

struct option {
    const char *name;  // "--size" or "-o"
    enum option_kind kind;
    size_t offset;         // of the member of the command's struct that holds its value
    const char *group;     // where help lists it
    const char *argument;  // how help calls the value: "N"
    const char *help;
    double min, max;  // range of numbers; both 0: any
};

// Rows of a table. OPTIONS is the struct that they fill; its first member is `struct args args`.
// clang-format off
#define OPTION_AT(type, member) \
    _Generic(((OPTIONS *)NULL)->member, type: offsetof(OPTIONS, member))
#define FLAG(name, member, group, help) \
    {name, OPTION_FLAG, OPTION_AT(bool, member), group, NULL, help, 0, 0}
#define INT(name, member, group, argument, help, min, max) \
    {name, OPTION_INT, OPTION_AT(int, member), group, argument, help, min, max}
#define NUMBER(name, member, group, argument, help, min, max) \
    {name, OPTION_NUMBER, OPTION_AT(double, member), group, argument, help, min, max}
#define TEXTS(name, member, group, argument, help) \
    {name, OPTION_TEXTS, OPTION_AT(struct texts, member), group, argument, help, 0, 0}
#define TEXT(name, member, group, argument, help) \
    TEXT_AS(OPTION_TEXT, name, member, group, argument, help)
#define TEXT_AS(kind, name, member, group, argument, help) \
    {name, kind, OPTION_AT(const char *, member), group, argument, help, 0, 0}
// clang-format on

// Of an option that may be repeated.
struct texts {
    int count;
    const char *const *text;
};

// Of every command that reads captures.
#define ALLOW_OUTSIDE_OPTION                                                                       \
    FLAG("--allow-outside", allow_outside, "input",                                                \
         "files that the capture names may lie outside its folder")

// What every command gets; the options of its own follow in its struct.
struct args {
    const struct relume_log *log;  // messages and progress to stderr
    int threads;                   // 0: all
    int inputs;
    const char *const *input;
    bool quiet, help, any_format;
    const char *max_memory, *max_pixels;
    const struct parsed *parsed;
};

// One command, one cmd_*.c file, one entry in commands[] (main.c). Help is made from it.
struct command {
    const char *name;     // of a task of a command two words: "btf fit"
    const char *usage;    // what follows the name: "CAPTURE -o FILE.exr"
    const char *summary;  // one line
    const char *example;  // complete command line
    int min_inputs, max_inputs;
    const struct option *options;        // common options are added
    const char *groups;                  // help shows these groups only; NULL: all
    size_t size;                         // of the struct that they fill
    const void *defaults;                // such a struct; NULL: zeros
    const struct command *const *tasks;  // instead of all that: what its next word names
    relume_status (*run)(const struct args *args);
};
extern const struct command *const commands[];

// Whether the option was given that fills `member` of the struct of `args`.
bool args_given(const struct args *args, const void *member);
// A log that says which file its sentences are about: "PREFIX: ...".
struct prefix_log {
    struct relume_log log;
    const struct relume_log *to;
    const char *prefix;
};
const struct relume_log *prefix_log(struct prefix_log *p, const struct relume_log *to,
                                    const char *prefix);

// A sentence to the log.
__attribute__((format(printf, 3, 4))) void say(const struct args *args, enum relume_level level,
                                               const char *format, ...);
// "relume: ..." on stderr; returns RELUME_EINVAL, so that a command may return it.
__attribute__((format(printf, 1, 2))) relume_status usage_error(const char *format, ...);
// The same for inputs at fault: RELUME_EUNFIT.
__attribute__((format(printf, 1, 2))) relume_status data_error(const char *format, ...);
// RELUME_EINVAL and "unknown WHAT 'given'; did you mean ...? Expected one of ...".
relume_status unknown_name(const char *what, const char *given, const char *const *names);
// `count` numbers separated by commas or blanks, nothing else.
bool parse_numbers(const char *text, double *out, int count);
// "x,y,z" of an option; RELUME_EINVAL with a sentence.
relume_status args_vec3(struct relume_vec3 *out, const char *option, const char *text);
// NULL, an option that was not given, leaves `*out` as it is.
relume_status args_transfer(struct relume_transfer *out, const char *option, const char *text);
// "auto", "linear" or "display", of --domain.
relume_status args_domain(enum relume_domain *out, const char *text);

// What a PSNR means for who looks at the pictures: "differences not visible".
const char *judgement(double psnr_db);

// The file that `relume encode CAPTURE -o OUTPUT` makes, and what it says.
relume_status encode_as_usual(const struct args *args, const char *capture, const char *output);

// A name or note as a line for people may hold it; the text lives in `out`.
struct shown {
    char text[4096];
};
const char *shown(struct shown *out, const char *text);
// A number for JSON output: never NaN or Inf (null instead).
void json_number(FILE *out, double value);
// A text with its quotes. What a terminal would obey is escaped, what is no UTF-8 is U+FFFD.
void json_text(FILE *out, const char *text);

#endif
