// photograph.h - what the camera noted, within limits
#ifndef IMAGE_PHOTOGRAPH_H
#define IMAGE_PHOTOGRAPH_H

#include <relume/image/photograph.h>

// relume_exif_read, of files within `limits`.
relume_status photograph_notes(struct relume_exif *out, const char *path,
                               const struct relume_limits *limits, const struct relume_log *log);

// A vector of the picture as it lies in the file, x to the right and y up, in the one that is shown
// upright.
void photograph_turn_vector(double xy[2], int orientation);

// Refuses a folder of tiles that WebRTIMaker wrote, which look like photographs.
// RELUME_EUNSUPPORTED, RELUME_ENOMEM.
relume_status photographs_refuse_tiles(const char *folder, const struct relume_log *log);

#endif
