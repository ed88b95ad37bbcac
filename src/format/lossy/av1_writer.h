// av1_writer.h - libaom, given one picture after the other
//
// A writer runs in this process or in one that the helper program forks (av1_serve.h); av1_encode
// chooses.
#ifndef LOSSY_AV1_WRITER_H
#define LOSSY_AV1_WRITER_H

#include "format/lossy/av1.h"

typedef struct av1_writer av1_writer;

// Begins a group of `members` sequences as av1_encode. `shape->halved` is not used: each picture
// comes with its own. RELUME_ENOMEM; RELUME_ESYSTEM with av1_writer_error. `*out` may exist on
// failure and is destroyed by the caller either way.
relume_status av1_writer_open(av1_writer **out, const struct av1_shape *shape, int members,
                              const struct av1_effort *effort, int threads);
// Codes samples[component][height][width]: picture 0 of each member in turn, then picture 1, and so
// on. `halved` is how often the step of its samples was halved. Errors as above.
relume_status av1_writer_add(av1_writer *w, const uint16_t *samples, int picture, int member,
                             int halved);
// The bytes of a member so far. They belong to the writer unless the caller takes them and leaves a
// zeroed struct.
struct av1_bytes *av1_writer_bytes(av1_writer *w, int member);
// Text of the last failure, never NULL.
const char *av1_writer_error(av1_writer *w);
void av1_writer_destroy(av1_writer **writer);

#endif
