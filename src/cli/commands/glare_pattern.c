// glare_pattern.c - an eye's pattern as pictures and diagrams (`relume glare --psf`)
#include "cli/commands/glare_pattern.h"

#include "cli/fill.h"

#include "cli/develop.h"
#include "cli/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------- pictures

static int ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static double luminance(const float *rgb)
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

// A pattern spans six decades: shown so that 97 of 100 texels stay below white.
static relume_status expose(struct relume_image *image)
{
    const size_t n = (size_t)image->width * (size_t)image->height;
    float *const sorted = malloc(n * sizeof *sorted);
    if (!sorted)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++)
        sorted[i] = (float)luminance(image->data + 3 * i);
    qsort(sorted, n, sizeof *sorted, ascending);
    const float white = sorted[(size_t)(0.97 * (double)(n - 1))];
    free(sorted);
    for (size_t i = 0; white > 0.0f && i < n; i++) {
        float *const rgb = image->data + 3 * i;
        // What is brighter than white is white, whatever its colour.
        const float over = fmaxf((float)luminance(rgb) / white - 1.0f, 0.0f);
        for (int c = 0; c < 3; c++)
            rgb[c] = rgb[c] / white + over;
    }
    return RELUME_OK;
}

static relume_status save_psf(const struct viewer_eye *e, const char *path,
                              const struct relume_log *log)
{
    struct relume_image image;
    relume_status status = relume_psf_image(&image, e->psf);
    if (!status && !relume_image_saves_linear(path))
        status = expose(&image);
    if (!status)
        status = relume_image_save(&image, path, relume_image_params(.log = log));
    relume_image_destroy(&image);
    return status;
}

// ---------------------------------------------------------------- diagrams

// Fig. 8.3: the diameter over time for three fields, and for the one that is looked at.
static relume_status save_pupil(const struct viewer_eye *e, const char *stem,
                                const struct relume_log *log)
{
    enum { SERIES = 4, STEPS = 400 };
    static const double span_s = 20.0;
    const double level[SERIES] = {0.1, 10.0, 1000.0, e->luminance};
    struct plot_series series[SERIES];
    struct plot_point *const point = calloc(SERIES * STEPS, sizeof *point);
    relume_status status = point ? RELUME_OK : RELUME_ENOMEM;
    for (int s = 0; !status && s < SERIES; s++) {
        relume_eye *eye;
        series[s] = (struct plot_series){.colour = s, .mark = s};
        snprintf(series[s].name, sizeof series[s].name,
                 s < 3 ? "%g cd/m\u00b2" : "this field, %.3g", level[s]);
        status = relume_eye_create(&eye, relume_eye_subject(e->eye), level[s]);
        for (int i = 0; !status && i < STEPS; i++) {
            point[s * STEPS + i] = (struct plot_point){.x = relume_eye_state(eye)->time_s,
                                                       .y = relume_eye_state(eye)->pupil_mm,
                                                       .series = s};
            status = relume_eye_advance(eye, span_s / STEPS, level[s]);
        }
        relume_eye_destroy(&eye);
    }
    const struct plot plot = {.title = "Pupil diameter over time",
                              .subtitle = "Eq. 8.1 and 8.2; bright fields: small and restless",
                              .x_label = "seconds",
                              .y_label = "mm",
                              .series = series,
                              .series_count = SERIES,
                              .point = point,
                              .points = SERIES * STEPS,
                              .linear = true,
                              .curves = true};
    if (!status)
        status = plot_save(&plot, stem, log);
    free(point);
    return status;
}

// Light per steradian over the angle, in rings of a tenth of an octave, beside the CIE's observer.
enum { RINGS = 64 };
static const double first_deg = 0.01, rings_per_octave = 6.0;

static void measure_rings(double light[RINGS], double angle[RINGS], int count[RINGS],
                          const struct relume_image *image, double step)
{
    const double deg = 180.0 / M_PI;
    const int half = image->width / 2;
    for (int y = -half; y <= half; y++)
        for (int x = -half; x <= half; x++) {
            const double t = step * deg * hypot(x, y);
            const int ring = relume_whole(floor(log2(t / first_deg) * rings_per_octave));
            if (!(t >= first_deg) || ring >= RINGS)
                continue;
            light[ring] += luminance(image->data + 3 * ((size_t)(y + half) * (size_t)image->width +
                                                        (size_t)(x + half))) /
                           (step * step);
            angle[ring] += t;
            count[ring]++;
        }
}

static relume_status save_observer(const struct viewer_eye *e, const char *stem,
                                   const struct relume_log *log)
{
    static const struct plot_series series[] = {{"this eye", 1, 0}, {"CIE 1999 observer", 0, 1}};
    const struct relume_psf_geometry *const g = relume_psf_shape(e->psf);
    const struct relume_subject *const subject = relume_eye_subject(e->eye);
    double light[RINGS] = {0.0}, angle[RINGS] = {0.0};
    int count[RINGS] = {0};
    struct plot_point point[2 * RINGS];
    struct relume_image image;
    relume_status status = relume_psf_image(&image, e->psf);
    int n = 0;
    if (!status)
        measure_rings(light, angle, count, &image, g->step);
    for (int i = 0; i < RINGS; i++) {
        const double t = count[i] ? angle[i] / count[i] : 0.0;
        if (!(light[i] > 0.0) || t > g->fade * 180.0 / M_PI)
            continue;
        const double cie = relume_cie_glare(t, subject->optics.age, subject->optics.pigment);
        point[n++] = (struct plot_point){.x = t, .y = log10(light[i] / count[i]), .series = 0};
        point[n++] = (struct plot_point){.x = t, .y = log10(cie), .series = 1};
    }
    const struct plot plot = {.title = "The pattern against the standard observer",
                              .subtitle = "light of a point source per steradian, mean over rings",
                              .x_label = "angle, degrees",
                              .y_label = "log10 of light per steradian",
                              .series = series,
                              .series_count = 2,
                              .point = point,
                              .points = n,
                              .curves = true};
    if (!status)
        status = plot_save(&plot, stem, log);
    relume_image_destroy(&image);
    return status;
}

// ---------------------------------------------------------------- all

static relume_status save_aperture(const struct viewer_eye *e, const char *path,
                                   const struct relume_log *log)
{
    struct relume_image image;
    relume_status status = relume_psf_aperture(&image, e->psf);
    if (!status)
        status = relume_image_save(&image, path, relume_image_params(.log = log));
    relume_image_destroy(&image);
    return status;
}

relume_status save_pattern(struct viewer_eye *e, const struct args *args, const char *path)
{
    static const struct {
        const char *name;
        relume_status (*save)(const struct viewer_eye *e, const char *path,
                              const struct relume_log *log);
    } files[] = {{"psf.exr", save_psf},
                 {"psf.png", save_psf},
                 {"aperture.png", save_aperture},
                 {"pupil", save_pupil},
                 {"observer", save_observer}};
    struct fill folder;
    char name[4200];
    relume_status status = relume_psf_update(e->psf, e->eye);
    if (status || strchr(path_name(path), '.'))
        return status ? status : save_psf(e, path, args->log);
    if (strlen(path) > 4000)
        return usage_error("--psf: expected a shorter name");
    status = fill_open(&folder, path, args->log);
    for (size_t i = 0; !status && i < sizeof files / sizeof *files; i++) {
        snprintf(name, sizeof name, "%s/%s", folder.path, files[i].name);
        status = files[i].save(e, name, args->log);
    }
    return fill_end(&folder, status);
}
