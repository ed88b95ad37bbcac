// alike.c - nearest neighbours for k-coherence (Tong et al., "Synthesis of Bidirectional Texture
// Functions on Arbitrary Surfaces", 2002): principal components of surroundings (Meseth 2008,
// 4.1.5: 16 of them do), in a tree that halves them along their widest direction
#include "material/synthesis/alike.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "core/math/gram.h"
#include "core/math/lsq.h"
#include "core/math/scalar.h"

#include <math.h>
#include <string.h>

enum {
    COMPONENTS = 12,
    MOST_OWN = 4,
    DIMENSIONS = COMPONENTS + MOST_OWN,
    LEAF = 12,    // points of a leaf, at most
    LEAVES = 48,  // looked into for one point, at most
    DEPTH = 40,
    ITEM = 256,  // points of one piece of work
    MOST_COUNT = 8,
};

struct node {
    int from, count;  // of the points, in the order of the tree
    int axis;         // -1: a leaf
    float split;
    int child[2];
};

struct tree {
    const struct alike_texels *t;
    size_t points;
    int components, dimensions;
    float (*point)[DIMENSIONS];  // by texel
    uint32_t *order;
    struct node *node;
    int nodes;
    double *vectors;  // [components][surroundings]
    uint32_t *out;
    int count, apart;
};

// ---------------------------------------------------------------- points

static int surroundings(const struct alike_texels *t)
{
    return t->side * t->side * t->values;
}

static void load(const struct alike_texels *t, size_t texel, double *to)
{
    const int x = (int)(texel % (size_t)t->width), y = (int)(texel / (size_t)t->width);
    const int r = t->side / 2;
    for (int j = -r; j <= r; j++)
        for (int i = -r; i <= r; i++) {
            const size_t at =
                (size_t)index_clamped(y + j * t->spacing, t->height) * (size_t)t->width +
                (size_t)index_clamped(x + i * t->spacing, t->width);
            for (int k = 0; k < t->values; k++)
                *to++ = (double)t->value[at * (size_t)t->values + (size_t)k];
        }
}

static void fill(const void *context, size_t first, size_t rows, double *out)
{
    const struct tree *tree = context;
    for (size_t i = 0; i < rows; i++)
        load(tree->t, first + i, out + i * (size_t)surroundings(tree->t));
}

static void project_item(void *context, size_t item, int worker)
{
    (void)worker;
    struct tree *tree = context;
    const size_t from = item * ITEM, end = from + ITEM;
    const int n = surroundings(tree->t);
    double values[9 * 9 * 8];
    for (size_t i = from; i < (end < tree->points ? end : tree->points); i++) {
        float *to = tree->point[i];
        load(tree->t, i, values);
        for (int k = 0; k < tree->components; k++) {
            double sum = 0.0;
            for (int j = 0; j < n; j++)
                sum += tree->vectors[(size_t)k * (size_t)n + (size_t)j] * values[j];
            *to++ = (float)sum;
        }
        for (int k = 0; k < tree->t->owns; k++)
            *to++ = sqrtf(tree->t->weight) * tree->t->own[i * (size_t)tree->t->owns + (size_t)k];
    }
}

static relume_status make_points(struct tree *tree, int threads)
{
    const size_t n = (size_t)surroundings(tree->t);
    double values[COMPONENTS], *gram = mem_array(n * n, sizeof *gram);
    tree->components = smaller_of((int)n, COMPONENTS);
    tree->dimensions = tree->components + tree->t->owns;
    tree->vectors = mem_array((size_t)tree->components * n, sizeof *tree->vectors);
    relume_status status = gram && tree->vectors
                               ? gram_sum(gram, n, tree->points, fill, tree, threads)
                               : RELUME_ENOMEM;
    if (!status && !lsq_eigenvectors(gram, (int)n, tree->components, values, tree->vectors))
        status = RELUME_ENOMEM;
    if (!status)
        thread_for(threads, (tree->points + ITEM - 1) / ITEM, project_item, tree);
    mem_free(gram);
    return status;
}

// ---------------------------------------------------------------- the tree

static int widest(const struct tree *tree, int from, int count, float *middle)
{
    int best = 0;
    float most = -1.0f;
    for (int k = 0; k < tree->dimensions; k++) {
        float low = INFINITY, high = -INFINITY;
        for (int i = from; i < from + count; i++) {
            const float v = tree->point[tree->order[i]][k];
            low = fminf(low, v);
            high = fmaxf(high, v);
        }
        if (high - low > most) {
            most = high - low;
            *middle = 0.5f * (low + high);
            best = k;
        }
    }
    return most > 0.0f ? best : -1;
}

// Points below the middle of the box first; where that is lopsided the tree is deeper, no more.
static int part(struct tree *tree, int from, int count, int axis, float middle)
{
    int low = from, high = from + count - 1;
    while (low <= high) {
        const uint32_t id = tree->order[low];
        if (tree->point[id][axis] < middle) {
            low++;
        } else {
            tree->order[low] = tree->order[high];
            tree->order[high--] = id;
        }
    }
    return low - from;
}

static int grow(struct tree *tree, int from, int count, int depth)
{
    const int self = tree->nodes++;
    struct node *n = &tree->node[self];
    *n = (struct node){.from = from, .count = count, .axis = -1};
    if (count <= LEAF || depth >= DEPTH)
        return self;
    n->axis = widest(tree, from, count, &n->split);
    if (n->axis < 0)
        return self;
    const int below = part(tree, from, count, n->axis, n->split);
    if (below == 0 || below == count) {
        n->axis = -1;
        return self;
    }
    n->child[0] = grow(tree, from, below, depth + 1);
    n->child[1] = grow(tree, from + below, count - below, depth + 1);
    return self;
}

// ---------------------------------------------------------------- search

struct hit {
    uint32_t texel;
    float wrong;
};

struct query {
    const struct tree *tree;
    const float *point;
    int x, y, found, leaves;
    struct hit hit[MOST_COUNT];
};

static bool is_apart(const struct query *q, int width, uint32_t texel, int apart)
{
    const int x = (int)(texel % (uint32_t)width), y = (int)(texel / (uint32_t)width);
    return abs(x - q->x) >= apart || abs(y - q->y) >= apart;
}

// Those that are kept are apart from each other as well, so that they are choices.
static void offer(struct query *q, uint32_t texel, float wrong)
{
    const int width = q->tree->t->width, apart = q->tree->apart;
    const int x = (int)(texel % (uint32_t)width), y = (int)(texel / (uint32_t)width);
    int at = q->found;
    for (int i = 0; i < q->found; i++) {
        const int ox = (int)(q->hit[i].texel % (uint32_t)width),
                  oy = (int)(q->hit[i].texel / (uint32_t)width);
        if (abs(x - ox) < apart && abs(y - oy) < apart) {
            if (q->hit[i].wrong <= wrong)
                return;
            memmove(&q->hit[i], &q->hit[i + 1], (size_t)(q->found - i - 1) * sizeof q->hit[0]);
            q->found--;
            i--;
        }
    }
    at = q->found;
    while (at > 0 && q->hit[at - 1].wrong > wrong)
        at--;
    if (at >= q->tree->count)
        return;
    if (q->found == q->tree->count)
        q->found--;
    memmove(&q->hit[at + 1], &q->hit[at], (size_t)(q->found - at) * sizeof q->hit[0]);
    q->hit[at] = (struct hit){texel, wrong};
    q->found++;
}

static float worst(const struct query *q)
{
    return q->found < q->tree->count ? INFINITY : q->hit[q->found - 1].wrong;
}

static void look_into(struct query *q, const struct node *n)
{
    const struct tree *tree = q->tree;
    q->leaves++;
    for (int i = n->from; i < n->from + n->count; i++) {
        const uint32_t id = tree->order[i];
        const float *p = tree->point[id], most = worst(q);
        float sum = 0.0f;
        for (int k = 0; k < tree->dimensions && sum < most; k++)
            sum += (p[k] - q->point[k]) * (p[k] - q->point[k]);
        if (sum < most && is_apart(q, tree->t->width, id, tree->apart))
            offer(q, id, sum);
    }
}

static void search(struct query *q, int node)
{
    const struct node *n = &q->tree->node[node];
    if (n->axis < 0) {
        look_into(q, n);
        return;
    }
    const float off = q->point[n->axis] - n->split;
    search(q, n->child[off >= 0.0f]);
    if (q->leaves < LEAVES && off * off < worst(q))
        search(q, n->child[off < 0.0f]);
}

static void search_item(void *context, size_t item, int worker)
{
    (void)worker;
    const struct tree *tree = context;
    const size_t from = item * ITEM, end = from + ITEM;
    for (size_t i = from; i < (end < tree->points ? end : tree->points); i++) {
        struct query q = {.tree = tree,
                          .point = tree->point[i],
                          .x = (int)(i % (size_t)tree->t->width),
                          .y = (int)(i / (size_t)tree->t->width)};
        search(&q, 0);
        for (int k = 0; k < tree->count; k++)
            tree->out[i * (size_t)tree->count + (size_t)k] =
                k < q.found ? q.hit[k].texel : (uint32_t)i;
    }
}

relume_status alike_find(uint32_t *out, int count, int apart, const struct alike_texels *t,
                         int threads)
{
    struct tree tree = {.t = t,
                        .points = (size_t)t->width * (size_t)t->height,
                        .out = out,
                        .count = count,
                        .apart = apart};
    tree.point = mem_array(tree.points, sizeof *tree.point);
    tree.order = mem_array(tree.points, sizeof *tree.order);
    tree.node = mem_array(2 * tree.points, sizeof *tree.node);
    relume_status status =
        tree.point && tree.order && tree.node ? make_points(&tree, threads) : RELUME_ENOMEM;
    if (!status) {
        for (size_t i = 0; i < tree.points; i++)
            tree.order[i] = (uint32_t)i;
        grow(&tree, 0, (int)tree.points, 0);
        thread_for(threads, (tree.points + ITEM - 1) / ITEM, search_item, &tree);
    }
    mem_free(tree.point);
    mem_free(tree.order);
    mem_free(tree.node);
    mem_free(tree.vectors);
    return status;
}
