#include "scene/walk.h"

#include "base/memory.h"

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
    free(places->at);
    *places = (struct places){0};
}

static struct place *new_place(struct places *places)
{
    if (places->count == places->room) {
        const size_t room = places->room ? 2 * places->room : 1024;
        struct place *at = places->failed ? NULL : mem_array(room, sizeof *at);
        if (!at) {
            places->failed = true;
            return NULL;
        }
        if (places->count)
            memcpy(at, places->at, places->count * sizeof *at);
        free(places->at);
        places->at = at;
        places->room = room;
    }
    return &places->at[places->count++];
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

// Shadow rays from a coarsely tessellated curve start on the curve rather than on its chord, else
// every triangle's terminator shows (Hanika 2021). Flat and concave places stay where they are.
static void smooth_position(const struct vertex *const v[3], const float w[3], float side,
                            const float flat[3], float out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = flat[c];
    for (int i = 0; i < 3; i++) {
        float below = 0.0f;
        for (int c = 0; c < 3; c++)
            below += (flat[c] - v[i]->position[c]) * v[i]->normal[c] * side;
        for (int c = 0; c < 3 && below < 0.0f; c++)
            out[c] -= w[i] * below * v[i]->normal[c] * side;
    }
}

// The surface at a hit, turned towards the viewer: every surface has two equal sides.
static bool surface_at(const relume_scene *scene, const struct trace_hit *hit,
                       const float direction[3], struct surface *s, float origin[3])
{
    const struct mesh *mesh = &scene->stage.mesh;
    const struct triangle *t = &mesh->triangles[hit->triangle];
    const struct vertex *v[3];
    for (int i = 0; i < 3; i++)
        v[i] = &mesh->vertices[t->vertex[i]];
    const float w[3] = {1.0f - hit->u - hit->v, hit->u, hit->v};
    float flat[3] = {0}, place[3] = {0}, e1[3], e2[3];
    memset(s->n, 0, sizeof s->n);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < 3; i++) {
            flat[c] += w[i] * v[i]->position[c];
            s->n[c] += w[i] * v[i]->normal[c];
            place[c] += w[i] * v[i]->texture[c];
        }
        e1[c] = v[1]->position[c] - v[0]->position[c];
        e2[c] = v[2]->position[c] - v[0]->position[c];
        s->wo[c] = -direction[c];
    }
    cross(e1, e2, s->ng);
    if (!make_unit(s->ng))
        return false;
    if (!make_unit(s->n))
        memcpy(s->n, s->ng, sizeof s->n);
    // The vertex normals say which side is outside, the eye says which side is seen.
    const bool agree = dot3(s->n, s->ng) >= 0.0f;
    const bool back = dot3(s->ng, s->wo) < 0.0f;
    if (back)
        flip(s->ng);
    if (back == agree)
        flip(s->n);
    float lifted[3];
    smooth_position(v, w, back == agree ? -1.0f : 1.0f, flat, lifted);
    trace_leave(lifted, s->ng, origin);

    const struct material *m = &scene->stage.materials[t->material];
    m->texture.color(&m->texture, place, s->diffuse);
    memcpy(s->f0, m->f0, sizeof s->f0);
    s->alpha = m->alpha;
    s->gloss = 1.0f - m->mirror;
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
    struct place *kept = new_place(walk->places);
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
