// print.h - a geometry as members of a JSON object, as capture.json and scene.json have them
#ifndef GEOMETRY_PRINT_H
#define GEOMETRY_PRINT_H

#include "core/base/json_write.h"

#include <relume/camera.h>

// Its "projection", on a line of its own.
void geometry_put_projection(struct jwriter *w, const struct relume_geometry *g);
// And its "window", "slab" or "panorama", on another.
void geometry_put(struct jwriter *w, const struct relume_geometry *g);
// Members of the object of a slab.
void geometry_put_planes(struct jwriter *w, const struct relume_geometry *g);

#endif
