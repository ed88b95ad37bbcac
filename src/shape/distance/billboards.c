// billboards.c - a mesh becomes a cloud of billboards
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "shape/distance/texels.h"

#include <math.h>
#include <string.h>

static const size_t MOST_TRIANGLES = (size_t)4 << 20, MOST_TEXELS = (size_t)64 << 20;

void relume_billboards_free(struct relume_billboards *cloud)
{
    mem_free(cloud->billboard);
    mem_free(cloud->texel);
    mem_free(cloud->owner);
    *cloud = (struct relume_billboards){.count = 0};
}

relume_status partition_create(struct partition *out, const struct soup *s)
{
    *out = (struct partition){.next = mem_array(s->count, sizeof *out->next)};
    return out->next ? RELUME_OK : RELUME_ENOMEM;
}

void partition_free(struct partition *p)
{
    mem_free(p->plane);
    mem_free(p->head);
    mem_free(p->next);
}

// ---------------------------------------------------------------- parameters

static struct relume_billboards_params defaults(const struct relume_billboards_params *params)
{
    struct relume_billboards_params p = PARAMS(relume_billboards_params, params);
    p.error = p.error == 0.0 && !p.count ? 0.01 : p.error;
    p.angle_deg = p.angle_deg == 0.0 ? 60.0 : p.angle_deg;
    p.waste = p.waste == 0.0 ? 0.75 : p.waste;
    p.neighbours = p.neighbours ? p.neighbours : 32;
    return p;
}

static relume_status check(const struct relume_billboards_params *p)
{
    const bool greedy = p->method == RELUME_BILLBOARDS_GREEDY;
    if (!(p->error >= 0.0 && p->error <= 1.0) || p->count < 0 || (greedy && p->error == 0.0))
        return log_fail(p->log, RELUME_EINVAL,
                        "billboards: expected an error above 0 and at most 1, or for clusters a "
                        "number of billboards");
    if (!(p->texel >= 0.0 && p->texel <= 1.0) || !(p->angle_deg > 0.0 && p->angle_deg <= 90.0) ||
        !(p->waste > 0.0 && p->waste <= 1.0) || p->neighbours < 1 || p->neighbours > 256)
        return log_fail(p->log, RELUME_EINVAL,
                        "billboards: expected texels and waste above 0 and at most 1, angles up to "
                        "90 degrees, 1 to 256 neighbours");
    return RELUME_OK;
}

// ---------------------------------------------------------------- the cloud

// What is made on the way.
struct billboards_build {
    const struct relume_billboards_params *p;
    struct soup soup;
    struct partition partition;
    uint32_t *owner;  // [triangles of the soup]
    float *shown;
    double error;  // a length; infinite: none is asked for
};

static relume_status find_planes(struct billboards_build *w)
{
    const struct relume_billboards_params *p = w->p;
    // what is asked for may be less than positions of floats hold
    w->error = p->error > 0.0 ? fmax(p->error, 1e-6) * w->soup.longest : INFINITY;
    const relume_status status = partition_create(&w->partition, &w->soup);
    if (status)
        return status;
    return p->method == RELUME_BILLBOARDS_GREEDY
               ? greedy_planes(&w->partition, &w->soup, w->error, p->log)
               : cluster_planes(&w->partition, &w->soup, w->error, p);
}

static relume_status lay(struct relume_billboards *out, struct billboards_build *w)
{
    const struct partition *p = &w->partition;
    vec3 *scratch = mem_array(6 * w->soup.count + 4, sizeof *scratch);
    out->billboard = mem_array(p->count, sizeof *out->billboard);
    w->owner = mem_array(w->soup.count, sizeof *w->owner);
    const bool good = scratch && out->billboard && w->owner;
    for (size_t i = 0; good && i < p->count; i++) {
        texels_lay(&out->billboard[i], &w->soup, p, i, scratch);
        out->error = fmaxf(out->error, out->billboard[i].error);
        for (uint32_t t = p->head[i]; t != NOBODY; t = p->next[t])
            w->owner[t] = (uint32_t)i;
    }
    mem_free(scratch);
    out->count = good ? p->count : 0;
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// By the error that was asked for, else by what came of it; no finer than pictures need be.
static double texel_side(const struct relume_billboards *cloud, const struct billboards_build *w)
{
    const double longest = w->soup.longest, FINEST = 1.0 / 512.0;
    if (w->p->texel > 0.0)
        return w->p->texel * longest;
    return isfinite(w->error) ? 0.5 * w->error : fmax(0.5 * (double)cloud->error, FINEST * longest);
}

static relume_status size(struct relume_billboards *out, struct billboards_build *w)
{
    size_t largest = 0;
    out->side = (float)texel_side(out, w);
    for (size_t i = 0; i < out->count; i++) {
        struct relume_billboard *const b = &out->billboard[i];
        if (!texels_size(b, (double)out->side, MOST_TEXELS - out->texels))
            return log_fail(w->p->log, RELUME_ELIMIT,
                            "billboards: more than %zu million texels of a side of %.3g; expected "
                            "larger texels, or a larger error",
                            MOST_TEXELS >> 20, (double)out->side);
        const size_t texels = (size_t)b->width * (size_t)b->height;
        b->first = out->texels;
        out->texels += texels;
        largest = texels > largest ? texels : largest;
    }
    out->texel = mem_array(out->texels, sizeof *out->texel);
    w->shown = mem_array(2 * largest, sizeof *w->shown);
    return out->texel && w->shown ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status fill(struct relume_billboards *out, const struct billboards_build *w,
                          size_t triangle_count)
{
    const struct filling f = {
        .error = isfinite(w->error) ? w->error : (double)out->error,
        .least_cosine = cos(w->p->angle_deg * M_PI / 180.0),
        .owner = w->owner,
        .shown = w->shown,
    };
    out->owner = mem_array(triangle_count, sizeof *out->owner);
    if (!out->owner)
        return RELUME_ENOMEM;
    memset(out->owner, 0xff, triangle_count * sizeof *out->owner);
    for (size_t i = 0; i < out->count; i++) {
        texels_fill(out, i, &w->soup, &w->partition, &f);
        if (!log_progress(w->p->log, "texels", (i + 1.0) / (double)out->count))
            return RELUME_ECANCEL;
    }
    return RELUME_OK;
}

relume_status relume_billboards_create(struct relume_billboards *out,
                                       const struct relume_mesh *mesh,
                                       const struct relume_billboards_params *params)
{
    const struct relume_billboards_params p = defaults(params);
    struct billboards_build w = {.p = &p};
    *out = (struct relume_billboards){.count = 0};
    relume_status status = check(&p);
    if (!status && mesh->triangle_count > MOST_TRIANGLES)
        status = log_fail(p.log, RELUME_ELIMIT,
                          "billboards: a mesh of %zu triangles; expected at most %zu; make it "
                          "smaller first",
                          mesh->triangle_count, MOST_TRIANGLES);
    if (!status)
        status = soup_create(&w.soup, mesh, p.log);
    if (!status)
        status = find_planes(&w);
    if (!status)
        status = lay(out, &w);
    if (!status)
        status = size(out, &w);
    if (!status)
        status = fill(out, &w, mesh->triangle_count);
    if (!status && p.count && out->count > (size_t)p.count)
        log_line(
            p.log, RELUME_WARNING,
            "%zu billboards, more than the %d asked for: fewer would be tilted by more than %g "
            "degrees against what they show, or be emptier than %g %% (--angle, --waste)",
            out->count, p.count, p.angle_deg, 100.0 * p.waste);
    if (status)
        relume_billboards_free(out);
    soup_free(&w.soup);
    partition_free(&w.partition);
    mem_free(w.owner);
    mem_free(w.shown);
    return status;
}
