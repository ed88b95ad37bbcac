// Pictures of fewer pixels: means, places, and quotients between them, over the seam of a panorama.
#include "test.h"

#include "world/object/coarse.h"

#include <math.h>

enum { W = 650, H = 325, FEWER = 3 };  // no multiple of it

static double wave(int i, int n)
{
    return 1.0 + 0.5 * cos(2.0 * M_PI * (i + 0.5) / n + 0.7);
}

// A quotient that goes around is there at every pixel, also where the panorama closes.
static void quotients_go_around(void **state)
{
    (void)state;
    struct relume_image fine, places, with, without, coarse;
    CHECK_OK(relume_image_create(&fine, W, H, 3));
    CHECK_OK(relume_image_create(&places, W, H, 3));
    for (size_t i = 0; i < 3 * (size_t)W * H; i++) {
        fine.data[i] = 2.0f;
        places.data[i] = (float)((i / 3) % W);
    }
    CHECK_OK(coarse_places(&coarse, &places, FEWER));
    assert_int_equal(coarse.width, 217);
    assert_int_equal(coarse.height, 108);
    for (int i = 0; i < coarse.width; i++)  // the middle of its part, to a pixel
        CHECK_NEAR(coarse.data[3 * i], (i + 0.5) * W / coarse.width - 0.5, 1.0);
    CHECK_OK(relume_image_create(&with, coarse.width, coarse.height, 3));
    CHECK_OK(relume_image_create(&without, coarse.width, coarse.height, 3));
    for (int i = 0; i < coarse.width * coarse.height; i++)
        for (int c = 0; c < 3; c++) {
            without.data[3 * i + c] = c == 2 ? 0.0f : 0.5f;
            with.data[3 * i + c] = (float)(0.5 * wave(i % coarse.width, coarse.width));
        }
    coarse_multiply(&fine, &with, &without, EDGE_WRAPPED, 2);
    for (int i = 0; i < W; i++) {
        CHECK_NEAR(fine.data[3 * (W * 7 + i)], 2.0 * wave(i, W), 1e-3);
        CHECK_NEAR(fine.data[3 * (W * 7 + i) + 2], 2.0, 1e-6);  // nothing is known of it
    }
    relume_image_destroy(&fine);
    relume_image_destroy(&places);
    relume_image_destroy(&coarse);
    relume_image_destroy(&with);
    relume_image_destroy(&without);
}

// Means keep the sum but for the unevenness of their parts, and all pixels have a part.
static void means_are_of_all_pixels(void **state)
{
    (void)state;
    struct relume_image ramp;
    CHECK_OK(relume_image_create(&ramp, W, H, 3));
    for (size_t i = 0; i < 3 * (size_t)W * H; i++)
        ramp.data[i] = (float)((i / 3) % W) + (i % 3 == 1 ? (float)(i / 3 / W) : 0.0f);
    coarse_means(&ramp, 217, 108);
    for (int i = 0; i < 217; i++) {
        CHECK_NEAR(ramp.data[3 * i], (i + 0.5) * W / 217 - 0.5, 0.51);
        CHECK_NEAR(ramp.data[3 * (107 * 217 + i) + 1] - ramp.data[3 * (107 * 217 + i)], H - 2.0,
                   0.51);
    }
    const float kept = ramp.data[30];
    coarse_means(&ramp, 217, 108);
    CHECK_NEAR(ramp.data[30], kept, 0.0);
    relume_image_destroy(&ramp);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quotients_go_around),
        cmocka_unit_test(means_are_of_all_pixels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
