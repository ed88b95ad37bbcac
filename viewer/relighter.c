#include "relighter.h"

#include "books.h"
#include "say.h"
#include "weights.h"

#include <stdlib.h>
#include <string.h>

static const size_t budget = (size_t)1 << 30;  // graphics memory to fill with views

// How GL stores the codes of each kind; `unit` turns its normalised values back into codes.
struct code_format {
    GLint internal;
    GLenum type;
    size_t bytes;
    double unit;
};
static const struct code_format formats[] = {
    [RELUME_STORE_8] = {GL_RGBA8, GL_UNSIGNED_BYTE, 1, 255.0},
    [RELUME_STORE_10] = {GL_RGBA16, GL_UNSIGNED_SHORT, 2, 65535.0},
    [RELUME_STORE_12] = {GL_RGBA16, GL_UNSIGNED_SHORT, 2, 65535.0},
    [RELUME_STORE_16] = {GL_RGBA16, GL_UNSIGNED_SHORT, 2, 65535.0},
    [RELUME_STORE_HALF] = {GL_RGBA16F, GL_HALF_FLOAT, 2, 1.0},
};

enum dot_uniform {
    DOT_RECTANGLE,
    DOT_SIZE,
    DOT_CODES,
    DOT_WEIGHTS,
    DOT_FIRST,
    DOT_LAYERS,
    DOT_CONSTANT,
    DOT_COLOURED,
    DOT_COLOUR,
    DOT_COUNT
};
static const char *const dot_uniforms[] = {
    "rectangle", "frame_size", "codes",    "weights",         "first_layer",
    "layers",    "constant",   "coloured", "colour_constant",
};
enum lookup_uniform {
    LOOKUP_RECTANGLE,
    LOOKUP_SIZE,
    LOOKUP_INDICES,
    LOOKUP_TABLE,
    LOOKUP_BOOKS,
    LOOKUP_COUNT
};
static const char *const lookup_uniforms[] = {
    "rectangle", "frame_size", "indices", "table", "books",
};
enum develop_uniform {
    DEVELOP_RECTANGLE,
    DEVELOP_SIZE,
    DEVELOP_CODED,
    DEVELOP_CURVE,
    DEVELOP_GAMMA,
    DEVELOP_LIGHT,
    DEVELOP_COUNT
};
static const char *const develop_uniforms[] = {
    "rectangle", "frame_size", "coded", "display.curve", "display.gamma", "light",
};

// ---------------------------------------------------------------- upload

// Four planes side by side in every texel; planes beyond the last are 0.
static void interleave(unsigned char *texels, const struct relume_codes *codes, int first,
                       size_t bytes)
{
    const size_t pixels = (size_t)codes->width * (size_t)codes->height;
    memset(texels, 0, pixels * LANES * bytes);
    for (int lane = 0; lane < LANES && first + lane < codes->planes; lane++) {
        const unsigned char *from = codes->plane[first + lane];
        unsigned char *to = texels + (size_t)lane * bytes;
        for (size_t i = 0; i < pixels; i++, from += bytes, to += LANES * bytes)
            memcpy(to, from, bytes);
    }
}

static void upload_array(const struct relighter *r, struct relit_view *v, int array,
                         const struct relume_codes *codes, unsigned char *texels)
{
    const struct gl *gl = r->gl;
    const struct code_format *f = &formats[codes->storage];
    const int first = array * gl->max_layers;
    const int layers = v->layers - first < gl->max_layers ? v->layers - first : gl->max_layers;
    texture_use(gl, 0, GL_TEXTURE_2D_ARRAY, v->array[array]);
    gl->TexImage3D(GL_TEXTURE_2D_ARRAY, 0, f->internal, codes->width, codes->height, layers, 0,
                   GL_RGBA, f->type, NULL);
    texture_settings(gl, GL_TEXTURE_2D_ARRAY);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int i = 0; i < layers; i++) {
        interleave(texels, codes, (first + i) * LANES, f->bytes);
        gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, i, codes->width, codes->height, 1, GL_RGBA,
                          f->type, texels);
    }
}

static void release(struct relighter *r, struct relit_view *v)
{
    if (v->array)
        r->gl->DeleteTextures(v->arrays, v->array);
    target_destroy(&v->relit, r->gl);
    r->bytes -= v->bytes;
    free(v->array);
    free(v->scale);
    if (v->codes.books)
        books_forget(&v->codes);
    *v = (struct relit_view){0};
}

// Views that this frame does not use leave, the longest unused first, until `bytes` more fit.
static void make_room(struct relighter *r, size_t bytes)
{
    while (r->bytes + bytes > r->budget) {
        struct relit_view *oldest = NULL;
        for (struct relit_view *v = r->view; v < r->view + r->views; v++)
            if (v->array && v->used < r->frame && (!oldest || v->used < oldest->used))
                oldest = v;
        if (!oldest)
            return;
        release(r, oldest);
    }
}

// Scale and offset outlive the codes, which the pack may forget.
static relume_status keep_scales(struct relit_view *v, const struct relume_codes *codes)
{
    const size_t n = (size_t)codes->planes;
    v->scale = malloc(2 * n * sizeof *v->scale);
    if (!v->scale)
        return RELUME_ENOMEM;
    memcpy(v->scale, codes->scale, n * sizeof *v->scale);
    memcpy(v->scale + n, codes->offset, n * sizeof *v->scale);
    v->codes = *codes;
    v->codes.plane = NULL;
    v->codes.scale = v->scale;
    v->codes.offset = v->scale + n;
    return RELUME_OK;
}

static relume_status upload_planes(struct relighter *r, struct relit_view *v,
                                   const struct relume_codes *codes)
{
    const size_t pixels = (size_t)codes->width * (size_t)codes->height;
    unsigned char *texels = malloc(pixels * LANES * formats[codes->storage].bytes);
    const relume_status status = texels ? keep_scales(v, codes) : RELUME_ENOMEM;
    for (int i = 0; !status && i < v->arrays; i++)
        upload_array(r, v, i, codes, texels);
    free(texels);
    return status;
}

static relume_status upload_indices(struct relighter *r, struct relit_view *v,
                                    const struct relume_codes *codes)
{
    texture_use(r->gl, 0, GL_TEXTURE_2D_ARRAY, v->array[0]);
    books_upload(r->gl, codes);
    return books_keep(&v->codes, codes);
}

static relume_status upload(struct relighter *r, struct relit_view *v,
                            const struct relume_codes *codes)
{
    const struct gl *gl = r->gl;
    const size_t pixels = (size_t)codes->width * (size_t)codes->height;
    const size_t texel = LANES * formats[codes->storage].bytes;
    const int layers = codes->books ? 1 : (codes->planes + LANES - 1) / LANES;
    const size_t bytes = pixels * LANES * sizeof(float) +
                         (codes->books ? books_bytes(codes) : pixels * texel * (size_t)layers);
    make_room(r, bytes);
    relume_status status = target_create(&v->relit, gl, codes->width, codes->height, r->log);
    if (status)
        return status;
    v->layers = layers;
    v->arrays = (layers + gl->max_layers - 1) / gl->max_layers;
    v->array = calloc((size_t)v->arrays, sizeof *v->array);
    v->bytes = bytes;
    r->bytes += bytes;
    if (!v->array)
        return RELUME_ENOMEM;
    gl->GenTextures(v->arrays, v->array);
    status = (codes->books ? upload_indices : upload_planes)(r, v, codes);
    return status ? status : gl_check(gl, "uploading a view", r->log);
}

static relume_status load(struct relighter *r, int view)
{
    const struct relume_codes *codes;
    relume_status status = r->source.codes(&codes, r->source.user, view);
    if (status)
        return status;
    status = upload(r, &r->view[view], codes);
    if (status)
        release(r, &r->view[view]);
    if (r->source.drop)
        r->source.drop(r->source.user, view);
    return status;
}

// ---------------------------------------------------------------- passes

static void draw_all(const struct gl *gl, const struct program *p, const struct target *into)
{
    gl->Uniform4f(p->at[DOT_RECTANGLE], 0, 0, (float)into->width, (float)into->height);
    gl->Uniform2f(p->at[DOT_SIZE], (float)into->width, (float)into->height);
    gl->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

// The dot product of all planes, added to what `into` holds.
static void pass_dot(const struct relighter *r, const struct relit_view *v, const struct weights *w,
                     const struct target *into)
{
    const struct gl *gl = r->gl;
    texture_use(gl, 1, GL_TEXTURE_2D, r->weights);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, CHANNELS, v->layers, 0, GL_RGBA, GL_FLOAT,
                   w->plane);
    texture_settings(gl, GL_TEXTURE_2D);
    gl->UseProgram(r->dot.id);
    gl->Uniform1i(r->dot.at[DOT_CODES], 0);
    gl->Uniform1i(r->dot.at[DOT_WEIGHTS], 1);
    for (int i = 0; i < v->arrays; i++) {
        const int first = i * gl->max_layers;
        const int left = v->layers - first;
        const float with = i == 0 ? 1.0f : 0.0f;
        texture_use(gl, 0, GL_TEXTURE_2D_ARRAY, v->array[i]);
        gl->Uniform1i(r->dot.at[DOT_FIRST], first);
        gl->Uniform1i(r->dot.at[DOT_LAYERS], left < gl->max_layers ? left : gl->max_layers);
        gl->Uniform3f(r->dot.at[DOT_CONSTANT], with * w->constant[0], with * w->constant[1],
                      with * w->constant[2]);
        gl->Uniform1i(r->dot.at[DOT_COLOURED], relume_coder_info(v->codes.coder)->luminance);
        gl->Uniform3f(r->dot.at[DOT_COLOUR], w->colour[0], w->colour[1], w->colour[2]);
        draw_all(gl, &r->dot, into);
    }
}

// The look-up of all codebooks under `n` lights, added to what `into` holds.
static relume_status pass_lookup(const struct relighter *r, const struct relit_view *v,
                                 const struct relume_light *lights, int n,
                                 const struct target *into)
{
    const struct gl *gl = r->gl;
    texture_use(gl, 1, GL_TEXTURE_2D_ARRAY, r->table);
    const relume_status status = books_relight(gl, &v->codes, lights, n);
    if (status)
        return status;
    texture_use(gl, 0, GL_TEXTURE_2D_ARRAY, v->array[0]);
    gl->UseProgram(r->lookup.id);
    gl->Uniform1i(r->lookup.at[LOOKUP_INDICES], 0);
    gl->Uniform1i(r->lookup.at[LOOKUP_TABLE], 1);
    gl->Uniform1i(r->lookup.at[LOOKUP_BOOKS], v->codes.books);
    draw_all(gl, &r->lookup, into);
    return RELUME_OK;
}

// `coded` decoded by the file's curve, times the light, added to what the target in use holds.
static void pass_develop(const struct relighter *r, const struct relit_view *v, const float rgb[3])
{
    const struct gl *gl = r->gl;
    texture_use(gl, 0, GL_TEXTURE_2D, r->coded.texture);
    gl->UseProgram(r->develop.id);
    gl->Uniform1i(r->develop.at[DEVELOP_CODED], 0);
    gl->Uniform1i(r->develop.at[DEVELOP_CURVE], (GLint)v->codes.display.curve);
    gl->Uniform1f(r->develop.at[DEVELOP_GAMMA], v->codes.display.gamma);
    gl->Uniform3f(r->develop.at[DEVELOP_LIGHT], rgb[0], rgb[1], rgb[2]);
    draw_all(gl, &r->develop, &v->relit);
}

static void add_light(struct weights *w, const struct relit_view *v,
                      const struct relume_light *light, const float rgb[3])
{
    weights_add(w, &v->codes, formats[v->codes.storage].unit, light->direction, rgb);
}

static relume_status relight_linear(struct relighter *r, struct relit_view *v, struct weights *w)
{
    for (int i = 0; i < r->lights; i++)
        add_light(w, v, &r->light[i], r->light[i].rgb);
    pass_dot(r, v, w, &v->relit);
    return RELUME_OK;
}

static relume_status prepare_coded(struct relighter *r, const struct relit_view *v)
{
    if (r->coded.width == v->relit.width && r->coded.height == v->relit.height)
        return RELUME_OK;
    target_destroy(&r->coded, r->gl);
    return target_create(&r->coded, r->gl, v->relit.width, v->relit.height, r->log);
}

static relume_status relight_display(struct relighter *r, struct relit_view *v, struct weights *w)
{
    static const float one[3] = {1, 1, 1};
    relume_status status = prepare_coded(r, v);
    for (int i = 0; !status && i < r->lights; i++) {
        target_begin(&r->coded, r->gl);
        if (v->codes.books) {
            status = pass_lookup(r, v, &r->light[i], 1, &r->coded);
        } else {
            weights_clear(w);
            add_light(w, v, &r->light[i], one);
            pass_dot(r, v, w, &r->coded);
        }
        target_resume(&v->relit, r->gl);
        pass_develop(r, v, r->light[i].rgb);
    }
    return status;
}

// All lights at once: sums in linear light, or one codebook that is linear when relit.
static relume_status relight_books(struct relighter *r, struct relit_view *v)
{
    return pass_lookup(r, v, r->light, r->lights, &v->relit);
}

static relume_status relight(struct relighter *r, struct relit_view *v)
{
    const struct gl *gl = r->gl;
    const bool display = v->codes.domain == RELUME_DOMAIN_DISPLAY;
    struct weights w;
    relume_status status = weights_create(&w, v->codes.coder, v->codes.planes);
    if (status)
        return status;
    gl->BindVertexArray(r->vertices);
    target_begin(&v->relit, gl);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    if (v->codes.books && (!display || v->codes.books == 1))
        status = relight_books(r, v);
    else
        status = (display ? relight_display : relight_linear)(r, v, &w);
    gl->Disable(GL_BLEND);
    weights_destroy(&w);
    if (!status)
        status = gl_check(gl, "relighting", r->log);
    v->fresh = !status;
    return status;
}

// ---------------------------------------------------------------- interface

relume_status relighter_create(struct relighter *r, const struct gl *gl,
                               const struct code_source *source, int views,
                               const struct relume_log *log)
{
    *r = (struct relighter){
        .gl = gl, .log = log, .source = *source, .views = views, .budget = budget};
    r->view = calloc((size_t)views, sizeof *r->view);
    relume_status status = r->view ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = program_create(&r->dot, gl, "relight.frag", dot_uniforms, DOT_COUNT, log);
    if (!status)
        status =
            program_create(&r->develop, gl, "develop.frag", develop_uniforms, DEVELOP_COUNT, log);
    if (!status)
        status = program_create(&r->lookup, gl, "lookup.frag", lookup_uniforms, LOOKUP_COUNT, log);
    gl->GenVertexArrays(1, &r->vertices);
    gl->GenTextures(1, &r->table);
    gl->GenTextures(1, &r->weights);
    if (status)
        relighter_destroy(r);
    return status;
}

void relighter_destroy(struct relighter *r)
{
    if (!r->gl)
        return;
    for (int i = 0; r->view && i < r->views; i++)
        release(r, &r->view[i]);
    target_destroy(&r->coded, r->gl);
    program_destroy(&r->dot, r->gl);
    program_destroy(&r->develop, r->gl);
    program_destroy(&r->lookup, r->gl);
    r->gl->DeleteTextures(1, &r->table);
    r->gl->DeleteTextures(1, &r->weights);
    r->gl->DeleteVertexArrays(1, &r->vertices);
    free(r->view);
    free(r->light);
    *r = (struct relighter){0};
}

static bool same_light(const struct relume_light *a, const struct relume_light *b)
{
    return a->kind == b->kind && a->direction.x == b->direction.x &&
           a->direction.y == b->direction.y && a->direction.z == b->direction.z &&
           a->rgb[0] == b->rgb[0] && a->rgb[1] == b->rgb[1] && a->rgb[2] == b->rgb[2];
}

static bool same_lights(const struct relighter *r, const struct relume_light *lights, int n)
{
    if (!r->light || r->lights != n)
        return false;
    for (int i = 0; i < n; i++)
        if (!same_light(&r->light[i], &lights[i]))
            return false;
    return true;
}

relume_status relighter_begin(struct relighter *r, const struct relume_light *lights, int n)
{
    r->frame++;
    if (same_lights(r, lights, n))
        return RELUME_OK;
    const size_t bytes = (size_t)n * sizeof *lights;
    struct relume_light *copy = malloc(bytes ? bytes : 1);
    if (!copy)
        return RELUME_ENOMEM;
    memcpy(copy, lights, bytes);
    free(r->light);
    r->light = copy;
    r->lights = n;
    for (int i = 0; i < r->views; i++)
        r->view[i].fresh = false;
    return RELUME_OK;
}

relume_status relighter_view(const struct target **out, struct relighter *r, int view)
{
    struct relit_view *v = &r->view[view];
    *out = NULL;
    relume_status status = v->array ? RELUME_OK : load(r, view);
    if (status)
        return status;
    v->used = r->frame;
    if (!v->fresh)
        status = relight(r, v);
    if (!status)
        *out = &v->relit;
    return status;
}
