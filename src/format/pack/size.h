// size.h - how large a relume file will be
#ifndef PACK_SIZE_H
#define PACK_SIZE_H

#include "format/pack/pack_write.h"

#include <relume/format/pack_write.h>

// Bytes of the file that relume_pack_write would write of the same. Words and depth are measured
// without being written; only what is compressed (preview, masks, reduced levels) is packed for it.
// Errors as relume_pack_write, without RELUME_EIO.
relume_status pack_size(uint64_t *bytes, const struct relume_pack_contents *contents,
                        const struct relume_pack_params *params);

#endif
