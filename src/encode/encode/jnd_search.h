// jnd_search.h - the smallest file whose losses are not seen
#ifndef ENCODE_JND_SEARCH_H
#define ENCODE_JND_SEARCH_H

#include <relume/encode.h>

// Encodes with the PSNR `psnr_db` into `path`, or by the writer of `p`.
typedef relume_status encode_trial(const char *path, const relume_capture *capture, double psnr_db,
                                   struct relume_encode_result *result,
                                   const struct relume_encode_capture_params *p);

// Searches for the lowest PSNR at which p->jnd is kept. Trials are made beside `path`, or in memory
// for a writer, and the best one becomes the output. Its `result` has the JND and the PSNR that
// relume_evaluate measures. Only the first trial is heard. Errors of the trials and of
// relume_evaluate.
relume_status jnd_search(const char *path, const relume_capture *capture,
                         struct relume_encode_result *result,
                         const struct relume_encode_capture_params *p, encode_trial *trial);

#endif
