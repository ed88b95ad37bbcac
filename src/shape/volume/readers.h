// readers.h - the files that volumes come from
#ifndef VOLUME_READERS_H
#define VOLUME_READERS_H

#include "shape/volume/store.h"
#include "shape/volume/unpack.h"

// Each fills `s->volume`, whose format and range it leaves to the caller. An input status with a
// sentence, RELUME_EINVAL, RELUME_ENOMEM, RELUME_EIO.
relume_status volume_read_raw(struct store *s, const char *path,
                              const struct relume_volume_params *params);
relume_status volume_read_nrrd(struct store *s, const char *path,
                               const struct relume_volume_params *params);
relume_status volume_read_nifti(struct store *s, const char *path,
                                const struct relume_volume_params *params);
relume_status volume_read_slices(struct store *s, const char *path,
                                 const struct relume_volume_params *params);
relume_status volume_read_pages(struct store *s, const char *path,
                                const struct relume_volume_params *params);

// All samples from where `from` stands, layer by layer; what follows them is passed over, unless
// `exact`.
relume_status volume_take(struct store *s, unpack *from, const int64_t size[3], bool exact,
                          const struct relume_volume_params *params);
// The spacing that a file names, where the caller wants it.
void volume_set_spacing(struct store *s, const double spacing[3],
                        const struct relume_volume_params *params);

#endif
