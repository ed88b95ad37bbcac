// model_gbrdf.h - the maps of a model that is a g-BRDF
#ifndef BTF_MODEL_MODEL_GBRDF_H
#define BTF_MODEL_MODEL_GBRDF_H

#include "btf_model/model.h"
#include "gbrdf/gbrdf.h"

// They belong to the model.
struct gbrdf_maps gbrdf_maps_of(const relume_btf_fitted *m);

#endif
