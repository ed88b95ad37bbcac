// manifest_check.c - what is promised of a manifest, whether a file says it or a program
#include "capture/manifest/manifest.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/vec.h"
#include "image/geometry/geometry.h"

#include <stdio.h>

void draft_publish(struct draft *d)
{
    d->m.directions = d->directions;
    d->m.positions = d->positions;
    d->m.intensities = (const float(*)[3])d->intensities;
    d->m.view = d->view;
}

// ---------------------------------------------------------------- lights

static relume_status check_vectors(struct relume_vec3 *v, int n, bool unit, const char *path,
                                   const struct relume_log *log)
{
    char where[64];
    for (int i = 0; v && i < n; i++) {
        snprintf(where, sizeof where, "lights.%s[%d]", unit ? "directions" : "positions", i);
        if (!isfinite(vec3_length(v[i])))
            return log_wrong(log, path, where, "three finite numbers");
        if (!(vec3_length(v[i]) > 0.0) && !unit)
            return log_wrong(log, path, where,
                             "a place of a lamp; found 0, 0, 0, the middle of the scene");
        if (unit && !direction_normalise(&v[i]))
            return log_wrong(log, path, where, "a direction; found a zero vector");
    }
    return RELUME_OK;
}

relume_status draft_check_lights(struct draft *d, const char *path, const struct relume_log *log)
{
    relume_status status = check_vectors(d->positions, d->m.lights, false, path, log);
    if (!status && !d->directions) {
        d->directions = arena_array(&d->arena, (size_t)d->m.lights, sizeof *d->directions);
        for (int i = 0; d->directions && i < d->m.lights; i++)
            d->directions[i] = d->positions[i];
        status = d->directions ? RELUME_OK : RELUME_ENOMEM;
    }
    if (!status)
        status = check_vectors(d->directions, d->m.lights, true, path, log);
    for (int i = 0; !status && d->intensities && i < d->m.lights; i++)
        for (int c = 0; !status && c < 3; c++)
            // Pixels are divided by it in single precision.
            if (!(d->intensities[i][c] >= 1e-30f && d->intensities[i][c] <= 1e30f))
                status = log_wrong(log, path, "lights.intensities", MANIFEST_INTENSITIES);
    return status;
}

static double mean_square(const vec3 *position, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += vec3_dot(position[i], position[i]) / n;
    return sum;
}

// Factors to restate intensities by; false where all are 1.
static bool find_factors(float *factor, const struct draft *d, bool at_origin)
{
    const double square = mean_square(d->positions, d->m.lights);
    bool differ = false;
    for (int i = 0; i < d->m.lights; i++) {
        const double own = vec3_dot(d->positions[i], d->positions[i]);
        const double shown = square / fmax(own, 1e-6 * square);
        factor[i] = (float)(at_origin ? shown : 1.0 / shown);
        differ |= factor[i] != 1.0f;
    }
    return differ;
}

static relume_status restate(struct draft *d, bool at_origin)
{
    const size_t n = (size_t)d->m.lights;
    if (!d->positions || d->m.no_falloff || d->m.intensities_at_origin == at_origin)
        return RELUME_OK;
    const bool given = d->intensities;
    float *factor = mem_array(n, sizeof *factor);
    relume_status status = factor ? RELUME_OK : RELUME_ENOMEM;
    const bool differ = !status && find_factors(factor, d, at_origin);
    if (differ && !given && !(d->intensities = arena_array(&d->arena, n, sizeof *d->intensities)))
        status = RELUME_ENOMEM;
    for (size_t i = 0; differ && !status && i < n; i++)
        for (int c = 0; c < 3; c++)
            d->intensities[i][c] = (given ? d->intensities[i][c] : 1.0f) * factor[i];
    mem_free(factor);
    d->m.intensities_at_origin = at_origin;
    draft_publish(d);
    return status;
}

relume_status draft_state_power(struct draft *d)
{
    return restate(d, false);
}

relume_status draft_state_at_origin(struct draft *d)
{
    return restate(d, true);
}

// ---------------------------------------------------------------- geometry

static bool rises(const double min[2], const double max[2])
{
    return min[0] < max[0] && min[1] < max[1];
}

static relume_status check_slab(const struct relume_geometry *g, const char *path,
                                const struct relume_log *log)
{
    if (!rises(g->st_min, g->st_max))
        return log_wrong(log, path, "window", "min below max");
    return g->uv_z == g->st_z ? log_wrong(log, path, "slab", "two different planes") : RELUME_OK;
}

static relume_status check_slabs(struct draft *d, const char *path, const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    char where[48];
    for (int i = 0; !status && i < d->m.slabs; i++) {
        status = check_slab(&d->slab[i], path, log);
        snprintf(where, sizeof where, "slabs[%d].axes", i);
        if (!status && !relume_pose_normalise(&d->slab[i].pose))
            status = log_wrong(log, path, where,
                               "a rotation: unit vectors, perpendicular, right-handed");
    }
    d->m.slab = d->slab;
    d->m.geometry = d->slab[0];
    return status;
}

static relume_status check_panorama(const struct relume_geometry *g, const char *path,
                                    const struct relume_log *log)
{
    if (!(g->v_min < g->v_max))
        return log_wrong(log, path, "panorama", "v_min below v_max");
    if (g->disc && g->projection != RELUME_CYLINDRICAL)
        return log_wrong(log, path, "panorama.discs", "none but of a cylinder");
    if (g->disc && !(g->v_min < 0.0 && g->v_max > 0.0))
        return log_wrong(log, path, "panorama.discs", "v_min below 0 and v_max above it");
    return RELUME_OK;
}

relume_status draft_check_geometry(struct draft *d, const char *path, const struct relume_log *log)
{
    const struct relume_geometry *g = &d->m.geometry;
    if (d->m.slabs)
        return check_slabs(d, path, log);
    if (g->projection == RELUME_SLAB)
        return check_slab(g, path, log);
    if (!rises(g->window_min, g->window_max))
        return log_wrong(log, path, "window", "min below max");
    return check_panorama(g, path, log);
}

// ---------------------------------------------------------------- views

relume_status draft_check_views(const struct draft *d, const char *path,
                                const struct relume_log *log)
{
    bool seen[RELUME_MOST_SLABS] = {false};
    char where[48], expected[32];
    snprintf(expected, sizeof expected, "0 to %d", d->m.slabs - 1);
    for (int i = 0; d->m.slabs && i < d->m.views; i++) {
        const int slab = d->view[i].slab;
        snprintf(where, sizeof where, "views[%d].slab", i);
        if (slab < 0 || slab >= d->m.slabs)
            return log_wrong(log, path, where, expected);
        seen[slab] = true;
    }
    for (int i = 0; i < d->m.slabs; i++) {
        snprintf(where, sizeof where, "slabs[%d]", i);
        if (!seen[i])
            return log_wrong(log, path, where, "at least one view of every slab");
    }
    return RELUME_OK;
}
