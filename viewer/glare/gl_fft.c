// gl_fft.c - Fourier transforms of lines in a buffer, by compute shaders
#include "glare/gl_fft.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { LEAST = 64, MOST_THREADS = 256 };
enum { FIRST, STRIDE, WAY, UNIFORMS };
static const char *const uniforms[] = {"first", "stride", "way"};

int gl_fft_length(const struct gl *gl, int n)
{
    const int most = gl->shared_bytes / (2 * (int)sizeof(float));
    int best = 0;
    static const int odd[] = {4, 5, 6, 8};
    for (int i = 0; i < 4; i++) {
        long length = odd[i];
        while (length < n || length < LEAST)
            length *= 2;
        if (length <= most && (!best || length < best))
            best = (int)length;
    }
    return best;
}

// stage(radix, product of those before) for every radix, the odd ones first.
static void list_stages(char *text, size_t size, int length)
{
    int before = 1, n = 0;
    while (before < length) {
        const int left = length / before;
        const int radix = left % 5 == 0 ? 5 : left % 3 == 0 ? 3 : left % 4 == 0 ? 4 : 2;
        n += snprintf(text + n, size - (size_t)n, " stage(%d, %d);", radix, before);
        before *= radix;
    }
}

static relume_status make_turns(GLuint *out, const struct gl *gl, int length)
{
    float *turn = malloc(2 * (size_t)length * sizeof *turn);
    if (!turn)
        return RELUME_ENOMEM;
    for (int k = 0; k < length; k++) {
        turn[2 * k] = (float)cos(2 * M_PI * k / length);
        turn[2 * k + 1] = (float)-sin(2 * M_PI * k / length);
    }
    gl->GenBuffers(1, out);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, *out);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, 2 * length * (GLsizeiptr)sizeof *turn, turn,
                   GL_STATIC_DRAW);
    free(turn);
    return RELUME_OK;
}

static void forget(struct gl_fft_length *l, const struct gl *gl)
{
    if (l->length) {
        program_destroy(&l->program, gl);
        gl->DeleteBuffers(1, &l->turns);
    }
    *l = (struct gl_fft_length){0};
}

static relume_status make(struct gl_fft_length *l, const struct gl *gl, int length,
                          const struct relume_log *log)
{
    char stages[256], defines[384];
    const int threads = length / 4 < MOST_THREADS ? length / 4 : MOST_THREADS;
    list_stages(stages, sizeof stages, length);
    snprintf(defines, sizeof defines, "#define LENGTH %d\n#define THREADS %d\n#define STAGES%s\n",
             length, threads, stages);
    forget(l, gl);
    relume_status status =
        program_create_compute(&l->program, gl, "glare_fft.comp", defines, uniforms, UNIFORMS, log);
    if (!status)
        status = make_turns(&l->turns, gl, length);
    if (!status)
        l->length = length;
    else
        program_destroy(&l->program, gl);
    return status;
}

static relume_status find_length(struct gl_fft_length **out, struct gl_fft *fft,
                                 const struct gl *gl, int length, const struct relume_log *log)
{
    struct gl_fft_length *oldest = &fft->of[0];
    for (int i = 0; i < GL_FFT_LENGTHS; i++) {
        *out = &fft->of[i];
        if ((*out)->length == length)
            return RELUME_OK;
        if ((*out)->used < oldest->used)
            oldest = *out;
    }
    *out = oldest;
    return make(oldest, gl, length, log);
}

relume_status gl_fft_run(struct gl_fft *fft, const struct gl *gl, const struct gl_fft_lines *lines,
                         const struct relume_log *log)
{
    struct gl_fft_length *l;
    const relume_status status = find_length(&l, fft, gl, lines->length, log);
    if (status || lines->lines < 1)
        return status;
    l->used = ++fft->uses;
    gl->UseProgram(l->program.id);
    gl->Uniform1i(l->program.at[FIRST], lines->first);
    gl->Uniform3i(l->program.at[STRIDE], lines->stride[0], lines->stride[1], lines->stride[2]);
    gl->Uniform1f(l->program.at[WAY], lines->inverse ? -1 : 1);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, l->turns);
    gl->DispatchCompute((GLuint)lines->lines, (GLuint)lines->planes, 1);
    gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return RELUME_OK;
}

void gl_fft_destroy(struct gl_fft *fft, const struct gl *gl)
{
    for (int i = 0; i < GL_FFT_LENGTHS; i++)
        forget(&fft->of[i], gl);
}
