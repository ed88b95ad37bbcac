// waves_fit.c - waves together, by least squares: what each of them took of the others is put right
// (Meseth 2008, 4.1.3, "Optimization of Extracted Frequencies")
//
// The model is real: sum Re(F e), e = exp(i (x b_x + y b_y)), x and y from 0 to 2 pi over the
// sample. Its derivatives by F and b are Re(G x^p y^q e), and sums of products of two of these are
// products of sums over x and over y alone: the normal equations cost next to nothing.
#include "material/synthesis/waves.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/scalar.h"

#include <complex.h>
#include <string.h>

enum { WEIGHTS = 2, PLACES = 4 };  // unknowns of a wave

// The derivatives: by Re F, by Im F, by b_x, by b_y.
static const int power_x[PLACES] = {0, 0, 1, 0}, power_y[PLACES] = {0, 0, 0, 1};

struct fit {
    const struct plane *plane;
    int each, unknowns;
    double *left;  // [height][width]: plane - model
    double *matrix, *system, *right;
    double *turn;
    double complex *column[2];  // [width] of sums along y with y^0 and y^1
};

static double complex factor_of(const struct relume_wave *w, int k)
{
    return k == 0 ? 1.0 : k == 1 ? I : I * (w->re + I * w->im);
}

// sum over x of x^p exp(i d x), p from 0 to 2
static void power_sums(double complex out[3], double d, int m)
{
    const double step = 2.0 * M_PI / m;
    double sum[6] = {0};
    for (int j = 0; j < m; j++) {
        const double x = step * j, c = cos(d * x), s = sin(d * x);
        sum[0] += c;
        sum[1] += s;
        sum[2] += x * c;
        sum[3] += x * s;
        sum[4] += x * x * c;
        sum[5] += x * x * s;
    }
    for (int p = 0; p < 3; p++)
        out[p] = sum[2 * p] + I * sum[2 * p + 1];
}

static void fill_matrix(struct fit *f, const struct waves *w)
{
    for (int i = 0; i < w->count; i++)
        for (int j = 0; j <= i; j++) {
            const struct relume_wave *a = &w->wave[i], *b = &w->wave[j];
            double complex x[2][3], y[2][3];
            power_sums(x[0], a->x - b->x, f->plane->width);
            power_sums(x[1], a->x + b->x, f->plane->width);
            power_sums(y[0], a->y - b->y, f->plane->height);
            power_sums(y[1], a->y + b->y, f->plane->height);
            for (int k = 0; k < f->each; k++)
                for (int l = 0; l < f->each; l++) {
                    const int p = power_x[k] + power_x[l], q = power_y[k] + power_y[l];
                    const double complex u = factor_of(a, k), v = factor_of(b, l);
                    const double value =
                        0.5 * creal(u * conj(v) * x[0][p] * y[0][q] + u * v * x[1][p] * y[1][q]);
                    const int row = i * f->each + k, column = j * f->each + l;
                    f->matrix[(size_t)row * (size_t)f->unknowns + (size_t)column] = value;
                    f->matrix[(size_t)column * (size_t)f->unknowns + (size_t)row] = value;
                }
        }
}

// What is left of the plane; its mean square.
static double residual(struct fit *f, const struct waves *w)
{
    const int width = f->plane->width, height = f->plane->height;
    double *cx = f->turn, *sx = cx + width, *cy = sx + width, *sy = cy + height, sum = 0.0;
    memcpy(f->left, f->plane->value, (size_t)width * (size_t)height * sizeof *f->left);
    for (int i = 0; i < w->count; i++) {
        const struct relume_wave *a = &w->wave[i];
        waves_turn(cx, sx, width, a->x, width);
        waves_turn(cy, sy, height, a->y, height);
        for (int y = 0; y < height; y++) {
            const double re = a->re * cy[y] - a->im * sy[y], im = a->re * sy[y] + a->im * cy[y];
            double *to = f->left + (size_t)y * (size_t)width;
            for (int x = 0; x < width; x++)
                to[x] -= re * cx[x] - im * sx[x];
        }
    }
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        sum += f->left[i] * f->left[i];
    return sum / ((double)width * height);
}

static void fill_right(struct fit *f, const struct waves *w)
{
    const int width = f->plane->width, height = f->plane->height;
    for (int i = 0; i < w->count; i++) {
        const struct relume_wave *a = &w->wave[i];
        double *c = f->turn, *s = c + larger_of(width, height);
        double complex sum[PLACES] = {0};
        waves_turn(c, s, height, a->y, height);
        for (int x = 0; x < width; x++)
            f->column[0][x] = f->column[1][x] = 0.0;
        for (int y = 0; y < height; y++) {
            const double complex e = c[y] + I * s[y], t = e * (2.0 * M_PI * y / height);
            const double *from = f->left + (size_t)y * (size_t)width;
            for (int x = 0; x < width; x++) {
                f->column[0][x] += from[x] * e;
                f->column[1][x] += from[x] * t;
            }
        }
        waves_turn(c, s, width, a->x, width);
        for (int x = 0; x < width; x++) {
            const double complex e = c[x] + I * s[x];
            sum[0] += e * f->column[0][x];
            sum[2] += e * f->column[0][x] * (2.0 * M_PI * x / width);
            sum[3] += e * f->column[1][x];
        }
        sum[1] = sum[0];
        for (int k = 0; k < f->each; k++)
            f->right[i * f->each + k] = creal(factor_of(a, k) * sum[k]);
    }
}

// The mean has no second weight, and nothing has a place where it is 0: such unknowns stay.
static bool step(struct fit *f, const struct waves *from, struct waves *to, double damping)
{
    const size_t n = (size_t)f->unknowns;
    memcpy(f->system, f->matrix, n * n * sizeof *f->system);
    for (size_t i = 0; i < n; i++) {
        double *own = &f->system[i * n + i];
        *own = *own * (1.0 + damping) + 1e-9 * f->plane->width * f->plane->height;
    }
    if (!lsq_solve(f->system, f->unknowns, f->right, 1))
        return false;
    memcpy(to->wave, from->wave, (size_t)from->count * sizeof *to->wave);
    for (int i = 0; i < to->count; i++) {
        const double *d = f->right + i * f->each;
        struct relume_wave *w = &to->wave[i];
        w->re += d[0];
        w->im += i ? d[1] : 0.0;
        if (f->each == PLACES && i) {
            w->x += fmin(fmax(d[2], -0.25), 0.25);
            w->y += fmin(fmax(d[3], -0.25), 0.25);
        }
    }
    return true;
}

static void fit_steps(struct fit *f, struct waves *w, struct waves *trial, int steps, double *rest,
                      double *before)
{
    double damping = f->each == PLACES ? 1e-3 : 0.0;
    *rest = residual(f, w);
    if (before)
        *before = *rest;
    for (int i = 0; i < steps; i++) {
        fill_matrix(f, w);
        fill_right(f, w);
        if (!step(f, w, trial, damping))
            break;
        const double new = residual(f, trial);
        if (new <= *rest) {
            const bool done = new > 0.99999 * *rest;
            memcpy(w->wave, trial->wave, (size_t)w->count * sizeof *w->wave);
            *rest = new;
            damping *= 0.2;
            if (done)
                break;
        } else {
            damping = damping * 10.0 + 1e-4;
            *rest = residual(f, w);
        }
    }
}

static relume_status fit(struct waves *w, const struct plane *plane, int each, int steps,
                         double *rest, double *before)
{
    const size_t n = (size_t)(w->count * each),
                 pixels = (size_t)plane->width * (size_t)plane->height;
    struct fit f = {.plane = plane, .each = each, .unknowns = w->count * each};
    struct waves trial = {mem_copy(w->wave, (size_t)w->count, sizeof *w->wave), w->count};
    f.matrix = mem_array(2 * n * n + n, sizeof *f.matrix);
    f.left = mem_array(pixels + 2 * (size_t)(plane->width + plane->height), sizeof *f.left);
    f.column[0] = mem_array(2 * (size_t)plane->width, sizeof *f.column[0]);
    const bool good = trial.wave && f.matrix && f.left && f.column[0];
    if (good) {
        f.system = f.matrix + n * n;
        f.right = f.system + n * n;
        f.turn = f.left + pixels;
        f.column[1] = f.column[0] + plane->width;
        fit_steps(&f, w, &trial, steps, rest, before);
    }
    mem_free(trial.wave);
    mem_free(f.matrix);
    mem_free(f.left);
    mem_free(f.column[0]);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

relume_status waves_fit(struct waves *w, const struct plane *plane, int steps, double *rest,
                        double *before)
{
    const relume_status status = fit(w, plane, WEIGHTS, 2, rest, before);
    return status || steps < 1 ? status : fit(w, plane, PLACES, steps, rest, NULL);
}
