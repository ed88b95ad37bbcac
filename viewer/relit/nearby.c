// nearby.c - lights that stand near, on the GPU: each is a draw that evaluates the basis at every
// pixel's own direction
#include "relit/nearby.h"

#include "cli/program/say.h"
#include "gl/program.h"
#include "relight/light/environment.h"
#include "relight/light/refit.h"
#include "relit/captured_uniforms.h"
#include "relit/weights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum uniform {
    RECTANGLE,
    SIZE,
    CODES,
    PICTURE,
    SURFACE,
    GRID,
    TRIANGLES,
    TRIANGLE_COUNT,
    GRID_ROWS,
    TILES,
    AFFINE,
    INDICES,
    VECTORS,
    LIGHT,
    PATCHES = LIGHT + LIGHT_UNIFORMS,
    ZONE,
    FORM = ZONE + ZONE_UNIFORMS,
    COEFFICIENTS,
    LAYERS,
    BOOKS,
    CODED,
    CURVE,
    GAMMA,
    UNIFORMS
};
static const char *const uniforms[] = {
    "rectangle", "frame_size",     "codes",     "picture",       "surface",       "grid",
    "triangles", "triangle_count", "grid_rows", "tiles",         "affine",        "indices",
    "vectors",   LIGHT_NAMES,      "patches",   ZONE_NAMES,      "form",          "coefficients",
    "layers",    "books",          "coded",     "display.curve", "display.gamma",
};

// Texture units; each sampler has its own.
enum unit {
    UNIT_CODES,
    UNIT_PICTURE,
    UNIT_SURFACE,
    UNIT_GRID,
    UNIT_TRIANGLES,
    UNIT_AFFINE,
    UNIT_INDICES,
    UNIT_VECTORS,
    UNIT_BORDER
};

// As in near.frag.
enum { FORM_SEPARATE, FORM_JOINT, FORM_LUMINANCE };
enum { VECTORS_WIDE = 64 };

relume_status nearby_create(struct nearby *near, const struct gl *gl, const struct relume_log *log)
{
    *near = (struct nearby){.gl = gl, .log = log, .uniforms = {.gl = gl, .log = log}};
    gl->GenTextures(1, &near->grid);
    gl->GenTextures(1, &near->triangles);
    gl->GenTextures(1, &near->patches);
    gl->GenTextures(1, &near->border);
    return program_create(&near->program, gl, "near.frag", uniforms, UNIFORMS, log);
}

void nearby_forget(struct nearby *near)
{
    light_uniforms_forget(&near->uniforms);
}

void nearby_destroy(struct nearby *near)
{
    if (!near->gl)
        return;
    nearby_forget(near);
    near->gl->DeleteTextures(1, &near->grid);
    near->gl->DeleteTextures(1, &near->triangles);
    near->gl->DeleteTextures(1, &near->patches);
    near->gl->DeleteTextures(1, &near->border);
    program_destroy(&near->program, near->gl);
    *near = (struct nearby){0};
}

// ---------------------------------------------------------------- weights by direction

// Four coefficients of one set, from every node.
static void gather_layer(float *texel, const struct relume_weight_grid_info *g, int layer)
{
    const int sets = g->sets, set = layer % sets, first = layer / sets * LANES;
    const size_t nodes = (size_t)relume_weight_grid_rows(g) * (size_t)g->columns;
    for (size_t i = 0; i < nodes; i++)
        for (int lane = 0; lane < LANES; lane++, texel++)
            *texel = first + lane < g->coefficients
                         ? g->data[i * (size_t)g->stride +
                                   (size_t)(set * g->coefficients + first + lane)]
                         : 0.0f;
}

static void gather_constants(float *texel, const struct relume_weight_grid_info *g)
{
    const size_t nodes = (size_t)relume_weight_grid_rows(g) * (size_t)g->columns;
    memset(texel, 0, nodes * LANES * sizeof *texel);
    for (size_t i = 0; g->sets == 3 && i < nodes; i++)
        memcpy(texel + LANES * i, g->data + i * (size_t)g->stride + 3 * (size_t)g->coefficients,
               3 * sizeof *texel);
}

static relume_status upload_grid(struct nearby *near, const struct relume_weight_grid_info *g)
{
    const struct gl *gl = near->gl;
    const int layers = (g->coefficients + LANES - 1) / LANES * g->sets + 1;
    if (layers > gl->max_layers)
        return say(near->log, RELUME_ESYSTEM,
                   "near lights on %d coefficients take %d texture layers; OpenGL has %d here",
                   g->coefficients, layers, gl->max_layers);
    const int rows = relume_weight_grid_rows(g);
    float *texels = malloc((size_t)rows * (size_t)g->columns * LANES * sizeof *texels);
    if (!texels)
        return RELUME_ENOMEM;
    texture_use(gl, UNIT_GRID, GL_TEXTURE_2D_ARRAY, near->grid);
    // Between triangles nodes are few, and nothing is filtered.
    gl->TexImage3D(GL_TEXTURE_2D_ARRAY, 0, g->triangles ? GL_RGBA32F : GL_RGBA16F, g->columns, rows,
                   layers, 0, GL_RGBA, GL_FLOAT, NULL);
    texture_settings(gl, GL_TEXTURE_2D_ARRAY);
    gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    for (int i = 0; i < layers; i++) {
        if (i < layers - 1)
            gather_layer(texels, g, i);
        else
            gather_constants(texels, g);
        gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, i, g->columns, rows, 1, GL_RGBA, GL_FLOAT,
                          texels);
    }
    free(texels);
    near->has_grid = true;
    near->grid_rows = g->rows;
    return gl_check(gl, "uploading weights", near->log);
}

// The tiles of the grid's cells, then those of the tiles' own.
static relume_status upload_tiles(struct nearby *near, const struct relume_weight_grid_info *g)
{
    enum { WIDE = 1024 };
    const struct gl *gl = near->gl;
    const size_t cells = (size_t)(g->rows - 1) * (size_t)(g->columns - 1);
    const size_t all = cells + 4 * (size_t)g->tiles;
    const int rows = (int)((all + 4 * WIDE - 1) / (4 * WIDE));
    float *texels = calloc((size_t)rows, 4 * WIDE * sizeof *texels);
    if (!texels)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < cells; i++)
        texels[i] = (float)g->tile[i];
    for (size_t i = 0; i < 4 * (size_t)g->tiles; i++)
        texels[cells + i] = (float)g->child[i / 4][i % 4];
    texture_use(gl, UNIT_TRIANGLES, GL_TEXTURE_2D, near->triangles);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, WIDE, rows, 0, GL_RGBA, GL_FLOAT, texels);
    texture_settings(gl, GL_TEXTURE_2D);
    free(texels);
    near->tiles = g->tiles;
    return gl_check(gl, "uploading tiles of weights", near->log);
}

// More triangles, or tiles, than a texture has rows give way to a plain grid.
static relume_status make_grid(relume_weight_grid **grid, const struct gl *gl,
                               const relume_coder *coder)
{
    const relume_status status = relume_weight_grid_create(grid, coder, NULL);
    if (status)
        return status;
    const struct relume_weight_grid_info *info = relume_weight_grid_info(*grid);
    if (triangles_rows(info) <= gl->max_texture && relume_weight_grid_rows(info) <= gl->max_texture)
        return RELUME_OK;
    relume_weight_grid_destroy(grid);
    return relume_weight_grid_create(grid, coder, relume_weight_grid_params(.steps = 16));
}

static relume_status need_grid(struct nearby *near, const relume_coder *coder)
{
    if (near->has_grid)
        return RELUME_OK;
    relume_weight_grid *grid;
    relume_status status = make_grid(&grid, near->gl, coder);
    const struct relume_weight_grid_info *info = grid ? relume_weight_grid_info(grid) : NULL;
    if (!status && info->triangles)
        status = triangles_upload(near->gl, UNIT_TRIANGLES, near->triangles, info);
    near->triangle_count = info ? info->triangles : 0;
    if (!status && info->tiles)
        status = upload_tiles(near, info);
    if (!status)
        status = upload_grid(near, info);
    if (!status)
        zone_upload(near->gl, UNIT_BORDER, near->border, coder);
    relume_weight_grid_destroy(&grid);
    return status;
}

// ---------------------------------------------------------------- views

static relume_status upload_positions(struct nearby_view *v, const struct gl *gl)
{
    const size_t n = (size_t)v->surface.width * (size_t)v->surface.height;
    float *texels = malloc(n * 4 * sizeof *texels);
    if (!texels)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        const float *p = v->surface.data + 3 * i;
        const bool finite = isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
        for (size_t c = 0; c < 3; c++)
            texels[4 * i + c] = finite ? p[c] : 0.0f;
        texels[4 * i + 3] = finite ? 1.0f : 0.0f;
    }
    gl->GenTextures(1, &v->positions);
    light_uniforms_upload(gl, UNIT_PICTURE, v->positions, GL_RGBA32F, GL_RGBA, v->surface.width,
                          v->surface.height, texels);
    free(texels);
    return RELUME_OK;
}

static relume_status upload_affine(struct nearby_view *v, const struct gl *gl,
                                   const struct nearby_codes *c)
{
    const int planes = c->codes->planes;
    float *texels = calloc((size_t)c->layers * 2 * LANES, sizeof *texels);
    if (!texels)
        return RELUME_ENOMEM;
    for (int p = 0; p < planes; p++) {
        float *layer = texels + p / LANES * 2 * LANES + p % LANES;
        layer[0] = (float)(c->unit * (double)c->codes->scale[p]);
        layer[LANES] = c->codes->offset[p];
    }
    gl->GenTextures(1, &v->affine);
    light_uniforms_upload(gl, UNIT_PICTURE, v->affine, GL_RGBA32F, GL_RGBA, 2, c->layers, texels);
    free(texels);
    return RELUME_OK;
}

// Code vectors side by side, each as texels of four numbers.
static void gather_book(float *texels, const struct relume_codes *codes, int book, int layers)
{
    const size_t planes = (size_t)codes->planes;
    for (int v = 0; v < codes->book_codes[book]; v++)
        memcpy(texels + (size_t)v * (size_t)layers * LANES,
               codes->vectors[book] + (size_t)v * planes, planes * sizeof *texels);
}

static relume_status upload_vectors(struct nearby_view *v, const struct nearby *near,
                                    const struct relume_codes *codes)
{
    const struct gl *gl = near->gl;
    const int layers = (codes->planes + LANES - 1) / LANES, width = VECTORS_WIDE * layers;
    int most = 0;
    for (int b = 0; b < codes->books; b++)
        most = codes->book_codes[b] > most ? codes->book_codes[b] : most;
    const int height = (most + VECTORS_WIDE - 1) / VECTORS_WIDE;
    if (width > gl->max_texture)
        return say(near->log, RELUME_ESYSTEM,
                   "near lights on codebooks of %d numbers take a texture %d wide; OpenGL has %d "
                   "here",
                   codes->planes, width, gl->max_texture);
    float *texels = calloc((size_t)width * (size_t)height, LANES * sizeof *texels);
    if (!texels)
        return RELUME_ENOMEM;
    gl->GenTextures(1, &v->vectors);
    texture_use(gl, UNIT_VECTORS, GL_TEXTURE_2D_ARRAY, v->vectors);
    gl->TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, width, height, codes->books, 0, GL_RGBA,
                   GL_FLOAT, NULL);
    texture_settings(gl, GL_TEXTURE_2D_ARRAY);
    for (int b = 0; b < codes->books; b++) {
        gather_book(texels, codes, b, layers);
        gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, b, width, height, 1, GL_RGBA, GL_FLOAT,
                          texels);
    }
    free(texels);
    return RELUME_OK;
}

relume_status nearby_view_create(struct nearby_view *view, const struct nearby *near,
                                 const struct nearby_codes *codes, struct relume_image *surface)
{
    *view = (struct nearby_view){.surface = *surface};
    *surface = (struct relume_image){0};
    relume_status status = upload_positions(view, near->gl);
    if (!status)
        status = codes->codes->books ? upload_vectors(view, near, codes->codes)
                                     : upload_affine(view, near->gl, codes);
    if (!status)
        status = gl_check(near->gl, "uploading a surface", near->log);
    if (status)
        nearby_view_destroy(view, near->gl);
    return status;
}

void nearby_view_destroy(struct nearby_view *view, const struct gl *gl)
{
    gl->DeleteTextures(1, &view->positions);
    gl->DeleteTextures(1, &view->affine);
    gl->DeleteTextures(1, &view->vectors);
    relume_image_destroy(&view->surface);
    *view = (struct nearby_view){0};
}

// ---------------------------------------------------------------- lights

static relume_status set_light(struct nearby *near, const struct nearby_view *view,
                               const struct relume_light *l)
{
    const GLint *at = near->program.at;
    const bool area = l->kind == RELUME_LIGHT_AREA;
    const int side = area ? relume_light_patch_side(l, relume_area_distance(l, &view->surface)) : 0;
    const relume_status status =
        area ? light_uniforms_patches(near->gl, UNIT_PICTURE, near->patches, l, side) : RELUME_OK;
    if (status)
        return status;
    near->gl->Uniform1i(at[PATCHES], side * side);
    return light_uniforms_set(&near->uniforms, at + LIGHT, UNIT_PICTURE, l);
}

static void set_codes(const struct nearby *near, const struct nearby_view *view,
                      const struct nearby_codes *c)
{
    const struct gl *gl = near->gl;
    const GLint *at = near->program.at;
    const struct relume_codes *codes = c->codes;
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    static const struct {
        enum uniform sampler;
        enum unit unit;
    } units[] = {{CODES, UNIT_CODES},     {PICTURE, UNIT_PICTURE},     {SURFACE, UNIT_SURFACE},
                 {GRID, UNIT_GRID},       {TRIANGLES, UNIT_TRIANGLES}, {AFFINE, UNIT_AFFINE},
                 {INDICES, UNIT_INDICES}, {VECTORS, UNIT_VECTORS}};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        gl->Uniform1i(at[units[i].sampler], units[i].unit);
    texture_use(gl, codes->books ? UNIT_INDICES : UNIT_CODES, GL_TEXTURE_2D_ARRAY, c->array);
    texture_use(gl, UNIT_SURFACE, GL_TEXTURE_2D, view->positions);
    texture_use(gl, UNIT_GRID, GL_TEXTURE_2D_ARRAY, near->grid);
    texture_use(gl, UNIT_TRIANGLES, GL_TEXTURE_2D, near->triangles);
    texture_use(gl, UNIT_AFFINE, GL_TEXTURE_2D, view->affine);
    texture_use(gl, UNIT_VECTORS, GL_TEXTURE_2D_ARRAY, view->vectors);
    gl->Uniform1i(at[TRIANGLE_COUNT], near->triangle_count);
    gl->Uniform1i(at[GRID_ROWS], near->grid_rows);
    gl->Uniform1i(at[TILES], near->tiles);
    gl->Uniform1i(at[FORM], info->luminance ? FORM_LUMINANCE
                            : info->joint   ? FORM_JOINT
                                            : FORM_SEPARATE);
    gl->Uniform1i(at[COEFFICIENTS], info->coefficients);
    gl->Uniform1i(at[LAYERS], (codes->planes + LANES - 1) / LANES);
    gl->Uniform1i(at[BOOKS], codes->books);
    gl->Uniform1i(at[CODED], codes->domain == RELUME_DOMAIN_DISPLAY);
    gl->Uniform1i(at[CURVE], (GLint)codes->display.curve);
    gl->Uniform1f(at[GAMMA], codes->display.gamma);
}

relume_status nearby_draw(struct nearby *near, const struct nearby_view *view,
                          const struct nearby_codes *codes, const struct relume_light *light)
{
    const struct gl *gl = near->gl;
    const float width = (float)view->surface.width, height = (float)view->surface.height;
    relume_status status = need_grid(near, codes->codes->coder);
    if (status)
        return status;
    gl->UseProgram(near->program.id);
    status = set_light(near, view, light);
    if (status)
        return status;
    set_codes(near, view, codes);
    zone_set(gl, near->program.at + ZONE, UNIT_BORDER, near->border, codes->codes->coder);
    gl->Uniform4f(near->program.at[RECTANGLE], 0, 0, width, height);
    gl->Uniform2f(near->program.at[SIZE], width, height);
    gl->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    return RELUME_OK;
}
