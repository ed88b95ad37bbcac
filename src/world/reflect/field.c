// field.c - edits of reflections: what is asked for is checked, gathered by regions, and measured
// along the surface
#include "world/reflect/field.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "world/reflect/geodesic.h"
#include "world/reflect/reflection.h"

#include <string.h>

// Of the size of the surface: no distance to a constraint is taken to be less.
static const double LEAST = 1e-3;

void relume_reflection_destroy(relume_reflection **reflection)
{
    relume_reflection *f = *reflection;
    *reflection = NULL;
    if (!f)
        return;
    for (int i = 0; f->region && i < f->edit.regions; i++)
        mem_free((void *)f->region[i].stroke);
    for (int i = 0; f->gathered && i < gathered_count(f); i++)
        mem_free(f->gathered[i].member);
    for (int i = 0; f->along && i < f->edit.constraints; i++)
        mem_free(f->along[i]);
    for (int i = 0; f->region_along && i < f->edit.regions; i++)
        mem_free(f->region_along[i]);
    mem_free(f->along);
    mem_free(f->region_along);
    mem_free(f->gathered);
    mem_free(f->constraint);
    mem_free(f->region);
    mem_free(f);
}

const struct relume_reflection_edit *relume_reflection_edit(const relume_reflection *reflection)
{
    return &reflection->edit;
}

struct relume_reflection_set relume_reflection_set_of(double *least, const relume_reflection *f,
                                                      int region)
{
    *least = f->least;
    return (struct relume_reflection_set){f->gathered[region].member, f->gathered[region].members};
}

bool relume_reflection_acts(const relume_reflection *f, int constraint)
{
    for (int i = 0; i < gathered_count(f); i++)
        for (int k = 0; k < f->gathered[i].members; k++)
            if (f->gathered[i].member[k] == constraint)
                return true;
    return false;
}

const float *relume_reflection_from_constraint(const relume_reflection *f, int constraint)
{
    return f->along ? f->along[constraint] : NULL;
}

const float *relume_reflection_from_region(const relume_reflection *f, int region)
{
    return f->region_along ? f->region_along[region] : NULL;
}

double relume_reflection_edge(const relume_reflection *f)
{
    return f->edge;
}

// ---------------------------------------------------------------- what is asked for

struct asking {
    const struct relume_log *log;
    const char *name;
};

static const double FARTHEST = 1e15;  // graphics cards add up its square in single precision

static bool is_within(vec3 v)
{
    return fabs(v.x) <= FARTHEST && fabs(v.y) <= FARTHEST && fabs(v.z) <= FARTHEST;
}

static bool has_direction(vec3 v)
{
    return vec3_length(v) > 0.0 && isfinite(vec3_length(v));
}

static relume_status check_constraint(const struct relume_log *log,
                                      const struct relume_reflection_constraint *c)
{
    if (!is_within(c->position) || !is_within(c->eye))
        return log_fail(log, RELUME_EINVAL, "position and eye: expected numbers up to %g",
                        FARTHEST);
    if (!has_direction(c->original) || !has_direction(c->edited))
        return log_fail(log, RELUME_EINVAL,
                        "original and edited direction: expected finite numbers, not all 0");
    return RELUME_OK;
}

static relume_status check_region(const struct relume_log *log,
                                  const struct relume_reflection_region *r)
{
    if (!(r->radius > 0.0 && r->radius <= FARTHEST))
        return log_fail(log, RELUME_EINVAL, "radius: expected a number above 0, up to %g; found %g",
                        FARTHEST, r->radius);
    if (!(r->border >= 0.0 && r->border <= FARTHEST))
        return log_fail(log, RELUME_EINVAL, "border: expected 0 to %g; found %g", FARTHEST,
                        r->border);
    if (!is_within(r->centre))
        return log_fail(log, RELUME_EINVAL, "centre: expected numbers up to %g", FARTHEST);
    if (r->shape == RELUME_REFLECTION_STROKES && r->points < 1)
        return log_fail(log, RELUME_EINVAL, "stroke: expected at least one point");
    for (int i = 0; r->shape == RELUME_REFLECTION_STROKES && i < r->points; i++)
        if (!is_within(r->stroke[i]))
            return log_fail(log, RELUME_EINVAL, "stroke: expected numbers up to %g", FARTHEST);
    return RELUME_OK;
}

static relume_status check(const struct asking *a, const struct relume_reflection_edit *e)
{
    struct log_place place;
    relume_status status = RELUME_OK;
    if (e->constraints < 0 || e->constraints > RELUME_REFLECTION_CONSTRAINTS_MOST)
        return log_fail(a->log, RELUME_EINVAL, "%s: expected at most %d constraints; found %d",
                        a->name, RELUME_REFLECTION_CONSTRAINTS_MOST, e->constraints);
    if (e->regions < 0 || e->regions > RELUME_REFLECTION_REGIONS_MOST)
        return log_fail(a->log, RELUME_EINVAL, "%s: expected at most %d regions; found %d", a->name,
                        RELUME_REFLECTION_REGIONS_MOST, e->regions);
    if (e->frozen && !is_within(e->eye))
        return log_fail(a->log, RELUME_EINVAL, "%s: frozen: expected an eye of numbers up to %g",
                        a->name, FARTHEST);
    for (int i = 0; i < e->constraints && !status; i++)
        status = check_constraint(log_at(&place, a->log, "%s: constraint %d: ", a->name, i),
                                  &e->constraint[i]);
    for (int i = 0; i < e->regions && !status; i++)
        status = check_region(log_at(&place, a->log, "%s: region %d: ", a->name, i), &e->region[i]);
    return status;
}

// ---------------------------------------------------------------- copies

static relume_status copy_edit(relume_reflection *f, const struct relume_reflection_edit *e)
{
    f->edit = *e;
    f->edit.regions = 0;  // of as many there are copies to free
    f->constraint = mem_array((size_t)e->constraints, sizeof *f->constraint);
    f->region = mem_zeroed((size_t)e->regions, sizeof *f->region);
    if (!f->constraint || !f->region)
        return RELUME_ENOMEM;
    for (int i = 0; i < e->constraints; i++) {
        f->constraint[i] = e->constraint[i];
        f->constraint[i].original = vec3_unit(e->constraint[i].original);
        f->constraint[i].edited = vec3_unit(e->constraint[i].edited);
    }
    for (; f->edit.regions < e->regions; f->edit.regions++) {
        struct relume_reflection_region *to = &f->region[f->edit.regions];
        *to = e->region[f->edit.regions];
        const bool strokes = to->shape == RELUME_REFLECTION_STROKES;
        to->points = strokes ? to->points : 0;
        to->stroke = strokes ? mem_copy(to->stroke, (size_t)to->points, sizeof *to->stroke) : NULL;
        if (strokes && !to->stroke)
            return RELUME_ENOMEM;
    }
    f->edit.constraint = f->constraint;
    f->edit.region = f->region;
    return RELUME_OK;
}

static void extend(vec3 *min, vec3 *max, vec3 p, double by)
{
    *min = vec3_of(fmin(min->x, p.x - by), fmin(min->y, p.y - by), fmin(min->z, p.z - by));
    *max = vec3_of(fmax(max->x, p.x + by), fmax(max->y, p.y + by), fmax(max->z, p.z + by));
}

// Of the surface; without one, of what the edit names.
static double size_of(const relume_reflection *f, const struct relume_reflection_surface *s)
{
    vec3 min = vec3_of(INFINITY, INFINITY, INFINITY), max = vec3_scale(min, -1.0);
    for (size_t i = 0; s && i < 3 * s->triangles; i++) {
        float p[3];
        memcpy(p, (const char *)s->position + s->triangle[i / 3][i % 3] * s->stride, sizeof p);
        extend(&min, &max, vec3_of((double)p[0], (double)p[1], (double)p[2]), 0.0);
    }
    for (int i = 0; !s && i < f->edit.constraints; i++)
        extend(&min, &max, f->constraint[i].position, 0.0);
    for (int i = 0; !s && i < f->edit.regions; i++)
        extend(&min, &max, f->region[i].centre, f->region[i].radius);
    const double size = vec3_length(vec3_sub(max, min));
    return size > 0.0 && isfinite(size) ? size : 1.0;
}

// ---------------------------------------------------------------- along the surface

struct measuring {
    relume_reflection *f;
    const struct geodesic_mesh *mesh;
    relume_status *status;          // [items]
    const relume_reflection *like;  // relume_reflection_params
};

static bool same_place(vec3 a, vec3 b)
{
    return !memcmp(&a, &b, sizeof a);
}

// Distances from there that are known already, else NULL.
static const float *find_measured(const relume_reflection *like, size_t vertices, vec3 origin)
{
    if (!like || like->vertices != vertices)
        return NULL;
    for (int i = 0; i < like->edit.constraints; i++)
        if (like->along[i] && same_place(like->constraint[i].position, origin))
            return like->along[i];
    for (int i = 0; i < like->edit.regions; i++)
        if (like->region_along[i] && same_place(like->region[i].centre, origin))
            return like->region_along[i];
    return NULL;
}

static relume_status measure_from(float *distance, const struct measuring *m, vec3 origin)
{
    const float *known = find_measured(m->like, m->mesh->given, origin);
    if (!known)
        return geodesic_distances(distance, m->mesh, origin);
    memcpy(distance, known, m->mesh->given * sizeof *distance);
    return RELUME_OK;
}

// Item i is a constraint or, after these, a region.
static void measure(void *context, size_t item, int worker)
{
    (void)worker;
    const struct measuring *m = context;
    relume_reflection *f = m->f;
    const size_t constraints = (size_t)f->edit.constraints;
    const bool of_region = item >= constraints;
    const struct relume_reflection_region *region =
        of_region ? &f->region[item - constraints] : NULL;
    if (region ? region->shape != RELUME_REFLECTION_GEODESIC : !f->edit.geodesic)
        return;
    float *distance = mem_array(m->mesh->given, sizeof *distance);
    m->status[item] =
        distance ? measure_from(distance, m, region ? region->centre : f->constraint[item].position)
                 : RELUME_ENOMEM;
    *(region ? &f->region_along[item - constraints] : &f->along[item]) = distance;
}

static bool needs_surface(const relume_reflection *f)
{
    bool needs = f->edit.geodesic;
    for (int i = 0; i < f->edit.regions; i++)
        needs |= f->region[i].shape == RELUME_REFLECTION_GEODESIC;
    return needs;
}

static relume_status measure_all(relume_reflection *f, const struct geodesic_mesh *mesh,
                                 const relume_reflection *like, int threads)
{
    const size_t items = (size_t)f->edit.constraints + (size_t)f->edit.regions;
    struct measuring m = {f, mesh, mem_zeroed(items, sizeof *m.status), like};
    f->along = mem_zeroed((size_t)f->edit.constraints, sizeof *f->along);
    f->region_along = mem_zeroed((size_t)f->edit.regions, sizeof *f->region_along);
    relume_status status = m.status && f->along && f->region_along ? RELUME_OK : RELUME_ENOMEM;
    f->edge = mesh->edge;
    f->vertices = mesh->given;
    if (!status)
        thread_for(threads, items, measure, &m);
    for (size_t i = 0; i < items && !status; i++)
        status = m.status[i];
    mem_free(m.status);
    return status;
}

// ---------------------------------------------------------------- what counts where

// A constraint counts where its place, and along the surface the nearest one on that, has a weight.
static void count_in(relume_reflection *f, const struct geodesic_mesh *mesh, int constraint)
{
    const struct relume_reflection_place at = {.position = f->constraint[constraint].position};
    struct relume_reflection_place on;
    bool located = false, tried = false;
    for (int i = 0; i < gathered_count(f); i++) {
        struct gathered *g = &f->gathered[i];
        const bool along = f->edit.regions && f->region[i].shape == RELUME_REFLECTION_GEODESIC;
        if (along && !tried)
            located = geodesic_locate(&on, mesh, at.position);
        tried |= along;
        if (!f->edit.regions ||
            ((!along || located) && relume_reflection_weight(f, i, along ? &on : &at) > 0.0))
            g->member[g->members++] = constraint;
    }
}

static relume_status gather(relume_reflection *f, const struct geodesic_mesh *mesh)
{
    f->gathered = mem_zeroed((size_t)gathered_count(f), sizeof *f->gathered);
    if (!f->gathered)
        return RELUME_ENOMEM;
    for (int i = 0; i < gathered_count(f); i++) {
        f->gathered[i].member = mem_array((size_t)f->edit.constraints, sizeof(int));
        if (!f->gathered[i].member)
            return RELUME_ENOMEM;
    }
    for (int k = 0; k < f->edit.constraints; k++)
        count_in(f, mesh, k);
    for (int i = 0; i < gathered_count(f); i++) {
        struct gathered *g = &f->gathered[i];
        if (g->members == 1)
            g->only = rotation_least(f->constraint[g->member[0]].original,
                                     f->constraint[g->member[0]].edited);
    }
    return RELUME_OK;
}

static bool contradict(const relume_reflection *f, int i, int k)
{
    const double ALIKE = 1e-3, OTHER = 1e-2;  // radians
    const struct relume_reflection_constraint *a = &f->constraint[i], *b = &f->constraint[k];
    return vec3_length(vec3_sub(a->position, b->position)) < f->least &&
           vec3_angle(a->original, b->original) < ALIKE && vec3_angle(a->edited, b->edited) > OTHER;
}

static void warn(const relume_reflection *f, const struct asking *a)
{
    for (int i = 0; i < f->edit.constraints; i++)
        if (!relume_reflection_acts(f, i))
            log_line(a->log, RELUME_WARNING,
                     "%s: constraint %d lies outside every region and has no effect; move it or "
                     "enlarge a region",
                     a->name, i);
    for (int i = 0; i < f->edit.constraints; i++)
        for (int k = 0; k < i; k++)
            if (contradict(f, i, k)) {
                log_line(a->log, RELUME_WARNING,
                         "%s: constraints %d and %d are in one place and want different "
                         "reflections; their mean is shown",
                         a->name, k, i);
                break;
            }
}

relume_status relume_reflection_create(relume_reflection **out,
                                       const struct relume_reflection_edit *edit,
                                       const struct relume_reflection_surface *surface,
                                       const struct relume_reflection_params *params)
{
    const struct relume_reflection_params own = PARAMS_WORK(relume_reflection_params, params);
    const struct asking asking = {own.log, own.name ? own.name : "reflections"};
    struct geodesic_mesh mesh = {0};
    *out = NULL;
    relume_status status = check(&asking, edit);
    for (size_t i = 0; surface && i < 3 * surface->triangles && !status; i++)
        if (surface->triangle[i / 3][i % 3] >= surface->vertices)
            status = log_fail(own.log, RELUME_EINVAL,
                              "%s: a triangle of the mesh names vertex %u of %zu", asking.name,
                              (unsigned)surface->triangle[i / 3][i % 3], surface->vertices);
    if (status)
        return status;
    relume_reflection *f = mem_zeroed(1, sizeof *f);
    status = f ? copy_edit(f, edit) : RELUME_ENOMEM;
    if (!status && needs_surface(f)) {
        status = surface && surface->triangles
                     ? geodesic_mesh_create(&mesh, surface)
                     : log_fail(own.log, RELUME_EINVAL,
                                "%s: distances along the surface need a mesh", asking.name);
        if (!status)
            status = measure_all(f, &mesh, own.like, own.threads);
    }
    if (!status) {
        f->least = LEAST * size_of(f, surface);
        status = gather(f, &mesh);
    }
    geodesic_mesh_free(&mesh);
    if (status)
        relume_reflection_destroy(&f);
    else
        warn(f, &asking);
    *out = f;
    return status;
}
