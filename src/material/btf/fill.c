// fill.c - all pictures of a BTF, view by view on all cores
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "material/btf/btf.h"
#include "material/btf/values.h"

#include <stdatomic.h>

struct filling {
    relume_btf *btf;
    const void *context;
    void (*picture)(const void *context, int view, int light, float *rgb);
    atomic_bool failed;
};

static void fill_view(void *context, size_t view, int worker)
{
    (void)worker;
    struct filling *f = context;
    float *rgb = mem_array(3 * btf_texels(f->btf), sizeof *rgb);
    for (int l = 0; rgb && l < f->btf->info.lights; l++) {
        f->picture(f->context, (int)view, l, rgb);
        relume_btf_store(f->btf, (int)view, l, rgb);
    }
    if (!rgb)
        f->failed = true;
    mem_free(rgb);
}

relume_status btf_fill(relume_btf *btf, int threads, const void *context,
                       void (*picture)(const void *context, int view, int light, float *rgb))
{
    struct filling f = {btf, context, picture, false};
    thread_for(threads, (size_t)btf->info.views, fill_view, &f);
    return f.failed ? RELUME_ENOMEM : RELUME_OK;
}
