// basis.c - what lights become: weights of any basis (coder.h), or of wavelets on a cube
#include "world/baked/baked.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/bilinear.h"
#include "core/math/haar.h"

#include <relume/image/directions.h>
#include <string.h>

// ---------------------------------------------------------------- the cube

enum { FACES = 6 };

static double component(vec3 d, int axis)
{
    return axis == 0 ? d.x : axis == 1 ? d.y : d.z;
}

// Face 2 k looks along +x, +y or +z, 2 k + 1 the other way; (a, b) in [-1, 1] lie along the two
// axes that follow.
static vec3 cube_direction(int face, double a, double b)
{
    const double s = face % 2 ? -1.0 : 1.0;
    const int axis = face / 2;
    return vec3_unit(axis == 0   ? vec3_of(s, a, b)
                     : axis == 1 ? vec3_of(b, s, a)
                                 : vec3_of(a, b, s));
}

static int cube_face(double at[2], vec3 d)
{
    const double x = fabs(d.x), y = fabs(d.y), z = fabs(d.z);
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    const double along = component(d, axis);
    at[0] = component(d, (axis + 1) % 3) / fabs(along);
    at[1] = component(d, (axis + 2) % 3) / fabs(along);
    return 2 * axis + (along < 0.0);
}

static size_t cube_texel(int side, int face, int column, int row)
{
    return ((size_t)face * (size_t)side + (size_t)row) * (size_t)side + (size_t)column;
}

static double texel_middle(int side, int i)
{
    return (i + 0.5) * 2.0 / side - 1.0;
}

// A texel beside a face is that of the next face which lies in its direction.
static size_t cube_around(int side, int face, int column, int row)
{
    double at[2];
    if (column >= 0 && row >= 0 && column < side && row < side)
        return cube_texel(side, face, column, row);
    const int other =
        cube_face(at, cube_direction(face, texel_middle(side, column), texel_middle(side, row)));
    const int i = index_clamped(relume_whole(floor((at[0] + 1.0) * 0.5 * side)), side);
    const int j = index_clamped(relume_whole(floor((at[1] + 1.0) * 0.5 * side)), side);
    return cube_texel(side, other, i, j);
}

static void cube_add(float *weights, int side, vec3 direction, const float rgb[3])
{
    const size_t count = (size_t)(FACES * side * side);
    double at[2];
    const int face = cube_face(at, direction);
    const double x = (at[0] + 1.0) * 0.5 * side - 0.5, y = (at[1] + 1.0) * 0.5 * side - 0.5;
    const int left = relume_whole(floor(x)), top = relume_whole(floor(y));
    for (int k = 0; k < 4; k++) {
        const double wx = k % 2 ? x - left : 1.0 - (x - left);
        const double wy = k / 2 ? y - top : 1.0 - (y - top);
        const size_t to = cube_around(side, face, left + k % 2, top + k / 2);
        for (size_t c = 0; c < 3; c++)
            weights[c * count + to] += (float)(wx * wy) * rgb[c];
    }
}

// ---------------------------------------------------------------- the basis

static void cube_directions(struct baked_basis *b)
{
    for (int face = 0; face < FACES; face++)
        for (int j = 0; j < b->cube; j++)
            for (int i = 0; i < b->cube; i++)
                b->direction[cube_texel(b->cube, face, i, j)] =
                    cube_direction(face, texel_middle(b->cube, i), texel_middle(b->cube, j));
}

static relume_status basis_coder(struct baked_basis *b, const struct relume_basis *basis,
                                 const struct relume_log *log)
{
    relume_status status =
        relume_directions_make(b->direction, b->directions, relume_pattern_find("spiral"),
                               relume_directions_params(.log = log, .pole_y = true));
    return status ? status
                  : relume_coder_create(&b->coder, basis, b->direction, b->directions,
                                        relume_coder_params(.log = log, .coefficients = b->count,
                                                            .pole_y = true, .no_ridge = true));
}

relume_status basis_make(struct baked_basis *out, const struct relume_basis *basis, int count,
                         int cube, int directions, const struct relume_log *log)
{
    *out = (struct baked_basis){.count = cube ? FACES * cube * cube : count,
                                .cube = cube,
                                .directions = cube ? FACES * cube * cube : directions};
    out->direction = mem_array((size_t)out->directions, sizeof *out->direction);
    if (!out->direction)
        return RELUME_ENOMEM;
    if (!cube)
        return basis_coder(out, basis, log);
    cube_directions(out);
    return RELUME_OK;
}

void basis_free(struct baked_basis *b)
{
    relume_coder_destroy(&b->coder);
    mem_free(b->direction);
    b->direction = NULL;
}

static void transform(float *data, int cube, size_t step)
{
    const size_t face = (size_t)(cube * cube);
    for (size_t i = 0; i < FACES; i++)
        haar_square(data + i * face * step, cube, step, false);
}

// [directions][views][3] to [views][directions][3], each channel in wavelets.
static void analyse_cube(float *out, const struct baked_basis *b, const float *samples, int views)
{
    const size_t n = (size_t)b->count, v = (size_t)views;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < v; j++)
            memcpy(out + 3 * (j * n + i), samples + 3 * (i * v + j), 3 * sizeof *out);
    for (size_t j = 0; j < v; j++)
        for (size_t c = 0; c < 3; c++)
            transform(out + 3 * j * n + c, b->cube, 3);
}

relume_status basis_analyse(float *out, const struct baked_basis *b, float *samples, int views)
{
    const size_t n = (size_t)b->count, v = (size_t)views;
    if (b->cube) {
        analyse_cube(out, b, samples, views);
        return RELUME_OK;
    }
    float *planes = mem_array(3 * n * v, sizeof *planes);
    relume_status status =
        planes ? relume_coder_apply(b->coder, samples, 3 * v, v, planes, v) : RELUME_ENOMEM;
    for (size_t j = 0; j < v && !status; j++)
        for (size_t k = 0; k < 3 * n; k++)
            out[3 * n * j + k] = planes[k * v + j];
    mem_free(planes);
    return status;
}

void basis_add(float *weights, const struct baked_basis *b, vec3 direction, const float rgb[3])
{
    enum { SHORT = 512 };
    if (b->cube) {
        cube_add(weights, b->cube, direction, rgb);
        return;
    }
    const size_t n = (size_t)b->count;
    float few[3 * SHORT], constant[3], *one = n <= SHORT ? few : mem_array(3 * n, sizeof *one);
    if (!one)
        return;
    relume_coder_weights(b->coder, direction, one, constant);
    for (size_t c = 0; c < 3; c++)
        for (size_t k = 0; k < n; k++)
            weights[c * n + k] += one[c * n + k] * rgb[c];
    if (one != few)
        mem_free(one);
}

void basis_finish(float *weights, const struct baked_basis *b)
{
    for (size_t c = 0; c < 3 && b->cube; c++)
        transform(weights + c * (size_t)b->count, b->cube, 1);
}
