// pairs.h - pairs of pictures whose light and eye have changed places
#ifndef GBRDF_PAIRS_H
#define GBRDF_PAIRS_H

#include "material/btf/btf.h"

// Two pictures of one sample that are compared.
struct picture_pair {
    int view[2], light[2];
};
// All reciprocal pairs whose two directions differ, each once, in *out, which the caller frees, and
// their number in *count, which is 0 where the BTF has none. RELUME_ENOMEM.
relume_status pairs_reciprocal(struct picture_pair **out, int *count, const relume_btf *btf);

// A BTF under lights where its views are, interpolated: every pair of it has its reciprocal.
// RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status pairs_resample(relume_btf **out, const relume_btf *btf, int threads,
                             const struct relume_log *log);

#endif
