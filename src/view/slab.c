// slab.c - the light slab: a grid of cameras on the plane uv looking through one window on st
//
// Levoy and Hanrahan 1996, Gortler et al. 1996; with illumination: Wong 1998, 8.1. A frame shows
// the window from the eye, so a pixel fixes (s, t); its ray meets the uv plane in (u, v). The value
// is bilinear in (u, v) over the four cameras around, times bilinear in (s, t) over the four texels
// around: Gortler's quadralinear basis. Since u depends on s alone and v on t alone, every weight
// of a frame is the product of one factor per column and one per row.
#include <relume/view.h>

#include "base/memory.h"
#include "base/thread.h"

#include <math.h>
#include <string.h>

// Camera coordinates closer than this (relative to the grid) are the same row or column.
#define SAME_LINE 1e-6
// A point this far (relative) outside the grid is on its border: eyes there are computed.
#define BORDER_SLACK 1e-9

struct relume_slab {
    struct relume_geometry geometry;
    int columns, rows;
    double slack; // BORDER_SLACK in world units
    double *u;
    double *v;
    int *view;
};

// Up to two neighbours on a line with their weights, none of them 0.
struct neighbours {
    int count;
    int index[2];
    double weight[2];
};

// ---------------------------------------------------------------- grid

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

// Sort `lines` and keep the least of each group closer than `same`; returns how many are left.
static int keep_distinct(double *lines, int n, double same)
{
    qsort(lines, (size_t)n, sizeof *lines, compare_doubles);
    int kept = 1;
    for (int i = 1; i < n; i++)
        if (lines[i] - lines[kept - 1] > same)
            lines[kept++] = lines[i];
    return kept;
}

// The last of the ascending `lines` that is not above `at`; 0 when all are.
static int line_below(const double *lines, int n, double at)
{
    int low = 0;
    while (n - low > 1) {
        const int middle = low + (n - low) / 2;
        if (lines[middle] <= at)
            low = middle;
        else
            n = middle;
    }
    return low;
}

static double extent(const double (*uv)[2], int views, int axis)
{
    double low = uv[0][axis];
    double high = low;
    for (int i = 1; i < views; i++) {
        low = fmin(low, uv[i][axis]);
        high = fmax(high, uv[i][axis]);
    }
    return high - low;
}

// The rows and columns of the cameras, and which camera stands at each crossing.
static relume_status find_grid(relume_slab *slab, const double (*uv)[2], int views)
{
    const double size = fmax(extent(uv, views, 0), extent(uv, views, 1));
    const double depth = fabs(slab->geometry.uv_z - slab->geometry.st_z);
    slab->slack = BORDER_SLACK * fmax(size, depth);
    for (int i = 0; i < views; i++) {
        slab->u[i] = uv[i][0];
        slab->v[i] = uv[i][1];
    }
    slab->columns = keep_distinct(slab->u, views, SAME_LINE * size);
    slab->rows = keep_distinct(slab->v, views, SAME_LINE * size);
    if ((int64_t)slab->columns * slab->rows != views)
        return RELUME_EINVAL;
    for (int i = 0; i < views; i++)
        slab->view[i] = -1;
    for (int i = 0; i < views; i++) {
        const int column = line_below(slab->u, slab->columns, uv[i][0]);
        const int row = line_below(slab->v, slab->rows, uv[i][1]);
        int *at = &slab->view[(size_t)row * (size_t)slab->columns + (size_t)column];
        if (*at >= 0)
            return RELUME_EINVAL;
        *at = i;
    }
    return RELUME_OK;
}

static bool usable(const struct relume_geometry *g, const double (*uv)[2], int views)
{
    if (views < 1 || !isfinite(g->uv_z) || !isfinite(g->st_z) || g->uv_z == g->st_z)
        return false;
    for (int axis = 0; axis < 2; axis++)
        if (!isfinite(g->st_min[axis]) || !isfinite(g->st_max[axis]) ||
            !(g->st_min[axis] < g->st_max[axis]))
            return false;
    for (int i = 0; i < views; i++)
        if (!isfinite(uv[i][0]) || !isfinite(uv[i][1]))
            return false;
    return true;
}

relume_status relume_slab_create(relume_slab **out, const struct relume_geometry *geometry,
                                 const double (*uv)[2], int views)
{
    *out = NULL;
    if (!usable(geometry, uv, views))
        return RELUME_EINVAL;
    relume_slab *slab = mem_zeroed(1, sizeof *slab);
    if (!slab)
        return RELUME_ENOMEM;
    slab->geometry = *geometry;
    slab->u = mem_array((size_t)views, sizeof *slab->u);
    slab->v = mem_array((size_t)views, sizeof *slab->v);
    slab->view = mem_array((size_t)views, sizeof *slab->view);
    relume_status status = RELUME_ENOMEM;
    if (slab->u && slab->v && slab->view)
        status = find_grid(slab, uv, views);
    if (status)
        relume_slab_destroy(&slab);
    *out = slab;
    return status;
}

void relume_slab_destroy(relume_slab **slab)
{
    if (!*slab)
        return;
    free((*slab)->u);
    free((*slab)->v);
    free((*slab)->view);
    free(*slab);
    *slab = NULL;
}

struct relume_slab_grid relume_slab_grid(const relume_slab *slab)
{
    return (struct relume_slab_grid){slab->columns, slab->rows, slab->u, slab->v, slab->view};
}

struct relume_vec3 relume_slab_middle(const relume_slab *slab)
{
    return (struct relume_vec3){
        .x = 0.5 * (slab->u[0] + slab->u[slab->columns - 1]),
        .y = 0.5 * (slab->v[0] + slab->v[slab->rows - 1]),
        .z = slab->geometry.uv_z,
    };
}

// ---------------------------------------------------------------- rays

// How far along the way from the eye (0) to the st plane (1) the uv plane lies.
static bool uv_reach(double *reach, const relume_slab *slab, struct relume_vec3 eye)
{
    const struct relume_geometry *g = &slab->geometry;
    const bool finite = isfinite(eye.x) && isfinite(eye.y) && isfinite(eye.z);
    if (!finite || (eye.z - g->st_z) * (g->uv_z - g->st_z) <= 0.0)
        return false;
    *reach = (g->uv_z - eye.z) / (g->st_z - eye.z);
    return true;
}

// Exact for a reach of 0; never decreases nor increases twice as `st` grows, rounding included.
static double uv_hit(double eye, double st, double reach)
{
    return eye + reach * (st - eye);
}

bool relume_slab_uv(double uv[2], const relume_slab *slab, struct relume_vec3 eye, double s,
                    double t)
{
    double reach;
    if (!uv_reach(&reach, slab, eye))
        return false;
    uv[0] = uv_hit(eye.x, s, reach);
    uv[1] = uv_hit(eye.y, t, reach);
    return true;
}

// ---------------------------------------------------------------- weights

static struct neighbours one_neighbour(int index)
{
    return (struct neighbours){1, {index, index}, {1.0, 0.0}};
}

static struct neighbours find_neighbours(const double *lines, int n, double slack, bool constant,
                                         double at)
{
    if (!(at >= lines[0] - slack && at <= lines[n - 1] + slack))
        return (struct neighbours){0};
    const int low = line_below(lines, n, at);
    if (low == n - 1 || at <= lines[low])
        return one_neighbour(low);
    const double part = (at - lines[low]) / (lines[low + 1] - lines[low]);
    if (constant)
        return one_neighbour(part < 0.5 ? low : low + 1);
    return (struct neighbours){2, {low, low + 1}, {1.0 - part, part}};
}

static struct neighbours column_neighbours(const relume_slab *slab, bool constant, double u)
{
    return find_neighbours(slab->u, slab->columns, slab->slack, constant, u);
}

static struct neighbours row_neighbours(const relume_slab *slab, bool constant, double v)
{
    return find_neighbours(slab->v, slab->rows, slab->slack, constant, v);
}

int relume_slab_blend(int view[4], double weight[4], const relume_slab *slab, const double uv[2],
                      const struct relume_view_params *params)
{
    const bool constant = params && params->constant;
    const struct neighbours across = column_neighbours(slab, constant, uv[0]);
    const struct neighbours down = row_neighbours(slab, constant, uv[1]);
    int n = 0;
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++, n++) {
            view[n] =
                slab->view[(size_t)down.index[j] * (size_t)slab->columns + (size_t)across.index[i]];
            weight[n] = down.weight[j] * across.weight[i];
        }
    return n;
}

// ---------------------------------------------------------------- which views

// The lines with weight anywhere between the points `a` and `b`; false when there are none.
static bool line_span(int span[2], const double *lines, int n, double slack, bool constant,
                      double a, double b)
{
    const double low = fmax(fmin(a, b), lines[0]);
    const double high = fmin(fmax(a, b), lines[n - 1]);
    if (low > high + slack)
        return false;
    const struct neighbours first = find_neighbours(lines, n, slack, constant, low);
    const struct neighbours last = find_neighbours(lines, n, slack, constant, high);
    span[0] = first.index[0];
    span[1] = last.index[last.count - 1];
    return true;
}

int relume_slab_needs(bool *needed, const relume_slab *slab, struct relume_vec3 eye,
                      const struct relume_view_params *params)
{
    const struct relume_geometry *g = &slab->geometry;
    const bool constant = params && params->constant;
    const size_t columns = (size_t)slab->columns;
    memset(needed, 0, columns * (size_t)slab->rows * sizeof *needed);
    double a[2], b[2];
    int across[2], down[2];
    if (!relume_slab_uv(a, slab, eye, g->st_min[0], g->st_min[1]) ||
        !relume_slab_uv(b, slab, eye, g->st_max[0], g->st_max[1]) ||
        !line_span(across, slab->u, slab->columns, slab->slack, constant, a[0], b[0]) ||
        !line_span(down, slab->v, slab->rows, slab->slack, constant, a[1], b[1]))
        return 0;
    for (int row = down[0]; row <= down[1]; row++)
        for (int column = across[0]; column <= across[1]; column++)
            needed[slab->view[(size_t)row * columns + (size_t)column]] = true;
    return (down[1] - down[0] + 1) * (across[1] - across[0] + 1);
}

// ---------------------------------------------------------------- frame

// One factor of a pixel's weights: up to two camera lines times up to two texels of the view.
struct taps {
    int count;
    int line[4];
    int texel[4];
    float weight[4];
};

// Pixel `i` of `pixels` lies at this place between the texel centres of a view of `texels`; a frame
// of the view's own size hits them exactly.
static struct neighbours texel_neighbours(int i, int pixels, int texels)
{
    const double at = ((2.0 * i + 1.0) * texels) / (2.0 * pixels) - 0.5;
    if (at <= 0.0)
        return one_neighbour(0);
    if (at >= texels - 1)
        return one_neighbour(texels - 1);
    const int low = (int)at;
    if (at == low)
        return one_neighbour(low);
    return (struct neighbours){2, {low, low + 1}, {1.0 - (at - low), at - low}};
}

static struct taps combine(struct neighbours lines, struct neighbours texels)
{
    struct taps taps = {0};
    for (int i = 0; i < lines.count; i++)
        for (int k = 0; k < texels.count; k++) {
            const int n = taps.count++;
            taps.line[n] = lines.index[i];
            taps.texel[n] = texels.index[k];
            taps.weight[n] = (float)(lines.weight[i] * texels.weight[k]);
        }
    return taps;
}

struct frame {
    const relume_slab *slab;
    const struct relume_image *out;
    const struct relume_image *views;
    const struct taps *across; // [width]
    const struct taps *down;   // [height]
};

static const float *texel(const struct frame *f, const struct taps *across, int i,
                          const struct taps *down, int j)
{
    const int columns = f->slab->columns;
    const int view =
        f->slab->view[(size_t)down->line[j] * (size_t)columns + (size_t)across->line[i]];
    const struct relume_image *image = &f->views[view];
    return image->data +
           3 * ((size_t)down->texel[j] * (size_t)image->width + (size_t)across->texel[i]);
}

static void draw_pixel(float *rgb, const struct frame *f, const struct taps *across,
                       const struct taps *down)
{
    const bool inside = across->count && down->count;
    // -0 + x is x for every x, 0 included: a single texel of weight 1 arrives bit by bit.
    rgb[0] = rgb[1] = rgb[2] = inside ? -0.0f : 0.0f;
    for (int j = 0; j < down->count; j++)
        for (int i = 0; i < across->count; i++) {
            const float w = down->weight[j] * across->weight[i];
            const float *from = texel(f, across, i, down, j);
            for (int c = 0; c < 3; c++)
                rgb[c] += w * from[c];
        }
}

static void draw_row(void *context, size_t row, int worker)
{
    const struct frame *f = context;
    (void)worker;
    float *rgb = f->out->data + 3 * row * (size_t)f->out->width;
    for (int x = 0; x < f->out->width; x++, rgb += 3)
        draw_pixel(rgb, f, &f->across[x], &f->down[row]);
}

// Column c looks at s = st_min + (c+.5)/W * extent; row 0 is at the top, where t is largest.
static void prepare_taps(struct taps *across, struct taps *down, const struct frame *f,
                         struct relume_vec3 eye, double reach, bool constant,
                         const struct relume_image *view)
{
    const struct relume_geometry *g = &f->slab->geometry;
    const int width = f->out->width;
    const int height = f->out->height;
    for (int x = 0; x < width; x++) {
        const double s = g->st_min[0] + (x + 0.5) / width * (g->st_max[0] - g->st_min[0]);
        const double u = uv_hit(eye.x, s, reach);
        across[x] = combine(column_neighbours(f->slab, constant, u),
                            texel_neighbours(x, width, view->width));
    }
    for (int y = 0; y < height; y++) {
        const double t = g->st_max[1] - (y + 0.5) / height * (g->st_max[1] - g->st_min[1]);
        const double v = uv_hit(eye.y, t, reach);
        down[y] = combine(row_neighbours(f->slab, constant, v),
                          texel_neighbours(y, height, view->height));
    }
}

// The first needed view when all needed ones are there, of one size and of three channels.
static const struct relume_image *check_views(const bool *needed, const struct relume_image *views,
                                              int n)
{
    const struct relume_image *first = NULL;
    for (int i = 0; i < n; i++) {
        if (!needed[i])
            continue;
        if (!first)
            first = &views[i];
        if (!views[i].data || views[i].channels != 3 || views[i].width != first->width ||
            views[i].height != first->height)
            return NULL;
    }
    return first;
}

relume_status relume_slab_frame(struct relume_image *out, const relume_slab *slab,
                                struct relume_vec3 eye, const struct relume_image *views,
                                const struct relume_view_params *params)
{
    const int cameras = slab->columns * slab->rows;
    double reach;
    if (!out->data || out->channels != 3 || !uv_reach(&reach, slab, eye))
        return RELUME_EINVAL;
    bool *needed = mem_zeroed((size_t)cameras, sizeof *needed);
    struct taps *across = mem_array((size_t)out->width, sizeof *across);
    struct taps *down = mem_array((size_t)out->height, sizeof *down);
    relume_status status = RELUME_ENOMEM;
    if (!needed || !across || !down)
        goto done;
    status = RELUME_EINVAL;
    if (!relume_slab_needs(needed, slab, eye, params))
        goto done;
    const struct relume_image *view = check_views(needed, views, cameras);
    if (!view)
        goto done;
    struct frame frame = {slab, out, views, across, down};
    prepare_taps(across, down, &frame, eye, reach, params && params->constant, view);
    thread_for(params ? params->threads : 0, (size_t)out->height, draw_row, &frame);
    status = RELUME_OK;
done:
    free(needed);
    free(across);
    free(down);
    return status;
}
