// ubo_values.c - the values of a .btf file of the University of Bonn: the product of its factors,
// colour by colour, and what undoes the decorrelation of its colours (docs/btf-bonn.md)
//
// A tile is some pairs of directions by some texels: both factors of it are turned into floats, the
// product is one call, and the texels of a pair lie together where they are stored. So the output
// is written from front to back, whatever its size.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "material/btf/ubo.h"
#include "core/base/half.h"
#include "core/math/lsq.h"

#include <float.h>
#include <string.h>

enum { PAIRS = 128, TEXELS = 256, BATCH = 256 };

static const float HALF_MAX = 65504.0f;
static const float EPSILON = 1e-5f;  // what Bonn adds before a logarithm

// ---------------------------------------------------------------- colours

static void keep(float *const v[UBO_COLOURS], size_t n, const struct ubo *u)
{
    (void)v, (void)n, (void)u;
}

static void apply(float *const v[UBO_COLOURS], size_t n, const float m[9], const float mean[3])
{
    for (size_t i = 0; i < n; i++) {
        const float a = v[0][i], b = v[1][i], c = v[2][i];
        for (int k = 0; k < UBO_COLOURS; k++)
            v[k][i] = m[3 * k] * a + m[3 * k + 1] * b + m[3 * k + 2] * c + mean[k];
    }
}

static const float NO_MEAN[3] = {0.0f, 0.0f, 0.0f};

static void from_yuv(float *const v[UBO_COLOURS], size_t n, const struct ubo *u)
{
    static const float m[9] = {1.0f,     0.0f, 1.13983f, 1.0f, -0.39465f,
                               -0.5806f, 1.0f, 2.03211f, 0.0f};
    (void)u;
    apply(v, n, m, NO_MEAN);
}

static void from_ycocg(float *const v[UBO_COLOURS], size_t n, const struct ubo *u)
{
    static const float m[9] = {1.0f, 1.0f, -1.0f, 1.0f, 0.0f, 1.0f, 1.0f, -1.0f, -1.0f};
    (void)u;
    apply(v, n, m, NO_MEAN);
}

// A row of numbers times the file's matrix.
static void from_pca(float *const v[UBO_COLOURS], size_t n, const struct ubo *u)
{
    float m[9];
    for (int i = 0; i < 9; i++)
        m[i] = u->matrix[3 * (i % 3) + i / 3];
    apply(v, n, m, u->mean);
}

static void undo_log(float *v, size_t n)
{
    for (size_t i = 0; i < n; i++)
        v[i] = expf(v[i]) - EPSILON;
}

static void from_log_rgb(float *const v[UBO_COLOURS], size_t n, const struct ubo *u)
{
    (void)u;
    for (int k = 0; k < UBO_COLOURS; k++)
        undo_log(v[k], n);
}

static void from_log_y(float *const v[UBO_COLOURS], size_t n, const struct ubo *u)
{
    undo_log(v[0], n);
    from_yuv(v, n, u);
}

static void from_log_yuv(float *const v[UBO_COLOURS], size_t n, const struct ubo *u)
{
    for (int k = 1; k < UBO_COLOURS; k++)
        for (size_t i = 0; i < n; i++)
            v[k][i] = v[k][i] == 0.0f ? 0.0f : copysignf(EPSILON * expf(fabsf(v[k][i])), v[k][i]);
    from_log_y(v, n, u);
}

static void from_log_y_ratios(float *const v[UBO_COLOURS], size_t n, const struct ubo *u)
{
    for (size_t i = 0; i < n; i++) {
        const float y = expf(v[0][i]);
        v[0][i] = y - EPSILON;
        v[1][i] *= y;
        v[2][i] *= y;
    }
    from_yuv(v, n, u);
}

static const struct ubo_colours all_colours[] = {
    {UBO_RGB, "RGB", keep},
    {1, "YUV", from_yuv},
    {3, "principal colours", from_pca},
    {4, "YCoCg", from_ycocg},
    {9, "log Y, U, V", from_log_y},
    {10, "log Y, log U, log V", from_log_yuv},
    {11, "log Y, U/Y, V/Y", from_log_y_ratios},
    {UBO_LOG_RGB, "log RGB", from_log_rgb},
};

const struct ubo_colours *ubo_colours_find(int number)
{
    for (size_t i = 0; i < sizeof all_colours / sizeof *all_colours; i++)
        if (all_colours[i].number == number)
            return &all_colours[i];
    return NULL;
}

// ---------------------------------------------------------------- factors

// A row of the file as floats, `step` apart.
static void read_row(float *to, size_t step, const uint8_t *row, int rank, int scalar)
{
    uint16_t half[UBO_MOST_RANK];
    if (scalar == 2) {
        memcpy(half, row, (size_t)rank * sizeof *half);
        for (int k = 0; k < rank; k++)
            to[(size_t)k * step] = float_from_half(half[k]);
        return;
    }
    for (int k = 0; k < rank; k++) {
        double d;
        float f;
        if (scalar == 4)
            memcpy(&f, row + 4 * (size_t)k, sizeof f);
        else
            memcpy(&d, row + 8 * (size_t)k, sizeof d), f = (float)d;
        to[(size_t)k * step] = f;
    }
}

// What a worker needs.
struct ubo_buffers {
    float *pair[UBO_COLOURS];     // [PAIRS][rank]
    float *texel;                 // [rank][TEXELS]
    float *product[UBO_COLOURS];  // [PAIRS][TEXELS]
};

static bool work_start(struct ubo_buffers *b, const struct ubo *u)
{
    int most = 0;
    bool good = true;
    for (int c = 0; c < UBO_COLOURS; c++) {
        const int rank = u->plane[c].rank;
        most = rank > most ? rank : most;
        b->pair[c] = mem_array((size_t)PAIRS * (size_t)rank, sizeof *b->pair[c]);
        b->product[c] = mem_array((size_t)PAIRS * TEXELS, sizeof *b->product[c]);
        good = good && b->pair[c] && b->product[c];
    }
    b->texel = mem_array((size_t)TEXELS * (size_t)most, sizeof *b->texel);
    return good && b->texel;
}

static void work_end(struct ubo_buffers *b)
{
    for (int c = 0; c < UBO_COLOURS; c++) {
        mem_free(b->pair[c]);
        mem_free(b->product[c]);
    }
    mem_free(b->texel);
}

static void read_pairs(const struct ubo_buffers *b, const struct ubo *u, size_t first, size_t n)
{
    for (int c = 0; c < UBO_COLOURS; c++) {
        const struct ubo_plane *p = &u->plane[c];
        for (size_t i = 0; i < n; i++)
            read_row(b->pair[c] + i * (size_t)p->rank, 1, p->pair + (first + i) * p->pair_step,
                     p->rank, p->scalar);
    }
}

// Texels are those of the crop.
static void read_texels(const struct ubo_buffers *b, const struct ubo *u, const struct ubo_plane *p,
                        size_t first, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const size_t x = (first + i) % (size_t)u->crop[2] + (size_t)u->crop[0];
        const size_t y = (first + i) / (size_t)u->crop[2] + (size_t)u->crop[1];
        read_row(b->texel + i, TEXELS, p->texel + (y * (size_t)u->width + x) * p->texel_step,
                 p->rank, p->scalar);
    }
}

static void multiply(const struct ubo_buffers *b, const struct ubo *u, size_t pairs, size_t first,
                     size_t n)
{
    for (int c = 0; c < UBO_COLOURS; c++) {
        const struct ubo_plane *p = &u->plane[c];
        if (!c || p->texel != p[-1].texel)
            read_texels(b, u, p, first, n);
        lsq_multiply((int)pairs, (int)n, p->rank, b->pair[c], p->rank, b->texel, TEXELS,
                     b->product[c], TEXELS);
    }
}

// ---------------------------------------------------------------- storing

// Values below 0, which too few components leave, become 0. False: NaN or infinity.
static bool store_row(uint16_t *to, float *const v[UBO_COLOURS], size_t n)
{
    bool good = true;
    for (int c = 0; c < UBO_COLOURS; c++)
        for (size_t i = 0; i < n; i++) {
            const float f = v[c][i];
            good &= fabsf(f) <= FLT_MAX;
            to[3 * i + (size_t)c] = half_from_float(f > HALF_MAX ? HALF_MAX : f > 0.0f ? f : 0.0f);
        }
    return good;
}

struct storing {
    const struct ubo *ubo;
    relume_btf *btf;
    struct ubo_buffers *work;  // one a worker
    size_t first;              // item of the batch
    size_t bad[BATCH];         // the first pair of an item that is not finite, or SIZE_MAX
};

static void store_item(void *context, size_t item, int worker)
{
    struct storing *s = context;
    const struct ubo *u = s->ubo;
    const struct ubo_buffers *b = &s->work[worker];
    const size_t texels = btf_texels(s->btf), first = (s->first + item) * PAIRS;
    const size_t all = (size_t)u->views * (size_t)u->lights;
    const size_t pairs = all - first < PAIRS ? all - first : PAIRS;
    s->bad[item] = SIZE_MAX;
    read_pairs(b, u, first, pairs);
    for (size_t t = 0; t < texels; t += TEXELS) {
        const size_t n = texels - t < TEXELS ? texels - t : TEXELS;
        multiply(b, u, pairs, t, n);
        for (size_t i = 0; i < pairs; i++) {
            float *const v[UBO_COLOURS] = {b->product[0] + i * TEXELS, b->product[1] + i * TEXELS,
                                           b->product[2] + i * TEXELS};
            u->colours->turn(v, n, u);
            if (!store_row(s->btf->own + 3 * ((first + i) * texels + t), v, n) &&
                first + i < s->bad[item])
                s->bad[item] = first + i;
        }
    }
}

static relume_status check_batch(const struct storing *s, size_t n)
{
    const struct ubo *u = s->ubo;
    for (size_t i = 0; i < n; i++)
        if (s->bad[i] != SIZE_MAX)
            return log_fail(u->log, RELUME_EDAMAGED,
                            "view %zu, light %zu: NaN or infinity; expected finite values",
                            s->bad[i] / (size_t)u->lights, s->bad[i] % (size_t)u->lights);
    return RELUME_OK;
}

static relume_status store_batches(struct storing *s, int threads)
{
    const size_t pairs = (size_t)s->ubo->views * (size_t)s->ubo->lights;
    const size_t items = (pairs + PAIRS - 1) / PAIRS;
    relume_status status = RELUME_OK;
    const size_t batch = 4 * (size_t)threads < BATCH ? 4 * (size_t)threads : BATCH;
    for (s->first = 0; s->first < items && !status; s->first += batch) {
        const size_t n = items - s->first < batch ? items - s->first : batch;
        thread_for(threads, n, store_item, s);
        status = check_batch(s, n);
        if (!status &&
            !log_progress(s->ubo->log, "reading", (double)(s->first + n) / (double)items))
            status = RELUME_ECANCEL;
    }
    return status;
}

relume_status ubo_store(const struct ubo *u, relume_btf *btf)
{
    const int threads = thread_count(u->params ? u->params->threads : 0);
    struct storing s = {u, btf, mem_zeroed((size_t)threads, sizeof *s.work), 0, {0}};
    relume_status status = s.work ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; i < threads && !status; i++)
        status = work_start(&s.work[i], u) ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = store_batches(&s, threads);
    for (int i = 0; i < threads && s.work; i++)
        work_end(&s.work[i]);
    mem_free(s.work);
    return status;
}
