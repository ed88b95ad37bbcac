// fuzz.h - a small deterministic fuzzer: seeds made at the start, mutated bytes, a time limit
//
// `fuzz_X SECONDS [SEED]`: one input an iteration, written to a file whose name is printed, so that
// the input of a crash is what lies there. Every eighth iteration an allocation fails as well.
// `fuzz_X seeds FILE...` tries the seeds and the files as they are instead: `make replay` does so
// with tests/fuzz/corpus, where inputs lie that once failed.
//
// With RELUME_LIBFUZZER (config=fuzzer) the same file is a target of libFuzzer instead: its main()
// runs once and makes what inputs are tried on; inputs come from the engine, and allocations fail
// as often as the last byte of an input says. RELUME_FUZZ_SEEDS names a folder to write the seeds
// and words to.
#ifndef FUZZ_H
#define FUZZ_H

#include "capture_fixture.h"
#include "core/base/helper.h"
#include "core/base/memory.h"

#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

struct bytes {
    uint8_t *data;
    size_t size;
};

struct fuzz {
    char folder[64], path[96];
    uint64_t state;
    long iterations, accepted;
    struct bytes seed[256];
    int seeds;
    const char *const *words;  // NULL-terminated: text and names that mutations know
};

// Foreign readers run in another process, of which an engine sees nothing and where a file takes 15
// ms: files for it are refused, except by targets that say otherwise.
#ifndef FUZZ_HELPER
relume_status helper_start(struct helper_job *job, enum helper_kind kind, const char *path,
                           const struct relume_log *log)
{
    (void)kind, (void)path, (void)log;
    *job = (struct helper_job){.why = "not in this target"};
    return RELUME_EDAMAGED;
}
relume_status helper_ask(struct helper_job *job, const void *message, size_t size, int file,
                         void *answer, size_t answer_size)
{
    (void)job, (void)message, (void)size, (void)file, (void)answer, (void)answer_size;
    return RELUME_EDAMAGED;
}
void helper_end(struct helper_job *job)
{
    (void)job;
}
#endif

static inline uint32_t fuzz_random(struct fuzz *f)
{
    f->state = f->state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(f->state >> 33);
}

static inline size_t fuzz_below(struct fuzz *f, size_t n)
{
    return n ? fuzz_random(f) % n : 0;
}

static inline struct bytes fuzz_load(const char *path)
{
    struct bytes b = {0};
    FILE *file = fopen(path, "rb");
    if (!file)
        abort();
    fseek(file, 0, SEEK_END);
    b.size = (size_t)ftell(file);
    rewind(file);
    b.data = malloc(b.size + 1);
    if (!b.data || fread(b.data, 1, b.size, file) != b.size)
        abort();
    fclose(file);
    return b;
}

static inline void fuzz_add(struct fuzz *f, struct bytes b)
{
    if (f->seeds == (int)(sizeof f->seed / sizeof *f->seed))
        abort();
    f->seed[f->seeds++] = b;
}

static inline void fuzz_add_text(struct fuzz *f, const char *text)
{
    struct bytes b = {(uint8_t *)strdup(text), strlen(text)};
    if (!b.data)
        abort();
    fuzz_add(f, b);
}

static inline void fuzz_store(const char *path, struct bytes b)
{
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(b.data, 1, b.size, file) != b.size || fclose(file))
        abort();
}

static inline void fuzz_mutate_bytes(struct fuzz *f, struct bytes *b)
{
    static const uint32_t edges[] = {
        0,      1,       0x7f,       0x80,       0xff,       0x100,      0x7fff,     0x8000,
        0xffff, 0x10000, 0x7fffffff, 0x80000000, 0xffffffff, 0x7f800000, 0x7fc00000, 0x40000000};
    // headers decide more than pixels
    const size_t reach = fuzz_random(f) % 3 ? (b->size < 3000 ? b->size : 3000) : b->size;
    const size_t at = fuzz_below(f, reach);
    const uint32_t edge = edges[fuzz_below(f, sizeof edges / sizeof *edges)];
    switch (fuzz_random(f) % 6) {
    case 0: b->data[at] ^= (uint8_t)(1u << fuzz_below(f, 8)); break;
    case 1: b->data[at] = (uint8_t)fuzz_random(f); break;
    case 2: memcpy(b->data + at, &edge, b->size - at < 4 ? b->size - at : 4); break;
    case 3: b->size = fuzz_below(f, b->size) + 1; break;  // cut
    case 4: {                                             // move a piece
        const size_t to = fuzz_below(f, b->size), n = fuzz_below(f, 64);
        const size_t left = b->size - (at > to ? at : to);
        memmove(b->data + to, b->data + at, n < left ? n : left);
        break;
    }
    default: {  // remove a piece
        const size_t n = fuzz_below(f, b->size - at < 40 ? b->size - at : 40);
        memmove(b->data + at, b->data + at + n, b->size - at - n);
        b->size -= n;
    }
    }
    if (b->size == 0)
        b->size = 1;
}

// Change something close behind a known word, or put another word in its place.
static inline void fuzz_mutate_word(struct fuzz *f, struct bytes *b)
{
    size_t count = 0;
    while (f->words[count])
        count++;
    const char *word = f->words[fuzz_below(f, count)], *other = f->words[fuzz_below(f, count)];
    const uint8_t *hit = memmem(b->data, b->size, word, strlen(word));
    if (!hit)
        return;
    const size_t at = (size_t)(hit - b->data) + strlen(word);
    if (fuzz_random(f) % 4 == 0) {
        const size_t n = strlen(other) < b->size - (at - strlen(word))
                             ? strlen(other)
                             : b->size - at + strlen(word);
        memcpy(b->data + at - strlen(word), other, n);
        return;
    }
    const size_t to = at + fuzz_below(f, 48);
    if (to < b->size)
        b->data[to] = (uint8_t)(fuzz_random(f) % 2 ? fuzz_random(f) : fuzz_random(f) % 8);
}

static inline struct bytes fuzz_next(struct fuzz *f)
{
    const struct bytes seed = f->seed[fuzz_below(f, (size_t)f->seeds)];
    struct bytes b = {malloc(seed.size + 8), seed.size};
    if (!b.data)
        abort();
    memcpy(b.data, seed.data, seed.size);
    for (size_t n = 1 + fuzz_below(f, 4); n; n--)
        if (f->words && fuzz_random(f) % 2)
            fuzz_mutate_word(f, &b);
        else
            fuzz_mutate_bytes(f, &b);
    return b;
}

static inline double fuzz_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline void fuzz_begin(struct fuzz *f, const char *name, int argc, char **argv)
{
    f->state = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
    snprintf(f->folder, sizeof f->folder, "%s/relume-fuzz-XXXXXX",
             access("/dev/shm", W_OK) ? "/tmp" : "/dev/shm");  // in memory: files are many
    if (!mkdtemp(f->folder))
        abort();
    snprintf(f->path, sizeof f->path, "%s/input", f->folder);
    printf("%s: seed %llu, input %s\n", name, (unsigned long long)f->state, f->path);
    fflush(stdout);
}

#ifndef RELUME_LIBFUZZER

static inline void fuzz_end(struct fuzz *f)
{
    char command[128];
    snprintf(command, sizeof command, "/bin/rm -rf '%s'", f->folder);
    for (int i = 0; i < f->seeds; i++)
        free(f->seed[i].data);
    if (system(command))
        abort();
}

// Seeds have to be accepted, or what is made of them ends at the reader's door; files that once
// failed are mostly refused. Each at first as it is, then while the last byte of it says which
// allocation fails.
static inline int fuzz_replay(struct fuzz *f, int files, char **file,
                              bool (*one)(struct fuzz *, struct bytes))
{
    int refused = 0;
    for (int i = 0; i < files; i++)
        fuzz_add(f, fuzz_load(file[i]));
    for (int i = 0; i < f->seeds; i++) {
        const struct bytes seed = f->seed[i];
        const int late = seed.size ? seed.data[seed.size - 1] : 0;
        for (int fail = 0; seed.size && fail < 2 && (!fail || late >= 224); fail++) {
            struct bytes b = {malloc(seed.size + 8), seed.size};
            if (!b.data)
                abort();
            memcpy(b.data, seed.data, seed.size);
            mem_fail_after(fail ? late - 223 : 0);
            const bool accepted = one(f, b);
            mem_fail_after(0);
            f->accepted += accepted;
            if (!fail && !accepted && i < f->seeds - files)
                printf("seed %d is refused\n", i), refused++;
            free(b.data);
        }
    }
    printf("%d seeds, %d refused; %d files; %ld accepted\n", f->seeds - files, refused, files,
           f->accepted);
    fuzz_end(f);
    return refused > 0;
}

// `one` returns true when the input was accepted.
static inline int fuzz_run(struct fuzz *f, int argc, char **argv,
                           bool (*one)(struct fuzz *, struct bytes))
{
    if (argc > 1 && !strcmp(argv[1], "seeds"))
        return fuzz_replay(f, argc - 2, argv + 2, one);
    const double end = fuzz_now() + (argc > 1 ? atof(argv[1]) : 1.0);
    double slowest = 0.0;
    while (fuzz_now() < end) {
        struct bytes b = fuzz_next(f);
        const double start = fuzz_now();
        mem_fail_after(f->iterations % 8 == 7 ? 1 + (long)fuzz_below(f, 80) : 0);
        f->accepted += one(f, b);
        mem_fail_after(0);
        slowest = fuzz_now() - start > slowest ? fuzz_now() - start : slowest;
        f->iterations++;
        free(b.data);
        if (slowest > 20.0) {
            printf("an input took %.1f s: %s\n", slowest, f->path);
            return 1;
        }
    }
    printf("%ld inputs, %ld accepted, slowest %.2f s\n", f->iterations, f->accepted, slowest);
    fuzz_end(f);
    return f->iterations == 0;
}

#else

static struct fuzz fuzz_target;
static bool (*fuzz_one)(struct fuzz *, struct bytes);

// The seeds as files and the words as a dictionary, for engines that want them so.
static inline void fuzz_publish(const struct fuzz *f, const char *folder)
{
    char path[4200];
    for (int i = 0; i < f->seeds; i++) {
        snprintf(path, sizeof path, "%s/seed-%02d", folder, i);
        fuzz_store(path, f->seed[i]);
    }
    snprintf(path, sizeof path, "%s/words.dict", folder);
    FILE *dict = fopen(path, "w");
    for (int i = 0; dict && f->words && f->words[i]; i++) {
        fputc('"', dict);
        for (const char *c = f->words[i]; *c; c++)
            fprintf(dict, "\\x%02X", (unsigned char)*c);
        fputs("\"\n", dict);
    }
    if (!dict || fclose(dict))
        abort();
}

static void fuzz_clean(void)
{
    char command[128];
    printf("%ld inputs, %ld accepted\n", fuzz_target.iterations, fuzz_target.accepted);
    snprintf(command, sizeof command, "/bin/rm -rf '%s'", fuzz_target.folder);
    if (system(command))
        perror(command);
}

static inline int fuzz_run(struct fuzz *f, int argc, char **argv,
                           bool (*one)(struct fuzz *, struct bytes))
{
    (void)argc, (void)argv;
    fuzz_target = *f;
    atexit(fuzz_clean);
    fuzz_one = one;
    const char *folder = getenv("RELUME_FUZZ_SEEDS");
    if (folder)
        fuzz_publish(f, folder);
    return 0;
}

static int fuzz_main(int argc, char **argv);
int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    (void)argc;
    return fuzz_main(1, *argv);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct bytes b = {malloc(size + 8), size};
    if (!b.data)
        abort();
    memcpy(b.data, data, size);
    const int late = size ? data[size - 1] : 0;
    mem_fail_after(late >= 224 ? late - 223 : 0);
    fuzz_target.accepted += size > 0 && fuzz_one(&fuzz_target, b);
    mem_fail_after(0);
    fuzz_target.iterations++;
    free(b.data);
    return 0;
}

#define main fuzz_main

#endif

#endif
