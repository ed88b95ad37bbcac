// geometry.h - where the pixels of a view lie: what a picture of a size can show
#ifndef GEOMETRY_GEOMETRY_H
#define GEOMETRY_GEOMETRY_H

#include <relume/camera.h>
#include <relume/image.h>

enum { RELUME_MOST_SLABS = 64 };

// Whether such a cylinder with discs can be: v_min < 0 < v_max, squares that fit, rows above them.
// True of everything without discs.
bool relume_geometry_fits(const struct relume_geometry *geometry, int width, int height);
// Returns false for pixels with centres outside of a cylinder's discs.
bool relume_geometry_shows(const struct relume_geometry *geometry, int width, int height,
                           int column, int row);
// The window of a planar view, or a slab's, of that size becomes the one of a part of it.
void geometry_crop(struct relume_geometry *geometry, int width, int height,
                   const struct relume_rect *part);

#endif
