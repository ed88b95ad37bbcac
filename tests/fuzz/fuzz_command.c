// fuzz_command.c - whole command lines made of bytes, an argument a line, run in a folder that has
// a file of every kind. Work that is refused or stopped leaves no output and changes nothing,
// nothing unfinished stays, and what is asked to end ends.
#include "cli/main.c"

#include "fuzz.h"

#include <dirent.h>
#include <ftw.h>
#include <sys/stat.h>
#include <sys/time.h>

enum { MOST_WORDS = 512, MOST_KEPT = 96, MOST_LINES = 24 };
static const struct timeval PATIENT = {.tv_usec = 250000};  // of processor time

static const char *words[MOST_WORDS] = {
    "--",        "help",      "sphere",      "box",     "cap",       "cap/capture.json",
    "a.exr",     "a.ptm",     "p.hdr",       "p.png",   "lights.lp", "m.obj",
    "rays",      "out",       "out.exr",     "out.png", "out.ptm",   "out.json",
    "8",         "2x2",       "0.5",         "-1",      "1e308",     "nan",
    "dir 0 0 1", "env p.hdr", "point 0 0 1", "sh",      "pca",       "ptm",
    "hsh",       "16",        "half",        "relight", "sphere",    "corduroy",
    "rfp",       "0,0,3",     "0,0,-1",      "auto",    NULL};

// ---------------------------------------------------------------- the folder

// As the folder was before the first line. Files come behind the folders that they are in.
static struct kept {
    char path[64];
    struct bytes bytes;
    struct stat state;
} kept[MOST_KEPT];
static int kept_count;
static struct {
    int made, changed, found, unfinished;
} seen;

static int keep(const char *path, const struct stat *s, int type, struct FTW *place)
{
    if (place->level == 0)
        return 0;
    if (kept_count == MOST_KEPT || strlen(path) >= sizeof kept->path)
        abort();
    struct kept *k = &kept[kept_count++];
    *k = (struct kept){.state = *s};
    strcpy(k->path, path);
    if (type == FTW_F)
        k->bytes = fuzz_load(path);
    return 0;
}

// How the library begins the names of files that it has not finished.
#define UNFINISHED ".relume-"

static int look(const char *path, const struct stat *s, int type, struct FTW *place)
{
    if (place->level == 0)
        return 0;
    const struct kept *k = kept;
    while (k < kept + kept_count && strcmp(k->path, path))
        k++;
    if (k == kept + kept_count)
        seen.made++;
    else
        seen.found++;
    seen.unfinished += !strncmp(path + place->base, UNFINISHED, strlen(UNFINISHED));
    if (k < kept + kept_count && type == FTW_F)
        seen.changed += k->state.st_ino != s->st_ino || k->state.st_size != s->st_size ||
                        k->state.st_mtim.tv_nsec != s->st_mtim.tv_nsec;
    return 0;
}

static int drop(const char *path, const struct stat *s, int type, struct FTW *place)
{
    (void)s, (void)type;
    return place->level ? remove(path) : 0;
}

static void restore(void)
{
    if (nftw(".", drop, 16, FTW_PHYS | FTW_DEPTH))
        abort();
    for (struct kept *k = kept; k < kept + kept_count; k++) {
        if (S_ISDIR(k->state.st_mode) && mkdir(k->path, 0777))
            abort();
        if (!S_ISDIR(k->state.st_mode))
            fuzz_store(k->path, k->bytes);
        if (stat(k->path, &k->state))
            abort();
    }
}

// ---------------------------------------------------------------- one line

static struct parsed parsed;

static volatile sig_atomic_t stopped;

static void stop(int signal_number)
{
    stopped = signal_number;
}

static bool go_on(void *user, const char *what, double done)
{
    (void)user, (void)what, (void)done;
    return !stopped;
}

// `line` begins with the command.
static relume_status run(int count, char **line, bool patiently)
{
    static const struct itimerval never = {{0, 0}, {0, 0}};
    const struct itimerval once = {{0, 0}, patiently ? never.it_value : PATIENT};
    FILE *const out = stdout;
    parsed.log = (struct relume_log){.message = on_message, .progress = go_on};
    parsed.limits = (struct relume_limits){.max_memory = 64 << 20, .max_pixels = 1 << 7};
    stopped = 0;
    parsed.command = find_command(commands, line[0]);
    stdout = people;
    setitimer(ITIMER_PROF, &once, NULL);
    const relume_status status = parsed.command
                                     ? run_command(&parsed, count - 1, line + 1)
                                     : unknown_command(&parsed.log, "command", commands, line[0]);
    setitimer(ITIMER_PROF, &never, NULL);
    stdout = out;
    relume_context_destroy(&parsed.log.context);
    free(parsed.args);
    parsed.args = NULL;
    return status;
}

// Nothing is named outside the folder or as what is unfinished there, and the limits stay. A glare
// takes seconds.
static bool is_harmless(const char *argument)
{
    return strcmp(argument, "glare") && !strstr(argument, "..") && *argument != '/' &&
           !strstr(argument, "=/") && !strstr(argument, UNFINISHED) &&
           strncmp(argument, "--max-", 6);
}

static bool one(struct fuzz *f, struct bytes b)
{
    char *line[MOST_LINES + 2] = {NULL, (char[]){"--threads"}, (char[]){"1"}}, *save;
    char *text = strndup((const char *)b.data, b.size);
    uint64_t size;
    int count = 3;
    (void)f;
    line[0] = text ? strtok_r(text, "\n", &save) : NULL;
    for (char *next = line[0]; next; next = strtok_r(NULL, "\n", &save)) {
        if (!is_harmless(next) || count == MOST_LINES) {
            free(text);
            return false;
        }
        if (relume_size_parse(&size, next))
            size = 0;
        if (next != line[0])
            line[count++] = next;
    }
    const relume_status status = line[0] ? run(count, line, false) : RELUME_EINVAL;
    memset(&seen, 0, sizeof seen);
    if (nftw(".", look, 16, FTW_PHYS))
        abort();
    // a sweep keeps the rows that it has
    const bool changes = seen.made || seen.changed || seen.found != kept_count;
    if (seen.unfinished || (status && changes && parsed.command != &command_sweep))
        abort();
    if (changes)
        restore();
    free(text);
    return !status;
}

// ---------------------------------------------------------------- what is there

static struct bytes text(const char *t)
{
    return (struct bytes){(uint8_t *)strdup(t), strlen(t)};
}

static void put(const char *path, const char *t)
{
    fuzz_store(path, (struct bytes){(uint8_t *)(uintptr_t)t, strlen(t)});
}

static size_t add_options(size_t n, const struct option *options)
{
    return (size_t)option_names(words, (int)n, MOST_WORDS - 32, options);
}

static size_t add_commands(size_t n, const struct command *const *list)
{
    for (const struct command *const *c = list; c && *c && n < MOST_WORDS - 32; c++) {
        words[n++] = (*c)->name;
        n = add_options(n, (*c)->options);
        n = add_commands(n, (*c)->tasks);
    }
    return n;
}

static void add_words(void)
{
    size_t n = 0;
    while (words[n])
        n++;
    (void)add_commands(add_options(n, common), commands);
}

static void must(const char *line)
{
    struct bytes b = text(line);
    char *parts[MOST_LINES], *save;
    int count = 0;
    for (char *p = strtok_r((char *)b.data, "\n", &save); p; p = strtok_r(NULL, "\n", &save))
        parts[count++] = p;
    if (run(count, parts, true))
        abort();
    free(b.data);
}

static void fill_folder(void)
{
    must("synth\nbox\n-o\ncap\n--size\n6\n--lights\n6\n--hemisphere\n--projection\nplanar\n--"
         "samples\n1");
    must("synth\n--btf\nleather\n-o\nbtf\n--size\n2\n--directions\ncoarse");
    must("encode\ncap\n-o\na.exr\n--basis\nptm");
    must("export\na.exr\n--to\nptm\n-o\na.ptm");
    must("relight\na.exr\n-o\np.exr");
    must("relight\na.exr\n-o\np.png");
    put("lights.lp", "3\na.png 0 0 1\nb.png 1 0 1\nc.png 0 1 1\n");
    put("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    put("rays", "0 0 3 0 0 -1\n");
    if (nftw(".", keep, 16, FTW_PHYS))
        abort();
    restore();
}

int main(int argc, char **argv)
{
    static const char *const lines[] = {
        "synth\nbox\n-o\nout\n--projection\nslab\n--size\n4\n--views\n2x2\n--lights\n4",
        "synth\n--btf\nleather\n-o\nbtf\n--force\n--size\n2\n--directions\ncoarse",
        "capture\np.png\np.png\np.png\n--lights\nlights.lp\n-o\nout",
        "capture\np.exr\n--panorama\nsphere\n-o\nout",
        "lights\n--pattern\nhammersley\n-n\n9\n--hemisphere\n--json",
        "encode\ncap\n-o\nout.exr\n--basis\npca\n--coefficients\n4\n--bits\nhalf",
        "info\na.exr\n--json",
        "check\na.exr\n--json",
        "relight\na.exr\n-o\nout.png\n--light\ndir 0 1 1 rgb 1 .5 .5\n--exposure\n1",
        "query\na.exr\n--eye\n0,0,3\n--direction\n0,0,-1\n--light\ndir 0 0 1\n--json",
        "query\na.exr\n--rays\nrays",
        "eval\na.exr\ncap\n--json",
        "compare\np.exr\np.png\n--json",
        "sweep\ncap\n--basis\nptm,sh\n--leave-out\n2\n--json",
        "import\na.ptm\n-o\nout.exr",
        "export\na.exr\n--to\nrelight\n-o\nout",
        "btf\nfit\nbtf\n--model\nlaf\n-o\nout",
        "btf\ninfo\nbtf",
        "tonemap\np.exr\n-o\nout.png\n--exposure\n-1",
        "relight\n--help",
    };
    struct fuzz f = {.words = words};
    char path[96];
    fuzz_begin(&f, "fuzz_command", argc, argv);
    snprintf(path, sizeof path, "%s/work", f.folder);
    people = fopen("/dev/null", "we");
    if (!people || mkdir(path, 0777) || chdir(path))
        abort();
    setenv("PATH", f.folder, 1);  // no programs: films want one
    signal(SIGPROF, stop);
    add_words();
    fill_folder();
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
        fuzz_add(&f, text(lines[i]));
    return fuzz_run(&f, argc, argv, one);
}
