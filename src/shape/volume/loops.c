// loops.c - a loop is cut into triangles that face as the gradient says (Wong 1998, Fig. 4-9)
//
// Corners are cut off whose triangle is within 15 degrees of what all three vertices want; when
// none is left, within 0.15 radians more. No cut runs along a face of the box, since the neighbour
// may cut its own there, and four triangles would meet; that is given up when nothing else is left.
#include "shape/volume/loops.h"

#include <math.h>
#include <string.h>

#define FIRST_ANGLE  0.2617994f  // 15 degrees
#define MORE_ANGLE   0.15f
#define WIDEST_ANGLE 3.1415927f

// The least cosine between a corner's triangle and its vertices' normals; -2 of none.
static float agreement(const struct place *a, const struct place *b, const struct place *c)
{
    const struct place *corner[3] = {a, b, c};
    float u[3], v[3], least = 1.0f;
    for (int i = 0; i < 3; i++) {
        u[i] = b->position[i] - a->position[i];
        v[i] = c->position[i] - a->position[i];
    }
    const float n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                        u[0] * v[1] - u[1] * v[0]};
    const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 1e-9f))
        return -2.0f;
    for (int k = 0; k < 3; k++) {
        const float *g = corner[k]->normal;
        const float cosine = (n[0] * g[0] + n[1] * g[1] + n[2] * g[2]) / length;
        least = cosine < least ? cosine : least;
    }
    return least;
}

// A vertex of the loop that is left, and what cutting off the triangle from it to the next two is
// worth: its agreement, or UNKNOWN.
struct corner {
    uint8_t vertex;
    float agreement;
};
#define UNKNOWN 2.0f

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

static void put_triangle(const struct loop *l, int a, int b, int c, uint64_t out[3])
{
    out[0] = l->key[a];
    out[1] = l->key[b];
    out[2] = l->key[c];
}

static bool may_cut(const struct loop *l, const struct patience *p, struct corner *a, int b, int c)
{
    if (p->anything)
        return true;
    if (!p->any_chord && l->faces[a->vertex] & l->faces[c])
        return false;
    if (a->agreement >= UNKNOWN)
        a->agreement = agreement(l->place[a->vertex], l->place[b], l->place[c]);
    return a->agreement >= p->cosine;
}

void loop_cut(struct loop *l, uint64_t (*out)[3])
{
    struct patience p = {.angle = FIRST_ANGLE, .cosine = cosf(FIRST_ANGLE)};
    struct corner ring[LOOP_MOST];
    int count = l->count;
    for (int i = 0; i < count; i++)
        ring[i] = (struct corner){(uint8_t)i, UNKNOWN};
    for (int i = 0, fails = 0; count > 3;) {
        const int next = i + 1 < count ? i + 1 : 0, last = next + 1 < count ? next + 1 : 0;
        const int a = ring[i].vertex, b = ring[next].vertex, c = ring[last].vertex;
        if (may_cut(l, &p, &ring[i], b, c)) {
            put_triangle(l, a, b, c, *out++);
            ring[i].agreement = ring[i ? i - 1 : count - 1].agreement = UNKNOWN;
            memmove(ring + next, ring + next + 1, (size_t)(--count - next) * sizeof *ring);
            i = (last > next ? next : last) % count;  // where c is now
            fails = 0;
        } else {
            i = next;
            if (++fails > count) {
                fails = 0;
                lose(&p);
            }
        }
    }
    put_triangle(l, ring[0].vertex, ring[1].vertex, ring[2].vertex, *out);
}
