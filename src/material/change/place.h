// place.h - where the pixels of the first capture lie in the second
#ifndef CHANGE_PLACE_H
#define CHANGE_PLACE_H

#include "material/change/surface.h"

#include <relume/capture/align.h>

// Displacements on nodes, and a homography of what is displaced.
struct place {
    double m[3][3];  // pixels of the first, centres at +0.5 -> of the second
    double step;     // pixels of the first between nodes; node (0, 0) lies at (0, 0)
    int columns, rows;
    double (*d)[2];  // [rows][columns], pixels of the first, or NULL
};
void place_free(struct place *p);
void place_of(double out[2], const struct place *p, double x, double y);

// By a homography alone, from pictures of what does not change with the light. RELUME_EUNFIT with a
// sentence when the two have nothing in common; RELUME_ENOMEM.
relume_status place_register(struct place *out, double *correlation, const struct surface *a,
                             const struct surface *b, double max_roll_deg, int threads,
                             const struct relume_log *log);

// What of surface `b` lies at the places of the pixels of a picture of width x height pixels:
// normals and colours by cubic interpolation, what lies outside is not known.
relume_status place_sample(struct surface *out, const struct surface *b, const struct place *p,
                           int width, int height, int threads);

#endif
