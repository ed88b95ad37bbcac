// Surfaces of volumes: known shapes, no cracks, dikes and boxes against slow definitions.
#include "core/base/memory.h"
#include "shape/volume/block.h"
#include "shape/volume/climb.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const int all_blocks[RELUME_ISOSURFACE_LEVELS] = {1, 2, 4, 8, 16};

// ---------------------------------------------------------------- fields

typedef float field(float x, float y, float z);  // in [-1, 1]

static float sphere(float x, float y, float z)
{
    return 0.7f - sqrtf(x * x + y * y + z * z);
}

static float torus(float x, float y, float z)
{
    const float q = sqrtf(x * x + y * y) - 0.55f;
    return 0.27f - sqrtf(q * q + z * z);
}

static float gyroid(float x, float y, float z)
{
    const float k = 4.5f;
    return sinf(k * x) * cosf(k * y) + sinf(k * y) * cosf(k * z) + sinf(k * z) * cosf(k * x);
}

static float noise(float x, float y, float z)
{
    (void)x, (void)y, (void)z;
    static uint32_t state = 7;
    state = state * 1664525u + 1013904223u;
    return (float)(state >> 8) / 16777216.0f - 0.5f;
}

static relume_volume *volume_of(field *f, int nx, int ny, int nz)
{
    float *sample = malloc((size_t)nx * (size_t)ny * (size_t)nz * sizeof *sample), *to = sample;
    relume_volume *volume;
    const float longest = (float)(nx > ny ? (nx > nz ? nx : nz) : ny > nz ? ny : nz) - 1.0f;
    for (int z = 0; z < nz; z++)
        for (int y = 0; y < ny; y++)
            for (int x = 0; x < nx; x++)
                *to++ = f((2.0f * (float)x - (float)(nx - 1)) / longest,
                          (2.0f * (float)y - (float)(ny - 1)) / longest,
                          (2.0f * (float)z - (float)(nz - 1)) / longest);
    assert_int_equal(relume_volume_from(&volume, sample,
                                        relume_volume_params(.size = {nx, ny, nz}, .type = "f32")),
                     RELUME_OK);
    free(sample);
    return volume;
}

// ---------------------------------------------------------------- what a mesh is

// Edges by their ends, the lower first, and which way they are gone along.
static int compare(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

struct topology {
    size_t open;     // edges that are not gone along as often both ways, within the volume
    size_t crowded;  // edges of more than two triangles
    long euler;
};

static bool on_border(const struct relume_mesh *m, const int size[3], uint32_t a, uint32_t b)
{
    for (int c = 0; c < 3; c++) {
        const float p = m->position[a][c], q = m->position[b][c], end = (float)size[c] - 1.0f;
        if ((p == 0.0f && q == 0.0f) || (p == end && q == end))
            return true;
    }
    return false;
}

static struct topology topology_of(const struct relume_mesh *m, const int size[3])
{
    const size_t count = 3 * m->triangle_count;
    uint64_t *edge = malloc((count + 1) * sizeof *edge);
    struct topology t = {.euler = (long)m->vertex_count + (long)m->triangle_count};
    for (size_t i = 0; i < count; i++) {
        const uint32_t a = m->triangle[i / 3][i % 3], b = m->triangle[i / 3][(i + 1) % 3];
        edge[i] = a < b ? (uint64_t)a << 32 | b << 1 : (uint64_t)b << 32 | a << 1 | 1;
    }
    qsort(edge, count, sizeof *edge, compare);
    for (size_t i = 0, k; i < count; i = k) {
        int way = 0;
        for (k = i; k < count && edge[k] >> 1 == edge[i] >> 1; k++)
            way += edge[k] & 1 ? 1 : -1;
        t.crowded += k - i > 2;
        t.euler--;
        t.open += way && !on_border(m, size, (uint32_t)(edge[i] >> 32), (uint32_t)edge[i] >> 1);
    }
    free(edge);
    return t;
}

// How many triangles face against the gradient at their vertices.
static size_t facing_wrong(const struct relume_mesh *m)
{
    size_t wrong = 0;
    for (size_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *v = m->triangle[i];
        float a[3], b[3], sum = 0.0f;
        for (int c = 0; c < 3; c++) {
            a[c] = m->position[v[1]][c] - m->position[v[0]][c];
            b[c] = m->position[v[2]][c] - m->position[v[0]][c];
        }
        for (int c = 0; c < 3; c++) {
            const int d = (c + 1) % 3, e = (c + 2) % 3;
            const float n = a[d] * b[e] - a[e] * b[d];
            for (int k = 0; k < 3; k++)
                sum += n * m->normal[v[k]][c];
        }
        wrong += sum < 0.0f;
    }
    return wrong;
}

static void make(struct relume_mesh mesh[RELUME_ISOSURFACE_LEVELS],
                 struct relume_isosurface_report report[RELUME_ISOSURFACE_LEVELS],
                 const relume_volume *volume, int threads)
{
    assert_int_equal(
        relume_isosurface(mesh, report, volume, 0.0,
                          relume_isosurface_params(.threads = threads, .blocks = {1, 2, 4, 8, 16})),
        RELUME_OK);
}

static void free_all(struct relume_mesh mesh[RELUME_ISOSURFACE_LEVELS])
{
    for (int i = 0; i < RELUME_ISOSURFACE_LEVELS; i++)
        relume_mesh_free(&mesh[i]);
}

// ---------------------------------------------------------------- known shapes

static void test_a_sphere_is_one(void **state)
{
    (void)state;
    const int n = 65, size[3] = {n, n, n};
    // the error grows as the square of the boxes' sides: a chord of 2^l samples is 2^(2 l) / 8 r
    // off
    const double most[RELUME_ISOSURFACE_LEVELS] = {0.02, 0.08, 0.3, 1.2, 5.0};
    const double radius = 0.7 * (n - 1) / 2.0, middle = (n - 1) / 2.0;
    relume_volume *volume = volume_of(sphere, n, n, n);
    struct relume_mesh mesh[RELUME_ISOSURFACE_LEVELS];
    make(mesh, NULL, volume, 2);
    for (int l = 0; l < RELUME_ISOSURFACE_LEVELS; l++) {
        const struct relume_mesh *m = &mesh[l];
        const struct topology t = topology_of(m, size);
        assert_int_equal(t.open, 0);
        assert_int_equal(t.crowded, 0);
        assert_int_equal(t.euler, 2);
        assert_int_equal(facing_wrong(m), 0);
        for (size_t i = 0; i < m->vertex_count; i++) {
            double square = 0.0, along = 0.0;
            for (int c = 0; c < 3; c++) {
                const double d = (double)m->position[i][c] - middle;
                square += d * d;
                along += d * (double)m->normal[i][c];
            }
            // vertices lie on lines between samples: linear there, the field is not quite
            assert_true(fabs(sqrt(square) - radius) < 0.02);
            assert_true(along / sqrt(square) > 0.999);
        }
        for (size_t i = 0; i < m->triangle_count; i++) {
            double square = 0.0;
            for (int c = 0; c < 3; c++) {
                double sum = 0.0;
                for (int k = 0; k < 3; k++)
                    sum += (double)m->position[m->triangle[i][k]][c];
                square += (sum / 3.0 - middle) * (sum / 3.0 - middle);
            }
            assert_true(fabs(sqrt(square) - radius) < most[l]);
        }
    }
    // as many as another marching cubes makes (vtkFlyingEdges3D 9.1), and a sixteenth at N = 4
    assert_int_equal(mesh[0].triangle_count, 18968);
    assert_int_equal(mesh[0].vertex_count, 9486);
    assert_true(mesh[2].triangle_count < 18968 / 12);
    free_all(mesh);
    relume_volume_destroy(&volume);
}

static void test_a_torus_has_a_hole(void **state)
{
    (void)state;
    const int size[3] = {41, 41, 30};
    relume_volume *volume = volume_of(torus, size[0], size[1], size[2]);
    struct relume_mesh mesh[RELUME_ISOSURFACE_LEVELS];
    make(mesh, NULL, volume, 2);
    for (int l = 0; l < RELUME_ISOSURFACE_LEVELS; l++) {
        const struct topology t = topology_of(&mesh[l], size);
        assert_int_equal(t.open, 0);
        assert_int_equal(t.euler, 0);
    }
    free_all(mesh);
    relume_volume_destroy(&volume);
}

// It goes through the border of the volume, and keeps its Euler number at every size of boxes.
static void test_a_gyroid_has_no_cracks(void **state)
{
    (void)state;
    const int size[3] = {49, 45, 38};
    relume_volume *volume = volume_of(gyroid, size[0], size[1], size[2]);
    struct relume_mesh mesh[RELUME_ISOSURFACE_LEVELS];
    struct relume_isosurface_report report[RELUME_ISOSURFACE_LEVELS];
    make(mesh, report, volume, 1);
    const long euler = topology_of(&mesh[0], size).euler;
    for (int l = 0; l < RELUME_ISOSURFACE_LEVELS; l++) {
        const struct topology t = topology_of(&mesh[l], size);
        assert_int_equal(t.open, 0);
        assert_int_equal(t.crowded, 0);
        assert_int_equal(t.euler, euler);
        assert_true(facing_wrong(&mesh[l]) <= mesh[l].triangle_count / 100);
        assert_true(report[l].boxes > 0 && report[l].seconds >= 0.0);
    }
    assert_true(3 * mesh[1].triangle_count < mesh[0].triangle_count);
    free_all(mesh);
    relume_volume_destroy(&volume);
}

// ---------------------------------------------------------------- cracks

static void test_noise_of_odd_sizes_has_no_cracks(void **state)
{
    (void)state;
    static const int sizes[][3] = {{28, 31, 23}, {17, 2, 35}, {66, 9, 5}, {33, 16, 17}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        relume_volume *volume = volume_of(noise, sizes[s][0], sizes[s][1], sizes[s][2]);
        struct relume_mesh mesh[RELUME_ISOSURFACE_LEVELS];
        make(mesh, NULL, volume, 2);
        for (int l = 0; l < RELUME_ISOSURFACE_LEVELS; l++) {
            assert_true(mesh[l].triangle_count > 0);
            assert_int_equal(topology_of(&mesh[l], sizes[s]).open, 0);
        }
        free_all(mesh);
        relume_volume_destroy(&volume);
    }
}

// Without shared lines the same count finds cracks, so that it would have found them above.
static void test_cracks_are_found_where_they_are(void **state)
{
    (void)state;
    const int size[3] = {28, 31, 23};
    relume_volume *volume = volume_of(noise, size[0], size[1], size[2]);
    struct signs signs;
    assert_int_equal(signs_create(&signs, volume, 0.0f, 1), RELUME_OK);
    for (int share = 0; share < 2; share++) {
        struct relume_mesh mesh = {0};
        struct relume_isosurface_report report = {0};
        assert_int_equal(climb_mesh(&mesh, &report, &signs, 8, share), RELUME_OK);
        const size_t open = topology_of(&mesh, size).open;
        assert_true(share ? open == 0 : open > 1000);
        relume_mesh_free(&mesh);
    }
    signs_free(&signs);
    relume_volume_destroy(&volume);
}

// ---------------------------------------------------------------- the same whatever

static void expect_same(const struct relume_mesh *a, const struct relume_mesh *b)
{
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->triangle_count, b->triangle_count);
    assert_memory_equal(a->position, b->position, a->vertex_count * sizeof *a->position);
    assert_memory_equal(a->normal, b->normal, a->vertex_count * sizeof *a->normal);
    assert_memory_equal(a->triangle, b->triangle, a->triangle_count * sizeof *a->triangle);
}

static void test_threads_and_indices_change_nothing(void **state)
{
    (void)state;
    relume_volume *volume = volume_of(gyroid, 47, 33, 29);
    struct relume_mesh one[RELUME_ISOSURFACE_LEVELS], other[RELUME_ISOSURFACE_LEVELS];
    make(one, NULL, volume, 1);
    for (int round = 0; round < 2; round++) {
        make(other, NULL, volume, round ? 1 : 5);
        for (int l = 0; l < RELUME_ISOSURFACE_LEVELS; l++)
            expect_same(&one[l], &other[l]);
        free_all(other);
        assert_int_equal(relume_volume_index(volume, 3), RELUME_OK);
    }
    free_all(one);
    relume_volume_destroy(&volume);
}

static void test_types_agree(void **state)
{
    (void)state;
    enum { N = 20, SAMPLES = N * N * N };
    static uint8_t bytes[SAMPLES];
    static uint16_t words[SAMPLES];
    static int16_t shorts[SAMPLES];
    static double doubles[SAMPLES];
    const void *const samples[] = {bytes, words, shorts, doubles};
    const char *const types[] = {"u8", "u16", "i16", "f64"};
    struct relume_mesh mesh[4][2];
    for (int i = 0; i < SAMPLES; i++) {
        bytes[i] = (uint8_t)(20.0f * (gyroid(0.1f * (float)(i % N), 0.1f * (float)(i / N % N),
                                             0.1f * (float)(i / N / N)) +
                                      3.0f));
        words[i] = bytes[i];
        shorts[i] = bytes[i];
        doubles[i] = bytes[i];
    }
    for (int t = 0; t < 4; t++) {
        relume_volume *volume;
        assert_int_equal(
            relume_volume_from(&volume, samples[t],
                               relume_volume_params(.size = {N, N, N}, .type = types[t])),
            RELUME_OK);
        assert_int_equal(relume_isosurface(mesh[t], NULL, volume, 60.5,
                                           relume_isosurface_params(.blocks = {1, 4})),
                         RELUME_OK);
        relume_volume_destroy(&volume);
    }
    for (int t = 0; t < 4; t++)
        for (int l = 0; l < 2; l++)
            expect_same(&mesh[t][l], &mesh[0][l]);
    for (int i = 0; i < 8; i++)
        relume_mesh_free(&mesh[i / 2][i % 2]);
}

static void test_spacing_stretches_places_and_turns_normals(void **state)
{
    (void)state;
    enum { N = 25 };
    static float sample[N * N * N];
    relume_volume *volume;
    struct relume_mesh mesh;
    for (int i = 0; i < N * N * N; i++)  // a ball of radius 9 in a world of half samples along x
        sample[i] = 9.0f - hypotf(hypotf(0.5f * (float)(i % N - 12), (float)(i / N % N - 12)),
                                  (float)(i / N / N - 12));
    assert_int_equal(relume_volume_from(&volume, sample,
                                        relume_volume_params(.size = {N, N, N}, .type = "f32",
                                                             .spacing = {0.5, 1.0, 1.0})),
                     RELUME_OK);
    assert_int_equal(relume_isosurface(&mesh, NULL, volume, 0.0, NULL), RELUME_OK);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        const float *p = mesh.position[i], *n = mesh.normal[i];
        const float d[3] = {p[0] - 6.0f, p[1] - 12.0f, p[2] - 12.0f};
        const float r = hypotf(hypotf(d[0], d[1]), d[2]);
        assert_true(fabsf(r - 9.0f) < 0.02f);
        const bool border = p[0] < 0.5f || p[0] > 11.5f;  // one-sided there
        assert_true(border || (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]) / r > 0.998f);
    }
    relume_mesh_free(&mesh);
    relume_volume_destroy(&volume);
}

// ---------------------------------------------------------------- no surface

// The sum of squares within both kinds, in two passes.
static double within(const uint8_t *sample, int count, double threshold)
{
    double mean[2] = {0}, sum = 0.0;
    int n[2] = {0};
    for (int i = 0; i < count; i++) {
        mean[sample[i] >= threshold] += sample[i];
        n[sample[i] >= threshold]++;
    }
    if (!n[0] || !n[1])
        return INFINITY;
    for (int k = 0; k < 2; k++)
        mean[k] /= n[k];
    for (int i = 0; i < count; i++) {
        const double d = sample[i] - mean[sample[i] >= threshold];
        sum += d * d;
    }
    return sum;
}

static double threshold_of(const void *sample, const char *type)
{
    relume_volume *volume;
    assert_int_equal(
        relume_volume_from(&volume, sample, relume_volume_params(.size = {10, 9, 8}, .type = type)),
        RELUME_OK);
    const double threshold = relume_volume_threshold(volume);
    relume_volume_destroy(&volume);
    return threshold;
}

// No other threshold leaves kinds that vary less; between two kinds it is in the middle.
static void test_the_threshold_of_two_kinds(void **state)
{
    (void)state;
    uint8_t sample[720];
    float far[720];
    for (int i = 0; i < 720; i++) {
        sample[i] = (uint8_t)(90.0f + (i % 3 ? 30.0f : 110.0f) * (0.5f + noise(0, 0, 0)));
        far[i] = i % 5 ? -2.0f : 6.0f;
    }
    const double found = threshold_of(sample, "u8");
    double best = INFINITY;
    for (int t = 1; t < 256; t++)
        best = fmin(best, within(sample, 720, t - 0.5));
    assert_true(within(sample, 720, found) <= best * (1.0 + 1e-9));
    assert_true(fabs(threshold_of(far, "f32") - 2.0) < 8.0 / 1023);
}

static void test_thresholds_beyond_the_values(void **state)
{
    (void)state;
    relume_volume *volume = volume_of(sphere, 12, 12, 12);
    struct relume_mesh mesh[2];
    const double beyond[] = {-5.0, 5.0};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(relume_isosurface(mesh, NULL, volume, beyond[i],
                                           relume_isosurface_params(.blocks = {1, 8})),
                         RELUME_OK);
        for (int l = 0; l < 2; l++) {
            assert_int_equal(mesh[l].triangle_count + mesh[l].vertex_count, 0);
            relume_mesh_free(&mesh[l]);
        }
    }
    assert_int_equal(relume_isosurface(mesh, NULL, volume, (double)NAN, NULL), RELUME_EINVAL);
    assert_int_equal(
        relume_isosurface(mesh, NULL, volume, 0.0, relume_isosurface_params(.blocks = {3})),
        RELUME_EINVAL);
    assert_int_equal(
        relume_isosurface(mesh, NULL, volume, 0.0, relume_isosurface_params(.blocks = {32})),
        RELUME_EINVAL);
    relume_volume_destroy(&volume);
}

// Whichever allocation fails, nothing is made and nothing is lost (the sanitizers look).
static void test_memory_that_runs_out(void **state)
{
    (void)state;
    enum { N = 9 };
    float sample[N * N * N];
    relume_status status = RELUME_ENOMEM;
    for (int i = 0; i < N * N * N; i++)
        sample[i] = noise(0, 0, 0);
    for (long n = 1; status; n++) {
        relume_volume *volume;
        struct relume_mesh mesh[2] = {{0}};
        mem_fail_after(n);
        status = relume_volume_from(&volume, sample,
                                    relume_volume_params(.size = {N, N, N}, .type = "f32"));
        if (!status)
            status = relume_volume_index(volume, 1);
        if (!status)
            status = relume_isosurface(mesh, NULL, volume, 0.0,
                                       relume_isosurface_params(.threads = 1, .blocks = {1, 4}));
        mem_fail_after(0);
        assert_true(status == RELUME_OK || status == RELUME_ENOMEM);
        for (int l = 0; l < 2; l++) {
            assert_true(!status == (mesh[l].triangle_count > 0));
            relume_mesh_free(&mesh[l]);
        }
        relume_volume_destroy(&volume);
    }
}

// ---------------------------------------------------------------- dikes and boxes

static int crossings(const bool *sample, int begin, int length)
{
    int n = 0;
    for (int i = begin; i < begin + length; i++)
        n += sample[i] != sample[i + 1];
    return n;
}

// Every pattern of nine samples, along each axis, against counting; and the digest's line.
static void test_dikes_of_every_pattern(void **state)
{
    (void)state;
    struct block *b = calloc(1, sizeof *b);
    b->side = 8;
    b->levels = 3;
    for (int pattern = 0; pattern < 512; pattern++) {
        bool sample[9];
        for (int cells = 5; cells <= 8; cells += 3) {  // whole, and cut short
            for (int axis = 0; axis < 3; axis++) {
                memset(b->row, 0, sizeof b->row);
                for (int c = 0; c < 3; c++)
                    b->cells[c] = c == axis ? cells : 1;
                for (int i = 0; i < 9; i++)
                    sample[i] = pattern >> i & 1;
                for (int i = 0; i <= cells; i++)
                    for (int k = 0; k < 4; k++) {
                        int p[3] = {0};
                        p[axis] = i;
                        p[(axis + 1) % 3] = k & 1;
                        p[(axis + 2) % 3] = k >> 1;
                        b->row[p[2] * BLOCK_POINTS + p[1]] |= (uint32_t)sample[i] << p[0];
                    }
                (void)block_climb(b);
                for (int l = 0; l <= 3; l++)
                    for (int at = 0; at < cells; at += 1 << l) {
                        const bool simple =
                            at + (1 << l) <= cells && crossings(sample, at, 1 << l) <= 1;
                        const uint32_t mask = axis == 0   ? b->along_x[l][0][0] >> at
                                              : axis == 1 ? b->along_y[l][0][at]
                                                          : b->along_z[l][0][at];
                        assert_int_equal(mask & 1, !simple);
                    }
            }
        }
    }
    free(b);
}

// Boxes tile the block, each is of dikes, and every line in it is crossed at most once.
static void expect_simple(const struct block *b, const struct box *r)
{
    const int from[3] = {r->at[0], r->at[1], r->at[2]};
    const int to[3] = {from[0] + (1 << r->level[0]), from[1] + (1 << r->level[1]),
                       from[2] + (1 << r->level[2])};
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        assert_int_equal(from[axis] % (1 << r->level[axis]), 0);
        assert_true(to[axis] <= b->cells[axis]);
        for (int j = from[v]; j <= to[v]; j++)
            for (int i = from[u]; i <= to[u]; i++) {
                bool sample[BLOCK_POINTS];
                int p[3];
                p[u] = i;
                p[v] = j;
                for (p[axis] = from[axis]; p[axis] <= to[axis]; p[axis]++)
                    sample[p[axis]] = block_inside(b, p);
                assert_true(crossings(sample, from[axis], to[axis] - from[axis]) <= 1);
            }
    }
}

static void test_boxes_tile_their_block(void **state)
{
    (void)state;
    field *const fields[] = {noise, gyroid, torus};
    struct block *b = malloc(sizeof *b);
    for (int f = 0; f < 3; f++) {
        relume_volume *volume = volume_of(fields[f], 30, 27, 21);
        struct signs signs;
        assert_int_equal(signs_create(&signs, volume, 0.0f, 1), RELUME_OK);
        for (int l = 1; l < RELUME_ISOSURFACE_LEVELS; l++) {
            const int side = all_blocks[l];
            int covered = 0;
            block_load(b, &signs, side, (const int[3]){29 / side / 2, 0, 20 / side / 2});
            (void)block_climb(b);
            for (int z = 0; z < b->cells[2]; z++)
                for (int y = 0; y < b->cells[1]; y++)
                    for (int x = 0; x < b->cells[0]; x++) {
                        struct box r = {{(uint8_t)x, (uint8_t)y, (uint8_t)z}, {0}};
                        const box_owner own = *block_owner(b->owner, side, x, y, z);
                        assert_true(own > 0);
                        owner_levels(r.level, own);
                        if (x & ((1 << r.level[0]) - 1) || y & ((1 << r.level[1]) - 1) ||
                            z & ((1 << r.level[2]) - 1))
                            continue;
                        expect_simple(b, &r);
                        covered += 1 << (r.level[0] + r.level[1] + r.level[2]);
                    }
            assert_int_equal(covered, b->cells[0] * b->cells[1] * b->cells[2]);
        }
        signs_free(&signs);
        relume_volume_destroy(&volume);
    }
    free(b);
}

// Progress that ascends, until it is stopped at the n-th call.
struct stop {
    int calls, at;
    double last;
};

static bool stops(void *user, const char *what, double done)
{
    struct stop *s = user;
    assert_true(strlen(what) > 0 && done >= 0.0 && done <= 1.0 && done >= s->last);
    s->last = done;
    return ++s->calls != s->at;
}

static void test_it_can_be_stopped(void **state)
{
    (void)state;
    relume_volume *v = volume_of(gyroid, 33, 33, 33);
    for (int at = 0, last = 1; at <= last; at++) {
        struct stop stop = {.at = at};
        const struct relume_log log = {.progress = stops, .user = &stop};
        struct relume_mesh mesh[3] = {{0}};
        const relume_status status = relume_isosurface(
            mesh, NULL, v, 0.0,
            relume_isosurface_params(.log = &log, .threads = 1, .blocks = {1, 4, 8}));
        assert_int_equal(status, at ? RELUME_ECANCEL : RELUME_OK);
        last = at ? last : stop.calls;
        for (int i = 0; i < 3; i++) {
            assert_true((mesh[i].position != NULL) == !at);
            relume_mesh_free(&mesh[i]);
        }
    }
    relume_volume_destroy(&v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dikes_of_every_pattern),
        cmocka_unit_test(test_boxes_tile_their_block),
        cmocka_unit_test(test_it_can_be_stopped),
        cmocka_unit_test(test_a_sphere_is_one),
        cmocka_unit_test(test_a_torus_has_a_hole),
        cmocka_unit_test(test_a_gyroid_has_no_cracks),
        cmocka_unit_test(test_noise_of_odd_sizes_has_no_cracks),
        cmocka_unit_test(test_cracks_are_found_where_they_are),
        cmocka_unit_test(test_threads_and_indices_change_nothing),
        cmocka_unit_test(test_types_agree),
        cmocka_unit_test(test_spacing_stretches_places_and_turns_normals),
        cmocka_unit_test(test_the_threshold_of_two_kinds),
        cmocka_unit_test(test_thresholds_beyond_the_values),
        cmocka_unit_test(test_memory_that_runs_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
