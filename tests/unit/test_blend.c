// Blending by bands against the formula in double precision over the whole panorama, and what it
// is for: steps of brightness, fine detail and what moved at a seam.
#include "test.h"

#include "capture/multiview/blend.h"

enum { WIDTH = 67, HEIGHT = 32, PICTURES = 3, PIXELS = WIDTH * HEIGHT, BANDS = 4 };

struct panorama {
    struct blend blend;
    uint16_t owner[PIXELS];
    float picture[PICTURES][3 * PIXELS];
    float sums[3 * PIXELS];
};

static void fetch(float *rgba, const void *context, int picture, int x, int y, int n)
{
    const struct panorama *p = context;
    for (int i = 0; i < n; i++)
        memcpy(rgba + 4 * i, p->picture[picture] + 3 * (y * WIDTH + (x + i) % WIDTH),
               3 * sizeof *rgba);
}

static struct panorama *begin(int bands)
{
    struct panorama *p = calloc(1, sizeof *p);
    assert_non_null(p);
    p->blend = (struct blend){WIDTH, HEIGHT, bands, PICTURES, p->owner, NULL};
    return p;
}

static void blend_all(struct panorama *p, int threads)
{
    CHECK_OK(blend_begin(&p->blend));
    memset(p->sums, 0, sizeof p->sums);
    for (int i = 0; i < PICTURES; i++)
        CHECK_OK(blend_add(p->sums, &p->blend, i, fetch, p, threads));
    relume_free(p->blend.box);
}

static void end(struct panorama *p)
{
    free(p);
}

// ---------------------------------------------------------------- the formula

static int index_of(int x, int y)
{
    if (y < 0 || y >= HEIGHT) {  // over a pole, half around
        y = y < 0 ? -1 - y : 2 * HEIGHT - 1 - y;
        x += WIDTH / 2;
    }
    return y * WIDTH + ((x % WIDTH) + WIDTH) % WIDTH;
}

static void smooth(double *out, const double *in, int step)
{
    static const double kernel[5] = {1 / 16.0, 4 / 16.0, 6 / 16.0, 4 / 16.0, 1 / 16.0};
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double sum = 0.0;
            for (int j = -2; j <= 2; j++)
                for (int i = -2; i <= 2; i++)
                    sum += kernel[i + 2] * kernel[j + 2] * in[index_of(x + i * step, y + j * step)];
            out[y * WIDTH + x] = sum;
        }
}

static void add_by_formula(double *sums, const struct panorama *p, int picture, int c, int bands)
{
    static double mask[2][PIXELS], image[2][PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        mask[0][i] = (p->owner[i] & ~BLEND_UNSEEN) == picture;
        image[0][i] = p->picture[picture][3 * i + c];
    }
    int k = 0;
    for (; k < bands - 1; k++) {
        double *fine = image[k % 2], *coarse = image[(k + 1) % 2];
        smooth(mask[(k + 1) % 2], mask[k % 2], 1 << k);
        smooth(coarse, fine, 1 << k);
        for (int i = 0; i < PIXELS; i++)
            sums[i] += mask[(k + 1) % 2][i] * (fine[i] - coarse[i]);
    }
    for (int i = 0; i < PIXELS; i++)
        sums[i] += mask[k % 2][i] * image[k % 2][i];
}

static void fill_with_noise(struct panorama *p, uint32_t seed)
{
    for (int i = 0; i < PICTURES; i++)
        for (int k = 0; k < 3 * PIXELS; k++)
            p->picture[i][k] = (float)test_uniform(&seed);
}

// Slanted patches that go on across the ends and lie on both poles.
static void own_patches(struct panorama *p)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            p->owner[y * WIDTH + x] = (uint16_t)(((x + y / 2 + 9) % WIDTH) * PICTURES / WIDTH);
}

static void bands_follow_the_formula(void **state)
{
    (void)state;
    for (int bands = 1; bands <= BANDS; bands++) {
        struct panorama *p = begin(bands);
        fill_with_noise(p, 5);
        own_patches(p);
        blend_all(p, 1);
        for (int c = 0; c < 3; c++) {
            static double want[PIXELS];
            memset(want, 0, sizeof want);
            for (int i = 0; i < PICTURES; i++)
                add_by_formula(want, p, i, c, bands);
            for (int i = 0; i < PIXELS; i++)  // sums of some ten floats below 1
                CHECK_NEAR(p->sums[3 * i + c], want[i], 2e-6);
        }
        end(p);
    }
}

// A patch in the middle, whose box is a part of the panorama, comes out as where its box is all.
static void boxes_leave_nothing_out(void **state)
{
    (void)state;
    for (int across = 0; across < 2; across++) {
        struct panorama *p = begin(2);
        fill_with_noise(p, 6);
        for (int y = 14; y < 18; y++)
            for (int x = 0; x < 9; x++)
                p->owner[y * WIDTH + (x + (across ? WIDTH - 4 : 20)) % WIDTH] = 1;
        blend_all(p, 1);
        static double want[PIXELS];
        memset(want, 0, sizeof want);
        for (int i = 0; i < 2; i++)
            add_by_formula(want, p, i, 1, 2);
        for (int i = 0; i < PIXELS; i++)
            CHECK_NEAR(p->sums[3 * i + 1], want[i], 2e-6);
        end(p);
    }
}

static void pictures_that_agree_stay(void **state)
{
    (void)state;
    struct panorama *p = begin(BANDS);
    uint32_t seed = 7;
    fill_with_noise(p, 8);
    for (int i = 1; i < PICTURES; i++)
        memcpy(p->picture[i], p->picture[0], sizeof p->picture[0]);
    for (int i = 0; i < PIXELS; i++)
        p->owner[i] = (uint16_t)(test_random(&seed) % PICTURES);
    blend_all(p, 2);
    for (int i = 0; i < 3 * PIXELS; i++)
        CHECK_NEAR(p->sums[i], p->picture[0][i], 2e-6);
    end(p);
}

// ---------------------------------------------------------------- seams

enum { SEAM = 33 };  // picture 0 to its left, 1 from there on

static void own_halves(struct panorama *p)
{
    for (int i = 0; i < PIXELS; i++)
        p->owner[i] = i % WIDTH >= SEAM;
}

// Three smoothings by 1, 2 and 4 pixels' steps have variances of 1, 4 and 16: the step becomes
// about the integral of their Gaussian, whose steepest rise is 1 / sqrt(2 pi 21) of it. (Rows from
// which the poles, and with them the other side's seam, are out of reach.)
static void a_step_of_brightness_is_spread(void **state)
{
    (void)state;
    struct panorama *p = begin(BANDS);
    own_halves(p);
    for (int i = 0; i < 3 * PIXELS; i++) {
        p->picture[0][i] = 0.75f;
        p->picture[1][i] = 1.0f;
    }
    blend_all(p, 1);
    float steepest = 0.0f;
    for (int y = 14; y < HEIGHT - 14; y++)
        for (int x = 15; x < WIDTH - 15; x++) {
            const float *at = p->sums + 3 * (y * WIDTH + x);
            assert_true(at[3] >= at[0] - 1e-6f);
            steepest = fmaxf(steepest, at[3] - at[0]);
        }
    CHECK_NEAR(steepest, 0.25 / sqrt(2.0 * 3.14159265 * 21.0), 0.002);
    CHECK_NEAR(p->sums[3 * (16 * WIDTH + SEAM - 16)], 0.75, 1e-3);
    CHECK_NEAR(p->sums[3 * (16 * WIDTH + SEAM + 16)], 1.0, 1e-3);
    end(p);
}

// A chessboard of pixels is nothing but the finest band; two pixels from the seam it is its
// owner's alone.
static void fine_detail_changes_at_once(void **state)
{
    (void)state;
    struct panorama *p = begin(BANDS);
    own_halves(p);
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++) {
            const float board = (i % WIDTH + i / WIDTH) % 2 ? 0.25f : -0.25f;
            p->picture[0][3 * i + c] = 0.5f + board;
            p->picture[1][3 * i + c] = 0.5f - board;
        }
    blend_all(p, 1);
    for (int x = 8; x < WIDTH - 8; x++)
        if (x < SEAM - 2 || x >= SEAM + 2)
            CHECK_NEAR(p->sums[3 * (16 * WIDTH + x)], p->picture[x >= SEAM][3 * (16 * WIDTH + x)],
                       2e-6);
    end(p);
}

// A small thing that only the left picture shows, at the right of the seam. A plain mean with the
// weights of the coarsest band would show a fifth of it.
static void what_moved_is_not_seen_twice(void **state)
{
    (void)state;
    struct panorama *p = begin(BANDS);
    own_halves(p);
    for (int y = 15; y <= 16; y++)
        for (int x = SEAM + 4; x <= SEAM + 5; x++)
            for (int c = 0; c < 3; c++)
                p->picture[0][3 * (y * WIDTH + x) + c] = 1.0f;
    blend_all(p, 1);
    for (int i = 0; i < 3 * PIXELS; i++)
        assert_true(fabsf(p->sums[i]) < 0.03f);
    end(p);
}

// ---------------------------------------------------------------- edges

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    struct panorama *p = begin(BANDS);
    static float first[3 * PIXELS];
    fill_with_noise(p, 9);
    own_patches(p);
    blend_all(p, 1);
    memcpy(first, p->sums, sizeof first);
    blend_all(p, 5);
    assert_memory_equal(first, p->sums, sizeof first);
    end(p);
}

static void the_unseen_is_black_and_light_not_negative(void **state)
{
    (void)state;
    struct panorama *p = begin(2);
    for (int i = 0; i < 3 * PIXELS; i++)
        p->sums[i] = i % 2 ? -1.0f : 1.0f;
    p->owner[5] = 1 | BLEND_UNSEEN;
    blend_finish(p->sums, &p->blend);
    for (int i = 0; i < 3 * PIXELS; i++)
        assert_true(p->sums[i] == (i % 2 || i / 3 == 5 ? 0.0f : 1.0f));
    end(p);
}

static void more_bands_than_the_panorama_holds(void **state)
{
    (void)state;
    struct panorama *p = begin(BLEND_BANDS);
    own_patches(p);
    for (int i = 0; i < PICTURES; i++)
        for (int k = 0; k < 3 * PIXELS; k++)
            p->picture[i][k] = 0.5f;
    blend_all(p, 2);
    for (int i = 0; i < 3 * PIXELS; i++)
        CHECK_NEAR(p->sums[i], 0.5, 1e-5);
    end(p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bands_follow_the_formula),
        cmocka_unit_test(boxes_leave_nothing_out),
        cmocka_unit_test(pictures_that_agree_stay),
        cmocka_unit_test(a_step_of_brightness_is_spread),
        cmocka_unit_test(fine_detail_changes_at_once),
        cmocka_unit_test(what_moved_is_not_seen_twice),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(the_unseen_is_black_and_light_not_negative),
        cmocka_unit_test(more_bands_than_the_panorama_holds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
