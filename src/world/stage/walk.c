// walk.c - from the eye into the scene: the places whose light a pixel gathers
#include "world/stage/walk.h"

#include "core/base/memory.h"

#include <string.h>

enum { MAX_MIRRORS = 8 };
static const float FAINT = 0.01f;  // reflections below this share of a sample are not followed

// Rough enough that a lobe seen after a diffuse bounce is no firefly (caustics are left out).
static const float INDIRECT_ALPHA = 0.35f;

struct step {
    float origin[3], direction[3];
    float weight[3];
    int mirrors, bounces;  // passed so far
};

void places_destroy(struct places *places)
{
    mem_free(places->at);
    *places = (struct places){0};
}

static void flip(float v[3])
{
    for (int c = 0; c < 3; c++)
        v[c] = -v[c];
}

static bool make_unit(float v[3])
{
    const float length = sqrtf(dot3(v, v));
    if (!(length > 0.0f))
        return false;
    for (int c = 0; c < 3; c++)
        v[c] /= length;
    return true;
}

static void cross(const float a[3], const float b[3], float out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

// What the corners of a triangle give at a point inside it.
struct inside {
    const struct vertex *corner[3];
    float weight[3];
    float position[3], texture[3];
};

static struct inside inside_of(const struct mesh *mesh, const struct trace_hit *hit)
{
    const struct triangle *t = &mesh->triangles[hit->triangle];
    struct inside in = {.weight = {1.0f - hit->u - hit->v, hit->u, hit->v}};
    for (int i = 0; i < 3; i++) {
        const struct vertex *v = in.corner[i] = &mesh->vertices[t->vertex[i]];
        for (int c = 0; c < 3; c++) {
            in.position[c] += in.weight[i] * v->position[c];
            in.texture[c] += in.weight[i] * v->texture[c];
        }
    }
    return in;
}

// Shadow rays from a coarsely tessellated curve start on the curve rather than on its chord, else
// every triangle's terminator shows (Hanika 2021). Flat and concave places stay where they are.
static void smooth_position(const struct inside *in, float side, float out[3])
{
    memcpy(out, in->position, sizeof in->position);
    for (int i = 0; i < 3; i++) {
        const struct vertex *v = in->corner[i];
        float below = 0.0f;
        for (int c = 0; c < 3; c++)
            below += (in->position[c] - v->position[c]) * v->normal[c] * side;
        for (int c = 0; c < 3 && below < 0.0f; c++)
            out[c] -= in->weight[i] * below * v->normal[c] * side;
    }
}

// Both normals, turned towards the viewer: every surface has two equal sides. The vertex normals
// say which side is outside, the eye says which side is seen. `*side` is -1 when that is the
// inside; false for a triangle without area.
static bool set_normals(struct surface *s, const struct inside *in, float *side)
{
    float e1[3], e2[3];
    memset(s->n, 0, sizeof s->n);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < 3; i++)
            s->n[c] += in->weight[i] * in->corner[i]->normal[c];
        e1[c] = in->corner[1]->position[c] - in->corner[0]->position[c];
        e2[c] = in->corner[2]->position[c] - in->corner[0]->position[c];
    }
    cross(e1, e2, s->ng);
    if (!make_unit(s->ng))
        return false;
    if (!make_unit(s->n))
        memcpy(s->n, s->ng, sizeof s->n);
    const bool agree = dot3(s->n, s->ng) >= 0.0f;
    const bool back = dot3(s->ng, s->wo) < 0.0f;
    *side = back == agree ? -1.0f : 1.0f;
    if (back)
        flip(s->ng);
    if (back == agree)
        flip(s->n);
    return true;
}

static void set_material(struct surface *s, const struct material *m, const float texture[3])
{
    m->texture.color(&m->texture, texture, s->diffuse);
    memcpy(s->f0, m->f0, sizeof s->f0);
    s->alpha = m->alpha;
    s->gloss = 1.0f - m->mirror;
}

static bool surface_at(const relume_scene *scene, const struct trace_hit *hit,
                       const float direction[3], struct surface *s, float origin[3])
{
    const struct mesh *mesh = &scene->stage.mesh;
    const struct inside in = inside_of(mesh, hit);
    float side, lifted[3];
    for (int c = 0; c < 3; c++)
        s->wo[c] = -direction[c];
    if (!set_normals(s, &in, &side))
        return false;
    smooth_position(&in, side, lifted);
    trace_leave(lifted, s->ng, origin);
    set_material(s, &scene->stage.materials[mesh->triangles[hit->triangle].material], in.texture);
    return true;
}

static bool faint(const float weight[3])
{
    return fmaxf(weight[0], fmaxf(weight[1], weight[2])) < FAINT;
}

static void follow(struct walk *walk, const struct step *step);

static void follow_mirror(struct walk *walk, const struct step *step, const struct surface *s,
                          const float origin[3])
{
    if (s->gloss >= 1.0f || step->mirrors == MAX_MIRRORS)
        return;
    struct step next = {.mirrors = step->mirrors + 1, .bounces = step->bounces};
    float share[3];
    surface_mirror(s, share);
    const float along = 2.0f * dot3(s->n, s->wo);
    for (int c = 0; c < 3; c++) {
        next.weight[c] = step->weight[c] * share[c];
        next.direction[c] = along * s->n[c] - s->wo[c];
        next.origin[c] = origin[c];
    }
    if (faint(next.weight) || dot3(next.direction, s->ng) <= 0.0f || !make_unit(next.direction))
        return;
    follow(walk, &next);
}

static void follow_bounce(struct walk *walk, const struct step *step, const struct surface *s,
                          const float origin[3])
{
    if (step->bounces == walk->bounces)
        return;
    struct step next = {.mirrors = step->mirrors, .bounces = step->bounces + 1};
    float share[3], u[2];
    const float pick = (float)random_next(&walk->random);
    for (int i = 0; i < 2; i++)
        u[i] = step->bounces ? (float)random_next(&walk->random) : walk->first_bounce[i];
    if (!surface_sample(s, pick, u, next.direction, share) || !make_unit(next.direction))
        return;
    for (int c = 0; c < 3; c++) {
        next.weight[c] = step->weight[c] * share[c];
        next.origin[c] = origin[c];
    }
    follow(walk, &next);
}

static void follow(struct walk *walk, const struct step *step)
{
    struct trace_hit hit;
    struct place place = {.pixel = walk->pixel};
    if (!trace_closest(walk->scene->tracer, step->origin, step->direction, &hit) ||
        !surface_at(walk->scene, &hit, step->direction, &place.surface, place.origin))
        return;
    if (step->bounces > 0)
        place.surface.alpha = fmaxf(place.surface.alpha, INDIRECT_ALPHA);
    memcpy(place.weight, step->weight, sizeof place.weight);
    walk->places->failed = walk->places->failed || !mem_grow(&walk->places->at, walk->places->count,
                                                             sizeof *walk->places->at);
    struct place *kept = walk->places->failed ? NULL : &walk->places->at[walk->places->count++];
    if (!kept)
        return;
    *kept = place;
    follow_mirror(walk, step, &place.surface, place.origin);
    follow_bounce(walk, step, &place.surface, place.origin);
}

void walk_from_eye(struct walk *walk, struct camera_ray ray)
{
    const struct step first = {
        .origin = {(float)ray.origin.x, (float)ray.origin.y, (float)ray.origin.z},
        .direction = {(float)ray.direction.x, (float)ray.direction.y, (float)ray.direction.z},
        .weight = {1.0f, 1.0f, 1.0f},
    };
    follow(walk, &first);
}
