// simplify_parts.c - a mesh for which memory is too short, piece by piece
//
// Space is cut into cells; the triangles whose middles lie in a cell are a piece. A point at which
// pieces meet stays, with all triangles around it, so that what one piece does never tears it from
// another. Further rounds cut elsewhere, and begin with the points that could not go yet: the
// seams. Vertices that have gone stay on the lists of the triangles that they lie on from piece to
// piece, and the original's triangles near a piece are looked up anew: errors are those of the
// whole, never of one round upon another.
//
// Lists of all triangles and vertices wait in a scratch file; only the pages that a piece touches
// are in memory.
#include "core/base/log.h"
#include "core/base/scratch.h"
#include "shape/mesh/simplify_kd.h"
#include "shape/mesh/simplify_run.h"

#include <errno.h>
#include <string.h>

#define SHARED (NOTHING - 1)
// A piece with the border around it has at most so many times its triangles, roughly.
#define WITH_BORDER 1.5
enum { LEAST_PIECE = 1000, PASSES = 3 };
static const double cut_at[PASSES] = {0.5, 0.38, 0.6};

struct list {
    uint32_t *item;
    size_t count;
};

struct box {
    vec3 low, high;
};

// The triangles of a mesh by cells.
struct by_cell {
    uint32_t *triangle;  // in the scratch file
    size_t *first;       // [cells + 1]
};

struct parts {
    struct run *run;
    const struct relume_log *log;
    size_t capacity;  // triangles of a piece
    char *memory;
    size_t bytes, taken;
    uint32_t (*triangle)[3];               // as they are now; gone: NOTHING
    uint32_t *sample_first, *sample_next;  // vertices that have gone, by triangles
    float (*shown)[3];                     // [vertices]: normals as they are now
    uint32_t *point;                       // [vertices]
    uint32_t *owner;                       // [points]: a cell, SHARED, NOTHING
    uint32_t *local;                       // [vertices]: in the piece
    uint32_t *marked;                      // [points]: 1 while a piece looks for its border
    uint32_t *waits;                       // [points]: 1 until it may go for the first time
    size_t points, alive;
    struct kd cells;
    struct by_cell now, original;
    struct box *box;      // [cells]: of the original's triangles
    struct list *border;  // [cells]: triangles at points that others touch
};

// A piece while it is made and run.
struct open_piece {
    struct parts *parts;
    int cell;
    struct piece piece;
    struct list vertex;    // of the mesh, by local numbers
    struct list triangle;  // of the mesh: own ones, then borders
    struct list near;      // of the original
    struct list sample;    // vertex, triangle (local)
};

// ---------------------------------------------------------------- memory

static void *take_memory(struct parts *p, size_t count)
{
    void *at = p->memory + p->taken;
    p->taken += (count * sizeof(uint32_t) + 4095) / 4096 * 4096;
    return at;
}

static relume_status map_parts(struct parts *p)
{
    const struct relume_mesh *m = p->run->s.mesh;
    const size_t t = m->triangle_count, v = m->vertex_count;
    p->bytes = (6 * t + 9 * v) * sizeof(uint32_t) + (size_t)13 * 4096;
    p->memory = scratch_map(NULL, p->bytes);
    if (!p->memory)
        return log_fail(p->log, RELUME_EIO,
                        "no room for %zu MB of a mesh that is simplified in %s; %s", p->bytes >> 20,
                        scratch_folder(), strerror(errno));
    p->triangle = take_memory(p, 3 * t);
    p->sample_first = take_memory(p, t);
    p->now.triangle = take_memory(p, t);
    p->original.triangle = take_memory(p, t);
    p->sample_next = take_memory(p, v);
    p->shown = take_memory(p, 3 * v);
    p->point = take_memory(p, v);
    p->owner = take_memory(p, v);
    p->local = take_memory(p, v);
    p->marked = take_memory(p, v);
    p->waits = take_memory(p, v);
    return RELUME_OK;
}

static void free_round(struct parts *p)
{
    for (int i = 0; p->border && i < p->cells.count; i++)
        mem_free(p->border[i].item);
    mem_free(p->border);
    mem_free(p->box);
    mem_free(p->now.first);
    mem_free(p->original.first);
    kd_free(&p->cells);
    p->border = NULL;
    p->box = NULL;
    p->now.first = p->original.first = NULL;
}

static bool add(struct list *l, uint32_t item)
{
    if (!mem_grow(&l->item, l->count, sizeof *l->item))
        return false;
    l->item[l->count++] = item;
    return true;
}

// ---------------------------------------------------------------- rounds

static relume_status begin(struct parts *p)
{
    const struct relume_mesh *m = p->run->s.mesh;
    struct connect c = {.vertices = m->vertex_count, .point = p->point};
    const relume_status status = connect_number(&c, m);
    if (status)
        return status;
    p->points = c.points;
    for (size_t t = 0; t < m->triangle_count; t++) {
        const bool whole = connect_has_area(&c, m->triangle[t]);
        memcpy(p->triangle[t], m->triangle[t], sizeof *p->triangle);
        if (!whole)
            p->triangle[t][0] = NOTHING;
        p->alive += whole;
    }
    memset(p->sample_first, 0xff, m->triangle_count * sizeof *p->sample_first);
    memcpy(p->shown, m->normal, m->vertex_count * sizeof *p->shown);
    memset(p->local, 0xff, m->vertex_count * sizeof *p->local);
    for (size_t i = 0; i < p->points; i++)
        p->waits[i] = 1;
    return p->alive ? RELUME_OK : log_fail(p->log, RELUME_EUNFIT, NO_AREA);
}

// Pages of what was touched leave the memory of the process.
static void rest(struct parts *p)
{
    scratch_forget(p->memory, p->bytes, 0, p->bytes);
}

// Triangles in the order of their cells; those that are gone in none.
static relume_status sort(struct parts *p, struct by_cell *by, uint32_t (*triangle)[3])
{
    const struct simplify *s = &p->run->s;
    const size_t n = s->mesh->triangle_count;
    by->first = mem_zeroed((size_t)p->cells.count + 1, sizeof *by->first);
    uint32_t *cell = mem_array(n, sizeof *cell);
    const bool good = by->first && cell;
    for (size_t t = 0; good && t < n; t++) {
        cell[t] =
            triangle[t][0] == NOTHING ? NOTHING : (uint32_t)kd_find(&p->cells, s, triangle[t]);
        if (cell[t] != NOTHING)
            by->first[cell[t] + 1]++;
    }
    for (int i = 0; good && i < p->cells.count; i++)
        by->first[i + 1] += by->first[i];
    for (size_t t = n; good && t-- > 0;)
        if (cell[t] != NOTHING)
            by->triangle[--by->first[cell[t] + 1]] = (uint32_t)t;
    // each first is that of the cell before it now
    for (int i = 0; good && i < p->cells.count; i++)
        by->first[i] = by->first[i + 1];
    size_t count = 0;
    for (size_t t = 0; good && t < n; t++)
        count += cell[t] != NOTHING;
    if (good)
        by->first[p->cells.count] = count;
    mem_free(cell);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

static bool is_border(const struct parts *p, const uint32_t t[3])
{
    return p->owner[p->point[t[0]]] == SHARED || p->owner[p->point[t[1]]] == SHARED ||
           p->owner[p->point[t[2]]] == SHARED;
}

static bool list_border(struct parts *p, int cell)
{
    p->border[cell].count = 0;
    for (size_t i = p->now.first[cell]; i < p->now.first[cell + 1]; i++) {
        const uint32_t t = p->now.triangle[i];
        if (p->triangle[t][0] != NOTHING && is_border(p, p->triangle[t]) &&
            !add(&p->border[cell], t))
            return false;
    }
    return true;
}

static void own_points(struct parts *p)
{
    memset(p->owner, 0xff, p->points * sizeof *p->owner);
    for (int cell = 0; cell < p->cells.count; cell++)
        for (size_t i = p->now.first[cell]; i < p->now.first[cell + 1]; i++)
            for (int k = 0; k < 3; k++) {
                uint32_t *owner = &p->owner[p->point[p->triangle[p->now.triangle[i]][k]]];
                *owner = *owner == NOTHING || *owner == (uint32_t)cell ? (uint32_t)cell : SHARED;
            }
}

static void widen(struct box *b, vec3 p)
{
    b->low = vec3_of(fmin(b->low.x, p.x), fmin(b->low.y, p.y), fmin(b->low.z, p.z));
    b->high = vec3_of(fmax(b->high.x, p.x), fmax(b->high.y, p.y), fmax(b->high.z, p.z));
}

static struct box nowhere(void)
{
    const vec3 most = vec3_of(INFINITY, INFINITY, INFINITY);
    return (struct box){most, vec3_scale(most, -1.0)};
}

static bool do_meet(const struct box *a, const struct box *b)
{
    return a->low.x <= b->high.x && b->low.x <= a->high.x && a->low.y <= b->high.y &&
           b->low.y <= a->high.y && a->low.z <= b->high.z && b->low.z <= a->high.z;
}

static void find_boxes(struct parts *p)
{
    const struct simplify *s = &p->run->s;
    for (int cell = 0; cell < p->cells.count; cell++) {
        p->box[cell] = nowhere();
        for (size_t i = p->original.first[cell]; i < p->original.first[cell + 1]; i++)
            for (int k = 0; k < 3; k++)
                widen(&p->box[cell], place(s, s->mesh->triangle[p->original.triangle[i]][k]));
    }
}

static relume_status begin_round(struct parts *p, size_t most, double share)
{
    const struct relume_mesh *m = p->run->s.mesh;
    relume_status status = kd_create(&p->cells, &p->run->s, most, share);
    if (!status)
        status = sort(p, &p->now, p->triangle);
    rest(p);
    if (!status)
        status = sort(p, &p->original, m->triangle);
    rest(p);
    const size_t cells = (size_t)p->cells.count;
    if (!status && (!(p->box = mem_array(cells, sizeof *p->box)) ||
                    !(p->border = mem_zeroed(cells, sizeof *p->border))))
        status = RELUME_ENOMEM;
    if (status)
        return status;
    own_points(p);
    rest(p);
    find_boxes(p);
    rest(p);
    for (int i = 0; i < p->cells.count; i++)
        if (!list_border(p, i))
            return RELUME_ENOMEM;
    rest(p);
    return RELUME_OK;
}

// ---------------------------------------------------------------- a piece is made

static bool name_vertex(struct open_piece *w, uint32_t vertex)
{
    uint32_t *local = &w->parts->local[vertex];
    if (*local != NOTHING)
        return true;
    *local = (uint32_t)w->vertex.count;
    return add(&w->vertex, vertex);
}

static bool name_triangle(struct open_piece *w, const uint32_t t[3])
{
    return name_vertex(w, t[0]) && name_vertex(w, t[1]) && name_vertex(w, t[2]);
}

static bool list_own(struct open_piece *w)
{
    const struct parts *p = w->parts;
    for (size_t i = p->now.first[w->cell]; i < p->now.first[w->cell + 1]; i++) {
        const uint32_t t = p->now.triangle[i], local = (uint32_t)w->triangle.count;
        if (!add(&w->triangle, t) || !name_triangle(w, p->triangle[t]))
            return false;
        for (uint32_t v = p->sample_first[t]; p->run->s.tested && v != NOTHING;
             v = p->sample_next[v])
            if (!name_vertex(w, v) || !add(&w->sample, p->local[v]) || !add(&w->sample, local))
                return false;
    }
    w->piece.own = w->triangle.count;
    return true;
}

static void mark_border(struct open_piece *w, uint32_t mark)
{
    struct parts *p = w->parts;
    const struct list *border = &p->border[w->cell];
    for (size_t i = 0; i < border->count; i++)
        for (int k = 0; k < 3; k++)
            p->marked[p->point[p->triangle[border->item[i]][k]]] = mark;
}

static bool is_marked(const struct parts *p, uint32_t vertex)
{
    const uint32_t point = p->point[vertex];
    return p->marked[point] && p->owner[point] == SHARED;
}

// Triangles of other pieces at points of this one.
static bool list_others(struct open_piece *w)
{
    const struct parts *p = w->parts;
    bool good = true;
    mark_border(w, 1);
    for (int cell = 0; cell < p->cells.count && good; cell++)
        for (size_t i = 0; cell != w->cell && i < p->border[cell].count && good; i++) {
            const uint32_t t = p->border[cell].item[i], *v = p->triangle[t];
            if (is_marked(p, v[0]) || is_marked(p, v[1]) || is_marked(p, v[2]))
                good = add(&w->triangle, t) && name_triangle(w, v);
        }
    mark_border(w, 0);
    return good;
}

// The original as far as new triangles may ask for it.
static bool list_near(struct open_piece *w)
{
    const struct parts *p = w->parts;
    const struct simplify *s = &p->run->s;
    const double reach = isfinite(p->run->most.length) ? p->run->most.length : 0.0;
    const vec3 around = vec3_of(reach, reach, reach);
    struct box here = nowhere();
    for (size_t i = 0; i < w->vertex.count; i++)
        widen(&here, place(s, w->vertex.item[i]));
    here.low = vec3_sub(here.low, around);
    here.high = vec3_add(here.high, around);
    for (int cell = 0; cell < p->cells.count; cell++) {
        if (!do_meet(&here, &p->box[cell]))
            continue;
        for (size_t i = p->original.first[cell]; i < p->original.first[cell + 1]; i++) {
            const uint32_t t = p->original.triangle[i], *v = s->mesh->triangle[t];
            struct box own = nowhere();
            for (int k = 0; k < 3; k++)
                widen(&own, place(s, v[k]));
            if (do_meet(&here, &own) && (!add(&w->near, t) || !name_triangle(w, v)))
                return false;
        }
    }
    return true;
}

static void copy_vertices(struct open_piece *w)
{
    const struct parts *p = w->parts;
    const struct relume_mesh *m = p->run->s.mesh;
    struct relume_mesh *to = &w->piece.mesh;
    for (size_t i = 0; i < w->vertex.count; i++) {
        const uint32_t v = w->vertex.item[i], point = p->point[v];
        memcpy(to->position[i], m->position[v], sizeof *to->position);
        memcpy(to->normal[i], m->normal[v], sizeof *to->normal);
        memcpy(w->piece.shown[i], p->shown[v], sizeof *p->shown);
        if (m->texture)
            memcpy(to->texture[i], m->texture[v], sizeof *to->texture);
        if (m->colour)
            memcpy(to->colour[i], m->colour[v], sizeof *to->colour);
        w->piece.may[i] = p->owner[point] != (uint32_t)w->cell ? PIECE_STAYS
                          : p->waits[point]                    ? PIECE_WAITS
                                                               : PIECE_MAY_GO;
    }
}

static void copy_triangles(const struct parts *p, const struct list *from,
                           const uint32_t (*triangle)[3], uint32_t (*to)[3])
{
    for (size_t i = 0; i < from->count; i++)
        for (int k = 0; k < 3; k++)
            to[i][k] = p->local[triangle[from->item[i]][k]];
}

static relume_status make_piece(struct open_piece *w)
{
    const struct parts *p = w->parts;
    const struct relume_mesh *m = p->run->s.mesh;
    struct piece *piece = &w->piece;
    if (!list_own(w) || !list_others(w) || (p->run->s.tested && !list_near(w)))
        return RELUME_ENOMEM;
    const size_t vertices = w->vertex.count, triangles = w->triangle.count;
    piece->mesh = (struct relume_mesh){
        .vertex_count = vertices,
        .triangle_count = w->near.count,
        .position = mem_array(vertices, sizeof *piece->mesh.position),
        .normal = mem_array(vertices, sizeof *piece->mesh.normal),
        .texture = m->texture ? mem_array(vertices, sizeof *piece->mesh.texture) : NULL,
        .colour = m->colour ? mem_array(vertices, sizeof *piece->mesh.colour) : NULL,
        .triangle = mem_array(w->near.count, sizeof *piece->mesh.triangle),
    };
    piece->triangles = triangles;
    piece->triangle = mem_array(triangles, sizeof *piece->triangle);
    piece->part = m->part ? mem_array(triangles, sizeof *piece->part) : NULL;
    piece->shown = mem_array(vertices, sizeof *piece->shown);
    piece->may = mem_array(vertices, sizeof *piece->may);
    piece->sample = w->sample.item;
    piece->samples = w->sample.count / 2;
    if (!piece->mesh.position || !piece->mesh.normal || (m->texture && !piece->mesh.texture) ||
        (m->colour && !piece->mesh.colour) || !piece->mesh.triangle || !piece->triangle ||
        (m->part && !piece->part) || !piece->shown || !piece->may)
        return RELUME_ENOMEM;
    copy_vertices(w);
    copy_triangles(p, &w->triangle, (const uint32_t(*)[3])p->triangle, piece->triangle);
    copy_triangles(p, &w->near, (const uint32_t(*)[3])m->triangle, piece->mesh.triangle);
    for (size_t i = 0; piece->part && i < triangles; i++)
        piece->part[i] = m->part[w->triangle.item[i]];
    return RELUME_OK;
}

// ---------------------------------------------------------------- and done

static void keep_triangles(struct open_piece *w, const struct run *r)
{
    struct parts *p = w->parts;
    const struct connect *c = &r->s.connect;
    for (size_t i = 0; i < w->piece.own; i++) {
        const uint32_t t = w->triangle.item[i];
        uint32_t *first = &p->sample_first[t];
        if (c->triangle[i][0] == NOTHING) {
            p->triangle[t][0] = NOTHING;
            *first = NOTHING;
            p->alive--;
            continue;
        }
        for (int k = 0; k < 3; k++)
            p->triangle[t][k] = w->vertex.item[c->triangle[i][k]];
        if (!r->s.tested)
            continue;
        *first = NOTHING;
        for (uint32_t v = r->s.sample_first[i]; v != NOTHING; v = r->s.sample_next[v]) {
            p->sample_next[w->vertex.item[v]] = *first;
            *first = w->vertex.item[v];
        }
    }
    for (size_t i = 0; i < w->vertex.count; i++) {
        const uint32_t v = w->vertex.item[i];
        if (w->piece.may[i] == PIECE_STAYS)
            continue;
        p->waits[p->point[v]] = 0;
        if (r->s.shown)
            memcpy(p->shown[v], r->s.shown[i], sizeof *p->shown);
    }
}

static relume_status keep_steps(const struct open_piece *w, const struct run *r)
{
    struct run *all = w->parts->run;
    for (size_t i = 0; i < r->steps; i++) {
        struct relume_simplify_step step = r->step[i];
        if (!mem_grow(&all->step, all->steps, sizeof *all->step))
            return RELUME_ENOMEM;
        step.vertex = w->vertex.item[step.vertex];
        step.onto = w->vertex.item[step.onto];
        all->step[all->steps++] = step;
    }
    return RELUME_OK;
}

static void free_work(struct open_piece *w)
{
    relume_mesh_free(&w->piece.mesh);
    mem_free(w->piece.triangle);
    mem_free(w->piece.part);
    mem_free(w->piece.shown);
    mem_free(w->piece.may);
    for (size_t i = 0; i < w->vertex.count; i++)
        w->parts->local[w->vertex.item[i]] = NOTHING;
    mem_free(w->vertex.item);
    mem_free(w->triangle.item);
    mem_free(w->near.item);
    mem_free(w->sample.item);
}

static bool has_work(const struct parts *p, int cell)
{
    for (size_t i = p->now.first[cell]; i < p->now.first[cell + 1]; i++)
        for (int k = 0; k < 3; k++) {
            const uint32_t point = p->point[p->triangle[p->now.triangle[i]][k]];
            if (p->waits[point] && p->owner[point] == (uint32_t)cell)
                return true;
        }
    return false;
}

// `share`: of its triangles that are to be left.
static relume_status run_piece(struct parts *p, int cell, double share)
{
    struct run *all = p->run;
    struct open_piece w = {.parts = p, .cell = cell};
    struct run r = *all;
    relume_status status = make_piece(&w);
    r.piece = &w.piece;
    r.s.mesh = &w.piece.mesh;
    r.step = NULL;
    r.steps = 0;
    r.target = w.piece.triangles - w.piece.own + (size_t)(share * (double)w.piece.own);
    if (!status)
        status = r.status = run_prepare(&r);
    if (!status) {
        run_down(&r, p->log);
        status = r.status;
    }
    if (!status)
        status = keep_steps(&w, &r);
    if (!status) {
        all->done = r.done;
        keep_triangles(&w, &r);
        status = list_border(p, cell) ? RELUME_OK : RELUME_ENOMEM;
    }
    run_free(&r);
    free_work(&w);
    rest(p);
    return status;
}

static relume_status run_round(struct parts *p, size_t most, double cut, double from, double to)
{
    const size_t target = p->run->target;
    relume_status status = begin_round(p, most, cut);
    const double share = target ? fmin((double)target / (double)p->alive, 1.0) : 0.0;
    for (int cell = 0; cell < p->cells.count && !status && p->alive > target; cell++) {
        const double each = (to - from) / p->cells.count;
        p->run->told[0] = from + cell * each;
        p->run->told[1] = from + (cell + 1) * each;
        if (!log_progress(p->log, "simplify", p->run->told[0]))
            status = RELUME_ECANCEL;
        else if (has_work(p, cell))
            status = run_piece(p, cell, share);
    }
    free_round(p);
    return status;
}

// What seams have kept, and what could not go unseen, in one piece where that fits.
static relume_status run_rest(struct parts *p)
{
    p->run->last_resort = p->run->s.tested;
    p->run->s.tested = false;
    for (size_t i = 0; i < p->points; i++)
        p->waits[i] = 1;
    const size_t all = p->run->s.mesh->triangle_count;
    return run_round(p, p->alive <= p->capacity ? all : p->capacity, cut_at[0], 0.9, 1.0);
}

static relume_status run_all(struct parts *p)
{
    relume_status status = begin(p);
    rest(p);
    for (int i = 0; i < PASSES && !status; i++)
        status = run_round(p, p->capacity, cut_at[i], i ? 0.7 + 0.1 * (i - 1) : 0.0, 0.7 + 0.1 * i);
    if (!status && p->alive > p->run->target && p->run->target)
        status = run_rest(p);
    return status;
}

relume_status run_in_parts(struct relume_mesh *out, struct run *r, size_t memory,
                           const struct relume_log *log)
{
    const struct relume_mesh *m = r->s.mesh;
    const double each = WITH_BORDER *
                        (double)(run_bytes(&r->s, m->vertex_count, m->triangle_count) +
                                 m->triangle_count * (12 + 12 + 4) + m->vertex_count * 48) /
                        (double)m->triangle_count;
    struct parts p = {.run = r, .log = log, .capacity = (size_t)((double)memory / each)};
    if (p.capacity < LEAST_PIECE)
        return log_fail(
            log, RELUME_ELIMIT,
            "simplifying the mesh takes at least %s; expected at most %s (--max-memory)",
            memory_text((uint64_t)(LEAST_PIECE * each), memory).text,
            memory_text(memory, (uint64_t)(LEAST_PIECE * each)).text);
    log_line(log, RELUME_NOTE,
             "the mesh is simplified in parts of about %zu triangles, for want of memory",
             p.capacity);
    relume_status status = map_parts(&p);
    if (!status)
        status = run_all(&p);
    if (!status) {
        const struct connect c = {.vertices = m->vertex_count,
                                  .triangles = m->triangle_count,
                                  .triangle = p.triangle,
                                  .alive = p.alive};
        status = run_collect(out, &c, m, p.shown);
    }
    if (p.memory)
        scratch_unmap(p.memory, p.bytes);
    return status;
}
