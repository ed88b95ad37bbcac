// levels.c - objects that have fewer triangles from afar, without popping
//
// One run of collapses is a progressive mesh (Hoppe 1996); levels are its states at errors that
// double. The coarsest level whose error is seen within so many pixels is shown, and its vertices
// are on their way to where the next level has them, by as much as the error that may be seen has
// grown from the one level's to the other's. So the surface is the same before and after a change,
// and its error is never more than what may be seen.
//
// Each part of an object has a level of its own. A vertex at which parts meet is where the finest
// of their levels has it, for all of them (the shared boundary samples of a Seam Graph; Meseth
// 2008, chapter 6): every vertex has one place, so that nothing opens, whatever the levels.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "world/object/levels.h"
#include "shape/distance/lod.h"
#include "world/object/drawn_objects.h"
#include "world/object/object.h"
#include "world/object/skin.h"

#include <relume/shape/billboards.h>
#include <relume/shape/simplify.h>
#include <string.h>

// Of the diagonal: an object whose error that is covers a few pixels.
static const double COARSEST = 0.08;
// What shading may change by counts as the length that is seen from as far away under 1/30 degree.
static const double LENGTH_OF_DISTANCE = 2.0 * 2.908882e-4;
// Of its triangles a level has at most so many of those of the finer one.
static const double FEWER = 0.8;
// A move is done in so many steps: they are finer than what is seen, and most frames change none.
// Of more parts all have one level.
enum { MOVES = 256, LEAST_TRIANGLES = 12, MOST_LEVELS = 12, MOST_PARTS = 64 };

struct level {
    double error;      // in the world, of what is seen
    double length;     // most distance from the full mesh, in the world
    uint32_t *vertex;  // [vertices]: where each has gone
    uint32_t *kept;    // [triangles]: that have an area still
    size_t triangles;
};
struct ball {
    vec3 middle;
    double radius;
};
struct object_levels {
    double pixels;  // that an error may be seen as
    int first_part, parts;
    struct ball *ball;    // [parts]
    uint64_t *meet;       // [vertices]: parts that meet there, as bits; NULL: all have one level
    uint32_t *border;     // [vertices]: the first on its way where parts meet, if any
    size_t first, count;  // triangles of the objects
    uint32_t *vertex;     // [vertices]: of the objects, in order
    size_t vertices;
    double radius;  // of all
    int levels;
    struct level level[MOST_LEVELS];  // the first is the mesh itself
};

void object_levels_free(struct object_levels **levels)
{
    struct object_levels *l = *levels;
    *levels = NULL;
    if (!l)
        return;
    for (int i = 0; i < MOST_LEVELS; i++) {
        mem_free(l->level[i].vertex);
        mem_free(l->level[i].kept);
    }
    mem_free(l->vertex);
    mem_free(l->ball);
    mem_free(l->meet);
    mem_free(l->border);
    mem_free(l);
}

// ---------------------------------------------------------------- making

static int by_number(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

// The object's number of a vertex of the objects.
static uint32_t own_number(const struct object_levels *l, uint32_t vertex)
{
    const uint32_t *at = bsearch(&vertex, l->vertex, l->vertices, sizeof *l->vertex, by_number);
    return (uint32_t)(at - l->vertex);
}

static relume_status list_vertices(struct object_levels *l, const relume_objects *o)
{
    const size_t corners = 3 * l->count;
    uint32_t *v = l->vertex = mem_copy(o->triangles[l->first], corners, sizeof *l->vertex);
    if (!v)
        return RELUME_ENOMEM;
    qsort(v, corners, sizeof *v, by_number);
    for (size_t i = 0; i < corners; i++)
        if (!i || v[i] != v[l->vertices - 1])
            v[l->vertices++] = v[i];
    return RELUME_OK;
}

static relume_status take_mesh(struct relume_mesh *out, const struct object_levels *l,
                               const relume_objects *o)
{
    *out = (struct relume_mesh){
        .vertex_count = l->vertices,
        .triangle_count = l->count,
        .position = mem_array(l->vertices, sizeof *out->position),
        .normal = mem_array(l->vertices, sizeof *out->normal),
        .texture = mem_array(l->vertices, sizeof *out->texture),
        .triangle = mem_array(l->count, sizeof *out->triangle),
        .part = mem_array(l->count, sizeof *out->part),
    };
    if (!out->position || !out->normal || !out->texture || !out->triangle || !out->part)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < l->vertices; i++) {
        const struct relume_mesh_vertex *v = &o->vertices[l->vertex[i]];
        memcpy(out->position[i], v->position, sizeof out->position[i]);
        memcpy(out->normal[i], v->normal, sizeof out->normal[i]);
        memcpy(out->texture[i], v->texture, sizeof out->texture[i]);
    }
    for (size_t i = 0; i < l->count; i++) {
        for (int k = 0; k < 3; k++)
            out->triangle[i][k] = own_number(l, o->triangles[l->first + i][k]);
        out->part[i] = o->mesh.triangles[l->first + i].material;
    }
    return RELUME_OK;
}

static double step_error(const struct relume_simplify_step *step)
{
    return fmax((double)step->error, (double)step->distance * LENGTH_OF_DISTANCE);
}

// Steps up to that error, of the diagonal.
static size_t steps_within(const struct relume_simplified *s, double error)
{
    size_t n = 0;
    while (n < s->steps && step_error(&s->step[n]) <= error)
        n++;
    return n;
}

static bool has_area(const struct relume_mesh *m, const uint32_t *vertex, const uint32_t *corner)
{
    const float *p[3];
    for (int k = 0; k < 3; k++)
        p[k] = m->position[vertex[corner[k]]];
    const size_t size = sizeof *m->position;
    return memcmp(p[0], p[1], size) && memcmp(p[1], p[2], size) && memcmp(p[2], p[0], size);
}

// The mesh after `steps` of them.
static relume_status make_level(struct level *out, const struct relume_mesh *m,
                                const struct relume_simplified *s, size_t steps)
{
    *out = (struct level){.vertex = mem_array(m->vertex_count, sizeof *out->vertex),
                          .kept = mem_array(m->triangle_count, sizeof *out->kept)};
    if (!out->vertex || !out->kept)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < m->vertex_count; i++)
        out->vertex[i] = (uint32_t)i;
    while (steps-- > 0)  // where the last ones go is known first
        out->vertex[s->step[steps].vertex] = out->vertex[s->step[steps].onto];
    for (size_t i = 0; i < m->triangle_count; i++)
        if (has_area(m, out->vertex, m->triangle[i]))
            out->kept[out->triangles++] = (uint32_t)i;
    return RELUME_OK;
}

static relume_status make_levels(struct object_levels *l, const struct relume_mesh *m,
                                 const struct relume_simplified *s)
{
    double error = COARSEST;
    for (int i = 2; i < MOST_LEVELS; i++)
        error *= 0.5;
    relume_status status = make_level(&l->level[0], m, s, 0);
    l->levels = 1;
    for (; error <= COARSEST && !status; error *= 2.0) {
        const size_t steps = steps_within(s, error);
        struct level *next = &l->level[l->levels];
        status = make_level(next, m, s, steps);
        const double most = FEWER * (double)next[-1].triangles;
        if (!status && steps && next->triangles && (double)next->triangles <= most) {
            next->error = 2.0 * l->radius * step_error(&s->step[steps - 1]);
            next->length = 2.0 * l->radius * (double)s->step[steps - 1].error;
            l->levels++;
            continue;
        }
        mem_free(next->vertex);
        mem_free(next->kept);
        *next = (struct level){0};
    }
    return status;
}

static struct ball ball_of(const struct relume_mesh *m, uint32_t part, bool all)
{
    vec3 min = vec3_of(INFINITY, INFINITY, INFINITY), max = vec3_scale(min, -1.0);
    for (size_t i = 0; i < m->triangle_count; i++)
        for (int k = 0; (all || m->part[i] == part) && k < 3; k++) {
            const vec3 p = vec3_floats(m->position[m->triangle[i][k]]);
            min = vec3_of(fmin(min.x, p.x), fmin(min.y, p.y), fmin(min.z, p.z));
            max = vec3_of(fmax(max.x, p.x), fmax(max.y, p.y), fmax(max.z, p.z));
        }
    return (struct ball){vec3_scale(vec3_add(min, max), 0.5),
                         0.5 * vec3_length(vec3_sub(max, min))};
}

// Of a part without triangles, and of all where they have one level, that of the whole.
static relume_status find_extent(struct object_levels *l, const struct relume_mesh *m)
{
    const struct ball all = ball_of(m, 0, true);
    l->radius = all.radius;
    l->ball = mem_array((size_t)l->parts, sizeof *l->ball);
    for (int i = 0; l->ball && i < l->parts; i++) {
        l->ball[i] = all;
        if (l->parts <= MOST_PARTS && l->parts > 1)
            l->ball[i] = ball_of(m, (uint32_t)(l->first_part + i), false);
        if (!(l->ball[i].radius < (double)INFINITY))
            l->ball[i] = all;
    }
    return l->ball ? RELUME_OK : RELUME_ENOMEM;
}

static bool is_border(const struct object_levels *l, uint32_t own)
{
    return l->meet[own] & (l->meet[own] - 1);
}

struct spot {
    float position[3];
    uint32_t vertex;
};

static int by_position(const void *a, const void *b)
{
    return memcmp(((const struct spot *)a)->position, ((const struct spot *)b)->position,
                  sizeof(float[3]));
}

// Vertices at one place are of the parts of all of them.
static relume_status join_places(struct object_levels *l, const struct relume_mesh *m)
{
    struct spot *spot = mem_array(l->vertices, sizeof *spot);
    if (!spot)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < l->vertices; i++) {
        spot[i].vertex = (uint32_t)i;
        for (int k = 0; k < 3; k++)  // -0 is 0
            spot[i].position[k] = m->position[i][k] + 0.0f;
    }
    qsort(spot, l->vertices, sizeof *spot, by_position);
    for (size_t i = 0, end; i < l->vertices; i = end) {
        uint64_t all = 0;
        for (end = i; end < l->vertices && !by_position(&spot[i], &spot[end]); end++)
            all |= l->meet[spot[end].vertex];
        for (size_t k = i; k < end; k++)
            l->meet[spot[k].vertex] = all;
    }
    mem_free(spot);
    return RELUME_OK;
}

static relume_status find_borders(struct object_levels *l, const struct relume_mesh *m,
                                  const struct relume_simplified *s)
{
    if (l->parts < 2 || l->parts > MOST_PARTS)
        return RELUME_OK;
    l->meet = mem_zeroed(l->vertices, sizeof *l->meet);
    l->border = mem_array(l->vertices, sizeof *l->border);
    if (!l->meet || !l->border)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            l->meet[m->triangle[i][k]] |= (uint64_t)1 << ((int)m->part[i] - l->first_part);
    const relume_status status = join_places(l, m);
    for (size_t i = 0; i < l->vertices; i++)
        l->border[i] = (uint32_t)i;
    for (size_t i = s->steps; i-- > 0;)  // where the last ones go is known first
        if (!status && !is_border(l, s->step[i].vertex))
            l->border[s->step[i].vertex] = l->border[s->step[i].onto];
    return status;
}

static relume_status add_levels(relume_objects *o, int object, double pixels,
                                const struct relume_log *log)
{
    struct relume_mesh mesh = {0}, coarse = {0};
    struct relume_simplified s = {0};
    struct object_levels *l = o->levels[object] = mem_zeroed(1, sizeof *l);
    if (!l)
        return RELUME_ENOMEM;
    l->pixels = pixels;
    for (int i = 0; i < o->info.parts; i++) {
        if (o->part[i].object != object)
            continue;
        l->first = l->count ? l->first : o->part[i].first;
        l->first_part = l->parts ? l->first_part : i;
        l->parts = i + 1 - l->first_part;
        l->count += o->part[i].count;
    }
    if (!l->count) {
        object_levels_free(&o->levels[object]);
        return RELUME_OK;
    }
    relume_status status = list_vertices(l, o);
    if (!status)
        status = take_mesh(&mesh, l, o);
    if (!status)
        status = find_extent(l, &mesh);
    if (!status)
        status = relume_mesh_simplify(
            &coarse, &s, &mesh, relume_simplify_params(.log = log, .triangles = LEAST_TRIANGLES));
    if (!status)
        status = make_levels(l, &mesh, &s);
    if (!status)
        status = find_borders(l, &mesh, &s);
    mem_free(s.step);
    relume_mesh_free(&coarse);
    relume_mesh_free(&mesh);
    return status;
}

// What light is followed into, or what was computed for one mesh, needs that mesh.
static bool need_the_mesh(const relume_objects *o)
{
    bool need = o->clouds > 0;
    for (int i = 0; i < o->info.materials; i++)
        need |= o->material[i].mirror || o->material[i].translucent || o->material[i].baked;
    return need;
}

relume_status objects_want_levels(relume_objects *o, int object, double pixels)
{
    if (!mem_grow(&o->wanted, (size_t)o->wants, sizeof *o->wanted))
        return RELUME_ENOMEM;
    o->wanted[o->wants++] = (struct wanted_levels){object, pixels};
    return RELUME_OK;
}

relume_status objects_make_levels(relume_objects *o, const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    if (!o->wants)
        return RELUME_OK;
    if (need_the_mesh(o)) {
        log_line(log, RELUME_WARNING,
                 "levels are left out: beside mirrors, translucent or baked materials and "
                 "billboards, all objects are shown in full");
        return RELUME_OK;
    }
    o->levels = mem_zeroed((size_t)o->info.objects, sizeof *o->levels);
    if (!o->levels)
        return RELUME_ENOMEM;
    for (int i = 0; i < o->wants && !status; i++)
        status = add_levels(o, o->wanted[i].object, o->wanted[i].pixels, log);
    return status;
}

// ---------------------------------------------------------------- choosing

double objects_pixel_of_window(const struct relume_window *w, int width, int height)
{
    const vec3 across = vec3_cross(w->right, w->down);
    const double area = vec3_length(across);
    const double away = area > 0.0 ? fabs(vec3_dot(vec3_sub(w->corner, w->eye), across)) / area : 0;
    return away > 0.0 ? fmin(vec3_length(w->right) / width, vec3_length(w->down) / height) / away
                      : 0.0;
}

double objects_pixel_of_viewport(const struct relume_viewport *v)
{
    const double x = floor(0.5 * v->width) + 0.5, y = floor(0.5 * v->height) + 0.5;
    vec3 eye, at, right, below;
    if (v->kind == RELUME_VIEWPORT_PARALLEL)
        return 0.0;
    relume_viewport_ray(&eye, &at, v, x, y);
    relume_viewport_ray(&eye, &right, v, x + 1.0, y);
    relume_viewport_ray(&eye, &below, v, x, y + 1.0);
    return fmin(vec3_length(vec3_sub(right, at)), vec3_length(vec3_sub(below, at)));
}

// The level, and how far it is on its way to the next.
static struct level_choice choose(const struct object_levels *l, int part, vec3 eye, double pixel)
{
    double error[MOST_LEVELS];
    struct level_choice c = {0, 0};
    if (!l || !(pixel > 0.0))
        return c;
    for (int i = 0; i < l->levels; i++)
        error[i] = l->level[i].error;
    const struct ball *ball = &l->ball[part - l->first_part];
    const double away = vec3_length(vec3_sub(eye, ball->middle)) - ball->radius;
    c.level = relume_lod_choose(error, l->levels, l->pixels, away, 2.0 * atan(0.5 * pixel), 1);
    if (!(away > 0.0) || c.level + 1 == l->levels)
        return c;
    const double allowed = l->pixels * away * pixel;
    // on the way along chords of the surface errors are up to 0.6 of those at its end
    const double to = error[c.level + 1], from = fmax(error[c.level], 0.5 * to);
    c.moved = (int)floor(MOVES * fmin(fmax((allowed - from) / (to - from), 0.0), 1.0));
    return c;
}

// False where everything is shown in full.
static bool choose_all(struct level_choice *choice, const relume_objects *o, vec3 eye, double pixel)
{
    bool any = false;
    for (int i = 0; i < o->info.parts; i++) {
        choice[i] = choose(o->levels[o->part[i].object], i, eye, pixel);
        any |= choice[i].level > 0 || choice[i].moved > 0;
    }
    return any;
}

// ---------------------------------------------------------------- what is shown

// Where a corner is shown: at a vertex of the objects, or on its way to a place between two.
struct corner_place {
    uint32_t at, to[2];
    float moved, along;
};

static struct level_choice finer(struct level_choice a, struct level_choice b)
{
    return a.level < b.level || (a.level == b.level && a.moved < b.moved) ? a : b;
}

// The finest of the parts at a vertex.
static struct level_choice choice_at(const struct object_levels *l,
                                     const struct level_choice *choice, uint32_t own)
{
    uint64_t left = l->meet ? l->meet[own] : 1;
    struct level_choice c = choice[l->first_part + __builtin_ctzll(left)];
    for (left &= left - 1; left; left &= left - 1)
        c = finer(c, choice[l->first_part + __builtin_ctzll(left)]);
    return c;
}

static uint32_t vertex_in(const struct object_levels *l, int level, uint32_t own)
{
    return l->vertex[l->level[level].vertex[own]];
}

static struct corner_place way_of(const struct object_levels *l, struct level_choice c,
                                  uint32_t own)
{
    const uint32_t at = vertex_in(l, c.level, own);
    const uint32_t to = c.moved ? vertex_in(l, c.level + 1, own) : at;
    return (struct corner_place){at, {to, to}, (float)c.moved / MOVES, 0.0f};
}

// What has come to a border goes on with it.
static struct corner_place find_place(const struct object_levels *l,
                                      const struct level_choice *choice, uint32_t vertex)
{
    if (!l)
        return (struct corner_place){vertex, {vertex, vertex}, 0.0f, 0.0f};
    const uint32_t own = own_number(l, vertex);
    const struct level_choice c = choice_at(l, choice, own);
    struct corner_place place = way_of(l, c, own);
    if (!l->meet || is_border(l, own))
        return place;
    const uint32_t border = l->border[own];
    const struct corner_place there = way_of(l, choice_at(l, choice, border), border);
    if (is_border(l, l->level[c.level].vertex[own]))
        return there;
    if (c.moved && is_border(l, l->level[c.level + 1].vertex[own])) {
        place.to[0] = there.at;
        place.to[1] = there.to[0];
        place.along = there.moved;
    }
    return place;
}

// From a to the place between b and c.
static void blend(float *out, const float *a, const float *b, const float *c, int n,
                  const struct corner_place *p)
{
    for (int i = 0; i < n; i++)
        out[i] = a[i] + p->moved * (b[i] + p->along * (c[i] - b[i]) - a[i]);
}

static uint32_t shown_vertex(relume_objects *to, uint32_t *number, const relume_objects *o,
                             const struct corner_place *p)
{
    if (number[p->at] != UINT32_MAX)
        return number[p->at];
    const struct relume_mesh_vertex *a = &o->vertices[p->at], *b = &o->vertices[p->to[0]],
                                    *c = &o->vertices[p->to[1]];
    const size_t n = to->info.vertex_count;
    struct relume_mesh_vertex *v = &to->vertices[n];
    *v = *a;
    blend(v->position, a->position, b->position, c->position, 3, p);
    blend(v->normal, a->normal, b->normal, c->normal, 3, p);
    blend(v->tangent, a->tangent, b->tangent, c->tangent, 3, p);
    blend(v->texture, a->texture, b->texture, c->texture, 2, p);
    const vec3 normal = vec3_floats(v->normal);
    if (vec3_length(normal) > 0.0)
        vec3_store(v->normal, vec3_unit(normal));
    if (o->tint)
        blend(to->tint[n], o->tint[p->at], o->tint[p->to[0]], o->tint[p->to[1]], 3, p);
    memcpy(to->mesh.vertices[n].position, v->position, sizeof v->position);
    return number[p->at] = (uint32_t)to->info.vertex_count++;
}

static bool is_same_place(const relume_objects *o, uint32_t a, uint32_t b)
{
    const float *p = o->vertices[a].position, *q = o->vertices[b].position;
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

// False where it has no area.
static bool find_corners(struct corner_place corner[3], const relume_objects *o,
                         const struct level_choice *choice, int part, size_t triangle)
{
    for (int k = 0; k < 3; k++)
        corner[k] = find_place(o->levels[o->part[part].object], choice, o->triangles[triangle][k]);
    return !is_same_place(o, corner[0].at, corner[1].at) &&
           !is_same_place(o, corner[1].at, corner[2].at) &&
           !is_same_place(o, corner[2].at, corner[0].at);
}

// Triangles of a part that may have an area: those of its level, where all parts of the object are
// in that.
struct walk {
    size_t first, count;
    const uint32_t *kept;  // NULL: all
};

static struct walk walk_of(const relume_objects *o, const struct level_choice *choice, int part)
{
    const struct relume_object_part *from = &o->part[part];
    const struct object_levels *l = o->levels[from->object];
    bool alike = l;
    for (int i = 0; alike && i < l->parts; i++)
        alike = !memcmp(&choice[l->first_part + i], &choice[part], sizeof *choice);
    if (!alike)
        return (struct walk){from->first, from->count, NULL};
    const struct level *level = &l->level[choice[part].level];
    return (struct walk){l->first, level->triangles, level->kept};
}

// False where it is not the part's, or has no area.
static bool find_triangle(struct corner_place corner[3], const relume_objects *o,
                          const struct level_choice *choice, int part, const struct walk *w,
                          size_t i)
{
    const struct relume_object_part *from = &o->part[part];
    const size_t triangle = w->first + (w->kept ? w->kept[i] : i);
    if (triangle < from->first || triangle - from->first >= from->count)
        return false;
    return find_corners(corner, o, choice, part, triangle) || !o->levels[from->object];
}

static void show_part(relume_objects *to, uint32_t *number, const relume_objects *o, int part)
{
    const struct walk w = walk_of(o, to->choice, part);
    to->part[part].first = to->info.triangle_count;
    for (size_t i = 0; i < w.count; i++) {
        struct corner_place corner[3];
        if (!find_triangle(corner, o, to->choice, part, &w, i))
            continue;
        const size_t n = to->info.triangle_count++;
        for (int k = 0; k < 3; k++) {
            to->triangles[n][k] = shown_vertex(to, number, o, &corner[k]);
            to->mesh.triangles[n].vertex[k] = to->triangles[n][k];
        }
        to->mesh.triangles[n].material = (uint32_t)part;
    }
    to->part[part].count = to->info.triangle_count - to->part[part].first;
}

static size_t count_part(const relume_objects *to, const relume_objects *o, int part)
{
    const struct walk w = walk_of(o, to->choice, part);
    struct corner_place corner[3];
    size_t n = 0;
    for (size_t i = 0; i < w.count; i++)
        n += find_triangle(corner, o, to->choice, part, &w, i);
    return n;
}

// Allocates what all that can be shown needs.
static relume_status allocate_levels(relume_objects *to, const relume_objects *o)
{
    size_t triangles = 0;
    for (int i = 0; i < o->info.parts; i++)
        triangles += count_part(to, o, i);
    const size_t vertices =
        triangles < o->info.vertex_count / 3 ? 3 * triangles : o->info.vertex_count;
    to->vertices = mem_array(vertices, sizeof *to->vertices);
    to->tint = o->tint ? mem_array(vertices, sizeof *to->tint) : NULL;
    to->triangles = mem_array(triangles, sizeof *to->triangles);
    to->mesh.vertices = mem_zeroed(vertices, sizeof *to->mesh.vertices);
    to->mesh.triangles = mem_array(triangles, sizeof *to->mesh.triangles);
    to->part = mem_copy(o->part, (size_t)o->info.parts, sizeof *to->part);
    return to->vertices && to->triangles && to->mesh.vertices && to->mesh.triangles && to->part &&
                   (to->tint || !o->tint)
               ? RELUME_OK
               : RELUME_ENOMEM;
}

// All but the surface is that of `o`.
static relume_status show(relume_objects *to, const relume_objects *o)
{
    uint32_t *number = mem_array(o->info.vertex_count, sizeof *number);
    relume_status status = number ? allocate_levels(to, o) : RELUME_ENOMEM;
    if (!status) {
        memset(number, 0xff, o->info.vertex_count * sizeof *number);
        to->info = o->info;
        to->info.vertex_count = to->info.triangle_count = 0;
        for (int i = 0; i < o->info.parts; i++)
            show_part(to, number, o, i);
        to->mesh.vertex_count = to->info.vertex_count;
        to->mesh.triangle_count = to->info.triangle_count;
        to->info.vertices = to->vertices;
        to->info.triangles = (const uint32_t(*)[3])to->triangles;
        to->info.tint = (const float(*)[3])to->tint;
        to->info.part = to->part;
    }
    mem_free(number);
    return status;
}

// A fold of a coarse surface that the full one has not got is at most so high.
static float fold_of(const relume_objects *o, const struct level_choice *choice, int part)
{
    const struct object_levels *l = o->levels[o->part[part].object];
    const struct level_choice c = choice[part];
    if (!l)
        return 0.0f;
    const double from = l->level[c.level].length;
    const double to = c.moved ? l->level[c.level + 1].length : from;
    return (float)(from + (to - from) * c.moved / MOVES);
}

static bool same_choice(const relume_objects *shown, const relume_objects *o,
                        const struct level_choice *choice, bool rays)
{
    return shown && shown->shown_of == o && (shown->tracer || !rays) &&
           !memcmp(shown->choice, choice, (size_t)o->info.parts * sizeof *choice);
}

static relume_status finish(relume_objects *to, const relume_objects *o, bool rays)
{
    struct trace_holes holes;
    to->shown_of = o;
    to->material = o->material;
    to->folder = o->folder;
    to->translucent = o->translucent;
    to->standing = o->standing;
    to->reflection = o->reflection;
    to->fold = mem_array((size_t)o->info.parts, sizeof *to->fold);
    if (!to->fold)
        return RELUME_ENOMEM;
    for (int i = 0; i < o->info.parts; i++)
        to->fold[i] = fold_of(o, to->choice, i);
    const relume_status status = show(to, o);
    if (status || !rays)
        return status;
    const bool has_holes = skin_holes(&holes, to);
    return trace_create_clouds(&to->tracer, &to->mesh, NULL, 0, has_holes ? &holes : NULL, NULL);
}

relume_status objects_show(relume_objects **shown, const relume_objects *o,
                           const struct level_choice *choice, bool rays)
{
    relume_objects *to = mem_zeroed(1, sizeof *to);
    if (!to)
        return RELUME_ENOMEM;
    to->choice = mem_copy(choice, (size_t)o->info.parts, sizeof *choice);
    const relume_status status = to->choice ? finish(to, o, rays) : RELUME_ENOMEM;
    relume_objects_destroy(status ? &to : shown);
    if (!status)
        *shown = to;
    return status;
}

relume_status relume_objects_shown(relume_objects **shown, const relume_objects *o, vec3 eye,
                                   double pixel, bool rays)
{
    relume_status status = RELUME_OK;
    if (!o->levels) {
        relume_objects_destroy(shown);
        return RELUME_OK;
    }
    struct level_choice *choice = mem_array((size_t)o->info.parts, sizeof *choice);
    if (!choice)
        return RELUME_ENOMEM;
    if (!choose_all(choice, o, eye, pixel))
        relume_objects_destroy(shown);
    else if (!same_choice(*shown, o, choice, rays))
        status = objects_show(shown, o, choice, rays);
    else
        for (int i = 0; i < o->info.parts; i++)
            (*shown)->part[i].material = o->part[i].material;
    mem_free(choice);
    return status;
}

int objects_levels(const relume_objects *o, int part)
{
    const struct object_levels *l = o->levels ? o->levels[o->part[part].object] : NULL;
    return l ? l->levels : 1;
}
