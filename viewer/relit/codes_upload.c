// codes_upload.c - codes of a view become array textures
#include "relit/books.h"
#include "relit/gl_relighter_parts.h"
#include "relit/weights.h"

#include <stdlib.h>
#include <string.h>

static const struct code_format formats[] = {
    [RELUME_STORE_8] = {GL_RGBA8, GL_UNSIGNED_BYTE, 1, 255.0},
    [RELUME_STORE_10] = {GL_RGBA16, GL_UNSIGNED_SHORT, 2, 65535.0},
    [RELUME_STORE_12] = {GL_RGBA16, GL_UNSIGNED_SHORT, 2, 65535.0},
    [RELUME_STORE_16] = {GL_RGBA16, GL_UNSIGNED_SHORT, 2, 65535.0},
    [RELUME_STORE_HALF] = {GL_RGBA16F, GL_HALF_FLOAT, 2, 1.0},
    [RELUME_STORE_FLOAT] = {GL_RGBA32F, GL_FLOAT, 4, 1.0},
};

const struct code_format *code_format_of(const struct relume_codes *codes)
{
    return &formats[codes->storage];
}

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

static void upload_array(const struct gl_relighter *r, struct relit_view *v, int array,
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

static relume_status upload_planes(struct gl_relighter *r, struct relit_view *v,
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

static relume_status upload_indices(struct gl_relighter *r, struct relit_view *v,
                                    const struct relume_codes *codes)
{
    texture_use(r->gl, 0, GL_TEXTURE_2D_ARRAY, v->array[0]);
    books_upload(r->gl, codes);
    return books_keep(&v->codes, codes);
}

static int layers_of(const struct relume_codes *codes)
{
    return codes->books ? 1 : (codes->planes + LANES - 1) / LANES;
}

size_t codes_bytes(const struct relume_codes *codes)
{
    const size_t pixels = (size_t)codes->width * (size_t)codes->height;
    const size_t texel = LANES * formats[codes->storage].bytes;
    return codes->books ? books_bytes(codes) : pixels * texel * (size_t)layers_of(codes);
}

relume_status codes_upload(struct gl_relighter *r, struct relit_view *v,
                           const struct relume_codes *codes)
{
    const struct gl *gl = r->gl;
    v->layers = layers_of(codes);
    v->arrays = (v->layers + gl->max_layers - 1) / gl->max_layers;
    v->array = calloc((size_t)v->arrays, sizeof *v->array);
    if (!v->array)
        return RELUME_ENOMEM;
    gl->GenTextures(v->arrays, v->array);
    const relume_status status = (codes->books ? upload_indices : upload_planes)(r, v, codes);
    return status ? status : gl_check(gl, "uploading a view", r->log);
}
