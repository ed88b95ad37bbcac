// on_maps.c - the operations on maps, each pixel by the mask's share
#include "material/gbrdf/on_maps.h"

#include "core/base/log.h"
#include "core/math/bilinear.h"
#include "core/math/vec.h"
#include "material/gbrdf/drawing.h"
#include "material/maps/maps.h"

#include <string.h>

static size_t pixels_of(const struct relume_maps *m)
{
    return (size_t)m->width * (size_t)m->height;
}

static float mixed(float a, double b, float share)
{
    return (float)((double)a + (b - (double)a) * (double)share);
}

static float mixed_share(float a, double b, float share)
{
    return fminf(fmaxf(mixed(a, b, share), 0.0f), 1.0f);
}

// ---------------------------------------------------------------- relief

static double slope(const float *z, int i, int n, size_t stride)
{
    const int before = index_clamped(i - 1, n), after = index_clamped(i + 1, n);
    return after > before
               ? (double)(z[(size_t)after * stride] - z[(size_t)before * stride]) / (after - before)
               : 0.0;
}

// Steeper normals have no slope that numbers hold.
static const double LEAST_Z = 0.02;

static void lean(float *n, double across, double up)
{
    const double z = fmax((double)n[2], LEAST_Z);
    const vec3 made = vec3_unit(vec3_of((double)n[0] / z - across, (double)n[1] / z - up, 1.0));
    n[0] = (float)made.x;
    n[1] = (float)made.y;
    n[2] = (float)made.z;
}

static void lean_all(struct relume_maps *m, const struct relume_image *relief)
{
    const size_t width = (size_t)m->width;
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width; x++) {
            float *n = m->normal.data + 3 * ((size_t)y * width + (size_t)x);
            if (n[0] != 0.0f || n[1] != 0.0f || n[2] != 0.0f)
                lean(n, slope(relief->data + (size_t)y * width, x, m->width, 1),
                     -slope(relief->data + x, y, m->height, width));
        }
}

// The measured normals keep what heights do not show: only the drawing's slopes are added.
static relume_status add_relief(struct relume_maps *m, const struct relume_edit *e, double sign,
                                int threads, const struct relume_log *log)
{
    struct relume_image relief, occlusion = {.width = 0};
    double mean = 0.0;
    relume_status status = drawing_lay(&relief, e, m->width, m->height, false, log);
    for (size_t i = 0; !status && i < pixels_of(m); i++) {
        relief.data[i] *= (float)(sign * e->height * m->width);  // pixels
        mean += (double)relief.data[i] / (double)pixels_of(m);
    }
    for (size_t i = 0; !status && i < pixels_of(m); i++)
        m->height_map.data[i] += (float)(((double)relief.data[i] - mean) * m->pixel);
    if (!status)
        lean_all(m, &relief);
    relume_image_destroy(&relief);
    if (!status)
        status = relume_height_occlusion(&occlusion, &m->height_map, m->pixel, threads);
    if (!status) {
        relume_image_destroy(&m->occlusion);
        m->occlusion = occlusion;
    }
    return status;
}

relume_status maps_emboss(struct relume_maps *maps, const struct relume_edit *edit, int threads,
                          const struct relume_log *log)
{
    return add_relief(maps, edit, 1.0, threads, log);
}

relume_status maps_engrave(struct relume_maps *maps, const struct relume_edit *edit, int threads,
                           const struct relume_log *log)
{
    return add_relief(maps, edit, -1.0, threads, log);
}

// ---------------------------------------------------------------- colour and gloss

// Change every pixel by the mask's share.
static relume_status each_pixel(struct relume_maps *m, const struct relume_edit *e,
                                const struct relume_log *log,
                                void (*change)(struct relume_maps *m, size_t at, float share,
                                               const struct relume_edit *e))
{
    struct relume_image mask;
    if (e->label >= 0)
        return log_fail(log, RELUME_EUNFIT,
                        "maps have no labels of materials; expected a mask in place of label %d",
                        e->label);
    relume_status status = mask_lay(&mask, e, m->width, m->height);
    float most = 0.0f;
    for (size_t i = 0; !status && i < pixels_of(m); i++)
        most = fmaxf(most, mask.data[i]);
    if (!status && most == 0.0f)
        status = log_fail(log, RELUME_EUNFIT, "the mask is black; expected white somewhere");
    for (size_t i = 0; !status && i < pixels_of(m); i++)
        change(m, i, fminf(fmaxf(mask.data[i], 0.0f), 1.0f), e);
    relume_image_destroy(&mask);
    return status;
}

static void roughen(struct relume_maps *m, size_t at, float share, const struct relume_edit *e)
{
    float *roughness = &m->roughness.data[at];
    *roughness = mixed_share(*roughness, (double)*roughness * e->factor, share);
}

static void tint(struct relume_maps *m, size_t at, float share, const struct relume_edit *e)
{
    float *colour = m->base_color.data + 3 * at, *specular = m->specular.data + 3 * at;
    for (int c = 0; c < 3; c++) {
        colour[c] = mixed_share(colour[c], (double)colour[c] * e->factors[c], share);
        if (m->metallic.data[at] > 0.5f)
            specular[c] = mixed_share(specular[c], (double)specular[c] * e->factors[c], share);
    }
}

static void exchange(struct relume_maps *m, size_t at, float share, const struct relume_edit *e)
{
    float *of[] = {m->base_color.data + 3 * at, m->specular.data + 3 * at};
    for (int k = 0; k < 2; k++) {
        const float old[3] = {of[k][0], of[k][1], of[k][2]};
        for (int c = 0; c < 3; c++)
            of[k][c] = mixed(old[c], (double)old[strchr("RGB", e->channels[c]) - "RGB"], share);
    }
}

static void lay_on(struct relume_maps *m, size_t at, float share, const struct relume_edit *e)
{
    float *colour = m->base_color.data + 3 * at, *specular = m->specular.data + 3 * at;
    m->roughness.data[at] = mixed(m->roughness.data[at], e->roughness, share);
    for (int c = 0; c < 3; c++) {
        specular[c] = mixed(specular[c], e->r0 * e->highlight[c], share);
        if (!isnan(e->colour[0]))
            colour[c] = mixed(colour[c], e->colour[c], share);
    }
    if (share >= 0.5f)
        m->metallic.data[at] = 0.0f;
}

relume_status maps_roughness(struct relume_maps *maps, const struct relume_edit *edit, int threads,
                             const struct relume_log *log)
{
    (void)threads;
    return each_pixel(maps, edit, log, roughen);
}

relume_status maps_tint(struct relume_maps *maps, const struct relume_edit *edit, int threads,
                        const struct relume_log *log)
{
    (void)threads;
    return each_pixel(maps, edit, log, tint);
}

relume_status maps_channels(struct relume_maps *maps, const struct relume_edit *edit, int threads,
                            const struct relume_log *log)
{
    (void)threads;
    return each_pixel(maps, edit, log, exchange);
}

relume_status maps_add_material(struct relume_maps *maps, const struct relume_edit *edit,
                                int threads, const struct relume_log *log)
{
    (void)threads;
    return each_pixel(maps, edit, log, lay_on);
}
