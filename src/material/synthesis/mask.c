// mask.c - the regular structure of a texture, as large as is asked for (Meseth 2008, 4.1.3,
// "Fractional Fourier Texture Masks")
#include "material/synthesis/regular.h"
#include "material/synthesis/waves.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <math.h>
#include <string.h>

static void turn_from(double *c, double *s, int count, double from, double step)
{
    for (int i = 0; i < count; i++) {
        c[i] = cos(from + step * i);
        s[i] = sin(from + step * i);
    }
}

void mask_fill(float *out, const struct relume_regular *r, const struct mask_area *a,
               double *scratch)
{
    double *cx = scratch, *sx = cx + a->width, *cy = sx + a->width, *sy = cy + a->height;
    memset(out, 0, (size_t)a->width * (size_t)a->height * MASK_VALUES * sizeof *out);
    for (int i = 0; i < r->info.count; i++) {
        const struct relume_wave *w = &r->wave[i];
        if (w->x == 0.0 && w->y == 0.0)
            continue;
        const double per_x = 2.0 * M_PI * w->x / r->width * a->spacing * a->stretch_x,
                     per_y = 2.0 * M_PI * w->y / r->height * a->spacing * a->stretch_y;
        turn_from(cx, sx, a->width, per_x * a->x, per_x);
        turn_from(cy, sy, a->height, per_y * a->y, per_y);
        for (int y = 0; y < a->height; y++) {
            const double re = (w->re * cy[y] - w->im * sy[y]) / 255.0,
                         im = (w->re * sy[y] + w->im * cy[y]) / 255.0;
            float *to = out + (size_t)y * (size_t)a->width * MASK_VALUES;
            for (int x = 0; x < a->width; x++, to += MASK_VALUES) {
                const double real = re * cx[x] - im * sx[x];
                if (w->channel == 0) {
                    to[0] += (float)real;
                    to[1] += (float)(re * sx[x] + im * cx[x]);
                } else {
                    to[1 + w->channel] += (float)real;
                }
            }
        }
    }
}

float *mask_of_sample(const struct relume_regular *r)
{
    const struct mask_area area = {
        .width = r->width, .height = r->height, .spacing = 1.0, .stretch_x = 1.0, .stretch_y = 1.0};
    float *mask = mem_array((size_t)r->width * (size_t)r->height * MASK_VALUES, sizeof *mask);
    double *scratch = mem_array(2 * (size_t)(r->width + r->height), sizeof *scratch);
    if (mask && scratch)
        mask_fill(mask, r, &area, scratch);
    if (!scratch) {
        mem_free(mask);
        mask = NULL;
    }
    mem_free(scratch);
    return mask;
}

// ---------------------------------------------------------------- pictures

enum { BAND = 64 };

struct picture {
    struct relume_image *image;
    const struct relume_regular *r;
    float *mask;      // [workers][BAND][width][MASK_VALUES]
    double *scratch;  // [workers][2 (width + BAND)]
};

static void draw_band(void *context, size_t item, int worker)
{
    const struct picture *p = context;
    struct relume_image *image = p->image;
    const size_t width = (size_t)image->width, each = BAND * width * MASK_VALUES;
    const int top = (int)item * BAND, left = image->height - top;
    const struct mask_area area = {.y = top,
                                   .width = image->width,
                                   .height = left < BAND ? left : BAND,
                                   .spacing = 1.0,
                                   .stretch_x = 1.0,
                                   .stretch_y = 1.0};
    float *mask = p->mask + (size_t)worker * each;
    float mean[REGULAR_CHANNELS] = {0};
    for (int i = 0; i < p->r->info.count; i++)
        if (p->r->wave[i].x == 0.0 && p->r->wave[i].y == 0.0)
            mean[p->r->wave[i].channel] = (float)(p->r->wave[i].re / 255.0);
    mask_fill(mask, p->r, &area, p->scratch + (size_t)worker * 2 * (width + BAND));
    float *to = image->data + (size_t)top * width * (size_t)image->channels;
    for (size_t i = 0; i < width * (size_t)area.height; i++)
        for (int c = 0; c < image->channels; c++)
            *to++ = mean[c] + mask[i * MASK_VALUES + (c ? (size_t)c + 1 : 0)];
}

relume_status relume_regular_mask(struct relume_image *out, const relume_regular *regular,
                                  int width, int height, int threads)
{
    const size_t workers = (size_t)thread_count(threads);
    struct picture p = {.image = out, .r = regular};
    relume_status status =
        relume_image_create(out, width, height, regular->channels < 3 ? 1 : REGULAR_CHANNELS);
    if (status)
        return status;
    p.mask = mem_array(workers * BAND * (size_t)width * MASK_VALUES, sizeof *p.mask);
    p.scratch = mem_array(workers * 2 * ((size_t)width + BAND), sizeof *p.scratch);
    if (p.mask && p.scratch)
        thread_for(threads, ((size_t)height + BAND - 1) / BAND, draw_band, &p);
    else
        status = RELUME_ENOMEM;
    mem_free(p.mask);
    mem_free(p.scratch);
    if (status)
        relume_image_destroy(out);
    return status;
}
