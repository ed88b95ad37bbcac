// flat.h - a BTF drawn onto its relief: each texel's values are of one place of the surface from
// everywhere, with what can be seen and lit there
#ifndef GBRDF_FLAT_H
#define GBRDF_FLAT_H

#include "material/btf/btf.h"
#include "material/gbrdf/gbrdf.h"

struct flat {
    const relume_btf *btf;  // values, moved
    relume_btf *own;        // or NULL: the relief is a plane
    int views, lights;
    uint8_t *seen, *lit;  // [texel][view], [texel][light]
    vec3 *normal;         // [texel], Sobel's
};
// RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status flat_make(struct flat *out, const relume_btf *btf, const struct meso *relief,
                        int threads, const struct relume_log *log);
void flat_free(struct flat *flat);

#endif
