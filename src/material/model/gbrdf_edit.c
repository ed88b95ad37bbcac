// gbrdf_edit.c - a fitted g-BRDF with edits
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "material/model/edited.h"
#include "material/model/model_gbrdf.h"
#include "material/gbrdf/edits.h"
#include "material/gbrdf/apply.h"
#include "material/gbrdf/fit.h"
#include "core/math/fnv.h"

#include <string.h>

uint64_t relume_btf_fitted_fingerprint(const relume_btf_fitted *fitted)
{
    const int32_t size[] = {fitted->width, fitted->height, fitted->clusters,
                            fitted->without_cosine};
    uint64_t hash = fnv_of(FNV_START, size, sizeof size);
    for (int i = 0; i < fitted->arrays; i++)
        hash = fnv_of(hash, fitted->array[i].data, npy_bytes(&fitted->array[i].npy));
    return hash;
}

static relume_status copy_maps(struct gbrdf_maps *out, const struct gbrdf_maps *from)
{
    const size_t texels = (size_t)from->width * (size_t)from->height;
    const relume_status status = gbrdf_maps_create(out, from->width, from->height, from->materials);
    if (status)
        return status;
    memcpy(out->depth, from->depth, texels * sizeof *out->depth);
    memcpy(out->rotation, from->rotation, texels * sizeof *out->rotation);
    memcpy(out->diffuse, from->diffuse, 3 * texels * sizeof *out->diffuse);
    memcpy(out->r0, from->r0, texels * sizeof *out->r0);
    memcpy(out->label, from->label, texels);
    memcpy(out->ndf, from->ndf, (size_t)from->materials * NDF_VALUES * sizeof *out->ndf);
    *out->light = *from->light;
    return RELUME_OK;
}

static const char *who(const relume_edits *edits)
{
    return edits->file ? edits->file : "edits";
}

static relume_status check_kind(const relume_btf_fitted *m, const relume_edits *edits,
                                const struct relume_log *log)
{
    if (m->model != &model_gbrdf)
        return log_fail(log, RELUME_EUNFIT, "%s: model %s cannot be edited; expected gbrdf",
                        who(edits), m->model->name);
    return m->half
               ? log_fail(
                     log, RELUME_EUNFIT,
                     "%s: %d levels of detail, each with materials of its own; expected one level",
                     who(edits), m->info.levels)
               : RELUME_OK;
}

relume_status relume_btf_fitted_edit(relume_btf_fitted **out, const relume_btf_fitted *fitted,
                                     const relume_edits *edits, const struct relume_log *log)
{
    const struct gbrdf_directions directions = {fitted->view, fitted->light, fitted->views,
                                                fitted->lights, fitted->without_cosine};
    struct gbrdf_maps maps = {.width = 0};
    *out = NULL;
    relume_status status = check_kind(fitted, edits, log);
    if (!status)
        status = edits_check(edits, relume_btf_fitted_fingerprint(fitted), NULL, log);
    if (!status) {
        const struct gbrdf_maps original = gbrdf_maps_of(fitted);
        status = copy_maps(&maps, &original);
    }
    if (!status)
        status = edit_gbrdf(&maps, edits, log);
    const char *fault = status ? NULL : gbrdf_fault(&maps);
    if (fault)
        status = log_fail(log, RELUME_EUNFIT, "%s: a map is out of range; expected %s", who(edits),
                          fault);
    if (!status)
        status = gbrdf_model_create(out, &maps, &directions, log);
    if (!status) {
        (*out)->info.edits = edits->count - edits->undone;
        (*out)->info.edits_undone = edits->undone;
    }
    gbrdf_maps_free(&maps);
    return status;
}

relume_status model_apply_edits(relume_btf_fitted **m, const char *path,
                                const struct relume_log *log)
{
    char *name = edits_name(path);
    const bool kept = name && input_exists(name, log);
    relume_edits *edits = NULL;
    relume_btf_fitted *edited = NULL;
    relume_status status = name ? RELUME_OK : RELUME_ENOMEM;
    mem_free(name);
    if (!kept || (*m)->model != &model_gbrdf)
        return status;
    status = relume_edits_open(&edits, path, relume_btf_fitted_fingerprint(*m), log);
    if (!status)
        status = relume_btf_fitted_edit(&edited, *m, edits, log);
    relume_edits_destroy(&edits);
    relume_btf_fitted_destroy(m);
    *m = edited;
    return status;
}
