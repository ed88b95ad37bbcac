// print.h - a geometry as members of a JSON object, as capture.json and scene.json have them
#ifndef GEOMETRY_PRINT_H
#define GEOMETRY_PRINT_H

#include <relume/camera.h>
#include <stdio.h>

// Its "projection".
void geometry_print_projection(FILE *f, const struct relume_geometry *g);
// And its "window", "slab" or "panorama"; both lines end with a comma.
void geometry_print(FILE *f, const struct relume_geometry *g);
// The object of a slab, but for its end.
void geometry_print_planes(FILE *f, const struct relume_geometry *g);

#endif
