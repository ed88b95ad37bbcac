// seen.c - what of a mesh the views see, and in which colours
#include "shape/fusion/seen.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"

#include <string.h>

enum { CHUNK = 4096 };

struct looking {
    struct relume_mesh *mesh;
    const struct witness *witness;
    int witnesses;
    double near;
    bool *seen;
    // of colours
    struct relume_image relit;
    float (*sum)[4];  // of red, green, blue, each times its weight, and of the weights
};

double seen_weight(struct sighting *at, const struct witness *s, vec3 place, vec3 normal,
                   double near)
{
    // from the side nobody sees much, and walls beside what is seen begin
    const double LEAST = 0.1;
    const double SLANTED = 2.0;  // where depth ends nobody knows how slanted it is
    if (!witness_ask(at, s, place, near) || !(fabs(at->distance) <= near) ||
        !(fabs(at->along) <= SLANTED * near))
        return 0.0;
    const struct camera_ray ray = camera_ray_at(&s->camera, at->xy[0], at->xy[1]);
    const double facing = -vec3_dot(ray.direction, normal);
    return facing > LEAST ? facing * facing : 0.0;
}

static double weight_of(struct sighting *at, const struct looking *k, const struct witness *s,
                        size_t vertex)
{
    return seen_weight(at, s, vec3_floats(k->mesh->position[vertex]),
                       vec3_floats(k->mesh->normal[vertex]), k->near);
}

static void look_chunk(void *context, size_t chunk, int worker)
{
    (void)worker;
    struct looking *k = context;
    const size_t end = (chunk + 1) * CHUNK;
    for (size_t i = chunk * CHUNK; i < end && i < k->mesh->vertex_count; i++) {
        struct sighting at;
        k->seen[i] = false;
        for (int s = 0; s < k->witnesses && !k->seen[i]; s++)
            k->seen[i] = weight_of(&at, k, &k->witness[s], i) > 0.0;
    }
}

// Numbers of the vertices that triangles still have.
static void keep(struct relume_mesh *m, const bool *seen, uint32_t *number)
{
    size_t triangles = 0, vertices = 0;
    memset(number, 0, m->vertex_count * sizeof *number);
    for (size_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *v = m->triangle[i];
        if (seen[v[0]] + seen[v[1]] + seen[v[2]] < 2)
            continue;
        for (int c = 0; c < 3; c++)
            number[v[c]] = 1;
        memmove(m->triangle[triangles++], v, sizeof m->triangle[0]);
    }
    for (size_t i = 0; i < m->vertex_count; i++)
        if (number[i]) {
            memmove(m->position[vertices], m->position[i], sizeof m->position[0]);
            memmove(m->normal[vertices], m->normal[i], sizeof m->normal[0]);
            number[i] = (uint32_t)vertices++;
        }
    for (size_t i = 0; i < triangles; i++)
        for (int c = 0; c < 3; c++)
            m->triangle[i][c] = number[m->triangle[i][c]];
    m->vertex_count = vertices;
    m->triangle_count = triangles;
}

// Normals of what is left, from its triangles, each by its area: beside what nobody sees the
// gradient says nothing.
static void smooth(struct relume_mesh *m)
{
    memset(m->normal, 0, m->vertex_count * sizeof *m->normal);
    for (size_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *v = m->triangle[i];
        float a[3], b[3];
        for (int c = 0; c < 3; c++) {
            a[c] = m->position[v[1]][c] - m->position[v[0]][c];
            b[c] = m->position[v[2]][c] - m->position[v[0]][c];
        }
        for (int c = 0; c < 3; c++) {
            const int d = (c + 1) % 3, e = (c + 2) % 3;
            for (int k = 0; k < 3; k++)
                m->normal[v[k]][c] += a[d] * b[e] - a[e] * b[d];
        }
    }
    for (size_t i = 0; i < m->vertex_count; i++) {
        const vec3 n =
            vec3_of((double)m->normal[i][0], (double)m->normal[i][1], (double)m->normal[i][2]);
        const vec3 unit = vec3_length(n) > 0.0 ? vec3_unit(n) : vec3_of(0, 0, 1);
        m->normal[i][0] = (float)unit.x;
        m->normal[i][1] = (float)unit.y;
        m->normal[i][2] = (float)unit.z;
    }
}

relume_status seen_keep(struct relume_mesh *mesh, size_t *left_out, const struct witness *witness,
                        int witnesses, double near, int threads)
{
    struct looking k = {.mesh = mesh, .witness = witness, .witnesses = witnesses, .near = near};
    const size_t before = mesh->triangle_count;
    k.seen = mem_array(mesh->vertex_count, sizeof *k.seen);
    uint32_t *number = mem_array(mesh->vertex_count, sizeof *number);
    const bool good = k.seen && number;
    if (good) {
        thread_for(threads, (mesh->vertex_count + CHUNK - 1) / CHUNK, look_chunk, &k);
        keep(mesh, k.seen, number);
        smooth(mesh);
        *left_out = before - mesh->triangle_count;
    }
    mem_free(k.seen);
    mem_free(number);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- colours

static void sum_chunk(void *context, size_t chunk, int worker)
{
    (void)worker;
    struct looking *k = context;
    const struct relume_image *relit = &k->relit;
    const size_t end = (chunk + 1) * CHUNK;
    for (size_t i = chunk * CHUNK; i < end && i < k->mesh->vertex_count; i++) {
        struct sighting at;
        const float weight = (float)weight_of(&at, k, k->witness, i);
        if (!(weight > 0.0f))
            continue;
        float rgb[3];
        witness_light(rgb, k->witness, relit, at.xy, k->near / at.cosine);
        for (int c = 0; c < 3; c++)
            k->sum[i][c] += weight * rgb[c];
        k->sum[i][3] += weight;
    }
}

static relume_status sum_view(struct looking *k, relume_renderer *renderer, int view, int threads)
{
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW, .view = view};
    relume_status status = relume_renderer_frame(&k->relit, renderer, &camera);
    if (status)
        return status;
    thread_for(threads, (k->mesh->vertex_count + CHUNK - 1) / CHUNK, sum_chunk, k);
    relume_image_destroy(&k->relit);
    return RELUME_OK;
}

static uint8_t code_of(float linear)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const float code = relume_transfer_encode(srgb, fminf(fmaxf(linear, 0.0f), 1.0f));
    return (uint8_t)relume_whole((double)(255.0f * code) + 0.5);
}

relume_status seen_colour(struct relume_mesh *mesh, relume_renderer *renderer,
                          const struct witness *witness, int witnesses, double near, int threads)
{
    struct looking k = {.mesh = mesh, .near = near};
    relume_status status = RELUME_OK;
    k.sum = mem_zeroed(mesh->vertex_count, sizeof *k.sum);
    mesh->colour = mem_array(mesh->vertex_count, sizeof *mesh->colour);
    if (!k.sum || !mesh->colour)
        status = RELUME_ENOMEM;
    for (int i = 0; i < witnesses && !status; i++) {
        k.witness = &witness[i];
        status = sum_view(&k, renderer, i, threads);
    }
    for (size_t i = 0; i < mesh->vertex_count && !status; i++) {
        const float weight = k.sum[i][3] > 0.0f ? k.sum[i][3] : 1.0f;
        for (int c = 0; c < 3; c++)
            mesh->colour[i][c] = code_of(k.sum[i][c] / weight);
        mesh->colour[i][3] = 255;
    }
    mem_free(k.sum);
    return status;
}
