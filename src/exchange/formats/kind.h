// kind.h - what an input is, wherever it lies
#ifndef EXCHANGE_KIND_H
#define EXCHANGE_KIND_H

#include <relume/exchange.h>

// relume_kind_of, where names are those of the log's context.
enum relume_kind exchange_kind_of(const char *path, const struct relume_log *log);

#endif
