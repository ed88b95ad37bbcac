// bench_isosurface: surfaces of volumes by block size, in the form of Wong 1998, Tables 4.1 and 4.2
//
//     bench_isosurface                              a knot and a gyroid of 128^3, one thread
//     bench_isosurface make KIND N OUT              a field as N^3 floats: knot, gyroid, sphere
//     bench_isosurface volume FILE XxYxZ TYPE T     one JSON object (XxYxZ - : the file knows)
//     bench_isosurface error MESH FILE XxYxZ TYPE T how far a mesh is from the surface, in samples
//
// The error is measured from points all over the triangles, evenly by area, to the surface of the
// trilinear field, by Newton's method along the gradient.
#include "bench.h"

#include "shape/volume/volume.h"

enum { LEVELS = 4, RUNS = 5 };
static const int blocks[LEVELS] = {1, 2, 4, 8};

// Of the processor, since others may use the machine.
static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// ---------------------------------------------------------------- fields

// A tube around a trefoil; the algebraic knot of the table is not given.
static float knot(float x, float y, float z)
{
    enum { POINTS = 240 };
    static float at[POINTS][3];
    float least = 1e9f;
    for (int i = 0; i < POINTS && at[0][0] == 0.0f; i++) {
        const float t = 6.2831853f * (float)(POINTS - 1 - i) / POINTS;
        const float r = 0.5f + 0.2f * cosf(3.0f * t);
        at[POINTS - 1 - i][0] = r * cosf(2.0f * t);
        at[POINTS - 1 - i][1] = r * sinf(2.0f * t);
        at[POINTS - 1 - i][2] = 0.35f * sinf(3.0f * t);
    }
    for (int i = 0; i < POINTS; i++) {
        const float a = x - at[i][0], b = y - at[i][1], c = z - at[i][2];
        least = fminf(least, a * a + b * b + c * c);
    }
    return 0.12f - sqrtf(least);
}

static float gyroid(float x, float y, float z)
{
    const float k = 9.424778f;
    return sinf(k * x) * cosf(k * y) + sinf(k * y) * cosf(k * z) + sinf(k * z) * cosf(k * x);
}

static float sphere(float x, float y, float z)
{
    return 0.7f - sqrtf(x * x + y * y + z * z);
}

static float *make(const char *kind, int n)
{
    float (*f)(float, float, float) = !strcmp(kind, "knot")     ? knot
                                      : !strcmp(kind, "gyroid") ? gyroid
                                                                : sphere;
    float *samples = malloc(sizeof *samples * (size_t)n * (size_t)n * (size_t)n), *to = samples;
    const float scale = 2.0f / (float)(n - 1);
    for (int z = 0; z < n; z++)
        for (int y = 0; y < n; y++)
            for (int x = 0; x < n; x++)
                *to++ =
                    f((float)x * scale - 1.0f, (float)y * scale - 1.0f, (float)z * scale - 1.0f);
    return samples;
}

// ---------------------------------------------------------------- error

static double value(const relume_volume *v, const double p[3], double gradient[3])
{
    int at[3];
    double f[3], corner[2][2][2];
    for (int c = 0; c < 3; c++) {
        const double q = fmin(fmax(p[c], 0.0), v->size[c] - 1.001);
        at[c] = (int)q;
        f[c] = q - at[c];
    }
    for (int i = 0; i < 8; i++)
        corner[i >> 2][i >> 1 & 1][i & 1] = (double)volume_sample(
            v, volume_at(v, at[0] + (i & 1), at[1] + (i >> 1 & 1), at[2] + (i >> 2)));
    double sum = 0.0;
    memset(gradient, 0, 3 * sizeof *gradient);
    for (int i = 0; i < 8; i++) {
        const double w[3] = {i & 1 ? f[0] : 1 - f[0], i & 2 ? f[1] : 1 - f[1],
                             i & 4 ? f[2] : 1 - f[2]};
        const double s = corner[i >> 2][i >> 1 & 1][i & 1];
        sum += w[0] * w[1] * w[2] * s;
        gradient[0] += (i & 1 ? 1 : -1) * w[1] * w[2] * s;
        gradient[1] += (i & 2 ? 1 : -1) * w[0] * w[2] * s;
        gradient[2] += (i & 4 ? 1 : -1) * w[0] * w[1] * s;
    }
    return sum;
}

static double distance(const relume_volume *v, const double from[3], double threshold)
{
    double p[3] = {from[0], from[1], from[2]}, g[3];
    for (int i = 0; i < 10; i++) {
        const double off = value(v, p, g) - threshold;
        const double square = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
        const double step = square > 0.0 ? off / square : 0.0;
        const double shorten = fmin(1.0, 0.7 / (fabs(step) * sqrt(square) + 1e-12));
        for (int c = 0; c < 3; c++)
            p[c] -= shorten * step * g[c];
    }
    return sqrt(pow(p[0] - from[0], 2) + pow(p[1] - from[1], 2) + pow(p[2] - from[2], 2));
}

struct error {
    double rms, most;
};

static struct error error_of(const struct relume_mesh *m, const relume_volume *v, double threshold)
{
    double sum = 0.0, weights = 0.0;
    struct error e = {0.0, 0.0};
    uint32_t state = 1;
    for (size_t i = 0; i < m->triangle_count; i++) {
        const float *a = m->position[m->triangle[i][0]], *b = m->position[m->triangle[i][1]],
                    *c = m->position[m->triangle[i][2]];
        double u[3], w[3], square = 0.0;
        for (int k = 0; k < 3; k++) {
            u[k] = (double)b[k] - (double)a[k];
            w[k] = (double)c[k] - (double)a[k];
        }
        for (int k = 0; k < 3; k++)
            square += pow(u[(k + 1) % 3] * w[(k + 2) % 3] - u[(k + 2) % 3] * w[(k + 1) % 3], 2);
        const double area = 0.5 * sqrt(square);
        const int n = 1 + (int)(area / 2.0);
        for (int s = 0; s < n; s++) {
            double r[2], p[3];
            for (int k = 0; k < 2; k++) {
                state = state * 1664525u + 1013904223u;
                r[k] = (state >> 8) / 16777216.0;
            }
            if (r[0] + r[1] > 1.0)
                r[0] = 1.0 - r[0], r[1] = 1.0 - r[1];
            for (int k = 0; k < 3; k++)
                p[k] = (double)a[k] + r[0] * u[k] + r[1] * w[k];
            const double d = distance(v, p, threshold);
            sum += area / n * d * d;
            weights += area / n;
            e.most = fmax(e.most, d);
        }
    }
    e.rms = weights > 0.0 ? sqrt(sum / weights) : 0.0;
    return e;
}

// ---------------------------------------------------------------- times

static double best_time(struct relume_mesh *mesh, const relume_volume *v, double t, int block)
{
    double best = INFINITY;
    for (int i = 0; i < RUNS; i++) {
        relume_mesh_free(mesh);
        const double start = seconds();
        bench_check(relume_isosurface(mesh, NULL, v, t,
                                      relume_isosurface_params(.threads = 1, .blocks = {block})));
        best = fmin(best, seconds() - start);
    }
    return best;
}

static void print(const char *name, relume_volume *v, double threshold)
{
    struct relume_mesh mesh[LEVELS] = {{0}};
    double plain[LEVELS], indexed[LEVELS];
    struct error e[LEVELS];
    for (int l = 0; l < LEVELS; l++) {
        plain[l] = best_time(&mesh[l], v, threshold, blocks[l]);
        e[l] = error_of(&mesh[l], v, threshold);
    }
    const double start = seconds();
    bench_check(relume_volume_index(v, 1));
    const double index = seconds() - start;
    for (int l = 0; l < LEVELS; l++)
        indexed[l] = best_time(&mesh[l], v, threshold, blocks[l]);
    printf("{\"name\": \"%s\", \"threshold\": %g, \"index_s\": %.5f, \"levels\": [", name,
           threshold, index);
    for (int l = 0; l < LEVELS; l++) {
        printf("%s{\"block\": %d, \"triangles\": %zu, \"s\": %.5f, \"indexed_s\": %.5f, "
               "\"rms\": %.4f, \"max\": %.3f}",
               l ? ", " : "", blocks[l], mesh[l].triangle_count, plain[l], indexed[l], e[l].rms,
               e[l].most);
        relume_mesh_free(&mesh[l]);
    }
    puts("]}");
}

static relume_volume *open_volume(const char *path, const char *size, const char *type)
{
    struct relume_volume_params p = *relume_volume_params(.type = type);
    relume_volume *v;
    (void)sscanf(size, "%dx%dx%d", &p.size[0], &p.size[1], &p.size[2]);
    bench_check(relume_volume_open(&v, path, &p));
    return v;
}

static void made(const char *kind, int n)
{
    char name[32];
    float *samples = make(kind, n);
    relume_volume *v;
    bench_check(
        relume_volume_from(&v, samples, relume_volume_params(.size = {n, n, n}, .type = "f32")));
    free(samples);
    snprintf(name, sizeof name, "%s%d", kind, n);
    print(name, v, 0.0);
    relume_volume_destroy(&v);
}

int main(int argc, char **argv)
{
    if (argc == 5 && !strcmp(argv[1], "make")) {
        const int n = atoi(argv[3]);
        float *samples = make(argv[2], n);
        bench_check(relume_file_save(argv[4], samples,
                                     sizeof *samples * (size_t)n * (size_t)n * (size_t)n, NULL));
        free(samples);
    } else if (argc == 6 && !strcmp(argv[1], "volume")) {
        relume_volume *v = open_volume(argv[2], argv[3], argv[4]);
        print(argv[2], v, atof(argv[5]));
        relume_volume_destroy(&v);
    } else if (argc == 7 && !strcmp(argv[1], "error")) {
        struct relume_mesh mesh;
        relume_volume *v = open_volume(argv[3], argv[4], argv[5]);
        bench_check(relume_mesh_read(&mesh, argv[2], NULL));
        const struct error e = error_of(&mesh, v, atof(argv[6]));
        printf("{\"triangles\": %zu, \"rms\": %.4f, \"max\": %.3f}\n", mesh.triangle_count, e.rms,
               e.most);
        relume_mesh_free(&mesh);
        relume_volume_destroy(&v);
    } else {
        puts("isosurfaces, one thread (Wong 1998, Table 4.1)");
        made("knot", 128);
        made("gyroid", 128);
    }
    return 0;
}
