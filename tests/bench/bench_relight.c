// bench_relight.c - directional relight of 1 Mpixel RGB, 25 8-bit coefficients, against reading the
// same bytes once, on the same threads
#include "bench.h"

#include "base/thread.h"
#include "kernel/kernels.h"

enum { SIDE = 1024, K = 25, PLANES = 3 * K, RUNS = 15 };

struct read_job {
    const uint8_t *bytes;
    size_t block;
    uint64_t *sum;
};

static void read_block(void *context, size_t item, int worker)
{
    (void)worker;
    const struct read_job *j = context;
    const uint64_t *w = (const uint64_t *)(j->bytes + item * j->block);
    uint64_t sum[4] = {0, 0, 0, 0};
    for (size_t i = 0; i < j->block / 8; i += 4)
        for (size_t l = 0; l < 4; l++)
            sum[l] += w[i + l];
    j->sum[item] = sum[0] + sum[1] + sum[2] + sum[3];
}

static relume_coder *make_coder(void)
{
    struct relume_vec3 lights[100];
    relume_coder *coder;
    bench_check(relume_directions_make(lights, 100, relume_pattern_find("hammersley"), NULL));
    bench_check(relume_coder_create(&coder, &relume_basis_sh, lights, 100,
                                    relume_coder_params(.coefficients = K)));
    return coder;
}

static void compare(const struct relume_codes *codes, const uint8_t *bytes, int threads)
{
    enum { BLOCKS = 75 };
    const struct relume_light light = {.direction = {0.3, 0.4, 0.8}, .rgb = {1, 1, 1}};
    const size_t size = (size_t)PLANES * SIDE * SIDE;
    uint64_t sums[BLOCKS], check = 0;
    struct relume_image out = {0};
    struct bench read = {.runs = 0}, fast = {.runs = 0}, plain = {.runs = 0};
    for (int i = 0; i < RUNS; i++) {
        double t = bench_now_s();
        thread_for(threads, BLOCKS, read_block, &(struct read_job){bytes, size / BLOCKS, sums});
        bench_add(&read, bench_now_s() - t);
        check += sums[i];
        t = bench_now_s();
        bench_check(
            relume_relight(&out, codes, &light, 1, relume_relight_params(.threads = threads)));
        bench_add(&fast, bench_now_s() - t);
        t = bench_now_s();
        bench_check(relume_relight(&out, codes, &light, 1,
                                   relume_relight_params(.threads = threads, .cpu_off = ~0u)));
        bench_add(&plain, bench_now_s() - t);
    }
    printf("%d thread%s (checksum %llx)\n", threads, threads == 1 ? "" : "s",
           (unsigned long long)check);
    bench_print("read 75 MB", &read);
    bench_print(kernels_choose(0)->name, &fast);
    bench_print("c", &plain);
    printf("  speed of relighting / speed of reading: %.2f (target 0.6), plain C %.2f\n",
           bench_median(&read) / bench_median(&fast), bench_median(&read) / bench_median(&plain));
    relume_image_destroy(&out);
}

int main(void)
{
    const size_t size = (size_t)PLANES * SIDE * SIDE;
    uint8_t *bytes = aligned_alloc(64, size);
    const void *plane[PLANES];
    float scale[PLANES], offset[PLANES];
    relume_coder *coder = make_coder();
    for (size_t i = 0; i < size; i++)
        bytes[i] = (uint8_t)(i * 2654435761u >> 13);
    for (int p = 0; p < PLANES; p++) {
        plane[p] = bytes + (size_t)p * SIDE * SIDE;
        scale[p] = 0.004f;
        offset[p] = -0.5f;
    }
    const struct relume_codes codes = {
        .coder = coder,
        .domain = RELUME_DOMAIN_LINEAR,
        .width = SIDE,
        .height = SIDE,
        .planes = PLANES,
        .storage = RELUME_STORE_8,
        .plane = plane,
        .scale = scale,
        .offset = offset,
    };
    printf("relight: %d x %d, %d coefficients, 8 bits\n", SIDE, SIDE, K);
    compare(&codes, bytes, 1);
    if (relume_cpu_count() > 1)
        compare(&codes, bytes, relume_cpu_count());
    relume_coder_destroy(&coder);
    free(bytes);
    return 0;
}
