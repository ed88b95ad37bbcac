// tiles.h - plane JPEGs cut into DeepZoom pyramids, as OpenLIME's layout "deepzoom" reads them
#ifndef EXCHANGE_TILES_H
#define EXCHANGE_TILES_H

#include "exchange/web.h"

// Replace plane_N.jpg in the folder `path` by plane_N.dzi and plane_N_files/LEVEL/COLUMN_ROW.jpg.
// The coefficients of a level are means of the level below.
relume_status tiles_write(const struct web_folder *w, double step, const char *path, int threads,
                          const struct relume_log *log);

#endif
