// bench_lookup.c - 4 Mpixel relit from a codebook of 4096 vectors into bytes for the screen,
// against memcpy of those bytes
#include "bench.h"

enum { SIDE = 2048, PIXELS = SIDE * SIDE, K = 25, CODES = 4096, RUNS = 15 };

static relume_coder *make_coder(void)
{
    struct relume_vec3 lights[100];
    relume_coder *coder;
    bench_check(relume_directions_make(lights, 100, relume_pattern_find("hammersley"), NULL));
    bench_check(relume_coder_create(&coder, &relume_basis_sh, lights, 100,
                                    relume_coder_params(.coefficients = K)));
    return coder;
}

static void compare(const struct relume_codes *codes, uint8_t *out, uint8_t *copy, int threads)
{
    const struct relume_light light = {.direction = {0.3, 0.4, 0.8}, .rgb = {1, 1, 1}};
    struct bench bytes = {.runs = 0}, fast = {.runs = 0}, plain = {.runs = 0}, floats = {.runs = 0};
    struct relume_image image = {0};
    for (int i = 0; i < RUNS; i++) {
        double t = bench_now_s();
        memcpy(copy, out, (size_t)PIXELS * 4);
        bench_add(&bytes, bench_now_s() - t);
        out[copy[i]]++;  // the copy is used
        t = bench_now_s();
        bench_check(
            relume_relight_rgba8(out, codes, &light, 1, relume_relight_params(.threads = threads)));
        bench_add(&fast, bench_now_s() - t);
        t = bench_now_s();
        bench_check(relume_relight_rgba8(
            out, codes, &light, 1, relume_relight_params(.threads = threads, .cpu_off = ~0u)));
        bench_add(&plain, bench_now_s() - t);
        t = bench_now_s();
        bench_check(
            relume_relight(&image, codes, &light, 1, relume_relight_params(.threads = threads)));
        bench_add(&floats, bench_now_s() - t);
    }
    printf("%d thread%s (memcpy: 1)\n", threads, threads == 1 ? "" : "s");
    bench_print("memcpy of 16 MB", &bytes);
    bench_print("to RGBA8", &fast);
    bench_print("to RGBA8, plain C", &plain);
    bench_print("to linear floats", &floats);
    printf("  speed of relighting / speed of memcpy: %.2f (target 0.5), plain C %.2f\n",
           bench_median(&bytes) / bench_median(&fast), bench_median(&bytes) / bench_median(&plain));
    relume_image_destroy(&image);
}

int main(void)
{
    relume_coder *coder = make_coder();
    const int planes = 3 * K, count = CODES;
    uint16_t *index = malloc((size_t)PIXELS * sizeof *index);
    float *vectors = malloc((size_t)CODES * 3 * K * sizeof *vectors);
    uint8_t *out = calloc(PIXELS, 4), *copy = calloc(PIXELS, 4);
    for (size_t i = 0; i < PIXELS; i++)  // neighbours mostly alike, as in pictures
        index[i] = (uint16_t)((i / 9 % SIDE + i / SIDE / 7 * 31 + (i * 2654435761u >> 28)) % CODES);
    for (size_t i = 0; i < (size_t)CODES * 3 * K; i++)
        vectors[i] = (float)(i * 2654435761u >> 8 & 0xffff) / 65536.0f - 0.4f;
    const uint16_t *indices[] = {index};
    const float *books[] = {vectors};
    const struct relume_codes codes = {
        .coder = coder,
        .domain = RELUME_DOMAIN_DISPLAY,
        .display = {.curve = RELUME_CURVE_SRGB},
        .width = SIDE,
        .height = SIDE,
        .planes = planes,
        .books = 1,
        .index = indices,
        .vectors = books,
        .book_codes = &count,
    };
    printf("look-up: %d x %d, %d codes, %d coefficients, display domain\n", SIDE, SIDE, CODES, K);
    compare(&codes, out, copy, 1);
    if (relume_cpu_count() > 1)
        compare(&codes, out, copy, relume_cpu_count());
    relume_coder_destroy(&coder);
    free(index);
    free(vectors);
    free(out);
    free(copy);
    return 0;
}
