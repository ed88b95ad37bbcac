// jpeg_model.h - how many bytes photographs take as JPEG files, from a look at some blocks
#ifndef ENCODE_JPEG_MODEL_H
#define ENCODE_JPEG_MODEL_H

#include <relume/capture.h>
#include <relume/format/team.h>

// The bytes of all photographs of `capture` as JPEG files of quality 90 with colour at half
// resolution: about what a camera writes, whatever files they are. Some blocks of the middle view
// are looked at under some lights, by the first member of a team. It takes milliseconds beside
// decoding. An input status, RELUME_ENOMEM.
relume_status jpeg_model_bytes(double *out, const relume_capture *capture,
                               const struct relume_team *team, int threads,
                               const struct relume_log *log);

#endif
