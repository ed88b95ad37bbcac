// judge.c - a mesh in its colours against the views that they are of
#include "shape/fusion/texture.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "core/math/scalar.h"
#include "shape/mesh/trace.h"

#include <relume/image.h>

struct judging {
    const struct relume_mesh *mesh;
    const struct relume_image *picture;
    const tracer *tracer;
    const struct witness *witness;
    const struct relume_image *relit;
    struct judged_row {
        double square;
        size_t shown, all;
    } * row;
};

static float display(float linear)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    return relume_transfer_encode(srgb, fminf(fmaxf(linear, 0.0f), 1.0f));
}

static void colour_at(float display_rgb[3], const struct judging *j, const struct trace_hit *hit)
{
    const uint32_t *v = j->mesh->triangle[hit->triangle];
    const float weight[3] = {1.0f - hit->u - hit->v, hit->u, hit->v};
    double at[2] = {0};
    for (size_t c = 0; c < 3; c++)
        display_rgb[c] = 0.0f;
    for (int k = 0; k < 3; k++)
        for (size_t c = 0; c < 3; c++) {
            if (!j->picture)
                display_rgb[c] += weight[k] * (float)j->mesh->colour[v[k]][c] / 255.0f;
            else if (c < 2)
                at[c] += (double)weight[k] * (double)j->mesh->texture[v[k]][c];
        }
    if (!j->picture)
        return;
    const int w = j->picture->width, h = j->picture->height;
    const struct bilinear b =
        bilinear_at(at[0] * w - 0.5, (1.0 - at[1]) * h - 0.5, w, h, EDGE_CLAMPED);
    for (size_t c = 0; c < 3; c++)
        display_rgb[c] = display(bilinear_valuef(&b, j->picture->data, 3, c));
}

static void judge_row(void *context, size_t y, int worker)
{
    (void)worker;
    const struct judging *j = context;
    struct judged_row *row = &j->row[y];
    for (int x = 0; x < j->relit->width; x++) {
        vec3 place;
        struct trace_hit hit;
        float origin[3], direction[3], rgb[3];
        if (!witness_place(&place, j->witness, x, (int)y))
            continue;
        row->all++;
        const struct camera_ray ray = camera_ray_at(&j->witness->camera, x + 0.5, (double)y + 0.5);
        vec3_store(origin, ray.origin);
        vec3_store(direction, ray.direction);
        if (!trace_closest(j->tracer, origin, direction, &hit))
            continue;
        row->shown++;
        colour_at(rgb, j, &hit);
        const float *want = j->relit->data + 3 * (y * (size_t)j->relit->width + (size_t)x);
        for (size_t c = 0; c < 3; c++)
            row->square += pow((double)(rgb[c] - display(want[c])), 2.0);
    }
}

static relume_status judge_view(struct judged_row *sum, const struct judging *all,
                                const struct texture *t, int view)
{
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW, .view = view};
    struct relume_image relit;
    relume_status status = relume_renderer_frame(&relit, t->renderer, &camera);
    if (status)
        return status;
    struct judging j = *all;
    j.relit = &relit;
    j.witness = &t->witness[view];
    j.row = mem_zeroed((size_t)relit.height, sizeof *j.row);
    if (j.row)
        thread_for(t->threads, (size_t)relit.height, judge_row, &j);
    for (int y = 0; j.row && y < relit.height; y++) {
        sum->square += j.row[y].square;
        sum->shown += j.row[y].shown;
        sum->all += j.row[y].all;
    }
    status = j.row ? RELUME_OK : RELUME_ENOMEM;
    mem_free(j.row);
    relume_image_destroy(&relit);
    return status;
}

static relume_status take_mesh(struct mesh *to, const struct relume_mesh *m)
{
    for (size_t i = 0; i < m->vertex_count; i++)
        (void)mesh_vertex(to, vec3_floats(m->position[i]), vec3_of(0, 0, 1), vec3_of(0, 0, 0));
    for (size_t i = 0; i < m->triangle_count; i++)
        mesh_triangle(to, m->triangle[i][0], m->triangle[i][1], m->triangle[i][2], 0);
    return to->failed ? RELUME_ENOMEM : RELUME_OK;
}

relume_status texture_judge(double *psnr_db, double *shown, const struct relume_mesh *mesh,
                            const struct relume_image *picture, const struct texture *t)
{
    struct mesh copy = {0};
    tracer *rays = NULL;
    struct judged_row sum = {0};
    relume_status status = take_mesh(&copy, mesh);
    if (!status)
        status = trace_create(&rays, &copy, t->log);
    const struct judging j = {.mesh = mesh, .picture = picture, .tracer = rays};
    for (int i = 0; i < t->witnesses && !status; i++)
        status = judge_view(&sum, &j, t, i);
    trace_destroy(&rays);
    mesh_free(&copy);
    *psnr_db = sum.shown ? decibels(sum.square / (3.0 * (double)sum.shown)) : 0.0;
    *shown = sum.all ? (double)sum.shown / (double)sum.all : 0.0;
    return status;
}
