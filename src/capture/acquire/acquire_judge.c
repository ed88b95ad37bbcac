// acquire_judge.c - photographs that contradict those under similar lights
//
// Each photograph is predicted from the rest by interpolation over the lights (neighbours.h), which
// follows gloss and shadows as no law of reflection does, and compared in three ways. The light
// that explains it best may be elsewhere: lines of the list are exchanged. In coarse blocks it may
// be brighter or darker: another exposure, a lamp of other power. Some blocks may differ from most:
// a shadow, stray light. Another scene has edges of its own. Thresholds scale with the median
// difference in the same capture, over the deviation that the distances of the lights predict. The
// worst photograph is left out, since it spoils the prediction around it, and all are judged again.
#include "capture/acquire/acquire.h"

#include "capture/acquire/neighbours.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/tree.h"
#include "core/math/sort.h"

#include <relume/capture/align.h>
#include <stdio.h>
#include <string.h>

enum { LEAST_SHOTS = 10, COLUMNS = 10, ROWS = 8, BLOCKS = COLUMNS * ROWS, GRID = 150 };
enum { PIXELS = 3000, MOST_EXCHANGED = 8 };
static const double LEFT = 0.6;  // share of the photographs that are never named
// Share of the differences between photographs that their lights explain: 0.4 and more on sound
// captures of 14 lights, 0 and more of 10; below 0.1 in another order.
static const double EXPLAINED = 0.25, EXPLAINED_FEW = 0.0;
enum { FEW = 14 };
static const double RAKING = 0.3;
static const double GRAZING = 0.12;               // z: lights below show little but relief
static const double EXPOSURE = 0.5, PARTS = 0.7;  // stops
static const double UNUSUAL_EXPOSURE = 3.5, UNUSUAL_PARTS = 4.0;  // times the median
static const double LEAST_DETAIL = 2e-3;  // mean square of the logarithm's differences
// Logarithm of the missing detail: at most 0.4 on sound real captures and 1.1 on a made one, 1.4
// and more after a Gaussian blur of 1.5 pixels.
static const double BLURRED = 0.6, UNUSUAL_BLUR = 6.0;  // ...; times the median
static const double ELSEWHERE = 25.0;                   // degrees
static const double NEIGHBOURS = 2.0;                   // times the angle to the nearest light
static const double BETTER = 0.5;  // of the difference that is left under the light elsewhere
// clearness(): at most 7.5 on sound real captures of 18 lights and more; 10 and more in nine of ten
// exchanged photographs
static const double CLEARLY = 8.0;
static const double EVEN = 0.01;        // variation of an even picture, at most
static const double UNEXPLAINED = 1.2;  // of a photograph's own variation: it is of something else
static const double UNLIKE = 0.5;       // share of the usual similarity
static const float DARK = 0.999f;       // share of the pixels
static const double OTHER = 0.5;        // the same, of one with unlike edges
// similarity to the most similar under the nearest lights: 0.25 and more in sound real photographs
// unless almost black; 0.09 at most of another scene or a turned one, coins apart
static const double FOREIGN = 0.15;
enum { NEAREST = 5 };
static const double FRONTAL = 0.9;  // z: light within 25 degrees of the camera flashes from gloss
// stops in the mean of the blocks: 0.24 and more in a flash, below 0 in a person's shadow
static const double FLASH = 0.1, FLASH_LEFT = 0.3;  // ...; share that no exposure explains

// Predicts what a light shows by all photographs together.
struct lit {
    double *weight;   // [n]
    double *product;  // [n], of the photographs with the prediction
    double square;    // of the prediction
};

struct explanation {
    double left, best;  // under its own light, and under the best one
    double angle;       // between both, degrees
    double apart;       // from its own light to the nearest one, degrees
    int nearest;        // of the photographs, to the best one
};

struct judge {
    struct acquisition *s;
    int n;                   // photographs that are not left out
    int *shot;               // [n]
    vec3 *direction;         // [n]
    float (*block)[BLOCKS];  // [n], root of the light
    double *gram;            // [all][all]: products of photographs, pixel by pixel
    double *sum;             // [all] of the pixels
    int all;
    size_t pixels;
    struct neighbours set;
    double *weight;      // [n]
    struct lit *lit;     // [GRID + n]: lights that may explain a photograph
    double *lit_values;  // of these
    double *exposure, *parts, *brighter, *sd, *sorted;  // [n]
    struct explanation *explanation;                    // [n]
};

// ---------------------------------------------------------------- values

static float tone(const struct shot *shot, const float *p, bool scaled)
{
    float sum = 0.0f;
    for (int c = 0; c < 3; c++)
        sum += p[c] / (scaled ? fmaxf(shot->intensity[c], 1e-6f) : 1.0f);
    return sqrtf(fmaxf(sum / 3.0f, 0.0f));
}

static void fill_blocks(const struct shot *shot, float *block, bool scaled)
{
    const struct relume_image *m = &shot->small;
    int count[BLOCKS] = {0};
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width; x++) {
            const int at = y * ROWS / m->height * COLUMNS + x * COLUMNS / m->width;
            block[at] +=
                tone(shot, m->data + 3 * ((size_t)y * (size_t)m->width + (size_t)x), scaled);
            count[at]++;
        }
    for (int k = 0; k < BLOCKS; k++)
        block[k] /= (float)(count[k] > 0 ? count[k] : 1);
}

static relume_status fill_gram(struct judge *j)
{
    const struct acquisition *s = j->s;
    const struct relume_image *first = &s->shot[0].small;
    const size_t most = (size_t)first->width * (size_t)first->height, step = most / PIXELS + 1;
    float *value = mem_array((size_t)j->all, (most / step + 1) * sizeof *value);
    if (!value)
        return RELUME_ENOMEM;
    j->pixels = (most + step - 1) / step;
    for (int i = 0; i < j->all; i++)
        for (size_t k = 0; k < j->pixels; k++) {
            const float v =
                tone(&s->shot[i], s->shot[i].small.data + 3 * k * step, s->has_intensities);
            value[(size_t)i * j->pixels + k] = v;
            j->sum[i] += (double)v;
        }
    for (int i = 0; i < j->all; i++)
        for (int k = 0; k <= i; k++) {
            const float *a = value + (size_t)i * j->pixels, *b = value + (size_t)k * j->pixels;
            double sum = 0.0;
            for (size_t p = 0; p < j->pixels; p++)
                sum += (double)(a[p] * b[p]);
            j->gram[i * j->all + k] = j->gram[k * j->all + i] = sum;
        }
    mem_free(value);
    return RELUME_OK;
}

static vec3 direction_of(const struct acquisition *s, int i)
{
    return vec3_unit(s->p.near ? s->shot[i].position : s->shot[i].direction);
}

static relume_status create(struct judge *j)
{
    struct acquisition *s = j->s;
    const size_t n = (size_t)s->shots;
    j->all = s->shots;
    j->shot = mem_array(n, sizeof *j->shot);
    j->direction = mem_array(n, sizeof *j->direction);
    j->block = mem_zeroed(n, sizeof *j->block);
    j->gram = mem_array(n * n, sizeof *j->gram);
    j->sum = mem_zeroed(n, sizeof *j->sum);
    j->weight = mem_array(n, sizeof *j->weight);
    j->lit = mem_array(GRID + n, sizeof *j->lit);
    j->lit_values = mem_array((GRID + n) * n, 2 * sizeof *j->lit_values);
    j->exposure = mem_array(n, sizeof *j->exposure);
    j->parts = mem_array(n, sizeof *j->parts);
    j->brighter = mem_array(n, sizeof *j->brighter);
    j->sd = mem_array(n, sizeof *j->sd);
    j->sorted = mem_array(n, sizeof *j->sorted);
    j->explanation = mem_array(n, sizeof *j->explanation);
    if (!j->shot || !j->direction || !j->block || !j->gram || !j->sum || !j->weight || !j->lit ||
        !j->lit_values || !j->exposure || !j->parts || !j->brighter || !j->sd || !j->sorted ||
        !j->explanation)
        return RELUME_ENOMEM;
    for (int i = 0; i < s->shots; i++) {
        const vec3 d = direction_of(s, i);
        // light from behind shows rims, which change from light to light; a ball has named strays
        if (d.z < 0.0 || s->shot[i].stray)
            continue;
        j->shot[j->n] = i;
        j->direction[j->n] = d;
        fill_blocks(&s->shot[i], j->block[j->n++], s->has_intensities);
    }
    if (j->n < LEAST_SHOTS)
        return RELUME_EUNFIT;
    const relume_status status = fill_gram(j);
    return status ? status : neighbours_create(&j->set, j->direction, j->n);
}

static void destroy(struct judge *j)
{
    neighbours_destroy(&j->set);
    mem_free(j->shot);
    mem_free(j->direction);
    mem_free(j->block);
    mem_free(j->gram);
    mem_free(j->sum);
    mem_free(j->weight);
    mem_free(j->lit);
    mem_free(j->lit_values);
    mem_free(j->exposure);
    mem_free(j->parts);
    mem_free(j->brighter);
    mem_free(j->sd);
    mem_free(j->sorted);
    mem_free(j->explanation);
}

static relume_status leave_out(struct judge *j, int k)
{
    const size_t after = (size_t)(j->n - k - 1);
    memmove(j->shot + k, j->shot + k + 1, after * sizeof *j->shot);
    memmove(j->direction + k, j->direction + k + 1, after * sizeof *j->direction);
    memmove(j->block + k, j->block + k + 1, after * sizeof *j->block);
    j->n--;
    neighbours_destroy(&j->set);
    return neighbours_create(&j->set, j->direction, j->n);
}

static double median(struct judge *j, const double *v)
{
    memcpy(j->sorted, v, (size_t)j->n * sizeof *v);
    sort_doubles(j->sorted, (size_t)j->n);
    return j->sorted[j->n / 2];
}

// Brightness and shadows change faster, the lower a light stands: a factor of what may be missed.
static double leeway(const struct judge *j, int i)
{
    return (1.0 + RAKING / fmax(j->direction[i].z, 0.1)) / (1.0 + RAKING);
}

// ---------------------------------------------------------------- pixel by pixel

static double product(const struct judge *j, int a, int b)
{
    return j->gram[j->shot[a] * j->all + j->shot[b]];
}

// Products of photograph `i` and of itself with what the weights predict.
static void predict(const struct judge *j, int i, double *with, double *itself)
{
    *with = *itself = 0.0;
    for (int a = 0; a < j->n; a++) {
        double sum = 0.0;
        for (int b = 0; b < j->n; b++)
            sum += j->weight[b] * product(j, a, b);
        *itself += j->weight[a] * sum;
        *with += j->weight[a] * product(j, i, a);
    }
}

static double variation(const struct judge *j, int i)
{
    const double sum = j->sum[j->shot[i]];
    return product(j, i, i) - sum * sum / (double)j->pixels;
}

// Share of the differences of photographs from their mean that their lights predict; the tenth of
// them that is predicted worst does not count.
static double explain(struct judge *j)
{
    double mean_square = 0.0, missed = 0.0, all = 0.0;
    double *miss = j->exposure, *own = j->parts;  // not needed yet
    for (int a = 0; a < j->n; a++)
        for (int b = 0; b < j->n; b++)
            mean_square += product(j, a, b) / ((double)j->n * j->n);
    for (int i = 0; i < j->n; i++) {
        double with, itself, to_mean = 0.0;
        neighbours_weights(&j->set, i, j->direction[i], j->weight);
        predict(j, i, &with, &itself);
        for (int k = 0; k < j->n; k++)
            to_mean += product(j, i, k) / j->n;
        miss[i] = product(j, i, i) - 2.0 * with + itself;
        own[i] = product(j, i, i) - 2.0 * to_mean + mean_square;
    }
    memcpy(j->sorted, miss, (size_t)j->n * sizeof *miss);
    sort_doubles(j->sorted, (size_t)j->n);
    const double most = j->sorted[j->n - 1 - j->n / 10];
    for (int i = 0; i < j->n; i++) {
        missed += miss[i] <= most ? miss[i] : 0.0;
        all += miss[i] <= most ? own[i] : 0.0;
    }
    return 1.0 - missed / fmax(all, 1e-12);
}

// Returns the share of a photograph that light `d` leaves unexplained at the best exposure.
static double left_under(const struct judge *j, int i, vec3 d)
{
    double with, itself;
    neighbours_weights(&j->set, i, d, j->weight);
    predict(j, i, &with, &itself);
    return (product(j, i, i) - fmax(with, 0.0) * with / fmax(itself, 1e-12)) /
           fmax(variation(j, i), 1e-12 + EVEN * product(j, i, i));
}

static vec3 grid_direction(int k)
{
    const double z = 0.1 + 0.9 * (k + 0.5) / GRID, r = sqrt(1.0 - z * z);
    const double phi = k * (M_PI * (3.0 - sqrt(5.0)));
    return vec3_of(r * cos(phi), r * sin(phi), z);
}

static vec3 lit_direction(const struct judge *j, int k)
{
    return k < GRID ? grid_direction(k) : j->direction[k - GRID];
}

static void light_all(struct judge *j)
{
    const size_t n = (size_t)j->n;
    for (int k = 0; k < GRID + j->n; k++) {
        struct lit *lit = &j->lit[k];
        lit->weight = j->lit_values + 2 * n * (size_t)k;
        lit->product = lit->weight + n;
        lit->square = 0.0;
        neighbours_all_weights(&j->set, lit_direction(j, k), lit->weight);
        for (int a = 0; a < j->n; a++) {
            double sum = 0.0;
            for (int b = 0; b < j->n; b++)
                sum += lit->weight[b] * product(j, a, b);
            lit->product[a] = sum;
            lit->square += lit->weight[a] * sum;
        }
    }
}

// left[GRID + n]: what left_under() returns for each of the lights.
static void leave_under_all(const struct judge *j, int i, double *left)
{
    const double *q = neighbours_row(&j->set, i);
    double own = 0.0, square = 0.0;  // products of row q with photograph i and with itself
    for (int a = 0; a < j->n; a++) {
        double sum = 0.0;
        for (int b = 0; b < j->n; b++)
            sum += q[b] * product(j, a, b);
        own += a == i ? sum : 0.0;
        square += q[a] * sum;
    }
    const double most = fmax(variation(j, i), 1e-12 + EVEN * product(j, i, i));
    for (int k = 0; k < GRID + j->n; k++) {
        const struct lit *lit = &j->lit[k];
        const double part = lit->weight[i] / q[i];
        double cross = 0.0;
        for (int a = 0; a < j->n; a++)
            cross += q[a] * lit->product[a];
        const double with = lit->product[i] - part * own;
        const double itself = lit->square - 2.0 * part * cross + part * part * square;
        left[k] = (product(j, i, i) - fmax(with, 0.0) * with / fmax(itself, 1e-12)) / most;
    }
}

static struct explanation search(const struct judge *j, int i, double *left)
{
    struct explanation e = {.nearest = -1};
    vec3 at = j->direction[i];
    leave_under_all(j, i, left);
    e.left = e.best = left[GRID + i];
    for (int k = 0; k < GRID + j->n; k++)
        if (k != GRID + i && left[k] < e.best) {
            e.best = left[k];
            at = lit_direction(j, k);
        }
    e.angle = vec3_angle(at, j->direction[i]) * 180.0 / M_PI;
    e.apart = 180.0;
    double least = INFINITY;
    for (int k = 0; k < j->n; k++) {
        if (k != i)
            e.apart = fmin(e.apart, vec3_angle(j->direction[k], j->direction[i]) * 180.0 / M_PI);
        const double angle = vec3_angle(at, j->direction[k]);
        if (k != i && angle < least) {
            least = angle;
            e.nearest = k;
        }
    }
    return e;
}

static relume_status name_elsewhere(struct judge *j, int i, const struct explanation *e)
{
    struct acquisition *s = j->s;
    s->shot[j->shot[i]].misfit = true;
    return acquire_warn_alike(
        s, ALIKE_MISFIT, e->left,
        "%s does not fit its light: it looks as under a light %.0f degrees elsewhere, near that of "
        "%s; lights exchanged, or turned?",
        s->shot[j->shot[i]].path, e->angle, path_name(s->shot[j->shot[e->nearest]].path));
}

// Returns how clearly another light explains a photograph. The difference under its own light is
// divided by the usual difference of such lights, and by the share that the other light leaves.
static double clearness(const struct judge *j, int i, double usual)
{
    const struct explanation *e = &j->explanation[i];
    return j->parts[i] / usual * e->left / fmax(e->best, 1e-12);
}

// Returns the photograph that another light explains far better than its own, the clearest of them,
// or -1.
static int find_exchanged(struct judge *j, double *left)
{
    int found = -1;
    double clearest = 1.0 / BETTER;
    light_all(j);
    for (int i = 0; i < j->n; i++) {
        const double sd = neighbours_weights(&j->set, i, j->direction[i], j->weight) * leeway(j, i);
        j->explanation[i] = search(j, i, left);
        j->parts[i] = j->explanation[i].left / (sd * sd);
    }
    const double usual = fmax(median(j, j->parts), 1e-12);
    for (int i = 0; i < j->n; i++) {
        const struct explanation *e = &j->explanation[i];
        const double times = e->left / fmax(e->best, 1e-12);
        if (j->direction[i].z > GRAZING && times > clearest &&
            e->angle > fmax(ELSEWHERE, NEIGHBOURS * e->apart) && clearness(j, i, usual) > CLEARLY) {
            clearest = times;
            found = i;
        }
    }
    return found;
}

// The photographs that another light explains far better, the clearest first.
static relume_status find_elsewhere(struct judge *j)
{
    double *left = mem_array(GRID + (size_t)j->n, sizeof *left);
    relume_status status = left ? RELUME_OK : RELUME_ENOMEM;
    for (int named = 0; !status && named < MOST_EXCHANGED && j->n > LEFT * j->all; named++) {
        const int i = find_exchanged(j, left);
        if (i < 0)
            break;
        status = name_elsewhere(j, i, &j->explanation[i]);
        if (!status)
            status = leave_out(j, i);
    }
    mem_free(left);
    return status;
}

// ---------------------------------------------------------------- in blocks

static double faintest(struct judge *j)
{
    double sum = 0.0;
    for (int i = 0; i < j->n; i++)
        for (int k = 0; k < BLOCKS; k++)
            sum += (double)j->block[i][k] / ((double)j->n * BLOCKS);
    return 0.1 * sum + 1e-4;
}

// Stops by which a photograph is brighter than predicted, in the median block and in the mean, and
// by which the fifth of the blocks that differ most differ from the median.
static void compare_blocks(struct judge *j, int i, double faint)
{
    double stops[BLOCKS], sorted[BLOCKS];
    j->brighter[i] = 0.0;
    j->sd[i] = neighbours_weights(&j->set, i, j->direction[i], j->weight);
    for (int k = 0; k < BLOCKS; k++) {
        double sum = 0.0;
        for (int a = 0; a < j->n; a++)
            sum += j->weight[a] * (double)j->block[a][k];
        stops[k] = sorted[k] =
            2.0 * log2(((double)j->block[i][k] + faint) / (fmax(sum, 0.0) + faint));
    }
    for (int k = 0; k < BLOCKS; k++)
        j->brighter[i] += stops[k] / BLOCKS;
    sort_doubles(sorted, BLOCKS);
    j->exposure[i] = sorted[BLOCKS / 2];
    for (int k = 0; k < BLOCKS; k++)
        sorted[k] = fabs(stops[k] - j->exposure[i]);
    sort_doubles(sorted, BLOCKS);
    j->parts[i] = sorted[BLOCKS * 4 / 5];
}

// Returns the stops of exposure relative to the expected ones. The median of blocks is smooth over
// the lights: it is missed by far less where they are near, so that the square of `sd` is expected.
static double unusual_exposure(const struct judge *j, int i)
{
    return fabs(j->exposure[i]) / (j->sd[i] * j->sd[i] * leeway(j, i));
}

static double unusual_parts(const struct judge *j, int i)
{
    return j->parts[i] / (j->sd[i] * leeway(j, i));
}

// Returns whether gloss flashes under light near the camera, in this photograph only: it adds
// light, in patterns that no exposure of the predicted ones has.
static bool flashes(const struct judge *j, int i)
{
    return j->direction[i].z > FRONTAL && j->brighter[i] > FLASH &&
           left_under(j, i, j->direction[i]) > FLASH_LEFT;
}

// Returns the photograph that differs most, in units of its threshold; -1 where all are below 1.
static int find_worst(struct judge *j, double *how_bad, bool *exposure)
{
    double usual[2];
    const double faint = faintest(j);
    int worst = -1;
    *how_bad = 1.0;
    for (int i = 0; i < j->n; i++)
        compare_blocks(j, i, faint);
    double *scaled = j->weight;  // not needed any more
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < j->n; i++)
            scaled[i] = k ? unusual_parts(j, i) : unusual_exposure(j, i);
        usual[k] = median(j, scaled) + 1e-6;
    }
    for (int i = 0; i < j->n; i++) {
        if (j->direction[i].z < GRAZING)
            continue;
        const double bad[2] = {fmin(fabs(j->exposure[i]) / EXPOSURE / sqrt(leeway(j, i)),
                                    unusual_exposure(j, i) / usual[0] / UNUSUAL_EXPOSURE),
                               fmin(j->parts[i] / PARTS / sqrt(leeway(j, i)),
                                    unusual_parts(j, i) / usual[1] / UNUSUAL_PARTS)};
        for (int k = 0; k < 2; k++)
            if (bad[k] > *how_bad && !(k == 0 && j->s->p.refine_brightness)) {
                *how_bad = bad[k];
                *exposure = k == 0;
                worst = i;
            }
    }
    return worst;
}

static relume_status find_uneven(struct judge *j)
{
    struct acquisition *s = j->s;
    relume_status status = RELUME_OK;
    while (!status && j->n > LEFT * j->all) {
        double how_bad;
        bool exposure = false;
        const int i = find_worst(j, &how_bad, &exposure);
        if (i < 0)
            break;
        struct shot *shot = &s->shot[j->shot[i]];
        const bool sound = flashes(j, i);
        shot->misfit = !sound;
        if (!sound && shot->black <= DARK)  // that has been said
            status =
                exposure
                    ? acquire_warn_alike(
                          s, ALIKE_EXPOSURE, how_bad,
                          "%s does not fit its light: %.1f stops %s than those under similar "
                          "lights; another exposure, or a lamp of other power "
                          "(--refine-brightness)?",
                          shot->path, fabs(j->exposure[i]),
                          j->exposure[i] > 0 ? "brighter" : "darker")
                    : acquire_warn_alike(
                          s, ALIKE_PARTS, how_bad,
                          "%s does not fit its light: parts of it differ by %.1f stops from those "
                          "under similar lights; a shadow, stray light, or something that moved?",
                          shot->path, j->parts[i]);
        if (!status)
            status = leave_out(j, i);
    }
    return status;
}

// Returns whether a photograph's edges are unlike all those under the NEAREST lights, or missing.
static bool is_foreign(struct judge *j, int i)
{
    const struct acquisition *s = j->s;
    double *angle = j->exposure;  // not needed yet, or any more
    for (int k = 0; k < j->n; k++)
        angle[k] = k == i ? INFINITY : vec3_angle(j->direction[k], j->direction[i]);
    memcpy(j->sorted, angle, (size_t)j->n * sizeof *angle);
    sort_doubles(j->sorted, (size_t)j->n);
    const double within = j->sorted[NEAREST - 1];
    for (int k = 0; k < j->n; k++)
        if (angle[k] <= within && relume_edge_correlation(&s->shot[j->shot[i]].small,
                                                          &s->shot[j->shot[k]].small) > FOREIGN)
            return false;
    return true;
}

// Returns whether gloss, low light or far neighbours explain a photograph that seems to be of
// another scene. `unlike`: its edges differ from most.
static bool is_excused(struct judge *j, int i, bool unlike)
{
    if (!unlike || j->direction[i].z < GRAZING)
        return !is_foreign(j, i);
    compare_blocks(j, i, faintest(j));
    return flashes(j, i);
}

// Names photographs of another scene, or turned ones. `unlike` takes only photographs whose edges
// are unlike most photographs' as well.
static relume_status find_strange(struct judge *j, double usual_similarity, bool unlike)
{
    struct acquisition *s = j->s;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < j->n && j->n > LEFT * j->all;) {
        struct shot *shot = &s->shot[j->shot[i]];
        const double left = left_under(j, i, j->direction[i]);
        const double most = unlike ? OTHER * leeway(j, i) : UNEXPLAINED;
        const bool may_be = left > most && shot->black <= DARK;
        if (may_be && unlike)
            shot->similarity = acquire_similarity(s, j->shot[i]);
        if (!may_be || (unlike && !((double)shot->similarity < UNLIKE * usual_similarity)) ||
            is_excused(j, i, unlike)) {
            i++;
            continue;
        }
        shot->misfit = shot->strange = true;
        if (!s->p.skip_bad)
            status = acquire_warn_alike(s, ALIKE_SCENE, left,
                                        "%s: seems to show another scene, or the scene turned or "
                                        "moved: those under similar lights do not predict it",
                                        shot->path);
        if (!status)
            status = leave_out(j, i);
    }
    return status;
}

// ---------------------------------------------------------------- sharpness

// Fine detail over coarse, as a logarithm; 0 where there is too little to say.
static double detail_of(const struct shot *shot)
{
    return shot->coarse > LEAST_DETAIL && shot->fine > 0.0 ? log(shot->fine / shot->coarse) : 0.0;
}

// Raking light lengthens shadows, which are coarse: sharpness is predicted as well.
static relume_status find_blurred(struct judge *j)
{
    struct acquisition *s = j->s;
    double *miss = j->exposure, *size = j->parts;  // not needed any more
    relume_status status = RELUME_OK;
    for (int i = 0; i < j->n; i++) {
        double sum = 0.0, all = 0.0;
        neighbours_weights(&j->set, i, j->direction[i], j->weight);
        for (int k = 0; k < j->n; k++) {
            const double d = detail_of(&s->shot[j->shot[k]]);
            sum += j->weight[k] * d;
            all += d != 0.0 ? j->weight[k] : 0.0;
        }
        const double own = detail_of(&s->shot[j->shot[i]]);
        miss[i] = own != 0.0 && all > 0.5 ? (own - sum / all) / leeway(j, i) : 0.0;
        size[i] = fabs(miss[i]);
        s->shot[j->shot[i]].sharpness = own != 0.0 ? (float)exp(miss[i]) : (float)NAN;
    }
    const double most = fmax(BLURRED, UNUSUAL_BLUR * median(j, size));
    for (int i = 0; !status && i < j->n; i++)
        if (miss[i] < -most)
            status =
                acquire_warn_alike(s, ALIKE_BLURRED, -miss[i],
                                   "%s: less sharp than the others: %.0f %% of the fine detail "
                                   "under similar lights; focus moved, or the camera shook?",
                                   s->shot[j->shot[i]].path, 100.0 * exp(miss[i]));
    return status;
}

// ---------------------------------------------------------------- one after another

static double usual_similarity(struct judge *j)
{
    int known = 0;
    for (int i = 0; i < j->all; i += ACQUIRE_SIMILAR) {
        const float like = acquire_similarity(j->s, i);
        if (isfinite(like))
            j->sorted[known++] = (double)like;
    }
    sort_doubles(j->sorted, (size_t)known);
    return known ? j->sorted[known / 2] : 0.0;
}

static relume_status doubt_list(struct judge *j, double explained)
{
    struct acquisition *s = j->s;
    return acquire_warn(s,
                        "the photographs do not fit the lights: those under similar lights do not "
                        "look alike (%.0f %% of their differences are explained; right lists reach "
                        "50 to 99 %%); wrong order%s%s?",
                        100.0 * fmax(explained, 0.0), s->p.lights ? " of " : ", or a wrong ball",
                        s->p.lights ? path_name(s->p.lights) : "");
}

static relume_status judge_all(struct judge *j)
{
    const double usual = usual_similarity(j);
    relume_status status = find_strange(j, usual, true);
    const double explained = status ? 1.0 : explain(j);
    if (explained < (j->n < FEW ? EXPLAINED_FEW : EXPLAINED))
        return doubt_list(j, explained);
    if (!status)
        status = find_elsewhere(j);
    if (!status)
        status = find_uneven(j);
    if (!status)
        status = find_strange(j, usual, false);
    return status ? status : find_blurred(j);
}

static relume_status drop_strange(struct acquisition *s)
{
    relume_status status = RELUME_OK;
    for (int i = s->shots - 1; !status && i >= 0; i--)
        if (s->shot[i].strange && s->p.skip_bad)
            status = acquire_drop(s, i, true, "shows another scene");
    return status;
}

bool acquire_can_judge(const struct acquisition *s)
{
    return s->shots >= LEAST_SHOTS;
}

relume_status acquire_judge(struct acquisition *s)
{
    struct judge j = {.s = s};
    if (!acquire_can_judge(s))
        return RELUME_OK;
    relume_status status = create(&j);
    if (!status)
        status = judge_all(&j);
    s->judged = status == RELUME_OK;
    destroy(&j);
    if (status == RELUME_EUNFIT)
        return acquire_name_scenes(s);
    return status ? status : drop_strange(s);
}
