// luma_chroma.c - EXR pictures of luminance and coarser colour
//
// Kainz, Bogart, Stanczyk: Technical Introduction to OpenEXR (2013). Y is the luminance of the
// picture's primaries, RY = (R - Y) / Y, BY = (B - Y) / Y. Every second row and column has RY and
// BY; what lies between is interpolated by a windowed sinc, which is what writers filter with
// before they leave samples out. Beside a dark edge of coloured light that gives colours that are
// far too pure: saturation is limited by that of the four pixels at the corners.
#include "image/image/luma_chroma.h"

#include "core/base/memory.h"
#include "core/math/vec.h"

#include <string.h>

enum { TAPS = 7, RING = 2 * TAPS + 2, Y = 0, RY, BY };

struct luma_chroma {
    exr_blocks *light, *colour;  // colour is read ahead
    int channel[3];              // Y, RY, BY
    int width, height, rows;     // rows that have colour
    int next, filled;            // the next row of light, and of colour
    vec3 weight;                 // of red, green and blue in Y
    float tap[TAPS];             // of the samples to both sides of a gap
    float *sparse;               // [(width + 1) / 2]
    float *ring;                 // [RING][2][width]: rows of colour, their gaps filled
    float *rgb;                  // [3][width][3]: rows before the limit
    float *y;                    // [width]
};

// ---------------------------------------------------------------- weights

static double bessel_i0(double x)
{
    double sum = 1, term = 1;
    for (int k = 1; k < 40; k++)
        sum += term *= x * x / (4.0 * k * k);
    return sum;
}

// Kaiser's window over 15 pixels to each side, beta = 7.
static void make_taps(float tap[TAPS])
{
    double h[TAPS], sum = 0;
    for (int k = 0; k < TAPS; k++) {
        const double x = M_PI * (k + 0.5), at = (k + 0.5) / 7.5;
        h[k] = sin(x) / x * bessel_i0(7 * sqrt(1 - at * at));
        sum += 2 * h[k];
    }
    for (int k = 0; k < TAPS; k++)
        tap[k] = (float)(h[k] / sum);
}

static vec3 from_xy(const float *xy)
{
    return vec3_of(xy[0] / xy[1], 1, (1 - xy[0] - xy[1]) / xy[1]);
}

// The primaries' shares of a white of luminance 1.
static vec3 luminance_of(const exr_file *file)
{
    static const float bt709[8] = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
    float xy[8];
    if (!exr_get_chromaticities(file, 0, xy))
        memcpy(xy, bt709, sizeof xy);
    const vec3 r = from_xy(xy), g = from_xy(xy + 2), b = from_xy(xy + 4), w = from_xy(xy + 6);
    const vec3 share =
        vec3_scale(vec3_of(vec3_dot(w, vec3_cross(g, b)), vec3_dot(w, vec3_cross(b, r)),
                           vec3_dot(w, vec3_cross(r, g))),
                   1 / vec3_dot(r, vec3_cross(g, b)));
    return share;
}

// ---------------------------------------------------------------- rows of colour

static void fill_gaps(const struct luma_chroma *p, float *out)
{
    const int n = (p->width + 1) / 2;
    for (int x = 0; x < p->width; x++) {
        float sum = 0;
        for (int k = 0; x % 2 && k < TAPS; k++) {
            const int left = x / 2 - k, right = x / 2 + 1 + k;
            sum +=
                p->tap[k] * (p->sparse[left < 0 ? 0 : left] + p->sparse[right < n ? right : n - 1]);
        }
        out[x] = x % 2 ? sum : p->sparse[x / 2];
    }
}

static float *ring_row(const struct luma_chroma *p, int row, int channel)
{
    const size_t at = 2 * (size_t)(row % RING) + (size_t)(channel - RY);
    return p->ring + at * (size_t)p->width;
}

static relume_status read_colour(struct luma_chroma *p, int last)
{
    relume_status status = RELUME_OK;
    for (; !status && p->filled <= last && p->filled < p->rows; p->filled++)
        for (int c = RY; !status && c <= BY; c++) {
            status = exr_blocks_channel(p->colour, 2 * p->filled, p->channel[c], p->sparse);
            if (!status)
                fill_gaps(p, ring_row(p, p->filled, c));
        }
    return status;
}

static float colour_at(const struct luma_chroma *p, int row, int channel, int x)
{
    if (row % 2 == 0)
        return ring_row(p, row / 2, channel)[x];
    float sum = 0;
    for (int k = 0; k < TAPS; k++) {
        const int above = row / 2 - k, below = row / 2 + 1 + k;
        sum += p->tap[k] * (ring_row(p, above < 0 ? 0 : above, channel)[x] +
                            ring_row(p, below < p->rows ? below : p->rows - 1, channel)[x]);
    }
    return sum;
}

// ---------------------------------------------------------------- red, green and blue

static float *rgb_row(const struct luma_chroma *p, int row)
{
    return p->rgb + (size_t)(row % 3) * 3 * (size_t)p->width;
}

static relume_status convert_row(struct luma_chroma *p)
{
    const int row = p->next;
    float *out = rgb_row(p, row);
    relume_status status = read_colour(p, row / 2 + TAPS);
    if (!status)
        status = exr_blocks_channel(p->light, row, p->channel[Y], p->y);
    for (int x = 0; !status && x < p->width; x++, out += 3) {
        const float y = p->y[x];
        const float r = (1 + colour_at(p, row, RY, x)) * y, b = (1 + colour_at(p, row, BY, x)) * y;
        out[0] = r;
        out[1] = (float)((y - p->weight.x * r - p->weight.z * b) / p->weight.y);
        out[2] = b;
    }
    p->next++;
    return status;
}

static float saturation(const float *c)
{
    const float most = fmaxf(c[0], fmaxf(c[1], c[2])), least = fminf(c[0], fminf(c[1], c[2]));
    return most > 0 ? 1 - least / most : 0;
}

static float luminance(const struct luma_chroma *p, const float *c)
{
    return (float)(p->weight.x * c[0] + p->weight.y * c[1] + p->weight.z * c[2]);
}

// Towards grey, as bright as before.
static void desaturate(const struct luma_chroma *p, float *c, float part)
{
    const float most = fmaxf(c[0], fmaxf(c[1], c[2])), before = luminance(p, c);
    for (int i = 0; i < 3; i++)
        c[i] = fmaxf(most - (most - c[i]) * part, 0);
    const float after = luminance(p, c);
    for (int i = 0; i < 3 && after > 0; i++)
        c[i] *= before / after;
}

static void limit_row(const struct luma_chroma *p, int row, float *out)
{
    const int last = p->width - 1;
    const float *above = rgb_row(p, row ? row - 1 : 0);
    const float *below = rgb_row(p, row + 1 < p->height ? row + 1 : row);
    memcpy(out, rgb_row(p, row), 3 * (size_t)p->width * sizeof *out);
    for (int x = 0; x <= last; x++, out += 3) {
        const int left = 3 * (x ? x - 1 : 0), right = 3 * (x < last ? x + 1 : last);
        const float corners = saturation(above + left) + saturation(above + right) +
                              saturation(below + left) + saturation(below + right);
        const float most = 1 - (1 - fminf(corners / 4, 1)) / 4, s = saturation(out);
        if (s > most)
            desaturate(p, out, most / s);
    }
}

relume_status luma_chroma_next(luma_chroma *p, float *rgb)
{
    const int row = p->next ? p->next - 1 : 0;
    relume_status status = p->next ? RELUME_OK : convert_row(p);
    if (!status && p->next < p->height)
        status = convert_row(p);
    else
        p->next++;
    if (!status)
        limit_row(p, row, rgb);
    return status;
}

// ---------------------------------------------------------------- opening

// Y at every pixel, RY and BY at every second; perhaps with A. OpenEXR's C core 3.1 takes sound
// files of coarser channels by DWA for damaged, and small ones by B44 for others.
static bool find_channels(int channel[3], const exr_file *file)
{
    static const char *const names[] = {[Y] = "Y", [RY] = "RY", [BY] = "BY"};
    const struct exr_part_info info = exr_part_info(file, 0);
    int found = 0;
    for (int i = 0; i < info.channels; i++)
        for (int c = Y; c <= BY; c++)
            if (!strcmp(exr_channel_name(file, 0, i), names[c]) &&
                exr_channel_step(file, 0, i) == (c == Y ? 1 : 2)) {
                channel[c] = i;
                found |= 1 << c;
            }
    return found == 7 && exr_part_count(file) == 1 && strcmp(info.codec, "other") &&
           info.x % 2 == 0 && info.y % 2 == 0;
}

static bool create(struct luma_chroma *p, const exr_file *file)
{
    const struct exr_part_info info = exr_part_info(file, 0);
    const size_t width = (size_t)info.width;
    p->width = info.width;
    p->height = info.height;
    p->rows = (info.height + 1) / 2;
    p->weight = luminance_of(file);
    make_taps(p->tap);
    p->sparse = mem_array((width + 1) / 2, sizeof *p->sparse);
    p->ring = mem_array(RING * 2 * width, sizeof *p->ring);
    p->rgb = mem_array(9 * width, sizeof *p->rgb);
    p->y = mem_array(width, sizeof *p->y);
    return p->sparse && p->ring && p->rgb && p->y;
}

relume_status luma_chroma_open(luma_chroma **out, const exr_file *file)
{
    int channel[3];
    *out = NULL;
    if (!find_channels(channel, file))
        return RELUME_OK;
    struct luma_chroma *p = *out = mem_zeroed(1, sizeof *p);
    relume_status status = p && create(p, file) ? RELUME_OK : RELUME_ENOMEM;
    if (p)
        memcpy(p->channel, channel, sizeof channel);
    if (!status)
        status = exr_blocks_open(&p->light, file, 0);
    if (!status)
        status = exr_blocks_open(&p->colour, file, 0);
    if (status)
        luma_chroma_close(out);
    return status;
}

void luma_chroma_close(luma_chroma **picture)
{
    struct luma_chroma *p = *picture;
    if (!p)
        return;
    exr_blocks_close(&p->light);
    exr_blocks_close(&p->colour);
    mem_free(p->sparse);
    mem_free(p->ring);
    mem_free(p->rgb);
    mem_free(p->y);
    mem_free(p);
    *picture = NULL;
}
