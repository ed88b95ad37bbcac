// texture.c - procedural colours on gradient noise (Perlin 2002), and bilinear pictures
//
// Wood is distance rings about an axis bent by noise, marble a sine of a coordinate bent by
// turbulence (Ebert et al. 1994). Lattice gradients come from a hash, so there is no table.
#include "world/stage/texture.h"

#include "core/math/bilinear.h"
#include "core/math/random.h"

#include <math.h>

static float mixed(float a, float b, float t)
{
    return a + (b - a) * t;
}

static void mix_color(const struct texture *t, float amount, float out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = mixed(t->a[c], t->b[c], amount);
}

static float clamp01(float x)
{
    return fminf(fmaxf(x, 0.0f), 1.0f);
}

static float smooth_step(float low, float high, float x)
{
    const float t = clamp01((x - low) / (high - low));
    return t * t * (3.0f - 2.0f * t);
}

static uint64_t lattice_hash(int x, int y, int z)
{
    return random_mix((uint64_t)(uint32_t)x | (uint64_t)(uint32_t)y << 32) ^
           random_mix(0x51ed27u + (uint64_t)(uint32_t)z);
}

static float lattice_value(int x, int y, int z)
{
    return (float)(random_mix(lattice_hash(x, y, z)) >> 40) * 0x1p-24f;
}

// One of the twelve edge directions of a cube, dotted with the offset.
static float gradient_dot(int x, int y, int z, float dx, float dy, float dz)
{
    const unsigned h = (unsigned)(random_mix(lattice_hash(x, y, z)) >> 60);
    const float u = h < 8 ? dx : dy;
    const float v = h < 4 ? dy : h == 12 || h == 14 ? dx : dz;
    return ((h & 1) ? -u : u) + ((h & 2) ? -v : v);
}

static float fade(float t)
{
    return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

float noise_at(float x, float y, float z)
{
    const float fx = floorf(x), fy = floorf(y), fz = floorf(z);
    const float dx = x - fx, dy = y - fy, dz = z - fz;
    const int ix = relume_whole(fx), iy = relume_whole(fy), iz = relume_whole(fz);
    float row[2][2];
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 2; j++)
            row[k][j] =
                mixed(gradient_dot(ix, iy + j, iz + k, dx, dy - (float)j, dz - (float)k),
                      gradient_dot(ix + 1, iy + j, iz + k, dx - 1.0f, dy - (float)j, dz - (float)k),
                      fade(dx));
    return mixed(mixed(row[0][0], row[0][1], fade(dy)), mixed(row[1][0], row[1][1], fade(dy)),
                 fade(dz));
}

float noise_sum(float x, float y, float z, int octaves)
{
    float sum = 0.0f, size = 1.0f;
    for (int i = 0; i < octaves; i++) {
        sum += noise_at(x / size, y / size, z / size) * size;
        size *= 0.5f;
    }
    return sum;
}

void texture_plain(const struct texture *t, const float at[3], float out[3])
{
    (void)at;
    mix_color(t, 0.0f, out);
}

void texture_checker(const struct texture *t, const float at[3], float out[3])
{
    // Faces that lie exactly on a cell border must not flicker between two cells.
    const float inside = 1e-4f;
    int parity = 0;
    for (int i = 0; i < 3; i++)
        parity += relume_whole(floorf(at[i] * t->scale + inside));
    mix_color(t, (float)(parity & 1), out);
}

void texture_wood(const struct texture *t, const float at[3], float out[3])
{
    const float x = at[0] * t->scale, y = at[1] * t->scale, z = at[2] * t->scale;
    const float bend = 0.35f * noise_sum(0.15f * x, 0.6f * y, 0.6f * z, 2);
    const float ring = (hypotf(y + 0.4f, z + 0.3f) + bend) * 4.0f;
    const float late = ring - floorf(ring);
    const float grain = noise_sum(1.5f * x, 40.0f * y, 40.0f * z, 2);
    mix_color(t, clamp01(late * late * late * 0.8f + 0.15f + 0.18f * grain), out);
}

void texture_marble(const struct texture *t, const float at[3], float out[3])
{
    const float x = at[0] * t->scale, y = at[1] * t->scale, z = at[2] * t->scale;
    const float wave = sinf(2.2f * (x + 0.6f * y + 0.8f * z) + 4.5f * noise_sum(x, y, z, 5));
    const float vein = 1.0f - fabsf(wave);
    mix_color(t,
              clamp01(0.12f + 0.1f * noise_sum(3.0f * x, 3.0f * y, 3.0f * z, 3) +
                      0.9f * vein * vein * vein * vein * vein),
              out);
}

void texture_plaster(const struct texture *t, const float at[3], float out[3])
{
    const float x = at[0] * t->scale, y = at[1] * t->scale, z = at[2] * t->scale;
    mix_color(t, smooth_step(-0.5f, 0.7f, noise_sum(x, y, z, 5)), out);
}

void texture_bricks(const struct texture *t, const float at[3], float out[3])
{
    const float row = floorf(at[1] * t->scale * 2.0f);
    const float along = (fabsf(at[0]) > fabsf(at[2]) ? at[2] : at[0]) * t->scale + 0.5f * row;
    const float u = along - floorf(along), v = at[1] * t->scale * 2.0f - row;
    const float joint = fmaxf(fabsf(u - 0.5f) - 0.46f, 0.5f * (fabsf(v - 0.5f) - 0.42f));
    const float tone = 0.75f +
                       0.5f * lattice_value(relume_whole(floorf(along)), relume_whole(row), 7) +
                       0.25f * noise_sum(6.0f * at[0], 6.0f * at[1], 6.0f * at[2], 3);
    const float brick = joint < 0.0f ? 1.0f : 0.0f;
    for (int c = 0; c < 3; c++)
        out[c] = clamp01(mixed(t->a[c], t->b[c] * tone, brick));
}

static const float *texel(const struct relume_image *image, int x, int y)
{
    x = index_wrapped(x, image->width);
    y = index_wrapped(y, image->height);
    return image->data + ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
}

void texture_image(const struct texture *t, const float at[3], float out[3])
{
    const float u = at[0] - floorf(at[0]), v = at[1] - floorf(at[1]);
    const float x = u * (float)t->image->width - 0.5f;
    const float y = (1.0f - v) * (float)t->image->height - 0.5f;
    const int ix = relume_whole(floorf(x)), iy = relume_whole(floorf(y));
    const float fx = x - (float)ix, fy = y - (float)iy;
    const float *p00 = texel(t->image, ix, iy), *p10 = texel(t->image, ix + 1, iy);
    const float *p01 = texel(t->image, ix, iy + 1), *p11 = texel(t->image, ix + 1, iy + 1);
    for (int c = 0; c < 3; c++)
        out[c] = mixed(mixed(p00[c], p10[c], fx), mixed(p01[c], p11[c], fx), fy);
}
