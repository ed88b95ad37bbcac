// near_fit.c - near lights: every pixel is fitted at the directions from which it was lit
#include "format/coder/near_fit.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "core/math/lsq.h"
#include "format/coder/coding.h"

#include <string.h>

// Weak beside the pixel's own samples. Less or more of it changes little between 0.001 and 0.3;
// beyond 1 the gain is lost.
static const double GUESS = 0.1;

struct near_fit {
    const relume_coder *coder;
    const relume_table *table;
    struct design design;
    int width, height, threads;
    int cell, columns, rows;  // pixels between nodes, nodes
    size_t node_size;         // floats: map [k][own and guessed rows of the design], [k] constants
    float **node;             // [rows]: [columns][node_size]; NULL: not needed now
    float *mixed;             // [workers][columns][node_size]
    double *work;             // [workers][work_size]
    size_t work_size;
    float *cells;  // [workers][cell_size]
    size_t cell_size;
    // of the call in progress
    int row, band_rows, node_row;
    const float *own, *guess;
    float *planes;
};

bool near_fit_suits(const relume_coder *coder)
{
    return !coder->robust && coder->info.basis->fits;
}

void near_fit_destroy(struct near_fit **fit)
{
    struct near_fit *s = *fit;
    *fit = NULL;
    if (!s)
        return;
    for (int i = 0; s->node && i < s->rows; i++)
        mem_free(s->node[i]);
    mem_free(s->node);
    mem_free(s->mixed);
    mem_free(s->work);
    mem_free(s->cells);
    design_destroy(&s->design);
    mem_free(s);
}

relume_status near_fit_create(struct near_fit **out, const relume_coder *coder,
                              const relume_table *table, int width, int height, int threads)
{
    struct near_fit *s = *out = mem_zeroed(1, sizeof *s);
    if (!s)
        return RELUME_ENOMEM;
    *s = (struct near_fit){.coder = coder,
                           .table = table,
                           .width = width,
                           .height = height,
                           .threads = thread_count(threads),
                           .cell = coarse_cell(width, height)};
    relume_status status = design_create(&s->design, coder);
    if (status) {
        near_fit_destroy(out);
        return status;
    }
    const size_t k = (size_t)s->design.k, n = (size_t)s->design.rows;
    const size_t lights = (size_t)s->design.lights, workers = (size_t)s->threads;
    s->columns = (width + s->cell - 1) / s->cell + 1;
    s->rows = (height + s->cell - 1) / s->cell + 1;
    s->node_size = 2 * k * n + k;
    // the system, its right sides, rows and constants, directions; weights of one light
    s->work_size = k * k + 2 * n * k + n * k + n + 3 * lights + 3 * k;
    s->node = mem_zeroed((size_t)s->rows, sizeof *s->node);
    s->mixed = mem_array(workers * (size_t)s->columns * s->node_size, sizeof *s->mixed);
    s->work = mem_array(workers * s->work_size, sizeof *s->work);
    // samples in the order of the design and of guesses by channels, coefficients left and right
    s->cell_size = (6 * lights + 3 * lights + 2 * k) * (size_t)s->cell;
    s->cells = mem_array(workers * s->cell_size, sizeof *s->cells);
    if (!s->node || !s->mixed || !s->work || !s->cells) {
        near_fit_destroy(out);
        return RELUME_ENOMEM;
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- nodes

// right[row] is the column of the right sides that belongs to sample `row`, of own and of guessed.
static void fill_sides(const struct design *d, const double *y, double *right)
{
    const size_t k = (size_t)d->k, n = (size_t)d->rows, lights = (size_t)d->lights;
    for (size_t r = 0; r < n; r++)
        for (size_t j = 0; j < k; j++) {
            right[r * k + j] = y[r * k + j] / (double)lights;
            right[(n + r) * k + j] = GUESS * d->y[r * k + j] / (double)lights +
                                     (d->fill ? d->fill[j * lights + r] : 0.0);
        }
}

static void fill_system(const struct design *d, const double *y, double *m)
{
    const size_t k = (size_t)d->k, n = (size_t)d->rows;
    memcpy(m, d->prior, k * k * sizeof *m);
    for (size_t r = 0; r < n; r++)
        for (size_t i = 0; i < k; i++)
            for (size_t j = 0; j <= i; j++)
                m[i * k + j] +=
                    (y[r * k + i] * y[r * k + j] + GUESS * d->y[r * k + i] * d->y[r * k + j]) /
                    (double)d->lights;
}

// Transposed, and what the constants of learned bases take away.
static void store(const struct design *d, const double *right, const double *constant, float *to)
{
    const size_t k = (size_t)d->k, n = (size_t)d->rows;
    for (size_t j = 0; j < k; j++) {
        double base = 0.0;
        for (size_t r = 0; r < n; r++) {
            to[2 * j * n + r] = (float)right[r * k + j];
            to[(2 * j + 1) * n + r] = (float)right[(n + r) * k + j];
            base -= right[r * k + j] * constant[r] + right[(n + r) * k + j] * d->constant[r];
        }
        to[2 * k * n + j] = (float)base;
    }
}

static void solve_node(void *context, size_t item, int worker)
{
    struct near_fit *s = context;
    const struct design *d = &s->design;
    const size_t k = (size_t)d->k, n = (size_t)d->rows;
    double *m = s->work + (size_t)worker * s->work_size, *right = m + k * k;
    double *y = right + 2 * n * k, *constant = y + n * k;
    struct relume_vec3 *direction = (struct relume_vec3 *)(void *)(constant + n);
    float *weights = (float *)(void *)(direction + d->lights);
    float *to = s->node[s->node_row] + item * s->node_size;
    relume_table_directions(s->table, (double)item * s->cell, (double)s->node_row * s->cell,
                            s->cell / 2, direction);
    design_rows(y, constant, d, s->coder, direction, weights);
    fill_system(d, y, m);
    fill_sides(d, y, right);
    if (!lsq_solve(m, d->k, right, 2 * d->rows))
        memset(right, 0, 2 * n * k * sizeof *right);
    store(d, right, constant, to);
}

// Rows of nodes around the band; others are given back.
static bool need_nodes(struct near_fit *s)
{
    const int first = s->row / s->cell, last = (s->row + s->band_rows - 1) / s->cell + 1;
    for (int i = 0; i < s->rows; i++) {
        if (i < first || i > last) {
            mem_free(s->node[i]);
            s->node[i] = NULL;
        } else if (!s->node[i]) {
            s->node[i] = mem_array((size_t)s->columns * s->node_size, sizeof **s->node);
            if (!s->node[i])
                return false;
            s->node_row = i;
            thread_for(s->threads, (size_t)s->columns, solve_node, s);
        }
    }
    return true;
}

// ---------------------------------------------------------------- pixels

// Pixels between two nodes, in one row of the band.
struct piece {
    int y, x, n;        // row of the band, first column, how many
    float part;         // of the way from the left node to the right one, for pixel 0
    const float *left;  // its maps, mixed for the row
    float *v;           // [sets][own and guessed rows][n], samples in the order of the design
    float *parted;      // [3][lights][n]
    float *side[2];     // [k][n]
};

static const float *sample_at(const struct near_fit *s, const float *band, int light, int y, int x)
{
    return band +
           3 * (((size_t)light * (size_t)s->band_rows + (size_t)y) * (size_t)s->width + (size_t)x);
}

// A luminance coder's own samples, over the sum of the colour that the guesses have.
static void order_luminance(const struct near_fit *s, const struct piece *p)
{
    const size_t lights = (size_t)s->design.lights, n = (size_t)p->n;
    const size_t stride = 3 * (size_t)s->band_rows * (size_t)s->width;
    const size_t plane = (size_t)s->band_rows * (size_t)s->width;
    float *planes = s->planes + (size_t)p->y * (size_t)s->width + (size_t)p->x;
    const float *colour = planes + (size_t)s->design.k * plane;
    coder_part(s->coder, p->parted, sample_at(s, s->guess, 0, p->y, p->x), stride, n, planes,
               plane);
    memcpy(p->v + lights * n, p->parted, lights * n * sizeof *p->v);
    for (size_t x = 0; x < n; x++) {
        const float sum = colour[x] + colour[plane + x] + colour[2 * plane + x];
        const float scale = sum > 1e-6f ? 1.0f / sum : 0.0f;
        for (size_t i = 0; i < lights; i++) {
            const float *rgb = sample_at(s, s->own, (int)i, p->y, p->x + (int)x);
            p->v[i * n + x] = (rgb[0] + rgb[1] + rgb[2]) * scale;
        }
    }
}

static void order_colours(const struct near_fit *s, const struct piece *p)
{
    const struct design *d = &s->design;
    const int lights = d->lights, channels = d->rows / lights;
    for (int of_guess = 0; of_guess < 2; of_guess++)
        for (int i = 0; i < lights; i++) {
            const float *rgb = sample_at(s, of_guess ? s->guess : s->own, i, p->y, p->x);
            for (int c = 0; c < 3; c++) {
                const int row = channels > 1 ? i * channels + c : 2 * c * lights + i;
                float *to = p->v + (size_t)(row + of_guess * d->rows) * (size_t)p->n;
                for (int x = 0; x < p->n; x++)
                    to[x] = rgb[3 * x + c];
            }
        }
}

static void fit_piece(const struct near_fit *s, const struct piece *p)
{
    const struct design *d = &s->design;
    const struct relume_coder_info *info = &s->coder->info;
    const size_t k = (size_t)d->k, n = (size_t)p->n, samples = 2 * (size_t)d->rows;
    const size_t plane = (size_t)s->band_rows * (size_t)s->width;
    float *planes = s->planes + (size_t)p->y * (size_t)s->width + (size_t)p->x;
    if (info->luminance)
        order_luminance(s, p);
    else
        order_colours(s, p);
    for (size_t set = 0; set < (info->joint ? 1u : 3u); set++) {
        for (size_t side = 0; side < 2; side++)
            lsq_multiply(d->k, p->n, (int)samples, p->left + side * s->node_size, (int)samples,
                         p->v + set * samples * n, p->n, p->side[side], p->n);
        const float *left = p->left + k * samples, *right = left + s->node_size;
        for (size_t j = 0; j < k; j++) {
            float *out = planes + (size_t)relume_coder_plane(info, (int)j, (int)set) * plane;
            for (size_t x = 0; x < n; x++) {
                const float a = p->side[0][j * n + x] + left[j];
                const float b = p->side[1][j * n + x] + right[j];
                out[x] = a + (p->part + (float)x / (float)s->cell) * (b - a);
            }
        }
    }
}

static void fit_row(void *context, size_t item, int worker)
{
    const struct near_fit *s = context;
    const int y = s->row + (int)item, above = y / s->cell;
    const float part = ((float)(y - above * s->cell) + 0.5f) / (float)s->cell;
    const float *top = s->node[above], *bottom = s->node[above + 1];
    const size_t size = (size_t)s->columns * s->node_size, lights = (size_t)s->design.lights;
    float *mixed = s->mixed + (size_t)worker * size;
    float *v = s->cells + (size_t)worker * s->cell_size;
    for (size_t i = 0; i < size; i++)
        mixed[i] = top[i] + part * (bottom[i] - top[i]);
    for (int x = 0; x < s->width; x += s->cell) {
        const int n = s->width - x < s->cell ? s->width - x : s->cell;
        float *parted = v + 6 * lights * (size_t)n, *side = parted + 3 * lights * (size_t)n;
        const struct piece p = {
            .y = (int)item,
            .x = x,
            .n = n,
            .part = 0.5f / (float)s->cell,
            .left = mixed + (size_t)(x / s->cell) * s->node_size,
            .v = v,
            .parted = parted,
            .side = {side, side + (size_t)s->design.k * (size_t)n},
        };
        fit_piece(s, &p);
    }
}

relume_status near_fit_apply(struct near_fit *fit, int row, int rows, const float *own,
                             const float *guess, float *planes)
{
    fit->row = row;
    fit->band_rows = rows;
    fit->own = own;
    fit->guess = guess;
    fit->planes = planes;
    if (!need_nodes(fit))
        return RELUME_ENOMEM;
    thread_for(fit->threads, (size_t)rows, fit_row, fit);
    return RELUME_OK;
}

void near_fit_predict(struct near_fit *fit, int worker, int x, int y, const float *planes,
                      size_t plane_stride, float *out)
{
    const struct design *d = &fit->design;
    const struct relume_coder_info *info = &fit->coder->info;
    double *work = fit->work + (size_t)worker * fit->work_size;
    struct relume_vec3 *direction = (struct relume_vec3 *)(void *)work;
    float *weights = (float *)(void *)(direction + d->lights), constant[3];
    relume_table_directions(fit->table, x + 0.5, y + 0.5, 1, direction);
    for (int i = 0; i < d->lights; i++) {
        relume_coder_weights(fit->coder, direction[i], weights, constant);
        for (int c = 0; c < 3; c++) {
            float sum = constant[c];
            for (int k = 0; k < d->k; k++)
                sum += weights[c * d->k + k] *
                       planes[(size_t)relume_coder_plane(info, k, c) * plane_stride];
            out[3 * i + c] =
                sum * (info->luminance ? planes[(size_t)(d->k + c) * plane_stride] : 1.0f);
        }
    }
}
