// request.h - one call of relume_encode_capture: its params, and the decisions so far
#ifndef ENCODE_REQUEST_H
#define ENCODE_REQUEST_H

#include "core/base/log.h"

#include <relume/encode.h>
#include <relume/encode/pack_encode.h>

struct encode_request {
    const struct relume_encode_capture_params *asked;
    const char *path;  // NULL: pack.writer
    const relume_capture *capture;
    const struct relume_log *log;  // sentences that name a file themselves
    struct log_place about;        // sentences of coders and codebooks, which name none
    // Decided as the work goes on
    const struct relume_basis *basis;
    struct relume_coder_params coder;
    struct relume_books_params books;
    struct relume_pack_encode_params pack;
    enum relume_moving shadows, highlights;
    bool decides;     // the photographs choose basis, domain and storage
    bool is_open;     // and, lossy, the quality
    bool is_unasked;  // open by default: some captures are not to be lossy
    struct relume_encode_result result;
};

// `asked` is borrowed; its log and threads are what the request uses.
void request_make(struct encode_request *out, const char *path, const relume_capture *capture,
                  const struct relume_encode_capture_params *asked);

// Lossy, by PSNR or bytes.
bool request_is_lossy(const struct encode_request *r);
// Lossy, by a table whose interpolant is left open.
bool request_is_table(const struct encode_request *r);
// Pixels are read before the capture is encoded.
bool request_learns_first(const struct encode_request *r);
// Parts share ranges of planes before they can store their pixels.
bool request_has_steps(const struct encode_request *r);
// Codes of the display domain.
bool request_is_display(const struct encode_request *r);

#endif
