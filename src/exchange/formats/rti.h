// rti.h - hemispherical harmonics: .rti files (HSH 1.2) and the older .hsh
#ifndef EXCHANGE_RTI_H
#define EXCHANGE_RTI_H

#include "exchange/foreign/foreign.h"

#include <relume/context.h>

// An input status with a sentence. `old`: the header's numbers are (min, max), not (scale, min).
relume_status rti_read(struct foreign *out, const char *path, bool old,
                       const struct relume_limits *limits, const struct relume_log *log);

// `f` has the form "channels" with hsh functions and equal scales in the three channels.
relume_status rti_write(const struct foreign *f, const char *path,
                        const struct relume_writer *writer, const struct relume_log *log);

#endif
