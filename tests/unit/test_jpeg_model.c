// test_jpeg_model.c - the bytes of photographs as JPEG files by the model, against libjpeg's
#include "test.h"

#include "capture_fixture.h"
#include "encode/encode/jpeg_model.h"
#include "format/coder/coding.h"
#include "in_folder.h"

#include <stdlib.h>

#include <jpeglib.h>

enum { LIGHTS = 5, WIDTH = 250, HEIGHT = 190 };
static const struct fixture f = {
    .width = WIDTH, .height = HEIGHT, .lights = LIGHTS, .views = 1, .hemisphere = true};

// Display values: waves, edges, and noise of that size.
static float value_at(int x, int y, int c, int light, float noise, unsigned *n)
{
    const float wave = 0.2f * sinf(0.07f * (float)(x + 5 * light)) * cosf(0.05f * (float)(y + c));
    const float edge = (x / 37 + y / 23) % 2 ? 0.12f : 0.0f;
    *n = *n * 1664525u + 1013904223u;
    return 0.4f + wave + edge + noise * ((float)(*n >> 8) / 0x1p24f - 0.5f);
}

static size_t libjpeg_bytes(uint8_t *rgb)
{
    struct jpeg_compress_struct info;
    struct jpeg_error_mgr errors;
    unsigned char *bytes = NULL;
    unsigned long size = 0;
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    jpeg_mem_dest(&info, &bytes, &size);
    info.image_width = WIDTH;
    info.image_height = HEIGHT;
    info.input_components = 3;
    info.in_color_space = JCS_RGB;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, 90, TRUE);
    info.optimize_coding = TRUE;
    jpeg_start_compress(&info, TRUE);
    for (int y = 0; y < HEIGHT; y++) {
        JSAMPROW row = rgb + 3 * WIDTH * y;
        jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    free(bytes);
    return size;
}

// Writes the photographs, and returns what libjpeg makes of them.
static double write_photographs(float noise)
{
    static uint8_t rgb[3 * WIDTH * HEIGHT];
    const struct relume_transfer curve = {.curve = RELUME_CURVE_SRGB};
    double bytes = 0.0;
    unsigned n = 1;
    for (int i = 0; i < LIGHTS; i++) {
        struct relume_image image;
        char name[32];
        snprintf(name, sizeof name, "v0-%d.exr", i);
        CHECK_OK(relume_image_load(&image, path_of(name), NULL));
        for (int k = 0; k < 3 * WIDTH * HEIGHT; k++) {
            const float v = value_at(k / 3 % WIDTH, k / 3 / WIDTH, k % 3, i, noise, &n);
            rgb[k] = (uint8_t)lrintf(255.0f * v);
            image.data[k] = relume_transfer_decode(curve, (float)rgb[k] / 255.0f);
        }
        CHECK_OK(relume_image_save(&image, path_of(name), NULL));
        relume_image_destroy(&image);
        bytes += (double)libjpeg_bytes(rgb);
    }
    return bytes;
}

// The entropy stands for Huffman codes, and some of the units for all.
static void test_bytes(void **state)
{
    static const float noise[] = {0.0f, 0.02f, 0.1f};
    (void)state;
    for (size_t i = 0; i < sizeof noise / sizeof *noise; i++) {
        relume_capture *capture;
        double model;
        fixture_write(&f, folder);
        const double real = write_photographs(noise[i]);
        CHECK_OK(relume_capture_open(&capture, folder, NULL));
        CHECK_OK(jpeg_model_bytes(&model, capture, NULL, 1, NULL));
        print_message("  noise %.2f: %.0f bytes by the model, %.0f by libjpeg\n", noise[i], model,
                      real);
        assert_true(model > 0.9 * real && model < 1.1 * real);
        double again;
        CHECK_OK(jpeg_model_bytes(&again, capture, NULL, 3, NULL));
        assert_true(again == model);
        relume_capture_destroy(&capture);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bytes),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
