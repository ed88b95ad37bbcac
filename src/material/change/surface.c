// surface.c - photometric stereo by all lights, and by each of two halves of them
//
// A half is a draw of the lights as another capture would be: what halves differ in has all that
// lights bring in, noise, shadows and highlights alike. Two means of n/2 samples differ by twice
// the deviation that a mean of n has, so half of the difference has the size of the noise.
//
// Gloss is what highlights add to the matte surface, by least squares along a broad lobe around the
// mirror direction, cos^16 of the angle between normal and half vector: the same for all captures,
// so that lamps at other places see about the same of it, and a sharper highlight is less.
#include "material/change/surface.h"

#include "capture/manifest/near_view.h"
#include "capture/manifest/reflectance_table.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/lambert.h"
#include "core/math/luminance.h"
#include "core/math/random.h"

#include <math.h>

enum { LEAST = 4, LEAST_HALVED = 8, PARTS = 3, TRIES = 50 };
static const size_t band_bytes = (size_t)64 << 20;
static const float clipped = 0.995f;  // of the largest value
static const double least_lobe =
    0.25;  // of the squares of the lobe that some lamps see: 12 degrees

struct fit {
    struct surface *out;
    const relume_capture *capture;
    int lights, width, rows, row;
    bool is_near;
    struct near_view near;
    const vec3 *distant;
    unsigned char *half;  // [lights]: 0 or 1
    bool halved;
    double spread;  // of a normal's component, for samples of deviation 1: sqrt(tr (L'L)^-1 / 3)
    float (*white)[3];
    float *samples;  // [lights][rows][width][3]
    struct relume_image mask;
    struct lambert_sample *scratch;  // [workers][lights]
    vec3 *towards;                   // [workers][lights]
    float *gain;                     // [workers][lights]
};

struct pixel {
    struct lambert_sample *sample;
    vec3 *direction;
    float *gain;
    size_t at, of_view;
};

// What some of the lights say of a pixel.
struct found {
    vec3 normal;
    float colour[3];
    double miss;  // RMS of the residuals over the albedo
    double gloss, lobe;
};

void colour_code(float code[3], const float linear[3])
{
    const float r = cbrtf(fmaxf(linear[0], 0.0f)), g = cbrtf(fmaxf(linear[1], 0.0f)),
                b = cbrtf(fmaxf(linear[2], 0.0f));
    code[0] = (r + g + b) / 3.0f;
    code[1] = r - g;
    code[2] = 0.5f * (r + g) - b;
}

void colour_linear(float linear[3], const float code[3])
{
    const float b = code[0] - code[2] * 2.0f / 3.0f, r = b + code[2] + 0.5f * code[1],
                g = b + code[2] - 0.5f * code[1];
    linear[0] = r * r * r, linear[1] = g * g * g, linear[2] = b * b * b;
    for (int c = 0; c < 3; c++)
        linear[c] = fmaxf(linear[c], 0.0f);
}

static const float *sample_of(const struct fit *f, int light, size_t at)
{
    return f->samples + 3 * ((size_t)light * (size_t)f->rows * (size_t)f->width + at);
}

static bool is_clipped(const struct fit *f, const struct pixel *p, int light)
{
    const float *rgb = sample_of(f, light, p->at), *white = f->white[light];
    const float most = clipped * p->gain[light];
    return rgb[0] >= most * white[0] || rgb[1] >= most * white[1] || rgb[2] >= most * white[2];
}

// Of half 0, 1 or (2) all lights; what clips is left out unless too little remains.
static int gather(const struct fit *f, const struct pixel *p, int part)
{
    int n = 0;
    for (int keep = 0; keep < 2 && n < LEAST; keep++) {
        n = 0;
        for (int i = 0; i < f->lights; i++)
            if ((part == 2 || f->half[i] == part) && (keep || !is_clipped(f, p, i)))
                p->sample[n++] =
                    (struct lambert_sample){luminance_709f(sample_of(f, i, p->at)), 1.0f, i};
    }
    return n;
}

// What the lamps of a part see over the matte surface `g`, those that clip too.
static void find_gloss(struct found *out, const struct fit *f, const struct pixel *p, int part,
                       vec3 g)
{
    double sum = 0.0;
    out->lobe = 0.0;
    for (int i = 0; i < f->lights; i++) {
        const vec3 l = p->direction[i], half = vec3_unit(vec3_add(l, vec3_of(0.0, 0.0, 1.0)));
        const double c = vec3_dot(out->normal, half);
        if ((part != 2 && f->half[i] != part) || !(c > 0.0) ||
            vec3_dot(out->normal, l) <= LAMBERT_GRAZING)
            continue;
        const double c4 = c * c * c * c, lobe = c4 * c4 * c4 * c4;
        const double over = (double)luminance_709f(sample_of(f, i, p->at)) - vec3_dot(g, l);
        sum += lobe * over;
        out->lobe += lobe * lobe;
    }
    out->gloss = out->lobe > 0.0 ? sum / out->lobe : 0.0;
}

static bool find(struct found *out, const struct fit *f, const struct pixel *p, int part)
{
    vec3 g;
    int n = gather(f, p, part);
    const struct lambert_sample *s = lambert_fit(&g, p->direction, p->sample, &n, false);
    if (!s)
        return false;
    out->normal = vec3_unit(g);
    double sum[3] = {0}, norm = 0.0, miss = 0.0, weight = 0.0;
    for (int i = 0; i < n; i++) {
        const float *rgb = sample_of(f, s[i].light, p->at);
        const double w = (double)s[i].weight;
        const double cosine = vec3_dot(out->normal, p->direction[s[i].light]);
        const double d = (double)s[i].value - vec3_dot(g, p->direction[s[i].light]);
        miss += w * d * d, weight += w;
        if (cosine <= LAMBERT_GRAZING)
            continue;
        norm += w * cosine * cosine;
        for (int c = 0; c < 3; c++)
            sum[c] += w * cosine * (double)rgb[c];
    }
    float albedo[3];
    for (int c = 0; c < 3; c++)
        albedo[c] = norm > 0.0 ? (float)(sum[c] / norm) : 0.0f;
    colour_code(out->colour, albedo);
    out->miss = weight > 0.0 ? sqrt(miss / weight) / vec3_length(g) : 0.0;
    find_gloss(out, f, p, part, g);
    return true;
}

static void set_lights(const struct fit *f, const struct pixel *p)
{
    const size_t width = (size_t)f->width;
    vec3 point = {0, 0, 0};
    if (f->is_near)
        point = near_view_pixel(&f->near, (int)(p->of_view % width), (int)(p->of_view / width));
    for (int i = 0; i < f->lights; i++) {
        double gain = 1.0;
        p->direction[i] =
            f->is_near ? near_view_direction(&gain, &f->near, i, point) : f->distant[i];
        p->gain[i] = (float)gain;
    }
}

// Without halves: of the size that residuals of independent samples would make, with signs that
// change from pixel to pixel as those of noise do.
static void set_noise(float normal[3], float colour[3], const struct fit *f, const struct pixel *p,
                      const struct found all[PARTS])
{
    if (f->halved) {
        vec3_store(normal, vec3_scale(vec3_sub(all[0].normal, all[1].normal), 0.5));
        for (int c = 0; c < 3; c++)
            colour[c] = 0.5f * (all[0].colour[c] - all[1].colour[c]);
        return;
    }
    struct random draw = random_stream(1, p->of_view, 0);
    const double size = f->spread * all[2].miss;
    for (int c = 0; c < 3; c++) {
        normal[c] = (float)(random_next(&draw) < 0.5 ? -size : size);
        colour[c] = (float)((random_next(&draw) < 0.5 ? -size : size) / 3.0) * all[2].colour[0];
    }
}

static void fit_pixel(struct fit *f, const struct pixel *p)
{
    struct found found[PARTS];
    set_lights(f, p);
    for (int part = f->halved ? 0 : 2; part < PARTS; part++)
        if (!find(&found[part], f, p, part))
            return;
    const size_t at = 3 * p->of_view;
    vec3_store(f->out->normal.data + at, found[2].normal);
    for (size_t c = 0; c < 3; c++)
        f->out->colour.data[at + c] = found[2].colour[c];
    if (f->halved && found[0].lobe >= least_lobe && found[1].lobe >= least_lobe) {
        f->out->gloss.data[at] = (float)found[2].gloss;
        f->out->gloss.data[at + 1] = 1.0f;
        f->out->gloss_noise.data[at] = (float)(0.5 * (found[0].gloss - found[1].gloss));
    }
    set_noise(f->out->normal_noise.data + at, f->out->colour_noise.data + at, f, p, found);
}

static void fit_row(void *context, size_t item, int worker)
{
    struct fit *f = context;
    const size_t first = (size_t)worker * (size_t)f->lights, width = (size_t)f->width;
    struct pixel p = {f->scratch + first, f->towards + first, f->gain + first, 0, 0};
    for (size_t x = 0; x < width; x++) {
        p.at = item * width + x;
        p.of_view = (size_t)f->row * width + p.at;
        if (!f->mask.data || f->mask.data[p.of_view] > 0.5f)
            fit_pixel(f, &p);
    }
}

static relume_status fit_bands(struct fit *f, int view, int threads, const struct relume_log *log)
{
    relume_table *table;
    const int most = f->rows, height = f->out->height;
    relume_status status =
        relume_table_open(&table, f->capture, view,
                          relume_table_params(.keep_near = true, .log = log, .threads = threads));
    for (f->row = 0; !status && f->row < height; f->row += f->rows) {
        f->rows = height - f->row < most ? height - f->row : most;
        status = relume_table_read(table, f->rows, f->samples);
        if (!status)
            thread_for(threads, (size_t)f->rows, fit_row, f);
        if (!status && !log_progress(log, "normals", (f->row + f->rows) / (double)height))
            status = RELUME_ECANCEL;
    }
    relume_table_destroy(&table);
    return status;
}

// ---------------------------------------------------------------- halves

static void draw_half(unsigned char *half, int lights, uint64_t seed)
{
    struct random draw = random_stream(seed, (uint64_t)lights, 0);
    for (int i = 0; i < lights; i++)
        half[i] = i < lights / 2;
    for (int i = lights - 1; i > 0; i--) {
        const int k = (int)random_range(&draw, 0.0, i + 1.0);
        const unsigned char t = half[i];
        half[i] = half[k], half[k] = t;
    }
}

// The length of the mean direction: near 1 where lights stand together.
static double lean(const struct fit *f, int part)
{
    vec3 sum = {0, 0, 0};
    int n = 0;
    for (int i = 0; i < f->lights; i++)
        if (f->half[i] == part) {
            sum = vec3_add(sum, vec3_of(f->distant[i].x, f->distant[i].y, 0.0));
            n++;
        }
    return vec3_length(sum) / n;
}

static bool half_spans(const struct fit *f, int part)
{
    int n = 0;
    for (int i = 0; i < f->lights; i++)
        if (f->half[i] == part)
            f->towards[n++] = f->distant[i];
    return lambert_spans(f->towards, n);
}

// Of some draws the one whose halves stand around the object most evenly.
static void choose_halves(struct fit *f)
{
    uint64_t best = 0;
    double least = INFINITY;
    f->halved = f->lights >= LEAST_HALVED;
    for (uint64_t seed = 0; f->halved && seed < TRIES; seed++) {
        draw_half(f->half, f->lights, seed);
        const double uneven = fmax(lean(f, 0), lean(f, 1));
        if (uneven < least)
            least = uneven, best = seed;
    }
    draw_half(f->half, f->lights, best);
    f->halved = f->halved && half_spans(f, 0) && half_spans(f, 1);
}

static double spread_of(const vec3 *l, int n)
{
    double xx = 0, yy = 0;
    for (int i = 0; i < n; i++)
        xx += l[i].x * l[i].x, yy += l[i].y * l[i].y;
    return sqrt(0.5 / fmax(xx, 1e-6) + 0.5 / fmax(yy, 1e-6));
}

// ---------------------------------------------------------------- the whole

static relume_status alloc(struct fit *f, int threads)
{
    const size_t lights = (size_t)f->lights, workers = (size_t)threads;
    const size_t fitting = band_bytes / ((size_t)f->width * lights * 3 * sizeof(float));
    struct relume_image *const of[] = {&f->out->normal,       &f->out->colour,
                                       &f->out->gloss,        &f->out->normal_noise,
                                       &f->out->colour_noise, &f->out->gloss_noise};
    f->rows = fitting < 1 ? 1 : fitting < (size_t)f->out->height ? (int)fitting : f->out->height;
    f->samples = mem_array(3 * lights * (size_t)f->rows * (size_t)f->width, sizeof *f->samples);
    f->white = mem_array(lights, sizeof *f->white);
    f->half = mem_zeroed(lights, 1);
    f->scratch = mem_array(workers * lights, sizeof *f->scratch);
    f->towards = mem_array(workers * lights, sizeof *f->towards);
    f->gain = mem_array(workers * lights, sizeof *f->gain);
    if (!f->samples || !f->white || !f->half || !f->scratch || !f->towards || !f->gain)
        return RELUME_ENOMEM;
    for (int i = 0; i < f->lights; i++)
        relume_capture_white(f->capture, i, f->white[i]);
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && i < sizeof of / sizeof *of; i++)
        status = relume_image_create(of[i], f->width, f->out->height, 3);
    return status;
}

static void release(struct fit *f)
{
    mem_free(f->samples);
    mem_free(f->white);
    mem_free(f->half);
    mem_free(f->scratch);
    mem_free(f->towards);
    mem_free(f->gain);
    near_view_close(&f->near);
    relume_image_destroy(&f->mask);
}

void surface_free(struct surface *s)
{
    relume_image_destroy(&s->normal);
    relume_image_destroy(&s->colour);
    relume_image_destroy(&s->normal_noise);
    relume_image_destroy(&s->colour_noise);
    relume_image_destroy(&s->gloss);
    relume_image_destroy(&s->gloss_noise);
    *s = (struct surface){0};
}

relume_status surface_fit(struct surface *out, const relume_capture *capture, int view, int threads,
                          const struct relume_log *log)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    struct fit f = {.out = out, .capture = capture, .lights = m->lights, .distant = m->directions};
    *out = (struct surface){.width = relume_capture_width(capture),
                            .height = relume_capture_height(capture)};
    f.width = out->width;
    if (view < 0 || view >= m->views)
        return log_fail(log, RELUME_EINVAL, "view %d does not exist; expected 0 to %d", view,
                        m->views - 1);
    if (m->lights < LEAST || !lambert_spans(m->directions, m->lights))
        return log_fail(log, RELUME_EUNFIT,
                        "the surface cannot be computed; expected %d lights or more that do not "
                        "lie in one plane; found %d",
                        LEAST, m->lights);
    f.is_near = near_view_applies(capture, view);
    relume_status status = relume_capture_mask(&f.mask, capture, view, log);
    if (!status && f.is_near)
        status = near_view_open(&f.near, capture, view, log);
    if (!status)
        status = alloc(&f, threads);
    if (!status) {
        choose_halves(&f);
        f.spread = spread_of(m->directions, m->lights);
        status = fit_bands(&f, view, threads, log);
    }
    release(&f);
    if (status)
        surface_free(out);
    return status;
}
