// ism.c - virtual lights with imperfect shadow maps (Ritschel, Grosch, Kim, Seidel, Dachsbacher,
// Kautz 2008, "Imperfect shadow maps for efficient computation of indirect illumination")
#include "world/transport/instant.h"

static relume_status begin(struct world *w, const struct relume_log *log)
{
    return instant_begin(w, &(struct instant_params){.pattern = INSTANT_PATTERN}, log);
}

const struct relume_transport transport_ism = {
    .name = "ism",
    .summary = "many virtual lights, each with a small shadow map drawn from points",
    .samples = INSTANT_SAMPLES,
    .pattern = INSTANT_PATTERN,
    .gl_version = 43,
    .begin = begin,
    .end = instant_end,
    .gather = instant_gather,
};
