// main.c - the relume tool: finds the command, has its options read, turns statuses into exit codes
#include "start.h"

#include "cli/program/output_name.h"
#include "cli/program/stopping.h"
#include "messages.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <limits.h>
#include <malloc.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

extern const struct command command_synth, command_lights, command_hdr, command_lightfield,
    command_panorama, command_encode, command_info, command_relight, command_query, command_eval,
    command_compare, command_study, command_sweep, command_import, command_export, command_maps,
    command_capture, command_btf, command_glare, command_tonemap, command_check, command_join,
    command_bench, command_mesh, command_bake, command_notes, command_publish, command_change;

const struct command *const commands[] = {
    &command_synth,
    &command_capture,
    &command_hdr,
    &command_lightfield,
    &command_panorama,
    &command_lights,
    &command_encode,
    &command_join,
    &command_info,
    &command_check,
    &command_relight,
    &command_query,
    &command_eval,
    &command_compare,
    &command_change,
    &command_study,
    &command_sweep,
    &command_import,
    &command_export,
    &command_publish,
    &command_maps,
    &command_btf,
    &command_bake,
    &command_mesh,
    &command_notes,
    &command_glare,
    &command_tonemap,
    &command_bench,
    NULL,
};

#define OPTIONS struct args
static const struct option common[] = {
    GROUP("of every command"),
    INT("--threads", threads, "N", "worker threads; default: all cores", 0, 256),
    BYTES("--max-memory", limits.max_memory, "SIZE",
          "most memory for one picture, view or model, as 4G; default: half of the machine's"),
    BYTES("--max-pixels", limits.max_pixels, "N",
          "most pixels in one picture, as 200M; default: 1G"),
    FLAG("--any-format", limits.any_format,
         "read pictures of every format that OpenImageIO knows, not only those for photographs"),
    FLAG("-q", quiet, "no progress bar and no notes; warnings and errors stay"),
    FLAG("--help", help, "this text"),
    {0},
};

// A command line on its way; what it fills begins with `args`.
struct parsed {
    const struct command *command;
    struct args *args;
    struct command_line line;
    struct relume_log log;
    struct relume_limits limits;  // before --max-memory and --max-pixels
    const char *program;
    const struct relume_team *team;
    int threads;  // where --threads does not say
};

// What `capture` did until it became four commands.
static const struct {
    const char *option;
    const struct command *to;
} moved[] = {{"--hdr", &command_hdr},
             {"--slab", &command_lightfield},
             {"--colmap", &command_lightfield},
             {"--depth-from-views", &command_lightfield},
             {"--panorama", &command_panorama}};

bool given(const void *options, const void *member)
{
    return option_given(((const struct args *)options)->line, member);
}

// ---------------------------------------------------------------- help

static const char *last_word(const char *name)
{
    const char *blank = strrchr(name, ' ');
    return blank ? blank + 1 : name;
}

static void print_commands(const struct command *const *list)
{
    for (; list && *list; list++)
        printf("  %-10s %s\n", last_word((*list)->name), (*list)->summary);
}

static void print_help(const struct command *command)
{
    printf("usage: relume %s %s\n\n%s\n\noptions:\n", command->name, command->usage,
           command->summary);
    options_print(command->options, command->groups, 28);
    options_print(common, NULL, 28);
    if (command->tasks)
        printf("\ntasks; 'relume %s TASK --help' explains one:\n", command->name);
    print_commands(command->tasks);
    printf("\nexample:\n  %s\n", command->example);
}

// The command of that name; NULL: there is none.
static const struct command *find_command(const struct command *const *list, const char *name)
{
    for (; *list; list++)
        if (!strcmp(last_word((*list)->name), name))
            return *list;
    return NULL;
}

static relume_status unknown_command(const struct relume_log *log, const char *what,
                                     const struct command *const *list, const char *given)
{
    if (is_option(given))
        return usage_error("%s: options come after the command; expected 'relume COMMAND %s ...'",
                           given, given);
    const char *names[32];
    int n = 0;
    for (; *list; list++)
        names[n++] = last_word((*list)->name);
    names[n] = NULL;
    return unknown_word(log, what, given, names);
}

// ---------------------------------------------------------------- main

int tool_exit(relume_status status)
{
    if (status == RELUME_ENOMEM)
        fputs("relume: out of memory\n", people);
    if (status == RELUME_ECANCEL) {
        fputs("relume: interrupted; no unfinished output is left\n", people);
        return stopping_die();
    }
    return relume_status_exit(status);
}

// A folder that is there may be one that a command fills or replaces. `elsewhere`: files are put
// there.
static bool is_output(const struct given *g, bool elsewhere)
{
    struct stat s;
    if (elsewhere && g->option->kind > OPTION_OUTPUT && g->option->kind < OPTION_RIG)
        return false;
    return g->option->kind > OPTION_OUTPUT ||
           (g->option->kind == OPTION_OUTPUT && (stat(g->text, &s) || !S_ISDIR(s.st_mode)));
}

// Whether two names are those of one file or folder, there already or not. What is neither, as
// /dev/null, takes any number.
static bool is_same_output(const char *a, const char *b)
{
    struct stat s, t;
    const bool there = !stat(a, &s), other = !stat(b, &t);
    if (there || other)
        return there && other && s.st_dev == t.st_dev && s.st_ino == t.st_ino &&
               (S_ISREG(s.st_mode) || S_ISDIR(s.st_mode));
    char *folder_a = strdup(a);
    char *folder_b = strdup(b);
    const bool same = folder_a && folder_b && !strcmp(path_name(a), path_name(b)) &&
                      !stat(dirname(folder_a), &s) && !stat(dirname(folder_b), &t) &&
                      s.st_dev == t.st_dev && s.st_ino == t.st_ino;
    free(folder_a);
    free(folder_b);
    return same;
}

static relume_status check_outputs_differ(const struct command_line *l)
{
    for (int i = 0; i < l->given_count; i++)
        for (int k = 0; k < i; k++)
            if (l->given[i].option != l->given[k].option &&
                l->given[i].option->kind >= OPTION_OUTPUT &&
                l->given[k].option->kind >= OPTION_OUTPUT &&
                is_same_output(l->given[i].text, l->given[k].text))
                return usage_error("%s and %s: both are %s, and one would be lost; choose another "
                                   "name",
                                   l->given[k].option->name, l->given[i].option->name,
                                   l->given[i].text);
    return RELUME_OK;
}

// What the command line names and is there is read, except what it says is written. Files that
// these name in turn are noted as they are opened.
static relume_status note_inputs(struct parsed *p)
{
    const struct command *c = p->command;
    const bool elsewhere = c->moves_outputs && c->moves_outputs(p->args);
    relume_status status = RELUME_OK;
    for (int i = 0; !c->names_built_in && i < p->line.input_count; i++)
        relume_context_note(p->log.context, p->line.input[i]);
    for (int i = 0; i < p->line.given_count; i++) {
        const enum option_kind kind = p->line.given[i].option->kind;
        if (kind == OPTION_TEXT || kind == OPTION_TEXTS || kind == OPTION_FILES)
            relume_context_note(p->log.context, p->line.given[i].text);
    }
    for (int i = 0; !status && i < p->line.given_count; i++)
        if (is_output(&p->line.given[i], elsewhere))
            status = relume_file_check(p->line.given[i].text, &p->log);
    return status ? status : check_outputs_differ(&p->line);
}

static relume_status fill_options(struct parsed *p, int argc, char **argv)
{
    const struct command *c = p->command;
    p->args = calloc(1, c->size ? c->size : sizeof *p->args);
    if (!p->args)
        return RELUME_ENOMEM;
    if (c->defaults)
        memcpy(p->args, c->defaults, c->size);
    p->args->limits = p->limits;
    p->args->program = p->program;
    p->args->team = p->team;
    p->args->threads = p->threads;
    p->args->log = p->line.log = &p->log;
    p->log.user = p->args;
    p->line.name = c->name;
    p->line.tables[0] = c->options ? c->options : common;
    p->line.tables[1] = c->options ? common : NULL;
    p->line.values = p->args;
    p->args->line = &p->line;
    p->args->input = p->line.input;
    relume_status status = relume_context_create(
        &p->log.context, relume_context_params(.limits = &p->args->limits, .keep_inputs = true));
    if (!status)
        status = command_line_parse(&p->line, argc, argv);
    p->args->inputs = p->line.input_count;
    return status;
}

// The option that the command does nothing without; of a task only in a group that it shows.
static relume_status check_needed(const struct parsed *p)
{
    const struct command *c = p->command;
    const char *group = "";
    for (const struct option *o = c->options; o && o->name; o++) {
        group = o->kind == OPTION_GROUP ? o->name : group;
        if (o->needed && (!c->groups || strstr(c->groups, group)) &&
            !given(p->args, (const char *)p->args + o->offset))
            return usage_error("%s: expected %s %s, as in 'relume %s %s'", c->name, o->name,
                               o->argument, c->name, c->usage);
    }
    return RELUME_OK;
}

// The name of the group that an option of the command stands in; NULL: it is of all commands.
static const char *group_of(const struct command *c, const struct option *wanted)
{
    const char *group = "";
    for (const struct option *o = c->options; o && o->name; o++) {
        group = o->kind == OPTION_GROUP ? o->name : group;
        if (o == wanted)
            return group;
    }
    return NULL;
}

// Tasks share a table of options; what only others use would do nothing.
static relume_status check_groups(const struct parsed *p)
{
    const struct command *c = p->command;
    for (int i = 0; c->groups && i < p->line.given_count; i++) {
        const struct option *o = p->line.given[i].option;
        const char *group = group_of(c, o);
        if (group && !strstr(c->groups, group))
            return usage_error("%s: %s does nothing here; leave it out (relume help %s)", c->name,
                               o->name, c->name);
    }
    return RELUME_OK;
}

// An option that capture no longer has by itself; NULL: none.
static const char *moved_option(const struct command **to, int argc, char **argv)
{
    for (size_t m = 0; m < sizeof moved / sizeof *moved; m++)
        for (int i = 0; i < argc && strcmp(argv[i], "--"); i++)
            if (is_option(argv[i]) && !strncmp(argv[i], moved[m].option, strcspn(argv[i], "=")) &&
                strlen(moved[m].option) == strcspn(argv[i], "=")) {
                *to = moved[m].to;
                return moved[m].option;
            }
    return NULL;
}

// The task of a command is its first word that names one; options and their values may stand before
// it.
static relume_status choose_task(struct parsed *p, int *argc, char **argv)
{
    const struct command *const *tasks = p->command->tasks;
    const struct command *task = NULL;
    int i = 0;
    if (p->command->run && !(*argc > 0 && find_command(tasks, argv[0])))
        return RELUME_OK;
    while (i < *argc && !(task = find_command(tasks, argv[i])) &&
           (argv[i][0] == '-' || (i > 0 && argv[i - 1][0] == '-')))  // that may be its value
        i++;
    if (i == *argc)
        return RELUME_OK;
    if (!task)
        return unknown_command(&p->log, "task", tasks, argv[i]);
    p->command = task;
    memmove(argv + i, argv + i + 1, (size_t)(--*argc - i) * sizeof *argv);
    return RELUME_OK;
}

// Of another of the four commands that `capture` was.
static relume_status check_capture(int argc, char **argv)
{
    for (int i = 0; i < argc && strcmp(argv[i], "--"); i++)
        for (size_t m = 0; is_option(argv[i]) && m < sizeof moved / sizeof *moved; m++)
            if (option_find(moved[m].to->options, argv[i]) &&
                !option_find(command_capture.options, argv[i]))
                return usage_error("capture: %s is an option of 'relume %s'", argv[i],
                                   moved[m].to->name);
    return RELUME_OK;
}

static relume_status run_command(struct parsed *p, int argc, char **argv)
{
    const char *old = NULL;
    relume_status status = RELUME_OK;
    if (p->command == &command_capture)
        old = moved_option(&p->command, argc, argv);
    else if (p->command->tasks)
        status = choose_task(p, &argc, argv);
    const struct command *c = p->command;
    if (c == &command_capture)
        status = check_capture(argc, argv);
    if (!status)
        status = fill_options(p, argc, argv);
    if (status)
        return status;
    if (p->args->help) {
        print_help(c);
        return RELUME_OK;
    }
    if (old && !p->args->quiet)
        (void)usage_error("'relume capture %s' is now 'relume %s'", old, c->name);
    if (p->args->inputs < c->min_inputs || p->args->inputs > c->max_inputs)
        return usage_error("%s: expected 'relume %s %s'; found %d input%s", c->name, c->name,
                           c->usage, p->args->inputs, relume_plural(p->args->inputs));
    status = check_needed(p);
    if (!status)
        status = check_groups(p);
    if (!status)
        status = note_inputs(p);
    return status ? status : c->run(p->args);
}

static bool flush_stdout(void)
{
    if (!fflush(stdout) && !ferror(stdout))
        return true;
    fprintf(people, "relume: standard output: writing failed; %s\n", strerror(errno));
    return false;
}

// Closed standard streams are opened, unwritable, so that no output file takes their number.
static void occupy_standard_streams(void)
{
    for (int fd = open("/dev/null", O_RDONLY); fd >= 0; fd = open("/dev/null", O_RDONLY))
        if (fd > STDERR_FILENO) {
            close(fd);
            return;
        }
}

// libpng, libtiff and others print errors of their own; what there is to say comes as a status, and
// one sentence is ours.
static void keep_stderr_for_people(void)
{
    people = stderr;
#ifdef __GLIBC__
    FILE *nowhere = fopen("/dev/null", "we");
    if (nowhere)
        stderr = nowhere;
#endif
}

// An encoder holds one file open for every light.
static void allow_many_files(void)
{
    struct rlimit limit;
    if (!getrlimit(RLIMIT_NOFILE, &limit)) {
        limit.rlim_cur = limit.rlim_max;
        setrlimit(RLIMIT_NOFILE, &limit);
    }
}

// Pictures come and go by the dozen. Freed memory stays for the next one: fresh pages have to be
// cleared by the kernel, a sixth of the time of merging exposures of 12 megapixels.
static void keep_freed_memory(void)
{
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, INT_MAX);
    mallopt(M_TRIM_THRESHOLD, INT_MAX);
#endif
}

// "relume -q info x" is "relume info -q x". The place of the command's name; 1 where there is none.
static int command_at(int argc, char **argv)
{
    int at = 1;
    while (at < argc && is_option(argv[at])) {
        const size_t length = strcspn(argv[at], "=");
        const struct option *o = common;
        while (o->name && (strlen(o->name) != length || strncmp(o->name, argv[at], length)))
            o++;
        if (!o->name)
            return 1;
        at += o->kind == OPTION_FLAG || argv[at][length] ? 1 : 2;
    }
    return at < argc ? at : 1;
}

static void put_command_first(int argc, char **argv)
{
    const int at = command_at(argc, argv);
    char *name = argv[at];
    memmove(argv + 2, argv + 1, (size_t)(at - 1) * sizeof *argv);
    argv[1] = name;
}

relume_status tool_run(int argc, char **argv, const struct relume_team *team, int threads)
{
    keep_freed_memory();
    occupy_standard_streams();
    keep_stderr_for_people();
    allow_many_files();
    stopping_listen("relume", &bar_drawn);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);  // a file size limit is a write error, not a death

    if (argc < 2 || !strcmp(argv[1], "--help") || !strcmp(argv[1], "help")) {
        printf("relume %s - image-based relighting\n\nusage: relume COMMAND [OPTION ...]\n\n",
               RELUME_VERSION);
        print_commands(commands);
        printf("\n'relume COMMAND --help' explains a command and gives an example.\n");
        return argc < 2 ? RELUME_EINVAL : RELUME_OK;
    }
    if (!strcmp(argv[1], "--version")) {
        printf("relume %s\n", RELUME_VERSION);
        return RELUME_OK;
    }
    struct parsed *p = calloc(1, sizeof *p);
    if (!p)
        return RELUME_ENOMEM;
    put_command_first(argc, argv);
    p->log = (struct relume_log){.message = on_message, .progress = on_progress};
    p->program = argv[0];
    p->team = team;
    p->threads = threads;
    p->command = find_command(commands, argv[1]);
    relume_status status = p->command ? run_command(p, argc - 2, argv + 2)
                                      : unknown_command(&p->log, "command", commands, argv[1]);
    clear_bar();
    if (!flush_stdout() && !status)
        status = RELUME_EIO;
    relume_context_destroy(&p->log.context);
    free(p->args);
    free(p);
    return status;
}
