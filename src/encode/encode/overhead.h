// overhead.h - bytes of a lossy file other than words of planes
#ifndef ENCODE_OVERHEAD_H
#define ENCODE_OVERHEAD_H

#include "encode/encode/contents.h"
#include "encode/parts/groups.h"

struct overhead {
    const struct contents *f;
    const struct view_groups *groups;
    double header;  // with the first group alone
};
// The first view of `f` has coefficients whose steps are known. All calls: RELUME_ENOMEM,
// RELUME_ECANCEL, RELUME_ESYSTEM.
relume_status overhead_create(struct overhead *out, const struct contents *f,
                              const struct view_groups *groups);

// The header and the heads of all groups.
relume_status overhead_heads(double *bytes, const struct overhead *o);
// Bytes added by depth, masks and levels of a group, by the preview, and by the models of shadows
// and highlights of all views, as far as `f` has them.
relume_status overhead_extras(double *bytes, const struct overhead *o, int group);
relume_status overhead_preview(double *bytes, const struct overhead *o);
relume_status overhead_models(double *bytes, const struct overhead *o);

#endif
