// relief.c - surfaces of materials: height and colour over a periodic unit square
#include "world/stage/relief.h"

#include "core/math/random.h"

#include <math.h>

static uint64_t lattice(int x, int y, int across, int along, uint64_t seed)
{
    const uint64_t i = (uint64_t)((x % across + across) % across);
    const uint64_t j = (uint64_t)((y % along + along) % along);
    return random_mix(random_mix(seed ^ i << 32) ^ j);
}

static double unit(uint64_t hash)
{
    return (double)(hash >> 11) * 0x1p-53;
}

static double slope(uint64_t hash, double dx, double dy)
{
    const double phi = 2.0 * M_PI * unit(hash);
    return cos(phi) * dx + sin(phi) * dy;
}

static double fade(double t)
{
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

double relief_mix(double a, double b, double t)
{
    return a + (b - a) * t;
}

double relief_round(double x, double half)
{
    return sqrt(fmax(0.0, 1.0 - x * x / (half * half)));
}

void relief_color(float out[3], const float color[3], double tone)
{
    for (int c = 0; c < 3; c++)
        out[c] = fminf(fmaxf(color[c] * (float)tone, 0.0f), 1.0f);
}

double relief_noise(double u, double v, int across, int along, uint64_t seed)
{
    const double x = u * across, y = v * along, fx = floor(x), fy = floor(y);
    const int ix = relume_whole(fx), iy = relume_whole(fy);
    const double dx = x - fx, dy = y - fy;
    double row[2];
    for (int j = 0; j < 2; j++)
        row[j] = relief_mix(slope(lattice(ix, iy + j, across, along, seed), dx, dy - j),
                            slope(lattice(ix + 1, iy + j, across, along, seed), dx - 1.0, dy - j),
                            fade(dx));
    return 1.4 * relief_mix(row[0], row[1], fade(dy));
}

double relief_sum(double u, double v, int cells, int octaves, uint64_t seed)
{
    double sum = 0.0, size = 1.0;
    for (int i = 0; i < octaves; i++, size *= 0.5)
        sum += size * relief_noise(u, v, cells << i, cells << i, seed + (uint64_t)i);
    return sum;
}

double relief_scatter(double u, double v, int cells, uint64_t seed, double distance[2])
{
    const double x = u * cells, y = v * cells;
    double own = 0.0;
    distance[0] = distance[1] = INFINITY;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            const int cx = relume_whole(floor(x)) + i, cy = relume_whole(floor(y)) + j;
            const uint64_t h = lattice(cx, cy, cells, cells, seed);
            const double dx = cx + unit(h) - x, dy = cy + unit(random_mix(h)) - y;
            const double d = sqrt(dx * dx + dy * dy);
            if (d < distance[0]) {
                distance[1] = distance[0];
                distance[0] = d;
                own = unit(random_mix(h + 1));
            } else if (d < distance[1]) {
                distance[1] = d;
            }
        }
    return own;
}
