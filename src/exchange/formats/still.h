// still.h - a picture of linear light becomes a relume file that shows it under any light
#ifndef EXCHANGE_STILL_H
#define EXCHANGE_STILL_H

#include <relume/exchange.h>

// `path`, a float picture, as one view under one light into the relume file `out`. An input status
// with a sentence, also for a picture that is no sphere where `params` want one.
relume_status still_write(const char *path, const char *out,
                          const struct relume_open_params *params);

#endif
