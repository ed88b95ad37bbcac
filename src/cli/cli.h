// cli.h - what the commands of the tool share: options, messages, exit status
#ifndef CLI_H
#define CLI_H

#include "cli/program/options.h"
#include "cli/program/output_name.h"
#include "cli/program/say.h"
#include "core/base/json_write.h"

#include <relume/extensions.h>
#include <stddef.h>
#include <stdio.h>

// Of every command that reads captures.
#define ALLOW_OUTSIDE_OPTION                                                                       \
    FLAG("--allow-outside", allow_outside, "allow files outside the folder of the capture")

// Of every command that relights files.
#define KEEP_GOING_OPTION                                                                          \
    FLAG("--keep-going", keep_going,                                                               \
         "continue without the damaged tiles of a file coded with loss, and list them")

// What every command gets; the options of its own follow in its struct, whose first member it is.
struct args {
    const struct relume_log *log;    // messages and progress to stderr
    int threads;                     // 0: all
    const struct relume_team *team;  // the other processes of relume-mpi; NULL: there are none
    int inputs;
    const char *const *input;
    bool quiet, help;
    struct relume_limits limits;
    const struct command_line *line;
    const char *program;  // as it was called
};

// One command, one cmd_*.c file, one entry in commands[] (main.c). Help is made from it.
struct command {
    const char *name;     // of a task of a command two words: "btf fit"
    const char *usage;    // what follows the name: "CAPTURE -o FILE.exr"
    const char *summary;  // one line
    const char *example;  // complete command line
    int min_inputs, max_inputs;
    bool names_built_in;           // inputs are names of what is built in, never files
    const struct option *options;  // common options are added
    const char *groups;            // help shows these groups only; NULL: all
    size_t size;                   // of the struct that they fill
    const void *defaults;          // such a struct; NULL: zeros
    // What its next word names, in place of all that; or, of a command that runs by itself, its
    // first word alone.
    const struct command *const *tasks;
    // Returns true where pictures and relume files go into other folders than their paths say,
    // which `run` checks. NULL: never.
    bool (*moves_outputs)(const struct args *args);
    relume_status (*run)(const struct args *args);
};
// With the `options` that fill OPTIONS, and `run`, of its file.
#define COMMAND(function, called, use, does, shows, least, most)                                   \
    .name = called, .usage = use, .summary = does, .example = shows, .min_inputs = least,          \
    .max_inputs = most, .options = options, .size = sizeof(OPTIONS), .run = function
extern const struct command *const commands[];

// Whether the option was given that fills `member` of the struct of a command's options.
bool given(const void *options, const void *member);

// A log that says which file its sentences are about: "PREFIX: ...".
struct prefix_log {
    struct relume_log log;
    const struct relume_log *to;
    const char *prefix;
};
const struct relume_log *prefix_log(struct prefix_log *p, const struct relume_log *to,
                                    const char *prefix);

// A sentence to the log.
__attribute__((format(printf, 3, 4))) void announce(const struct args *args,
                                                    enum relume_level level, const char *format,
                                                    ...);
// "relume: ..." on stderr; returns `status`, so that a command may return it. Of wrong usage, and
// of inputs at fault.
__attribute__((format(printf, 2, 3))) relume_status refuse(relume_status status, const char *format,
                                                           ...);
// Of commands that read a capture more than once: decoded images of up to this size wait.
#define KEEP_BYTES ((size_t)640 << 20)

#define usage_error(...) refuse(RELUME_EINVAL, __VA_ARGS__)
#define data_error(...)  refuse(RELUME_EUNFIT, __VA_ARGS__)

// What a PSNR means for who looks at the pictures: "differences not visible".
const char *judgement(double psnr_db);

// The file that `relume encode CAPTURE -o OUTPUT` makes, and what it says.
relume_status encode_as_usual(const struct args *args, const char *capture, const char *output);

// What a baked object is: facts on stdout, as lines or JSON.
void print_baked(const char *file, const relume_baked *baked, bool json);

// Whether a file is one part of several ('relume join').
bool is_part(struct relume_pack_part *out, const char *path);

// A name or note as a line for people may hold it; the text lives in `out`.
struct shown {
    char text[4096];
};
const char *shown(struct shown *out, const char *text);
// A writer of the JSON that a command prints: nothing in it is obeyed by a terminal.
struct jwriter json_to(FILE *out);
// The same on stdout without blanks.
struct jwriter json_dense(void);
// A number of 9 digits; bytes and other whole numbers as they are.
void json_measure(struct jwriter *w, const char *key, double value);

#endif
