// main.c - the relume tool: finds the command, parses its options, turns statuses into exit codes
#include "cli.h"
#include "output_name.h"
#include "program/stopping.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <malloc.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

extern const struct command command_synth, command_lights, command_hdr, command_lightfield,
    command_panorama, command_encode, command_info, command_relight, command_query, command_eval,
    command_compare, command_sweep, command_import, command_export, command_capture, command_btf,
    command_glare, command_tonemap, command_check;

const struct command *const commands[] = {
    &command_synth,  &command_capture, &command_hdr,     &command_lightfield, &command_panorama,
    &command_lights, &command_encode,  &command_info,    &command_check,      &command_relight,
    &command_query,  &command_eval,    &command_compare, &command_sweep,      &command_import,
    &command_export, &command_btf,     &command_glare,   &command_tonemap,    NULL,
};

#define OPTIONS struct args
static const struct option common[] = {
    INT("--threads", threads, "of every command", "N", "worker threads; default: all cores", 0,
        256),
    TEXT("--max-memory", max_memory, "of every command", "SIZE",
         "most memory for one picture, view or model, as 4G; default: half of the machine's"),
    TEXT("--max-pixels", max_pixels, "of every command", "N",
         "most pixels in one picture, as 200M; default: 1G"),
    FLAG("--any-format", any_format, "of every command",
         "read pictures of every format that OpenImageIO knows, not only those for photographs"),
    FLAG("-q", quiet, "of every command", "no progress bar, no warnings"),
    FLAG("--help", help, "of every command", "this text"),
    {0},
};

enum { MAX_ARGS = 4096 };

struct given {
    const struct option *option;
    const char *text;
    double number;
};

// A command line; its values go into the struct of the command's options.
struct parsed {
    const struct command *command;
    struct args *args;
    int given_count, input_count, listed;
    struct given given[MAX_ARGS];
    const char *inputs[MAX_ARGS];
    const char *list[MAX_ARGS];  // of options that may be repeated
    struct relume_log log;
    struct relume_limits limits;  // of log
};

// ---------------------------------------------------------------- messages and progress

static FILE *people;  // standard error
static volatile bool bar_drawn;

static void clear_bar(void)
{
    if (bar_drawn)
        fputs("\r\033[K", people);
    bar_drawn = false;
}

// One line, whatever bytes file names hold.
static void print_line(const char *prefix, const char *text)
{
    struct shown line;
    clear_bar();
    fprintf(people, "relume: %s%s\n", prefix, shown(&line, text));
}

static void on_message(void *user, enum relume_level level, const char *text)
{
    const struct parsed *p = user;
    if (level != RELUME_NOTE || !p->args->quiet)
        print_line(level == RELUME_WARNING ? "warning: " : "", text);
}

static void on_prefixed(void *user, enum relume_level level, const char *text)
{
    const struct prefix_log *p = user;
    char line[2048];
    snprintf(line, sizeof line, "%s: %s", p->prefix, text);
    p->to->message(p->to->user, level, line);
}

static bool on_prefixed_progress(void *user, const char *what, double done)
{
    const struct prefix_log *p = user;
    return p->to->progress(p->to->user, what, done);
}

const struct relume_log *prefix_log(struct prefix_log *p, const struct relume_log *to,
                                    const char *prefix)
{
    *p = (struct prefix_log){
        {on_prefixed, on_prefixed_progress, p, to->inputs, to->limits}, to, prefix};
    return &p->log;
}

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void draw_bar(const char *what, double done)
{
    enum { CELLS = 30 };
    static double start, last;
    static const char *task;
    const double now = now_s();
    if (what != task) {
        task = what;
        start = now;
    } else if (now - last < 0.1 && done < 1.0) {
        return;
    }
    last = now;
    char bar[CELLS + 1];
    for (int i = 0; i < CELLS; i++)
        bar[i] = i < done * CELLS ? '#' : '.';
    bar[CELLS] = '\0';
    const double left = done > 0.0 ? (now - start) * (1.0 - done) / done : 0.0;
    fprintf(people, "\r\033[K%-12s [%s] %3.0f %%", what, bar, 100.0 * done);
    if (done > 0.0 && done < 1.0)
        fprintf(people, "  %.0f s left", left);
    fflush(people);
    bar_drawn = true;
    if (done >= 1.0)
        clear_bar();
}

static bool on_progress(void *user, const char *what, double done)
{
    const struct parsed *p = user;
    if (!p->args->quiet && isatty(STDERR_FILENO))
        draw_bar(what, done);
    return !stopping_asked();
}

static void say_error(const char *format, va_list list)
{
    char text[2048];
    vsnprintf(text, sizeof text, format, list);
    print_line("", text);
}

void say(const struct args *args, enum relume_level level, const char *format, ...)
{
    char text[2048];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    args->log->message(args->log->user, level, text);
}

relume_status usage_error(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    say_error(format, list);
    va_end(list);
    return RELUME_EINVAL;
}

relume_status data_error(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    say_error(format, list);
    va_end(list);
    return RELUME_EUNFIT;
}

// ---------------------------------------------------------------- names

relume_status unknown_name(const char *what, const char *given, const char *const *names)
{
    const char *near = relume_name_nearest(given, names);
    char list[1024] = "";
    for (size_t n = 0; *names && n < sizeof list; names++)
        n += (size_t)snprintf(list + n, sizeof list - n, " %s", *names);
    if (near)
        return usage_error("unknown %s '%.200s'; did you mean '%s'? Expected one of:%s", what,
                           given, near, list);
    return usage_error("unknown %s '%.200s'; expected one of:%s", what, given, list);
}

// ---------------------------------------------------------------- options

static const struct option *find_option(const struct command *command, const char *name)
{
    for (const struct option *o = command->options; o && o->name; o++)
        if (!strcmp(o->name, name))
            return o;
    for (const struct option *o = common; o->name; o++)
        if (!strcmp(o->name, name))
            return o;
    return NULL;
}

// What `capture` did until it became four commands.
static const struct {
    const char *option;
    const struct command *to;
} moved[] = {{"--hdr", &command_hdr},
             {"--slab", &command_lightfield},
             {"--colmap", &command_lightfield},
             {"--depth-from-views", &command_lightfield},
             {"--panorama", &command_panorama}};

static relume_status unknown_option(const struct command *command, const char *given)
{
    const char *names[64];
    int n = 0;
    for (const struct option *o = command->options; o && o->name && n < 56; o++)
        names[n++] = o->name;
    for (size_t i = 0; command == &command_capture && i < sizeof moved / sizeof *moved; i++)
        if (find_option(moved[i].to, given))
            return usage_error("capture: %s is an option of 'relume %s'", given, moved[i].to->name);
    for (const struct option *o = common; o->name; o++)
        names[n++] = o->name;
    names[n] = NULL;
    const char *near = relume_name_nearest(given, names);
    if (near)
        return usage_error("%s: unknown option '%s'; did you mean '%s'?", command->name, given,
                           near);
    return usage_error("%s: unknown option '%s'; see 'relume %s --help'", command->name, given,
                       command->name);
}

bool args_given(const struct args *args, const void *member)
{
    const size_t offset = (size_t)((const char *)member - (const char *)args);
    for (int i = 0; i < args->parsed->given_count; i++)
        if (args->parsed->given[i].option->offset == offset)
            return true;
    return false;
}

bool parse_numbers(const char *text, double *out, int count)
{
    for (int i = 0; i < count; i++) {
        text += strspn(text, i ? ", \t" : " \t");
        char *end;
        out[i] = strtod(text, &end);
        if (end == text || !isfinite(out[i]))
            return false;
        text = end;
    }
    return text[strspn(text, " \t")] == '\0';
}

relume_status args_vec3(struct relume_vec3 *out, const char *option, const char *text)
{
    double v[3];
    if (!parse_numbers(text, v, 3))
        return usage_error("%s: expected three numbers x,y,z; found '%s'", option, text);
    *out = (struct relume_vec3){v[0], v[1], v[2]};
    return RELUME_OK;
}

relume_status args_transfer(struct relume_transfer *out, const char *option, const char *text)
{
    if (!text || !relume_transfer_parse(out, text))
        return RELUME_OK;
    return usage_error("%s: expected linear, srgb or gamma:G; found '%s'", option, text);
}

relume_status args_domain(enum relume_domain *out, const char *text)
{
    static const char *const names[] = {"auto", "linear", "display", NULL};
    for (int i = 0; names[i]; i++)
        if (!strcmp(text, names[i])) {
            *out = (enum relume_domain)i;
            return RELUME_OK;
        }
    return unknown_name("--domain", text, names);
}

static relume_status check_value(struct given *g)
{
    const struct option *o = g->option;
    if (!*g->text)
        return usage_error("%s: expected a value (%s); found an empty one", o->name, o->argument);
    switch (o->kind) {
    case OPTION_TEXT:
    case OPTION_TEXTS:
    case OPTION_OUTPUT: return RELUME_OK;
    case OPTION_PICTURE: return picture_name(o->name, g->text);
    case OPTION_FLOATS: return floats_name(o->name, g->text);
    case OPTION_RELUME: return relume_name(o->name, g->text);
    default: break;
    }
    char *end;
    errno = 0;
    g->number = strtod(g->text, &end);
    const bool whole =
        o->kind == OPTION_NUMBER || (g->number == floor(g->number) && fabs(g->number) <= INT_MAX);
    if (end == g->text || *end || !isfinite(g->number) || !whole)
        return usage_error("%s: expected %s; found '%s'", o->name,
                           o->kind == OPTION_INT ? "a whole number" : "a number", g->text);
    if ((o->min != 0.0 || o->max != 0.0) && (g->number < o->min || g->number > o->max))
        return usage_error("%s: expected a number from %g to %g; found %s", o->name, o->min, o->max,
                           g->text);
    return RELUME_OK;
}

// "-5" and "-.5" are values, "-o" is an option.
static bool is_option(const char *text)
{
    return text[0] == '-' && text[1] && !(text[1] >= '0' && text[1] <= '9') && text[1] != '.';
}

static relume_status parse(struct parsed *p, int argc, char **argv)
{
    bool only_inputs = false;
    for (int i = 0; i < argc; i++) {
        if (p->given_count == MAX_ARGS || p->input_count == MAX_ARGS)
            return usage_error("too many arguments");
        if (!only_inputs && !strcmp(argv[i], "--")) {
            only_inputs = true;
            continue;
        }
        if (!*argv[i])
            return usage_error("%s: expected '%s'; found an empty name", p->command->name,
                               p->command->usage);
        if (only_inputs || !is_option(argv[i])) {
            p->inputs[p->input_count++] = argv[i];
            continue;
        }
        char name[64];
        const char *equals = strncmp(argv[i], "--", 2) ? NULL : strchr(argv[i], '=');
        snprintf(name, sizeof name, "%.*s", equals ? (int)(equals - argv[i]) : 63, argv[i]);
        const struct option *o = find_option(p->command, name);
        if (!o)
            return unknown_option(p->command, name);
        struct given *g = &p->given[p->given_count++];
        g->option = o;
        if (o->kind == OPTION_FLAG) {
            if (equals)
                return usage_error("%s: takes no value; found '%s'", o->name, equals + 1);
            continue;
        }
        if (!equals && i + 1 >= argc)
            return usage_error("%s: expected a value (%s) after it; found none", o->name,
                               o->argument);
        g->text = equals ? equals + 1 : argv[++i];
        const relume_status status = check_value(g);
        if (status)
            return status;
    }
    return RELUME_OK;
}

// Every occurrence of an option that may be repeated, in order.
static struct texts gather(struct parsed *p, const struct option *option)
{
    const struct texts all = {.text = p->list + p->listed};
    for (int i = 0; i < p->given_count; i++)
        if (p->given[i].option == option)
            p->list[p->listed++] = p->given[i].text;
    return (struct texts){(int)(p->list + p->listed - all.text), all.text};
}

static void fill(struct parsed *p, const struct given *g)
{
    void *member = (char *)p->args + g->option->offset;
    switch (g->option->kind) {
    case OPTION_FLAG: *(bool *)member = true; break;
    case OPTION_INT: *(int *)member = (int)g->number; break;
    case OPTION_NUMBER: *(double *)member = g->number; break;
    case OPTION_TEXTS:
        if (!((struct texts *)member)->count)
            *(struct texts *)member = gather(p, g->option);
        break;
    default: *(const char **)member = g->text;
    }
}

static relume_status fill_options(struct parsed *p, int argc, char **argv)
{
    p->args = calloc(1, p->command->size ? p->command->size : sizeof *p->args);
    if (!p->args)
        return RELUME_ENOMEM;
    if (p->command->defaults)
        memcpy(p->args, p->command->defaults, p->command->size);
    const relume_status status = parse(p, argc, argv);
    for (int i = 0; !status && i < p->given_count; i++)
        fill(p, &p->given[i]);
    p->args->log = &p->log;
    p->args->parsed = p;
    p->args->inputs = p->input_count;
    p->args->input = p->inputs;
    return status;
}

// ---------------------------------------------------------------- help

static const char *last_word(const char *name)
{
    const char *blank = strrchr(name, ' ');
    return blank ? blank + 1 : name;
}

// Those of one group, of which `first` is the first.
static void print_group(const struct option *first)
{
    printf(" %s:\n", first->group);
    for (const struct option *o = first; o->name; o++) {
        char left[64];
        if (strcmp(o->group, first->group) != 0 || !o->help)  // without help: an old spelling
            continue;
        snprintf(left, sizeof left, "%s%s%s", o->name, o->argument ? " " : "",
                 o->argument ? o->argument : "");
        printf("  %-28s %s\n", left, o->help);
    }
}

static void print_options(const struct option *options, const char *groups)
{
    for (const struct option *o = options, *before = options; o && o->name; o++, before = options) {
        while (before < o && strcmp(before->group, o->group) != 0)
            before++;
        if (before == o && (!groups || strstr(groups, o->group)))
            print_group(o);
    }
}

static void print_help(const struct command *command)
{
    printf("usage: relume %s %s\n\n%s\n\noptions:\n", command->name, command->usage,
           command->summary);
    print_options(command->options, command->groups);
    print_options(common, NULL);
    if (command->tasks)
        printf("\ntasks; 'relume %s TASK --help' explains one:\n", command->name);
    for (const struct command *const *t = command->tasks; t && *t; t++)
        printf("  %-10s %s\n", last_word((*t)->name), (*t)->summary);
    printf("\nexample:\n  %s\n", command->example);
}

static void print_overview(void)
{
    printf("relume %s - image-based relighting\n\nusage: relume COMMAND [OPTION ...]\n\n",
           RELUME_VERSION);
    for (const struct command *const *c = commands; *c; c++)
        printf("  %-10s %s\n", (*c)->name, (*c)->summary);
    printf("\n'relume COMMAND --help' explains a command and gives an example.\n");
}

// The command of that name; NULL: there is none.
static const struct command *find_command(const struct command *const *list, const char *name)
{
    for (; *list; list++)
        if (!strcmp(last_word((*list)->name), name))
            return *list;
    return NULL;
}

static relume_status unknown_command(const char *what, const struct command *const *list,
                                     const char *given)
{
    if (is_option(given))
        return usage_error("%s: options come after the command; expected 'relume COMMAND %s ...'",
                           given, given);
    const char *names[32];
    int n = 0;
    for (; *list; list++)
        names[n++] = last_word((*list)->name);
    names[n] = NULL;
    return unknown_name(what, given, names);
}

// ---------------------------------------------------------------- main

static int exit_code(relume_status status)
{
    if (status == RELUME_ENOMEM)
        fputs("relume: out of memory\n", people);
    if (status == RELUME_ECANCEL) {
        fputs("relume: interrupted; nothing was written\n", people);
        return stopping_die();
    }
    return relume_status_exit(status);
}

// A folder that is there may be one that a command fills or replaces.
static bool is_output(const struct given *g)
{
    struct stat s;
    return g->option->kind > OPTION_OUTPUT ||
           (g->option->kind == OPTION_OUTPUT && (stat(g->text, &s) || !S_ISDIR(s.st_mode)));
}

// What the command line names and is there is read, except what it says is written. Files that
// these name in turn are noted as they are opened.
static relume_status note_inputs(struct parsed *p)
{
    relume_status status = relume_inputs_create(&p->log.inputs);
    for (int i = 0; !status && i < p->input_count; i++)
        relume_inputs_add(p->log.inputs, p->inputs[i]);
    for (int i = 0; !status && i < p->given_count; i++) {
        const enum option_kind kind = p->given[i].option->kind;
        if (kind == OPTION_TEXT || kind == OPTION_TEXTS)
            relume_inputs_add(p->log.inputs, p->given[i].text);
    }
    for (int i = 0; !status && i < p->given_count; i++)
        if (is_output(&p->given[i]))
            status = relume_file_check(p->given[i].text, &p->log);
    return status;
}

static relume_status take_size(uint64_t *out, const char *text, const char *name)
{
    if (!text || !relume_size_parse(out, text))
        return RELUME_OK;
    return usage_error("%s: expected a size like 500M or 4G; found '%s'", name, text);
}

static relume_status take_limits(struct parsed *p)
{
    struct relume_limits *l = &p->limits;
    l->any_format = p->args->any_format;
    const relume_status status = take_size(&l->max_memory, p->args->max_memory, "--max-memory");
    return status ? status : take_size(&l->max_pixels, p->args->max_pixels, "--max-pixels");
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
    while (i < *argc && !(task = find_command(tasks, argv[i])) &&
           (argv[i][0] == '-' || (i > 0 && argv[i - 1][0] == '-')))  // that may be its value
        i++;
    if (i == *argc)
        return RELUME_OK;
    if (!task)
        return unknown_command("task", tasks, argv[i]);
    p->command = task;
    memmove(argv + i, argv + i + 1, (size_t)(--*argc - i) * sizeof *argv);
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
    if (!status)
        status = fill_options(p, argc, argv);
    if (!status)
        status = take_limits(p);
    if (status)
        return status;
    if (p->args->help) {
        print_help(c);
        return RELUME_OK;
    }
    if (old && !p->args->quiet)
        (void)usage_error("'relume capture %s' is now 'relume %s'", old, c->name);
    if (p->input_count < c->min_inputs || p->input_count > c->max_inputs)
        return usage_error("%s: expected 'relume %s %s'; found %d input%s", c->name, c->name,
                           c->usage, p->input_count, relume_plural(p->input_count));
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

int main(int argc, char **argv)
{
    keep_freed_memory();
    occupy_standard_streams();
    keep_stderr_for_people();
    allow_many_files();
    stopping_listen("relume", &bar_drawn);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);  // a file size limit is a write error, not a death

    if (argc < 2 || !strcmp(argv[1], "--help") || !strcmp(argv[1], "help")) {
        print_overview();
        return argc < 2 ? 2 : 0;
    }
    if (!strcmp(argv[1], "--version")) {
        printf("relume %s\n", RELUME_VERSION);
        return 0;
    }
    struct parsed *p = calloc(1, sizeof *p);
    if (!p)
        return exit_code(RELUME_ENOMEM);
    put_command_first(argc, argv);
    p->log = (struct relume_log){
        .message = on_message, .progress = on_progress, .user = p, .limits = &p->limits};
    p->command = find_command(commands, argv[1]);
    relume_status status = p->command ? run_command(p, argc - 2, argv + 2)
                                      : unknown_command("command", commands, argv[1]);
    clear_bar();
    if (!flush_stdout() && !status)
        status = RELUME_EIO;
    relume_inputs_destroy(&p->log.inputs);
    free(p->args);
    free(p);
    return exit_code(status);
}
