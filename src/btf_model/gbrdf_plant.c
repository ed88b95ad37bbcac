// gbrdf_plant.c - the g-BRDF of which everything is known, as a fitted model
#include "base/log.h"
#include "base/memory.h"
#include "base/params.h"
#include "btf_model/model_gbrdf.h"
#include "gbrdf/planted.h"

static relume_status make_directions(relume_btf_fitted *m, const struct relume_btf_set *set,
                                     const struct relume_log *log)
{
    m->views = m->lights = set->count;
    m->view = mem_array((size_t)set->count, sizeof *m->view);
    m->light = mem_array((size_t)set->count, sizeof *m->light);
    if (!m->view || !m->light)
        return RELUME_ENOMEM;
    relume_btf_set_directions(set, m->view);
    relume_btf_set_directions(set, m->light);
    const relume_status status = btf_make_mesh(&m->view_mesh, m->view, m->views, NULL, "", log);
    return status ? status : btf_make_mesh(&m->light_mesh, m->light, m->lights, NULL, "", log);
}

relume_status relume_gbrdf_plant(relume_btf_fitted **out,
                                 const struct relume_gbrdf_plant_params *params)
{
    const struct relume_gbrdf_plant_params p = PARAMS(relume_gbrdf_plant_params, params);
    const int size = p.size ? p.size : 64;
    *out = NULL;
    if (size < 1 || size > 1024)
        return log_fail(p.log, RELUME_EINVAL, "size: expected 1 to 1024 texels; found %d", size);
    relume_btf_fitted *m = mem_zeroed(1, sizeof *m);
    if (!m)
        return RELUME_ENOMEM;
    m->model = &model_gbrdf;
    m->width = m->height = size;
    m->texels = (size_t)size * (size_t)size;
    m->clusters = PLANTED_MATERIALS;
    relume_status status =
        make_directions(m, p.directions ? p.directions : relume_btf_set_find("bonn"), p.log);
    if (!status)
        status = model_make_arrays(m);
    if (!status) {
        struct gbrdf_maps maps = gbrdf_maps_of(m);
        gbrdf_plant(&maps, p.seed);
        status = model_gbrdf.prepare(m);
    }
    if (status)
        relume_btf_fitted_destroy(&m);
    else
        model_settle(m);
    *out = m;
    return status;
}
