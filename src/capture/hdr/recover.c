// recover.c - the camera's response from an exposure bracket (Debevec, Malik 1997)
//
// Eq. 3 asks for the curve g = ln f and radiances E_i that minimise
//     sum_ij w(z_ij)^2 (g(z_ij) - ln E_i - ln t_j)^2 + lambda^2 sum_z w(z)^2 g''(z)^2,  g(128) = 0.
// Every ln E_i stands in its own samples alone and is eliminated, so that the system has the 256
// unknowns of g however many samples there are.
#include <relume/image/response.h>

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/lsq.h"

#include <math.h>
#include <string.h>

enum { N = RELUME_CODES, MIDDLE = N / 2, LEAST_CODES = 16, CANDIDATES = 1 << 16 };
static const int default_samples = 400;
static const double default_smoothness = 20.0;
static const double rows_of_paper = 550.0;  // smoothness is stated for 50 samples x 11 exposures
static const double same_exposure = 1.01;
// This far below middle grey 8 bits hold nothing: what codes are there are the black level's.
static const double nothing_ev = -12.0;
enum { LEAST_BLACK = 16 };
static const float even_range = 0.25f;  // of the code range: neighbours whose mean is a code

static int code_of(float v)
{
    return v >= 1.0f ? N - 1 : v > 0.0f ? (int)(v * (N - 1) + 0.5f) : 0;
}

// ---------------------------------------------------------------- samples

struct place {
    size_t pixel;
    float uneven;
};

struct search {
    const struct relume_image *codes, *masks;
    int n;
};

static bool has_masks(const struct search *s)
{
    for (int j = 0; s->masks && j < s->n; j++)
        if (s->masks[j].data)
            return true;
    return false;
}

static bool is_masked(const struct search *s, size_t pixel)
{
    for (int j = 0; s->masks && j < s->n; j++)
        if (s->masks[j].data && !(s->masks[j].data[pixel] > 0.0f))
            return true;
    return false;
}

// Differences to the four neighbours, summed over exposures.
static float unevenness(const struct search *s, int x, int y)
{
    const size_t stride = 3 * (size_t)s->codes->width;
    float sum = 0.0f;
    for (int j = 0; j < s->n; j++) {
        const float *p = s->codes[j].data + (size_t)y * stride + 3 * (size_t)x;
        for (int c = 0; c < 3; c++)
            sum += fabsf(p[c] - p[c - 3]) + fabsf(p[c] - p[c + 3]) +
                   fabsf(p[c] - p[c - (ptrdiff_t)stride]) + fabsf(p[(size_t)c + stride] - p[c]);
    }
    return sum;
}

// Grows with radiance, whatever the response.
static double brightness(const struct search *s, size_t pixel)
{
    double sum = 0.0;
    for (int j = 0; j < s->n; j++)
        for (size_t c = 0; c < 3; c++)
            sum += (double)s->codes[j].data[3 * pixel + c];
    return sum / (3.0 * s->n);
}

// The most even pixel of every step of brightness; steps where nothing is stay at SIZE_MAX.
static void choose_places(const struct search *s, struct place *place, int samples)
{
    const int width = s->codes->width, height = s->codes->height;
    const double pixels = (double)width * height;
    const int step = (int)ceil(sqrt(fmax(pixels / CANDIDATES, 1.0)));
    for (int i = 0; i < samples; i++)
        place[i] = (struct place){SIZE_MAX, INFINITY};
    for (int y = 1 + step / 2; y < height - 1; y += step)
        for (int x = 1 + step / 2; x < width - 1; x += step) {
            const size_t pixel = (size_t)y * (size_t)width + (size_t)x;
            const double b = brightness(s, pixel);
            struct place *p = &place[b >= 1.0 ? samples - 1 : b > 0.0 ? (int)(b * samples) : 0];
            const float uneven = unevenness(s, x, y);
            if (uneven < p->uneven && !is_masked(s, pixel))
                *p = (struct place){pixel, uneven};
        }
}

// ---------------------------------------------------------------- the system

// What one channel of the bracket is solved for.
struct channel {
    const struct search *s;
    const struct place *place;
    int c, samples;
    const double *log_time;
    int *z;     // [n], scratch
    int black;  // codes up to this one say nothing; -1: all do
};

// Eq. 4, scaled to 1 at the top.
static double hat(const struct channel *ch, int z)
{
    if (z <= ch->black)
        return 0.0;
    return (z < MIDDLE ? z : N - 1 - z) / (double)(MIDDLE - 1);
}

// The mean of 3 x 3 pixels, and how far these lie apart.
static float mean_around(const struct relume_image *codes, size_t pixel, int c, float *range)
{
    const ptrdiff_t stride = codes->width;
    float sum = 0.0f, least = INFINITY, most = -INFINITY;
    for (ptrdiff_t y = -1; y <= 1; y++)
        for (ptrdiff_t x = -1; x <= 1; x++) {
            const float v = codes->data[3 * ((ptrdiff_t)pixel + y * stride + x) + c];
            sum += v;
            least = fminf(least, v);
            most = fmaxf(most, v);
        }
    *range = most - least;
    return sum / 9.0f;
}

// Whether the pixels around a place differ by noise alone in all exposures: the mean of codes that
// differ by more is not the code of the mean, least of all where some are saturated.
static bool is_even(const struct channel *ch, size_t pixel)
{
    bool even = true;
    for (int j = 0; even && j < ch->s->n; j++) {
        float range;
        mean_around(&ch->s->codes[j], pixel, ch->c, &range);
        even = range <= even_range;
    }
    return even;
}

// The codes of place `i`. Smooth: even places lose two thirds of their noise, of which the curve,
// whose unknowns are chosen by the codes, would keep a part however many places there are. Not
// where things move: neighbours are not to be trusted, and places may be few.
static bool read_codes(const struct channel *ch, int i, bool smooth)
{
    const size_t pixel = ch->place[i].pixel;
    float range;
    if (pixel == SIZE_MAX)
        return false;
    smooth = smooth && is_even(ch, pixel);
    for (int j = 0; j < ch->s->n; j++) {
        const struct relume_image *codes = &ch->s->codes[j];
        ch->z[j] = code_of(smooth ? mean_around(codes, pixel, ch->c, &range)
                                  : codes->data[3 * pixel + (size_t)ch->c]);
    }
    return true;
}

struct equations {
    double *matrix, *right;  // [N][N], [N]
    double rows;
    bool has[N];  // code values that count
};

// One sample: the rows of its exposures without ln E.
static void add_sample(struct equations *e, const struct channel *ch)
{
    const int *z = ch->z, n = ch->s->n;
    double total = 0.0, mean = 0.0;
    int used = 0;
    for (int j = 0; j < n; j++) {
        const double w = hat(ch, z[j]) * hat(ch, z[j]);
        total += w;
        mean += w * ch->log_time[j];
        used += w > 0.0;
    }
    if (used < 2)
        return;
    mean /= total;
    e->rows += used;
    for (int j = 0; j < n; j++) {
        const double w = hat(ch, z[j]) * hat(ch, z[j]);
        double *row = e->matrix + (size_t)z[j] * N;
        row[z[j]] += w;
        for (int k = 0; k < n; k++)
            row[z[k]] -= w * hat(ch, z[k]) * hat(ch, z[k]) / total;
        e->right[z[j]] += w * (ch->log_time[j] - mean);
        e->has[z[j]] |= w > 0.0;
    }
}

static void add_smoothness(struct equations *e, const struct channel *ch, double smoothness)
{
    static const double second[3] = {1.0, -2.0, 1.0};
    for (int z = 1; z < N - 1; z++) {
        // The ends weigh nothing in Eq. 3; a little keeps the curve straight there.
        const double w = smoothness * fmax(hat(ch, z), 0.05);
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                e->matrix[(size_t)(z - 1 + a) * N + (size_t)(z - 1 + b)] +=
                    w * w * second[a] * second[b];
    }
    e->matrix[(size_t)MIDDLE * N + MIDDLE] += fmax(e->rows, 1.0);
}

// The nearest curve that never falls (pool adjacent violators).
static void make_monotone(double *g)
{
    double level[N];
    int count[N], pools = 0;
    for (int z = 0; z < N; z++) {
        level[pools] = g[z];
        count[pools++] = 1;
        for (; pools > 1 && level[pools - 2] > level[pools - 1]; pools--) {
            const int a = count[pools - 2], b = count[pools - 1];
            level[pools - 2] = (a * level[pools - 2] + b * level[pools - 1]) / (a + b);
            count[pools - 2] = a + b;
        }
    }
    for (int i = 0, z = 0; i < pools; i++)
        for (int k = 0; k < count[i]; k++)
            g[z++] = level[i];
}

static relume_status solve(double *g, const struct channel *ch, double smoothness,
                           const struct relume_log *log)
{
    static const char *const names[] = {"red", "green", "blue"};
    struct equations e = {.matrix = mem_zeroed((size_t)N * N, sizeof(double)), .right = g};
    const bool smooth = !has_masks(ch->s);
    int seen = 0;
    if (!e.matrix)
        return RELUME_ENOMEM;
    memset(g, 0, N * sizeof *g);
    for (int i = 0; i < ch->samples; i++)
        if (read_codes(ch, i, smooth))
            add_sample(&e, ch);
    for (int z = 0; z < N; z++)
        seen += e.has[z];
    relume_status status = RELUME_OK;
    if (seen < LEAST_CODES)
        status = log_fail(log, RELUME_EUNFIT,
                          "the %s channel shows %d code values in two exposures at once; expected "
                          "%d or more: is all saturated, or are the exposures too far apart?",
                          names[ch->c], seen, LEAST_CODES);
    if (!status) {
        add_smoothness(&e, ch, smoothness * sqrt(e.rows / rows_of_paper));
        if (!lsq_solve(e.matrix, N, g, 1))
            status = log_fail(log, RELUME_EUNFIT,
                              "the %s response is not determined; expected "
                              "exposures that overlap",
                              names[ch->c]);
    }
    mem_free(e.matrix);
    return status;
}

// ln E of the sample in ch->z, NAN where no exposure resolves it well.
static double log_radiance(const double *g, const struct channel *ch)
{
    double total = 0.0, sum = 0.0;
    for (int j = 0; j < ch->s->n; j++) {
        const double w = ch->z[j] > N / 4 ? hat(ch, ch->z[j]) : 0.0;
        total += w;
        sum += w * (g[ch->z[j]] - ch->log_time[j]);
    }
    return total > 0.0 ? sum / total : (double)NAN;
}

static int median(const int count[N])
{
    int total = 0, sum = 0, z = 0;
    for (int i = 0; i < N; i++)
        total += count[i];
    for (sum = count[0]; 2 * sum < total; sum += count[z])
        z++;
    return z;
}

// Scanned film and some cameras lift black: the highest code that says nothing, noise included; -1
// when black is 0.
static int find_black(const double *g, const struct channel *ch)
{
    int count[N] = {0}, distance[N] = {0}, seen = 0;
    for (int i = 0; i < ch->samples; i++) {
        const double radiance = read_codes(ch, i, false) ? log_radiance(g, ch) : (double)NAN;
        for (int j = 0; j < ch->s->n; j++)
            if (radiance + ch->log_time[j] < g[MIDDLE] + nothing_ev * log(2.0)) {
                count[ch->z[j]]++;
                seen++;
            }
    }
    const int black = median(count);
    for (int z = 0; z < N; z++)
        distance[abs(z - black)] += count[z];
    if (seen < LEAST_BLACK || black < 2 || black > N / 4)
        return -1;
    return black + (int)ceil(3.0 * 1.4826 * median(distance));
}

static relume_status solve_channel(struct relume_response *out, struct channel *ch,
                                   double smoothness, const struct relume_log *log)
{
    double g[N];
    relume_status status = solve(g, ch, smoothness, log);
    if (!status)
        ch->black = find_black(g, ch);
    if (!status && ch->black >= 0)
        status = solve(g, ch, smoothness, log);
    if (status)
        return status;
    make_monotone(g);
    for (int i = 0; i < N; i++)
        out->exposure[ch->c][i] = i <= ch->black ? 0.0f : (float)exp(g[i] - g[MIDDLE]);
    return RELUME_OK;
}

// Codes of 1/2 are grey; the green of full code is 1.
static void normalise(struct relume_response *out)
{
    const float gain = 1.0f / out->exposure[1][N - 1];
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < N; i++)
            out->exposure[c][i] *= gain;
}

static relume_status check(const struct relume_image *codes, const double *exposures, int n,
                           const struct relume_log *log)
{
    if (n < 1)
        return RELUME_EINVAL;
    double low = INFINITY, high = 0.0;
    for (int j = 0; j < n; j++) {
        if (codes[j].channels != 3 || codes[j].width != codes->width ||
            codes[j].height != codes->height || !(exposures[j] > 0.0) || !isfinite(exposures[j]))
            return log_fail(log, RELUME_EINVAL,
                            "exposure %d of the bracket: expected 3 channels, equal sizes and a "
                            "time above 0",
                            j);
        low = fmin(low, exposures[j]);
        high = fmax(high, exposures[j]);
    }
    if (codes->width < 8 || codes->height < 8)
        return log_fail(log, RELUME_EINVAL, "a response needs pictures of 8 x 8 pixels or more");
    if (high < same_exposure * low)
        return log_fail(log, RELUME_EUNFIT,
                        "all %d exposures are of %g; expected at least two different ones", n,
                        high);
    return RELUME_OK;
}

relume_status relume_response_recover(struct relume_response *out, const struct relume_image *codes,
                                      const double *exposures, int n,
                                      const struct relume_recover_params *params)
{
    const struct relume_recover_params p = PARAMS(relume_recover_params, params);
    const int samples = p.samples > 0 ? p.samples : default_samples;
    const double smoothness = p.smoothness > 0.0 ? p.smoothness : default_smoothness;
    *out = (struct relume_response){0};
    relume_status status = check(codes, exposures, n, p.log);
    if (status)
        return status;
    const struct search s = {codes, p.masks, n};
    struct place *place = mem_array((size_t)samples, sizeof *place);
    double *log_time = mem_array((size_t)n, sizeof *log_time);
    int *z = mem_array((size_t)n, sizeof *z);
    status = place && log_time && z ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        choose_places(&s, place, samples);
    for (int j = 0; !status && j < n; j++)
        log_time[j] = log(exposures[j]);
    for (int c = 0; !status && c < 3; c++) {
        struct channel ch = {&s, place, c, samples, log_time, z, -1};
        status = solve_channel(out, &ch, smoothness, p.log);
    }
    if (!status)
        normalise(out);
    mem_free(place);
    mem_free(log_time);
    mem_free(z);
    return status;
}
