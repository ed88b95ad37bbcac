// simplify_run.c - fewer triangles that look the same: the order in which vertices go
//
// The cheapest point by quadrics is tried first, towards each of its neighbours. What it would do
// is measured (simplify_samples.c); where that is worse than its key it waits under its true error
// (Guthe 2008, section 10.1). Points around a move are weighed again when their turn comes: they
// rarely become cheaper.
#include "shape/mesh/simplify_run.h"

#include "core/base/log.h"
#include "core/base/params.h"
#include "core/math/scalar.h"

#define PI 3.14159265358979323846
// An edge is seen to move when it moves by more than this angle.
#define LEAST_ANGLE (PI / 180.0 / 30.0)
// Of a value of 1 (a normal's component, white's), diagonals.
#define VALUE_WEIGHT 0.03
// Seen where one looks for it: at 1 few triangles of a scan could go.
#define USUAL_JND 4.0
// A pattern may lie beside where it was by this share of the most error for each JND: a 1200th of a
// degree, as finely as eyes tell whether lines meet (vernier acuity, about 5 seconds of arc).
#define SLIP_PER_JND 0.025
// Errors below this share of the most are as good as none.
#define FINE_SHARE 0.95
// Between looks at whether to stop.
enum { PROGRESS_EVERY = 16384, FIT_ROUNDS = 3 };

void run_free(struct run *r)
{
    struct simplify *s = &r->s;
    connect_free(&s->connect);
    queue_free(&r->queue);
    mem_free(s->quadric);
    mem_free(s->spread);
    mem_free(s->bend);
    mem_free(s->area);
    mem_free(s->shown);
    mem_free(s->spacing);
    near_free(&s->near);
    mem_free(s->sample_first);
    mem_free(s->sample_next);
    mem_free(r->samples.landing);
    mem_free(r->stale);
    mem_free(r->may);
    mem_free(r->stays);
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
           p->gloss <= 1000.0 && is_within(p->white, 1e6);
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

size_t run_bytes(const struct simplify *s, size_t v, size_t t)
{
    return quadrics_bytes(s, v, v) + t * (12 + 12 + 4) +
           t * (NEAR_CELLS + NEAR_REFERENCES) * sizeof(uint32_t) +
           v * (4 + 4 + 4 + 4 + 4 + 12 + 2 + 12 + 4) + sizeof(struct relume_simplify_step) * v;
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
    s->slip = endless ? 0.0 : SLIP_PER_JND * s->jnd * r->most.length;
    if (endless)
        r->most = (struct error){INFINITY, INFINITY};
    r->target = p->triangles;
}

relume_status run_settle(struct run *r, const struct relume_simplify_params *p)
{
    struct simplify *s = &r->s;
    const double gloss = p->gloss > 0.0 ? p->gloss : p->gloss < 0.0 ? 0.0 : 20.0;
    s->tested = !p->quadrics;
    s->jnd = p->jnd > 0.0 ? p->jnd : USUAL_JND;
    s->white = p->white > 0.0 ? p->white : 200.0;
    s->slide = texture_length(s);
    set_weights(s);
    set_limits(r, p);
    return s->tested ? visible_create(&s->visible, s->jnd, gloss, s->white) : RELUME_OK;
}

// Vertices that have gone before lie where they lay.
static relume_status take_piece(struct run *r)
{
    const struct piece *piece = r->piece;
    struct simplify *s = &r->s;
    r->may = mem_array(s->connect.points, sizeof *r->may);
    if (!r->may)
        return RELUME_ENOMEM;
    for (size_t v = 0; v < s->connect.vertices; v++)
        r->may[s->connect.point[v]] = piece->may[v];
    if (!(r->stays = mem_array(s->connect.points, sizeof *r->stays)))
        return RELUME_ENOMEM;
    for (uint32_t p = 0; p < s->connect.points; p++)
        r->stays[p] = r->may[p] == PIECE_STAYS;
    s->stays = r->stays;
    for (size_t i = 0; s->tested && i < piece->samples; i++) {
        const uint32_t vertex = piece->sample[2 * i], triangle = piece->sample[2 * i + 1];
        s->sample_next[vertex] = s->sample_first[triangle];
        s->sample_first[triangle] = vertex;
    }
    return RELUME_OK;
}

relume_status run_prepare(struct run *r)
{
    struct simplify *s = &r->s;
    const struct piece *piece = r->piece;
    relume_status status =
        piece ? connect_create(&s->connect, s->mesh, piece->triangle, piece->triangles, piece->part)
              : connect_create(&s->connect, s->mesh, s->mesh->triangle, s->mesh->triangle_count,
                               s->mesh->part);
    if (!status)
        status = quadrics_create(s);
    if (!status && s->tested)
        status = samples_create(s, piece ? piece->shown : NULL);
    if (!status && s->tested && isfinite(r->most.length))
        status = near_create(&s->near, s, r->most.length);
    if (!status)
        status = queue_create(&r->queue, s->connect.points);
    if (!status && !(r->stale = mem_zeroed(s->connect.points, sizeof *r->stale)))
        status = RELUME_ENOMEM;
    if (!status && piece)
        status = take_piece(r);
    return status;
}

static bool may_go(const struct run *r, uint32_t point)
{
    return !r->may || r->may[point] != PIECE_STAYS;
}

// ---------------------------------------------------------------- moves

struct choice {
    int neighbour;
    double cost;
};

// Neighbours that the point of r->fan may go to, the cheapest first, at most `most`.
static int find_choices(struct run *r, uint32_t point, struct choice *choice, int most)
{
    struct moves moves;
    int n = 0;
    for (int i = 0; i < r->fan.neighbours; i++) {
        if (!connect_is_target(&r->fan, i) ||
            !connect_moves(&r->s.connect, point, &r->fan, r->fan.neighbour[i], &moves))
            continue;
        const double cost = quadrics_error(&r->s, point, &moves);
        int at = n < most ? n++ : most;
        for (; at > 0 && cost < choice[at - 1].cost; at--)
            if (at < most)
                choice[at] = choice[at - 1];
        if (at < most)
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
        if (!may_go(r, p))
            continue;
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
    struct fan there;
    double least = INFINITY;
    const double key = (double)r->queue.key[point], fine = FINE_SHARE * r->most.length;
    const double allowed = fmax(key * (1.0 + 1e-6), isfinite(fine) ? fine : 0.0);
    const int n = find_choices(r, point, choice, CHOICES);
    for (int i = 0; i < n; i++) {
        const uint32_t target = r->fan.neighbour[choice[i].neighbour];
        struct error error;
        if (!connect_may_move(&r->s.connect, point, &r->fan, choice[i].neighbour, &moves, &there))
            continue;
        if (!samples_try(&r->s, &r->samples, &error, &r->fan, &there, target, &moves, &r->most)) {
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
        if (!r->may || r->may[p] == PIECE_WAITS)
            weigh(r, p);
}

// Normals of all that stays, each in turn: moves have done theirs alone.
static void refit(struct run *r)
{
    for (int round = 0; round < FIT_ROUNDS; round++)
        for (uint32_t p = 0; p < r->s.connect.points && !r->status; p++) {
            connect_fan(&r->s.connect, p, &r->fan);
            if (!r->fan.too_many && !samples_refit(&r->s, &r->samples, &r->fan, p))
                r->status = RELUME_ENOMEM;
        }
}

void run_down(struct run *r, const struct relume_log *log)
{
    const double from = (double)r->s.connect.alive;
    weigh_all(r);
    for (size_t i = 1; !is_done(r); i++) {
        const double done = 1.0 - (double)r->s.connect.alive / from;
        if (i % PROGRESS_EVERY == 0 &&
            !log_progress(log, "simplify", r->told[0] + done * (r->told[1] - r->told[0])))
            r->status = RELUME_ECANCEL;
        const uint32_t point = queue_take(&r->queue);
        if (r->stale[point]) {
            weigh(r, point);
            continue;
        }
        connect_fan(&r->s.connect, point, &r->fan);
        try_point(r, point);
    }
    if (!r->status && r->s.tested && r->s.fits)
        refit(r);
}

static relume_status run_whole(struct relume_mesh *out, struct run *r, const struct relume_log *log)
{
    r->status = run_prepare(r);
    if (!r->status && !r->s.connect.alive)
        r->status = log_fail(log, RELUME_EUNFIT, NO_AREA);
    if (!r->status)
        run_down(r, log);
    if (!r->status && r->s.connect.alive > r->target && r->target && r->s.tested) {
        r->last_resort = true;
        r->s.tested = false;
        run_down(r, log);
    }
    return r->status ? r->status : run_collect(out, &r->s.connect, r->s.mesh, r->s.shown);
}

// At once where memory is enough, else in parts.
static relume_status run_by_size(struct relume_mesh *out, struct run *r,
                                 const struct relume_simplify_params *p)
{
    const struct relume_mesh *m = r->s.mesh;
    const uint64_t most = limits_or_default(limits_of(NULL, p->log)).max_memory;
    const size_t memory = p->memory ? p->memory : (size_t)most;
    return run_bytes(&r->s, m->vertex_count, m->triangle_count) <= memory
               ? run_whole(out, r, p->log)
               : run_in_parts(out, r, memory, p->log);
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
    r->told[1] = 1.0;
    r->keep_steps = report && !p.no_steps;
    r->s.fits = !r->keep_steps;
    relume_status status =
        are_sound(&p) && is_whole(mesh) && find_scale(&r->s) ? RELUME_OK : RELUME_EINVAL;
    if (!status)
        status = run_settle(r, &p);
    if (!status)
        status = run_by_size(out, r, &p);
    if (!status && report) {
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
    run_free(r);
    mem_free(r);
    if (status)
        relume_mesh_free(out);
    return status;
}
