// mirrors.c - where a bulging mirror shows positions, by a Bezier patch and by triangles
#include "cli/measure/bezier.h"
#include "cli/measure/reflections.h"
#include "cli/measure/triangle.h"
#include "core/base/clock.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/random.h"

static const vec3 eye = {0.4, -0.3, 3.0};

// A bulge of height 1/4 at its control points over the square from (-1, -1) to (1, 1).
static void make_bulge(struct bezier *out)
{
    vec3 control[4][4];
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++) {
            const bool inner = i % 3 && k % 3, corner = !(i % 3) && !(k % 3);
            control[i][k] = vec3_of((2 * i - 3) / 3.0, (2 * k - 3) / 3.0,
                                    inner    ? 0.25
                                    : corner ? 0.0
                                             : 0.125);
        }
    bezier_make(out, (const vec3(*)[4])control);
}

static vec3 position_of(int i)
{
    struct random r = random_stream(1, (uint64_t)i, 0);
    const double x = random_range(&r, -1.5, 1.5), y = random_range(&r, -1.5, 1.5);
    return vec3_of(x, y, random_range(&r, 1, 4));
}

// Returns the error of a reflection at `at` with the normal of (u, v): the distance between the
// unit vector to the position and the one of the law of reflection.
static double law_error(const struct bezier *b, double u, double v, vec3 at, vec3 position)
{
    struct bezier_point p;
    bezier_at(&p, b, u, v);
    const vec3 n = vec3_unit(vec3_cross(p.u, p.v)), in = vec3_unit(vec3_sub(eye, at));
    const vec3 out = vec3_sub(vec3_scale(n, 2.0 * vec3_dot(n, in)), in);
    return vec3_length(vec3_sub(out, vec3_unit(vec3_sub(position, at))));
}

// One of n x n x 2 triangles of the patch.
struct piece {
    double uv[3][2];
    vec3 corner[3], normal[3];
};

// The triangle that holds (u, v).
static void cut_piece(struct piece *out, const struct bezier *b, int n, double u, double v)
{
    const double x = floor(u * n), y = floor(v * n);
    const int upper = u * n - x + v * n - y > 1.0;
    const double uv[3][2] = {{x + upper, y + upper}, {x + 1, y}, {x, y + 1}};
    for (int k = 0; k < 3; k++) {
        struct bezier_point p;
        out->uv[k][0] = uv[k][0] / n;
        out->uv[k][1] = uv[k][1] / n;
        bezier_at(&p, b, out->uv[k][0], out->uv[k][1]);
        out->corner[k] = p.s;
        out->normal[k] = vec3_unit(vec3_cross(p.u, p.v));
    }
}

static double piece_error(const struct bezier *b, const struct piece *p,
                          const struct triangle_reflection *r, vec3 position)
{
    const double weight[3] = {1.0 - r->a - r->b, r->a, r->b};
    double u = 0.0, v = 0.0;
    vec3 at = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        u += weight[k] * p->uv[k][0];
        v += weight[k] * p->uv[k][1];
        at = vec3_along(at, p->corner[k], weight[k]);
    }
    return law_error(b, u, v, at, position);
}

// Positions, and what the methods find for them; [MIRROR_POSITIONS] each.
struct search {
    struct bezier mirror;
    vec3 *position;
    struct bezier_reflection *by_patch;
    struct piece *piece;
    struct triangle_reflection *by_piece;
    bool *found;
};

static struct mirror_result measure_patch(const struct search *s)
{
    struct mirror_result r = {0};
    const double start = processor_s();
    for (int i = 0; i < MIRROR_POSITIONS; i++)
        s->found[i] = bezier_reflect(&s->by_patch[i], &s->mirror, eye, s->position[i]);
    r.seconds = (processor_s() - start) / MIRROR_POSITIONS;
    for (int i = 0; i < MIRROR_POSITIONS; i++) {
        const struct bezier_reflection *f = &s->by_patch[i];
        if (!s->found[i])
            continue;
        r.found++;
        r.iterations += f->iterations;
        r.error = fmax(r.error, law_error(&s->mirror, f->u, f->v, f->place, s->position[i]));
    }
    r.iterations /= r.found > 0 ? r.found : 1;
    return r;
}

// The triangle is chosen by the patch's own answer; only finding within it is timed.
static struct mirror_result measure_triangles(const struct search *s, int n)
{
    struct mirror_result r = {.triangles = n};
    for (int i = 0; i < MIRROR_POSITIONS; i++)
        cut_piece(&s->piece[i], &s->mirror, n, s->by_patch[i].u, s->by_patch[i].v);
    const double start = processor_s();
    for (int i = 0; i < MIRROR_POSITIONS; i++) {
        struct mirror_triangle m;
        mirror_triangle_make(&m, s->piece[i].corner, s->piece[i].normal, eye);
        s->found[i] = mirror_triangle_reflect(&s->by_piece[i], &m, s->position[i]);
    }
    r.seconds = (processor_s() - start) / MIRROR_POSITIONS;
    for (int i = 0; i < MIRROR_POSITIONS; i++) {
        if (s->found[i])
            r.error = fmax(r.error,
                           piece_error(&s->mirror, &s->piece[i], &s->by_piece[i], s->position[i]));
        r.found += s->found[i];
    }
    return r;
}

static void free_search(struct search *s)
{
    mem_free(s->position);
    mem_free(s->by_patch);
    mem_free(s->piece);
    mem_free(s->by_piece);
    mem_free(s->found);
}

static relume_status begin_search(struct search *s)
{
    make_bulge(&s->mirror);
    s->position = mem_array(MIRROR_POSITIONS, sizeof *s->position);
    s->by_patch = mem_zeroed(MIRROR_POSITIONS, sizeof *s->by_patch);
    s->piece = mem_array(MIRROR_POSITIONS, sizeof *s->piece);
    s->by_piece = mem_array(MIRROR_POSITIONS, sizeof *s->by_piece);
    s->found = mem_array(MIRROR_POSITIONS, sizeof *s->found);
    if (!s->position || !s->by_patch || !s->piece || !s->by_piece || !s->found)
        return RELUME_ENOMEM;
    for (int i = 0; i < MIRROR_POSITIONS; i++)
        s->position[i] = position_of(i);
    return RELUME_OK;
}

relume_status measure_mirrors(struct mirror_result out[MIRROR_METHODS],
                              const struct relume_log *log)
{
    static const int sides[MIRROR_METHODS] = {0, 4, 16, 64};
    struct search s = {0};
    relume_status status = begin_search(&s);
    for (int i = 0; !status && i < MIRROR_METHODS; i++) {
        out[i] = sides[i] ? measure_triangles(&s, sides[i]) : measure_patch(&s);
        if (!log_progress(log, "mirrors", (i + 1.0) / MIRROR_METHODS))
            status = RELUME_ECANCEL;
    }
    free_search(&s);
    return status;
}
