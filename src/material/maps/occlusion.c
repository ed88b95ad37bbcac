// occlusion.c - ambient occlusion of a relief
//
// In each plane through the surface's normal's foot and the vertical the sky is free between two
// horizons h1 < 0 < h2, angles from the vertical; the cosine-weighted share of the arc for a normal
// whose projection into the plane is at the angle g (Jimenez et al. 2016, Eq. 7):
//     a(h) = (cos g - cos(2 h - g) + 2 h sin g) / 4,
// times the length of the projection, meaned over planes.
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "core/math/vec.h"
#include "material/maps/maps.h"

#include <relume/material/maps.h>

enum { PLANES = 8, STEPS = 30 };

struct sky {
    const struct relume_image *height;
    struct relume_image *out;
    double pixel, reach;  // reach in pixels
};

static double height_at(const struct sky *s, double x, double y)
{
    const struct bilinear b = bilinear_at(x, y, s->height->width, s->height->height, EDGE_CLAMPED);
    return bilinear_value(&b, s->height->data, 1, 0);
}

// The tangent of the highest elevation in a direction; steps grow with the distance.
static double horizon(const struct sky *s, double x, double y, double z, double dx, double dy)
{
    const double grow = pow(s->reach, 1.0 / (STEPS - 1));
    double steepest = -INFINITY, far = 1.0;
    for (int i = 0; i < STEPS; i++, far *= grow) {
        const double px = x + far * dx, py = y + far * dy;
        if (px < 0.0 || py < 0.0 || px > s->height->width - 1 || py > s->height->height - 1)
            break;
        steepest = fmax(steepest, (height_at(s, px, py) - z) / (far * s->pixel));
    }
    return steepest;
}

static vec3 normal_at(const struct sky *s, int x, int y)
{
    const double right = height_at(s, x + 1, y) - height_at(s, x - 1, y);
    const double down = height_at(s, x, y + 1) - height_at(s, x, y - 1);
    const int w = s->height->width, h = s->height->height;
    const double across = (x > 0) + (x + 1 < w), along = (y > 0) + (y + 1 < h);
    return vec3_unit(vec3_of(-right / fmax(across, 1.0), down / fmax(along, 1.0), s->pixel));
}

static double arc(double h, double g)
{
    return 0.25 * (cos(g) - cos(2.0 * h - g) + 2.0 * h * sin(g));
}

static double free_share(const struct sky *s, int x, int y)
{
    const vec3 n = normal_at(s, x, y);
    const double z = height_at(s, x, y);
    double sum = 0.0;
    for (int i = 0; i < PLANES; i++) {
        const double a = M_PI * (i + 0.5) / PLANES, dx = cos(a), dy = sin(a);
        const double along = n.x * dx - n.y * dy;  // rows run down
        const double length = hypot(along, n.z), g = atan2(along, n.z);
        const double right = M_PI_2 - atan(horizon(s, x, y, z, dx, dy));
        const double left = M_PI_2 - atan(horizon(s, x, y, z, -dx, -dy));
        const double h1 = g + fmax(-left - g, -M_PI_2), h2 = g + fmin(right - g, M_PI_2);
        sum += length * (arc(h1, g) + arc(h2, g));
    }
    return fmin(fmax(sum / PLANES, 0.0), 1.0);
}

static void do_row(void *context, size_t item, int worker)
{
    (void)worker;
    const struct sky *s = context;
    const int width = s->height->width;
    for (int x = 0; x < width; x++)
        s->out->data[item * (size_t)width + (size_t)x] = (float)free_share(s, x, (int)item);
}

relume_status relume_height_occlusion(struct relume_image *out, const struct relume_image *height,
                                      double pixel, int threads)
{
    *out = (struct relume_image){0};
    if (height->channels != 1 || !(pixel > 0.0))
        return RELUME_EINVAL;
    const int side = height->width > height->height ? height->width : height->height;
    const struct sky s = {height, out, pixel, fmax(side / 8.0, 2.0)};
    const relume_status status = relume_image_create(out, height->width, height->height, 1);
    if (!status)
        thread_for(threads, (size_t)height->height, do_row, (void *)&s);
    return status;
}
