// texture.c - what relit views show of a surface, as a picture that lies on it
//
// The surface is flattened onto charts (shape/atlas/atlas.h). Each texel knows its place and
// normal, asks every view, and takes the mean of what they show, those more that see it from
// before. Where nobody has seen anything the means of ever larger squares of texels step in
// (push-pull, Gortler et al. 1996), so that no other chart's colour or black shows at borders, nor
// in smaller versions.
#include "shape/fusion/texture.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "shape/atlas/atlas.h"
#include "shape/fusion/seen.h"
#include "core/math/scalar.h"

#include <string.h>

// Texels: noise at outlines would become thousands of charts that are mostly border.
#define SMALL_CHART 64.0

struct painting {
    const struct texture *t;
    struct atlas atlas;
    struct atlas_corner (*triangle)[3];
    const struct witness *witness;
    struct relume_image relit;
    float (*sum)[4];  // of red, green, blue, each times its weight, and of the weights
};

static relume_status flatten(struct painting *p, const struct relume_mesh *m)
{
    p->triangle = mem_zeroed(m->triangle_count, sizeof *p->triangle);
    if (!p->triangle)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            struct atlas_corner *c = &p->triangle[i][k];
            memcpy(c->position, m->position[m->triangle[i][k]], sizeof c->position);
            memcpy(c->normal, m->normal[m->triangle[i][k]], sizeof c->normal);
        }
    return atlas_make(&p->atlas, p->triangle, m->triangle_count, p->t->side, p->t->side,
                      SMALL_CHART, p->t->log);
}

// ---------------------------------------------------------------- light

static void place_of(vec3 *place, vec3 *normal, const struct painting *p,
                     const struct atlas_texel *texel)
{
    const double weight[3] = {1.0 - (double)texel->u - (double)texel->v, (double)texel->u,
                              (double)texel->v};
    *place = *normal = vec3_of(0, 0, 0);
    for (int k = 0; k < 3; k++) {
        const struct atlas_corner *c = &p->triangle[texel->triangle][k];
        *place = vec3_along(*place, vec3_floats(c->position), weight[k]);
        *normal = vec3_along(*normal, vec3_floats(c->normal), weight[k]);
    }
}

static void paint_row(void *context, size_t row, int worker)
{
    (void)worker;
    struct painting *p = context;
    const size_t side = (size_t)p->t->side;
    for (size_t i = row * side; i < (row + 1) * side; i++) {
        const struct atlas_texel *texel = &p->atlas.texel[i];
        struct sighting at;
        vec3 place, normal;
        float rgb[3];
        if (texel->triangle == UINT32_MAX)
            continue;
        place_of(&place, &normal, p, texel);
        if (!(vec3_length(normal) > 0.0))
            continue;
        const float weight =
            (float)seen_weight(&at, p->witness, place, vec3_unit(normal), p->t->near);
        if (!(weight > 0.0f))
            continue;
        witness_light(rgb, p->witness, &p->relit, at.xy, p->t->near / at.cosine);
        add_scaled(p->sum[i], rgb, weight, 3);
        p->sum[i][3] += weight;
    }
}

static relume_status paint(struct painting *p)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < p->t->witnesses && !status; i++) {
        const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW, .view = i};
        p->witness = &p->t->witness[i];
        status = relume_renderer_frame(&p->relit, p->t->renderer, &camera);
        if (status)
            return status;
        thread_for(p->t->threads, (size_t)p->t->side, paint_row, p);
        relume_image_destroy(&p->relit);
        if (!log_progress(p->t->log, "texture", (i + 1.0) / p->t->witnesses))
            status = RELUME_ECANCEL;
    }
    return status;
}

// ---------------------------------------------------------------- gaps

// Texels without weight take the mean of the least square around that has one.
static relume_status fill(float (*sum)[4], int side)
{
    const int half = (side + 1) / 2;
    if (side == 1)
        return RELUME_OK;
    float(*coarse)[4] = mem_zeroed((size_t)half * (size_t)half, sizeof *coarse);
    if (!coarse)
        return RELUME_ENOMEM;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            const float *from = sum[(size_t)y * (size_t)side + (size_t)x];
            if (from[3] > 0.0f) {
                float *to = coarse[(size_t)(y / 2) * (size_t)half + (size_t)(x / 2)];
                add_scaled(to, from, 1.0f / from[3], 3);
                to[3] += 1.0f;
            }
        }
    const relume_status status = fill(coarse, half);
    for (int y = 0; y < side && !status; y++)
        for (int x = 0; x < side; x++) {
            float *to = sum[(size_t)y * (size_t)side + (size_t)x];
            if (!(to[3] > 0.0f))
                memcpy(to, coarse[(size_t)(y / 2) * (size_t)half + (size_t)(x / 2)], sizeof *sum);
        }
    mem_free(coarse);
    return status;
}

static relume_status make_picture(struct relume_image *picture, struct painting *p)
{
    const size_t texels = (size_t)p->t->side * (size_t)p->t->side;
    relume_status status = fill(p->sum, p->t->side);
    if (!status)
        status = relume_image_create(picture, p->t->side, p->t->side, 3);
    for (size_t i = 0; i < texels && !status; i++)
        for (size_t c = 0; c < 3; c++)
            picture->data[3 * i + c] = p->sum[i][3] > 0.0f ? p->sum[i][c] / p->sum[i][3] : 0.0f;
    return status;
}

// ---------------------------------------------------------------- vertices

// A vertex for each place in the picture: the first keeps its number.
struct splitting {
    struct relume_mesh to;
    uint32_t *next;  // another one of the same place in the world; 0: none
    bool *placed;
};

static void copy_vertex(struct relume_mesh *to, size_t i, const struct relume_mesh *from, size_t v)
{
    memcpy(to->position[i], from->position[v], sizeof *to->position);
    memcpy(to->normal[i], from->normal[v], sizeof *to->normal);
    if (from->colour)
        memcpy(to->colour[i], from->colour[v], sizeof *to->colour);
}

static uint32_t vertex_at(struct splitting *s, uint32_t v, const float at[2])
{
    for (;; v = s->next[v]) {
        if (s->placed[v] && !memcmp(s->to.texture[v], at, sizeof s->to.texture[v]))
            return v;
        if (!s->placed[v])
            break;
        if (!s->next[v]) {
            s->next[v] = (uint32_t)s->to.vertex_count++;
            copy_vertex(&s->to, s->next[v], &s->to, v);
        }
    }
    s->placed[v] = true;
    memcpy(s->to.texture[v], at, sizeof s->to.texture[v]);
    return v;
}

static relume_status split(struct relume_mesh *m, struct atlas_corner (*triangle)[3])
{
    const size_t most = m->vertex_count + 3 * m->triangle_count;
    struct splitting s = {.next = mem_zeroed(most, sizeof *s.next),
                          .placed = mem_zeroed(most, sizeof *s.placed)};
    s.to = (struct relume_mesh){.vertex_count = m->vertex_count,
                                .position = mem_array(most, sizeof *s.to.position),
                                .normal = mem_array(most, sizeof *s.to.normal),
                                .texture = mem_array(most, sizeof *s.to.texture),
                                .colour = m->colour ? mem_array(most, sizeof *s.to.colour) : NULL};
    const bool good = s.next && s.placed && s.to.position && s.to.normal && s.to.texture &&
                      (s.to.colour || !m->colour) && most <= UINT32_MAX;
    for (size_t i = 0; good && i < m->vertex_count; i++)
        copy_vertex(&s.to, i, m, i);
    for (size_t i = 0; good && i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            const float *place = triangle[i][k].place;
            const float at[2] = {place[0], 1.0f - place[1]};
            m->triangle[i][k] = vertex_at(&s, m->triangle[i][k], at);
        }
    mem_free(s.next);
    mem_free(s.placed);
    if (good) {
        s.to.triangle = m->triangle;
        s.to.triangle_count = m->triangle_count;
        m->triangle = NULL;
        relume_mesh_free(m);
        *m = s.to;
    } else {
        relume_mesh_free(&s.to);
    }
    return good ? RELUME_OK : RELUME_ENOMEM;
}

relume_status texture_make(struct relume_mesh *mesh, struct relume_image *picture,
                           const struct texture *t)
{
    struct painting p = {.t = t};
    const size_t texels = (size_t)t->side * (size_t)t->side;
    *picture = (struct relume_image){0};
    relume_status status =
        limits_memory(NULL, texels * 40, "the texture", t->log);  // atlas, sums, their levels
    if (!status)
        status = flatten(&p, mesh);
    if (!status && !(p.sum = mem_zeroed(texels, sizeof *p.sum)))
        status = RELUME_ENOMEM;
    if (!status)
        status = paint(&p);
    if (!status)
        status = make_picture(picture, &p);
    if (!status)
        status = split(mesh, p.triangle);
    atlas_free(&p.atlas);
    mem_free(p.triangle);
    mem_free(p.sum);
    if (status)
        relume_image_destroy(picture);
    return status;
}
