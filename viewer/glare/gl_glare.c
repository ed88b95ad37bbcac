// gl_glare.c - a frame as an eye sees it, by compute shaders of OpenGL 4.3
#include "glare/gl_glare.h"
#include "relight/eye/veil.h"

#include <math.h>
#include <stdlib.h>

enum { WATCH_FRAME, WATCH_COUNT };
static const char *const watch_uniforms[] = {"frame"};

void gl_glare_destroy(struct gl_glare *g, const struct gl *gl)
{
    gl_fft_destroy(&g->fft, gl);
    gl_psf_destroy(&g->psf, gl);
    gl_convolver_destroy(&g->convolver, gl);
    program_destroy(&g->watch, gl);
    if (g->before.texture)
        target_destroy(&g->before, gl);
    gl->DeleteBuffers(1, &g->results);
    *g = (struct gl_glare){0};
}

// ---------------------------------------------------------------- watching

static relume_status prepare_watch(struct gl_glare *g, const struct gl *gl, int width, int height,
                                   int groups, const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    if (!g->watch.id)
        status = program_create_compute(&g->watch, gl, "glare_watch.comp", NULL, watch_uniforms,
                                        WATCH_COUNT, log);
    if (status || (g->before.width == width && g->before.height == height))
        return status;
    if (g->before.texture)
        target_destroy(&g->before, gl);
    gl->DeleteBuffers(1, &g->results);
    g->results = gl_storage(gl, (size_t)groups * 4 * sizeof(float), NULL);
    status = target_create(&g->before, gl, width, height, log);
    if (!status)
        target_begin(&g->before, gl);
    return status;
}

static void add_results(struct gl_glare_facts *out, const float (*result)[4], int groups)
{
    *out = (struct gl_glare_facts){.same = true};
    for (int i = 0; i < groups; i++) {
        out->luminance += (double)result[i][0];
        out->greatest = fmax(out->greatest, (double)result[i][1]);
        out->same &= result[i][2] == 0.0f;
    }
}

relume_status gl_glare_watch(struct gl_glare_facts *out, struct gl_glare *g, const struct gl *gl,
                             const struct target *frame, const struct relume_log *log)
{
    const int across = (frame->width + 15) / 16, groups = across * ((frame->height + 15) / 16);
    const relume_status status = prepare_watch(g, gl, frame->width, frame->height, groups, log);
    float(*result)[4] = status ? NULL : malloc((size_t)groups * sizeof *result);
    if (status || !result)
        return status ? status : RELUME_ENOMEM;
    gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    gl->UseProgram(g->watch.id);
    gl->Uniform1i(g->watch.at[WATCH_FRAME], 0);
    texture_use(gl, 0, GL_TEXTURE_2D, frame->texture);
    gl->BindImageTexture(0, g->before.texture, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, g->results);
    gl_compute(gl, frame->width, frame->height);
    gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, g->results);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, groups * (GLsizeiptr)sizeof *result, result);
    add_results(out, (const float(*)[4])result, groups);
    out->luminance /= (double)frame->width * (double)frame->height;
    free(result);
    return gl_check(gl, "glare", log);
}

// ---------------------------------------------------------------- seeing

relume_status gl_glare_prepare(struct gl_glare *g, const struct gl *gl,
                               const struct relume_psf_params *params)
{
    gl_psf_destroy(&g->psf, gl);
    gl_convolver_destroy(&g->convolver, gl);
    return gl_psf_create(&g->psf, gl, params);
}

relume_status gl_glare_update(struct gl_glare *g, const struct gl *gl, const relume_eye *eye,
                              const struct relume_log *log)
{
    return gl_psf_update(&g->psf, gl, &g->fft, eye, log);
}

relume_status gl_glare_apply(struct gl_glare *g, const struct gl *gl, const struct target *seen,
                             const struct target *frame, const struct gl_glare_facts *facts,
                             const relume_eye *eye, const struct relume_glare_params *view,
                             bool *fits, const struct relume_log *log)
{
    const struct relume_subject *subject = relume_eye_subject(eye);
    const struct relume_psf_geometry *shape = &g->psf.shape;
    const double magnify = view->magnify > 0 ? view->magnify : 1;
    struct gl_convolver_view v = {
        .pixel = relume_glare_pixel(view->fov_deg, frame->width) / magnify,
    };
    relume_veil(&v.veil, shape, subject->optics.age, subject->optics.pigment);
    v.veiled = !view->no_veil && v.veil.share > 0;
    *fits = true;
    relume_status status = RELUME_OK;
    if (!gl_convolver_fits(&g->convolver, shape, &v, frame->width, frame->height)) {
        gl_convolver_destroy(&g->convolver, gl);
        status = gl_convolver_create(&g->convolver, gl, shape, &v, frame->width, frame->height,
                                     fits, log);
    }
    return status || !*fits ? status
                            : gl_convolver_run(&g->convolver, gl, &g->fft, seen, frame, facts->same,
                                               facts->greatest, &g->psf, &v, log);
}
