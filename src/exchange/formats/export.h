// export.h - what the writers of the formats share
#ifndef EXCHANGE_EXPORT_H
#define EXCHANGE_EXPORT_H

#include "exchange/foreign/source.h"

#include <relume/exchange.h>

struct export
{
    const struct source *source;
    const struct relume_export_params *params;
    const struct relume_log *log;  // names the file
    bool tiles;
};

relume_status export_web(const struct export *e, const char *path,
                         struct relume_export_report *report);
relume_status export_legacy(const struct export *e, const char *path, enum relume_exchange format,
                            struct relume_export_report *report);

relume_status export_blocks(const struct export *e, const char *path, enum relume_exchange format,
                            struct relume_export_report *report);

// A layer of half floats for every light that the codes were made from.
relume_status export_olat(const struct relume_codes *codes, const char *path,
                          struct relume_export_report *report,
                          const struct relume_export_params *params);

// Mean distance of a light from its nearest neighbour.
double export_light_spacing(const struct source *s);

#endif
