// baked.c - baked objects: arrays go to the GPU once, colours whenever lights change. Twin:
// src/world/baked/lit.c
#include "draw/baked.h"

#include "cli/program/say.h"
#include "world/object/baked_object.h"

#include <stdlib.h>
#include <string.h>

enum {
    PLACE = DRAW_OWN,
    NORMAL,
    TANGENT,
    CLUSTER,
    WEIGHT,
    FRAME,
    COLOUR,
    PART,
    EYE,
    AXES,
    ATLAS,
    COUNTS,
    BLOCKS,
    COUNT
};
static const char *const uniforms[] = {
    "rectangle", "frame_size", "place", "normal_s", "tangent_t", "clusters", "weights", "frames",
    "colours",   "part",       "eye",   "axes",     "atlas",     "counts",   "blocks",
};
enum { UNIT_PLACE = BAKED_BUFFERS, UNIT_NORMAL, UNIT_TANGENT };
enum { CLUSTERS, WEIGHTS, FRAMES, COLOURS };

// ---------------------------------------------------------------- buffers

static relume_status fill(struct baked_drawer *d, struct baked_material *m, int i, GLenum format,
                          size_t texels, size_t bytes, const void *data)
{
    const struct gl *gl = d->gl;
    if (texels > (size_t)gl->max_buffer)
        return say(d->log, RELUME_ESYSTEM,
                   "a baked object of an array of %zu texels; OpenGL reads at most %d here", texels,
                   gl->max_buffer);
    if (!m->buffer[i]) {
        gl->GenBuffers(1, &m->buffer[i]);
        gl->GenTextures(1, &m->texture[i]);
        m->bytes += bytes;
    }
    gl->BindBuffer(GL_TEXTURE_BUFFER, m->buffer[i]);
    gl->BufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)bytes, data, GL_STATIC_DRAW);
    texture_use(gl, 0, GL_TEXTURE_BUFFER, m->texture[i]);
    gl->TexBuffer(GL_TEXTURE_BUFFER, format, m->buffer[i]);
    return gl_check(gl, "uploading a baked object", d->log);
}

// Threes padded to fours: GL 3.3 has no buffers of three.
static relume_status fill_threes(struct baked_drawer *d, struct baked_material *m, int i,
                                 const float *three, size_t n)
{
    float *four = calloc(n + 1, 4 * sizeof *four);
    if (!four)
        return RELUME_ENOMEM;
    for (size_t k = 0; k < n; k++)
        memcpy(four + 4 * k, three + 3 * k, 3 * sizeof *four);
    const relume_status status = fill(d, m, i, GL_RGBA32F, n, n * 4 * sizeof *four, four);
    free(four);
    return status;
}

static relume_status upload(struct baked_drawer *d, struct baked_material *m,
                            const struct relume_baked_info *info,
                            const struct relume_baked_arrays *a)
{
    const size_t texels = (size_t)info->width * (size_t)info->height;
    const size_t all = texels * (size_t)a->blocks, weights = all * (size_t)info->components;
    relume_status status =
        fill(d, m, CLUSTERS, GL_R16UI, all, all * sizeof *a->cluster, a->cluster);
    if (!status)
        status = fill(d, m, WEIGHTS, GL_R32F, weights, weights * sizeof *a->weight, a->weight);
    return status ? status : fill_threes(d, m, FRAMES, a->frame[0], 2 * texels);
}

static relume_status light(struct baked_drawer *d, struct baked_material *m,
                           const relume_objects *objects, int material, size_t vectors,
                           const struct relume_light *lights, int n)
{
    float(*colour)[3];
    relume_status status = relume_objects_baked_colours(&colour, objects, material, lights, n);
    if (!status)
        status = fill_threes(d, m, COLOURS, colour[0], vectors);
    relume_free(colour);
    m->lit = !status;
    return status;
}

static relume_status need_material(struct baked_drawer *d, int materials)
{
    if (d->material)
        return RELUME_OK;
    d->material = calloc((size_t)materials, sizeof *d->material);
    d->materials = d->material ? materials : 0;
    return d->material ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- drawing

static void set_uniforms(const struct baked_drawer *d, const struct baked_material *m, int part,
                         const struct relume_baked_info *info, const struct relume_baked_arrays *a,
                         const struct baked_surface *surface)
{
    static const int names[BAKED_BUFFERS] = {CLUSTER, WEIGHT, FRAME, COLOUR};
    const struct gl *gl = d->gl;
    const GLint *at = d->program.at;
    float axes[9];
    for (int i = 0; i < BAKED_BUFFERS; i++) {
        gl->Uniform1i(at[names[i]], i);
        texture_use(gl, i, GL_TEXTURE_BUFFER, m->texture[i]);
    }
    for (int i = 0; i < 3; i++) {
        axes[3 * i] = (float)a->axis[i].x;
        axes[3 * i + 1] = (float)a->axis[i].y;
        axes[3 * i + 2] = (float)a->axis[i].z;
    }
    gl->Uniform1i(at[PLACE], UNIT_PLACE);
    gl->Uniform1i(at[NORMAL], UNIT_NORMAL);
    gl->Uniform1i(at[TANGENT], UNIT_TANGENT);
    texture_use(gl, UNIT_PLACE, GL_TEXTURE_2D, surface->place->texture);
    texture_use(gl, UNIT_NORMAL, GL_TEXTURE_2D, surface->normal->texture);
    texture_use(gl, UNIT_TANGENT, GL_TEXTURE_2D, surface->tangent->texture);
    gl->Uniform1i(at[PART], part);
    gl->Uniform4f(at[EYE], surface->eye[0], surface->eye[1], surface->eye[2], surface->eye[3]);
    for (int i = 0; i < 3; i++)
        gl->Uniform3f(at[AXES] + i, axes[3 * i], axes[3 * i + 1], axes[3 * i + 2]);
    gl->Uniform2i(at[ATLAS], info->width, info->height);
    gl->Uniform3f(at[COUNTS], (float)info->side, (float)info->clusters, (float)info->components);
    gl->Uniform2i(at[BLOCKS], a->blocks, a->views);
}

relume_status baked_draw(struct baked_drawer *d, const relume_objects *objects, int part,
                         int material, const struct baked_surface *surface,
                         const struct relume_light *lights, int n)
{
    const struct relume_objects_info *of = relume_objects_info(objects);
    const struct gl *gl = d->gl;
    struct relume_baked_arrays a;
    if (!relume_objects_baked(&a, objects, material))
        return RELUME_EINVAL;
    const struct relume_baked_info *info = relume_baked_info(of->material[material].baked);
    relume_status status = need_material(d, of->materials);
    if (!status && !d->program.id)
        status = program_create(&d->program, gl, "baked.frag", uniforms, COUNT, d->log);
    struct baked_material *m = status ? NULL : &d->material[material];
    if (!status && !m->buffer[FRAMES])
        status = upload(d, m, info, &a);
    if (!status && !m->lit)
        status = light(d, m, objects, material, a.vectors, lights, n);
    if (status)
        return status;
    const struct frame_area whole = {.width = surface->place->width,
                                     .height = surface->place->height};
    gl->UseProgram(d->program.id);
    set_uniforms(d, m, part, info, &a, surface);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    draw_whole(gl, &d->program, &whole);
    gl->Disable(GL_BLEND);
    return RELUME_OK;
}

void baked_unlight(struct baked_drawer *d)
{
    for (int i = 0; i < d->materials; i++)
        d->material[i].lit = false;
}

size_t baked_bytes(const struct baked_drawer *d, int material)
{
    return material < d->materials ? d->material[material].bytes : 0;
}

void baked_forget(struct baked_drawer *d)
{
    if (!d->gl)
        return;
    program_destroy(&d->program, d->gl);
    for (int i = 0; i < d->materials; i++) {
        d->gl->DeleteTextures(BAKED_BUFFERS, d->material[i].texture);
        d->gl->DeleteBuffers(BAKED_BUFFERS, d->material[i].buffer);
    }
    free(d->material);
    *d = (struct baked_drawer){.gl = d->gl, .log = d->log};
}
