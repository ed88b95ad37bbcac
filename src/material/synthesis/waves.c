// waves.c - fractional Fourier analysis: the largest wave is found, noted and taken off, again and
// again (Meseth 2008, 4.1.2 and 4.1.3)
//
// The modulus of the transform of one complex wave has its maximum where the wave is. So the
// texture becomes an analytic signal; the largest of its whole frequencies says where to look, and
// the maximum is looked for along x and y in turn, as it is a product of functions of x and of y.
// The spectrum of what is left needs no new transform: that of a wave is known.
#include "material/synthesis/waves.h"

#include "core/base/memory.h"
#include "core/math/fft2d.h"
#include "core/math/scalar.h"

#include <string.h>

// A wave this close to another, in both directions, is a part of it.
static const double SAME = 0.75;

enum { AROUND = 8, ROUNDS = 4 };  // bins whose median is the surroundings; searches in x and y

struct spectrum {
    int width, height, threads;
    double *re, *im;          // what is left, [height][width]
    double *bin_re, *bin_im;  // its spectrum, the same size
    double *power;            // of the bins before anything was taken off
    double *line;             // 4 of the longer side
    double *turn;             // 4 of the longer side
    const struct plane *plane;
};

void waves_turn(double *cosine, double *sine, int count, double k, int m)
{
    const double step = 2.0 * M_PI * k / m;
    for (int j = 0; j < count; j++) {
        cosine[j] = cos(step * j);
        sine[j] = sin(step * j);
    }
}

// ---------------------------------------------------------------- the analytic signal

static void fill_row(void *context, int row, float *line)
{
    const struct spectrum *s = context;
    for (int x = 0; x < s->width; x++) {
        line[2 * x] = (float)s->plane->value[(size_t)row * (size_t)s->width + (size_t)x];
        line[2 * x + 1] = 0.0f;
    }
}

// 1 for frequencies that are their own conjugates, 2 for one of each pair of the others.
static double analytic(int x, int y, int width, int height)
{
    const bool self_x = x == 0 || 2 * x == width, self_y = y == 0 || 2 * y == height;
    if (self_x && self_y)
        return 1.0;
    if (!self_x)
        return 2 * x < width ? 2.0 : 0.0;
    return 2 * y < height ? 2.0 : 0.0;
}

static bool weigh(void *context, int column, int count, float *lines)
{
    struct spectrum *s = context;
    const double scale = 1.0 / ((double)s->width * s->height);
    for (int i = 0; i < count; i++)
        for (int y = 0; y < s->height; y++) {
            float *z = lines + 2 * ((size_t)i * (size_t)s->height + (size_t)y);
            const double w = scale * analytic(column + i, y, s->width, s->height);
            const size_t at = (size_t)y * (size_t)s->width + (size_t)(column + i);
            s->bin_re[at] = w * (double)z[0];
            s->bin_im[at] = w * (double)z[1];
            z[0] = (float)s->bin_re[at];
            z[1] = (float)s->bin_im[at];
        }
    return true;
}

static void take_row(void *context, int row, const float *line)
{
    struct spectrum *s = context;
    for (int x = 0; x < s->width; x++) {
        s->re[(size_t)row * (size_t)s->width + (size_t)x] = (double)line[2 * x];
        s->im[(size_t)row * (size_t)s->width + (size_t)x] = (double)line[2 * x + 1];
    }
}

static relume_status transform(struct spectrum *s)
{
    fft2d *f;
    relume_status status = fft2d_create(&f, s->width, s->height, false, s->threads);
    if (status)
        return status;
    float *bins = mem_large(fft2d_size(f) * sizeof *bins);
    if (bins) {
        fft2d_rows(f, bins, 0, s->height, fill_row, s);
        fft2d_step_columns(f, bins,
                           &(struct fft2d_step){.to = s->height,
                                                .end = fft2d_columns(f),
                                                .visit = weigh,
                                                .context = s,
                                                .back = true});
        fft2d_rows_back(f, bins, 0, s->height, take_row, s);
        for (size_t i = 0; i < (size_t)s->width * (size_t)s->height; i++)
            s->power[i] = s->bin_re[i] * s->bin_re[i] + s->bin_im[i] * s->bin_im[i];
    }
    mem_free(bins);
    fft2d_destroy(&f);
    return bins ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- one maximum

static double modulus(const double *re, const double *im, int m, double k)
{
    const double step = -2.0 * M_PI * k / m, c = cos(step), s = sin(step);
    double a = 1.0, b = 0.0, sum_re = 0.0, sum_im = 0.0;
    for (int j = 0; j < m; j++) {
        sum_re += a * re[j] - b * im[j];
        sum_im += a * im[j] + b * re[j];
        const double next = a * c - b * s;
        b = a * s + b * c;
        a = next;
    }
    return sum_re * sum_re + sum_im * sum_im;
}

// Where the transform of a line is largest, within `reach` of k.
static double line_maximum(const double *re, const double *im, int m, double k, double reach)
{
    enum { SAMPLES = 20, NARROWER = 36 };
    const double golden = 0.6180339887498949, step = 2.0 * reach / SAMPLES;
    double best = k, most = -1.0;
    for (int i = 0; i <= SAMPLES; i++) {
        const double at = k - reach + step * i, value = modulus(re, im, m, at);
        if (value > most) {
            most = value;
            best = at;
        }
    }
    double low = best - step, high = best + step;
    for (int i = 0; i < NARROWER; i++) {
        const double width = golden * (high - low), a = high - width, b = low + width;
        if (modulus(re, im, m, a) > modulus(re, im, m, b))
            high = b;
        else
            low = a;
    }
    return 0.5 * (low + high);
}

// What is left, summed along y with the wave ky: a line.
static void sum_columns(struct spectrum *s, double ky, double *re, double *im)
{
    memset(re, 0, (size_t)s->width * sizeof *re);
    memset(im, 0, (size_t)s->width * sizeof *im);
    waves_turn(s->turn, s->turn + s->height, s->height, -ky, s->height);
    for (int y = 0; y < s->height; y++) {
        const double c = s->turn[y], d = s->turn[s->height + y];
        const double *a = s->re + (size_t)y * (size_t)s->width,
                     *b = s->im + (size_t)y * (size_t)s->width;
        for (int x = 0; x < s->width; x++) {
            re[x] += c * a[x] - d * b[x];
            im[x] += c * b[x] + d * a[x];
        }
    }
}

static void sum_rows(struct spectrum *s, double kx, double *re, double *im)
{
    waves_turn(s->turn, s->turn + s->width, s->width, -kx, s->width);
    for (int y = 0; y < s->height; y++) {
        const double *a = s->re + (size_t)y * (size_t)s->width,
                     *b = s->im + (size_t)y * (size_t)s->width;
        const double *c = s->turn, *d = s->turn + s->width;
        double sum_re = 0.0, sum_im = 0.0;
        for (int x = 0; x < s->width; x++) {
            sum_re += c[x] * a[x] - d[x] * b[x];
            sum_im += c[x] * b[x] + d[x] * a[x];
        }
        re[y] = sum_re;
        im[y] = sum_im;
    }
}

// From the whole frequency (x, y) to the wave beside it.
static struct relume_wave maximum_near(struct spectrum *s, int x, int y)
{
    const int longest = larger_of(s->width, s->height);
    double *re = s->line, *im = s->line + longest;
    double kx = x, ky = y, reach = 1.0;
    for (int i = 0; i < ROUNDS; i++, reach *= 0.4) {
        sum_columns(s, ky, re, im);
        kx = line_maximum(re, im, s->width, kx, reach);
        sum_rows(s, kx, re, im);
        ky = line_maximum(re, im, s->height, ky, reach);
    }
    double sum_re = 0.0, sum_im = 0.0;
    waves_turn(s->turn, s->turn + s->height, s->height, -ky, s->height);
    for (int j = 0; j < s->height; j++) {
        sum_re += s->turn[j] * re[j] - s->turn[s->height + j] * im[j];
        sum_im += s->turn[j] * im[j] + s->turn[s->height + j] * re[j];
    }
    const double scale = 1.0 / ((double)s->width * s->height);
    return (struct relume_wave){.x = kx, .y = ky, .re = scale * sum_re, .im = scale * sum_im};
}

// ---------------------------------------------------------------- taking it off

// The spectrum of a line of one wave at its whole frequencies.
static void line_spectrum(double *re, double *im, int m, double b)
{
    for (int z = 0; z < m; z++) {
        const double d = 2.0 * M_PI * (b - z), half = 0.5 * d / m, s = sin(half);
        const double size = fabs(s) < 1e-12 ? cos(0.5 * d) / cos(half) : sin(0.5 * d) / (m * s);
        const double phase = 0.5 * d * (m - 1) / m;
        re[z] = size * cos(phase);
        im[z] = size * sin(phase);
    }
}

// plane -= F (lines of x) (lines of y)
static void subtract(double *re, double *im, int width, int height, double f_re, double f_im,
                     const double *x, const double *y)
{
    for (int j = 0; j < height; j++) {
        const double c = f_re * y[j] - f_im * y[height + j], d = f_re * y[height + j] + f_im * y[j];
        double *a = re + (size_t)j * (size_t)width, *b = im + (size_t)j * (size_t)width;
        for (int i = 0; i < width; i++) {
            a[i] -= c * x[i] - d * x[width + i];
            b[i] -= c * x[width + i] + d * x[i];
        }
    }
}

static void take_off(struct spectrum *s, const struct relume_wave *w)
{
    double *x = s->turn, *y = s->turn + 2 * s->width;
    waves_turn(x, x + s->width, s->width, w->x, s->width);
    waves_turn(y, y + s->height, s->height, w->y, s->height);
    subtract(s->re, s->im, s->width, s->height, w->re, w->im, x, y);
    line_spectrum(x, x + s->width, s->width, w->x);
    line_spectrum(y, y + s->height, s->height, w->y);
    subtract(s->bin_re, s->bin_im, s->width, s->height, w->re, w->im, x, y);
}

// ---------------------------------------------------------------- surroundings

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

// The mean power of the bins around, by their median, which a few waves do not move: of noise it
// is ln 2 times the mean.
static double surroundings(const struct spectrum *s, int x, int y)
{
    double list[(2 * AROUND + 1) * (2 * AROUND + 1)];
    int n = 0;
    for (int j = -AROUND; j <= AROUND; j++)
        for (int i = -AROUND; i <= AROUND; i++) {
            const int at_x = x + i, at_y = (y + j + s->height) % s->height;
            if (at_x < 0 || at_x >= s->width || (abs(i) <= 1 && abs(j) <= 1) || at_y < 0 ||
                analytic(at_x, at_y, s->width, s->height) < 1.5)
                continue;
            list[n++] = s->power[(size_t)at_y * (size_t)s->width + (size_t)at_x];
        }
    qsort(list, (size_t)n, sizeof *list, by_size);
    return n ? list[n / 2] / M_LN2 : 0.0;
}

// ---------------------------------------------------------------- all of them

static bool is_part(const struct waves *w, const struct relume_wave *new)
{
    for (int i = 0; i < w->count; i++)
        if (fabs(w->wave[i].x - new->x) < SAME && fabs(w->wave[i].y - new->y) < SAME)
            return true;
    return false;
}

static size_t largest_bin(const struct spectrum *s)
{
    size_t best = 0;
    double most = -1.0;
    for (size_t i = 0; i < (size_t)s->width * (size_t)s->height; i++) {
        const double p = s->bin_re[i] * s->bin_re[i] + s->bin_im[i] * s->bin_im[i];
        if (p > most) {
            most = p;
            best = i;
        }
    }
    return best;
}

static bool add(struct waves *w, const struct relume_wave *wave)
{
    if (!mem_grow(&w->wave, (size_t)w->count, sizeof *w->wave))
        return false;
    w->wave[w->count++] = *wave;
    return true;
}

// What comes near a wave that is known is taken off without being one.
static relume_status extract(struct waves *out, struct spectrum *s, double threshold, int most)
{
    for (int parts = 0; out->count <= most && parts < 4 * most;) {
        const size_t at = largest_bin(s);
        const int x = (int)(at % (size_t)s->width), y = (int)(at / (size_t)s->width);
        const int signed_x = 2 * x > s->width ? x - s->width : x,
                  signed_y = 2 * y > s->height ? y - s->height : y;
        struct relume_wave w = maximum_near(s, signed_x, signed_y);
        const double power = w.re * w.re + w.im * w.im, around = surroundings(s, x, y);
        if (power < threshold * threshold)
            break;
        take_off(s, &w);
        if (w.x < 0.0) {  // its conjugate is the same wave
            w.x = -w.x;
            w.y = -w.y;
            w.im = -w.im;
        }
        w.above = around > 0.0 ? power / around : 1e9;
        if (is_part(out, &w))
            parts++;
        else if (!add(out, &w))
            return RELUME_ENOMEM;
    }
    return RELUME_OK;
}

relume_status waves_find(struct waves *out, const struct plane *plane, double threshold, int most,
                         int threads)
{
    const size_t n = (size_t)plane->width * (size_t)plane->height;
    struct spectrum s = {.width = plane->width, .height = plane->height, .threads = threads};
    const size_t longest = (size_t)larger_of(s.width, s.height);
    double *memory = mem_array(5 * n + 6 * longest, sizeof *memory);
    *out = (struct waves){.count = 0};
    if (!memory)
        return RELUME_ENOMEM;
    s.plane = plane;
    s.re = memory;
    s.im = s.re + n;
    s.bin_re = s.im + n;
    s.bin_im = s.bin_re + n;
    s.power = s.bin_im + n;
    s.line = s.power + n;
    s.turn = s.line + 2 * longest;
    relume_status status = transform(&s);
    if (!status) {
        const struct relume_wave mean = {.re = s.bin_re[0]};
        take_off(&s, &mean);
        if (!add(out, &mean))
            status = RELUME_ENOMEM;
    }
    if (!status)
        status = extract(out, &s, threshold, most);
    mem_free(memory);
    if (status) {
        mem_free(out->wave);
        *out = (struct waves){.count = 0};
    }
    return status;
}
