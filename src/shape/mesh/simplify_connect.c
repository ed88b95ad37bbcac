// simplify_connect.c - which triangles meet where, and which vertices may go
//
// A vertex goes along features only where two of them meet in it, anywhere where none does, else
// stays. The surface keeps its topology: the points next to both ends of an edge that goes must be
// those of the triangles that go (Dey, Edelsbrunner, Guha, Nekhayev 1999).
#include "core/math/fnv.h"
#include "shape/mesh/simplify.h"

#include <string.h>

void connect_free(struct connect *c)
{
    mem_free(c->triangle);
    mem_free(c->point);
    mem_free(c->first);
    mem_free(c->next);
    *c = (struct connect){0};
}

// Of the bits of a place; -0 is 0.
static size_t hash_of(const float p[3])
{
    const float place[3] = {p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f};
    const uint64_t hash = fnv_of_words(FNV_START, place, sizeof place);
    return (size_t)(hash ^ hash >> 29);
}

static bool is_there(const float a[3], const float b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

relume_status connect_number(struct connect *c, const struct relume_mesh *mesh)
{
    size_t slots = 16;
    while (slots < 2 * mesh->vertex_count)
        slots *= 2;
    uint32_t *slot = mem_array(slots, sizeof *slot);  // the first vertex of a point
    if (!slot)
        return RELUME_ENOMEM;
    memset(slot, 0xff, slots * sizeof *slot);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        size_t s = hash_of(mesh->position[i]) & (slots - 1);
        while (slot[s] != NOTHING && !is_there(mesh->position[slot[s]], mesh->position[i]))
            s = (s + 1) & (slots - 1);
        if (slot[s] == NOTHING) {
            slot[s] = (uint32_t)i;
            c->point[i] = c->points++;
        } else {
            c->point[i] = c->point[slot[s]];
        }
    }
    mem_free(slot);
    return RELUME_OK;
}

bool connect_has_area(const struct connect *c, const uint32_t t[3])
{
    const uint32_t a = c->point[t[0]], b = c->point[t[1]], d = c->point[t[2]];
    return a != b && b != d && d != a;
}

static void link_corners(struct connect *c)
{
    memset(c->first, 0xff, c->points * sizeof *c->first);
    for (size_t t = 0; t < c->triangles; t++) {
        if (!connect_has_area(c, c->triangle[t])) {
            memset(c->triangle[t], 0xff, sizeof c->triangle[t]);
            continue;
        }
        c->alive++;
        for (int k = 0; k < 3; k++) {
            const uint32_t corner = (uint32_t)(3 * t + (size_t)k);
            uint32_t *first = &c->first[c->point[c->triangle[t][k]]];
            c->next[corner] = *first;
            *first = corner;
        }
    }
}

relume_status connect_create(struct connect *c, const struct relume_mesh *mesh,
                             uint32_t (*triangle)[3], size_t triangles, const uint32_t *part)
{
    *c = (struct connect){
        .vertices = mesh->vertex_count,
        .triangles = triangles,
        .triangle = mem_copy(triangle, triangles, sizeof *c->triangle),
        .part = part,
        .point = mem_array(mesh->vertex_count, sizeof *c->point),
        .next = mem_array(3 * triangles, sizeof *c->next),
    };
    relume_status status =
        c->triangle && c->point && c->next ? connect_number(c, mesh) : RELUME_ENOMEM;
    if (!status)
        status = (c->first = mem_array(c->points, sizeof *c->first)) ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        link_corners(c);
    return status;
}

// ---------------------------------------------------------------- fans

static int neighbour_of(struct fan *fan, uint32_t point)
{
    for (int i = 0; i < fan->neighbours; i++)
        if (fan->neighbour[i] == point)
            return i;
    fan->neighbour[fan->neighbours] = point;
    fan->shared[fan->neighbours] = 0;
    fan->feature[fan->neighbours] = false;
    return fan->neighbours++;
}

// The vertices of a triangle at a point and at another; NOTHING where it has none there.
static void ends(const struct connect *c, uint32_t triangle, uint32_t point, uint32_t other,
                 uint32_t end[2])
{
    end[0] = end[1] = NOTHING;
    for (int k = 0; k < 3; k++) {
        const uint32_t v = c->triangle[triangle][k];
        if (c->point[v] == point)
            end[0] = v;
        if (c->point[v] == other)
            end[1] = v;
    }
}

// Whether what two triangles have at their common edge differs.
static bool is_seam(const struct connect *c, uint32_t a, uint32_t b, uint32_t point, uint32_t other)
{
    uint32_t at_a[2], at_b[2];
    ends(c, a, point, other, at_a);
    ends(c, b, point, other, at_b);
    return at_a[0] != at_b[0] || at_a[1] != at_b[1] || (c->part && c->part[a] != c->part[b]);
}

static void find_features(const struct connect *c, uint32_t point, struct fan *fan)
{
    for (int i = 0; i < fan->neighbours; i++) {
        uint32_t both[2];
        int n = 0;
        for (int t = 0; t < fan->triangles && n < 2; t++)
            if (triangle_has(c, fan->triangle[t], fan->neighbour[i]))
                both[n++] = fan->triangle[t];
        fan->feature[i] =
            fan->shared[i] != 2 || is_seam(c, both[0], both[1], point, fan->neighbour[i]);
        fan->features += fan->feature[i];
    }
}

// Corners of triangles that have gone are unlinked on the way.
void connect_fan(struct connect *c, uint32_t point, struct fan *fan)
{
    fan->triangles = fan->neighbours = fan->features = 0;
    fan->too_many = false;
    for (uint32_t *link = &c->first[point]; *link != NOTHING;) {
        const uint32_t t = *link / 3;
        if (c->triangle[t][0] == NOTHING) {
            *link = c->next[*link];
            continue;
        }
        if (fan->triangles == FAN) {
            fan->too_many = true;
            return;
        }
        fan->triangle[fan->triangles++] = t;
        for (int k = 0; k < 3; k++) {
            const uint32_t other = c->point[c->triangle[t][k]];
            if (other != point)
                fan->shared[neighbour_of(fan, other)]++;
        }
        link = &c->next[*link];
    }
    find_features(c, point, fan);
}

bool connect_is_target(const struct fan *fan, int i)
{
    if (fan->too_many || fan->shared[i] > 2)
        return false;
    return fan->features == 0 || (fan->features == 2 && fan->feature[i]);
}

// The vertices that the point's vertices go to are those of the triangles at the edge.
bool connect_moves(const struct connect *c, uint32_t point, const struct fan *fan, uint32_t target,
                   struct moves *moves)
{
    moves->count = 0;
    for (int t = 0; t < fan->triangles; t++) {
        uint32_t end[2];
        ends(c, fan->triangle[t], point, target, end);
        if (end[1] == NOTHING)
            continue;
        const uint32_t known = moved(moves, end[0]);
        if (known != end[0] && known != end[1])
            return false;
        if (known == end[0] && moves->count == MOST_VERTICES)
            return false;
        if (known == end[0]) {
            moves->from[moves->count] = end[0];
            moves->to[moves->count++] = end[1];
        }
    }
    for (int t = 0; t < fan->triangles; t++) {
        uint32_t end[2];
        ends(c, fan->triangle[t], point, target, end);
        if (moved(moves, end[0]) == end[0])
            return false;
    }
    return moves->count > 0;
}

bool connect_may_move(struct connect *c, uint32_t point, const struct fan *fan, int i,
                      struct moves *moves, struct fan *there)
{
    const uint32_t target = fan->neighbour[i];
    int common = 0;
    if (!connect_is_target(fan, i) || fan->triangles <= fan->shared[i] ||
        !connect_moves(c, point, fan, target, moves))
        return false;
    connect_fan(c, target, there);
    for (int a = 0; a < there->neighbours; a++) {
        if (there->shared[a] > 2)
            return false;
        for (int b = 0; b < fan->neighbours; b++)
            common += there->neighbour[a] == fan->neighbour[b];
    }
    return !there->too_many && common == fan->shared[i] &&
           there->triangles + fan->triangles - 2 * fan->shared[i] <= FAN;
}

void connect_move(struct connect *c, uint32_t point, const struct fan *fan, uint32_t target,
                  const struct moves *moves)
{
    for (int i = 0; i < fan->triangles; i++) {
        uint32_t *t = c->triangle[fan->triangle[i]];
        if (triangle_has(c, fan->triangle[i], target)) {
            memset(t, 0xff, sizeof *c->triangle);
            c->alive--;
            continue;
        }
        for (int k = 0; k < 3; k++)
            t[k] = moved(moves, t[k]);
    }
    uint32_t *end = &c->first[point];
    while (*end != NOTHING)
        end = &c->next[*end];
    *end = c->first[target];
    c->first[target] = c->first[point];
    c->first[point] = NOTHING;
}
