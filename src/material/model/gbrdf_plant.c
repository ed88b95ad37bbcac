// gbrdf_plant.c - g-BRDFs that were not fitted: from maps and directions, and the one of which
// everything is known
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "material/gbrdf/fit.h"
#include "material/gbrdf/planted.h"
#include "material/model/model_gbrdf.h"

static relume_status copy_directions(relume_btf_fitted *m, const struct gbrdf_directions *d,
                                     const struct relume_log *log)
{
    m->views = d->views;
    m->lights = d->lights;
    m->without_cosine = d->without_cosine;
    m->view = mem_copy(d->view, (size_t)d->views, sizeof *m->view);
    m->light = mem_copy(d->light, (size_t)d->lights, sizeof *m->light);
    if (!m->view || !m->light)
        return RELUME_ENOMEM;
    const relume_status status = btf_make_mesh(&m->view_mesh, m->view, m->views, NULL, "", log);
    return status ? status : btf_make_mesh(&m->light_mesh, m->light, m->lights, NULL, "", log);
}

relume_status gbrdf_model_create(relume_btf_fitted **out, const struct gbrdf_maps *maps,
                                 const struct gbrdf_directions *directions,
                                 const struct relume_log *log)
{
    relume_btf_fitted *m = *out = mem_zeroed(1, sizeof *m);
    if (!m)
        return RELUME_ENOMEM;
    m->model = &model_gbrdf;
    m->width = maps->width;
    m->height = maps->height;
    m->texels = (size_t)maps->width * (size_t)maps->height;
    relume_status status = copy_directions(m, directions, log);
    if (!status)
        status = gbrdf_maps_store(m, maps);
    if (!status)
        status = model_gbrdf.prepare(m);
    if (status)
        relume_btf_fitted_destroy(out);
    else
        model_settle(m);
    return status;
}

relume_status gbrdf_model_of_set(relume_btf_fitted **out, const struct gbrdf_maps *maps,
                                 const struct relume_btf_set *set, const struct relume_log *log)
{
    set = set ? set : relume_btf_set_find("bonn");
    vec3 *d = mem_array((size_t)set->count, sizeof *d);
    if (d)
        relume_btf_set_directions(set, d);
    *out = NULL;
    const relume_status status =
        d ? gbrdf_model_create(out, maps,
                               &(struct gbrdf_directions){d, d, set->count, set->count, false}, log)
          : RELUME_ENOMEM;
    mem_free(d);
    return status;
}

relume_status relume_gbrdf_plant(relume_btf_fitted **out,
                                 const struct relume_gbrdf_plant_params *params)
{
    const struct relume_gbrdf_plant_params p = PARAMS(relume_gbrdf_plant_params, params);
    const int size = p.size ? p.size : 64;
    struct gbrdf_maps maps;
    *out = NULL;
    if (size < 1 || size > 1024)
        return log_fail(p.log, RELUME_EINVAL, "size: expected 1 to 1024 texels; found %d", size);
    relume_status status = gbrdf_maps_create(&maps, size, size, PLANTED_MATERIALS);
    if (!status) {
        gbrdf_plant(&maps, p.seed);
        status = gbrdf_model_of_set(out, &maps, p.directions, p.log);
    }
    gbrdf_maps_free(&maps);
    return status;
}
