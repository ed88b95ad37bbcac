// cut_view.c - the pixels of a small picture: squares of Nusselt's disc
#include "world/transport/cut_view.h"

#include <math.h>

// The part of a pixel within the disc, and the mean of its places there.
static void measure(struct cut_pixel *p, double x, double y, double size)
{
    enum { FINE = 16 };
    double at[2] = {0.0, 0.0};
    int n = 0;
    for (int i = 0; i < FINE * FINE; i++) {
        const double u = x + (i % FINE + 0.5) / FINE * size, v = y + (i / FINE + 0.5) / FINE * size;
        if (u * u + v * v >= 1.0)
            continue;
        at[0] += u, at[1] += v;
        n++;
    }
    *p = (struct cut_pixel){.inside = (float)n / (FINE * FINE)};
    if (!n)
        return;
    p->direction[0] = (float)(at[0] / n), p->direction[1] = (float)(at[1] / n);
    p->direction[2] =
        sqrtf(1.0f - p->direction[0] * p->direction[0] - p->direction[1] * p->direction[1]);
}

void cut_view_create(struct cut_view *out, int side)
{
    double all = 0.0;
    out->side = side;
    for (int i = 0; i < side * side; i++) {
        measure(&out->pixel[i], 2.0 * (i % side) / side - 1.0, 2.0 * (i / side) / side - 1.0,
                2.0 / side);
        all += (double)out->pixel[i].inside;
    }
    for (int i = 0; i < side * side; i++)
        out->pixel[i].share = (float)((double)out->pixel[i].inside / all);
}

void cut_place_at(struct cut_place *out, const struct cut_view *view, vec3 at, vec3 normal)
{
    const vec3 any = fabs(normal.x) < 0.7 ? vec3_of(1, 0, 0) : vec3_of(0, 1, 0);
    const vec3 x = vec3_unit(vec3_cross(any, normal)), y = vec3_cross(normal, x);
    const vec3 axes[] = {x, y, normal};
    for (int k = 0; k < 3; k++) {
        out->frame[k][0] = (float)axes[k].x;
        out->frame[k][1] = (float)axes[k].y;
        out->frame[k][2] = (float)axes[k].z;
    }
    out->at[0] = (float)at.x, out->at[1] = (float)at.y, out->at[2] = (float)at.z;
    out->view = view;
    out->warp = NULL;
}

vec3 cut_direction(const struct cut_place *place, const struct cut_pixel *pixel)
{
    double d[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++)
            d[c] += (double)pixel->direction[k] * (double)place->frame[k][c];
    return vec3_unit(vec3_of(d[0], d[1], d[2]));
}
