// ray.c - a single ray and the planes that it crosses
#include "relight/frame/renderer.h"

#include "core/math/bilinear.h"

void ray_sample(float rgb[3], const struct relume_image *image, double x, double y)
{
    const struct bilinear b =
        bilinear_at(x - 0.5, y - 0.5, image->width, image->height, EDGE_CLAMPED);
    for (size_t c = 0; c < 3; c++)
        rgb[c] = (float)bilinear_value(&b, image->data, 3, c);
}

bool ray_crosses_plane(vec3 eye, vec3 direction, double z, double xy[2])
{
    if (fabs(direction.z) < 1e-12)
        return false;
    const double t = (z - eye.z) / direction.z;
    xy[0] = eye.x + t * direction.x;
    xy[1] = eye.y + t * direction.y;
    return isfinite(xy[0]) && isfinite(xy[1]);
}

bool ray_window_pixel(const double min[2], const double max[2], int width, int height,
                      const double at[2], double xy[2])
{
    xy[0] = (at[0] - min[0]) / (max[0] - min[0]) * width;
    xy[1] = (max[1] - at[1]) / (max[1] - min[1]) * height;
    return xy[0] >= 0.0 && xy[0] <= width && xy[1] >= 0.0 && xy[1] <= height;
}

bool ray_goes_towards(vec3 eye, vec3 direction, double z)
{
    return (z - eye.z) * direction.z >= 0.0;
}
