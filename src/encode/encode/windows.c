// windows.c - windows of a view, coded as components and as pictures
#include "encode/encode/windows.h"

#include "core/base/memory.h"
#include "core/math/scalar.h"
#include "format/coder/basis.h"
#include "format/coder/codes.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"

#include <math.h>
#include <string.h>

// A window is smaller where there are more planes than that. Of a view that is larger than three
// windows across or down there are two that way.
enum { WINDOW = 256, MANY_PLANES = 320, ONE_WINDOW = 3 };

enum { FINE, COARSE, STEPS };
static const int usual_steps[STEPS] = {20 * AV1_STEPS, 40 * AV1_STEPS};
// For a high quality, which lies between the qualities of these.
static const int fine_steps[STEPS] = {12 * AV1_STEPS, 28 * AV1_STEPS};
static const double HIGH_DB = 36.0;

// What half the bytes cost: measured, within these bounds.
static const double LEAST_SLOPE = 2.0, MOST_SLOPE = 8.0;

// Coding is at least this share of all errors: a line in dB needs one, and of pictures and
// components that miss too much already nothing is left for it.
static const double LEAST_SHARE = 0.02;

// A window as a coder's codes before and after loss.
struct coded_window {
    relume_coefficients *coefficients;
    struct captured captured;
    uint16_t *before, *after;  // [planes][height][width]
};

// What all windows have taken, and missed: squared errors of display values, of the lights and of
// these as all others foretell them after loss.
struct points {
    double bytes[STEPS], square[STEPS], left_out[STEPS];
    double kept;  // what is missed before loss
};

// Rows of a window by which foretelling is judged: one of so many.
enum { EACH_ROW = 8 };

static void close_window(struct coded_window *l)
{
    relume_coefficients_destroy(&l->coefficients);
    captured_destroy(&l->captured);
    mem_free(l->before);
    mem_free(l->after);
}

// Where the i-th of `n` windows begins along `length` pixels.
static int begin_of(int i, int n, int length, int window)
{
    return (2 * i + 1) * length / (2 * n) - window / 2;
}

static int windows_along(int length, int window)
{
    return length > ONE_WINDOW * window ? 2 : 1;
}

static relume_status open_window(struct coded_window *l, const relume_coder *coder,
                                 const relume_capture *capture, const struct relume_rect *at,
                                 const struct relume_project_params *encode)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    const size_t size = (size_t)coder->info.planes * (size_t)at->width * (size_t)at->height;
    relume_status status = project_some_rows(&l->coefficients, coder, capture, m->views / 2,
                                             at->top, at->height, encode);
    if (!status)
        status = coefficients_share_steps(&l->coefficients, 1, false, RELUME_STEP_HALVED);
    if (!status)
        status = captured_create(&l->captured, coder, m->directions, m->lights);
    l->before = mem_array(size, sizeof *l->before);
    l->after = mem_array(size, sizeof *l->after);
    return status || (l->before && l->after) ? status : RELUME_ENOMEM;
}

// A row of a window, a channel of it under all lights: shown[light][x], display values.
static void show(float *shown, float *planes, const struct coded_window *l, const uint16_t *codes,
                 const struct relume_rect *at, int row, int channel)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(l->coefficients);
    const size_t width = (size_t)at->width, size = width * (size_t)at->height;
    for (size_t k = 0; k < (size_t)info->planes; k++)
        codes_restore(planes + k * width, RELUME_STORE_12, codes, k * size + (size_t)row * width,
                      width, info->scale[k], info->offset[k]);
    captured_predict(&l->captured, info->coder, channel, planes, width, width, shown);
}

// The mean squared difference of what `l` shows after loss from the pictures before.
static relume_status judge(double *square, const struct coded_window *l, const uint16_t *codes,
                           const struct coded_window *pictures, const struct relume_rect *at)
{
    const size_t n = (size_t)l->captured.lights * (size_t)at->width;
    const int most = relume_coefficients_info(pictures->coefficients)->planes,
              own = relume_coefficients_info(l->coefficients)->planes;
    float *planes =
        mem_array((size_t)(own > most ? own : most), (size_t)at->width * sizeof *planes);
    float *want = mem_array(n, sizeof *want), *got = mem_array(n, sizeof *got);
    const bool good = planes && want && got;
    double sum = 0.0;
    for (int i = 0; good && i < 3 * at->height; i++) {
        show(want, planes, pictures, pictures->before, at, i / 3, i % 3);
        show(got, planes, l, codes, at, i / 3, i % 3);
        for (size_t k = 0; k < n; k++) {
            const double d = (double)fminf(fmaxf(want[k], 0.0f), 1.0f) -
                             (double)fminf(fmaxf(got[k], 0.0f), 1.0f);
            sum += d * d;
        }
    }
    *square = sum / (3.0 * (double)n * at->height);
    mem_free(planes);
    mem_free(want);
    mem_free(got);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// Lights as all others foretell them: they are missed by (B t)_i / B_ii, t what `l` shows
// (basis.h).
static double foretell(const float *want, const float *got, float *missed, const double *b,
                       int lights, size_t width)
{
    double sum = 0.0;
    for (int i = 0; i < lights; i++, b += lights, want += width) {
        memset(missed, 0, width * sizeof *missed);
        for (int k = 0; k < lights; k++) {
            const float w = k == i ? 0.0f : (float)(-b[k] / b[i]);
            for (size_t x = 0; x < width; x++)
                missed[x] += w * got[(size_t)k * width + x];
        }
        for (size_t x = 0; x < width; x++) {
            const double d = (double)fminf(fmaxf(want[x], 0.0f), 1.0f) -
                             (double)fminf(fmaxf(missed[x], 0.0f), 1.0f);
            sum += d * d;
        }
    }
    return sum;
}

// The mean squared error of that, by some rows; `b` is the predictor of the lights.
static relume_status judge_left_out(double *square, const struct coded_window *l,
                                    const struct coded_window *pictures,
                                    const struct relume_rect *at, const double *b)
{
    const size_t width = (size_t)at->width, n = (size_t)l->captured.lights * width;
    const int most = relume_coefficients_info(pictures->coefficients)->planes,
              own = relume_coefficients_info(l->coefficients)->planes;
    float *planes = mem_array((size_t)(own > most ? own : most) + 1, width * sizeof *planes);
    float *want = mem_array(n, sizeof *want), *got = mem_array(n, sizeof *got);
    const bool good = planes && want && got;
    double sum = 0.0;
    int rows = 0;
    for (int row = EACH_ROW / 2 % at->height; good && row < at->height; row += EACH_ROW, rows++)
        for (int c = 0; c < 3; c++) {
            show(want, planes, pictures, pictures->before, at, row, c);
            show(got, planes, l, l->after, at, row, c);
            sum += foretell(want, got, planes, b, l->captured.lights, width);
        }
    *square = good ? sum / (3.0 * (double)n * rows) : 0.0;
    mem_free(planes);
    mem_free(want);
    mem_free(got);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// Of a step by both coders; `b` NULL: without lights left out.
static relume_status add_window(struct points points[2], const relume_coder *const coder[2],
                                const relume_capture *capture, const struct relume_rect *at, int s,
                                int quantiser, const double *b,
                                const struct relume_project_params *encode)
{
    const struct av1_effort effort = {quantiser, RATE_QUICK};
    struct coded_window window[2] = {{0}, {0}};
    relume_status status = open_window(&window[1], coder[1], capture, at, encode);
    if (!status)
        status = open_window(&window[0], coder[0], capture, at, encode);
    for (int i = 1; !status && i >= 0;
         i--) {  // the pictures first, which the other is compared with
        size_t bytes;
        double square = 0.0, kept = 0.0, left_out = 0.0;
        status = lossy_try(window[i].before, window[i].after, &bytes, window[i].coefficients, at,
                           &effort, encode->threads, encode->log);
        if (!status)
            status = judge(&square, &window[i], window[i].after, &window[1], at);
        if (!status && i == 0 && s == COARSE)
            status = judge(&kept, &window[i], window[i].before, &window[1], at);
        if (!status && b)
            status = judge_left_out(&left_out, &window[i], &window[1], at, b);
        points[i].bytes[s] += (double)bytes;
        points[i].square[s] += square;
        points[i].kept += kept;
        points[i].left_out[s] += left_out;
    }
    close_window(&window[0]);
    close_window(&window[1]);
    return status;
}

// The windows of the middle view.
struct windows {
    int width, height, across, down;
    double scale;     // pixels of the view for each of theirs
    const int *step;  // [STEPS]
};

static struct windows windows_of(const relume_coder *pictures, const relume_capture *capture,
                                 const struct rate_target *target)
{
    const int width = relume_capture_width(capture), height = relume_capture_height(capture);
    const int side = relume_coder_info(pictures)->planes > MANY_PLANES ? WINDOW / 2 : WINDOW;
    struct windows w = {smaller_of(side, width),
                        smaller_of(side, height),
                        windows_along(width, side),
                        windows_along(height, side),
                        0.0,
                        target->psnr_db > HIGH_DB ? fine_steps : usual_steps};
    w.scale = (double)width * height / ((double)w.width * w.height * w.across * w.down);
    return w;
}

static relume_status add_windows(struct points points[2], const struct windows *w,
                                 const relume_coder *const coder[2], const relume_capture *capture,
                                 int s, const double *b, const struct relume_project_params *encode)
{
    const int width = relume_capture_width(capture), height = relume_capture_height(capture);
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < w->across * w->down; i++) {
        struct relume_rect at = {.width = w->width, .height = w->height};
        at.left = begin_of(i % w->across, w->across, width, w->width);
        at.top = begin_of(i / w->across, w->down, height, w->height) / BAND_ROWS * BAND_ROWS;
        status = add_window(points, coder, capture, &at, s, w->step[s], b, encode);
    }
    return status;
}

// The mean squared error of coding alone, of a step.
static double loss_of(const struct points *p, const struct windows *w, int s)
{
    return fmax(p->square[s] - p->kept, LEAST_SHARE * p->square[s]) / (w->across * w->down);
}

// On a line through the coarse point, of so many dB of the coding error for twice the bytes; the
// error before coding is added to it.
static double merit_of(const struct points *p, const struct windows *w, double slope,
                       const struct rate_target *target, double header)
{
    const double coarse = decibels(loss_of(p, w, COARSE)), kept = p->kept / (w->across * w->down);
    const double bytes = w->scale * p->bytes[COARSE], left = fmax(target->bytes - header, 1.0);
    if (target->psnr_db > 0.0) {
        const double all = pow(10.0, -0.1 * target->psnr_db);
        const double wanted = decibels(fmax(all - kept, LEAST_SHARE * all));
        return rate_merit_of(target->psnr_db, bytes * exp2((wanted - coarse) / slope), target,
                             header);
    }
    return decibels(pow(10.0, -0.1 * (coarse + slope * log2(left / bytes))) + kept);
}

// Of the line through both points.
static double slope_of(const struct points *p, const struct windows *w)
{
    const double dB = decibels(loss_of(p, w, FINE)) - decibels(loss_of(p, w, COARSE));
    const double each = dB / fmax(log2(p->bytes[FINE] / p->bytes[COARSE]), 1e-3);
    return fmin(fmax(each, LEAST_SLOPE), MOST_SLOPE);
}

// Whether one is better than the other by more than `clearly` whatever the slopes are; then the
// least of its merit and the most of the other's.
static bool is_clear(double merit[2], const struct points points[2], const struct windows *w,
                     const struct rate_target *target, const double header[2], double clearly)
{
    double least[2], most[2];
    for (int i = 0; i < 2; i++) {
        const double flat = merit_of(&points[i], w, LEAST_SLOPE, target, header[i]);
        const double steep = merit_of(&points[i], w, MOST_SLOPE, target, header[i]);
        least[i] = fmin(flat, steep);
        most[i] = fmax(flat, steep);
    }
    const int better = least[1] > least[0];
    merit[better] = least[better];
    merit[!better] = most[!better];
    return merit[better] > merit[!better] + clearly;
}

// What lights left out are shown at about, at the target: on the line through both points, between
// them.
static double left_out_of(const struct points *p, const struct windows *w,
                          const struct rate_target *target, double header)
{
    const double coarse = decibels(p->square[COARSE]), fine = decibels(p->square[FINE]);
    const double left = fmax(target->bytes - header, 1.0) / w->scale;
    const double t =
        target->psnr_db > 0.0
            ? (target->psnr_db - decibels(p->square[COARSE] / (w->across * w->down))) /
                  fmax(fine - coarse, 1e-3)
            : log2(left / p->bytes[COARSE]) / fmax(log2(p->bytes[FINE] / p->bytes[COARSE]), 1e-3);
    const double from = decibels(p->left_out[COARSE] / (w->across * w->down)),
                 to = decibels(p->left_out[FINE] / (w->across * w->down));
    return from + (to - from) * fmin(fmax(t, 0.0), 1.0);
}

// Of the interpolant of the pictures, which is that of the components, too; NULL where there is
// none or memory is short.
static double *predictor_of(const relume_coder *pictures)
{
    const struct relume_interpolant *between = pictures->info.interpolant;
    const size_t lights = (size_t)pictures->info.lights;
    double *b =
        between && between->predictor && lights > 3 ? mem_array(lights * lights, sizeof *b) : NULL;
    if (b)
        between->predictor(pictures->interpolant, b);
    return b;
}

relume_status windows_compare(double merit[2], double left_out[2],
                              const relume_coder *const coder[2], const relume_capture *capture,
                              const struct rate_target *target, const double header[2],
                              double clearly, const struct relume_project_params *encode)
{
    const struct windows w = windows_of(coder[1], capture, target);
    struct points points[2] = {{.kept = 0.0}, {.kept = 0.0}};
    double *b = predictor_of(coder[1]);
    left_out[0] = left_out[1] = 0.0;
    relume_status status = add_windows(points, &w, coder, capture, COARSE, b, encode);
    if (!status && !is_clear(merit, points, &w, target, header, clearly)) {
        status = add_windows(points, &w, coder, capture, FINE, b, encode);
        for (int i = 0; i < 2; i++) {
            merit[i] = merit_of(&points[i], &w, slope_of(&points[i], &w), target, header[i]);
            left_out[i] = b ? left_out_of(&points[i], &w, target, header[i]) : 0.0;
        }
    }
    mem_free(b);
    return status;
}
