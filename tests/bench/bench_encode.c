// bench_encode.c - encoding 49 JPEG photographs against only decoding them on the same threads, by
// the library's own reader. Usage: bench_encode [SIDE]; default 2048. Prints peak memory as well.
#include "bench.h"

#include "core/base/thread.h"
#include "image/image/picture.h"

#include <sys/wait.h>

enum { LIGHTS = 49, RUNS = 3 };

static float noise(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) / 16777216.0f;
}

// A bumpy, speckled, slightly noisy surface, so that the JPEGs are as large as photographs are.
static void photograph(struct relume_image *image, struct relume_vec3 l, uint32_t seed)
{
    uint32_t state = seed;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            const double nx = 0.4 * sin(0.11 * x + 0.03 * y), ny = 0.4 * cos(0.07 * y - 0.05 * x);
            const double nz = sqrt(1.0 - nx * nx - ny * ny);
            const double lit = fmax(0.0, nx * l.x + ny * l.y + nz * l.z);
            const double albedo =
                0.3 + 0.2 * sin(0.9 * x) * sin(0.7 * y) + 0.2 * ((x / 37 + y / 23) & 1);
            float *p = image->data + ((size_t)y * (size_t)image->width + (size_t)x) * 3;
            for (int c = 0; c < 3; c++)
                p[c] = (float)(lit * albedo * (1.0 - 0.2 * c)) + 0.02f * noise(&state);
        }
}

static void make_capture(const char *folder, int side)
{
    struct relume_vec3 lights[LIGHTS];
    struct relume_image image;
    char path[256];
    bench_check(relume_directions_make(lights, LIGHTS, relume_pattern_find("hammersley"),
                                       relume_directions_params(.hemisphere = true)));
    bench_check(relume_image_create(&image, side, side, 3));
    snprintf(path, sizeof path, "%s/dirs.lp", folder);
    FILE *lp = fopen(path, "w");
    fprintf(lp, "%d\n", LIGHTS);
    for (int i = 0; i < LIGHTS; i++) {
        photograph(&image, lights[i], (uint32_t)i + 1);
        snprintf(path, sizeof path, "%s/photo%02d.jpg", folder, i);
        bench_check(relume_image_save(&image, path, NULL));
        fprintf(lp, "photo%02d.jpg %f %f %f\n", i, lights[i].x, lights[i].y, lights[i].z);
    }
    fclose(lp);
    relume_image_destroy(&image);
}

static void decode_one(void *context, size_t item, int worker)
{
    (void)worker;
    char path[256];
    picture_reader *reader;
    snprintf(path, sizeof path, "%s/photo%02zu.jpg", (const char *)context, item);
    bench_check(picture_open(&reader, path, NULL, NULL, NULL));
    const struct picture_info *info = picture_info_of(reader);
    uint8_t *pixels = malloc((size_t)info->width * (size_t)info->height * 3);
    bench_check(picture_read_bytes(reader, 0, info->height, pixels));
    free(pixels);
    picture_close(&reader);
}

static void decode(const char *folder)
{
    char copy[256];
    snprintf(copy, sizeof copy, "%s", folder);
    thread_for(0, LIGHTS, decode_one, copy);
}

struct setting {
    const char *name;
    const struct relume_basis *basis;
    int coefficients;
    enum relume_compression compression;
};

static void encode(const char *folder, const struct setting *s)
{
    char lp[256], out[256];
    relume_capture *capture;
    relume_coder *coder;
    snprintf(lp, sizeof lp, "%s/dirs.lp", folder);
    snprintf(out, sizeof out, "%s/out.exr", folder);
    bench_check(relume_capture_open(
        &capture, lp,
        relume_capture_params(.keep_bytes = s->basis->learned ? (size_t)640 << 20 : 0)));
    bench_check(relume_coder_learn(&coder, s->basis, capture,
                                   relume_coder_params(.coefficients = s->coefficients), NULL));
    bench_check(relume_pack_encode(capture, coder, out, NULL,
                                   relume_pack_encode_params(.compression = s->compression)));
    relume_coder_destroy(&coder);
    relume_capture_destroy(&capture);
}

// Peak memory of one encoding, in a process of its own.
static long peak_mb(const char *folder, const struct setting *s)
{
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        encode(folder, s);
        _exit(0);
    }
    struct rusage usage;
    int status;
    if (wait4(child, &status, 0, &usage) != child)
        return -1;
    return usage.ru_maxrss / 1024;
}

int main(int argc, char **argv)
{
    enum { SETTINGS = 5 };
    const struct setting settings[SETTINGS] = {
        {"sh 16, none", &relume_basis_sh, 16, RELUME_COMPRESS_NONE},
        {"sh 16, rle", &relume_basis_sh, 16, RELUME_COMPRESS_RLE},
        {"sh 16, zip", &relume_basis_sh, 16, RELUME_COMPRESS_ZIP},
        {"sh 16, piz (default)", &relume_basis_sh, 16, RELUME_COMPRESS_PIZ},
        {"pca 27, piz (default)", &relume_basis_pca, 27, RELUME_COMPRESS_PIZ}};
    const int side = argc > 1 ? atoi(argv[1]) : 2048;
    char folder[] = "/tmp/relume-bench-XXXXXX";
    if (side < 16 || !mkdtemp(folder))
        return 1;
    make_capture(folder, side);
    printf("encode: %d JPEG photographs of %d x %d, 8 bits, %d threads\n", LIGHTS, side, side,
           relume_cpu_count());
    for (int k = SETTINGS - 2; k < SETTINGS; k++)
        printf("  %s: peak memory %ld MB\n", settings[k].name, peak_mb(folder, &settings[k]));
    struct times read = {.n = 0}, write[SETTINGS] = {{.n = 0}};
    for (int run = 0; run < RUNS; run++) {
        double t = now_s();
        decode(folder);
        times_add(&read, now_s() - t);
        for (int k = 0; k < SETTINGS; k++) {
            t = now_s();
            encode(folder, &settings[k]);
            times_add(&write[k], now_s() - t);
        }
    }
    bench_print("decode only", &read);
    for (int k = 0; k < SETTINGS; k++) {
        bench_print(settings[k].name, &write[k]);
        printf("    encode / decode: %.2f\n", times_median(&write[k]) / times_median(&read));
    }
    char command[300];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command) != 0;
}
