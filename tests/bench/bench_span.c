// bench_span: which bricks of a volume a surface goes through, for many thresholds: the list of all
// ranges beside a kd tree over span space (Livnat, Shen, Johnson 1996)
//
// Ranges are those of bricks of 16 x 8 x 8 samples of a field of waves; a small one takes a
// threshold near its largest value, which few bricks reach. The tree is built once.
#include "bench.h"

// Of the processor, since others may use the machine.
static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

struct range {
    float least, most;
};

static struct range *make(size_t n, int across)
{
    struct range *r = malloc(n * sizeof *r);
    for (size_t i = 0; i < n; i++) {
        const double x = (double)(i % (size_t)across), y = (double)(i / (size_t)across % 64);
        const double z = (double)(i / (size_t)across / 64);
        const double at = sin(0.11 * x) + sin(0.07 * y) + sin(0.013 * z);
        r[i] = (struct range){(float)(at - 0.1), (float)(at + 0.1)};
    }
    return r;
}

static size_t by_list(const struct range *r, size_t n, float t, uint32_t *out)
{
    size_t found = 0;
    for (size_t i = 0; i < n; i++) {
        out[found] = (uint32_t)i;
        found += r[i].least < t && r[i].most >= t;
    }
    return found;
}

// ---------------------------------------------------------------- the tree

struct node {
    struct range range;
    uint32_t brick;
};

static int by_least(const void *a, const void *b)
{
    const float x = ((const struct node *)a)->range.least,
                y = ((const struct node *)b)->range.least;
    return x < y ? -1 : x > y;
}
static int by_most(const void *a, const void *b)
{
    const float x = ((const struct node *)a)->range.most, y = ((const struct node *)b)->range.most;
    return x < y ? -1 : x > y;
}

// The middle one of a piece is the node of both halves; least and most take turns.
static void build(struct node *node, size_t n, int depth)
{
    if (n < 2)
        return;
    qsort(node, n, sizeof *node, depth & 1 ? by_most : by_least);
    build(node, n / 2, depth + 1);
    build(node + n / 2 + 1, n - n / 2 - 1, depth + 1);
}

static size_t by_tree(const struct node *node, size_t n, int depth, float t, uint32_t *out)
{
    size_t found = 0;
    if (!n)
        return 0;
    const struct node *middle = node + n / 2;
    if (middle->range.least < t && middle->range.most >= t)
        out[found++] = middle->brick;
    if (depth & 1 ? middle->range.most >= t : true)
        found += by_tree(node, n / 2, depth + 1, t, out + found);
    if (depth & 1 ? true : middle->range.least < t)
        found += by_tree(middle + 1, n - n / 2 - 1, depth + 1, t, out + found);
    return found;
}

// ---------------------------------------------------------------- beside each other

static void measure(const char *name, size_t n, float threshold)
{
    enum { ROUNDS = 20 };
    struct range *r = make(n, 64);
    struct node *node = malloc(n * sizeof *node);
    uint32_t *out = malloc(n * sizeof *out);
    double list = 1e9, tree = 1e9;
    size_t found = 0, same = 0;
    for (size_t i = 0; i < n; i++)
        node[i] = (struct node){r[i], (uint32_t)i};
    double start = seconds();
    build(node, n, 0);
    const double once = seconds() - start;
    for (int i = 0; i < ROUNDS; i++) {
        start = seconds();
        found = by_list(r, n, threshold, out);
        const double between = seconds();
        same = by_tree(node, n, 0, threshold, out);
        list = fmin(list, between - start);
        tree = fmin(tree, seconds() - between);
    }
    printf("%s: %zu of %zu bricks, list %.1f us, tree %.1f us, built in %.1f ms%s\n", name, found,
           n, 1e6 * list, 1e6 * tree, 1e3 * once, found == same ? "" : "; NOT THE SAME");
    free(r);
    free(node);
    free(out);
}

int main(void)
{
    measure("256^3, large surface", 16384, 0.3f);
    measure("256^3, small surface", 16384, 2.9f);
    measure("1024^3, large surface", 1048576, 0.3f);
    measure("1024^3, small surface", 1048576, 2.9f);
    return 0;
}
