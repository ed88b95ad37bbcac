// panorama_discs.c - the end discs of a cylinder (Wong 1998, figure 8-17 b): upwards and downwards
//
// The cylinder has radius 1 and reaches from v_min to v_max; a disc is the unit circle of the plane
// at either height (layout: relume_geometry). Their texels do not line up at the rim, so the value
// there is the disc's own, and the cylinder goes over to it within the half row that lies between
// its outermost texels and the rim. A disc's texels beyond its rim are the cylinder's in their
// direction: so pictures are continuous, and what lies beside the discs is never read.
#include "relight/view/panorama.h"

static double height_of(const struct panorama *p, bool lower)
{
    return lower ? p->geometry->v_min : p->geometry->v_max;
}

// At (x, y) in pixels from the corner of a disc's square. Not of unit length.
static vec3 square_ray(const struct panorama *p, bool lower, double x, double y)
{
    const double side = p->geometry->disc;
    const double right = 2.0 * x / side - 1.0;
    const double up = 1.0 - 2.0 * y / side;
    return vec3_of(right, height_of(p, lower), lower ? -up : up);
}

vec3 disc_ray(const struct panorama *p, double x, double y)
{
    const int side = p->geometry->disc;
    const bool lower = x >= side;
    if (x > 2.0 * side)
        return vec3_of(0, 0, 0);
    return vec3_unit(square_ray(p, lower, lower ? x - side : x, y - panorama_rows(p)));
}

// Where a direction crosses the plane of a disc, in pixels from the corner of its square.
static void square_pixel(double xy[2], const struct panorama *p, bool lower, vec3 d)
{
    const double scale = height_of(p, lower) / d.y;
    const double side = p->geometry->disc;
    xy[0] = (0.5 + 0.5 * scale * d.x) * side;
    xy[1] = (0.5 - 0.5 * scale * (lower ? -d.z : d.z)) * side;
}

void disc_pixel(double xy[2], const struct panorama *p, vec3 d)
{
    const double side = p->geometry->disc;
    const bool lower = d.y < 0.0;
    square_pixel(xy, p, lower, d);
    // roundings on the rim stay within the square
    xy[0] = fmin(fmax(xy[0], 0.0), nextafter(side, 0.0)) + (lower ? side : 0.0);
    xy[1] = fmin(fmax(xy[1], 0.0), side) + panorama_rows(p);
}

double disc_texels(const struct panorama *p, vec3 d, vec3 step)
{
    const double scale = 0.5 * p->geometry->disc * height_of(p, d.y < 0.0) / d.y;
    const double nearer = step.y / d.y;
    return hypot(scale * (step.x - nearer * d.x), scale * (step.z - nearer * d.z));
}

// In the rows; h is within the cylinder.
static void cylinder_value(float rgb[3], const struct panorama *p, vec3 d)
{
    const struct relume_geometry *g = p->geometry;
    const double h = d.y / hypot(d.x, d.z);
    const double x = (atan2(d.x, -d.z) + M_PI) / (2.0 * M_PI) * p->width;
    const double y = (g->v_max - h) / (g->v_max - g->v_min) * panorama_rows(p);
    panorama_bilinear(rgb, p, panorama_cylinder_texel, 0, x - 0.5, y - 0.5);
}

static void disc_texel(float rgb[3], const struct panorama *p, int lower, int x, int y)
{
    const int side = p->geometry->disc;
    const vec3 d = square_ray(p, lower, x + 0.5, y + 0.5);
    if (d.x * d.x + d.z * d.z > 1.0)
        cylinder_value(rgb, p, d);
    else
        panorama_fetch(rgb, p, lower ? side + x : x, panorama_rows(p) + y);
}

// At (x, y) in pixels from the corner of the square.
static void disc_value(float rgb[3], const struct panorama *p, bool lower, const double xy[2])
{
    panorama_bilinear(rgb, p, disc_texel, lower, xy[0] - 0.5, xy[1] - 0.5);
}

// Of the cylinder's outermost half row, `part` of which lies between the rim and the position.
static void rim_sample(float rgb[3], const struct panorama *p, double x, bool lower, double part)
{
    const double phi = x / p->width * 2.0 * M_PI - M_PI;
    const int row = lower ? panorama_rows(p) - 1 : 0;
    double xy[2];
    float rim[3];
    square_pixel(xy, p, lower, vec3_of(sin(phi), height_of(p, lower), -cos(phi)));
    disc_value(rim, p, lower, xy);
    panorama_bilinear(rgb, p, panorama_cylinder_texel, 0, x - 0.5, row);
    for (int c = 0; c < 3; c++)
        rgb[c] = rim[c] + (float)part * (rgb[c] - rim[c]);
}

void disc_sample(float rgb[3], const struct panorama *p, const double xy[2])
{
    const double side = p->geometry->disc;
    const int rows = panorama_rows(p);
    const double from_rim = fmin(xy[1], rows - xy[1]);
    if (xy[1] >= rows) {
        const bool lower = xy[0] >= side;
        const double in_square[2] = {lower ? xy[0] - side : xy[0], xy[1] - rows};
        disc_value(rgb, p, lower, in_square);
    } else if (from_rim < 0.5) {
        rim_sample(rgb, p, xy[0], xy[1] > 0.5 * rows, 2.0 * from_rim);
    } else {
        panorama_bilinear(rgb, p, panorama_cylinder_texel, 0, xy[0] - 0.5, xy[1] - 0.5);
    }
}
