// texels.c - a loop over texels on several cores: pictures lie apart in the file, so that a chunk
// of texels is gathered at once
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "material/btf/btf.h"

enum { CHUNK = 32, CHUNKS_AT_ONCE = 32 };

struct loop {
    const relume_btf *btf;
    size_t first_chunk, each;
    float **scratch;  // [worker]
    void *context;
    void (*body)(void *context, size_t texel, const float *values);
};

static void run_chunk(void *context, size_t item, int worker)
{
    const struct loop *p = context;
    const size_t first = (p->first_chunk + item) * CHUNK, texels = btf_texels(p->btf);
    const size_t n = texels - first < CHUNK ? texels - first : CHUNK;
    btf_gather(p->btf, first, n, p->scratch[worker]);
    for (size_t i = 0; i < n; i++)
        p->body(p->context, first + i, p->scratch[worker] + i * p->each);
}

static relume_status loop_texels(struct loop *p, int threads, const struct relume_log *log,
                                 const char *what)
{
    const size_t chunks = (btf_texels(p->btf) + CHUNK - 1) / CHUNK;
    for (; p->first_chunk < chunks; p->first_chunk += CHUNKS_AT_ONCE) {
        const size_t left = chunks - p->first_chunk;
        thread_for(threads, left < CHUNKS_AT_ONCE ? left : CHUNKS_AT_ONCE, run_chunk, p);
        const double done = (double)(p->first_chunk + CHUNKS_AT_ONCE) / (double)chunks;
        if (what && !log_progress(log, what, fmin(done, 1.0)))
            return RELUME_ECANCEL;
    }
    return RELUME_OK;
}

relume_status btf_for_texels(const relume_btf *btf, int threads, const struct relume_log *log,
                             const char *what, void *context,
                             void (*body)(void *context, size_t texel, const float *values))
{
    const int workers = thread_count(threads);
    struct loop p = {
        .btf = btf,
        .each = 3 * (size_t)btf->info.views * (size_t)btf->info.lights,
        .scratch = mem_zeroed((size_t)workers, sizeof *p.scratch),
        .context = context,
        .body = body,
    };
    relume_status status = p.scratch ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; i < workers && !status; i++)
        if (!(p.scratch[i] = mem_array(CHUNK * p.each, sizeof(float))))
            status = RELUME_ENOMEM;
    if (!status)
        status = loop_texels(&p, workers, log, what);
    for (int i = 0; p.scratch && i < workers; i++)
        mem_free(p.scratch[i]);
    mem_free(p.scratch);
    return status;
}
