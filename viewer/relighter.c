#include "relighter.h"

#include "books.h"
#include "say.h"
#include "weights.h"

#include <stdlib.h>
#include <string.h>

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
    nearby_view_destroy(&v->near, r->gl);
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

static relume_status keep(struct relighter *r, int view, const struct relume_codes *codes)
{
    const relume_status status = upload(r, &r->view[view], codes);
    if (status)
        release(r, &r->view[view]);
    return status;
}

static relume_status load(struct relighter *r, int view)
{
    const struct relume_codes *codes;
    relume_status status = r->source.codes(&codes, r->source.user, view);
    if (status)
        return status;
    status = keep(r, view, codes);
    if (r->source.drop)
        r->source.drop(r->source.user, view);
    return status;
}

// What the loader has read, up to `view`; -1: as much as is there.
static relume_status take_loaded(struct relighter *r, int view)
{
    struct loaded loaded;
    relume_status status = RELUME_OK;
    while (!status && (view < 0 || !r->view[view].array) &&
           loader_take(&loaded, r->loader, view >= 0)) {
        status = loaded.status;
        if (status)
            break;
        if (!r->view[loaded.view].array)
            status = keep(r, loaded.view, loaded.codes);
        if (r->source.drop)
            r->source.drop(r->source.user, loaded.view);
    }
    return status;
}

// ---------------------------------------------------------------- passes

static void begin_adding(const struct relighter *r)
{
    r->gl->BindVertexArray(r->vertices);
    r->gl->Enable(GL_BLEND);
    r->gl->BlendFunc(GL_ONE, GL_ONE);
}

static void draw_all(const struct gl *gl, const struct program *p, const struct target *into)
{
    gl->Uniform4f(p->at[DOT_RECTANGLE], 0, 0, (float)into->width, (float)into->height);
    gl->Uniform2f(p->at[DOT_SIZE], (float)into->width, (float)into->height);
    gl->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

static bool is_environment(enum relume_light_kind kind)
{
    return kind == RELUME_LIGHT_ENVIRONMENT;
}

static bool is_distant(enum relume_light_kind kind)
{
    return !relume_light_is_near(kind);
}

static bool has_kind(const struct relighter *r, bool (*is)(enum relume_light_kind))
{
    for (int i = 0; i < r->lights; i++)
        if (is(r->light[i].kind))
            return true;
    return false;
}

static relume_status need_grid(struct relighter *r, const relume_coder *coder)
{
    return r->grid ? RELUME_OK : relume_weight_grid_create(&r->grid, coder, NULL);
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
    const relume_status status = books_relight(gl, &v->codes, lights, n, r->grid);
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

// `coded` decoded by `display`, times the light, added to what the target in use holds.
static void pass_develop(const struct relighter *r, const struct relit_view *v,
                         const struct target *coded, struct relume_transfer display,
                         const float rgb[3])
{
    const struct gl *gl = r->gl;
    texture_use(gl, 0, GL_TEXTURE_2D, coded->texture);
    gl->UseProgram(r->develop.id);
    gl->Uniform1i(r->develop.at[DEVELOP_CODED], 0);
    gl->Uniform1i(r->develop.at[DEVELOP_CURVE], (GLint)display.curve);
    gl->Uniform1f(r->develop.at[DEVELOP_GAMMA], display.gamma);
    gl->Uniform3f(r->develop.at[DEVELOP_LIGHT], rgb[0], rgb[1], rgb[2]);
    draw_all(gl, &r->develop, &v->relit);
}

static relume_status relight_linear(struct relighter *r, struct relit_view *v, struct weights *w)
{
    const double unit = formats[v->codes.storage].unit;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < r->lights; i++) {
        const struct relume_light *l = &r->light[i];
        if (l->kind == RELUME_LIGHT_DIRECTIONAL)
            weights_add(w, &v->codes, unit, l->direction, l->rgb);
        else if (l->kind == RELUME_LIGHT_ENVIRONMENT && !(status = need_grid(r, v->codes.coder)))
            weights_add_environment(w, &v->codes, unit, r->grid, l);
    }
    if (!status && has_kind(r, is_distant))
        pass_dot(r, v, w, &v->relit);
    return status;
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
        if (r->light[i].kind != RELUME_LIGHT_DIRECTIONAL)
            continue;
        target_begin(&r->coded, r->gl);
        if (v->codes.books) {
            status = pass_lookup(r, v, &r->light[i], 1, &r->coded);
        } else {
            weights_clear(w);
            weights_add(w, &v->codes, formats[v->codes.storage].unit, r->light[i].direction, one);
            pass_dot(r, v, w, &r->coded);
        }
        target_resume(&v->relit, r->gl);
        pass_develop(r, v, &r->coded, v->codes.display, r->light[i].rgb);
    }
    return status;
}

// The distant lights at once: sums in linear light, or one codebook that is linear when relit;
// that of the display domain leaves environments to its linear twin.
static relume_status relight_books(struct relighter *r, struct relit_view *v)
{
    const bool display = v->codes.domain == RELUME_DOMAIN_DISPLAY;
    struct relume_light *distant = malloc((size_t)r->lights * sizeof *distant + 1);
    relume_status status = distant ? RELUME_OK : RELUME_ENOMEM;
    int n = 0;
    for (int i = 0; !status && i < r->lights; i++)
        if (r->light[i].kind == RELUME_LIGHT_DIRECTIONAL ||
            (!display && is_environment(r->light[i].kind)))
            distant[n++] = r->light[i];
    if (!status && !display && has_kind(r, is_environment))
        status = need_grid(r, v->codes.coder);
    if (!status)
        status = pass_lookup(r, v, distant, n, &v->relit);
    free(distant);
    return status;
}

// ---------------------------------------------------------------- near lights, environments

static struct nearby_codes nearby_codes_of(const struct relit_view *v)
{
    return (struct nearby_codes){&v->codes, v->array[0], v->layers, formats[v->codes.storage].unit};
}

static relume_status need_surface(struct relighter *r, struct relit_view *v)
{
    struct relume_image surface = {0};
    const struct nearby_codes codes = nearby_codes_of(v);
    if (v->near.surface.data)
        return RELUME_OK;
    if (v->arrays > 1)
        return say(r->log, RELUME_ESYSTEM,
                   "near lights on %d planes: OpenGL has %d texture layers of four here",
                   v->codes.planes, r->gl->max_layers);
    const relume_status status =
        r->source.surface ? r->source.surface(&surface, r->source.user, (int)(v - r->view))
                          : RELUME_EINVAL;
    if (status == RELUME_EINVAL)
        return say(r->log, RELUME_EDATA,
                   "a near light needs to know where the surface is; expected a file with depth");
    return status ? status : nearby_view_create(&v->near, &r->near, &codes, &surface);
}

static relume_status relight_near(struct relighter *r, struct relit_view *v)
{
    const struct nearby_codes codes = nearby_codes_of(v);
    relume_status status = need_surface(r, v);
    target_resume(&v->relit, r->gl);
    for (int i = 0; !status && i < r->lights; i++)
        if (relume_light_is_near(r->light[i].kind))
            status = nearby_draw(&r->near, &v->near, &codes, &r->light[i]);
    return status;
}

static relume_status linear_codes(const struct relume_codes **out, void *user, int view)
{
    struct linear_source *s = user;
    const struct relume_codes *codes;
    relume_refit **refit = s->first ? &s->refit : &s->first;
    relume_status status = s->source.codes(&codes, s->source.user, view);
    if (!status)
        status =
            relume_refit_create(refit, codes, relume_refit_params(.log = s->log, .like = s->first));
    if (!status)
        *out = relume_refit_codes(*refit);
    return status;
}

static void linear_drop(void *user, int view)
{
    struct linear_source *s = user;
    if (s->refit)
        relume_refit_destroy(&s->refit);
    else
        relume_refit_forget(s->first);
    if (s->source.drop)
        s->source.drop(s->source.user, view);
}

static relume_status need_linear(struct relighter *r)
{
    if (r->linear)
        return RELUME_OK;
    r->linear = malloc(sizeof *r->linear);
    if (!r->linear)
        return RELUME_ENOMEM;
    r->linear_source = (struct linear_source){.source = r->source, .log = r->log};
    const struct code_source source = {linear_codes, linear_drop, &r->linear_source, NULL};
    const relume_status status = relighter_create(r->linear, r->gl, &source, r->views, r->log);
    if (status) {
        free(r->linear);
        r->linear = NULL;
    }
    return status;
}

// The linear twin under the environments alone.
static relume_status relight_environments(struct relighter *r, struct relit_view *v)
{
    static const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};
    static const float one[3] = {1.0f, 1.0f, 1.0f};
    const struct target *twin;
    struct relume_light *environments = malloc((size_t)r->lights * sizeof *environments);
    int n = 0;
    relume_status status = environments ? need_linear(r) : RELUME_ENOMEM;
    for (int i = 0; !status && i < r->lights; i++)
        if (is_environment(r->light[i].kind))
            environments[n++] = r->light[i];
    if (!status)
        status = relighter_begin(r->linear, environments, n);
    if (!status)
        status = relighter_view(&twin, r->linear, (int)(v - r->view));
    free(environments);
    if (status)
        return status;
    begin_adding(r);
    target_resume(&v->relit, r->gl);
    pass_develop(r, v, twin, linear, one);
    return RELUME_OK;
}

static relume_status relight(struct relighter *r, struct relit_view *v)
{
    const struct gl *gl = r->gl;
    const bool display = v->codes.domain == RELUME_DOMAIN_DISPLAY;
    struct weights w;
    relume_status status = weights_create(&w, v->codes.coder, v->codes.planes);
    if (status)
        return status;
    target_begin(&v->relit, gl);
    begin_adding(r);
    if (v->codes.books && (!display || v->codes.books == 1))
        status = relight_books(r, v);
    else
        status = (display ? relight_display : relight_linear)(r, v, &w);
    if (!status && display && has_kind(r, is_environment))
        status = relight_environments(r, v);
    if (!status && has_kind(r, relume_light_is_near))
        status = relight_near(r, v);
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
        .gl = gl, .log = log, .source = *source, .views = views, .budget = (size_t)1 << 30};
    r->view = calloc((size_t)views, sizeof *r->view);
    relume_status status = r->view ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = program_create(&r->dot, gl, "relight.frag", dot_uniforms, DOT_COUNT, log);
    if (!status)
        status =
            program_create(&r->develop, gl, "develop.frag", develop_uniforms, DEVELOP_COUNT, log);
    if (!status)
        status = program_create(&r->lookup, gl, "lookup.frag", lookup_uniforms, LOOKUP_COUNT, log);
    if (!status)
        status = nearby_create(&r->near, gl, log);
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
    loader_destroy(&r->loader);
    for (int i = 0; r->view && i < r->views; i++)
        release(r, &r->view[i]);
    if (r->linear)
        relighter_destroy(r->linear);
    free(r->linear);
    relume_refit_destroy(&r->linear_source.first);
    target_destroy(&r->coded, r->gl);
    program_destroy(&r->dot, r->gl);
    program_destroy(&r->develop, r->gl);
    program_destroy(&r->lookup, r->gl);
    nearby_destroy(&r->near);
    relume_weight_grid_destroy(&r->grid);
    r->gl->DeleteTextures(1, &r->table);
    r->gl->DeleteTextures(1, &r->weights);
    r->gl->DeleteVertexArrays(1, &r->vertices);
    free(r->view);
    free(r->light);
    *r = (struct relighter){0};
}

static bool same_vector(struct relume_vec3 a, struct relume_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static bool same_light(const struct relume_light *a, const struct relume_light *b)
{
    return a->kind == b->kind && same_vector(a->direction, b->direction) &&
           same_vector(a->position, b->position) && same_vector(a->u, b->u) &&
           same_vector(a->v, b->v) && a->disc == b->disc && a->nofall == b->nofall &&
           a->half_angle_deg == b->half_angle_deg && a->rotate_deg == b->rotate_deg &&
           a->rgb[0] == b->rgb[0] && a->rgb[1] == b->rgb[1] && a->rgb[2] == b->rgb[2] &&
           a->image == b->image && a->environment == b->environment && a->ies == b->ies;
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

static relume_status begin_frame(struct relighter *r)
{
    r->frame++;
    r->pending = false;
    if (!r->loader)
        return RELUME_OK;
    loader_clear(r->loader);
    return take_loaded(r, -1);
}

relume_status relighter_begin(struct relighter *r, const struct relume_light *lights, int n)
{
    const relume_status status = begin_frame(r);
    if (status || same_lights(r, lights, n))
        return status;
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

void relighter_forget(struct relighter *r)
{
    nearby_forget(&r->near);
    free(r->light);
    r->light = NULL;
    if (r->linear)
        relighter_forget(r->linear);
}

static relume_status show(const struct target **out, struct relighter *r, struct relit_view *v)
{
    v->used = r->frame;
    const relume_status status = v->fresh ? RELUME_OK : relight(r, v);
    if (!status)
        *out = &v->relit;
    return status;
}

relume_status relighter_view(const struct target **out, struct relighter *r, int view)
{
    struct relit_view *v = &r->view[view];
    relume_status status = RELUME_OK;
    *out = NULL;
    if (!v->array && r->loader) {
        loader_ask(r->loader, view);
        r->pending = true;
        return RELUME_OK;
    }
    if (!v->array)
        status = load(r, view);
    return status ? status : show(out, r, v);
}

relume_status relighter_wait(const struct target **out, struct relighter *r, int view)
{
    *out = NULL;
    if (!r->loader || r->view[view].array)
        return relighter_view(out, r, view);
    loader_ask(r->loader, view);
    const relume_status status = take_loaded(r, view);
    return status ? status : show(out, r, &r->view[view]);
}

bool relighter_has(const struct relighter *r, int view)
{
    return r->view[view].array != NULL;
}

relume_status relighter_stream(struct relighter *r)
{
    return loader_create(&r->loader, &r->source, r->views);
}
