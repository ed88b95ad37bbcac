// again.h - a relume file whose planes become lossy
#ifndef ENCODE_AGAIN_H
#define ENCODE_AGAIN_H

#include "encode/encode/request.h"

// A capture that has all of a file but photographs: lights, views, depth and masks. The caller
// destroys it with again_close. An input status, RELUME_ELIMIT, RELUME_ENOMEM.
struct again_capture {
    relume_capture *capture;
    relume_coder *coder;  // of the planes that the file stores
    float *depth, *mask;  // [views][height][width], or NULL
};
relume_status again_open(struct again_capture *out, relume_pack *pack,
                         const struct relume_log *log);
void again_close(struct again_capture *a);

// Writes the file of a lossy request whose capture is `a`. Errors of relume_pack_encode.
relume_status again_write(struct encode_request *r, const struct again_capture *a,
                          relume_pack *pack);

#endif
