// sight.c - opponent channels of two pictures in bands, each over the threshold that masking sets
#include "image/compare/sight.h"

#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "image/compare/jnd.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

void sight_destroy(struct sight *s)
{
    fft2d_destroy(&s->fft);
    for (int i = 0; i < 2; i++) {
        mem_free(s->spectrum[i]);
        mem_free(s->band[i]);
    }
    mem_free(s->work);
    mem_free(s->over);
    mem_free(s->scratch);
    *s = (struct sight){0};
}

static bool in_range(const struct relume_image *a, const struct relume_image *b,
                     const struct relume_jnd_params *p)
{
    return a->channels == 3 && b->channels == 3 && a->width == b->width && a->height == b->height &&
           a->width > 0 && a->height > 0 && p->pixels_per_degree >= 0.0 &&
           p->pixels_per_degree <= 1000.0 && p->white >= 0.0 && p->white <= 1e6 &&
           (!p->mask ||
            (p->mask->channels == 1 && p->mask->width == a->width && p->mask->height == a->height));
}

// Margin for pictures to go on mirrored beyond their borders, a degree where they are that large.
static int with_margin(int side, double ppd)
{
    return fft_good_size(side + smaller_of(side, (int)ceil(ppd)));
}

relume_status sight_create(struct sight *s, const struct relume_image *image,
                           const struct relume_image *reference, const struct relume_jnd_params *p)
{
    *s = (struct sight){0};
    if (!in_range(image, reference, p))
        return RELUME_EINVAL;
    *s = (struct sight){
        .image = {image, reference},
        .mask = p->mask ? p->mask->data : NULL,
        .width = image->width,
        .height = image->height,
        .ppd = p->pixels_per_degree > 0.0 ? p->pixels_per_degree : 40.0,
        .white = p->white > 0.0 ? p->white : 200.0,
        .threads = p->threads,
        .unmasked = p->unmasked,
    };
    s->wide = with_margin(s->width, s->ppd);
    s->high = with_margin(s->height, s->ppd);
    const size_t pixels = (size_t)s->width * (size_t)s->height;
    bool good = !fft2d_create(&s->fft, s->wide, s->high, true, s->threads);
    for (int i = 0; good && i < 2; i++)
        good = (s->spectrum[i] = mem_array(fft2d_size(s->fft), sizeof(float))) &&
               (s->band[i] = mem_array(pixels, sizeof(float)));
    good = good && (s->work = mem_zeroed(fft2d_size(s->fft), sizeof(float))) &&
           (s->over = mem_array(pixels, sizeof(float))) &&
           (s->scratch = mem_array(2 * pixels, sizeof(float)));
    if (!good)
        sight_destroy(s);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- channels

// Where place `i` of a line of `padded` lies in a picture of `side`: the picture, then its mirror
// image at its end, then the one at its beginning.
static int mirrored(int i, int side, int padded)
{
    if (i < side)
        return i;
    const int beyond = i - side, before = padded - 1 - i;
    return beyond <= before ? side - 1 - beyond % side : before % side;
}

struct channel {
    const struct sight *s;
    int image;
    enum relume_opponent opponent;
};

static void fill_row(void *context, int row, float *line)
{
    const struct channel *c = context;
    const struct sight *s = c->s;
    const size_t y = (size_t)mirrored(row, s->height, s->high);
    const float *from = s->image[c->image]->data + 3 * y * (size_t)s->width;
    for (int x = 0; x < s->width; x++) {
        const double rgb[3] = {from[3 * x], from[3 * x + 1], from[3 * x + 2]};
        double seen[RELUME_OPPONENTS];
        relume_jnd_opponent(seen, rgb, s->white);
        line[x] = (float)seen[c->opponent];
    }
    for (int x = s->width; x < s->wide; x++)
        line[x] = line[mirrored(x, s->width, s->wide)];
}

struct spectrum {
    const struct sight *s;
    const float *from;
    float *to;
    enum relume_opponent opponent;
    int band, direction;  // -1: all
};

// Cycles per degree of coefficient `v` of a column.
static double frequency_down(const struct sight *s, int v)
{
    return (v <= s->high / 2 ? v : v - s->high) * s->ppd / s->high;
}

static void weigh_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct spectrum *t = context;
    const struct sight *s = t->s;
    const int columns = fft2d_columns(s->fft);
    const size_t at = row * (fft2d_size(s->fft) / (size_t)s->high);
    const double y = frequency_down(s, (int)row), scale = 1.0 / ((double)s->wide * s->high);
    for (int u = 0; u < columns; u++) {
        const double x = u * s->ppd / s->wide;
        double weight = t->band < 0
                            ? scale * relume_jnd_sensitivity(t->opponent, sqrt(x * x + y * y))
                            : sight_band_share(t->band, x, y);
        if (t->direction >= 0 && weight > 0.0)
            weight *= sight_direction_share(t->direction, x, y);
        for (size_t i = at + 2 * (size_t)u; i < at + 2 * (size_t)u + 2; i++)
            t->to[i] = (float)weight * t->from[i];
    }
}

void sight_look(struct sight *s, enum relume_opponent channel)
{
    for (int i = 0; i < 2; i++) {
        struct channel c = {s, i, channel};
        const struct fft2d_step column_step = {.to = s->high, .end = fft2d_columns(s->fft)};
        fft2d_rows(s->fft, s->spectrum[i], 0, s->high, fill_row, &c);
        fft2d_step_columns(s->fft, s->spectrum[i], &column_step);
        struct spectrum t = {s, s->spectrum[i], s->spectrum[i], channel, -1, -1};
        thread_for(s->threads, (size_t)s->high, weigh_row, &t);
    }
}

// ---------------------------------------------------------------- bands

// From 1 at octave k to 0 at its neighbours; squares of cosines sum to 1.
double sight_band_share(int band, double x, double y)
{
    const double f2 = x * x + y * y;
    const double octave = f2 > 0.25 ? 0.5 * log2(f2) + 1.0 : 0.0;  // band 0 is 0.5 and coarser
    const double away = fmin(octave, SIGHT_BANDS - 1.0) - band;
    const double c = fabs(away) < 1.0 ? cos(0.5 * PI * away) : 0.0;
    return c * c;
}

double sight_direction_share(int direction, double x, double y)
{
    if (x == 0.0 && y == 0.0)
        return 1.0 / SIGHT_DIRECTIONS;
    double turn = (atan2(y, x) / PI) * SIGHT_DIRECTIONS - direction;  // 1: to the next one
    turn -= SIGHT_DIRECTIONS * floor(turn / SIGHT_DIRECTIONS + 0.5);
    const double c = fabs(turn) < 1.0 ? cos(0.5 * PI * turn) : 0.0;
    return c * c;
}

struct plane {
    float *to;
    int width;
};

static void take_row(void *context, int row, const float *line)
{
    const struct plane *p = context;
    memcpy(p->to + (size_t)row * (size_t)p->width, line, (size_t)p->width * sizeof *line);
}

static void find_band(struct sight *s, int image, int band, int direction)
{
    struct spectrum t = {s, s->spectrum[image], s->work, 0, band, direction};
    struct plane plane = {s->band[image], s->width};
    thread_for(s->threads, (size_t)s->high, weigh_row, &t);
    fft2d_columns_back(s->fft, s->work);
    fft2d_rows_back(s->fft, s->work, 0, s->height, take_row, &plane);
}

// ---------------------------------------------------------------- masking

// Means over windows of 2 r + 1 lines, or fewer at the borders.
struct means {
    const float *from;
    float *to;
    int lines, length, radius;  // `length` means of `lines` columns each, COLUMNS at a time
    size_t step, stride;        // from line to line, and along it
};
enum { COLUMNS = 64 };

static void mean_block(void *context, size_t item, int worker)
{
    (void)worker;
    const struct means *m = context;
    const size_t first = item * COLUMNS;
    const int n = smaller_of(COLUMNS, m->lines - (int)first);
    double sum[COLUMNS] = {0};
    int inside = 0;
    for (int i = -m->radius; i < m->length; i++) {
        const int in = i + m->radius, out = i - m->radius - 1;
        const float *add = m->from + first * m->step + (size_t)in * m->stride;
        for (int k = 0; in < m->length && k < n; k++)
            sum[k] += (double)add[(size_t)k * m->step];
        inside += in < m->length;
        if (out >= 0) {
            const float *drop = m->from + first * m->step + (size_t)out * m->stride;
            for (int k = 0; k < n; k++)
                sum[k] -= (double)drop[(size_t)k * m->step];
            inside--;
        }
        if (i < 0)
            continue;
        float *to = m->to + first * m->step + (size_t)i * m->stride;
        for (int k = 0; k < n; k++)
            to[(size_t)k * m->step] = (float)(sum[k] / inside);
    }
}

static void mean_both(struct sight *s, float *plane, float *scratch, int radius)
{
    const size_t width = (size_t)s->width;
    struct means across = {plane, scratch, s->height, s->width, radius, width, 1};
    struct means down = {scratch, plane, s->width, s->height, radius, 1, width};
    thread_for(s->threads, ((size_t)s->height + COLUMNS - 1) / COLUMNS, mean_block, &across);
    thread_for(s->threads, (width + COLUMNS - 1) / COLUMNS, mean_block, &down);
}

struct judged {
    struct sight *s;
    bool masked;
};

// The smaller one of both pictures' patterns masks. What is averaged is |sin|, 2 / pi of a
// pattern's amplitude.
static void judge_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct judged *j = context;
    struct sight *s = j->s;
    const size_t first = row * (size_t)s->width;
    for (size_t i = first; i < first + (size_t)s->width; i++) {
        const double difference = (double)s->band[0][i] - (double)s->band[1][i];
        const double masker = j->masked ? 0.5 * PI * fmax((double)s->scratch[i], 0.0) : 0.0;
        s->over[i] = (float)(j->masked ? difference / relume_jnd_threshold(masker) : difference);
    }
}

static void smaller_row(void *context, size_t row, int worker)
{
    (void)worker;
    struct sight *s = context;
    const size_t first = row * (size_t)s->width;
    for (size_t i = first; i < first + (size_t)s->width; i++)
        s->scratch[i] = fminf(fabsf(s->band[0][i]), fabsf(s->band[1][i]));
}

// What is even does not mask, so that the first band has no masker.
void sight_difference(struct sight *s, int band, int direction)
{
    struct judged j = {s, !s->unmasked && band > 0};
    for (int i = 0; i < 2; i++)
        find_band(s, i, band, direction);
    if (j.masked) {
        const double wavelength = s->ppd / exp2(band - 1);
        thread_for(s->threads, (size_t)s->height, smaller_row, s);
        mean_both(s, s->scratch, s->scratch + (size_t)s->width * (size_t)s->height,
                  larger_of(1, (int)(0.5 * wavelength)));
    }
    thread_for(s->threads, (size_t)s->height, judge_row, &j);
}
