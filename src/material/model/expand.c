// expand.c - a model back to values
#include "core/base/params.h"
#include "material/btf/values.h"
#include "material/model/model.h"

static void show(const void *context, int view, int light, float *rgb)
{
    const relume_btf_fitted *m = context;
    const struct model_blend at = {
        .view = relume_direction_mesh_at(m->view_mesh, m->view[view]),
        .v = m->view[view],
        .light = relume_direction_mesh_at(m->light_mesh, m->light[light]),
        .l = m->light[light],
    };
    for (size_t i = 0; i < m->texels; i++)
        model_blend(m, i, &at, rgb + 3 * i);
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
    if (!status)
        status = btf_fill(*out, p.threads, m, show);
    if (status)
        relume_btf_destroy(out);
    return status;
}
