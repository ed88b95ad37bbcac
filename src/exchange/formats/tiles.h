// tiles.h - plane JPEGs cut into DeepZoom pyramids, as OpenLIME's layout "deepzoom" reads them
#ifndef EXCHANGE_TILES_H
#define EXCHANGE_TILES_H

#include "exchange/formats/web.h"
#include "image/image/jpeg.h"

// Writes plane_N.dzi and plane_N_files/LEVEL/COLUMN_ROW.jpg of each kept sheet into the folder
// `path`. The coefficients of a level are means of the level below. RELUME_EIO, RELUME_ENOMEM.
relume_status tiles_write(const struct web_folder *w, double step, const char *path, int threads,
                          const struct relume_log *log);

// Put plane `image` of such a folder together again from the tiles of its finest level. Pyramids
// that begin with one pixel are read as well. An input status with a sentence, RELUME_ENOMEM.
relume_status tiles_read(struct jpeg_codes *out, const char *folder, int image,
                         const struct relume_limits *limits, const struct relume_log *log);

#endif
