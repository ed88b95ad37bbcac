// gl_convolver.c - a frame convolved with an eye's pattern by compute shaders
#include "glare/gl_convolver.h"

#include "gl/program.h"
#include "relight/eye/veil.h"

#include <math.h>

enum { EXACT_REACH = 2048 };

// ---------------------------------------------------------------- sizes

static int reach_of(const struct relume_psf_geometry *shape, const struct gl_convolver_view *view,
                    double radius)
{
    return (int)fmin(ceil((radius + shape->step) / view->pixel), 1e6);
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

static struct gl_convolver plan(const struct gl *gl, const struct relume_psf_geometry *shape,
                                const struct gl_convolver_view *view, int width, int height)
{
    struct gl_convolver c = {.width = width, .height = height};
    c.reach = reach_of(shape, view, shape->radius);
    const int all = view->veiled ? reach_of(shape, view, RELUME_VEIL_DEG * M_PI / 180) : c.reach;
    c.most[0] = least(all, width - 1);
    c.most[1] = least(all, height - 1);
    c.size[0] = gl_fft_length(gl, width + c.most[0]);
    c.size[1] = gl_fft_length(gl, height + c.most[1]);
    return c;
}

static bool fits_card(const struct gl *gl, const struct gl_convolver *c, int field)
{
    const double side = 2.0 * c->reach + 1, vec4 = 4 * sizeof(float);
    const double planes = 2.0 * c->size[0] * c->size[1] * 2 * sizeof(float);
    return planes > 0 && fmax(planes, vec4 * side * fmax(side, field)) <= (double)gl->storage_bytes;
}

bool gl_convolver_fits(const struct gl_convolver *c, const struct relume_psf_geometry *shape,
                       const struct gl_convolver_view *view, int width, int height)
{
    const int reach = reach_of(shape, view, shape->radius);
    const int all = view->veiled ? reach_of(shape, view, RELUME_VEIL_DEG * M_PI / 180) : reach;
    return c->spectrum && c->width == width && c->height == height && c->reach == reach &&
           c->most[0] == least(all, width - 1) && c->most[1] == least(all, height - 1);
}

// ---------------------------------------------------------------- making

enum { FRAME_FRAME, FRAME_SIZE, FRAME_GREATEST, FRAME_COUNT };
static const char *const frame_uniforms[] = {"frame", "size", "greatest"};
enum { SHARE_SCALE, SHARE_FIELD, SHARE_REACH, SHARE_COUNT };
static const char *const share_uniforms[] = {"scale", "field", "reach"};
enum { SUM_LENGTH, SUM_COUNT };
static const char *const sum_uniforms[] = {"count"};
enum {
    KERNEL_SIZE,
    KERNEL_MOST,
    KERNEL_REACH,
    KERNEL_PARTS,
    KERNEL_STEPS,
    KERNEL_ALL,
    KERNEL_COUNT
};
static const char *const kernel_uniforms[] = {"size",  "most",  "reach",
                                              "parts", "steps", "veil_steps"};
enum { PRODUCT_SIZE, PRODUCT_COUNT };
static const char *const product_uniforms[] = {"size"};
enum { PICTURE_SIZE, PICTURE_FACTOR, PICTURE_COUNT };
static const char *const picture_uniforms[] = {"size", "factor"};

static relume_status make_programs(struct gl_convolver *c, const struct gl *gl,
                                   const struct relume_log *log)
{
    const struct compute_shader list[] = {
        {&c->frame, "glare_frame.comp", frame_uniforms, FRAME_COUNT},
        {&c->rows, "glare_rows.comp", share_uniforms, SHARE_COUNT},
        {&c->columns, "glare_columns.comp", share_uniforms, SHARE_COUNT},
        {&c->sum, "glare_sum.comp", sum_uniforms, SUM_COUNT},
        {&c->kernel, "glare_kernel.comp", kernel_uniforms, KERNEL_COUNT},
        {&c->product, "glare_product.comp", product_uniforms, PRODUCT_COUNT},
        {&c->picture, "glare_picture.comp", picture_uniforms, PICTURE_COUNT},
    };
    return program_create_shaders(list, sizeof list / sizeof *list, gl, log);
}

relume_status gl_convolver_create(struct gl_convolver *c, const struct gl *gl,
                                  const struct relume_psf_geometry *shape,
                                  const struct gl_convolver_view *view, int width, int height,
                                  bool *fits, const struct relume_log *log)
{
    *c = plan(gl, shape, view, width, height);
    *fits = fits_card(gl, c, shape->field);
    if (!*fits) {
        *c = (struct gl_convolver){0};
        return RELUME_OK;
    }
    const size_t side = 2 * (size_t)c->reach + 1, rgb = 4 * sizeof(float);
    const size_t planes = 2 * (size_t)c->size[0] * (size_t)c->size[1] * 2 * sizeof(float);
    c->spectrum = gl_storage(gl, planes, NULL);
    c->work = gl_storage(gl, planes, NULL);
    c->row = gl_storage(gl, side * (size_t)shape->field * rgb, NULL);
    c->pixels = gl_storage(gl, side * side * rgb, NULL);
    c->sums = gl_storage(gl, side * rgb, NULL);
    c->total = gl_storage(gl, rgb, NULL);
    c->veil = gl_storage(gl, sizeof view->veil.light, view->veil.light);
    const relume_status status = make_programs(c, gl, log);
    return status ? status : gl_check(gl, "glare", log);
}

void gl_convolver_destroy(struct gl_convolver *c, const struct gl *gl)
{
    struct program *const programs[] = {&c->frame,  &c->rows,    &c->columns, &c->sum,
                                        &c->kernel, &c->product, &c->picture};
    const GLuint buffers[] = {c->spectrum, c->work, c->row, c->pixels, c->sums, c->total, c->veil};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        program_destroy(programs[i], gl);
    gl->DeleteBuffers(sizeof buffers / sizeof *buffers, buffers);
    *c = (struct gl_convolver){0};
}

// ---------------------------------------------------------------- steps

static relume_status run_rows(const struct gl_convolver *c, const struct gl *gl, struct gl_fft *fft,
                              int first, int lines, bool inverse, const struct relume_log *log)
{
    const int w = c->size[0], h = c->size[1];
    const struct gl_fft_lines rows = {w, first, lines, 2, {1, w, w * h}, inverse};
    return gl_fft_run(fft, gl, &rows, log);
}

static relume_status run_columns(const struct gl_convolver *c, const struct gl *gl,
                                 struct gl_fft *fft, bool inverse, const struct relume_log *log)
{
    const int w = c->size[0], h = c->size[1];
    const struct gl_fft_lines columns = {h, 0, w, 2, {w, 1, w * h}, inverse};
    return gl_fft_run(fft, gl, &columns, log);
}

static relume_status take_frame(struct gl_convolver *c, const struct gl *gl, struct gl_fft *fft,
                                const struct target *frame, double greatest,
                                const struct relume_log *log)
{
    gl->UseProgram(c->frame.id);
    gl->Uniform1i(c->frame.at[FRAME_FRAME], 0);
    gl->Uniform2i(c->frame.at[FRAME_SIZE], c->size[0], c->size[1]);
    gl->Uniform1f(c->frame.at[FRAME_GREATEST], (float)greatest);
    texture_use(gl, 0, GL_TEXTURE_2D, frame->texture);
    gl_bind(gl, 0, c->spectrum);
    gl_compute(gl, c->size[0], c->size[1]);
    const relume_status status = run_rows(c, gl, fft, 0, c->height, false, log);
    return status ? status : run_columns(c, gl, fft, false, log);
}

static void resample(const struct gl_convolver *c, const struct gl *gl, const struct program *p,
                     const struct gl_psf *psf, double pixel, GLuint in, GLuint out, int width)
{
    gl->UseProgram(p->id);
    gl->Uniform1f(p->at[SHARE_SCALE], (float)(psf->shape.step / pixel));
    gl->Uniform1i(p->at[SHARE_FIELD], psf->shape.field);
    gl->Uniform1i(p->at[SHARE_REACH], c->reach);
    gl_bind(gl, 0, in);
    gl_bind(gl, 1, out);
    gl->DispatchCompute((GLuint)(width + 63) / 64, (GLuint)(2 * c->reach + 1), 1);
    gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

static void add_up(const struct gl_convolver *c, const struct gl *gl, GLuint in, GLuint out,
                   int lines)
{
    gl->UseProgram(c->sum.id);
    gl->Uniform1i(c->sum.at[SUM_LENGTH], 2 * c->reach + 1);
    gl_bind(gl, 0, in);
    gl_bind(gl, 1, out);
    gl->DispatchCompute((GLuint)lines, 1, 1);
    gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

static double veil_at(const struct relume_veil *veil, double steps)
{
    if (steps >= RELUME_VEIL_STEPS)
        return 0;
    const int i = relume_whole(steps);
    return (double)veil->light[i] + (steps - i) * (double)(veil->light[i + 1] - veil->light[i]);
}

// What all of the veil's pixels hold together, per steradian of a pixel: an eighth of them, each as
// often as it is mirrored. Fine pixels are an integral, 2 pi t dt.
static double veil_sum(const struct relume_veil *veil, double pixel)
{
    const double steps = pixel / veil->step;
    const int reach = (int)fmin(ceil(RELUME_VEIL_STEPS / steps), 1e6);
    double sum = 0;
    for (int i = 1; reach > EXACT_REACH && i < RELUME_VEIL_STEPS; i++)
        sum += 2 * M_PI * i * (double)veil->light[i] / (steps * steps);
    for (int y = 0; reach <= EXACT_REACH && y <= reach; y++)
        for (int x = y; x <= reach; x++) {
            const int times = x == 0 ? 1 : y == 0 || y == x ? 4 : 8;
            sum += times * veil_at(veil, steps * sqrt((double)x * x + (double)y * y));
        }
    return sum;
}

static void make_kernel(struct gl_convolver *c, const struct gl *gl,
                        const struct gl_convolver_view *view)
{
    const double share = view->veiled ? view->veil.share : 0;
    const double solid = view->pixel * view->pixel;
    if (view->veiled && c->veil_pixel != view->pixel) {
        c->veil_sum = veil_sum(&view->veil, view->pixel);
        c->veil_pixel = view->pixel;
    }
    const double all = 1 - share + (view->veiled ? c->veil_sum * solid : 0);
    gl->UseProgram(c->kernel.id);
    gl->Uniform2i(c->kernel.at[KERNEL_SIZE], c->size[0], c->size[1]);
    gl->Uniform2i(c->kernel.at[KERNEL_MOST], c->most[0], c->most[1]);
    gl->Uniform1i(c->kernel.at[KERNEL_REACH], c->reach);
    gl->Uniform2f(c->kernel.at[KERNEL_PARTS], (float)((1 - share) / all),
                  view->veiled ? (float)(solid / all) : 0);
    gl->Uniform1f(c->kernel.at[KERNEL_STEPS], (float)(view->pixel / view->veil.step));
    gl->Uniform1i(c->kernel.at[KERNEL_ALL], RELUME_VEIL_STEPS);
    gl_bind(gl, 0, c->work);
    gl_bind(gl, 1, c->pixels);
    gl_bind(gl, 2, c->total);
    gl_bind(gl, 3, c->veil);
    gl_compute(gl, c->size[0], c->size[1]);
}

static relume_status take_kernel(struct gl_convolver *c, const struct gl *gl, struct gl_fft *fft,
                                 const struct gl_psf *psf, const struct gl_convolver_view *view,
                                 const struct relume_log *log)
{
    const int side = 2 * c->reach + 1, below = c->most[1];
    resample(c, gl, &c->rows, psf, view->pixel, psf->colours, c->row, psf->shape.field);
    resample(c, gl, &c->columns, psf, view->pixel, c->row, c->pixels, side);
    add_up(c, gl, c->pixels, c->sums, side);
    add_up(c, gl, c->sums, c->total, 1);
    make_kernel(c, gl, view);
    relume_status status = run_rows(c, gl, fft, 0, below + 1, false, log);
    if (!status)
        status = run_rows(c, gl, fft, c->size[1] - below, below, false, log);
    return status ? status : run_columns(c, gl, fft, false, log);
}

static relume_status multiply(const struct gl_convolver *c, const struct gl *gl, struct gl_fft *fft,
                              const struct relume_log *log)
{
    gl->UseProgram(c->product.id);
    gl->Uniform2i(c->product.at[PRODUCT_SIZE], c->size[0], c->size[1]);
    gl_bind(gl, 0, c->spectrum);
    gl_bind(gl, 1, c->work);
    gl_compute(gl, c->size[0], c->size[1]);
    gl_bind(gl, 0, c->work);
    const relume_status status = run_columns(c, gl, fft, true, log);
    return status ? status : run_rows(c, gl, fft, 0, c->height, true, log);
}

static void make_picture(const struct gl_convolver *c, const struct gl *gl,
                         const struct target *seen, double light)
{
    gl->UseProgram(c->picture.id);
    gl->Uniform2i(c->picture.at[PICTURE_SIZE], c->size[0], c->size[1]);
    gl->Uniform1f(c->picture.at[PICTURE_FACTOR],
                  (float)(light / ((double)c->size[0] * (double)c->size[1])));
    gl_bind(gl, 0, c->work);
    gl->BindImageTexture(0, seen->texture, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
    gl_compute(gl, c->width, c->height);
    gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                      GL_TEXTURE_UPDATE_BARRIER_BIT);
}

relume_status gl_convolver_run(struct gl_convolver *c, const struct gl *gl, struct gl_fft *fft,
                               const struct target *seen, const struct target *frame, bool same,
                               double greatest, const struct gl_psf *psf,
                               const struct gl_convolver_view *view, const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    if (!same || !c->kept)
        status = take_frame(c, gl, fft, frame, greatest, log);
    c->kept = !status;
    if (!status)
        status = take_kernel(c, gl, fft, psf, view, log);
    if (!status)
        status = multiply(c, gl, fft, log);
    if (status)
        return status;
    make_picture(c, gl, seen, psf->light);
    return gl_check(gl, "glare", log);
}
