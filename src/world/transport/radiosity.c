// radiosity.c - instant radiosity (Keller 1997): the virtual lights of imperfect shadow maps, whose
// shadows are looked for by rays, which is what ordinary shadow maps come to as they grow
#include "world/transport/instant.h"

static relume_status begin(struct world *w, const struct relume_log *log)
{
    return instant_begin(w, &(struct instant_params){.pattern = INSTANT_PATTERN, .rays = true},
                         log);
}

const struct relume_transport transport_radiosity = {
    .name = "radiosity",
    .summary = "the same virtual lights, with exact shadows",
    .samples = INSTANT_SAMPLES,
    .pattern = INSTANT_PATTERN,
    .begin = begin,
    .end = instant_end,
    .gather = instant_gather,
};
