// acquire_target.c - the colour target of a capture: where it stands, and how good its colours
// become
#include "capture/acquire/acquire.h"

#include "capture/acquire/chart.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <string.h>

static const double GOOD = 2.0, USABLE = 4.0;  // mean CIEDE2000 after correction

static void describe(const struct acquisition *s)
{
    const struct relume_chart *c = &s->out->chart;
    log_line(s->p.log, RELUME_NOTE,
             "%s: colour target, %d of 24 patches: colour difference %.1f (largest %.1f) as "
             "photographed, %.1f (%.1f) with white balance, %.1f (%.1f) corrected: %s",
             s->out->target, c->used, c->before[0], c->before[1], c->balanced[0], c->balanced[1],
             c->after[0], c->after[1],
             c->after[0] < GOOD     ? "good"
             : c->after[0] < USABLE ? "usable"
                                    : "poor; is the target clean, evenly lit, without shine?");
}

relume_status acquire_read_target(struct acquisition *s)
{
    const struct relume_acquire_params *p = &s->p;
    double values[RELUME_CHART_PATCHES][3];
    if (!p->target)
        return RELUME_OK;
    const bool among = !strcmp(p->target, "auto");
    const char *const *paths = among ? (const char *const *)s->photographs.path : &p->target;
    relume_status status = p->target_values
                               ? relume_chart_reference_load(values, p->target_values, p->log)
                               : RELUME_OK;
    if (!status)
        status = relume_chart_load(
            &s->out->chart, paths, among ? s->photographs.count : 1,
            relume_chart_params(.log = p->log, .transfer = p->transfer, .corner = p->target_corner,
                                .reference = p->target_values ? (const double(*)[3])values : NULL));
    if (status)
        return status;
    s->out->target = mem_text(paths[s->out->chart.photograph]);
    if (!s->out->target)
        return RELUME_ENOMEM;
    describe(s);
    return RELUME_OK;
}
