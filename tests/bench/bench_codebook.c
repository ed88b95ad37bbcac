// bench_codebook.c - training a codebook, one thread. Without arguments: k = 256 on 302,778 x 18
// and k = 4096 on 1 M x 27. For bench_codebook.py, which holds other programs against it on the
// same files of floats: `make FILE N DIM`, `train VECTORS DIM START CODES ROUNDS OUT [split]`.
#include "format/codebook/books.h"

#include "bench.h"

static float noise(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) / 16777216.0f;
}

// Coefficients like those of a surface: a few materials, smooth normals, functions of both, and a
// little noise. [n][dim], dim a multiple of 3.
static float *make_vectors(size_t n, int dim)
{
    const size_t width = (size_t)sqrt((double)n);
    float *v = malloc(n * (size_t)dim * sizeof *v);
    uint32_t state = 7;
    for (size_t i = 0; v && i < n; i++) {
        const double x = (double)(i % width), y = (double)(i / width);
        const double nx = 0.7 * sin(0.021 * x + 0.013 * y), ny = 0.7 * cos(0.017 * y - 0.011 * x);
        const double gloss = 0.5 + 0.5 * sin(0.003 * x * y / (double)width);
        const double albedo = 0.2 + 0.6 * (double)(((size_t)x / 61 + (size_t)y / 47) % 5) / 4.0;
        for (int k = 0; k < dim; k++) {
            const int order = k / 3, c = k % 3;
            const double wave =
                cos(order * (1.3 * nx + 0.4) + 0.7 * c * gloss) * sin(1.0 + order * 1.1 * ny);
            v[i * (size_t)dim + (size_t)k] =
                (float)((albedo - 0.1 * c) * wave * (order == 0 ? 3.0 : 1.0)) +
                0.1f * noise(&state);
        }
    }
    return v;
}

static float *load(const char *path, size_t *floats)
{
    FILE *f = fopen(path, "rb");
    if (!f)
        exit(1);
    fseek(f, 0, SEEK_END);
    *floats = (size_t)ftell(f) / sizeof(float);
    rewind(f);
    float *v = malloc(*floats * sizeof *v);
    if (!v || fread(v, sizeof *v, *floats, f) != *floats)
        exit(1);
    fclose(f);
    return v;
}

static void save(const char *path, const float *v, size_t floats)
{
    FILE *f = fopen(path, "wb");
    if (!f || fwrite(v, sizeof *v, floats, f) != floats || fclose(f))
        exit(1);
}

static relume_codebook *train(const float *vectors, size_t n, int dim, const float *start,
                              enum relume_codebook_start kind, int codes, int rounds)
{
    relume_codebook *book;
    bench_check(relume_codebook_train(
        &book, vectors, n, dim,
        relume_codebook_params(.codes = codes, .max_rounds = rounds, .min_gain = -1.0,
                               .initial = start, .start = kind, .seed = 1, .threads = 1)));
    return book;
}

static int train_file(char **a)
{
    const int dim = atoi(a[1]), codes = atoi(a[3]), rounds = atoi(a[4]);
    const bool split = a[6] && !strcmp(a[6], "split");
    size_t floats, start_floats;
    float *vectors = load(a[0], &floats), *start = load(a[2], &start_floats);
    const double begin = now_s();
    relume_codebook *book = train(vectors, floats / (size_t)dim, dim, split ? NULL : start,
                                  split ? RELUME_START_SPLIT : RELUME_START_RANDOM, codes, rounds);
    printf("%.6f\n", now_s() - begin);
    save(a[5], relume_codebook_info(book)->vectors, (size_t)codes * (size_t)dim);
    relume_codebook_destroy(&book);
    free(vectors);
    free(start);
    return 0;
}

static void time_training(size_t n, int dim, int codes, int rounds, int runs)
{
    float *vectors = make_vectors(n, dim);
    struct times random = {.n = 0}, split = {.n = 0};
    double errors[2] = {0.0, 0.0};
    for (int i = 0; i < runs; i++)
        for (int kind = 0; kind < 2; kind++) {
            const double t = now_s();
            relume_codebook *book =
                train(vectors, n, dim, NULL, (enum relume_codebook_start)kind, codes, rounds);
            times_add(kind ? &split : &random, now_s() - t);
            errors[kind] = relume_codebook_info(book)->squared_error;
            relume_codebook_destroy(&book);
        }
    printf("codebook: %d codes for %zu x %d, %d rounds, 1 thread\n", codes, n, dim, rounds);
    bench_print("random start", &random);
    bench_print("splitting start", &split);
    printf("    squared error: random %.6g, split %.6g\n", errors[0], errors[1]);
    free(vectors);
}

int main(int argc, char **argv)
{
    if (argc >= 8 && !strcmp(argv[1], "train"))
        return train_file(argv + 2);
    if (argc == 5 && !strcmp(argv[1], "make")) {
        const size_t n = strtoul(argv[3], NULL, 10);
        const int dim = atoi(argv[4]);
        float *v = make_vectors(n, dim);
        save(argv[2], v, n * (size_t)dim);
        free(v);
        return 0;
    }
    time_training(302778, 18, 256, 20, 3);
    time_training(1000000, 27, 4096, 2, 1);
    return 0;
}
