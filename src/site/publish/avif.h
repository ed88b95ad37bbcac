// avif.h - a sheet of planes as an AVIF picture, which browsers decode as they do JPEG
//
// AV1 of 12 bits, 4:4:4, without colour transform: red, green and blue are the sheet's planes.
// Browsers hand out 8 bits of it, codes in the sheet's own coding.
#ifndef PUBLISH_AVIF_H
#define PUBLISH_AVIF_H

#include "exchange/formats/sheet.h"

// `sheet` as coarse as errs no more than `jpeg` does, its JPEG, in whose coding the codes are.
// `out` has bytes alone; codes[3][height][width] is what a browser decodes. `quantiser` is a guess,
// and becomes what was taken. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status avif_encode(struct sheet_result *out, uint8_t *codes, const struct sheet *sheet,
                          const struct sheet_result *jpeg, int *quantiser,
                          const struct relume_log *log);

#endif
