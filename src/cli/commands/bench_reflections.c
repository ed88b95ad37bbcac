// bench_reflections.c - relume bench reflections: three ways without rays, against exact rays
#include "cli/cli.h"
#include "cli/measure/loops.h"
#include "cli/measure/reflections.h"
#include "cli/messages.h"

#include <math.h>

enum { MAX_MESHES = 16, SIZES = 3 };
// Pictures of table 11.1, which has frames per second: one ray per pixel.
static const int sizes[SIZES][2] = {{160, 120}, {320, 240}, {640, 480}};

struct reflections_options {
    struct args args;
    bool json;
};
#define OPTIONS struct reflections_options

static const struct option options[] = {
    GROUP("output"),
    FLAG("--json", json, "print one JSON object"),
    {0},
};

// ---------------------------------------------------------------- text

static void print_mirror(const struct mirror_result *r)
{
    char name[40] = "Bezier patch", iterations[16] = "-";
    if (r->triangles)
        snprintf(name, sizeof name, "%d x %d x 2 triangles", r->triangles, r->triangles);
    else
        snprintf(iterations, sizeof iterations, "%.1f", r->iterations);
    printf("%-24s%13.2f%12s%12.1e%9d\n", name, 1e6 * r->seconds, iterations, r->error, r->found);
}

static void print_tracing(const struct tracing_result *r)
{
    char name[40] = "ray tracer, exact";
    if (r->depth)
        snprintf(name, sizeof name, "octree of depth %d%s", r->depth, r->cone ? ", cone" : "");
    printf("%-24s%8.2f", name, r->build_s);
    if (r->depth)
        printf("%7.0f", (double)r->bytes / (1 << 20));
    else
        printf("%7s", "-");
    printf("%11.2f", 1e-6 * r->rays_per_s);
    for (int i = 0; i < SIZES; i++)
        printf("%9.1f", r->rays_per_s / (sizes[i][0] * sizes[i][1]));
    if (r->depth)
        printf("%11.2f%9.4f\n", 100.0 * r->one_only, r->error);
    else
        printf("%11s%9s\n", "-", "-");
}

static void print_tracing_head(const struct traced_mesh *mesh)
{
    struct shown name;
    printf("\n%d rays off a mirror ball to %s, %zu triangles\n%-24s%8s%7s%11s", REFLECTED_RAYS,
           shown(&name, mesh->name), mesh->triangles, "", "build s", "MB", "million/s");
    for (int i = 0; i < SIZES; i++)
        printf("  %dx%d", sizes[i][0], sizes[i][1]);
    printf("%11s%9s\n", "% one only", "error");
}

static void print_text(const struct mirror_result *mirrors, const struct traced_mesh *meshes, int n,
                       const char *processor)
{
    printf("relume %s, one thread%s%s\n\n", RELUME_VERSION, *processor ? " on " : "", processor);
    printf("A curved mirror shows %d positions\n%-24s%13s%12s%12s%9s\n", MIRROR_POSITIONS, "",
           "us each", "iterations", "error", "found");
    for (int i = 0; i < MIRROR_METHODS; i++)
        print_mirror(&mirrors[i]);
    for (int m = 0; m < n; m++) {
        print_tracing_head(&meshes[m]);
        for (int i = 0; i < TRACING_METHODS; i++)
            print_tracing(&meshes[m].result[i]);
    }
    puts("\nError of the mirror: largest distance between the unit vector that leaves it and that "
         "of the law of reflection.");
    puts("Error of an octree: median distance between its hits and the ray tracer's, relative to "
         "the mesh's diagonal.");
    puts("160x120 to 640x480: frames per second of that size, one ray per pixel.");
    puts("'% one only': rays that hit something by one of both only. Cone: cells are no finer than "
         "0.01 of the ray's length.");
}

// ---------------------------------------------------------------- JSON

static void put_mirror(struct jwriter *w, const struct mirror_result *r)
{
    jopen_object(w, NULL);
    jput_text(w, "method", r->triangles ? "triangles" : "patch");
    jput_integer(w, "triangles", 2 * r->triangles * r->triangles);
    jput_number(w, "seconds", r->seconds, 9);
    jput_number(w, "iterations", r->iterations, 9);
    jput_number(w, "error", r->error, 9);
    jput_integer(w, "found", r->found);
    jclose(w);
}

static void put_tracing(struct jwriter *w, const struct tracing_result *r)
{
    jopen_object(w, NULL);
    jput_text(w, "method", r->depth ? "octree" : "tracer");
    jput_integer(w, "depth", r->depth);
    jput_truth(w, "cone", r->cone);
    jput_number(w, "build_seconds", r->build_s, 9);
    jput_integer(w, "bytes", (long long)r->bytes);
    jput_number(w, "rays_per_second", r->rays_per_s, 9);
    jput_number(w, "one_only", r->one_only, 9);
    jput_number(w, "error", r->error, 9);
    jclose(w);
}

static void put_mesh(struct jwriter *w, const struct traced_mesh *mesh)
{
    jopen_object(w, NULL);
    jput_text(w, "name", mesh->name);
    jput_integer(w, "triangles", (long long)mesh->triangles);
    jopen_array(w, "tracing");
    for (int i = 0; i < TRACING_METHODS; i++)
        put_tracing(w, &mesh->result[i]);
    jclose_levels(w, 2);
}

static void print_json(const struct mirror_result *mirrors, const struct traced_mesh *meshes, int n,
                       const char *processor)
{
    struct jwriter w = json_dense();
    jopen_object(&w, NULL);
    jput_text(&w, "version", RELUME_VERSION);
    jput_text(&w, "processor", processor);
    jput_integer(&w, "positions", MIRROR_POSITIONS);
    jput_integer(&w, "rays", REFLECTED_RAYS);
    jopen_array(&w, "mirror");
    for (int i = 0; i < MIRROR_METHODS; i++)
        put_mirror(&w, &mirrors[i]);
    jclose(&w);
    jopen_array(&w, "meshes");
    for (int m = 0; m < n; m++)
        put_mesh(&w, &meshes[m]);
    jend(&w);
}

// ---------------------------------------------------------------- the command

static relume_status run_bench_reflections(const struct args *args)
{
    const struct reflections_options *o = (const void *)args;
    struct mirror_result mirrors[MIRROR_METHODS];
    struct traced_mesh meshes[MAX_MESHES];
    char processor[49];
    const int n = args->inputs > 0 ? args->inputs : 1;
    relume_status status = measure_mirrors(mirrors, args->log);
    for (int i = 0; !status && i < n; i++)
        status = measure_tracing(&meshes[i], args->inputs ? args->input[i] : NULL, args->log);
    if (status)
        return status;
    loops_processor(processor);
    clear_bar();
    if (o->json)
        print_json(mirrors, meshes, n, processor);
    else
        print_text(mirrors, meshes, n, processor);
    return RELUME_OK;
}

const struct command bench_task_reflections = {
    COMMAND(run_bench_reflections, "bench reflections", "[MESH ...] [--json]",
            "measure reflections by Bezier patches, triangles and octrees against exact rays",
            "relume bench reflections bunny.ply --json", 0, MAX_MESHES),
};
