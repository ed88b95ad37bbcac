// cli.h - what the commands of the tool share: options, messages, exit status
#ifndef CLI_H
#define CLI_H

#include <relume/relume.h>
#include <stdio.h>

// OPTION_OUTPUT and those behind it are text that names what is written; any other text, and any
// input, that names a file or folder is taken as read: no output replaces it. The endings of the
// last three are looked at before a command runs.
enum option_kind {
    OPTION_FLAG,
    OPTION_INT,
    OPTION_NUMBER,
    OPTION_TEXT,
    OPTION_OUTPUT,
    OPTION_PICTURE,  // a picture of any format
    OPTION_FLOATS,   // a picture of values that are no light
    OPTION_RELUME,   // a relume file
};

struct option {
    const char *name;  // "--size" or "-o"
    enum option_kind kind;
    const char *argument;  // how help calls the value: "N"
    const char *help;
    double min, max;  // range of numbers; both 0: any
};

// Of every command that reads captures.
#define ALLOW_OUTSIDE_OPTION                                                                       \
    {                                                                                              \
        "--allow-outside", OPTION_FLAG, NULL,                                                      \
            "files that the capture names may lie outside its folder", 0, 0                        \
    }

struct args;

// One command, one cmd_*.c file, one entry in commands[] (main.c). Help is made from it.
struct command {
    const char *name;
    const char *usage;    // what follows the name: "CAPTURE -o FILE.exr"
    const char *summary;  // one line
    const char *example;  // complete command line
    int min_inputs, max_inputs;
    const struct option *options;  // ends with a NULL name; common options are added
    relume_status (*run)(const struct args *args);
};
extern const struct command *const commands[];

// Parsed options; the name must be in the command's table or among the common ones.
bool args_has(const struct args *args, const char *name);
int args_int(const struct args *args, const char *name, int otherwise);
double args_number(const struct args *args, const char *name, double otherwise);
const char *args_text(const struct args *args, const char *name, const char *otherwise);
int args_count(const struct args *args, const char *name);  // how often a text option was given
const char *args_nth(const struct args *args, const char *name, int n);
int args_inputs(const struct args *args);
const char *args_input(const struct args *args, int n);

int args_threads(const struct args *args);                   // --threads, 0: all
const struct relume_log *args_log(const struct args *args);  // messages and progress to stderr

// A log that says which file its sentences are about: "PREFIX: ...".
struct prefix_log {
    struct relume_log log;
    const struct relume_log *to;
    const char *prefix;
};
const struct relume_log *prefix_log(struct prefix_log *p, const struct relume_log *to,
                                    const char *prefix);

// "relume: ..." on stderr; returns RELUME_EINVAL, so that a command may return it.
__attribute__((format(printf, 1, 2))) relume_status usage_error(const char *format, ...);
// The same for inputs at fault: RELUME_EDATA.
__attribute__((format(printf, 1, 2))) relume_status data_error(const char *format, ...);
// RELUME_EINVAL and "unknown WHAT 'given'; did you mean ...? Expected one of ...".
relume_status unknown_name(const char *what, const char *given, const char *const *names);
// `count` numbers separated by commas or blanks, nothing else.
bool parse_numbers(const char *text, double *out, int count);
// "x,y,z" of an option; RELUME_EINVAL with a sentence.
relume_status args_vec3(struct relume_vec3 *out, const char *option, const char *text);

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
