// lossy_choice.h - the coder of lossy planes, and how well it was judged
#ifndef ENCODE_LOSSY_CHOICE_H
#define ENCODE_LOSSY_CHOICE_H

#include "format/coder/coding.h"

#include <relume/encode/pack_encode.h>

// As relume_pack_decide, with what is known of components; where the pictures themselves are
// chosen, they have no error before coding.
relume_status lossy_decide(relume_coder **out, struct relume_decision *decision,
                           const relume_capture *capture, const struct relume_coder_params *coder,
                           const struct relume_pack_encode_params *params);

// The bytes that its planes take at p->psnr_db, all views together. Temporary data goes beside
// `scratch`; NULL: $TMPDIR.
relume_status lossy_foretell(double *bytes, const relume_coder *coder, double pooled_db,
                             const relume_capture *capture, const char *scratch,
                             const struct relume_pack_encode_params *p);

#endif
