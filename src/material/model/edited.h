// edited.h - models that are opened have the edits that are kept with them
#ifndef BTF_MODEL_EDITED_H
#define BTF_MODEL_EDITED_H

#include "material/model/model.h"

// The g-BRDF at `path`, opened whole, with the edits that are kept there, in place of it; NULL on
// failure. Other models have none. As relume_btf_fitted_edit, and an input status.
relume_status model_apply_edits(relume_btf_fitted **m, const char *path,
                                const struct relume_log *log);

#endif
