// disparity.c - depth of a slab's camera as disparity
//
// With m the height of a point above the st plane in units of the cameras' height, the camera at c
// sees it in (s, t), and the camera at c' in (s, t) + m / (1 - m) (c - c').
#include "relight/view/slab.h"
#include "relight/view/view.h"

#include <math.h>

// A surface closer to the cameras than this is treated as one at this disparity: it would need
// cameras closer together than any slab has.
static const double most = 64.0;

double relume_slab_plane_disparity(const relume_slab *slab, double z)
{
    return (z - slab->geometry.st_z) / (slab->geometry.uv_z - z);
}

double relume_slab_eye_disparity(const relume_slab *slab, struct relume_vec3 eye)
{
    double reach;
    return slab_reach(&reach, slab, eye) && reach < 0.0 ? -1.0 / reach : (double)INFINITY;
}

// Background beside a surface: antialiased, it holds some of that surface's colour.
static const float fringe = 2.0f * RELUME_SLAB_BACKGROUND;

static bool beside_surface(const struct relume_image *depth, int column, int row)
{
    for (int y = row - 1; y <= row + 1; y++)
        for (int x = column - 1; x <= column + 1; x++) {
            const bool inside = x >= 0 && x < depth->width && y >= 0 && y < depth->height;
            if (inside && isfinite(depth->data[(size_t)y * (size_t)depth->width + (size_t)x]))
                return true;
        }
    return false;
}

relume_status relume_slab_disparity(struct relume_image *out, const relume_slab *slab,
                                    const double uv[2], const struct relume_image *depth)
{
    const struct relume_geometry *g = &slab->geometry;
    *out = (struct relume_image){0};
    if (!depth->data || depth->channels != 1)
        return RELUME_EINVAL;
    const relume_status status = relume_image_create(out, depth->width, depth->height, 1);
    const double extent[2] = {g->st_max[0] - g->st_min[0], g->st_max[1] - g->st_min[1]};
    for (int row = 0; !status && row < depth->height; row++) {
        const double t = g->st_max[1] - (row + 0.5) / depth->height * extent[1] - uv[1];
        const double ahead = g->uv_z - g->st_z, beside = t * t + ahead * ahead;
        for (int column = 0; column < depth->width; column++) {
            const size_t i = (size_t)row * (size_t)depth->width + (size_t)column;
            const double s = g->st_min[0] + (column + 0.5) / depth->width * extent[0] - uv[0];
            const double whole = sqrt(s * s + beside);
            const double d = (double)depth->data[i];
            const double m = 1.0 - d / whole;  // height above the st plane, cameras at 1
            if (isfinite(d))
                out->data[i] = (float)(m < most / (1.0 + most) ? m / (1.0 - m) : most);
            else
                out->data[i] = beside_surface(depth, column, row) ? fringe : RELUME_SLAB_BACKGROUND;
        }
    }
    return status;
}

bool relume_slab_range(double range[2], const struct relume_image *disparity)
{
    const size_t n = (size_t)disparity->width * (size_t)disparity->height;
    range[0] = (double)INFINITY;
    range[1] = -(double)INFINITY;
    for (size_t i = 0; i < n; i++)
        if (disparity->data[i] > RELUME_SLAB_BACKGROUND) {
            range[0] = fmin(range[0], (double)disparity->data[i]);
            range[1] = fmax(range[1], (double)disparity->data[i]);
        }
    return range[0] <= range[1];
}
