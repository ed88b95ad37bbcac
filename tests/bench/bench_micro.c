// How many small pictures `--transport micro` draws in a second, by their size and by the number of
// points, and what the tree takes: the tables of docs/measurements/micro.md. Times are those of
// one thread's processor.
//
//   bench_micro
//
// The points are those of a room's six walls; pictures are drawn from places on all of them.
#include "bench.h"

#include "world/transport/cut.h"

enum { LEAST = 10, MOST = 20, PLACES = 512, RUNS = 5 };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Number `i` of a wall: even over it (Roberts's sequence).
static void on_wall(float place[3], float normal[3], size_t i)
{
    const int wall = (int)(i % 6), axis = wall / 2;
    const double u = fmod(0.5 + 0.7548776662466927 * (double)(i / 6), 1.0);
    const double v = fmod(0.5 + 0.5698402909980532 * (double)(i / 6), 1.0);
    for (int c = 0; c < 3; c++)
        normal[c] = 0.0f;
    place[axis] = wall % 2 ? 1.0f : -1.0f;
    place[(axis + 1) % 3] = (float)(2.0 * u - 1.0);
    place[(axis + 2) % 3] = (float)(2.0 * v - 1.0);
    normal[axis] = -place[axis];
}

static struct hierarchy room(size_t count)
{
    struct piece *pieces = malloc(count * sizeof *pieces);
    struct hierarchy h;
    if (!pieces)
        bench_check(RELUME_ENOMEM);
    for (size_t i = 0; i < count; i++) {
        float normal[3];
        on_wall(pieces[i].place, normal, i);
        for (int c = 0; c < 3; c++)
            pieces[i].area[c] = 24.0f * normal[c] / (float)count;
    }
    bench_check(hierarchy_create(&h, pieces, count, count, 1));
    free(pieces);
    return h;
}

static vec3 vector(const float v[3])
{
    return vec3_of((double)v[0], (double)v[1], (double)v[2]);
}

// Pictures in a second: the best of some runs.
static double rate(const struct hierarchy *h, int side)
{
    static struct cut_view view;
    static struct cut_cell cells[CUT_MOST * CUT_MOST];
    static struct cut_list list;
    double best = INFINITY;
    cut_view_create(&view, side);
    for (int run = 0; run < RUNS; run++) {
        const double begin = now();
        for (size_t i = 0; i < PLACES; i++) {
            struct cut_place place;
            float at[3], normal[3];
            on_wall(at, normal, 7 * i);
            cut_place_at(&place, &view, vec3_along(vector(at), vector(normal), 1e-3),
                         vector(normal));
            memset(cells, 0, (size_t)(side * side) * sizeof *cells);
            list.count = 0;
            cut_scene(cells, &list, h, &place);
        }
        best = fmin(best, now() - begin);
    }
    return PLACES / best;
}

int main(void)
{
    static const int sides[] = {8, 16, 24, 32};
    printf("points     tree ms   pictures/s:  8^2     16^2     24^2     32^2\n");
    for (int k = LEAST; k <= MOST; k += 2) {
        const double begin = now();
        struct hierarchy h = room((size_t)1 << k);
        printf("2^%-2d %15.1f        ", k, 1e3 * (now() - begin));
        for (int s = 0; s < 4; s++)
            printf("%9.0f", rate(&h, sides[s]));
        printf("\n");
        fflush(stdout);
        hierarchy_forget(&h);
    }
    return 0;
}
