// depth.c - heights by similarity of reciprocal pictures (Menzel 2011, section 6.3.1)
//
// Reflectance is the same when light and eye change places, and n.l is nearly one number in a small
// window, so that logarithms of the two pictures differ there by a constant: their normalised
// correlation is 1 where the window lies on the surface. For every layer of height all pictures are
// shifted by its parallax, and correlations of 5 x 5 windows are averaged over the pairs; the
// surface is the least cut of the cost 1 - mean (cut.h), between layers the top of a parabola.
#include "material/gbrdf/depth.h"

#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/luminance.h"
#include "material/btf/values.h"
#include "material/gbrdf/cut.h"

#include <stdatomic.h>
#include <string.h>

enum { LAYERS = 25, MOST_PAIRS = 300, BATCH = 12, WINDOW = 5 };
static const double RANGE = 0.1;   // widths of the sample, to both sides of the plane
static const double SMOOTH = 0.1;  // k of the thesis
// Lower directions shift by more than windows can follow.
static const double LOWEST = 0.48;
// Of the mean of a picture, added to values: shadows have no texture.
static const double DARK = 0.05;

struct volume {
    const relume_btf *btf;
    int width, height;
    size_t texels;
    const struct picture_pair *pair;  // of this batch
    int count;
    float *logs;  // [batch][2][texels]
    float *sum;   // [layer][texels]
    atomic_bool failed;
};

static double height_of(const struct volume *v, int layer)
{
    return v->width * RANGE * (2.0 * layer / (LAYERS - 1) - 1.0);
}

static void take_logarithms(void *context, size_t item, int worker)
{
    (void)worker;
    const struct volume *v = context;
    const struct picture_pair *pair = &v->pair[item / 2];
    const uint16_t *p = relume_btf_picture(v->btf, pair->view[item % 2], pair->light[item % 2]);
    float *to = v->logs + item * v->texels;
    double sum = 0.0;
    for (size_t i = 0; i < v->texels; i++) {
        const float rgb[3] = {float_from_half(p[3 * i]), float_from_half(p[3 * i + 1]),
                              float_from_half(p[3 * i + 2])};
        to[i] = fmaxf(luminance_709f(rgb), 0.0f);
        sum += (double)to[i];
    }
    const float dark = (float)(DARK * sum / (double)v->texels + 1e-9);
    const float middle = logf(dark + (float)(sum / (double)v->texels));
    for (size_t i = 0; i < v->texels; i++)
        to[i] = logf(dark + to[i]) - middle;
}

// As a place at that height over each texel's middle is seen from `d`: all move as far.
static void shift(float *to, const float *from, const struct volume *v, vec3 d, double z)
{
    const struct bilinear first =
        bilinear_tiled(-z * d.x / d.z, z * d.y / d.z, v->width, v->height);
    const float across = (float)first.across, down = (float)first.down;
    const int left = (int)(first.at[0] % (size_t)v->width),
              top = (int)(first.at[0] / (size_t)v->width);
    for (int y = 0; y < v->height; y++) {
        const float *row = from + index_wrapped(top + y, v->height) * v->width;
        const float *below = from + index_wrapped(top + y + 1, v->height) * v->width;
        for (int x = 0, i = left; x < v->width; x++, i = i + 1 < v->width ? i + 1 : 0) {
            const int j = i + 1 < v->width ? i + 1 : 0;
            *to++ = (row[i] * (1.0f - across) + row[j] * across) * (1.0f - down) +
                    (below[i] * (1.0f - across) + below[j] * across) * down;
        }
    }
}

static float around(const float *row, int x, int width)
{
    float sum = 0.0f;
    for (int k = -2; k <= 2; k++)
        sum += row[index_wrapped(x + k, width)];
    return sum;
}

// Sums over windows, in place: along the rows, then across them.
static void box(float *picture, float *scratch, int width, int height)
{
    for (int y = 0; y < height; y++) {
        const float *row = picture + y * width;
        float *to = scratch + y * width;
        for (int x = 0; x < 2; x++) {
            to[x] = around(row, x, width);
            to[width - 1 - x] = around(row, width - 1 - x, width);
        }
        for (int x = 2; x + 2 < width; x++)
            to[x] = row[x - 2] + row[x - 1] + row[x] + row[x + 1] + row[x + 2];
    }
    for (int y = 0; y < height; y++) {
        const float *row[WINDOW];
        float *to = picture + y * width;
        for (int k = 0; k < WINDOW; k++)
            row[k] = scratch + index_wrapped(y + k - 2, height) * width;
        for (int x = 0; x < width; x++)
            to[x] = row[0][x] + row[1][x] + row[2][x] + row[3][x] + row[4][x];
    }
}

static float correlation(float a, float b, float aa, float bb, float ab)
{
    const float n = WINDOW * WINDOW;
    const float va = aa - a * a / n, vb = bb - b * b / n;
    // windows without texture say nothing
    return va > 1e-4f && vb > 1e-4f ? (ab - a * b / n) / sqrtf(va * vb) : 0.0f;
}

static void add_layer(void *context, size_t layer, int worker)
{
    (void)worker;
    struct volume *v = context;
    const vec3 *view = relume_btf_info(v->btf)->view;
    const double z = height_of(v, (int)layer);
    float *own = mem_array(6 * v->texels, sizeof *own), *map[6];
    for (int i = 0; own && i < 6; i++)
        map[i] = own + (size_t)i * v->texels;
    for (int p = 0; own && p < v->count; p++) {
        for (int i = 0; i < 2; i++)
            shift(map[i], v->logs + (2 * (size_t)p + (size_t)i) * v->texels, v,
                  view[v->pair[p].view[i]], z);
        for (size_t i = 0; i < v->texels; i++) {
            map[2][i] = map[0][i] * map[0][i];
            map[3][i] = map[1][i] * map[1][i];
            map[4][i] = map[0][i] * map[1][i];
        }
        for (int i = 0; i < 5; i++)
            box(map[i], map[5], v->width, v->height);
        float *sum = v->sum + layer * v->texels;
        for (size_t i = 0; i < v->texels; i++)
            sum[i] += correlation(map[0][i], map[1][i], map[2][i], map[3][i], map[4][i]);
    }
    if (!own)
        v->failed = true;
    mem_free(own);
}

static int choose_pairs(struct picture_pair *out, const relume_btf *btf,
                        const struct picture_pair *pairs, int count)
{
    const vec3 *view = relume_btf_info(btf)->view;
    int steep = 0, chosen = 0;
    for (int step = 0; step < 2; step++)
        for (int i = 0, seen = 0; i < count; i++) {
            if (view[pairs[i].view[0]].z < LOWEST || view[pairs[i].view[1]].z < LOWEST)
                continue;
            seen++;
            if (!step)
                steep++;
            else if (steep <= MOST_PAIRS ||
                     seen * MOST_PAIRS / steep != (seen - 1) * MOST_PAIRS / steep)
                out[chosen++] = pairs[i];
        }
    return chosen;
}

// Between layers.
static void read_heights(float *z, const struct volume *v, const int *label)
{
    for (size_t i = 0; i < v->texels; i++) {
        const int at = label[i];
        double off = 0.0;
        if (at > 0 && at < LAYERS - 1) {
            const double left = (double)v->sum[(size_t)(at - 1) * v->texels + i],
                         right = (double)v->sum[(size_t)(at + 1) * v->texels + i];
            const double bend = left + right - 2.0 * (double)v->sum[(size_t)at * v->texels + i];
            off = bend > 1e-9 ? fmin(fmax(0.5 * (left - right) / bend, -0.5), 0.5) : 0.0;
        }
        z[i] = (float)(height_of(v, at) + off * (height_of(v, 1) - height_of(v, 0)));
    }
}

relume_status depth_find(float *z, const relume_btf *btf, const struct picture_pair *pairs,
                         int count, int threads, const struct relume_log *log)
{
    const struct relume_btf_info *info = relume_btf_info(btf);
    struct volume v = {btf, info->width, info->height, btf_texels(btf), NULL, 0, NULL, NULL, false};
    struct picture_pair *chosen = mem_array(MOST_PAIRS + 1, sizeof *chosen);
    int *label = mem_array(v.texels, sizeof *label);
    v.logs = mem_array(2 * BATCH * v.texels, sizeof *v.logs);
    v.sum = mem_zeroed(LAYERS * v.texels, sizeof *v.sum);
    relume_status status = chosen && label && v.logs && v.sum ? RELUME_OK : RELUME_ENOMEM;
    const int used = status ? 0 : choose_pairs(chosen, btf, pairs, count);
    for (int first = 0; first < used && !status; first += BATCH) {
        v.pair = chosen + first;
        v.count = used - first < BATCH ? used - first : BATCH;
        thread_for(threads, 2 * (size_t)v.count, take_logarithms, &v);
        thread_for(threads, LAYERS, add_layer, &v);
        status = v.failed                                                         ? RELUME_ENOMEM
                 : !log_progress(log, "relief", (first + v.count) / (double)used) ? RELUME_ECANCEL
                                                                                  : RELUME_OK;
    }
    for (size_t i = 0; i < LAYERS * v.texels && !status; i++)
        v.sum[i] = fmaxf(1.0f - (used ? v.sum[i] / (float)used : 0.0f), 0.0f);
    if (!status)
        status = cut_volume(label, v.sum, v.width, v.height, LAYERS, SMOOTH);
    if (!status)
        read_heights(z, &v, label);
    mem_free(chosen);
    mem_free(label);
    mem_free(v.logs);
    mem_free(v.sum);
    return status;
}
