// Textures of which everything is known: planted waves come back, stripes and checks go on exactly,
// tiles close, any number of threads makes the same map, and what is no texture is refused.
#include "test.h"

#include "core/base/memory.h"
#include "core/math/random.h"
#include "material/synthesis/alike.h"

typedef double painter(int x, int y);

static struct relume_texture paint(int width, int height, int channels, painter *value)
{
    struct relume_texture t = {.width = width, .height = height, .channels = channels};
    t.value = mem_array((size_t)(width * height * channels), sizeof *t.value);
    for (int i = 0; i < width * height; i++)
        for (int c = 0; c < channels; c++)
            t.value[i * channels + c] =
                (float)(value(i % width, i / width) * (c == 0 ? 1.0 : 0.3 / c));
    return t;
}

static relume_regular *find(const struct relume_texture *t, bool all)
{
    relume_regular *r;
    CHECK_OK(relume_regular_find(&r, t, relume_regular_params(.all = all)));
    return r;
}

// ---------------------------------------------------------------- painters

enum { WIDE = 96, HIGH = 80 };

static double hash(int x, int y)
{
    return (double)(random_mix((uint64_t)y << 32 | (uint32_t)x) >> 11) * 0x1p-53;
}

// Three waves, none of which fits into the sample.
static const struct {
    double x, y, size, phase;
} planted[] = {{7.2, 0.0, 40.0, 0.7}, {3.45, -5.3, 25.0, -1.1}, {12.6, 9.85, 10.0, 2.0}};

static double waves(int x, int y)
{
    double sum = 120.0;
    for (int i = 0; i < 3; i++)
        sum +=
            planted[i].size * cos(2.0 * M_PI * (planted[i].x * x / WIDE + planted[i].y * y / HIGH) +
                                  planted[i].phase);
    return sum / 255.0;
}

static double noisy_waves(int x, int y)
{
    return waves(x, y) + 0.1 * (hash(x, y) - 0.5);
}

static double noise(int x, int y)
{
    return hash(x, y);
}

static double flat(int x, int y)
{
    (void)x;
    (void)y;
    return 0.4;
}

static double stripes(int x, int y)
{
    (void)y;
    return x % 8 < 4 ? 0.2 : 0.8;
}

static double checks(int x, int y)
{
    return (x / 4 + y / 4) % 2 ? 0.2 : 0.8;
}

// A pattern of 11.3 x 9.7 texels with sharp features: many multiples of one base.
static double lattice(int x, int y)
{
    const double u = fmod(x / 11.3, 1.0) - 0.5, v = fmod(y / 9.7, 1.0) - 0.5;
    return exp(-30.0 * (u * u + v * v)) + 0.02 * (hash(x, y) - 0.5);
}

// ---------------------------------------------------------------- waves

// Every planted wave is among those found.
static void check_planted(const struct relume_regular_info *info, double place, double size)
{
    for (int i = 0; i < 3; i++) {
        const struct relume_wave *best = NULL;
        for (int k = 0; k < info->count; k++) {
            const struct relume_wave *w = &info->wave[k];
            if (fabs(w->x - planted[i].x) + fabs(w->y - planted[i].y) < 0.3)
                best = w;
        }
        assert_non_null(best);
        CHECK_NEAR(best->x, planted[i].x, place);
        CHECK_NEAR(best->y, planted[i].y, place);
        CHECK_NEAR(best->re, planted[i].size * cos(planted[i].phase), size);
        CHECK_NEAR(best->im, planted[i].size * sin(planted[i].phase), size);
    }
}

static void test_planted_waves(void **state)
{
    (void)state;
    struct relume_texture t = paint(WIDE, HIGH, 1, waves);
    relume_regular *r = find(&t, true);
    const struct relume_regular_info *info = relume_regular_info(r);
    // three waves and the mean say everything: what whole frequencies leak would need dozens
    CHECK_NEAR(info->wave[0].re, 120.0, 1e-3);
    CHECK_NEAR(info->rms, 0.0, 1e-3);
    CHECK_NEAR(info->share, 1.0, 1e-6);
    check_planted(info, 1e-4, 1e-2);
    relume_regular_destroy(&r);
    relume_texture_destroy(&t);

    t = paint(WIDE, HIGH, 1, noisy_waves);
    r = find(&t, true);
    info = relume_regular_info(r);
    // the deviation of a place by noise of 7.4 is about 0.4 * 7.4 / (10 sqrt(96 80 / 2))
    check_planted(info, 0.02, 1.0);
    assert_true(info->rms < 255.0 * 0.1 / sqrt(12.0));
    relume_regular_destroy(&r);
    relume_texture_destroy(&t);
}

// Two waves that are no multiples of anything larger than 2 have no common base, or a small one;
// one lattice has its own, in all channels.
static void test_base(void **state)
{
    (void)state;
    struct relume_texture t = paint(WIDE, HIGH, TEST_SANITIZED ? 1 : 3, lattice);
    relume_regular *r = find(&t, false);
    const struct relume_regular_info *info = relume_regular_info(r);
    assert_true(info->regular && info->common);
    CHECK_NEAR(info->base[0], WIDE / 11.3, 0.005);
    CHECK_NEAR(info->base[1], HIGH / 9.7, 0.005);
    assert_true(info->share > 0.9);
    for (int i = 0; i < info->count; i++) {
        CHECK_NEAR(remainder(info->wave[i].x, info->base[0]), 0.0, 1e-9);
        CHECK_NEAR(remainder(info->wave[i].y, info->base[1]), 0.0, 1e-9);
    }
    relume_regular_destroy(&r);
    relume_texture_destroy(&t);

    t = paint(64, 40, 1, stripes);
    r = find(&t, false);
    info = relume_regular_info(r);
    assert_true(info->regular && info->common);
    CHECK_NEAR(info->base[0], 8.0, 1e-3);
    CHECK_NEAR(info->base[1], 0.0, 0.0);
    relume_regular_destroy(&r);
    relume_texture_destroy(&t);
}

static void test_nothing_repeats(void **state)
{
    (void)state;
    painter *const none[] = {noise, flat};
    for (int i = 0; i < 2; i++) {
        struct relume_texture t = paint(40, 36, 3, none[i]);
        relume_regular *r = find(&t, false);
        const struct relume_regular_info *info = relume_regular_info(r);
        assert_false(info->regular);
        assert_int_equal(info->count, 3);  // the means
        CHECK_NEAR(info->share, 0.0, 0.0);
        relume_regular_destroy(&r);
        relume_texture_destroy(&t);
    }
}

// The structure goes on as it was planted, far from the sample.
static void test_mask(void **state)
{
    (void)state;
    enum { W = 301, H = 203 };
    struct relume_texture t = paint(WIDE, HIGH, 1, waves);
    relume_regular *r = find(&t, true);
    struct relume_image mask, one;
    CHECK_OK(relume_regular_mask(&mask, r, W, H, 3));
    CHECK_OK(relume_regular_mask(&one, r, W, H, 1));
    assert_memory_equal(mask.data, one.data, sizeof(float) * W * H);
    for (int y = 0; y < H; y += 7)
        for (int x = 0; x < W; x += 5)
            CHECK_NEAR((double)mask.data[y * W + x], waves(x, y), 1e-4);
    relume_image_destroy(&mask);
    relume_image_destroy(&one);
    relume_regular_destroy(&r);
    relume_texture_destroy(&t);
}

// ---------------------------------------------------------------- maps

enum { METHODS = 2 };
static const enum relume_grow_method methods[METHODS] = {RELUME_GROW_PATCH, RELUME_GROW_PIXEL};

static uint32_t *grow(const struct relume_texture *t, int width, int height,
                      const struct relume_grow_params *p)
{
    uint32_t *texel = mem_array((size_t)width * (size_t)height, sizeof *texel);
    CHECK_OK(relume_texture_grow(texel, width, height, t, p));
    for (int i = 0; i < width * height; i++)
        assert_true(texel[i] < (uint32_t)(t->width * t->height));
    return texel;
}

// What is purely regular goes on exactly, in its own phase; as a tile of whole periods also across
// its sides.
static void test_regular_exact(void **state)
{
    (void)state;
    enum { W = 136, H = 88 };
    painter *const kind[] = {stripes, checks};
    for (int k = TEST_SANITIZED; k < 2; k++) {
        struct relume_texture t = paint(56, 48, 1, kind[k]);
        relume_regular *r = find(&t, false);
        for (int m = 0; m < 2 * METHODS; m++) {
            uint32_t *texel =
                grow(&t, W, H,
                     relume_grow_params(.method = methods[m / 2], .regular = r, .tile = m % 2));
            int wrong = 0;
            for (int i = 0; i < W * H; i++)
                wrong += fabs((double)t.value[texel[i]] - kind[k](i % W, i / W)) > 1e-6;
            assert_int_equal(wrong, 0);
            mem_free(texel);
        }
        relume_regular_destroy(&r);
        relume_texture_destroy(&t);
    }
}

static double step(const struct relume_texture *t, uint32_t a, uint32_t b)
{
    return fabs((double)(t->value[a] - t->value[b]));
}

// Where a tile meets itself steps are as large as inside, and not as where a map ends that is none.
static void test_tiles_close(void **state)
{
    (void)state;
    enum { W = 130, H = 84 };  // 11 periods and a half
    struct relume_texture t = paint(WIDE, HIGH, 1, lattice);
    relume_regular *r = find(&t, false);
    for (int m = 0; m < METHODS; m++)
        for (int tile = TEST_SANITIZED; tile < 2; tile++) {
            uint32_t *texel = grow(
                &t, W, H,
                relume_grow_params(.method = methods[m], .regular = r, .tile = tile, .seed = 3));
            double inside = 0.0, across = 0.0;
            for (int y = 0; y < H; y++) {
                across += step(&t, texel[y * W + W - 1], texel[y * W]) / H;
                for (int x = 0; x + 1 < W; x++)
                    inside += step(&t, texel[y * W + x], texel[y * W + x + 1]) / (H * (W - 1.0));
            }
            assert_true(tile ? across < 1.25 * inside : across > 1.4 * inside);
            mem_free(texel);
        }
    relume_regular_destroy(&r);
    relume_texture_destroy(&t);
}

static void test_threads_and_seeds(void **state)
{
    (void)state;
    enum { W = TEST_SANITIZED ? 70 : 110, H = 91 };
    struct relume_texture t = paint(40, 32, 3, noisy_waves);
    relume_regular *r = find(&t, false);
    for (int m = 0; m < METHODS; m++) {
        uint32_t *map[4];
        const int threads[4] = {1, 2, 7, 2}, seed[4] = {5, 5, 5, 6};
        for (int i = 0; i < 4; i++)
            map[i] = grow(&t, W, H,
                          relume_grow_params(.method = methods[m], .regular = r, .patch = 16,
                                             .threads = threads[i], .seed = (uint64_t)seed[i]));
        assert_memory_equal(map[0], map[1], sizeof(uint32_t) * W * H);
        assert_memory_equal(map[0], map[2], sizeof(uint32_t) * W * H);
        assert_true(memcmp(map[0], map[3], sizeof(uint32_t) * W * H));
        for (int i = 0; i < 4; i++)
            mem_free(map[i]);
    }
    relume_regular_destroy(&r);
    relume_texture_destroy(&t);
}

// Sizes that no patch or block fits into, and all options' ends.
static void test_any_size(void **state)
{
    (void)state;
    static const int size[][2] = {{1, 1}, {3, 200}, {65, 2}, {17, 19}};
    struct relume_texture t = paint(24, 18, 5, lattice);
    for (int i = TEST_SANITIZED; i < 4; i++)
        for (int m = 0; m < 2 * METHODS; m++) {
            uint32_t *texel = grow(&t, size[i][0], size[i][1],
                                   relume_grow_params(.method = methods[m / 2], .tile = m % 2));
            mem_free(texel);
        }
    for (int k = 1; k <= 8; k += 7)
        mem_free(grow(&t, 30, 30,
                      relume_grow_params(.method = RELUME_GROW_PIXEL, .alike = k,
                                         .neighbourhood = k == 1 ? 3 : 9, .levels = k)));
    mem_free(grow(&t, 30, 30, relume_grow_params(.patch = 18)));
    mem_free(grow(&t, 30, 30, relume_grow_params(.patch = 4)));
    relume_texture_destroy(&t);
}

// ---------------------------------------------------------------- what maps are worth

// The sample side by side repeats entirely; copies have no new neighbourhood.
static void test_judge_tiling(void **state)
{
    (void)state;
    enum { W = 64 * 4, H = 48 * 4 };
    struct relume_texture t = paint(64, 48, 1, noise);
    uint32_t *texel = mem_array((size_t)W * H, sizeof *texel);
    struct relume_grow_quality q;
    for (int i = 0; i < W * H; i++)
        texel[i] = (uint32_t)(i / W % 48 * 64 + i % W % 64);
    CHECK_OK(relume_grow_judge(&q, texel, W, H, &t, NULL));
    CHECK_NEAR(q.repetition, 1.0, 0.05);
    assert_true(abs(q.repetition_at[0]) % 64 == 0 && q.repetition_at[1] % 48 == 0);
    CHECK_NEAR(q.coverage, 1.0, 0.0);
    CHECK_NEAR(q.cuts, (3.0 * H + 3.0 * W) / (2.0 * W * H - W - H), 1e-3);
    assert_true(q.novelty < 0.2);

    // texels by chance repeat nothing and look like nothing
    for (int i = 0; i < W * H; i++)
        texel[i] = (uint32_t)(hash(i, 5) * 64 * 48);
    CHECK_OK(relume_grow_judge(&q, texel, W, H, &t, NULL));
    assert_true(q.repetition < 0.1 && q.cuts > 0.95);
    CHECK_NEAR(q.novelty, 1.0, 0.05);  // of noise even chance makes more of the same

    mem_free(texel);
    texel = grow(&t, W, H, NULL);
    CHECK_OK(relume_grow_judge(&q, texel, W, H, &t, NULL));
    assert_true(q.repetition < 0.35 && q.coverage > 0.5);
    texel[7] = 64 * 48;
    assert_int_equal(relume_grow_judge(&q, texel, W, H, &t, NULL), RELUME_EINVAL);
    mem_free(texel);
    relume_texture_destroy(&t);
}

static void test_apply(void **state)
{
    (void)state;
    struct relume_image sample, out;
    const uint32_t texel[6] = {5, 4, 3, 2, 1, 0}, beyond[1] = {6};
    CHECK_OK(relume_image_create(&sample, 3, 2, 3));
    for (int i = 0; i < 18; i++)
        sample.data[i] = (float)i;
    CHECK_OK(relume_texture_apply(&out, texel, 2, 3, &sample, 2));
    assert_true(out.width == 2 && out.height == 3 && out.channels == 3);
    for (int i = 0; i < 6; i++)
        assert_memory_equal(out.data + 3 * i, sample.data + 3 * (5 - i), 3 * sizeof(float));
    relume_image_destroy(&out);
    assert_int_equal(relume_texture_apply(&out, beyond, 1, 1, &sample, 1), RELUME_EINVAL);
    relume_image_destroy(&sample);
}

// The tree finds what looking at all texels finds, nearly always.
static void test_alike(void **state)
{
    (void)state;
    enum { W = 40, H = 30, APART = 4 };
    static float value[W * H];
    static uint32_t found[W * H];
    int same = 0;
    for (int i = 0; i < W * H; i++)
        value[i] = (float)waves(i % W, i / W);
    const struct alike_texels t = {
        .width = W, .height = H, .value = value, .values = 1, .side = 3, .spacing = 1};
    CHECK_OK(alike_find(found, 1, APART, &t, 3));
    for (int y = 1; y + 1 < H; y++)
        for (int x = 1; x + 1 < W; x++) {
            double least = 1e9, got = 0.0;
            for (int v = 1; v + 1 < H; v++)
                for (int u = 1; u + 1 < W; u++) {
                    double sum = 0.0;
                    for (int k = 0; k < 9; k++) {
                        const int at = (k / 3 - 1) * W + k % 3 - 1;
                        const double d = (double)(value[y * W + x + at] - value[v * W + u + at]);
                        sum += d * d;
                    }
                    if ((uint32_t)(v * W + u) == found[y * W + x])
                        got = sum;
                    if (abs(u - x) >= APART || abs(v - y) >= APART)
                        least = fmin(least, sum);
                }
            same += got <= least * 1.0001 + 1e-12;
        }
    assert_true(same > 0.97 * (W - 2) * (H - 2));
}

// ---------------------------------------------------------------- what is refused

static void refused(relume_status want, const char *why, struct relume_texture *t,
                    struct relume_grow_params p)
{
    struct test_log log;
    uint32_t texel[16];
    test_log_init(&log);
    p.struct_size = sizeof p;
    p.log = &log.log;
    assert_int_equal(relume_texture_grow(texel, 4, 4, t, &p), want);
    assert_non_null(strstr(log.text, why));
}

static void test_refused(void **state)
{
    (void)state;
    struct relume_texture t = paint(24, 16, 1, lattice), small = paint(7, 16, 1, lattice);
    relume_regular *other = find(&t, false);
    t.height = 12;
    refused(RELUME_EINVAL, "of a texture of 24 x 16 texels; expected 24 x 12", &t,
            (struct relume_grow_params){.regular = other});
    t.height = 16;
    refused(RELUME_EUNFIT, "at least 8 x 8 texels; found 7 x 16", &small,
            (struct relume_grow_params){0});
    refused(RELUME_EINVAL, "an odd number from 3 to 9; found 4", &t,
            (struct relume_grow_params){.neighbourhood = 4});
    refused(RELUME_EINVAL, "patch: expected an even number from 4 to 16; found 18", &t,
            (struct relume_grow_params){.patch = 18});
    refused(RELUME_EINVAL, "alike: expected 1 to 8; found 9", &t,
            (struct relume_grow_params){.alike = 9});
    refused(RELUME_EINVAL, "weight", &t, (struct relume_grow_params){.weight = NAN});
    t.value[30] = NAN;
    refused(RELUME_EUNFIT, "row 1, column 6: expected a number; found nan", &t,
            (struct relume_grow_params){0});
    relume_regular *r;
    assert_int_equal(relume_regular_find(&r, &t, NULL), RELUME_EUNFIT);
    t.value[30] = 0.0f;
    assert_int_equal(relume_regular_find(&r, &t, relume_regular_params(.threshold = 0.01)),
                     RELUME_EINVAL);
    uint32_t texel;
    assert_int_equal(relume_texture_grow(&texel, 1 << 20, 1 << 20, &t, NULL), RELUME_ELIMIT);
    assert_int_equal(relume_texture_grow(&texel, 0, 1, &t, NULL), RELUME_ELIMIT);
    relume_regular_destroy(&other);
    relume_texture_destroy(&t);
    relume_texture_destroy(&small);
}

// Every allocation fails once.
static void test_memory(void **state)
{
    (void)state;
    struct relume_texture t = paint(16, 16, 3, checks);
    uint32_t texel[20 * 20];
    for (int m = 0; m < METHODS; m++)
        for (long n = 1;; n += n < 30 ? 1 : TEST_SANITIZED ? 61 : 11) {
            struct relume_grow_quality q;
            relume_regular *r = NULL;
            mem_fail_after(n);
            relume_status status = relume_regular_find(&r, &t, relume_regular_params(.threads = 1));
            if (!status)
                status = relume_texture_grow(
                    texel, 20, 20, &t,
                    relume_grow_params(.regular = r, .method = methods[m], .threads = 1));
            if (!status)
                status = relume_grow_judge(&q, texel, 20, 20, &t,
                                           relume_grow_quality_params(.regular = r, .threads = 1));
            const bool done = mem_fail_pending();
            mem_fail_after(0);
            relume_regular_destroy(&r);
            assert_true(status == RELUME_ENOMEM || (done && status == RELUME_OK));
            if (done)
                break;
        }
    relume_texture_destroy(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_planted_waves),
        cmocka_unit_test(test_base),
        cmocka_unit_test(test_nothing_repeats),
        cmocka_unit_test(test_mask),
        cmocka_unit_test(test_regular_exact),
        cmocka_unit_test(test_tiles_close),
        cmocka_unit_test(test_threads_and_seeds),
        cmocka_unit_test(test_any_size),
        cmocka_unit_test(test_judge_tiling),
        cmocka_unit_test(test_apply),
        cmocka_unit_test(test_alike),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
