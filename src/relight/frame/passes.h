// passes.h - what a frame's passes need of the file: normals, views towards the eye, photographs
#ifndef FRAME_PASSES_H
#define FRAME_PASSES_H

#include <relume/frame.h>

// Replace `image`, view number `view` of `pack` relit by `lights`, by what params->pass shows of
// it. RELUME_EINVAL, RELUME_EUNFIT with a sentence, RELUME_ENOMEM, RELUME_ECANCEL.
relume_status passes_apply(struct relume_image *image, relume_pack *pack, int view,
                           const struct relume_codes *codes, const struct relume_light *lights,
                           int n, const struct relume_frame_params *params);

#endif
