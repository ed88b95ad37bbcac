// levels.c - objects that have fewer triangles from afar, without popping
//
// One run of collapses is a progressive mesh (Hoppe 1996); levels are its states at errors that
// double. The coarsest level whose error is seen within so many pixels is shown, and its vertices
// are on their way to where the next level has them, by as much as the error that may be seen has
// grown from the one level's to the other's. So the surface is the same before and after a change,
// and its error is never more than what may be seen.
#include "base/log.h"
#include "base/memory.h"
#include "object/levels.h"
#include "object/object.h"
#include "object/skin.h"

#include <relume/billboards.h>
#include <relume/simplify.h>
#include <string.h>

// Of the diagonal: an object whose error that is covers a few pixels.
static const double COARSEST = 0.08;
// What shading may change by counts as the length that is seen from as far away under 1/30 degree.
static const double LENGTH_OF_DISTANCE = 2.0 * 2.908882e-4;
// Of its triangles a level has at most so many of those of the finer one.
static const double FEWER = 0.8;
// A move is done in so many steps: they are finer than what is seen, and most frames change none.
enum { MOVES = 256, LEAST_TRIANGLES = 12, MOST_LEVELS = 12 };

struct level {
    double error;      // in the world
    uint32_t *vertex;  // [vertices]: where each has gone
    uint32_t *kept;    // [triangles]: that have an area still
    size_t triangles;
};
struct object_levels {
    double pixels;        // that an error may be seen as
    size_t first, count;  // triangles of the objects
    uint32_t *vertex;     // [vertices]: of the objects, in order
    size_t vertices;
    vec3 middle;
    double radius;
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
        const struct relume_object_vertex *v = &o->vertices[l->vertex[i]];
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
            l->levels++;
            continue;
        }
        mem_free(next->vertex);
        mem_free(next->kept);
        *next = (struct level){0};
    }
    return status;
}

static void find_extent(struct object_levels *l, const relume_objects *o)
{
    vec3 min = vec3_of(INFINITY, INFINITY, INFINITY), max = vec3_scale(min, -1.0);
    for (size_t i = 0; i < l->vertices; i++) {
        const vec3 p = vec3_floats(o->vertices[l->vertex[i]].position);
        min = vec3_of(fmin(min.x, p.x), fmin(min.y, p.y), fmin(min.z, p.z));
        max = vec3_of(fmax(max.x, p.x), fmax(max.y, p.y), fmax(max.z, p.z));
    }
    l->middle = vec3_scale(vec3_add(min, max), 0.5);
    l->radius = 0.5 * vec3_length(vec3_sub(max, min));
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
        l->first = !l->count && o->part[i].object == object ? o->part[i].first : l->first;
        l->count += o->part[i].object == object ? o->part[i].count : 0;
    }
    if (!l->count) {
        object_levels_free(&o->levels[object]);
        return RELUME_OK;
    }
    relume_status status = list_vertices(l, o);
    if (!status)
        status = take_mesh(&mesh, l, o);
    if (!status)
        find_extent(l, o);
    if (!status)
        status = relume_mesh_simplify(
            &coarse, &s, &mesh, relume_simplify_params(.log = log, .triangles = LEAST_TRIANGLES));
    if (!status)
        status = make_levels(l, &mesh, &s);
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
static struct level_choice choose(const struct object_levels *l, vec3 eye, double pixel)
{
    double error[MOST_LEVELS];
    struct level_choice c = {0, 0};
    if (!l || !(pixel > 0.0))
        return c;
    for (int i = 0; i < l->levels; i++)
        error[i] = l->level[i].error;
    const double away = vec3_length(vec3_sub(eye, l->middle)) - l->radius;
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
    for (int i = 0; i < o->info.objects; i++) {
        choice[i] = choose(o->levels[i], eye, pixel);
        any |= choice[i].level > 0 || choice[i].moved > 0;
    }
    return any;
}

// ---------------------------------------------------------------- what is shown

static void between(float *out, const float *a, const float *b, int n, float part)
{
    for (int i = 0; i < n; i++)
        out[i] = a[i] + part * (b[i] - a[i]);
}

// The vertex of the objects that stands for a corner, and the one that it is on its way to.
static void find_ends(uint32_t end[2], const struct object_levels *l, struct level_choice c,
                      uint32_t vertex)
{
    end[0] = end[1] = vertex;
    if (!l)
        return;
    const uint32_t own = own_number(l, vertex);
    end[0] = end[1] = l->vertex[l->level[c.level].vertex[own]];
    if (c.moved)
        end[1] = l->vertex[l->level[c.level + 1].vertex[own]];
}

static uint32_t shown_vertex(relume_objects *to, uint32_t *number, const relume_objects *o,
                             const uint32_t end[2], float part)
{
    if (number[end[0]] != UINT32_MAX)
        return number[end[0]];
    const struct relume_object_vertex *a = &o->vertices[end[0]], *b = &o->vertices[end[1]];
    const size_t n = to->info.vertex_count;
    struct relume_object_vertex *v = &to->vertices[n];
    *v = *a;
    between(v->position, a->position, b->position, 3, part);
    between(v->normal, a->normal, b->normal, 3, part);
    between(v->tangent, a->tangent, b->tangent, 3, part);
    between(v->texture, a->texture, b->texture, 2, part);
    const vec3 normal = vec3_floats(v->normal);
    if (vec3_length(normal) > 0.0)
        vec3_store(v->normal, vec3_unit(normal));
    if (o->tint)
        between(to->tint[n], o->tint[end[0]], o->tint[end[1]], 3, part);
    memcpy(to->mesh.vertices[n].position, v->position, sizeof v->position);
    return number[end[0]] = (uint32_t)to->info.vertex_count++;
}

static void show_triangle(relume_objects *to, uint32_t *number, const relume_objects *o, int part,
                          size_t triangle)
{
    const int object = o->part[part].object;
    const struct level_choice c = to->choice[object];
    const size_t n = to->info.triangle_count++;
    for (int k = 0; k < 3; k++) {
        uint32_t end[2];
        find_ends(end, o->levels[object], c, o->triangles[triangle][k]);
        to->triangles[n][k] = shown_vertex(to, number, o, end, (float)c.moved / MOVES);
        to->mesh.triangles[n].vertex[k] = to->triangles[n][k];
    }
    to->mesh.triangles[n].material = (uint32_t)part;
}

static void show_part(relume_objects *to, uint32_t *number, const relume_objects *o, int part)
{
    const struct relume_object_part *from = &o->part[part];
    const struct object_levels *l = o->levels[from->object];
    const struct level *level = l ? &l->level[to->choice[from->object].level] : NULL;
    to->part[part].first = to->info.triangle_count;
    for (size_t i = 0; level && i < level->triangles; i++) {
        const size_t triangle = l->first + level->kept[i];
        if (triangle >= from->first && triangle - from->first < from->count)
            show_triangle(to, number, o, part, triangle);
    }
    for (size_t i = 0; !level && i < from->count; i++)
        show_triangle(to, number, o, part, from->first + i);
    to->part[part].count = to->info.triangle_count - to->part[part].first;
}

// Room for all that can be shown.
static relume_status make_room(relume_objects *to, const relume_objects *o)
{
    size_t triangles = 0;
    for (int i = 0; i < o->info.parts; i++) {
        const struct object_levels *l = o->levels[o->part[i].object];
        if (!l)
            triangles += o->part[i].count;
        else if (o->part[i].first == l->first)
            triangles += l->level[to->choice[o->part[i].object].level].triangles;
    }
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
    relume_status status = number ? make_room(to, o) : RELUME_ENOMEM;
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

static bool same_choice(const relume_objects *shown, const relume_objects *o,
                        const struct level_choice *choice, bool rays)
{
    return shown && shown->shown_of == o && (shown->tracer || !rays) &&
           !memcmp(shown->choice, choice, (size_t)o->info.objects * sizeof *choice);
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
    const relume_status status = show(to, o);
    if (status || !rays)
        return status;
    const bool has_holes = skin_holes(&holes, to);
    return trace_create_clouds(&to->tracer, &to->mesh, NULL, 0, has_holes ? &holes : NULL, NULL);
}

relume_status relume_objects_shown(relume_objects **shown, const relume_objects *o, vec3 eye,
                                   double pixel, bool rays)
{
    const size_t objects = (size_t)o->info.objects;
    struct level_choice *choice = o->levels ? mem_array(objects, sizeof *choice) : NULL;
    relume_objects *to = NULL;
    if (o->levels && !choice)
        return RELUME_ENOMEM;
    if (!choice || !choose_all(choice, o, eye, pixel)) {
        mem_free(choice);
        relume_objects_destroy(shown);
        return RELUME_OK;
    }
    if (same_choice(*shown, o, choice, rays)) {
        mem_free(choice);
        for (int i = 0; i < o->info.parts; i++)
            (*shown)->part[i].material = o->part[i].material;
        return RELUME_OK;
    }
    if (!(to = mem_zeroed(1, sizeof *to))) {
        mem_free(choice);
        return RELUME_ENOMEM;
    }
    to->choice = choice;
    const relume_status status = finish(to, o, rays);
    relume_objects_destroy(status ? &to : shown);
    if (!status)
        *shown = to;
    return status;
}
