// panorama.h - an image seen as a panorama, and the end discs of a cylinder
#ifndef VIEW_PANORAMA_H
#define VIEW_PANORAMA_H

#include "core/math/vec.h"

#include <relume/relight/view.h>

struct panorama {
    const struct relume_geometry *geometry;
    int width, height;
    const float *data;          // three channels; NULL when only the geometry is asked for
    enum relume_filter filter;  // of a frame; discs are bilinear
    const struct relume_view_params *params;  // of a single ray, or NULL
};

// Rows of a cylinder, which its discs lie below.
static inline int panorama_rows(const struct panorama *p)
{
    return p->height - p->geometry->disc;
}

void panorama_fetch(float rgb[3], const struct panorama *p, int x, int y);

// A texel of a layout: what it is of beyond a border is its own to say.
typedef void panorama_texel(float rgb[3], const struct panorama *p, int face, int x, int y);

// Of the rows of a cylinder: the first and the last are repeated.
panorama_texel panorama_cylinder_texel;

// Between four texels; (x, y) counts from the centre of the first one.
void panorama_bilinear(float rgb[3], const struct panorama *p, panorama_texel *texel, int face,
                       double x, double y);

// ---------------------------------------------------------------- discs

// Of a position in the rows below a cylinder; zero beside the squares of its discs.
vec3 disc_ray(const struct panorama *p, double x, double y);
// Of a direction that is above or below the cylinder; at or below its last row.
void disc_pixel(double xy[2], const struct panorama *p, vec3 d);
// How many texels further on a disc a direction comes to lie that moves by `step`.
double disc_texels(const struct panorama *p, vec3 d, vec3 step);
// Bilinear value at a position of the image that shows something.
void disc_sample(float rgb[3], const struct panorama *p, const double xy[2]);

#endif
