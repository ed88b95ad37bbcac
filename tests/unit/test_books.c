// test_books.c - relighting from codebooks against the sum of their vectors in double precision
#include "test.h"

#include "core/base/memory.h"
#include "relight/light/refit.h"

enum { W = 37, H = 11, PIXELS = W * H, LIGHTS = 12, MOST_BOOKS = 3, MOST_PLANES = 3 * 16 };
static const int counts[MOST_BOOKS] = {300, 7, 1};

struct setup {
    relume_coder *coder;
    float *vectors[MOST_BOOKS];
    uint16_t *index[MOST_BOOKS];
    struct relume_codes codes;
};

static void make(struct setup *s, int books, enum relume_domain domain)
{
    uint32_t seed = 3;
    struct relume_vec3 directions[60];
    for (int i = 0; i < 60; i++)
        directions[i] = test_direction(&seed);
    CHECK_OK(relume_coder_create(&s->coder, &relume_basis_sh, directions, 60,
                                 relume_coder_params(.coefficients = 16)));
    const int planes = relume_coder_info(s->coder)->planes;
    for (int b = 0; b < MOST_BOOKS; b++) {
        s->vectors[b] = malloc((size_t)(counts[b] * planes) * sizeof(float));
        s->index[b] = malloc(PIXELS * sizeof(uint16_t));
        for (int i = 0; i < counts[b] * planes; i++)
            s->vectors[b][i] = (float)((i % planes < 3 ? 0.8 : 0.1) * test_uniform(&seed) - 0.05);
        for (int i = 0; i < PIXELS; i++)
            s->index[b][i] = (uint16_t)(test_random(&seed) % (uint32_t)counts[b]);
    }
    s->codes = (struct relume_codes){
        .coder = s->coder,
        .domain = domain,
        .display = {.curve = RELUME_CURVE_SRGB},
        .width = W,
        .height = H,
        .planes = planes,
        .books = books,
        .index = (const uint16_t *const *)s->index,
        .vectors = (const float *const *)s->vectors,
        .book_codes = counts,
    };
}

static void drop(struct setup *s)
{
    for (int b = 0; b < MOST_BOOKS; b++) {
        free(s->vectors[b]);
        free(s->index[b]);
    }
    relume_coder_destroy(&s->coder);
}

static double coded(const struct setup *s, int pixel, int c, const float *weights,
                    const float *constant)
{
    const int k = relume_coder_info(s->coder)->coefficients;
    double sum = (double)constant[c];
    for (int b = 0; b < s->codes.books; b++)
        for (int i = 0; i < k; i++)
            sum += (double)weights[c * k + i] *
                   (double)s->vectors[b][s->index[b][pixel] * s->codes.planes + 3 * i + c];
    return sum;
}

static double slow(const struct setup *s, int pixel, int c, const struct relume_light *lights,
                   int n)
{
    float weights[MOST_PLANES], constant[3];
    double sum = 0.0;
    for (int i = 0; i < n; i++) {
        const struct relume_vec3 d = lights[i].direction;
        const double length = sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
        relume_coder_weights(s->coder,
                             (struct relume_vec3){d.x / length, d.y / length, d.z / length},
                             weights, constant);
        const double v = coded(s, pixel, c, weights, constant);
        sum += (double)lights[i].rgb[c] *
               (s->codes.domain == RELUME_DOMAIN_DISPLAY
                    ? (double)relume_transfer_decode(s->codes.display, (float)v)
                    : v);
    }
    return sum;
}

static const struct relume_light lights[] = {
    {.direction = {2, 0, 0.5}, .rgb = {1, 0.5f, 0.25f}},
    {.direction = {0.3, -0.5, 0.7}, .rgb = {0.2f, 0.3f, 0.6f}},
    {.direction = {-0.1, 0.2, -0.7}, .rgb = {0.1f, 0.3f, 0.1f}},
};

// Sums of 48 products of size 1 in single precision; the curve's straight pieces.
static const double TOLERANCE = 5e-6;

static void test_images(void **state)
{
    (void)state;
    for (int domain = RELUME_DOMAIN_LINEAR; domain <= RELUME_DOMAIN_DISPLAY; domain++)
        for (int books = 1; books <= MOST_BOOKS; books++)
            for (int n = 0; n <= 3; n++) {
                struct setup s;
                struct relume_image out = {0};
                make(&s, books, (enum relume_domain)domain);
                CHECK_OK(relume_relight(&out, &s.codes, lights, n, NULL));
                for (int i = 0; i < PIXELS; i++) {
                    double rgb[3];
                    relume_relight_pixel(rgb, &s.codes, i % W, i / W, lights, n);
                    for (int c = 0; c < 3; c++) {
                        const double want = slow(&s, i, c, lights, n);
                        CHECK_NEAR(out.data[3 * i + c], want, TOLERANCE);
                        CHECK_NEAR(rgb[c], want, TOLERANCE);
                    }
                }
                relume_image_destroy(&out);
                drop(&s);
            }
}

static double srgb(double v)
{
    v = v < 0.0 ? 0.0 : v > 1.0 ? 1.0 : v;
    return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
}

static void check_bytes(const struct setup *s, const struct relume_codes *codes, int n, float ev)
{
    uint32_t words[PIXELS + 1];
    for (int off = 0; off < 2; off++) {
        words[PIXELS] = 0x12345678u;
        CHECK_OK(relume_relight_rgba8(
            (uint8_t *)words, codes, lights, n,
            relume_relight_params(.cpu_off = off ? ~0u : 0u, .exposure_ev = ev)));
        assert_true(words[PIXELS] == 0x12345678u);
        for (int i = 0; i < PIXELS; i++) {
            const uint8_t *pixel = (const uint8_t *)&words[i];
            for (int c = 0; c < 3; c++)  // rounding: half a code, and what is off before it
                CHECK_NEAR(pixel[c], 255.0 * srgb(exp2((double)ev) * slow(s, i, c, lights, n)),
                           0.51);
            assert_int_equal(pixel[3], 255);
        }
    }
}

static void test_bytes(void **state)
{
    (void)state;
    for (int domain = RELUME_DOMAIN_LINEAR; domain <= RELUME_DOMAIN_DISPLAY; domain++)
        for (int books = 1; books <= MOST_BOOKS; books++)
            for (int n = 0; n <= 3; n++) {
                struct setup s;
                make(&s, books, (enum relume_domain)domain);
                check_bytes(&s, &s.codes, n, n == 2 ? -1.5f : 0.0f);
                drop(&s);
            }
}

// Codes in planes give the same bytes as the same values in a codebook of as many vectors.
static void test_bytes_of_planes(void **state)
{
    (void)state;
    struct setup s;
    make(&s, 1, RELUME_DOMAIN_DISPLAY);
    const int planes = s.codes.planes;
    uint16_t *words = malloc((size_t)(planes * PIXELS) * sizeof *words);
    const void *plane[MOST_PLANES];
    float scale[MOST_PLANES], offset[MOST_PLANES];
    for (int p = 0; p < planes; p++) {
        plane[p] = words + p * PIXELS;
        scale[p] = 1.0f / 65536.0f;
        offset[p] = -0.125f;
        for (int i = 0; i < PIXELS; i++) {
            float *v = &s.vectors[0][s.index[0][i] * planes + p];
            const int word = (int)((*v + 0.125f) * 65536.0f + 0.5f);
            words[p * PIXELS + i] = (uint16_t)word;
            *v = (float)word / 65536.0f - 0.125f;
        }
    }
    struct relume_codes codes = s.codes;
    codes.books = 0;
    codes.storage = RELUME_STORE_16;
    codes.plane = plane;
    codes.scale = scale;
    codes.offset = offset;
    check_bytes(&s, &codes, 2, 0.0f);
    free(words);
    drop(&s);
}

static void test_point_lights(void **state)
{
    (void)state;
    for (int domain = RELUME_DOMAIN_LINEAR; domain <= RELUME_DOMAIN_DISPLAY; domain++)
        for (int books = 1; books <= 2; books++) {
            struct setup s;
            struct relume_image surface, out = {0};
            make(&s, books, (enum relume_domain)domain);
            CHECK_OK(relume_image_create(&surface, W, H, 3));
            uint32_t seed = 1;
            for (int i = 0; i < 3 * PIXELS; i++)
                surface.data[i] = (float)test_uniform(&seed);
            const struct relume_light both[] = {lights[0],
                                                {.kind = RELUME_LIGHT_POINT,
                                                 .nofall = true,
                                                 .position = {0.4, -0.2, 3},
                                                 .rgb = {1, 2, 3}}};
            CHECK_OK(relume_relight(&out, &s.codes, both, 2,
                                    relume_relight_params(.surface = &surface)));
            for (int i = 0; i < PIXELS; i++) {
                const float *p = surface.data + 3 * i;
                const struct relume_light there = {
                    .direction = {0.4 - (double)p[0], -0.2 - (double)p[1], 3 - (double)p[2]},
                    .rgb = {1, 2, 3}};
                for (int c = 0; c < 3; c++)
                    CHECK_NEAR(out.data[3 * i + c],
                               slow(&s, i, c, lights, 1) + slow(&s, i, c, &there, 1),
                               3e-3);  // 1e-3 by the weight grid, for light of value 3
            }
            relume_image_destroy(&surface);
            relume_image_destroy(&out);
            drop(&s);
        }
}

static void test_tables(void **state)
{
    (void)state;
    float rgb[300 * 3];
    struct setup s;
    make(&s, 1, RELUME_DOMAIN_DISPLAY);
    CHECK_OK(relume_relight_book(rgb, &s.codes, 0, lights, 3, NULL));
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(rgb[3 * s.index[0][i] + c], slow(&s, i, c, lights, 3), TOLERANCE);
    CHECK_OK(relume_relight_book(rgb, &s.codes, 0, lights, 0, NULL));
    assert_true(rgb[0] == 0.0f && rgb[899] == 0.0f);
    assert_int_equal(relume_relight_book(rgb, &s.codes, 1, lights, 1, NULL), RELUME_EINVAL);
    s.codes.books = 2;
    assert_int_equal(relume_relight_book(rgb, &s.codes, 0, lights, 2, NULL), RELUME_EINVAL);
    assert_int_equal(relume_relight_book(rgb, &s.codes, 0, lights, 0, NULL), RELUME_EINVAL);
    const struct relume_light nowhere = {.rgb = {1, 1, 1}};
    assert_int_equal(relume_relight_book(rgb, &s.codes, 0, &nowhere, 1, NULL), RELUME_EINVAL);
    drop(&s);
}

static void test_allocations(void **state)
{
    (void)state;
    struct setup s;
    static uint32_t words[PIXELS];
    make(&s, 2, RELUME_DOMAIN_DISPLAY);
    for (int books = 1; books <= 2; books++)
        for (int n = 1;; n++) {
            struct relume_image out = {0};
            s.codes.books = books;
            mem_fail_after(n);
            relume_status status = relume_relight(&out, &s.codes, lights, 3, NULL);
            if (!status)
                status = relume_relight_rgba8((uint8_t *)words, &s.codes, lights, 3, NULL);
            const bool done = mem_fail_pending();
            mem_fail_after(0);
            relume_image_destroy(&out);
            if (done) {
                CHECK_OK(status);
                break;
            }
            assert_int_equal(status, RELUME_ENOMEM);
        }
    drop(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_images),          cmocka_unit_test(test_bytes),
        cmocka_unit_test(test_bytes_of_planes), cmocka_unit_test(test_point_lights),
        cmocka_unit_test(test_tables),          cmocka_unit_test(test_allocations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
