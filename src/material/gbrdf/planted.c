// planted.c - plateaus of a brushed metal, turned differently in each quarter, over ground of which
// one half is glossy and the other dusty
//
// Nothing in it is matte and even, since depth is found by texture: the diffuse colour is spotted.
#include "material/gbrdf/planted.h"

#include "core/base/half.h"
#include "core/math/random.h"
#include "core/math/scalar.h"

enum { BRUSHED, GLOSSY, DUSTY };

static const double PLATEAU = 0.05;  // widths of the sample, from the ground to the top
static const double SPOT = 3.0;      // texels from spot to spot

// Smooth noise in [0, 1].
static double noise(double x, double y, int width, int height, uint64_t seed)
{
    const int across = larger_of(1, (int)(width / SPOT)), down = larger_of(1, (int)(height / SPOT));
    const double u = x * across / width, v = y * down / height;
    const int i = (int)u, j = (int)v;
    double corner[4];
    for (int k = 0; k < 4; k++) {
        struct random r =
            random_stream(seed, (uint64_t)((i + k % 2) % across), (uint64_t)((j + k / 2) % down));
        corner[k] = random_next(&r);
    }
    const double s = smoothstep(0.0, 1.0, u - i), t = smoothstep(0.0, 1.0, v - j);
    return (corner[0] * (1.0 - s) + corner[1] * s) * (1.0 - t) +
           (corner[2] * (1.0 - s) + corner[3] * s) * t;
}

// What shines of a material: (x, y) of the micro-normal over its z.
static double shape(int material, double x, double y)
{
    const double r2 = x * x + y * y;
    switch (material) {
    case BRUSHED:  // leaning to +x, so that no turn but the whole one maps it to itself
        return exp(-0.5 * (pow((x - 0.25) / 0.3, 2) + pow(y / 0.12, 2)));
    case GLOSSY: return exp(-0.5 * r2 / (0.18 * 0.18));
    default: return 0.3 + exp(-0.5 * r2 / (0.6 * 0.6));
    }
}

static void plant_ndf(uint16_t *to, int material)
{
    // the integrals over the hemisphere: cs of each colour
    static const double share[PLANTED_MATERIALS][3] = {
        {0.23, 0.18, 0.10}, {0.22, 0.22, 0.22}, {0.12, 0.14, 0.18}};
    double sum = 0.0;
    for (int step = 0; step < 2; step++)
        for (int j = 0; j < NDF_SIDE; j++)
            for (int i = 0; i < NDF_SIDE; i++) {
                vec3 h;
                ndf_direction(i, j, NDF_SIDE, &h);
                // cells off the disc go on as its rim, for what is interpolated there
                const double z = fmax(h.z, 0.05), value = shape(material, h.x / z, h.y / z);
                if (!step && h.z > 0.0)
                    sum += value * ndf_solid_angle((1.0 - h.z) / (1.0 + h.z), NDF_SIDE);
                for (int c = 0; step && c < 3; c++)
                    to[3 * (j * NDF_SIDE + i) + c] =
                        half_from_float((float)(share[material][c] * value / sum));
            }
}

static void plant_texel(struct gbrdf_maps *maps, int x, int y, uint64_t seed)
{
    static const double color[PLANTED_MATERIALS][3] = {
        {0.20, 0.12, 0.06}, {0.12, 0.22, 0.42}, {0.5, 0.42, 0.36}};
    static const double r0[PLANTED_MATERIALS] = {0.8, 0.15, 0.3};
    const size_t at = (size_t)y * (size_t)maps->width + (size_t)x;
    const double u = (x + 0.5) / maps->width, v = (y + 0.5) / maps->height;
    const double swell = sin(2.0 * M_PI * u) * sin(2.0 * M_PI * v);
    const double rise = smoothstep(-0.5, 0.6, fabs(swell) * 2.0 - 1.0);
    const int label = rise > 0.5 ? BRUSHED : v < 0.5 ? GLOSSY : DUSTY;
    const double spot = noise(x, y, maps->width, maps->height, seed);
    maps->depth[at] = (float)(PLATEAU * (rise - 0.5));
    maps->label[at] = (uint8_t)label;
    maps->r0[at] = half_from_float((float)r0[label]);
    maps->rotation[at] =
        half_from_float(label == BRUSHED ? (float)(0.6 + 1.5 * ((u < 0.5) + 2 * (v < 0.5))) : 0.0f);
    for (int c = 0; c < 3; c++)
        maps->diffuse[3 * at + (size_t)c] =
            half_from_float((float)(color[label][c] * (0.25 + 1.1 * spot)));
}

void gbrdf_plant(struct gbrdf_maps *maps, uint64_t seed)
{
    for (int y = 0; y < maps->height; y++)
        for (int x = 0; x < maps->width; x++)
            plant_texel(maps, x, y, seed);
    for (int k = 0; k < PLANTED_MATERIALS; k++)
        plant_ndf(maps->ndf + (size_t)k * NDF_VALUES, k);
    *maps->light = 1.0f;
    gbrdf_limit_energy(maps);
}
