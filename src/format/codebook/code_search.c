// code_search.c - the nearest code of every vector
#include "format/codebook/code_search.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <math.h>
#include <string.h>

enum { CHUNK = 3072 };

// Whether vector i keeps its code: no other has come near enough (Hamerly 2010). The margin is far
// above the rounding of double precision.
static bool keeps_code(struct code_search *s, size_t i)
{
    const size_t dim = (size_t)s->nearest->dim, code = s->index[i];
    const double drift = s->furthest[s->drift[code] == s->furthest[0]];
    const double apart = 0.999999 * ((double)s->apart[i] - drift);
    s->apart[i] = apart > 0.0 ? (float)apart : 0.0f;
    s->distance[i] = squared_distance(s->vectors + i * dim, s->codes + code * dim, dim);
    return sqrt(s->distance[i]) * (1.0 + 1e-6) < (double)s->apart[i];
}

static void search_chunk(void *context, size_t item, int worker)
{
    struct code_search *s = context;
    const size_t first = s->first + item * CHUNK;
    const size_t last = first + CHUNK < s->end ? first + CHUNK : s->end;
    uint16_t before[CHUNK];
    uint32_t which[CHUNK];
    size_t count = 0;
    memcpy(before, s->index + first, (last - first) * sizeof *before);
    for (size_t i = first; i < last; i++)
        if (!s->drift || !keeps_code(s, i))
            which[count++] = (uint32_t)i;
    nearest_find(s->nearest, s->vectors, which, count, s->index, s->distance, s->apart,
                 s->scratch + (size_t)worker * nearest_scratch(s->nearest));
    if (memcmp(before, s->index + first, (last - first) * sizeof *before))
        atomic_store(&s->changed, true);
}

// Whole chunks.
static relume_status begin_share(void *context, int member)
{
    struct code_search *s = context;
    const size_t members = (size_t)team_members(s->team), chunks = (s->n + CHUNK - 1) / CHUNK;
    const size_t first = chunks * (size_t)member / members * CHUNK;
    const size_t end = chunks * ((size_t)member + 1) / members * CHUNK;
    s->end = end < s->n ? end : s->n;
    s->first = first < s->end ? first : s->end;
    atomic_store(&s->changed, false);
    return RELUME_OK;
}

static relume_status search_share(void *context)
{
    struct code_search *s = context;
    thread_for(s->threads, (s->end - s->first + CHUNK - 1) / CHUNK, search_chunk, s);
    return RELUME_OK;
}

static relume_status add_share(void *context)
{
    struct code_search *s = context;
    s->any_changed |= atomic_load(&s->changed);
    return RELUME_OK;
}

relume_status code_search_find(struct code_search *s, int codes, int dim, int threads,
                               unsigned cpu_off, const struct relume_log *log)
{
    static const struct team_work work = {begin_share, search_share, add_share};
    struct nearest nearest;
    relume_status status = nearest_create(&nearest, codes, dim, cpu_off);
    if (status)
        return status;
    nearest_set(&nearest, s->codes);
    s->nearest = &nearest;
    s->threads = threads;
    s->any_changed = false;
    s->scratch =
        mem_array((size_t)thread_count(threads) * nearest_scratch(&nearest), sizeof(float));
    status = s->scratch ? team_share(s->team, "search", &work, s, &code_search_bytes, s, log)
                        : RELUME_ENOMEM;
    mem_free(s->scratch);
    nearest_destroy(&nearest);
    s->nearest = NULL;
    return status;
}
