// simplify.h - what the parts of mesh simplification share
//
// A corner belongs to a vertex of the mesh; vertices at one place (where texture or normals have a
// seam) are one point. Places are relative to the middle of the mesh, in diagonals of its bounding
// box.
#ifndef MESH_SIMPLIFY_H
#define MESH_SIMPLIFY_H

#include "core/base/memory.h"
#include "core/math/vec.h"

#include <relume/shape/simplify.h>

#define NOTHING UINT32_MAX

#define NO_AREA "the mesh has no triangle with an area"

enum {
    FAN = 96,          // most triangles around a point that may go
    VALUES = 8,        // normal, texture place, colour
    MOST_VERTICES = 8  // at one point that may go
};

// ---------------------------------------------------------------- connectivity

struct connect {
    size_t vertices, triangles;
    uint32_t points;
    uint32_t (*triangle)[3];  // vertices; dead: all NOTHING
    const uint32_t *part;     // or NULL
    uint32_t *point;          // [vertices]
    uint32_t *first;          // [points]: a corner, 3 * triangle + k
    uint32_t *next;           // [3 * triangles]: another corner of the same point
    size_t alive;             // triangles
};
// Of triangles of a mesh's vertices, and the parts that they are of, or NULL. Points are vertices
// at equal places.
relume_status connect_create(struct connect *c, const struct relume_mesh *mesh,
                             uint32_t (*triangle)[3], size_t triangles, const uint32_t *part);
// Numbers the points of c->vertices vertices into c->point, which holds as many.
relume_status connect_number(struct connect *c, const struct relume_mesh *mesh);
// Whether a triangle has three points.
bool connect_has_area(const struct connect *c, const uint32_t t[3]);
void connect_free(struct connect *c);

// What lies around a point: its triangles, and the points across its edges.
struct fan {
    int triangles, neighbours;
    bool too_many;
    uint32_t triangle[FAN];
    uint32_t neighbour[2 * FAN];
    int shared[2 * FAN];    // triangles at that edge
    bool feature[2 * FAN];  // border, seam, or between parts
    int features;
};
void connect_fan(struct connect *c, uint32_t point, struct fan *fan);

// How the vertices at a point go to those at another.
struct moves {
    int count;
    uint32_t from[MOST_VERTICES], to[MOST_VERTICES];
};
// Whether `point` may go to its neighbour `i` without tearing or folding the surface's
// connectivity, and how its vertices do.
// The vertices alone. False where they have no one way to go.
bool connect_moves(const struct connect *c, uint32_t point, const struct fan *fan, uint32_t target,
                   struct moves *moves);
// `there` becomes the fan of that neighbour.
bool connect_may_move(struct connect *c, uint32_t point, const struct fan *fan, int i,
                      struct moves *moves, struct fan *there);
// Neighbours that a point may go to at all.
bool connect_is_target(const struct fan *fan, int i);
void connect_move(struct connect *c, uint32_t point, const struct fan *fan, uint32_t target,
                  const struct moves *moves);
static inline bool triangle_has(const struct connect *c, uint32_t triangle, uint32_t point)
{
    const uint32_t *t = c->triangle[triangle];
    return c->point[t[0]] == point || c->point[t[1]] == point || c->point[t[2]] == point;
}
static inline uint32_t moved(const struct moves *m, uint32_t vertex)
{
    for (int i = 0; i < m->count; i++)
        if (m->from[i] == vertex)
            return m->to[i];
    return vertex;
}

// ---------------------------------------------------------------- what is seen of shading

// How far away turned normals are seen: a table over their angle.
enum { VISIBLE_ANGLES = 128, VISIBLE_MASKERS = 48 };
struct visible {
    // finest pattern that is seen, cycles a degree, at angles of PI (k / 128)^2 and maskers
    float finest[VISIBLE_MASKERS + 1][VISIBLE_ANGLES + 1];
};
relume_status visible_create(struct visible *v, double jnd, double gloss, double white);
// The finest pattern, cycles a degree, in which normals that are `angle` off are seen where those
// of the original vary by `masker`; 0 where none is.
double visible_finest(const struct visible *v, double angle, double masker);

// ---------------------------------------------------------------- the original surface

// Its triangles by the cells of a cube about the mesh, all of whose places lie in [-1/2, 1/2].
struct simplify;
struct near_grid {
    double radius;  // of what is near; 0: nobody asks
    double side;    // of a cell
    int across;     // cells along each axis
    uint32_t *first, *triangle;
};
enum { NEAR_CELLS = 4, NEAR_REFERENCES = 8 };  // for each triangle, at most
relume_status near_create(struct near_grid *g, const struct simplify *s, double radius);
void near_free(struct near_grid *g);
// Whether the original is no farther from there than the radius.
bool near_is(const struct near_grid *g, const struct simplify *s, vec3 p);
// The place on a triangle that is nearest to p, as weights of its corners.
void nearest_place(const vec3 t[3], vec3 p, double w[3]);

// ---------------------------------------------------------------- the surfaces

struct simplify {
    const struct relume_mesh *mesh;
    struct connect connect;
    vec3 middle;
    double scale;  // 1 / diagonal
    int values;    // of a vertex that quadrics know
    double weight[VALUES];
    double slide;  // of a unit of texture, diagonals

    double (*quadric)[11];  // [points]: of planes, and their area
    float *spread;          // [vertices][quadric_floats]: of values

    bool tested;             // and not by quadrics alone
    float *bend;             // [points]: sqrt(k1^2 + k2^2) of the original, 1 / diagonal
    double slip;             // by which normals may lie beside where they were, diagonals
    float *area;             // [vertices]: of the original about them
    float (*shown)[3];       // [vertices]: normals as they are now, of any length
    bool fits;               // they may change
    const uint8_t *stays;    // [points]: whose normals may not; NULL: none
    float *spacing;          // [points]: of edges, diagonals
    uint32_t *sample_first;  // [triangles]: original vertices that lie there
    uint32_t *sample_next;   // [vertices]
    struct near_grid near;
    struct visible visible;
    double seen_per_length;  // distance at which a length counts as seen: 1 / (2 tan (1/60 degree))
    double white, jnd;
};

static inline vec3 place(const struct simplify *s, uint32_t vertex)
{
    const float *p = s->mesh->position[vertex];
    const vec3 v = vec3_of((double)p[0], (double)p[1], (double)p[2]);
    return vec3_scale(vec3_sub(v, s->middle), s->scale);
}

static inline vec3 normal_of(const struct simplify *s, uint32_t vertex)
{
    const float *n = s->mesh->normal[vertex];
    return vec3_of((double)n[0], (double)n[1], (double)n[2]);
}

static inline vec3 shown_of(const struct simplify *s, uint32_t vertex)
{
    return vec3_floats(s->shown[vertex]);
}

// Quadrics of all points and vertices. RELUME_ENOMEM.
relume_status quadrics_create(struct simplify *s);
// The error of a point that goes to another, whose place is that of moves->to[0]: a length.
double quadrics_error(const struct simplify *s, uint32_t point, const struct moves *moves);
void quadrics_move(struct simplify *s, uint32_t point, uint32_t target, const struct moves *moves);
size_t quadrics_bytes(const struct simplify *s, size_t points, size_t vertices);

// Original vertices that have gone, and the triangles that they lie on now.
struct error {
    double length;    // most distance between the surfaces
    double distance;  // up to which something is seen
};
struct landing {
    uint32_t vertex, triangle;
    uint32_t corner[3];
    float weight[3];
    int8_t fit[3];  // which of samples.fit its corners are, or -1
};
struct fitted {
    uint32_t vertex;
    int group;  // the first of those that share a normal
    float normal[3];
};
struct samples {
    size_t count, capacity;
    struct landing *landing;
    size_t own;   // the first ones lie on triangles that change
    double area;  // of all triangles around the target
    int fitted;   // vertices at the target
    struct fitted fit[FAN];
};
// `shown`: normals as they are now, or NULL: the original's.
relume_status samples_create(struct simplify *s, float (*shown)[3]);
// What a move would do, at the vertices that have gone around there and those that go; gives up
// beyond `most`. `there` is the fan of the target. False when memory is short.
bool samples_try(const struct simplify *s, struct samples *to, struct error *error,
                 const struct fan *fan, const struct fan *there, uint32_t target,
                 const struct moves *moves, const struct error *most);
void samples_move(struct simplify *s, const struct samples *to, const struct fan *fan);
// Normals of a point that stays, once more. False when memory is short.
bool samples_refit(struct simplify *s, struct samples *to, const struct fan *fan, uint32_t point);

// A vertex at the target is one of to->fit; after the last one, landings are told.
void look_at_vertex(const struct simplify *s, struct samples *to, uint32_t vertex);
void look_begin(struct samples *to);
void look_fit(const struct simplify *s, struct samples *to);
// Up to where somebody sees that normals around the target are not those of the original.
double look_distance(const struct simplify *s, const struct samples *to);

// ---------------------------------------------------------------- what comes next

// Points in the order of keys, a binary heap.
struct queue {
    uint32_t count;
    uint32_t *heap;  // points
    uint32_t *at;    // [points]: place in the heap, NOTHING
    float *key;      // [points]
};
relume_status queue_create(struct queue *q, uint32_t points);
void queue_free(struct queue *q);
void queue_put(struct queue *q, uint32_t point, double key);  // new, or with another key
uint32_t queue_take(struct queue *q);                         // that of the smallest key

#endif
