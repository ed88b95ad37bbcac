// gl_psf.c - the pattern of one point source by compute shaders: what relume_psf_update does
#include "glare/gl_psf.h"

#include "gl/program.h"
#include "gl/target.h"
#include "relight/eye/pattern.h"
#include "relight/eye/pupil.h"

#include <math.h>
#include <stdlib.h>

static const double widest_mm = 9;       // of a pupil
static const double least_light = 1e-3;  // of the pupil; lids that leave less are shut

void gl_compute(const struct gl *gl, int width, int height)
{
    gl->DispatchCompute((GLuint)(width + 15) / 16, (GLuint)(height + 15) / 16, 1);
    gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

// The widest pupil, in an odd number of tiles: their middle is the middle of one.
static int tiles_of(const struct relume_psf_geometry *shape)
{
    const int tiles = (int)ceil(widest_mm / shape->width_mm);
    return tiles + (tiles + 1) % 2;
}

bool gl_psf_fits(const struct gl *gl, const struct relume_psf_params *params)
{
    struct relume_psf_geometry shape;
    if (!gl->compute || relume_psf_geometry(&shape, params))
        return false;
    const int n = shape.size;
    return gl_fft_length(gl, n) == n && params->planes < 2 && !params->retina_distance &&
           tiles_of(&shape) * n <= gl->max_texture &&
           4.0 * sizeof(float) * n * n <= (double)gl->storage_bytes;
}

// ---------------------------------------------------------------- making

enum { WAVE_APERTURE, WAVE_SIZE, WAVE_TILES, WAVE_COUNT };
static const char *const wave_uniforms[] = {"aperture", "size", "tiles"};
enum { POWER_SIZE, POWER_COUNT };
static const char *const power_uniforms[] = {"size"};
enum { SMEAR_SIZE, SMEAR_FINE, SMEAR_FINES, SMEAR_COUNT };
static const char *const smear_uniforms[] = {"size", "fine", "fines"};
enum { COLOUR_SIZE, COLOUR_TAPS, COLOUR_FIELD, COLOUR_FADE, COLOUR_COUNT };
static const char *const colour_uniforms[] = {"size", "taps", "field", "fade_radius"};

static relume_status make_programs(struct gl_psf *psf, const struct gl *gl,
                                   const struct relume_log *log)
{
    const struct compute_shader list[] = {
        {&psf->wave, "glare_wave.comp", wave_uniforms, WAVE_COUNT},
        {&psf->power, "glare_power.comp", power_uniforms, POWER_COUNT},
        {&psf->smear, "glare_smear.comp", smear_uniforms, SMEAR_COUNT},
        {&psf->colour, "glare_colour.comp", colour_uniforms, COLOUR_COUNT},
    };
    return program_create_shaders(list, sizeof list / sizeof *list, gl, log);
}

// A texel's coverage is an average over it, which lowers high frequencies by a known factor.
static relume_status make_texel(struct gl_psf *psf, const struct gl *gl)
{
    const int n = psf->shape.size;
    float *factor = malloc((size_t)n * sizeof *factor);
    for (int i = 0; factor && i < n; i++) {
        const double x = M_PI * (i <= n / 2 ? i : i - n) / n, s = i ? sin(x) / x : 1;
        factor[i] = (float)(1 / (s * s));
    }
    if (factor)
        psf->texel = gl_storage(gl, (size_t)n * sizeof *factor, factor);
    free(factor);
    return psf->texel ? RELUME_OK : RELUME_ENOMEM;
}

static void make_taps(struct gl_psf *psf, const struct gl *gl)
{
    float tap[RELUME_PSF_MOST_TAPS][4];
    for (int i = 0; i < psf->spectrum.taps; i++) {
        tap[i][0] = psf->spectrum.tap[i].scale;
        for (int c = 0; c < 3; c++)
            tap[i][c + 1] = psf->spectrum.tap[i].rgb[c];
    }
    psf->taps = gl_storage(gl, (size_t)psf->spectrum.taps * sizeof *tap, tap);
}

static void make_buffers(struct gl_psf *psf, const struct gl *gl)
{
    const size_t n = (size_t)psf->shape.size, field = (size_t)psf->shape.field;
    psf->waves = gl_storage(gl, 2 * n * n * sizeof(float), NULL);
    psf->phase = gl_storage(gl, 2 * n * (size_t)psf->tiles * sizeof(float), NULL);
    psf->mono = gl_storage(gl, (n + 1) * (n + 1) * sizeof(float), NULL);
    psf->smeared = gl_storage(gl, (n + 1) * (n + 1) * sizeof(float), NULL);
    psf->colours = gl_storage(gl, 4 * field * field * sizeof(float), NULL);
    make_taps(psf, gl);
}

relume_status gl_psf_create(struct gl_psf *psf, const struct gl *gl,
                            const struct relume_psf_params *params)
{
    *psf = (struct gl_psf){.dioptres = NAN};
    relume_status status = relume_psf_geometry(&psf->shape, params);
    if (!status)
        status = relume_psf_spectrum(&psf->spectrum, params);
    if (!status)
        psf->tiles = tiles_of(&psf->shape);
    if (!status)
        status = gl_aperture_create(&psf->aperture, gl, psf->tiles * psf->shape.size,
                                    psf->shape.texel_mm, params->parts_off, params->log);
    if (!status)
        status = make_programs(psf, gl, params->log);
    if (!status)
        status = make_texel(psf, gl);
    if (status)
        return status;
    make_buffers(psf, gl);
    return gl_check(gl, "glare", params->log);
}

void gl_psf_destroy(struct gl_psf *psf, const struct gl *gl)
{
    struct program *const programs[] = {&psf->wave, &psf->power, &psf->smear, &psf->colour};
    const GLuint buffers[] = {psf->waves,   psf->phase, psf->texel,  psf->mono,
                              psf->smeared, psf->taps,  psf->colours};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        program_destroy(programs[i], gl);
    gl->DeleteBuffers(sizeof buffers / sizeof *buffers, buffers);
    gl_aperture_destroy(&psf->aperture, gl);
    *psf = (struct gl_psf){0};
}

// ---------------------------------------------------------------- steps

static relume_status make_phase(struct gl_psf *psf, const struct gl *gl, double dioptres)
{
    const int n = psf->tiles * psf->shape.size;
    if (psf->dioptres == dioptres)
        return RELUME_OK;
    float *phase = malloc(2 * (size_t)n * sizeof *phase);
    if (!phase)
        return RELUME_ENOMEM;
    for (int i = 0; i < n; i++) {
        const double x = (i - n / 2) * psf->shape.texel_mm;
        phase[2 * i] = (float)cos(psf->shape.defocus_phase * dioptres * x * x);
        phase[2 * i + 1] = (float)sin(psf->shape.defocus_phase * dioptres * x * x);
    }
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, psf->phase);
    gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, 2 * n * (GLsizeiptr)sizeof *phase, phase);
    free(phase);
    psf->dioptres = dioptres;
    return RELUME_OK;
}

static void make_wave(const struct gl_psf *psf, const struct gl *gl)
{
    const int n = psf->shape.size;
    gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    gl->UseProgram(psf->wave.id);
    gl->Uniform1i(psf->wave.at[WAVE_APERTURE], 0);
    gl->Uniform1i(psf->wave.at[WAVE_SIZE], n);
    gl->Uniform1i(psf->wave.at[WAVE_TILES], psf->tiles);
    texture_use(gl, 0, GL_TEXTURE_2D, psf->aperture.texture);
    gl_bind(gl, 0, psf->waves);
    gl_bind(gl, 1, psf->phase);
    gl_compute(gl, n, n);
}

// Rows without light stay black.
static relume_status transform(struct gl_psf *psf, const struct gl *gl, struct gl_fft *fft,
                               const struct relume_log *log)
{
    const int n = psf->shape.size;
    const int from = psf->tiles > 1 ? 0 : psf->aperture.from;
    const int to = psf->tiles > 1 ? n : psf->aperture.to;
    gl_bind(gl, 0, psf->waves);
    const struct gl_fft_lines rows = {
        .length = n, .first = from, .lines = to - from, .planes = 1, .stride = {1, n, 0}};
    const struct gl_fft_lines columns = {.length = n, .lines = n, .planes = 1, .stride = {n, 1, 0}};
    const relume_status status = gl_fft_run(fft, gl, &rows, log);
    return status ? status : gl_fft_run(fft, gl, &columns, log);
}

static void take_power(const struct gl_psf *psf, const struct gl *gl)
{
    gl->UseProgram(psf->power.id);
    gl->Uniform1i(psf->power.at[POWER_SIZE], psf->shape.size);
    gl_bind(gl, 0, psf->waves);
    gl_bind(gl, 1, psf->texel);
    gl_bind(gl, 2, psf->mono);
    gl_compute(gl, psf->shape.size + 1, psf->shape.size + 1);
}

static void smear(const struct gl_psf *psf, const struct gl *gl)
{
    gl->UseProgram(psf->smear.id);
    gl->Uniform1i(psf->smear.at[SMEAR_SIZE], psf->shape.size);
    gl->Uniform1i(psf->smear.at[SMEAR_FINES], psf->spectrum.fines);
    gl->Uniform1fv(psf->smear.at[SMEAR_FINE], psf->spectrum.fines, psf->spectrum.fine);
    gl_bind(gl, 0, psf->mono);
    gl_bind(gl, 1, psf->smeared);
    gl_compute(gl, psf->shape.size + 1, psf->shape.size + 1);
}

static void colour(const struct gl_psf *psf, const struct gl *gl)
{
    const struct relume_psf_geometry *g = &psf->shape;
    const bool smeared = psf->spectrum.fines > 1;
    if (smeared)
        smear(psf, gl);
    gl->UseProgram(psf->colour.id);
    gl->Uniform1i(psf->colour.at[COLOUR_SIZE], g->size);
    gl->Uniform1i(psf->colour.at[COLOUR_TAPS], psf->spectrum.taps);
    gl->Uniform1i(psf->colour.at[COLOUR_FIELD], g->field);
    gl->Uniform2f(psf->colour.at[COLOUR_FADE], (float)(g->fade / g->step),
                  (float)(g->radius / g->step));
    gl_bind(gl, 0, smeared ? psf->smeared : psf->mono);
    gl_bind(gl, 1, psf->taps);
    gl_bind(gl, 2, psf->colours);
    gl_compute(gl, g->field, g->field);
}

relume_status gl_psf_update(struct gl_psf *psf, const struct gl *gl, struct gl_fft *fft,
                            const relume_eye *eye, const struct relume_log *log)
{
    gl_aperture_draw(&psf->aperture, gl, relume_eye_aperture(eye));
    psf->light = psf->aperture.light;
    if (psf->light < least_light)
        return RELUME_OK;
    relume_status status = make_phase(psf, gl, relume_eye_subject(eye)->optics.defocus_dpt);
    if (status)
        return status;
    make_wave(psf, gl);
    status = transform(psf, gl, fft, log);
    if (status)
        return status;
    take_power(psf, gl);
    colour(psf, gl);
    return gl_check(gl, "glare", log);
}
