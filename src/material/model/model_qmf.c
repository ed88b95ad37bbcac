// model_qmf.c - a full matrix factorisation in as few bits as it needs: for a wanted size, each
// component's scores and patterns get the widths that together lose least
//     BTF(x, v, l) ~ C sum_k weight_k(x) pattern_k(v, l)
//
// C turns colours to where they are uncorrelated over the whole sample (Karhunen and Loeve), so
// that two of three pattern channels need few bits or none. Scores and patterns are numbers of 0 to
// 10 bits between levels of their own. With orthonormal patterns errors add up: what a width loses
// is known for each plane by itself, and Lagrange's multiplier makes the best of all planes under
// one sum of bytes (Shoham and Gersho 1988).
//
// A texel is one row of bits, a pair of directions another, and all rows are laid out alike: any
// value can be read in place. Here only texels are: patterns are unpacked once.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"
#include "material/model/reduce.h"
#include "material/model/scalar.h"

#include <string.h>

enum { SCORE, PATTERN, WIDTH, LEVELS, COLOR };
enum { PLANES = 4 };  // of a component: its scores, its pattern in three colours
// Bytes that hold a number of LEVELS_BITS bits wherever it begins: the least a texel has.
enum { WINDOW = 3 };
static const double USUAL_RATIO = 200.0;
// Components looked at, from the bytes wanted: those that are worth it have more bits than this in
// scores and patterns together, for each texel and pair.
static const double LEAST_BITS = 3.0;

static void layout(relume_btf_fitted *m)
{
    const size_t k = (size_t)m->components;
    if (!m->texel_bytes)
        return;  // before the fit
    model_add(m, "score", NPY_U8, true, 256, MODEL_SHAPE(m->texels, (size_t)m->texel_bytes));
    model_add(m, "pattern", NPY_U8, false, 256,
              MODEL_SHAPE((size_t)m->views, (size_t)m->lights, (size_t)m->pair_bytes));
    model_add(m, "width", NPY_U8, false, LEVELS_BITS + 1, MODEL_SHAPE(k, PLANES));
    model_add(m, "levels", NPY_FLOAT, false, 0, MODEL_SHAPE(k, PLANES, 3));
    model_add(m, "color", NPY_FLOAT, false, 0, MODEL_SHAPE(3, 3));
}

// ---------------------------------------------------------------- what each width loses

struct plane {
    const float *first;
    size_t count, stride;
    double weight;  // of a squared error in it
    struct levels levels[LEVELS_BITS + 1];
    double error[LEVELS_BITS + 1];  // of all its numbers, weighted
    int bits;
};

struct qmf_fit {
    struct fitting *f;
    struct reduced r;
    double energy[1024];  // [component]
    double color[9];      // rows: to uncorrelated colours
    struct plane *plane;  // [component][PLANES]
    size_t texels, pairs;
    bool failed;  // set by any worker, read after all
};

// Turn the patterns' colours, most of the energy first.
static bool turn_colors(struct qmf_fit *w)
{
    double gram[9] = {0.0}, values[3];
    for (int k = 0; k < w->r.count; k++)
        for (size_t i = 0; i < w->pairs; i++) {
            const float *p = w->r.basis + (size_t)k * w->r.values + 3 * i;
            for (int a = 0; a < 3; a++)
                for (int b = 0; b < 3; b++)
                    gram[3 * a + b] += w->energy[k] * (double)p[a] * (double)p[b];
        }
    if (!lsq_eigenvectors(gram, 3, 3, values, w->color))
        return false;
    for (size_t i = 0; i < (size_t)w->r.count * w->pairs; i++) {
        float *p = w->r.basis + 3 * i;
        const double rgb[3] = {(double)p[0], (double)p[1], (double)p[2]};
        for (int a = 0; a < 3; a++)
            p[a] = (float)(w->color[3 * a] * rgb[0] + w->color[3 * a + 1] * rgb[1] +
                           w->color[3 * a + 2] * rgb[2]);
    }
    return true;
}

static void measure_component(void *context, size_t k, int worker)
{
    (void)worker;
    struct qmf_fit *w = context;
    const size_t count = (size_t)w->r.count;
    struct plane *p = w->plane + k * PLANES;
    p[0] =
        (struct plane){.first = w->r.score + k, .count = w->texels, .stride = count, .weight = 1.0};
    for (size_t c = 0; c < 3; c++)
        p[c + 1] = (struct plane){.first = w->r.basis + k * w->r.values + c,
                                  .count = w->pairs,
                                  .stride = 3,
                                  .weight = w->energy[k]};
    for (int i = 0; i < PLANES; i++) {
        if (!levels_choose(p[i].first, p[i].count, p[i].stride, p[i].levels, p[i].error))
            __atomic_store_n(&w->failed, true, __ATOMIC_RELAXED);
        for (int b = 0; b <= LEVELS_BITS; b++)
            p[i].error[b] *= p[i].weight * (double)p[i].count;
    }
}

// ---------------------------------------------------------------- who gets how many bits

// The width of least error plus `price` times its bits; returns that sum.
static double choose_bits(struct plane *p, double price)
{
    double least = INFINITY;
    for (int b = 0; b <= LEVELS_BITS; b++) {
        const double cost = p->error[b] + price * b * (double)p->count;
        if (cost < least) {
            least = cost;
            p->bits = b;
        }
    }
    return least;
}

static size_t bytes_of(const struct qmf_fit *w, size_t *texel, size_t *pair)
{
    size_t score_bits = 0, pattern_bits = 0, used = 0;
    for (int k = 0; k < w->r.count; k++) {
        const struct plane *p = w->plane + k * PLANES;
        score_bits += (size_t)p[0].bits;
        pattern_bits += (size_t)(p[1].bits + p[2].bits + p[3].bits);
        used += p[0].bits > 0;
    }
    *texel = (score_bits + 7) / 8 > WINDOW ? (score_bits + 7) / 8 : WINDOW;
    *pair = pattern_bits ? (pattern_bits + 7) / 8 : 1;
    return w->texels * *texel + w->pairs * *pair + used * PLANES * (1 + sizeof(struct levels)) +
           sizeof(float[9]);
}

static size_t allocate(struct qmf_fit *w, double price, size_t *texel, size_t *pair)
{
    for (int k = 0; k < w->r.count; k++) {
        struct plane *p = w->plane + k * PLANES;
        double cost = 0.0;
        for (int i = 0; i < PLANES; i++)
            cost += choose_bits(&p[i], price);
        // a component is dropped where its whole energy costs less
        if (k && (!p[0].bits || cost >= w->energy[k]))
            for (int i = 0; i < PLANES; i++)
                p[i].bits = 0;
        if (!k)
            p[0].bits = p[0].bits ? p[0].bits : 1;
    }
    return bytes_of(w, texel, pair);
}

// The lowest price at which all fits into `most` bytes.
static void spend(struct qmf_fit *w, double most, size_t *texel, size_t *pair)
{
    double low = 1e-14 * w->energy[0], high = w->energy[0] + 1e-30;
    for (int i = 0; i < 60; i++) {
        const double price = sqrt(low * high);
        if ((double)allocate(w, price, texel, pair) > most)
            low = price;
        else
            high = price;
    }
    allocate(w, high, texel, pair);
}

// ---------------------------------------------------------------- writing

static void write_texel(void *context, size_t texel, int worker)
{
    (void)worker;
    const struct qmf_fit *w = context;
    const relume_btf_fitted *m = w->f->out;
    uint8_t *row = (uint8_t *)m->array[SCORE].data + texel * (size_t)m->texel_bytes;
    size_t at = 0;
    for (int k = 0; k < w->r.count; k++) {
        const struct plane *p = w->plane + k * PLANES;
        const float value = p->first[texel * p->stride];
        bits_put(row, at, p->bits, levels_number(&p->levels[p->bits], p->bits, value));
        at += (size_t)p->bits;
    }
}

static void write_pair(void *context, size_t pair, int worker)
{
    (void)worker;
    const struct qmf_fit *w = context;
    const relume_btf_fitted *m = w->f->out;
    uint8_t *row = (uint8_t *)m->array[PATTERN].data + pair * (size_t)m->pair_bytes;
    size_t at = 0;
    for (int i = 0; i < w->r.count * PLANES; i++) {
        const struct plane *p = w->plane + i;
        if (i % PLANES == 0)
            continue;
        const float value = p->first[pair * p->stride];
        bits_put(row, at, p->bits, levels_number(&p->levels[p->bits], p->bits, value));
        at += (size_t)p->bits;
    }
}

static void write_tables(const struct qmf_fit *w)
{
    const relume_btf_fitted *m = w->f->out;
    uint8_t *width = m->array[WIDTH].data;
    struct levels *levels = m->array[LEVELS].data;
    for (int i = 0; i < w->r.count * PLANES; i++) {
        const struct plane *p = w->plane + i;
        if (!w->plane[i - i % PLANES].bits)
            continue;  // dropped
        *width++ = (uint8_t)p->bits;
        *levels++ = p->levels[p->bits];
    }
    for (int i = 0; i < 9; i++)
        model_floats(m, COLOR)[i] = (float)w->color[i];
}

static relume_status write(struct qmf_fit *w)
{
    relume_btf_fitted *m = w->f->out;
    m->components = 0;
    for (int k = 0; k < w->r.count; k++)
        m->components += w->plane[k * PLANES].bits > 0;
    const relume_status status = model_make_arrays(m);
    if (status)
        return status;
    thread_for(w->f->threads, w->texels, write_texel, w);
    thread_for(w->f->threads, w->pairs, write_pair, w);
    write_tables(w);
    return RELUME_OK;
}

static relume_status quantise(struct qmf_fit *w, double most)
{
    size_t texel, pair;
    for (size_t i = 0; i < w->texels; i++)
        for (int k = 0; k < w->r.count; k++) {
            const double s = (double)w->r.score[i * (size_t)w->r.count + (size_t)k];
            w->energy[k] += s * s;
        }
    w->plane = mem_array((size_t)w->r.count * PLANES, sizeof *w->plane);
    if (!w->plane || !turn_colors(w))
        return RELUME_ENOMEM;
    thread_for(w->f->threads, (size_t)w->r.count, measure_component, w);
    if (w->failed)
        return RELUME_ENOMEM;
    spend(w, most, &texel, &pair);
    w->f->out->texel_bytes = (int)texel, w->f->out->pair_bytes = (int)pair;
    return write(w);
}

static relume_status fit(struct fitting *f)
{
    const relume_btf_fitted *m = f->out;
    struct qmf_fit w = {.f = f, .texels = m->texels, .pairs = model_pairs(m)};
    const double measured = (double)relume_btf_bytes(m->width, m->height, m->views, m->lights);
    const double most = measured / (f->ratio > 0.0 ? f->ratio : USUAL_RATIO);
    const double worth = 8.0 * most / (LEAST_BITS * (double)(w.texels + w.pairs));
    const int count = worth < 1.0 ? 1 : worth < m->components ? (int)worth : m->components;
    relume_status status = reduce_make(&w.r, f, count);
    if (!status)
        status = quantise(&w, most);
    reduce_free(&w.r);
    mem_free(w.plane);
    return status;
}

// ---------------------------------------------------------------- reading

static const char *fault(const relume_btf_fitted *m)
{
    const uint8_t *width = m->array[WIDTH].data;
    size_t score_bits = 0, pattern_bits = 0;
    for (int i = 0; i < m->components * PLANES; i++)
        *(i % PLANES ? &pattern_bits : &score_bits) += width[i];
    // components without a bit are not written: so many cannot be
    const bool good = score_bits <= 8 * (size_t)m->texel_bytes &&
                      pattern_bits <= 8 * (size_t)m->pair_bytes &&
                      m->components <= 8 * m->texel_bytes && m->texel_bytes >= WINDOW;
    return good ? NULL : "rows of bits as long as their widths";
}

// Where a component's number lies in the row of a texel, and how to read it.
struct score {
    int byte, shift;  // of a window that ends inside the row
    unsigned mask;
    float step, first;  // t = step number + first
    struct levels levels;
};

// What reading needs again and again.
struct ready {
    struct score score[1024];
    float pattern[];  // [pair][component][3], colours turned back
};

static void find_scores(const relume_btf_fitted *m, struct score *out)
{
    const uint8_t *width = m->array[WIDTH].data;
    const struct levels *levels = m->array[LEVELS].data;
    for (int k = 0, at = 0; k < m->components; k++, width += PLANES, levels += PLANES) {
        const int last = m->texel_bytes - WINDOW, byte = at / 8 < last ? at / 8 : last;
        out[k] = (struct score){.byte = byte, .shift = at - 8 * byte, .levels = *levels};
        if (*width) {
            out[k].mask = (1u << *width) - 1;
            out[k].step = 2.0f / (float)out[k].mask;
            out[k].first = -1.0f;
        }
        at += *width;
    }
}

static void unpack_pair(const relume_btf_fitted *m, size_t pair, float *to)
{
    const float *color = model_floats(m, COLOR);
    const uint8_t *width = m->array[WIDTH].data;
    const struct levels *levels = m->array[LEVELS].data;
    struct bit_reader row = {.next = (const uint8_t *)m->array[PATTERN].data +
                                     pair * (size_t)m->pair_bytes};
    for (int k = 0; k < m->components; k++, width += PLANES, levels += PLANES, to += 3) {
        float p[3];
        for (int c = 1; c < PLANES; c++)
            p[c - 1] = levels_value(&levels[c], width[c], bit_reader_take(&row, width[c]));
        for (int c = 0; c < 3; c++)
            to[c] = color[c] * p[0] + color[3 + c] * p[1] + color[6 + c] * p[2];
    }
}

static relume_status prepare(relume_btf_fitted *m)
{
    const size_t pairs = model_pairs(m), each = 3 * (size_t)m->components;
    struct ready *ready = mem_array(sizeof *ready + pairs * each * sizeof(float), 1);
    if (!ready)
        return RELUME_ENOMEM;
    find_scores(m, ready->score);
    for (size_t pair = 0; pair < pairs; pair++)
        unpack_pair(m, pair, ready->pattern + pair * each);
    m->prepared = ready;
    return RELUME_OK;
}

static inline float score_in(const uint8_t *row, const struct score *s)
{
    const uint8_t *at = row + s->byte;
    const unsigned window = at[0] | (unsigned)at[1] << 8 | (unsigned)at[2] << 16;
    const float t = s->step * (float)(window >> s->shift & s->mask) + s->first;
    return s->levels.middle + t * (s->levels.linear + s->levels.cubic * t * t);
}

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    const size_t pair = (size_t)at->view * (size_t)m->lights + (size_t)at->light;
    const struct ready *ready = m->prepared;
    const float *pattern = ready->pattern + 3 * pair * (size_t)m->components;
    const uint8_t *row = (const uint8_t *)m->array[SCORE].data + at->texel * (size_t)m->texel_bytes;
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (int k = 0; k < m->components; k++, pattern += 3) {
        const float w = score_in(row, &ready->score[k]);
        for (int c = 0; c < 3; c++)
            rgb[c] += w * pattern[c];
    }
}

// Rows of bits, 16 bytes at a time; levels and widths lie in constant memory.
static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    const uint8_t *width = m->array[WIDTH].data;
    int scores = 0, numbers = 0;
    for (int i = 0; i < m->components * PLANES; i++)
        *(i % PLANES ? &numbers : &scores) += width[i] > 0;
    const int decode = 5;  // shift, mask, to a number, the square, two multiply-adds
    return (struct relume_btf_cost){.ops = decode * scores,
                                    .fetches = 2 + (m->texel_bytes + 15) / 16,
                                    .light_ops = 9 * (decode + 1) * numbers + 3,
                                    .light_fetches = 2 + 9 * ((m->pair_bytes + 15) / 16)};
}

const struct relume_btf_model model_qmf = {
    .name = "qmf",
    .summary = "full matrix factorisation in as few bits as each part needs",
    .view_grid = true,
    .light_grid = true,
    .components = 512,
    .most_components = 1024,
    .layout = layout,
    .fit = fit,
    .eval = eval,
    .cost = cost,
    .fault = fault,
    .bit_rows = true,
    .prepare = prepare,
};
