// draws.c - distant lights on the GPU: dot products of planes, look-ups of codebooks
#include "common/vec.h"
#include "format/coder/coding.h"
#include "relit/books.h"
#include "relit/gl_relighter_parts.h"
#include "relit/moving.h"
#include "relit/weights.h"

#include <stdlib.h>

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
    DEVELOP_GUARD,
    DEVELOP_COUNT
};
static const char *const develop_uniforms[] = {
    "rectangle", "frame_size", "coded", "display.curve", "display.gamma", "light", "guard",
};

// ---------------------------------------------------------------- making

relume_status draws_create(struct gl_relighter *r)
{
    relume_status status =
        program_create(&r->dot, r->gl, "relight.frag", dot_uniforms, DOT_COUNT, r->log);
    if (!status)
        status = program_create(&r->develop, r->gl, "develop.frag", develop_uniforms, DEVELOP_COUNT,
                                r->log);
    if (!status)
        status =
            program_create(&r->lookup, r->gl, "lookup.frag", lookup_uniforms, LOOKUP_COUNT, r->log);
    r->gl->GenVertexArrays(1, &r->vertices);
    r->gl->GenTextures(1, &r->table);
    r->gl->GenTextures(1, &r->weights);
    return status;
}

void draws_destroy(struct gl_relighter *r)
{
    target_destroy(&r->coded, r->gl);
    program_destroy(&r->dot, r->gl);
    program_destroy(&r->develop, r->gl);
    program_destroy(&r->lookup, r->gl);
    relume_weight_grid_destroy(&r->grid);
    r->gl->DeleteTextures(1, &r->table);
    r->gl->DeleteTextures(1, &r->weights);
    r->gl->DeleteVertexArrays(1, &r->vertices);
}

// ---------------------------------------------------------------- draws

void draws_begin(const struct gl_relighter *r)
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

static relume_status need_grid(struct gl_relighter *r, const relume_coder *coder)
{
    return r->grid ? RELUME_OK
                   : relume_weight_grid_create(&r->grid, coder,
                                               relume_weight_grid_params(.sums = true));
}

// The dot product of all planes, added to what `into` holds.
static void draw_dot(const struct gl_relighter *r, const struct relit_view *v,
                     const struct weights *w, const struct target *into)
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
static relume_status draw_lookup(const struct gl_relighter *r, const struct relit_view *v,
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
static void develop(const struct gl_relighter *r, const struct relit_view *v,
                    const struct target *coded, struct relume_transfer display, const float rgb[3],
                    bool guard)
{
    const struct gl *gl = r->gl;
    texture_use(gl, 0, GL_TEXTURE_2D, coded->texture);
    gl->UseProgram(r->develop.id);
    gl->Uniform1i(r->develop.at[DEVELOP_CODED], 0);
    gl->Uniform1i(r->develop.at[DEVELOP_CURVE], (GLint)display.curve);
    gl->Uniform1f(r->develop.at[DEVELOP_GAMMA], display.gamma);
    gl->Uniform3f(r->develop.at[DEVELOP_LIGHT], rgb[0], rgb[1], rgb[2]);
    gl->Uniform1i(r->develop.at[DEVELOP_GUARD], guard);
    draw_all(gl, &r->develop, &v->relit);
}

void draws_develop(const struct gl_relighter *r, const struct relit_view *v,
                   const struct target *coded, struct relume_transfer display, const float rgb[3])
{
    develop(r, v, coded, display, rgb, false);
}

void draws_guarded(const struct gl_relighter *r, const struct relit_view *v,
                   const struct target *picture)
{
    static const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};
    static const float one[3] = {1, 1, 1};
    develop(r, v, picture, linear, one, true);
}

// What environments are part of is gathered in r->coded, then added without what is below 0.
static void add_guarded(struct gl_relighter *r, struct relit_view *v)
{
    target_resume(&v->relit, r->gl);
    draws_guarded(r, v, &r->coded);
}

relume_status draws_fit(const struct gl_relighter *r, struct target *target,
                        const struct relit_view *v)
{
    return target_need(target, r->gl, v->relit.width, v->relit.height, r->log);
}

relume_status draws_scratch(struct gl_relighter *r, const struct relit_view *v)
{
    return draws_fit(r, &r->coded, v);
}

static relume_status add_linear(struct gl_relighter *r, struct relit_view *v, struct weights *w)
{
    const double unit = code_format_of(&v->codes)->unit;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < r->lights; i++) {
        const struct relume_light *l = &r->light[i];
        if (l->kind == RELUME_LIGHT_DIRECTIONAL)
            weights_add(w, &v->codes, unit, l->direction, l->rgb);
        else if (l->kind == RELUME_LIGHT_ENVIRONMENT && !(status = need_grid(r, v->codes.coder)))
            weights_add_environment(w, &v->codes, unit, r->grid, l);
    }
    const bool guard = gl_relighter_has_kind(r, gl_relighter_is_environment);
    if (!status && guard)
        status = draws_scratch(r, v);
    if (status || !gl_relighter_has_kind(r, gl_relighter_is_distant))
        return status;
    if (guard)
        target_begin(&r->coded, r->gl);
    draw_dot(r, v, w, guard ? &r->coded : &v->relit);
    if (guard)
        add_guarded(r, v);
    return RELUME_OK;
}

// What a directional light shows, alone, in r->coded; it becomes linear by *curve and *times.
static relume_status relight_one(struct relume_transfer *curve, float times[3],
                                 struct gl_relighter *r, const struct relit_view *v,
                                 struct weights *w, const struct relume_light *light,
                                 struct relume_vec3 from, const float rgb[3])
{
    static const float one[3] = {1, 1, 1};
    const bool display = v->codes.domain == RELUME_DOMAIN_DISPLAY;
    const bool whole = v->codes.books && (!display || v->codes.books == 1);
    *curve = display && !whole ? v->codes.display
                               : (struct relume_transfer){.curve = RELUME_CURVE_LINEAR};
    for (int c = 0; c < 3; c++)
        times[c] = whole ? 1.0f : rgb[c];
    target_begin(&r->coded, r->gl);
    if (v->codes.books)
        return draw_lookup(r, v, light, 1, &r->coded);
    weights_clear(w);
    weights_add(w, &v->codes, code_format_of(&v->codes)->unit, from, one);
    draw_dot(r, v, w, &r->coded);
    return RELUME_OK;
}

static relume_status add_alone(struct gl_relighter *r, struct relit_view *v, struct weights *w,
                               const struct relume_light *light)
{
    struct moving_picture p = {.coded = &r->coded,
                               .coder = v->codes.coder,
                               .display = {.curve = RELUME_CURVE_LINEAR},
                               .left = v->at.left,
                               .top = v->at.top};
    const float share =
        (float)relume_coder_clamp(&p.direction, v->codes.coder, vec3_unit(light->direction));
    for (int c = 0; c < 3; c++)
        p.rgb[c] = share * light->rgb[c];
    if (v->codes.domain == RELUME_DOMAIN_DISPLAY)
        p.display = v->codes.display;
    relume_status status = relight_one(&p.picture, p.times, r, v, w, light, p.direction, p.rgb);
    if (!status && v->moving.shadows)
        return moving_draw(&r->moving, &v->moving, &p, &v->relit);
    if (!status) {
        target_resume(&v->relit, r->gl);
        draws_develop(r, v, &r->coded, p.picture, p.times);
    }
    return status;
}

// Directional lights that are decoded one by one.
static relume_status add_one_by_one(struct gl_relighter *r, struct relit_view *v, struct weights *w)
{
    relume_status status = draws_scratch(r, v);
    for (int i = 0; !status && i < r->lights; i++)
        if (r->light[i].kind == RELUME_LIGHT_DIRECTIONAL)
            status = add_alone(r, v, w, &r->light[i]);
    return status;
}

// The distant lights at once: sums in linear light, or one codebook that is linear when relit;
// that of the display domain leaves environments to its linear copy.
static relume_status add_books(struct gl_relighter *r, struct relit_view *v)
{
    const bool display = v->codes.domain == RELUME_DOMAIN_DISPLAY;
    struct relume_light *distant = malloc((size_t)r->lights * sizeof *distant + 1);
    relume_status status = distant ? RELUME_OK : RELUME_ENOMEM;
    int n = 0;
    for (int i = 0; !status && i < r->lights; i++)
        if (r->light[i].kind == RELUME_LIGHT_DIRECTIONAL ||
            (!display && gl_relighter_is_environment(r->light[i].kind)))
            distant[n++] = r->light[i];
    const bool guard = !display && gl_relighter_has_kind(r, gl_relighter_is_environment);
    if (!status && guard)
        status = need_grid(r, v->codes.coder);
    if (!status && guard)
        status = draws_scratch(r, v);
    if (!status && guard)
        target_begin(&r->coded, r->gl);
    if (!status)
        status = draw_lookup(r, v, distant, n, guard ? &r->coded : &v->relit);
    if (!status && guard)
        add_guarded(r, v);
    free(distant);
    return status;
}

relume_status draws_distant(struct gl_relighter *r, struct relit_view *v)
{
    const bool display = v->codes.domain == RELUME_DOMAIN_DISPLAY;
    if (v->codes.books && !v->moving.shadows && (!display || v->codes.books == 1))
        return add_books(r, v);
    struct weights w;
    relume_status status = weights_create(&w, v->codes.coder, v->codes.planes);
    if (status)
        return status;
    status = (display || v->moving.shadows ? add_one_by_one : add_linear)(r, v, &w);
    weights_destroy(&w);
    return status;
}

relume_status draws_environment(struct gl_relighter *r, struct relit_view *v,
                                const struct relume_light *light)
{
    struct weights w = {0};
    relume_status status = need_grid(r, v->codes.coder);
    if (!status)
        status = draws_scratch(r, v);
    if (!status && !v->codes.books)
        status = weights_create(&w, v->codes.coder, v->codes.planes);
    if (status)
        return status;
    target_begin(&r->coded, r->gl);
    if (v->codes.books)
        return draw_lookup(r, v, light, 1, &r->coded);
    weights_add_environment(&w, &v->codes, code_format_of(&v->codes)->unit, r->grid, light);
    draw_dot(r, v, &w, &r->coded);
    weights_destroy(&w);
    return RELUME_OK;
}
