// bench_glare.c - the eye's pattern and the frame seen through it, stage by stage as Table 8.2 of
// Ritschel 2009 has them, each with its target
#include "relight/eye/pattern.h"

#include "bench.h"

enum { RUNS = 9 };

static const double frame_s = 1.0 / 60.0, luminance = 10.0;

static void print_target(double ms, double target_ms)
{
    if (target_ms > 0.0)
        printf("   target %.4g: %s", target_ms, ms <= target_ms ? "reached" : "missed");
    printf("\n");
}

// Returns the median of the whole, ms. A target of 0 is none.
static double stages(const char *name, const struct relume_psf_params *params,
                     const struct relume_subject *subject, double target_ms)
{
    relume_eye *eye;
    relume_psf *psf;
    struct times stage[4] = {{.n = 0}};
    bench_check(relume_eye_create(&eye, subject, luminance));
    bench_check(relume_psf_create(&psf, params));
    bench_check(relume_psf_update(psf, eye));
    for (int i = 0; i < RUNS; i++) {
        bench_check(relume_eye_advance(eye, frame_s, luminance));
        const double start = now_s();
        bench_check(relume_psf_update(psf, eye));
        times_add(&stage[3], now_s() - start);
        const struct relume_psf_times t = relume_psf_times(psf);
        times_add(&stage[0], t.aperture_s);
        times_add(&stage[1], t.diffraction_s);
        times_add(&stage[2], t.chromatic_s);
    }
    printf("  %-26s", name);
    for (int k = 0; k < 4; k++)
        printf(" %7.2f (%.2f-%.2f)", 1e3 * times_median(&stage[k]), 1e3 * stage[k].s[0],
               1e3 * stage[k].s[RUNS - 1]);
    const double ms = 1e3 * times_median(&stage[3]);
    print_target(ms, target_ms);
    relume_psf_destroy(&psf);
    relume_eye_destroy(&eye);
    return ms;
}

// Playback of a loop instead.
static void playback(int size)
{
    char name[64];
    relume_eye *eye;
    relume_psf *psf;
    relume_psf_cycle *cycle;
    struct times b = {.n = 0};
    bench_check(relume_eye_create(&eye, NULL, luminance));
    bench_check(relume_psf_create(&psf, relume_psf_params(.size = size)));
    bench_check(relume_psf_cycle_create(&cycle, psf, eye, relume_psf_cycle_params(.seconds = 0.5)));
    for (int i = 0; i < RUNS; i++) {
        const double start = now_s();
        bench_check(relume_psf_cycle_show(psf, cycle, i * 0.017));
        times_add(&b, now_s() - start);
    }
    snprintf(name, sizeof name, "%d, from a loop", size);
    bench_print(name, &b);
    relume_psf_cycle_destroy(&cycle);
    relume_psf_destroy(&psf);
    relume_eye_destroy(&eye);
}

static void patterns(void)
{
    const struct relume_subject living = relume_subject_default();
    struct relume_subject sharp = living;
    sharp.optics.defocus_dpt = 0.0;
    printf("glare: pattern, ms: aperture, diffraction, wavelengths, whole (least-most of %d)\n",
           RUNS);
    static const double thesis_ms[] = {9.0, 18.4, 55.0};  // 256 for comparison, the others targets
    double at_1024 = 0.0;
    for (int i = 0; i < 3; i++) {
        const int size = 256 << i;
        char name[64];
        snprintf(name, sizeof name, "%d, 9 mm", size);
        at_1024 = stages(name, relume_psf_params(.size = size), &living, thesis_ms[i]);
        snprintf(name, sizeof name, "%d, 9 mm, no defocus", size);
        (void)stages(name, relume_psf_params(.size = size), &sharp, 0.0);
    }
    (void)stages("1024, plain C", relume_psf_params(.cpu_off = ~0u), &living, 0.0);
    (void)stages("1024, one thread", relume_psf_params(.threads = 1), &living, 0.0);
    (void)stages("1280, half field 3 deg", relume_psf_params(.size = 1280, .half_field_deg = 3.0),
                 &living, 2.0 * at_1024);
    (void)stages("1536, half field 4 deg", relume_psf_params(.size = 1536, .half_field_deg = 4.0),
                 &living, 0.0);
    playback(512);
    playback(1024);
}

// A dark frame with some lamps.
static void make_frame(struct relume_image *frame, int width, int height)
{
    bench_check(relume_image_create(frame, width, height, 3));
    for (size_t i = 0; i < 3 * (size_t)width * (size_t)height; i++)
        frame->data[i] = 0.05f + 0.01f * (float)(i % 7);
    for (int k = 0; k < 40; k++) {
        const size_t x = (size_t)(k * 7919 % width), y = (size_t)(k * 104729 % height);
        for (size_t c = 0; c < 3; c++)
            frame->data[3 * (y * (size_t)width + x) + c] = 3000.0f;
    }
}

static void apply(const char *name, const struct relume_image *frame, const relume_psf *psf,
                  bool same, const struct relume_glare_params *params, double target_ms)
{
    struct times b = {.n = 0};
    relume_glare *glare;
    bench_check(relume_glare_create(&glare));
    for (int i = 0; i <= RUNS; i++) {
        struct relume_image out;
        const double start = now_s();
        bench_check(relume_glare_apply(&out, glare, frame, same && i, psf, params));
        if (i)
            times_add(&b, now_s() - start);
        relume_image_destroy(&out);
    }
    const double ms = 1e3 * times_median(&b);
    printf("  %-44s %8.2f ms  (%.2f to %.2f)", name, ms, 1e3 * b.s[0], 1e3 * b.s[RUNS - 1]);
    print_target(ms, target_ms);
    relume_glare_destroy(&glare);
}

static void frames(void)
{
    struct relume_image frame;
    relume_eye *eye;
    relume_psf *psf;
    make_frame(&frame, 1280, 720);
    bench_check(relume_eye_create(&eye, NULL, luminance));
    bench_check(relume_psf_create(&psf, NULL));
    bench_check(relume_psf_update(psf, eye));
    printf("glare: onto 1280 x 720, 3 channels, 45 degrees wide, pattern 1024\n");
    apply("convolution, frame at rest", &frame, psf, true, NULL, 100.0);
    apply("convolution, frame moves", &frame, psf, false, NULL, 0.0);
    apply("convolution, without the far veil", &frame, psf, true,
          relume_glare_params(.no_veil = true), 0.0);
    apply("hybrid, frame moves", &frame, psf, false,
          relume_glare_params(.mode = RELUME_GLARE_HYBRID), 40.0);
    apply("billboards, frame moves", &frame, psf, false,
          relume_glare_params(.mode = RELUME_GLARE_BILLBOARD), 0.0);
    apply("convolution, frame at rest, one thread", &frame, psf, true,
          relume_glare_params(.threads = 1), 0.0);
    relume_psf_destroy(&psf);
    relume_eye_destroy(&eye);
    relume_image_destroy(&frame);
}

int main(void)
{
    patterns();
    frames();
    return 0;
}
