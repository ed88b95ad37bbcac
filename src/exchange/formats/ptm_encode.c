// ptm_encode.c - the JPEG forms of .ptm: planes as JPEGs, predicted from each other, and mended
//
// A unit of a term's code changes the picture by the term's scale times what the term is on average
// over the hemisphere; steps are chosen so that a step of any plane changes the picture alike. A
// plane is predicted from what readers decode of another one, not from what it was, so errors do
// not add up. Where the sum with the reference would leave a byte, or where JPEG is so far off
// that 40 bits are a good price for the pixel, a record of the side information gives its value.
#include "exchange/formats/ptm.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "exchange/formats/ptm_tree.h"
#include "exchange/formats/sheet.h"
#include "image/image/jpeg.h"
#include "image/image/trellis.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { COLOURS = 3, WEIGHT_PIXELS = 1 << 16 };

// Means of the products of two terms (1 x y x2 xy y2) over the directions of the hemisphere.
static const double moment[PTM_TERMS][PTM_TERMS] = {
    {1.0, 0.0, 0.0, 1.0 / 3, 0.0, 1.0 / 3}, {0.0, 1.0 / 3, 0.0, 0.0, 0.0, 0.0},
    {0.0, 0.0, 1.0 / 3, 0.0, 0.0, 0.0},     {1.0 / 3, 0.0, 0.0, 1.0 / 5, 0.0, 1.0 / 15},
    {0.0, 0.0, 0.0, 0.0, 1.0 / 15, 0.0},    {1.0 / 3, 0.0, 0.0, 1.0 / 15, 0.0, 1.0 / 5},
};

struct plane {
    uint8_t *bytes, *side;
    size_t size, records;
    relume_status status;
};

struct coder {
    const struct foreign *f;
    struct foreign decoded;  // the codes that readers see
    bool luminance;
    int step[PTM_MOST_PLANES];
    struct ptm_tree tree;
    struct plane plane[PTM_MOST_PLANES];
    int batch[PTM_MOST_PLANES];  // planes that are coded at once
};

// ---------------------------------------------------------------- steps

// Means over the pixels: of the squared luminance over the hemisphere, of the squared colour.
static void mean_squares(const struct foreign *f, double *luminance, double *colour)
{
    const size_t pixels = foreign_pixels(f), every = pixels / WEIGHT_PIXELS + 1;
    double count = 0.0;
    *luminance = *colour = 0.0;
    for (size_t i = 0; i < pixels; i += every, count += 1.0) {
        double term[PTM_TERMS];
        for (int k = 0; k < PTM_TERMS; k++)
            term[k] = foreign_coefficient(f, k, i);
        for (int k = 0; k < PTM_TERMS; k++)
            for (int m = 0; m < PTM_TERMS; m++)
                *luminance += term[k] * term[m] * moment[k][m];
        for (int c = 0; c < COLOURS; c++)
            *colour +=
                foreign_coefficient(f, PTM_TERMS + c, i) * foreign_coefficient(f, PTM_TERMS + c, i);
    }
    *luminance /= count;
    *colour /= count;
}

// `step`: of the picture's error, summed over the channels.
static void choose_steps(struct coder *c, double step)
{
    const struct foreign *f = c->f;
    double luminance = 1.0, colour = 1.0;
    if (c->luminance)
        mean_squares(f, &luminance, &colour);
    for (int i = 0; i < f->planes; i++) {
        const int p = ptm_plane(c->luminance, i);
        const int term = c->luminance ? p : p / COLOURS;
        const double energy =
            term < PTM_TERMS ? moment[term][term] * colour : luminance;  // of a unit's error
        const double codes = step / (fabs((double)f->scale[p]) * sqrt(energy));
        c->step[i] = (int)fmin(fmax(rint(codes), 1.0), 255.0);
    }
}

// ---------------------------------------------------------------- a plane

// The code that a residual is added to.
static int predicted(const struct coder *c, int i, const uint8_t *reference, int x)
{
    if (!reference)
        return 128;
    return c->tree.inverted[i] ? 255 - reference[x] : reference[x];
}

static const uint8_t *reference_row(const struct coder *c, int i, int y)
{
    const int r = c->tree.reference[i];
    return r < 0 ? NULL : ptm_row(&c->decoded, ptm_plane(c->luminance, r), y);
}

// What the JPEG holds, around zero.
static void find_residual(const struct coder *c, int i, float *out)
{
    const int plane = ptm_plane(c->luminance, i);
    for (int y = 0; y < c->f->height; y++) {
        const uint8_t *want = ptm_row(c->f, plane, y), *reference = reference_row(c, i, y);
        for (int x = 0; x < c->f->width; x++) {
            const int apart = want[x] - predicted(c, i, reference, x);
            *out++ = (float)(apart < -128 ? -128 : apart > 127 ? 127 : apart);
        }
    }
}

static bool add_record(struct plane *p, size_t pixel, uint8_t code)
{
    if (!mem_grow(&p->side, p->records, PTM_RECORD))
        return false;
    uint8_t *to = p->side + p->records++ * PTM_RECORD;
    for (int k = 0; k < 4; k++)
        to[k] = (uint8_t)(pixel >> (24 - 8 * k));
    to[4] = code;
    return true;
}

// What readers decode, and the records that mend it.
static bool mend(struct coder *c, int i, const uint8_t *jpeg)
{
    const int plane = ptm_plane(c->luminance, i), width = c->f->width;
    const double most = PTM_RECORD_BITS * SHEET_LAMBDA * c->step[i] * c->step[i];
    for (int y = 0; y < c->f->height; y++) {
        const uint8_t *want = ptm_row(c->f, plane, y), *reference = reference_row(c, i, y);
        uint8_t *out = ptm_row(&c->decoded, plane, y);
        for (int x = 0; x < width; x++) {
            const int sum =
                jpeg[(size_t)y * (size_t)width + (size_t)x] - 128 + predicted(c, i, reference, x);
            const double off = want[x] - sum;
            const bool record = sum < 0 || sum > 255 || off * off > most;
            out[x] = record ? want[x] : (uint8_t)sum;
            const size_t pixel = (size_t)y * (size_t)width + (size_t)x;
            if (record && !add_record(&c->plane[i], pixel, want[x]))
                return false;
        }
    }
    return true;
}

static relume_status compress(struct coder *c, int i, const float *residual)
{
    const int width = c->f->width, height = c->f->height;
    const size_t blocks = trellis_blocks(width, height);
    float *dct = mem_array(64 * blocks, sizeof *dct);
    int16_t *codes = mem_array(64 * blocks, sizeof *codes);
    const struct jpeg_picture picture = {.width = width,
                                         .height = height,
                                         .planes = 1,
                                         .baseline = true,
                                         .step = {c->step[i]},
                                         .coefficients = {codes}};
    relume_status status = dct && codes ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        trellis_transform(residual, width, height, dct);
        trellis_quantise(dct, blocks, c->step[i], SHEET_LAMBDA, codes);
        status = jpeg_encode(&c->plane[i].bytes, &c->plane[i].size, &picture);
    }
    mem_free(dct);
    mem_free(codes);
    return status;
}

static void code_plane(void *context, size_t item, int worker)
{
    (void)worker;
    struct coder *c = context;
    const int i = c->batch[item];
    struct jpeg_codes back = {0};
    float *residual = mem_array(foreign_pixels(c->f), sizeof *residual);
    relume_status status = residual ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        find_residual(c, i, residual);
        status = compress(c, i, residual);
    }
    mem_free(residual);
    if (!status)
        status =
            jpeg_decode(&back, c->plane[i].bytes, c->plane[i].size, "plane of a .ptm", NULL, NULL);
    if (!status && !mend(c, i, back.data))
        status = RELUME_ENOMEM;
    jpeg_codes_free(&back);
    c->plane[i].status = status;
}

static relume_status code_planes(struct coder *c, int threads)
{
    for (int depth = 0, left = c->f->planes; left > 0; depth++) {
        size_t n = 0;
        for (int i = 0; i < c->f->planes; i++)
            if (c->tree.depth[i] == depth)
                c->batch[n++] = i;
        thread_for(threads, n, code_plane, c);
        left -= (int)n;
        for (size_t k = 0; k < n; k++)
            if (c->plane[c->batch[k]].status)
                return c->plane[c->batch[k]].status;
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- the file

static long field_of(const struct coder *c, enum ptm_field field, int i)
{
    switch (field) {
    case PTM_TRANSFORM: return c->tree.inverted[i] ? PTM_INVERTED : PTM_AS_IT_IS;
    case PTM_ORDER: return c->tree.turn[i];
    case PTM_REFERENCE: return c->tree.reference[i];
    case PTM_BYTES: return (long)c->plane[i].size;
    case PTM_SIDE_BYTES: return (long)(c->plane[i].records * PTM_RECORD);
    default: return 0;
    }
}

static void print_file(const struct coder *c, int quality, FILE *out)
{
    ptm_print_header(c->f, true, out);
    fprintf(out, "%d\n", quality);
    for (enum ptm_field field = 0; field < PTM_FIELDS; field++) {
        for (int i = 0; i < c->f->planes; i++)
            fprintf(out, "%ld ", field_of(c, field, i));
        fputs("\n", out);
    }
    for (int i = 0; i < c->f->planes; i++) {
        const struct plane *p = &c->plane[i];
        fwrite(p->bytes, 1, p->size, out);
        if (p->records)
            fwrite(p->side, PTM_RECORD, p->records, out);
    }
}

static relume_status gather_file(struct ptm_jpeg *out, const struct coder *c, int quality)
{
    FILE *f = open_memstream((char **)&out->bytes, &out->size);
    if (!f)
        return RELUME_ENOMEM;
    print_file(c, quality, f);
    const bool failed = ferror(f) != 0;
    return fclose(f) || failed ? RELUME_ENOMEM : RELUME_OK;
}

relume_status ptm_encode_jpeg(struct ptm_jpeg *out, const struct foreign *f, double step,
                              int quality, int threads)
{
    *out = (struct ptm_jpeg){0};
    struct coder *c = mem_zeroed(1, sizeof *c);
    relume_status status = c ? RELUME_OK : RELUME_ENOMEM;
    out->codes = mem_array((size_t)f->planes, foreign_pixels(f));
    if (!out->codes)
        status = RELUME_ENOMEM;
    if (!status) {
        *c = (struct coder){.f = f, .decoded = *f, .luminance = f->form == FOREIGN_LUMINANCE};
        c->decoded.codes = out->codes;
        choose_steps(c, step);
        status = ptm_tree_grow(&c->tree, f, c->step);
    }
    if (!status)
        status = code_planes(c, threads);
    if (!status)
        status = gather_file(out, c, quality);
    for (int i = 0; c && i < f->planes; i++) {
        out->predicted += c->tree.reference[i] >= 0;
        out->inverted += c->tree.inverted[i];
        out->records += c->plane[i].records;
        mem_free(c->plane[i].bytes);
        mem_free(c->plane[i].side);
    }
    mem_free(c);
    if (status)
        ptm_jpeg_free(out);
    return status;
}

void ptm_jpeg_free(struct ptm_jpeg *file)
{
    mem_free_libc(file->bytes);
    mem_free(file->codes);
    *file = (struct ptm_jpeg){0};
}
