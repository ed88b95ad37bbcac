// gbrdf_file.h - a g-BRDF as one EXR file of six parts (docs/gbrdf.md)
#ifndef BTF_MODEL_GBRDF_FILE_H
#define BTF_MODEL_GBRDF_FILE_H

#include "material/model/model.h"

// Whether a name is that of such a file.
bool gbrdf_file_named(const char *path);

// RELUME_EINVAL for other models and for levels of detail, RELUME_EIO, RELUME_ENOMEM.
relume_status gbrdf_file_save(const relume_btf_fitted *m, const char *path,
                              const struct relume_log *log);
// An input status with a sentence, RELUME_ENOMEM.
relume_status gbrdf_file_open(relume_btf_fitted **out, const char *path,
                              const struct relume_btf_params *params);

#endif
