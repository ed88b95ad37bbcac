// depth_step.c - how coarsely depth is coded
#include "encode/encode/depth_step.h"

#include <math.h>

// The half of a step moves what the next camera of a slab sees by so many pixels; without one it is
// this part of the inverse of the usual depth. Twice as much where planes are coarse.
static const double MOST_PARALLAX = 0.25, OF_USUAL = 1.0 / 128.0, COARSE_DB = 36.0, FINE_DB = 40.0;

static double coarser(double psnr_db)
{
    return psnr_db > 0.0 ? fmin(fmax(exp2((FINE_DB - psnr_db) / (FINE_DB - COARSE_DB)), 1.0), 2.0)
                         : 1.0;
}

// How far apart the cameras of a slab stand; 0: there is one.
static double between_cameras(const struct relume_manifest *m, int slab)
{
    double extent = 0.0;
    int views = 0;
    for (int v = 0, first = 0; v < m->views; v++) {
        if (m->view[v].slab != slab)
            continue;
        first = views++ ? first : v;
        for (int i = 0; i < 2; i++)
            extent = fmax(extent, fabs(m->view[v].uv[i] - m->view[first].uv[i]));
    }
    return extent / fmax(sqrt(views) - 1.0, 1.0);
}

// The mean inverse of a depth map, of what is finite; 0 where nothing is.
static double usual_inverse(const struct relume_image *depth)
{
    const size_t n = (size_t)depth->width * (size_t)depth->height;
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < n; i++)
        if (isfinite(depth->data[i])) {
            sum += 1.0 / (double)depth->data[i];
            count++;
        }
    return count > 0.0 ? sum / count : 0.0;
}

static double finest_step(const struct relume_manifest *m, const struct relume_image *depth,
                          int slab)
{
    const struct relume_geometry *g = m->slabs ? &m->slab[slab] : &m->geometry;
    const double between = g->projection == RELUME_SLAB ? between_cameras(m, slab) : 0.0;
    if (!(between > 0.0))
        return 2.0 * OF_USUAL * usual_inverse(depth);
    const double pixel = fmin((g->st_max[0] - g->st_min[0]) / depth->width,
                              (g->st_max[1] - g->st_min[1]) / depth->height);
    return 2.0 * MOST_PARALLAX * pixel / (between * fabs(g->uv_z - g->st_z));
}

double depth_step(const struct relume_manifest *m, const struct relume_image *depth, int slab,
                  double psnr_db)
{
    return coarser(psnr_db) * finest_step(m, depth, slab);
}
