// isosurface.c - surfaces of a volume, as callers ask for them
#include "core/base/clock.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "shape/volume/cells.h"
#include "shape/volume/climb.h"

#include <math.h>
#include <string.h>

static int level_count(const int blocks[RELUME_ISOSURFACE_LEVELS])
{
    int n = 0;
    while (n < RELUME_ISOSURFACE_LEVELS && blocks[n])
        n++;
    return n;
}

static relume_status check(const int *blocks, int levels, const relume_volume *volume,
                           double threshold, const struct relume_log *log)
{
    for (int i = 0; i < levels; i++)
        if (blocks[i] < 1 || blocks[i] > 16 || blocks[i] & (blocks[i] - 1))
            return log_fail(log, RELUME_EINVAL, "blocks of %d samples; expected 1, 2, 4, 8 or 16",
                            blocks[i]);
    if (!isfinite(threshold) || fabs(threshold) > 1e38)
        return log_fail(log, RELUME_EINVAL, "a threshold of %g; expected one from -1e38 to 1e38",
                        threshold);
    const float t = (float)threshold;
    if (!(t > volume->min && t <= volume->max))
        log_line(log, RELUME_WARNING,
                 "the threshold %g gives no surface: values go from %g to %g, and %s reach it",
                 threshold, (double)volume->min, (double)volume->max,
                 t > volume->max ? "none" : "all");
    return RELUME_OK;
}

static relume_status mesh_level(struct relume_mesh *out, struct relume_isosurface_report *report,
                                const struct signs *g, int block)
{
    return block == 1 ? cells_mesh(out, report, g) : climb_mesh(out, report, g, block, true);
}

relume_status relume_isosurface(struct relume_mesh *out, struct relume_isosurface_report *report,
                                const relume_volume *volume, double threshold,
                                const struct relume_isosurface_params *params)
{
    const struct relume_isosurface_params p = PARAMS_WORK(relume_isosurface_params, params);
    const int blocks[RELUME_ISOSURFACE_LEVELS] = {p.blocks[0] ? p.blocks[0] : 1, p.blocks[1],
                                                  p.blocks[2], p.blocks[3], p.blocks[4]};
    const int levels = level_count(blocks);
    struct signs g = {.bits = NULL};
    double start = now_s();
    for (int i = 0; i < levels; i++)
        out[i] = (struct relume_mesh){0};
    relume_status status = check(blocks, levels, volume, threshold, p.log);
    if (!status)
        status = signs_create(&g, volume, (float)threshold, thread_count(p.threads));
    for (int i = 0; i < levels && !status; i++) {
        struct relume_isosurface_report own = {0};
        g.told = (struct thread_told){p.log, "surface", (double)i / levels, (i + 1.0) / levels};
        status = mesh_level(&out[i], &own, &g, blocks[i]);
        own.seconds = now_s() - start;
        start += own.seconds;
        if (report)
            report[i] = own;
    }
    signs_free(&g);
    if (status == RELUME_ELIMIT)
        log_line(p.log, RELUME_ERROR,
                 "the surface has 2^32 vertices or triangles, or more; expected fewer: take larger "
                 "blocks, or part of the volume");
    for (int i = 0; i < levels && status; i++)
        relume_mesh_free(&out[i]);
    return status;
}
