// main.c - the relume tool: finds the command, parses its options, turns statuses into exit codes
#include "cli.h"
#include "output_name.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <malloc.h>
#include <math.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

extern const struct command command_synth, command_lights, command_encode, command_info,
    command_relight, command_query, command_eval, command_compare, command_sweep, command_import,
    command_export, command_capture, command_btf, command_glare, command_tonemap, command_check;

const struct command *const commands[] = {
    &command_synth,
    &command_capture,
    &command_lights,
    &command_encode,
    &command_info,
    &command_check,
    &command_relight,
    &command_query,
    &command_eval,
    &command_compare,
    &command_sweep,
    &command_import,
    &command_export,
    &command_btf,
    &command_glare,
    &command_tonemap,
    NULL,
};

static const struct option common[] = {
    {"--threads", OPTION_INT, "N", "worker threads; default: all cores", 0, 256},
    {"--max-memory", OPTION_TEXT, "SIZE",
     "most memory for one picture, view or model, as 4G; default: half of the machine's", 0, 0},
    {"--max-pixels", OPTION_TEXT, "N", "most pixels in one picture, as 200M; default: 1G", 0, 0},
    {"--any-format", OPTION_FLAG, NULL,
     "read pictures of every format that OpenImageIO knows, not only those for photographs", 0, 0},
    {"-q", OPTION_FLAG, NULL, "no progress bar, no warnings", 0, 0},
    {"--help", OPTION_FLAG, NULL, "this text", 0, 0},
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

enum { MAX_ARGS = 4096 };

struct given {
    const struct option *option;
    const char *text;
    double number;
};

struct args {
    const struct command *command;
    int given_count, input_count;
    struct given given[MAX_ARGS];
    const char *inputs[MAX_ARGS];
    struct relume_log log;
    struct relume_limits limits;  // of log
    bool quiet;
};

// ---------------------------------------------------------------- messages and progress

static FILE *people;                       // standard error
static volatile sig_atomic_t interrupted;  // the signal that asked to stop, 0: none
static bool bar_drawn;

// Most phases ask every few milliseconds whether to stop, and clean up. A library's loop asks
// nobody: when work goes on for so long after that, a thread cleans up and ends the program.
static const struct timespec PATIENCE = {.tv_nsec = 800000000};
static sem_t asked_to_stop;

static void on_interrupt(int signal_number)
{
    interrupted = signal_number;
    sem_post(&asked_to_stop);
}

// By the signal itself, so that shells and scripts see what ended the program.
static int die_of(int signal_number)
{
    signal(signal_number, SIG_DFL);
    raise(signal_number);
    return 128 + signal_number;
}

static void *end_late(void *unused)
{
    static const char line[] = "\nrelume: interrupted\n";
    while (sem_wait(&asked_to_stop))
        ;
    nanosleep(&PATIENCE, NULL);
    relume_files_abandon();
    (void)!write(STDERR_FILENO, line + !bar_drawn, sizeof line - 1 - !bar_drawn);
    die_of(interrupted);
    return unused;
}

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
    const struct args *args = user;
    if (level != RELUME_NOTE || !args->quiet)
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
    const struct args *args = user;
    if (!args->quiet && isatty(STDERR_FILENO))
        draw_bar(what, done);
    return !interrupted;
}

static void say_error(const char *format, va_list list)
{
    char text[2048];
    vsnprintf(text, sizeof text, format, list);
    print_line("", text);
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
    return RELUME_EDATA;
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

static relume_status unknown_option(const struct command *command, const char *given)
{
    const char *names[64];
    int n = 0;
    for (const struct option *o = command->options; o->name && n < 56; o++)
        names[n++] = o->name;
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

// ---------------------------------------------------------------- options

static const struct option *find_option(const struct command *command, const char *name)
{
    for (const struct option *o = command->options; o->name; o++)
        if (!strcmp(o->name, name))
            return o;
    for (const struct option *o = common; o->name; o++)
        if (!strcmp(o->name, name))
            return o;
    return NULL;
}

static const struct given *find_given(const struct args *args, const char *name)
{
    assert(find_option(args->command, name));
    for (int i = args->given_count - 1; i >= 0; i--)
        if (!strcmp(args->given[i].option->name, name))
            return &args->given[i];
    return NULL;
}

bool args_has(const struct args *args, const char *name)
{
    return find_given(args, name) != NULL;
}

int args_int(const struct args *args, const char *name, int otherwise)
{
    const struct given *g = find_given(args, name);
    return g ? (int)g->number : otherwise;
}

double args_number(const struct args *args, const char *name, double otherwise)
{
    const struct given *g = find_given(args, name);
    return g ? g->number : otherwise;
}

const char *args_text(const struct args *args, const char *name, const char *otherwise)
{
    const struct given *g = find_given(args, name);
    return g ? g->text : otherwise;
}

int args_count(const struct args *args, const char *name)
{
    int n = 0;
    for (int i = 0; i < args->given_count; i++)
        n += !strcmp(args->given[i].option->name, name);
    return n;
}

const char *args_nth(const struct args *args, const char *name, int n)
{
    for (int i = 0; i < args->given_count; i++)
        if (!strcmp(args->given[i].option->name, name) && n-- == 0)
            return args->given[i].text;
    return NULL;
}

int args_inputs(const struct args *args)
{
    return args->input_count;
}

const char *args_input(const struct args *args, int n)
{
    return args->inputs[n];
}

int args_threads(const struct args *args)
{
    return args_int(args, "--threads", 0);
}

const struct relume_log *args_log(const struct args *args)
{
    return &args->log;
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

static relume_status check_value(struct given *g)
{
    const struct option *o = g->option;
    if (!*g->text)
        return usage_error("%s: expected a value (%s); found an empty one", o->name, o->argument);
    switch (o->kind) {
    case OPTION_TEXT:
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

static relume_status parse(struct args *args, int argc, char **argv)
{
    bool only_inputs = false;
    for (int i = 0; i < argc; i++) {
        if (args->given_count == MAX_ARGS || args->input_count == MAX_ARGS)
            return usage_error("too many arguments");
        if (!only_inputs && !strcmp(argv[i], "--")) {
            only_inputs = true;
            continue;
        }
        if (!*argv[i])
            return usage_error("%s: expected '%s'; found an empty name", args->command->name,
                               args->command->usage);
        if (only_inputs || !is_option(argv[i])) {
            args->inputs[args->input_count++] = argv[i];
            continue;
        }
        char name[64];
        const char *equals = strncmp(argv[i], "--", 2) ? NULL : strchr(argv[i], '=');
        snprintf(name, sizeof name, "%.*s", equals ? (int)(equals - argv[i]) : 63, argv[i]);
        const struct option *o = find_option(args->command, name);
        if (!o)
            return unknown_option(args->command, name);
        struct given *g = &args->given[args->given_count++];
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

// ---------------------------------------------------------------- help

static void print_options(const struct option *options)
{
    for (const struct option *o = options; o->name; o++) {
        char left[64];
        snprintf(left, sizeof left, "%s%s%s", o->name, o->argument ? " " : "",
                 o->argument ? o->argument : "");
        printf("  %-28s %s\n", left, o->help);
    }
}

static void print_help(const struct command *command)
{
    printf("usage: relume %s %s\n\n%s\n\noptions:\n", command->name, command->usage,
           command->summary);
    print_options(command->options);
    print_options(common);
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

static relume_status unknown_command(const char *given)
{
    const char *names[32];
    int n = 0;
    for (const struct command *const *c = commands; *c; c++)
        names[n++] = (*c)->name;
    names[n] = NULL;
    return unknown_name("command", given, names);
}

// ---------------------------------------------------------------- main

static int exit_code(relume_status status)
{
    switch (status) {
    case RELUME_OK: return 0;
    case RELUME_EDATA: return 1;
    case RELUME_EINVAL: return 2;
    case RELUME_ENOMEM: fputs("relume: out of memory\n", people); return 3;
    case RELUME_EIO:
    case RELUME_ESYSTEM: return 3;
    case RELUME_ECANCEL:
        fputs("relume: interrupted; nothing was written\n", people);
        return die_of(interrupted ? interrupted : SIGINT);
    }
    return 3;
}

// What the command line names and is there is read, except what it says is written. Files that
// these name in turn are noted as they are opened.
static relume_status note_inputs(struct args *args)
{
    relume_status status = relume_inputs_create(&args->log.inputs);
    for (int i = 0; !status && i < args->input_count; i++)
        relume_inputs_add(args->log.inputs, args->inputs[i]);
    for (int i = 0; !status && i < args->given_count; i++)
        if (args->given[i].option->kind == OPTION_TEXT)
            relume_inputs_add(args->log.inputs, args->given[i].text);
    for (int i = 0; !status && i < args->given_count; i++)
        if (args->given[i].option->kind >= OPTION_OUTPUT)
            status = relume_file_check(args->given[i].text, &args->log);
    return status;
}

static relume_status take_size(uint64_t *out, const struct args *args, const char *name)
{
    const char *text = args_text(args, name, NULL);
    if (!text || !relume_size_parse(out, text))
        return RELUME_OK;
    return usage_error("%s: expected a size like 500M or 4G; found '%s'", name, text);
}

static relume_status take_limits(struct args *args)
{
    struct relume_limits *l = &args->limits;
    l->any_format = args_has(args, "--any-format");
    const relume_status status = take_size(&l->max_memory, args, "--max-memory");
    return status ? status : take_size(&l->max_pixels, args, "--max-pixels");
}

static relume_status run_command(struct args *args, int argc, char **argv)
{
    const struct command *c = args->command;
    relume_status status = parse(args, argc, argv);
    if (!status)
        status = take_limits(args);
    if (status)
        return status;
    if (args_has(args, "--help")) {
        print_help(c);
        return RELUME_OK;
    }
    args->quiet = args_has(args, "-q");
    if (args->input_count < c->min_inputs || args->input_count > c->max_inputs)
        return usage_error("%s: expected 'relume %s %s'; found %d input%s", c->name, c->name,
                           c->usage, args->input_count, args->input_count == 1 ? "" : "s");
    status = note_inputs(args);
    return status ? status : c->run(args);
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

// Each asks to stop and clean up; a second one of its kind stops at once. nohup's choice is kept.
static void listen_to_signals(void)
{
    const struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = SA_RESETHAND};
    struct sigaction before;
    pthread_t watcher;
    pthread_attr_t small;
    sem_init(&asked_to_stop, 0, 0);
    pthread_attr_init(&small);
    pthread_attr_setstacksize(&small, 1 << 18);
    if (!pthread_create(&watcher, &small, end_late, NULL))
        pthread_detach(watcher);
    pthread_attr_destroy(&small);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    if (!sigaction(SIGHUP, NULL, &before) && before.sa_handler != SIG_IGN)
        sigaction(SIGHUP, &action, NULL);
}

int main(int argc, char **argv)
{
    keep_freed_memory();
    occupy_standard_streams();
    keep_stderr_for_people();
    allow_many_files();
    listen_to_signals();
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
    struct args *args = calloc(1, sizeof *args);
    if (!args)
        return exit_code(RELUME_ENOMEM);
    args->log = (struct relume_log){
        .message = on_message, .progress = on_progress, .user = args, .limits = &args->limits};
    for (const struct command *const *c = commands; *c; c++)
        if (!strcmp((*c)->name, argv[1]))
            args->command = *c;
    relume_status status =
        args->command ? run_command(args, argc - 2, argv + 2) : unknown_command(argv[1]);
    clear_bar();
    if (!flush_stdout() && !status)
        status = RELUME_EIO;
    relume_inputs_destroy(&args->log.inputs);
    free(args);
    return exit_code(status);
}
