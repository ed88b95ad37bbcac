// loops.c - a loop is cut into triangles that face as the gradient says (Wong 1998, Fig. 4-9)
//
// Corners are cut off whose triangle is within 15 degrees of what all three vertices want; when
// none is left, within 0.15 radians more. No cut runs along a face of the box, since the neighbour
// may cut its own there, and four triangles would meet; that is given up when nothing else is left.
#include "isosurface/loops.h"

#include <math.h>
#include <string.h>

#define FIRST_ANGLE  0.2617994f  // 15 degrees
#define MORE_ANGLE   0.15f
#define WIDEST_ANGLE 3.1415927f

// The least cosine between a corner's triangle and its vertices' normals; -2 of none.
static float agreement(const struct place *a, const struct place *b, const struct place *c)
{
    float u[3], v[3];
    for (int i = 0; i < 3; i++) {
        u[i] = b->position[i] - a->position[i];
        v[i] = c->position[i] - a->position[i];
    }
    const float n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                        u[0] * v[1] - u[1] * v[0]};
    const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 1e-9f))
        return -2.0f;
    const struct place *corner[3] = {a, b, c};
    float least = 1.0f;
    for (int i = 0; i < 3; i++) {
        const float *g = corner[i]->normal;
        least = fminf(least, (n[0] * g[0] + n[1] * g[1] + n[2] * g[2]) / length);
    }
    return least;
}

static void remove_vertex(struct loop *l, int at)
{
    const size_t behind = (size_t)(l->count - 1 - at);
    memmove(l->key + at, l->key + at + 1, behind * sizeof *l->key);
    memmove(l->place + at, l->place + at + 1, behind * sizeof *l->place);
    memmove(l->faces + at, l->faces + at + 1, behind * sizeof *l->faces);
    l->count--;
}

struct patience {
    float angle, cosine;
    bool any_chord, anything;
};

static void lose(struct patience *p)
{
    p->angle += MORE_ANGLE;
    if (p->angle > WIDEST_ANGLE) {
        p->anything = p->any_chord;
        p->any_chord = true;
        p->angle = FIRST_ANGLE;
    }
    p->cosine = cosf(p->angle);
}

void loop_cut(struct loop *l, uint64_t (*out)[3])
{
    struct patience p = {.angle = FIRST_ANGLE, .cosine = cosf(FIRST_ANGLE)};
    for (int i = 0, fails = 0; l->count > 3;) {
        const int a = i % l->count, b = (a + 1) % l->count, c = (a + 2) % l->count;
        const bool chord = l->faces[a] & l->faces[c];
        if (p.anything || ((p.any_chord || !chord) &&
                           agreement(&l->place[a], &l->place[b], &l->place[c]) >= p.cosine)) {
            const uint64_t triangle[3] = {l->key[a], l->key[b], l->key[c]};
            memcpy(*out++, triangle, sizeof triangle);
            remove_vertex(l, b);
            i = c > b ? b : c;  // where c is now
            fails = 0;
        } else {
            i = b;
            if (++fails > l->count) {
                fails = 0;
                lose(&p);
            }
        }
    }
    memcpy(*out, l->key, sizeof *out);
}
