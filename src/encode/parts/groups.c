// groups.c - the cameras of a slab are halved until as many stand together as are wanted; the tiles
// of all groups are shared evenly
#include "encode/parts/groups.h"

#include "core/base/memory.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

struct camera {
    double uv[2];
    int view;
};

static int compare(const struct camera *a, const struct camera *b, int axis)
{
    if (a->uv[axis] != b->uv[axis])
        return a->uv[axis] < b->uv[axis] ? -1 : 1;
    if (a->uv[!axis] != b->uv[!axis])
        return a->uv[!axis] < b->uv[!axis] ? -1 : 1;
    return a->view - b->view;
}

static int by_u(const void *a, const void *b)
{
    return compare(a, b, 0);
}

static int by_v(const void *a, const void *b)
{
    return compare(a, b, 1);
}

static double extent(const struct camera *c, int n, int axis)
{
    double least = c->uv[axis], most = least;
    for (int i = 1; i < n; i++) {
        least = fmin(least, c[i].uv[axis]);
        most = fmax(most, c[i].uv[axis]);
    }
    return most - least;
}

// The view nearest to the middle of them is the first, the others follow in their order.
static void add_group(struct view_groups *to, const struct camera *c, int at, int n)
{
    double u = 0.0, v = 0.0;
    int anchor = 0;
    for (int i = 0; i < n; i++) {
        u += c[i].uv[0] / n;
        v += c[i].uv[1] / n;
    }
    for (int i = 1; i < n; i++)
        if (hypot(c[i].uv[0] - u, c[i].uv[1] - v) < hypot(c[anchor].uv[0] - u, c[anchor].uv[1] - v))
            anchor = i;
    to->view[at] = c[anchor].view;
    for (int i = 0; i < n; i++)
        if (i != anchor)
            to->view[at + i + (i < anchor)] = c[i].view;
    to->begin[to->count++] = at;
}

// `n` cameras, whose views lie from `at` on, become `groups` groups.
static void halve(struct view_groups *to, struct camera *c, int at, int n, int groups)
{
    if (groups == 1) {
        add_group(to, c, at, n);
        return;
    }
    const int first = (int)((long long)n * (groups / 2) / groups);
    qsort(c, (size_t)n, sizeof *c, extent(c, n, 1) > extent(c, n, 0) ? by_v : by_u);
    halve(to, c, at, first, groups / 2);
    halve(to, c + first, at + first, n - first, groups - groups / 2);
}

// In the order of their anchors, as the file has them.
static void sort_groups(struct view_groups *to, const struct view_groups *from, int views)
{
    int at = 0;
    for (int anchor = 0; anchor < views; anchor++)
        for (int g = 0; g < from->count; g++) {
            const int *view = from->view + from->begin[g], n = from->begin[g + 1] - from->begin[g];
            if (*view != anchor)
                continue;
            to->begin[to->count++] = at;
            memcpy(to->view + at, view, (size_t)n * sizeof *view);
            at += n;
        }
    to->begin[to->count] = at;
}

static bool groups_create(struct view_groups *out, size_t views)
{
    *out = (struct view_groups){.begin = mem_array(views + 1, sizeof *out->begin),
                                .view = mem_array(views, sizeof *out->view),
                                .tile = mem_array(views + 1, sizeof *out->tile),
                                .cut = mem_array(views, sizeof *out->cut)};
    return out->begin && out->view && out->tile && out->cut;
}

static void cut_into_tiles(struct view_groups *g, const relume_coder *coder, int width, int height)
{
    g->tile[0] = 0;
    for (int i = 0; i < g->count; i++) {
        g->cut[i] = lossy_cut_of(coder, width, height, g->begin[i + 1] - g->begin[i]);
        g->tile[i + 1] = g->tile[i] + g->cut[i].count;
    }
}

relume_status groups_make(struct view_groups *out, const relume_capture *capture,
                          const relume_coder *coder)
{
    const struct relume_manifest *manifest = relume_capture_manifest(capture);
    const int most = lossy_most_views(coder);
    const size_t views = (size_t)manifest->views;
    const int side_by_side = manifest->geometry.projection == RELUME_SLAB ? most : 1;
    struct camera *camera = mem_array(views, sizeof *camera);
    struct view_groups halved;
    const bool made = groups_create(&halved, views);
    const bool good = groups_create(out, views) && made && camera;
    for (int s = 0, at = 0; good && at < manifest->views; s++) {
        int n = 0;
        for (int v = 0; v < manifest->views; v++) {
            const struct relume_manifest_view *view = &manifest->view[v];
            if (view->slab == s)
                camera[n++] = (struct camera){{view->uv[0], view->uv[1]}, v};
        }
        if (n)
            halve(&halved, camera, at, n, (n + side_by_side - 1) / side_by_side);
        at += n;
    }
    if (good) {
        halved.begin[halved.count] = manifest->views;
        sort_groups(out, &halved, manifest->views);
        cut_into_tiles(out, coder, relume_capture_width(capture), relume_capture_height(capture));
    }
    mem_free(camera);
    groups_destroy(&halved);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

relume_status groups_alone(struct view_groups *out, const relume_coder *coder, int width,
                           int height)
{
    if (!groups_create(out, 1))
        return RELUME_ENOMEM;
    out->count = 1;
    out->begin[0] = out->view[0] = 0;
    out->begin[1] = 1;
    cut_into_tiles(out, coder, width, height);
    return RELUME_OK;
}

void groups_destroy(struct view_groups *groups)
{
    mem_free(groups->begin);
    mem_free(groups->view);
    mem_free(groups->tile);
    mem_free(groups->cut);
}

static int first_tile(const struct view_groups *groups, int member, int members)
{
    return (int)((int64_t)groups->tile[groups->count] * member / members);
}

struct group_share groups_share(const struct view_groups *groups, int member, int members)
{
    return (struct group_share){first_tile(groups, member, members),
                                first_tile(groups, member + 1, members)};
}

struct group_share groups_tiles(const struct view_groups *groups, int group,
                                struct group_share share)
{
    const int begin = groups->tile[group], count = groups->cut[group].count;
    const int first = share.first - begin, end = share.end - begin;
    const struct group_share own = {first > 0 ? first : 0, end < count ? end : count};
    return own.first < own.end ? own : (struct group_share){0, 0};
}

int groups_of_tile(const struct view_groups *groups, int tile)
{
    int g = 0;
    while (g < groups->count && groups->tile[g + 1] <= tile)
        g++;
    return g;
}

int groups_with(const struct view_groups *groups, int view)
{
    int g = 0, i = 0;
    while (groups->view[i] != view)
        i++;
    while (groups->begin[g + 1] <= i)
        g++;
    return g;
}
