// expand.c - a model back to values
#include "base/log.h"
#include "base/memory.h"
#include "base/params.h"
#include "base/thread.h"
#include "btf_model/model.h"

#include <stdatomic.h>

struct expanding {
    const relume_btf_fitted *m;
    relume_btf *to;
    atomic_bool failed;
};

static void expand_view(void *context, size_t view, int worker)
{
    (void)worker;
    struct expanding *e = context;
    const relume_btf_fitted *m = e->m;
    float *rgb = mem_array(3 * m->texels, sizeof *rgb);
    struct model_blend at = {.view = relume_direction_mesh_at(m->view_mesh, m->view[view]),
                             .v = m->view[view]};
    for (int l = 0; rgb && l < m->lights; l++) {
        at.light = relume_direction_mesh_at(m->light_mesh, m->light[l]);
        at.l = m->light[l];
        for (size_t i = 0; i < m->texels; i++)
            model_blend(m, i, &at, rgb + 3 * i);
        relume_btf_store(e->to, (int)view, l, rgb);
    }
    if (!rgb)
        e->failed = true;
    mem_free(rgb);
}

relume_status relume_btf_expand(relume_btf **out, const relume_btf_fitted *m,
                                const struct relume_btf_params *params)
{
    const struct relume_btf_params p = PARAMS_WORK(relume_btf_params, params);
    struct relume_btf_info info = {.name = m->model->name,
                                   .width = m->width,
                                   .height = m->height,
                                   .views = m->views,
                                   .lights = m->lights,
                                   .view = m->view,
                                   .light = m->light};
    relume_status status =
        m->model->truth ? m->model->truth(m, &info.relief, &info.normals) : RELUME_OK;
    *out = NULL;
    if (!status)
        status = relume_btf_create(out, &info, &p);
    relume_image_destroy(&info.relief);
    relume_image_destroy(&info.normals);
    if (status)
        return status;
    struct expanding e = {m, *out, false};
    thread_for(p.threads, (size_t)m->views, expand_view, &e);
    if (e.failed)
        relume_btf_destroy(out);
    return e.failed ? RELUME_ENOMEM : RELUME_OK;
}
