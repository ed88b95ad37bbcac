// import.c - a picture of another format becomes a relume file
#include <relume/exchange.h>

#include "core/base/tree.h"
#include "exchange/formats/kind.h"
#include "exchange/formats/ptm.h"
#include "exchange/formats/rti.h"
#include "exchange/formats/web.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/vec.h"
#include "encode/levels/pyramid.h"
#include "format/coder/coding.h"
#include "format/pack/pack_write.h"

#include <relume/encode/pack_encode.h>
#include <relume/image/directions.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

// Formats without lights get a spread of so many, for what wants to know where to look.
enum { STAND_INS = 32 };

// ---------------------------------------------------------------- reading

static relume_status read_any(struct foreign *f, const char *path,
                              const struct relume_import_params *p)
{
    const struct relume_limits *limits = limits_of(p->limits, p->log);
    const enum input_kind is = input_kind(path, p->log);
    const bool folder = is == INPUT_FOLDER;
    const enum relume_kind kind = folder ? exchange_kind_of(path, p->log) : RELUME_KIND_FOREIGN;
    if (is == INPUT_NONE)
        return log_fail(p->log, RELUME_ENOTFOUND, "%s: no such file or folder", path);
    if (kind != RELUME_KIND_FOREIGN)
        return log_fail(
            p->log, RELUME_EFORMAT,
            "%s: a folder without info.json, so no web folder; expected one as relight "
            "and OpenLIME read it, or a .ptm, .rti or .hsh file%s",
            path, kind == RELUME_KIND_CAPTURE ? "; this is a capture, for 'relume encode'" : "");
    if (folder || path_ends(path, ".json"))
        return web_read(f, path, limits, p->log);
    if (path_ends(path, ".ptm") || path_ends(path, ".lptm"))
        return ptm_read(f, path, limits, p->log);
    if (path_ends(path, ".rti") || path_ends(path, ".hsh"))
        return rti_read(f, path, path_ends(path, ".hsh"), limits, p->log);
    return log_fail(
        p->log, RELUME_EFORMAT,
        "%s: this format cannot be imported; expected .ptm, .rti, .hsh or a folder with info.json",
        path);
}

// ---------------------------------------------------------------- codes

struct material {
    struct foreign *f;
    struct relume_vec3 *light;
    int lights;
    float *transform, *mean;
    const void **plane;
    uint16_t *words;  // planes that were no bytes
    relume_coder *coder;
    relume_coefficients *coefficients;
};

static void destroy(struct material *m)
{
    relume_coefficients_destroy(&m->coefficients);
    relume_coder_destroy(&m->coder);
    mem_free(m->light);
    mem_free(m->transform);
    mem_free(m->mean);
    mem_free(m->plane);
    mem_free(m->words);
}

// A file may scale by zero or below it; codes are turned so that the scale is positive.
static void make_positive(struct foreign *f, int plane)
{
    uint8_t *codes = f->codes + (size_t)plane * foreign_pixels(f);
    if (f->scale[plane] == 0.0f) {
        memset(codes, 0, foreign_pixels(f));
        f->scale[plane] = 1.0f;
    } else if (f->scale[plane] < 0.0f) {
        f->offset[plane] += 255.0f * f->scale[plane];
        f->scale[plane] = -f->scale[plane];
        for (size_t i = 0; i < foreign_pixels(f); i++)
            codes[i] = 255 - codes[i];
    }
}

// Joint planes over a type's own few functions (YCC) become a set of 16-bit planes per channel.
static relume_status separate(struct material *m)
{
    struct foreign *f = m->f;
    const size_t pixels = foreign_pixels(f);
    const int n = f->functions.count, planes = 3 * n;
    float *scale = mem_zeroed((size_t)planes, sizeof *scale);
    float *offset = mem_zeroed((size_t)planes, sizeof *offset);
    m->words = mem_array((size_t)planes * pixels, sizeof *m->words);
    relume_status status = scale && offset && m->words ? RELUME_OK : RELUME_ENOMEM;
    for (int q = 0; !status && q < planes; q++) {
        const int c = q % 3, j = q / 3;
        double low = f->mean[c * n + j], high = low;
        for (int p = 0; p < f->terms; p++) {
            const double t = f->transform[(c * f->terms + p) * n + j];
            const double a = t * (double)f->offset[p], b = a + t * 255.0 * (double)f->scale[p];
            low += a < b ? a : b;
            high += a < b ? b : a;
        }
        scale[q] = high > low ? (float)((high - low) / 65535.0) : 1.0f;
        offset[q] = (float)low;
        for (size_t i = 0; i < pixels; i++) {
            double v = f->mean[c * n + j];
            for (int p = 0; p < f->terms; p++)
                v += f->transform[(c * f->terms + p) * n + j] *
                     ((double)f->codes[(size_t)p * pixels + i] * (double)f->scale[p] +
                      (double)f->offset[p]);
            m->words[(size_t)q * pixels + i] =
                (uint16_t)fmin(fmax(rint((v - low) / (double)scale[q]), 0.0), 65535.0);
        }
    }
    if (status) {
        mem_free(scale);
        mem_free(offset);
        return status;
    }
    mem_free(f->scale);
    mem_free(f->offset);
    mem_free(f->transform);
    mem_free(f->mean);
    f->scale = scale;
    f->offset = offset;
    f->transform = f->mean = NULL;
    f->form = FOREIGN_CHANNELS;
    f->terms = n;
    f->planes = planes;
    return RELUME_OK;
}

// ---------------------------------------------------------------- coder

static const struct relume_basis *basis_of(const struct functions *f)
{
    switch (f->kind) {
    case FUNCTIONS_PTM: return &relume_basis_ptm;
    case FUNCTIONS_HSH: return &relume_basis_hsh;
    case FUNCTIONS_SH: return &relume_basis_sh;
    default: return &relume_basis_pca;
    }
}

static relume_status choose_lights(struct material *m)
{
    const struct functions *f = &m->f->functions;
    const bool interpolates = f->kind == FUNCTIONS_GAUSS || f->kind == FUNCTIONS_GRID;
    m->lights = interpolates ? f->count : STAND_INS;
    m->light = mem_array((size_t)m->lights, sizeof *m->light);
    if (!m->light)
        return RELUME_ENOMEM;
    if (!interpolates)
        return relume_directions_make(m->light, m->lights, relume_pattern_find("hammersley"),
                                      relume_directions_params(.hemisphere = true));
    for (int i = 0; i < m->lights; i++)
        m->light[i] =
            f->kind == FUNCTIONS_GRID ? functions_grid_node(f->resolution, i) : f->lights[i];
    return RELUME_OK;
}

// How the format's functions follow from the basis's: the same ones in another order and scale.
static relume_status match_functions(struct material *m, const struct relume_coder_params *params)
{
    enum { TRIES = 7 };
    const struct functions *f = &m->f->functions;
    const int n = f->count;
    relume_coder *raw;
    struct relume_coder_params plain = *params;
    plain.luminance = false;
    plain.transform = NULL;
    relume_status status = relume_coder_create(&raw, basis_of(f), m->light, m->lights, &plain);
    if (status)
        return status;
    double theirs[TRIES][FUNCTIONS_MOST_OWN];
    float ours[TRIES][3 * FUNCTIONS_MOST_OWN], constant[3];
    for (int t = 0; t < TRIES; t++) {
        const double z = 0.2 + 0.1 * t, r = sqrt(1.0 - z * z), phi = 0.4 + 2.0 * t;
        const struct relume_vec3 l = vec3_of(r * cos(phi), r * sin(phi), z);
        functions_at(f, l, theirs[t]);
        relume_coder_weights(raw, l, ours[t], constant);
    }
    relume_coder_destroy(&raw);
    m->transform = mem_zeroed((size_t)n * (size_t)n, sizeof *m->transform);
    for (int j = 0; m->transform && j < n; j++)
        for (int i = 0; i < n; i++) {
            const double ratio = theirs[0][j] / (double)ours[0][i];
            bool same = true;
            for (int t = 1; t < TRIES; t++)
                same = same && fabs(theirs[t][j] - ratio * (double)ours[t][i]) < 1e-5;
            if (same)
                m->transform[j * n + i] =
                    fabs(fabs(ratio) - 1.0) < 1e-5 ? (float)rint(ratio) : (float)ratio;
        }
    return m->transform ? RELUME_OK : RELUME_ENOMEM;
}

static float *floats_of(const double *from, size_t n)
{
    float *to = mem_array(n, sizeof *to);
    for (size_t i = 0; to && i < n; i++)
        to[i] = (float)from[i];
    return to;
}

static relume_status copy_functions(struct material *m)
{
    const struct foreign *f = m->f;
    const size_t n = (size_t)f->functions.count;
    m->transform = floats_of(f->transform, 3 * (size_t)f->terms * n);
    m->mean = floats_of(f->mean, 3 * n);
    return m->transform && m->mean ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status make_coder(struct material *m, const char *path,
                                const struct relume_import_params *p)
{
    const struct foreign *f = m->f;
    const bool joint = f->form == FOREIGN_JOINT;
    const bool grid = f->functions.kind == FUNCTIONS_GRID;
    struct relume_coder_params params = {
        .log = p->log,
        .coefficients = f->terms,
        .hemispherical = true,
        .decode = true,
        .luminance = f->form == FOREIGN_LUMINANCE,
        .interpolant = joint ? relume_interpolant_find(grid ? "octahedral" : "rbf") : NULL,
        .parameter = {grid ? f->functions.resolution : f->functions.sigma},
    };
    if (joint && f->terms > 3 * m->lights)
        return log_fail(p->log, RELUME_ELIMIT,
                        "%s: %d planes; expected at most three per light, %d", path, f->terms,
                        3 * m->lights);
    relume_status status = joint ? copy_functions(m) : match_functions(m, &params);
    params.transform = m->transform;
    params.mean = m->mean;
    if (!status)
        status =
            relume_coder_create(&m->coder, basis_of(&f->functions), m->light, m->lights, &params);
    return status;
}

// ---------------------------------------------------------------- writing

static relume_status keep_codes(struct material *m, const char *out,
                                const struct relume_import_params *p)
{
    const struct foreign *f = m->f;
    const size_t pixels = foreign_pixels(f);
    m->plane = mem_array((size_t)f->planes, sizeof *m->plane);
    if (!m->plane)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < (size_t)f->planes; i++)
        m->plane[i] = m->words ? (const void *)(m->words + i * pixels)
                               : (const void *)(f->codes + i * pixels);
    const struct relume_codes codes = {
        .coder = m->coder,
        .width = f->width,
        .height = f->height,
        .planes = f->planes,
        .storage = m->words ? RELUME_STORE_16 : RELUME_STORE_8,
        .plane = m->plane,
        .scale = f->scale,
        .offset = f->offset,
    };
    return relume_coefficients_keep(&m->coefficients, &codes,
                                    relume_project_params(.log = p->log, .scratch = out));
}

static relume_status write_pack(const struct material *m, const char *out,
                                const struct relume_import_params *p)
{
    const struct relume_pack_view view = {.coefficients = m->coefficients};
    struct relume_pack_contents contents = {
        .coder = m->coder,
        .domain = m->f->linear ? RELUME_DOMAIN_LINEAR : RELUME_DOMAIN_DISPLAY,
        .display = {.curve = RELUME_CURVE_SRGB},
        .geometry = relume_geometry_default(RELUME_PLANAR, m->f->width, m->f->height),
        .views = 1,
        .view = &view,
        .report = {(double)NAN, (double)NAN},
        .preview = relume_pack_preview,
        .preview_user = &contents,
    };
    return relume_pack_write(&contents, out,
                             relume_pack_params(.log = p->log, .compression = p->compression,
                                                .threads = p->threads, .writer = p->writer));
}

relume_status relume_import(const char *path, const char *out,
                            const struct relume_import_params *params)
{
    struct relume_import_params p = PARAMS_WORK(relume_import_params, params);
    struct one_input one;
    struct foreign f = {0};
    struct material m = {.f = &f};
    if (!out && !p.writer)
        return RELUME_EINVAL;
    path = infile_name(path);
    p.log = one_input(&one, path, p.reader, p.log);
    relume_status status = read_any(&f, path, &p);
    for (int i = 0; !status && i < f.planes; i++)
        make_positive(&f, i);
    if (!status && f.form == FOREIGN_JOINT && f.functions.kind <= FUNCTIONS_SH)
        status = separate(&m);
    if (!status)
        status = choose_lights(&m);
    if (!status)
        status = make_coder(&m, path, &p);
    if (!status)
        status = keep_codes(&m, out, &p);
    if (!status)
        status = write_pack(&m, out, &p);
    destroy(&m);
    foreign_free(&f);
    return status;
}
