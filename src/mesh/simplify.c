// simplify.c - fewer triangles that look the same: the order in which vertices go
//
// The cheapest point by quadrics is tried first, towards each of its neighbours. What it would do
// is measured (simplify_samples.c); where that is worse than its key it waits under its true error
// (Guthe 2008, section 10.1). Points around a move are weighed again when their turn comes: they
// rarely become cheaper.
#include "mesh/simplify.h"

#include "base/log.h"
#include "base/params.h"
#include "math/scalar.h"

#include <string.h>

#define PI 3.14159265358979323846
// An edge is seen to move when it moves by more than this angle.
#define LEAST_ANGLE (PI / 180.0 / 30.0)
// Of a value of 1 (a normal's component, white's), diagonals.
#define VALUE_WEIGHT 0.03
// Seen where one looks for it: at 1 few triangles of a scan could go.
#define USUAL_JND 4.0
// Errors below this share of the most are as good as none.
#define FINE_SHARE 0.5
// Between looks at whether to stop.
enum { PROGRESS_EVERY = 16384 };

struct run {
    struct simplify s;
    struct queue queue;
    struct samples samples;
    struct fan fan;
    uint8_t *stale;  // [points]: weigh again
    struct error most, done;
    bool last_resort;  // nothing is tested any more
    size_t target, moves;
    struct relume_simplify_step *step;  // or NULL
    size_t steps;
    bool keep_steps;
    relume_status status;
};

static void run_free(struct run *r)
{
    struct simplify *s = &r->s;
    connect_free(&s->connect);
    queue_free(&r->queue);
    mem_free(s->quadric);
    mem_free(s->spread);
    mem_free(s->curvature);
    mem_free(s->spacing);
    near_free(&s->near);
    mem_free(s->sample_first);
    mem_free(s->sample_next);
    mem_free(r->samples.landing);
    mem_free(r->stale);
    mem_free(r->step);
}

// ---------------------------------------------------------------- what is given

static bool is_whole(const struct relume_mesh *m)
{
    if (!m->vertex_count || !m->triangle_count || !m->position || !m->normal || !m->triangle ||
        m->vertex_count >= NOTHING / 3 || m->triangle_count >= NOTHING / 3)
        return false;
    for (size_t i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            if (m->triangle[i][k] >= m->vertex_count)
                return false;
    for (size_t i = 0; i < m->vertex_count; i++)
        for (int k = 0; k < 3; k++)
            if (!isfinite(m->position[i][k]) || !isfinite(m->normal[i][k]))
                return false;
    return true;
}

static bool is_within(double value, double most)
{
    return value >= 0.0 && value <= most;
}

static bool are_sound(const struct relume_simplify_params *p)
{
    return is_within(p->error, 1.0) && is_within(p->jnd, 100.0) && is_within(p->distance, 1e6) &&
           p->gloss <= 1000.0 && is_within(p->white, 1e6) &&
           (p->error > 0.0 || p->triangles || p->jnd > 0.0);
}

// The middle and the diagonal of the mesh; false when it is a point or not finite.
static bool find_scale(struct simplify *s)
{
    vec3 min = vec3_of(INFINITY, INFINITY, INFINITY), max = vec3_scale(min, -1.0);
    for (size_t i = 0; i < s->mesh->vertex_count; i++) {
        const float *p = s->mesh->position[i];
        min = vec3_of(fmin(min.x, (double)p[0]), fmin(min.y, (double)p[1]),
                      fmin(min.z, (double)p[2]));
        max = vec3_of(fmax(max.x, (double)p[0]), fmax(max.y, (double)p[1]),
                      fmax(max.z, (double)p[2]));
    }
    const double diagonal = vec3_length(vec3_sub(max, min));
    s->middle = vec3_scale(vec3_add(min, max), 0.5);
    s->scale = 1.0 / diagonal;
    return diagonal > 0.0 && isfinite(diagonal);
}

// How long a unit of texture is on the surface, diagonals.
static double texture_length(const struct simplify *s)
{
    double area = 0.0, texels = 0.0;
    for (size_t i = 0; s->mesh->texture && i < s->mesh->triangle_count; i++) {
        const uint32_t *t = s->mesh->triangle[i];
        const vec3 a = place(s, t[0]), b = place(s, t[1]), c = place(s, t[2]);
        const float *u = s->mesh->texture[t[0]], *v = s->mesh->texture[t[1]],
                    *w = s->mesh->texture[t[2]];
        area += vec3_length(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
        texels += fabs(((double)v[0] - (double)u[0]) * ((double)w[1] - (double)u[1]) -
                       ((double)w[0] - (double)u[0]) * ((double)v[1] - (double)u[1]));
    }
    return texels > 0.0 && isfinite(texels) ? sqrt(area / texels) : 0.0;
}

static void set_weights(struct simplify *s)
{
    for (int k = 0; k < 3; k++)
        s->weight[s->values++] = VALUE_WEIGHT;
    for (int k = 0; s->mesh->texture && k < 2; k++)
        s->weight[s->values++] = s->slide;
    for (int k = 0; s->mesh->colour && k < 3; k++)
        s->weight[s->values++] = VALUE_WEIGHT;
}

// What a mesh takes while it becomes smaller, beside itself: an upper bound.
static size_t bytes_of(const struct simplify *s)
{
    const size_t v = s->mesh->vertex_count, t = s->mesh->triangle_count;
    return quadrics_bytes(s, v) + t * (12 + 12 + 4) +
           t * (NEAR_CELLS + NEAR_REFERENCES) * sizeof(uint32_t) +
           v * (4 + 4 + 4 + 4 + 4 + 12 + 1) + (size_t)sizeof(struct relume_simplify_step) * v;
}

static void set_limits(struct run *r, const struct relume_simplify_params *p)
{
    struct simplify *s = &r->s;
    s->seen_per_length = 1.0 / (2.0 * tan(0.5 * LEAST_ANGLE));
    const double screen = p->distance > 0.0 ? p->distance : 1.9;
    const bool endless = p->triangles && !(p->error > 0.0) && !(p->jnd > 0.0);
    r->most.length = p->error > 0.0 ? p->error : screen / s->seen_per_length;
    r->most.distance = p->distance > 0.0 ? p->distance : r->most.length * s->seen_per_length;
    // errors of shading count in lengths as they are seen from where somebody looks
    s->seen_per_length = r->most.distance / r->most.length;
    if (endless)
        r->most = (struct error){INFINITY, INFINITY};
    r->target = p->triangles;
}

static relume_status prepare(struct run *r, const struct relume_simplify_params *p)
{
    struct simplify *s = &r->s;
    s->tested = !p->quadrics;
    s->jnd = p->jnd > 0.0 ? p->jnd : USUAL_JND;
    s->white = p->white > 0.0 ? p->white : 200.0;
    s->slide = texture_length(s);
    set_weights(s);
    set_limits(r, p);
    relume_status status = limits_memory(NULL, bytes_of(s), "simplifying the mesh", p->log);
    if (!status)
        status = connect_create(&s->connect, s->mesh);
    if (!status)
        status = quadrics_create(s);
    if (!status && s->tested)
        status = samples_create(s);
    if (!status && s->tested && isfinite(r->most.length))
        status = near_create(&s->near, s, r->most.length);
    if (!status && s->tested)
        status = visible_create(&s->visible, s->jnd,
                                p->gloss > 0.0   ? p->gloss
                                : p->gloss < 0.0 ? 0.0
                                                 : 20.0,
                                s->white);
    if (!status)
        status = queue_create(&r->queue, s->connect.points);
    if (!status && !(r->stale = mem_zeroed(s->connect.points, sizeof *r->stale)))
        status = RELUME_ENOMEM;
    return status;
}

// ---------------------------------------------------------------- moves

struct choice {
    int neighbour;
    double cost;
};

// Neighbours that the point of r->fan may go to, the cheapest first, at most `room`.
static int find_choices(struct run *r, uint32_t point, struct choice *choice, int room)
{
    struct moves moves;
    int n = 0;
    for (int i = 0; i < r->fan.neighbours; i++) {
        if (!connect_is_target(&r->fan, i) ||
            !connect_moves(&r->s.connect, point, &r->fan, r->fan.neighbour[i], &moves))
            continue;
        const double cost = quadrics_error(&r->s, point, &moves);
        int at = n < room ? n++ : room;
        for (; at > 0 && cost < choice[at - 1].cost; at--)
            if (at < room)
                choice[at] = choice[at - 1];
        if (at < room)
            choice[at] = (struct choice){i, cost};
    }
    return n;
}

// Put a point where its cheapest move belongs; one that may not go is left out.
static void weigh(struct run *r, uint32_t point)
{
    struct choice cheapest;
    connect_fan(&r->s.connect, point, &r->fan);
    r->stale[point] = false;
    if (find_choices(r, point, &cheapest, 1) &&
        (r->s.tested || r->last_resort || cheapest.cost <= r->most.length))
        queue_put(&r->queue, point, cheapest.cost);
}

static void note_step(struct run *r, const struct moves *moves)
{
    for (int i = 0; r->keep_steps && i < moves->count; i++) {
        if (!mem_grow(&r->step, r->steps, sizeof *r->step)) {
            r->status = RELUME_ENOMEM;
            return;
        }
        r->step[r->steps++] = (struct relume_simplify_step){
            .vertex = moves->from[i],
            .onto = moves->to[i],
            .error = r->last_resort ? INFINITY : (float)r->done.length,
            .distance = (float)r->done.distance,
        };
    }
}

static void go(struct run *r, uint32_t point, uint32_t target, const struct moves *moves,
               struct error error)
{
    r->done.length = fmax(r->done.length, error.length);
    r->done.distance = fmax(r->done.distance, error.distance);
    samples_move(&r->s, &r->samples, &r->fan);
    quadrics_move(&r->s, point, target, moves);
    connect_move(&r->s.connect, point, &r->fan, target, moves);
    for (int i = 0; i < r->fan.neighbours; i++) {
        const uint32_t p = r->fan.neighbour[i];
        r->stale[p] = true;
        if (r->queue.at[p] == NOTHING)  // what could not go may now
            queue_put(&r->queue, p, r->queue.key[p]);
    }
    note_step(r, moves);
    r->moves++;
}

// Of a point whose key is up to date: go to the first neighbour that costs no more than the key, or
// wait until others cost as much.
static void try_point(struct run *r, uint32_t point)
{
    enum { CHOICES = 6 };
    struct choice choice[CHOICES];
    struct moves moves;
    double least = INFINITY;
    const double key = (double)r->queue.key[point], fine = FINE_SHARE * r->most.length;
    const double allowed = fmax(key * (1.0 + 1e-6), isfinite(fine) ? fine : 0.0);
    const int n = find_choices(r, point, choice, CHOICES);
    for (int i = 0; i < n; i++) {
        const uint32_t target = r->fan.neighbour[choice[i].neighbour];
        struct error error;
        if (!connect_may_move(&r->s.connect, point, &r->fan, choice[i].neighbour, &moves))
            continue;
        if (!samples_try(&r->s, &r->samples, &error, &r->fan, target, &moves, &r->most)) {
            r->status = RELUME_ENOMEM;
            return;
        }
        if (!(error.length < (double)INFINITY))  // a triangle would turn over, or leave the surface
            continue;
        if (r->last_resort)
            error.distance = r->done.distance;
        else if (error.length > r->most.length || error.distance > r->most.distance)
            continue;
        const double worst = fmax(error.length, error.distance / r->s.seen_per_length);
        if (!r->s.tested || worst <= allowed) {
            go(r, point, target, &moves, error);
            return;
        }
        least = fmin(least, worst);
    }
    if (least < (double)INFINITY)
        queue_put(&r->queue, point, least);
}

static bool is_done(const struct run *r)
{
    return r->status || !r->queue.count || r->s.connect.alive <= r->target;
}

static void weigh_all(struct run *r)
{
    for (uint32_t p = 0; p < r->s.connect.points && !r->status; p++)
        weigh(r, p);
}

// Until nothing may go any more.
static void run_down(struct run *r, const struct relume_log *log)
{
    const double from = (double)r->s.connect.alive;
    for (size_t i = 1; !is_done(r); i++) {
        if (i % PROGRESS_EVERY == 0 &&
            !log_progress(log, "simplify", 1.0 - (double)r->s.connect.alive / from))
            r->status = RELUME_ECANCEL;
        const uint32_t point = queue_take(&r->queue);
        if (r->stale[point]) {
            weigh(r, point);
            continue;
        }
        connect_fan(&r->s.connect, point, &r->fan);
        try_point(r, point);
    }
}

// ---------------------------------------------------------------- what is left

static void copy_vertex(struct relume_mesh *out, size_t to, const struct relume_mesh *m, size_t i)
{
    memcpy(out->position[to], m->position[i], sizeof *out->position);
    memcpy(out->normal[to], m->normal[i], sizeof *out->normal);
    if (out->texture)
        memcpy(out->texture[to], m->texture[i], sizeof *out->texture);
    if (out->colour)
        memcpy(out->colour[to], m->colour[i], sizeof *out->colour);
}

static relume_status copy_names(struct relume_mesh *out, const struct relume_mesh *m)
{
    out->picture = m->picture ? mem_text(m->picture) : NULL;
    if (m->picture && !out->picture)
        return RELUME_ENOMEM;
    if (!m->part_name || !m->parts)
        return RELUME_OK;
    if (!(out->part_name = mem_zeroed((size_t)m->parts, sizeof *out->part_name)))
        return RELUME_ENOMEM;
    out->parts = m->parts;
    for (int i = 0; i < m->parts; i++)
        if (!(out->part_name[i] = mem_text(m->part_name[i] ? m->part_name[i] : "")))
            return RELUME_ENOMEM;
    return RELUME_OK;
}

static size_t number_vertices(const struct connect *c, uint32_t *number)
{
    size_t n = 0;
    memset(number, 0xff, c->vertices * sizeof *number);
    for (size_t t = 0; t < c->triangles; t++)
        for (int k = 0; c->triangle[t][0] != NOTHING && k < 3; k++)
            number[c->triangle[t][k]] = 0;
    for (size_t i = 0; i < c->vertices; i++)
        if (!number[i])
            number[i] = (uint32_t)n++;
    return n;
}

static relume_status collect(struct relume_mesh *out, const struct run *r)
{
    const struct connect *c = &r->s.connect;
    const struct relume_mesh *m = r->s.mesh;
    uint32_t *number = mem_array(c->vertices, sizeof *number);
    if (!number)
        return RELUME_ENOMEM;
    const size_t vertices = number_vertices(c, number);
    out->position = mem_array(vertices, sizeof *out->position);
    out->normal = mem_array(vertices, sizeof *out->normal);
    out->texture = m->texture ? mem_array(vertices, sizeof *out->texture) : NULL;
    out->colour = m->colour ? mem_array(vertices, sizeof *out->colour) : NULL;
    out->triangle = mem_array(c->alive, sizeof *out->triangle);
    out->part = m->part ? mem_array(c->alive, sizeof *out->part) : NULL;
    const bool good = out->position && out->normal && out->triangle &&
                      (!m->texture || out->texture) && (!m->colour || out->colour) &&
                      (!m->part || out->part);
    for (size_t i = 0; good && i < c->vertices; i++)
        if (number[i] != NOTHING)
            copy_vertex(out, number[i], m, i);
    for (size_t t = 0; good && t < c->triangles; t++) {
        if (c->triangle[t][0] == NOTHING)
            continue;
        for (int k = 0; k < 3; k++)
            out->triangle[out->triangle_count][k] = number[c->triangle[t][k]];
        if (out->part)
            out->part[out->triangle_count] = m->part[t];
        out->triangle_count++;
    }
    out->vertex_count = good ? vertices : 0;
    mem_free(number);
    return good ? copy_names(out, m) : RELUME_ENOMEM;
}

relume_status relume_mesh_simplify(struct relume_mesh *out, struct relume_simplified *report,
                                   const struct relume_mesh *mesh,
                                   const struct relume_simplify_params *params)
{
    const struct relume_simplify_params p = PARAMS(relume_simplify_params, params);
    *out = (struct relume_mesh){0};
    if (report)
        *report = (struct relume_simplified){0};
    struct run *r = mem_zeroed(1, sizeof *r);
    if (!r)
        return RELUME_ENOMEM;
    r->s.mesh = mesh;
    r->keep_steps = report != NULL;
    r->status = are_sound(&p) && is_whole(mesh) && find_scale(&r->s) ? RELUME_OK : RELUME_EINVAL;
    if (!r->status)
        r->status = prepare(r, &p);
    if (!r->status && !r->s.connect.alive)
        r->status = log_fail(p.log, RELUME_EUNFIT, "the mesh has no triangle with an area");
    if (!r->status) {
        weigh_all(r);
        run_down(r, p.log);
    }
    if (!r->status && p.triangles > 0 && r->s.connect.alive > p.triangles && r->s.tested) {
        r->last_resort = true;
        r->s.tested = false;
        weigh_all(r);
        run_down(r, p.log);
    }
    if (!r->status)
        r->status = collect(out, r);
    if (!r->status && report) {
        *report = (struct relume_simplified){
            .triangles = out->triangle_count,
            .vertices = out->vertex_count,
            .error = r->last_resort || p.quadrics ? (double)INFINITY : r->done.length,
            .distance = r->last_resort ? (double)INFINITY : r->done.distance,
            .steps = r->steps,
            .step = r->step,
        };
        r->step = NULL;
    }
    const relume_status status = r->status;
    run_free(r);
    mem_free(r);
    if (status)
        relume_mesh_free(out);
    return status;
}
