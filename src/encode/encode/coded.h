// coded.h - planes with loss: the steps, and the views of this part by them
#ifndef ENCODE_CODED_H
#define ENCODE_CODED_H

#include "encode/encode/contents.h"

// Returns true for lossy planes.
static inline bool encode_is_coded(const struct relume_pack_encode_params *p)
{
    return p->psnr_db > 0.0 || p->bytes_per_pixel > 0.0;
}

// Writes `path`, or by the writer of f->p, with what has its steps by f->p->psnr_db or
// bytes_per_pixel. Of a part these are the tiles of its share; what all parts must know
// is shared with the team, each part making what its own views say; without a team all is made
// here. Errors as relume_pack_encode.
relume_status encode_coded(struct contents *f, const char *path, struct relume_fidelity *report);

#endif
