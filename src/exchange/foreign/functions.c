// functions.c - the functions of the light that other formats are written in
#include "exchange/foreign/functions.h"

#include "core/math/bilinear.h"
#include "core/math/vec.h"

#include <string.h>

bool functions_has_count(enum function_kind kind, int count)
{
    switch (kind) {
    case FUNCTIONS_PTM: return count == 3 || count == 6;
    case FUNCTIONS_HSH: return count == 1 || count == 4 || count == 9 || count == 16;
    case FUNCTIONS_SH: return count == 1 || count == 4 || count == 9;
    default: return count >= 1 && count <= FUNCTIONS_MOST;
    }
}

static void ptm(vec3 l, double v[6])
{
    v[0] = 1.0;
    v[1] = l.x;
    v[2] = l.y;
    v[3] = l.x * l.x;
    v[4] = l.x * l.y;
    v[5] = l.y * l.y;
}

static void hsh(vec3 l, double v[16])
{
    const double theta = fmin(acos(fmax(-1.0, fmin(1.0, l.z))), M_PI / 2.0 - 0.01);
    const double phi = atan2(l.y, l.x), c = cos(theta), q = sqrt(c - c * c);
    v[0] = 1.0 / sqrt(2.0 * M_PI);
    v[1] = sqrt(6.0 / M_PI) * q * cos(phi);
    v[2] = sqrt(3.0 / (2.0 * M_PI)) * (2.0 * c - 1.0);
    v[3] = sqrt(6.0 / M_PI) * q * sin(phi);
    v[4] = sqrt(30.0 / M_PI) * (c * c - c) * cos(2.0 * phi);
    v[5] = sqrt(30.0 / M_PI) * (2.0 * c - 1.0) * q * cos(phi);
    v[6] = sqrt(5.0 / (2.0 * M_PI)) * (1.0 - 6.0 * c + 6.0 * c * c);
    v[7] = sqrt(30.0 / M_PI) * (2.0 * c - 1.0) * q * sin(phi);
    v[8] = sqrt(30.0 / M_PI) * (c * c - c) * sin(2.0 * phi);
    v[9] = 2.0 * sqrt(35.0 / M_PI) * q * q * q * cos(3.0 * phi);
    v[10] = sqrt(210.0 / M_PI) * (2.0 * c - 1.0) * (c * c - c) * cos(2.0 * phi);
    v[11] = 2.0 * sqrt(21.0 / M_PI) * q * (1.0 - 5.0 * c + 5.0 * c * c) * cos(phi);
    v[12] = sqrt(7.0 / (2.0 * M_PI)) * (((20.0 * c - 30.0) * c + 12.0) * c - 1.0);
    v[13] = 2.0 * sqrt(21.0 / M_PI) * q * (1.0 - 5.0 * c + 5.0 * c * c) * sin(phi);
    v[14] = sqrt(210.0 / M_PI) * (2.0 * c - 1.0) * (c * c - c) * sin(2.0 * phi);
    v[15] = 2.0 * sqrt(35.0 / M_PI) * q * q * q * sin(3.0 * phi);
}

static void sh(vec3 l, double v[9])
{
    const double a = 0.5 * sqrt(3.0 / M_PI), b = 0.5 * sqrt(15.0 / M_PI);
    v[0] = 0.5 / sqrt(M_PI);
    v[1] = a * l.y;
    v[2] = a * l.z;
    v[3] = a * l.x;
    v[4] = b * l.x * l.y;
    v[5] = b * l.y * l.z;
    v[6] = 0.25 * sqrt(5.0 / M_PI) * (3.0 * l.z * l.z - 1.0);
    v[7] = b * l.x * l.z;
    v[8] = 0.5 * b * (l.x * l.x - l.y * l.y);
}

// Weights of a thousandth and less are dropped.
static void gauss(const struct functions *f, vec3 l, double *v)
{
    double sum = 0.0, kept = 0.0, nearest = 1e300;
    int best = 0;
    for (int i = 0; i < f->count; i++) {
        const vec3 d = vec3_sub(l, f->lights[i]);
        const double squared = vec3_dot(d, d);
        if (squared < nearest) {
            nearest = squared;
            best = i;
        }
        v[i] = squared / (f->sigma * f->sigma);
    }
    // relative to the nearest, so that a narrow Gaussian far away from all lights is no 0 / 0
    const double least = v[best];
    for (int i = 0; i < f->count; i++) {
        v[i] = exp(least - v[i]);
        sum += v[i];
    }
    for (int i = 0; i < f->count; i++) {
        v[i] = v[i] / sum > 0.001 ? v[i] : 0.0;
        kept += v[i];
    }
    for (int i = 0; i < f->count; i++)
        v[i] = kept > 0.0 ? v[i] / kept : (double)(i == best);
}

static void grid(int side, vec3 l, double *v)
{
    const double s = fabs(l.x) + fabs(l.y) + fabs(l.z);
    const double u = ((l.x + l.y) / s + 1.0) / 2.0 * (side - 1);
    const double w = ((l.y - l.x) / s + 1.0) / 2.0 * (side - 1);
    memset(v, 0, (size_t)(side * side) * sizeof *v);
    if (side == 1)
        v[0] = 1.0;
    else
        bilinear_spread(v, side, u, w);
}

void functions_at(const struct functions *f, struct relume_vec3 light, double *values)
{
    double all[FUNCTIONS_MOST_OWN];
    switch (f->kind) {
    case FUNCTIONS_GAUSS: gauss(f, light, values); return;
    case FUNCTIONS_GRID: grid(f->resolution, light, values); return;
    case FUNCTIONS_PTM: ptm(light, all); break;
    case FUNCTIONS_HSH: hsh(light, all); break;
    case FUNCTIONS_SH: sh(light, all); break;
    }
    memcpy(values, all, (size_t)f->count * sizeof *values);
}

struct relume_vec3 functions_grid_node(int resolution, int i)
{
    const double step = resolution > 1 ? 2.0 / (resolution - 1) : 0.0;
    const double p = (i % resolution) * step - 1.0, q = (i / resolution) * step - 1.0;
    const double x = (p - q) / 2.0, y = (p + q) / 2.0;
    return vec3_unit(vec3_of(x, y, fmax(0.0, 1.0 - fabs(x) - fabs(y))));
}
