// fft_kiss.c - transforms by kissfft, in place of fft.c where FFTW's licence does not fit
//
// Even samples forward and odd ones backward make one complex transform of the same length
// (Makhoul 1980): with V its result, X_k = 2 Re(exp(-i pi k / 2N) V_k).
#include "core/math/fft.h"

#include "core/base/memory.h"

#include <kissfft/kiss_fft.h>
#include <math.h>
#include <string.h>

struct line {
    int n;
    kiss_fft_cfg plan;
    kiss_fft_cpx *in, *out, *turn;  // turn: exp(-i pi k / 2N)
};

static void close_line(struct line *l)
{
    kiss_fft_free(l->plan);
    mem_free(l->in);
    mem_free(l->out);
    mem_free(l->turn);
}

static bool open_line(struct line *l, int n, bool inverse)
{
    *l = (struct line){
        .n = n,
        .plan = kiss_fft_alloc(n, inverse, NULL, NULL),
        .in = mem_array((size_t)n, sizeof *l->in),
        .out = mem_array((size_t)n, sizeof *l->out),
        .turn = mem_array((size_t)n, sizeof *l->turn),
    };
    if (!l->plan || !l->in || !l->out || !l->turn)
        return false;
    for (int k = 0; k < n; k++)
        l->turn[k] =
            (kiss_fft_cpx){(float)cos(M_PI * k / (2.0 * n)), (float)-sin(M_PI * k / (2.0 * n))};
    return true;
}

// Where sample i goes: evens ascending, then odds descending.
static int mirror_index(int i, int n)
{
    return i % 2 ? n - 1 - i / 2 : i / 2;
}

static void forward(struct line *l, float *x, size_t stride)
{
    for (int i = 0; i < l->n; i++)
        l->in[mirror_index(i, l->n)] = (kiss_fft_cpx){x[(size_t)i * stride], 0.0f};
    kiss_fft(l->plan, l->in, l->out);
    for (int k = 0; k < l->n; k++)
        x[(size_t)k * stride] = 2.0f * (l->out[k].r * l->turn[k].r - l->out[k].i * l->turn[k].i);
}

// V_k = exp(i pi k / 2N) (X_k - i X_(N-k)) / 2, and back through 1 / N.
static void backward(struct line *l, float *x, size_t stride)
{
    const float half = 0.5f / (float)l->n;
    for (int k = 0; k < l->n; k++) {
        const float a = half * x[(size_t)k * stride];
        const float b = k ? -half * x[(size_t)(l->n - k) * stride] : 0.0f;
        l->in[k] = (kiss_fft_cpx){a * l->turn[k].r + b * l->turn[k].i,
                                  b * l->turn[k].r - a * l->turn[k].i};
    }
    kiss_fft(l->plan, l->in, l->out);
    for (int i = 0; i < l->n; i++)
        x[(size_t)i * stride] = l->out[mirror_index(i, l->n)].r;
}

relume_status fft_cosine(float *data, int width, int height, bool inverse)
{
    void (*const turn)(struct line *, float *, size_t) = inverse ? backward : forward;
    struct line row, column = {0};
    const bool good = open_line(&row, width, inverse) && open_line(&column, height, inverse);
    for (int y = 0; good && y < height; y++)
        turn(&row, data + (size_t)y * (size_t)width, 1);
    for (int x = 0; good && x < width; x++)
        turn(&column, data + x, (size_t)width);
    close_line(&row);
    close_line(&column);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- lines

struct fft_line {
    int n;
    enum fft_kind kind;
    kiss_fft_cfg plan;
};

relume_status fft_line_create(fft_line **out, int n, enum fft_kind kind)
{
    fft_line *const line = mem_zeroed(1, sizeof *line);
    *out = NULL;
    if (!line)
        return RELUME_ENOMEM;
    *line = (fft_line){n, kind, NULL};
    line->plan = kiss_fft_alloc(n, kind == FFT_INVERSE || kind == FFT_REAL_INVERSE, NULL, NULL);
    if (line->plan)
        *out = line;
    else
        mem_free(line);
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

void fft_line_destroy(fft_line **line)
{
    if (*line)
        kiss_fft_free((*line)->plan);
    mem_free(*line);
    *line = NULL;
}

// A real line is a complex one whose other half is known.
static void run_real(const fft_line *line, const float *in, float *out, float *scratch)
{
    kiss_fft_cpx *const a = (kiss_fft_cpx *)scratch, *const b = a + line->n;
    for (int i = 0; i < line->n; i++)
        a[i] = (kiss_fft_cpx){in[i], 0.0f};
    kiss_fft(line->plan, a, b);
    memcpy(out, b, ((size_t)line->n / 2 + 1) * sizeof *b);
}

static void run_real_inverse(const fft_line *line, const float *in, float *out, float *scratch)
{
    kiss_fft_cpx *const a = (kiss_fft_cpx *)scratch, *const b = a + line->n;
    const int n = line->n;
    memcpy(a, in, ((size_t)n / 2 + 1) * sizeof *a);
    for (int k = n / 2 + 1; k < n; k++)
        a[k] = (kiss_fft_cpx){a[n - k].r, -a[n - k].i};
    kiss_fft(line->plan, a, b);
    for (int i = 0; i < n; i++)
        out[i] = b[i].r;
}

void fft_line_run(const fft_line *line, float *in, float *out, float *scratch)
{
    if (line->kind == FFT_REAL)
        run_real(line, in, out, scratch);
    else if (line->kind == FFT_REAL_INVERSE)
        run_real_inverse(line, in, out, scratch);
    else
        kiss_fft(line->plan, (const kiss_fft_cpx *)in, (kiss_fft_cpx *)out);
}
