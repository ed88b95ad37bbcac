// from_pack.h - a file relit under its own lights, as a capture
#ifndef APPEARANCE_FROM_PACK_H
#define APPEARANCE_FROM_PACK_H

#include <relume/capture.h>
#include <relume/pack.h>

// The pictures wait in a temporary file as long as the capture is open.
struct relit {
    relume_capture *capture;  // one view, at most 64 lights
    float *pictures;          // [lights][height][width][3], mapped
    size_t bytes;
    struct relume_image depth, mask;
};
// RELUME_EUNSUPPORTED with a sentence for panoramas and several slabs, RELUME_EINVAL for a view
// that is not there; an input status, RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL. Closed on failure.
relume_status relit_open(struct relit *out, relume_pack *pack, int view, int threads,
                         const struct relume_log *log);
void relit_close(struct relit *relit);

#endif
