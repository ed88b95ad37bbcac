// surface.c - pixel, eye and depth become a point of the world: P = E + d V / |V| (Wong
// 1998, 7.5.5)
#include <relume/relight/view.h>

#include "core/math/vec.h"
#include "relight/view/view.h"

// The ray of a pixel centre: where it starts and its unit direction.
static void pixel_ray(const struct relume_geometry *g, const double uv[2], int width, int height,
                      int column, int row, vec3 *eye, vec3 *direction)
{
    const bool slab = g->projection == RELUME_SLAB;
    const double *min = slab ? g->st_min : g->window_min, *max = slab ? g->st_max : g->window_max;
    const double x = min[0] + (column + 0.5) / width * (max[0] - min[0]);
    const double y = max[1] - (row + 0.5) / height * (max[1] - min[1]);
    if (g->projection >= RELUME_CYLINDRICAL) {
        *eye = g->center;
        *direction = relume_panorama_ray(g, width, height, column + 0.5, row + 0.5);
    } else if (slab) {
        const vec3 camera = vec3_of(uv[0], uv[1], g->uv_z);
        const vec3 ray = vec3_unit(vec3_sub(vec3_of(x, y, g->st_z), camera));
        *eye = relume_pose_world(&g->pose, camera);
        *direction = relume_pose_turn(&g->pose, ray);
    } else if (g->perspective) {
        *eye = vec3_of(0.0, 0.0, g->camera_z);
        *direction = vec3_unit(vec3_sub(vec3_of(x, y, 0.0), *eye));
    } else {
        *eye = vec3_of(x, y, g->camera_z);
        *direction = vec3_of(0.0, 0.0, -1.0);
    }
}

relume_status relume_view_positions(struct relume_image *out,
                                    const struct relume_geometry *geometry, const double uv[2],
                                    const struct relume_image *depth, int width, int height)
{
    *out = (struct relume_image){0};
    if ((!depth && geometry->projection != RELUME_PLANAR) ||
        (depth && (depth->width != width || depth->height != height || depth->channels != 1)))
        return RELUME_EINVAL;
    const relume_status status = relume_image_create(out, width, height, 3);
    float *to = out->data;
    for (int row = 0; !status && row < height; row++)
        for (int column = 0; column < width; column++, to += 3) {
            vec3 eye, v;
            pixel_ray(geometry, uv, width, height, column, row, &eye, &v);
            const double d = depth
                                 ? (double)depth->data[(size_t)row * (size_t)width + (size_t)column]
                                 : -eye.z / v.z;  // to the plane z = 0
            to[0] = (float)(eye.x + d * v.x);
            to[1] = (float)(eye.y + d * v.y);
            to[2] = (float)(eye.z + d * v.z);
        }
    return status;
}
