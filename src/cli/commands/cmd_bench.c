// cmd_bench.c - relume bench: how fast this machine runs the hot loops, beside what it allows
#include "cli/cli.h"
#include "cli/measure/loops.h"
#include "cli/messages.h"

#include <math.h>

enum { MOST_LOOPS = 16 };
static const double LONG_ENOUGH_S = 40.0;

struct bench_options {
    struct args args;
    int rounds;
    bool json;
};
#define OPTIONS struct bench_options

static const struct bench_options defaults = {.rounds = 15};

static const struct option options[] = {
    GROUP("measuring"),
    INT("--rounds", rounds, "N", "how often each loop is timed; default: 15", 1, TIMES_MOST),
    GROUP("output"),
    FLAG("--json", json, "print one JSON object"),
    {0},
};

// What is said of one loop; NAN: not counted.
struct row {
    const struct hot_loop *loop;
    const struct times *times;
    double seconds, gb_s, gflop_s, share;
    bool by_memory;  // the roof that bounds it
};

static double rate(double of, double seconds)
{
    return of > 0.0 ? 1e-9 * of / seconds : (double)NAN;
}

static struct row make_row(int i, const struct times *times, double bytes_a_second,
                           double flops_a_second)
{
    const struct hot_loop *l = &hot_loops[i];
    const double s = times_median(&times[i]),
                 bound = loop_bound_s(l, bytes_a_second, flops_a_second);
    return (struct row){
        .loop = l,
        .times = &times[i],
        .seconds = s,
        .gb_s = rate(l->bytes, s),
        .gflop_s = rate(l->flops, s),
        .share = bound > 0.0 ? bound / s : (double)NAN,
        .by_memory = l->bytes / bytes_a_second >= l->flops / flops_a_second,
    };
}

static void print_number(const char *format, int width, double value)
{
    if (isfinite(value))
        printf(format, width, value);
    else
        printf("%*s", width, "-");
}

static void print_row(const struct row *r)
{
    printf("%-18s", r->loop->name);
    printf("%8.2f  %7.2f - %-7.2f", 1e3 * r->seconds, 1e3 * r->times->s[0],
           1e3 * r->times->s[r->times->n - 1]);
    print_number("%*.2f", 7, r->gb_s);
    print_number("%*.1f", 9, r->gflop_s);
    print_number("%*.0f", 8, 100.0 * r->share);
    printf("  %-10s", !isfinite(r->share) ? "-" : r->by_memory ? "memory" : "arithmetic");
    print_number("%*.2f", 8, r->loop->readme_s > 0.0 ? 1e3 * r->loop->readme_s : (double)NAN);
    printf("  %s\n", r->loop->what);
}

static void print_text(const struct row *rows, int n, const char *processor, int threads)
{
    printf("relume %s, %d thread%s, %s%s%s\n", RELUME_VERSION, threads, relume_plural(threads),
           loops_set(), *processor ? " on " : "", processor);
    printf("memory is read at %.1f GB/s; %.0f Gflop/s of multiplications and additions\n\n",
           rows[LOOP_READ].gb_s, rows[LOOP_ARITHMETIC].gflop_s);
    printf("%-18s%8s  %-17s%7s%9s%8s  %-10s%8s\n", "loop", "ms", "least - most", "GB/s", "Gflop/s",
           "% of it", "bound by", "README");
    for (int i = 0; i < n; i++)
        print_row(&rows[i]);
    printf("\nRelighting reaches %.2f of the speed of reading memory (target 0.8), the look-up "
           "%.2f of the speed of memcpy (0.5).\n'%% of it': share of the speed that memory or "
           "arithmetic allows. README: ms on the two cores of docs/measurements.\n",
           rows[LOOP_READ].seconds / rows[LOOP_RELIGHT].seconds,
           rows[LOOP_COPY].seconds / rows[LOOP_LOOK_UP].seconds);
}

static void put_loop(struct jwriter *w, const struct row *r)
{
    jopen_object(w, NULL);
    jput_text(w, "name", r->loop->name);
    jput_text(w, "what", r->loop->what);
    jput_integer(w, "runs", r->times->n);
    jput_number(w, "seconds", r->seconds, 9);
    jput_number(w, "least_seconds", r->times->s[0], 9);
    jput_number(w, "most_seconds", r->times->s[r->times->n - 1], 9);
    jput_number(w, "bytes", r->loop->bytes, 9);
    jput_number(w, "flops", r->loop->flops, 9);
    jput_number(w, "gb_s", r->gb_s, 9);
    jput_number(w, "gflop_s", r->gflop_s, 9);
    jput_number(w, "share", r->share, 9);
    jput_number(w, "readme_seconds", r->loop->readme_s > 0.0 ? r->loop->readme_s : (double)NAN, 9);
    jclose(w);
}

static void print_json(const struct row *rows, int n, const char *processor, int threads)
{
    struct jwriter w = json_dense();
    jopen_object(&w, NULL);
    jput_text(&w, "version", RELUME_VERSION);
    jput_text(&w, "processor", processor);
    jput_text(&w, "instructions", loops_set());
    jput_integer(&w, "threads", threads);
    jput_number(&w, "read_gb_s", rows[LOOP_READ].gb_s, 9);
    jput_number(&w, "gflop_s", rows[LOOP_ARITHMETIC].gflop_s, 9);
    jput_number(&w, "relight_of_reading", rows[LOOP_READ].seconds / rows[LOOP_RELIGHT].seconds, 9);
    jput_number(&w, "look_up_of_memcpy", rows[LOOP_COPY].seconds / rows[LOOP_LOOK_UP].seconds, 9);
    jopen_array(&w, "loops");
    for (int i = 0; i < n; i++)
        put_loop(&w, &rows[i]);
    jend(&w);
}

// All loops in turns, so that whatever else the machine does falls on all of them alike. The first
// round is not counted.
static relume_status measure(struct times *times, int rounds, int threads,
                             const struct relume_log *log)
{
    loops *l;
    const double start = now_s();
    relume_status status = loops_create(&l, threads);
    for (int round = 0; !status && round <= rounds; round++) {
        if (round > 1 && now_s() - start > LONG_ENOUGH_S)
            break;
        if (log->progress && !log->progress(log->user, "measuring", (double)round / (rounds + 1)))
            status = RELUME_ECANCEL;
        for (int i = 0; !status && hot_loops[i].name; i++) {
            const double begin = now_s();
            status = hot_loops[i].run(l);
            if (round)
                times_add(&times[i], now_s() - begin);
        }
    }
    loops_destroy(&l);
    return status;
}

static relume_status run_bench(const struct args *args)
{
    const struct bench_options *o = (const void *)args;
    struct times times[MOST_LOOPS] = {0};
    struct row rows[MOST_LOOPS];
    char processor[49];
    int n = 0;
    const relume_status status = measure(times, o->rounds, args->threads, args->log);
    if (status)
        return status;
    const double memory = hot_loops[LOOP_READ].bytes / times_median(&times[LOOP_READ]);
    const double sums = hot_loops[LOOP_ARITHMETIC].flops / times_median(&times[LOOP_ARITHMETIC]);
    for (; hot_loops[n].name; n++)
        rows[n] = make_row(n, times, memory, sums);
    loops_processor(processor);
    clear_bar();
    const int threads = args->threads > 0 ? args->threads : relume_cpu_count();
    if (o->json)
        print_json(rows, n, processor, threads);
    else
        print_text(rows, n, processor, threads);
    return RELUME_OK;
}

extern const struct command bench_task_reflections;
static const struct command *const tasks[] = {&bench_task_reflections, NULL};

const struct command command_bench = {
    COMMAND(
        run_bench, "bench", "[--rounds N] [--json]",
        "measure how fast relume runs on this machine, and what its memory and arithmetic allow",
        "relume bench --json", 0, 0),
    .defaults = &defaults,
    .tasks = tasks,
};
