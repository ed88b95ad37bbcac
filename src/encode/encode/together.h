// together.h - one file made by several processes that run at the same time
#ifndef ENCODE_TOGETHER_H
#define ENCODE_TOGETHER_H

#include "encode/encode/request.h"

// Writes the part of this process beside r->path; the first process of r->pack.team joins all parts
// and fills r->result.measured. After a failure the parts stay, and the same call takes them up.
// A status of sharing, errors of relume_pack_encode and relume_pack_join.
relume_status together_write(struct encode_request *r, const relume_coder *coder);

#endif
