// contest.h - components against pictures, both lossy
#ifndef ENCODE_CONTEST_H
#define ENCODE_CONTEST_H

#include <relume/encode/pack_encode.h>

// Keeps in *out the better of the components that are there and `pictures`, at the quality or bytes
// of `p`; the other is destroyed, on failure both. Shared by the members of p->team. Errors as
// windows_compare and rate_merit, and of sharing.
relume_status contest_keep_better(relume_coder **out, relume_coder *pictures,
                                  const relume_capture *capture,
                                  const struct relume_pack_encode_params *p,
                                  const struct relume_project_params *encode);

#endif
