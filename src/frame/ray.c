// ray.c - a single ray and the planes that it meets
#include "frame/renderer.h"

void ray_sample(float rgb[3], const struct relume_image *image, double x, double y)
{
    const double cx = fmin(fmax(x - 0.5, 0.0), image->width - 1.0);
    const double cy = fmin(fmax(y - 0.5, 0.0), image->height - 1.0);
    const int x0 = relume_whole(cx), y0 = relume_whole(cy);
    const int x1 = x0 + 1 < image->width ? x0 + 1 : x0, y1 = y0 + 1 < image->height ? y0 + 1 : y0;
    const double fx = cx - x0, fy = cy - y0;
    const size_t width = (size_t)image->width;
    const float *top = image->data + (size_t)y0 * width * 3;
    const float *low = image->data + (size_t)y1 * width * 3;
    for (int c = 0; c < 3; c++) {
        const double t = top[3 * x0 + c] * (1.0 - fx) + top[3 * x1 + c] * fx;
        const double l = low[3 * x0 + c] * (1.0 - fx) + low[3 * x1 + c] * fx;
        rgb[c] = (float)(t * (1.0 - fy) + l * fy);
    }
}

bool ray_meets_plane(vec3 eye, vec3 direction, double z, double xy[2])
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
