// legacy.h - .ptm of JPEG planes
#ifndef EXCHANGE_LEGACY_H
#define EXCHANGE_LEGACY_H

#include "exchange/foreign/foreign.h"
#include "exchange/formats/export.h"

// A quality, a size or a PSNR is asked for.
bool legacy_wants_jpeg(const struct relume_export_params *params);
// RELUME_EINVAL (.rti), RELUME_EUNFIT (too large for JPEG).
relume_status legacy_check_jpeg(const struct export *e, const char *path,
                                enum relume_exchange format);
// `f` as PTM_FORMAT_JPEG_RGB or PTM_FORMAT_JPEG_LRGB. RELUME_EUNFIT when out of reach, RELUME_EIO,
// RELUME_ENOMEM, RELUME_ECANCEL.
relume_status legacy_write_jpeg(const struct foreign *f, const struct export *e, const char *path,
                                struct relume_export_report *report);

#endif
