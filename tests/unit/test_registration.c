// Photographs that were taken after the camera had been moved are found, named and moved back
#include "test.h"

#include "core/math/vec.h"

#include <relume/capture/acquire.h>
#include <relume/image.h>

enum { SHOTS = 18, MOST_WIDTH = 160 };

struct set {
    int width, height;
    double texture;      // contrast of the paint: 0 is a bare relief
    double (*shift)[2];  // [SHOTS] pixels to the right and down
    int black;           // this one is black; 0: none
    char folder[64], lights[96], out[96];
    char path[SHOTS][96];
    const char *list[SHOTS];
};

static struct relume_vec3 lamp(int i)
{
    const double z = 0.45 + 0.5 * (i + 0.5) / SHOTS, phi = 2.399963 * i, r = sqrt(1.0 - z * z);
    return vec3_of(r * cos(phi), r * sin(phi), z);
}

static double random_unit(unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (double)(1u << 24);
}

// Slopes of a relief of waves.
static void slope(double x, double y, double out[2])
{
    static const double wave[][3] = {
        {0.21, 0.05, 0.5}, {-0.07, 0.26, 0.4}, {0.33, -0.29, 0.35}, {0.11, 0.47, 0.3}};
    out[0] = out[1] = 0.0;
    for (size_t i = 0; i < sizeof wave / sizeof *wave; i++) {
        const double c = wave[i][2] * cos(wave[i][0] * x + wave[i][1] * y + (double)i);
        out[0] += c * wave[i][0] * 3.0;
        out[1] += c * wave[i][1] * 3.0;
    }
}

// Blots of paint, which no lamp moves.
static double paint(double x, double y)
{
    return tanh(4.0 * sin(0.4 * x + 1.3 * sin(0.17 * y)) * sin(0.31 * y + 1.7 * sin(0.13 * x)));
}

// Matte relief under a distant lamp, seen through a camera that was moved.
static void photograph(struct relume_image *out, const struct set *s, int i)
{
    const vec3 light = lamp(i);
    unsigned seed = 17u + (unsigned)i;
    CHECK_OK(relume_image_create(out, s->width, s->height, 3));
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            double g[2];
            const double u = x - s->shift[i][0], v = y - s->shift[i][1];
            slope(u, v, g);
            const vec3 normal = vec3_unit(vec3_of(-g[0], g[1], 1.0));
            const double value =
                (0.55 + 0.35 * s->texture * paint(u, v)) * fmax(vec3_dot(normal, light), 0.0);
            for (int c = 0; c < 3; c++)
                out->data[3 * (y * s->width + x) + c] =
                    i && i == s->black ? 0.0f : (float)(value + 0.004 * (random_unit(&seed) - 0.5));
        }
}

static void take(struct set *s)
{
    test_folder(s->folder);
    snprintf(s->out, sizeof s->out, "%s/out", s->folder);
    snprintf(s->lights, sizeof s->lights, "%s/lights.lp", s->folder);
    FILE *list = fopen(s->lights, "w");
    assert_non_null(list);
    fprintf(list, "%d\n", SHOTS);
    for (int i = 0; i < SHOTS; i++) {
        struct relume_image image;
        // in one plane: no surface is fitted, which would take most of the time
        const vec3 l = vec3_unit(vec3_of(i - 8.5, 0.0, 5.0));
        snprintf(s->path[i], sizeof s->path[i], "%.63s/p%02d.png", s->folder, i);
        fprintf(list, "p%02d.png %.6f %.6f %.6f\n", i, l.x, l.y, l.z);
        s->list[i] = s->path[i];
        photograph(&image, s, i);
        CHECK_OK(relume_image_save(&image, s->path[i], NULL));
        relume_image_destroy(&image);
    }
    assert_int_equal(fclose(list), 0);
}

// Captures the set; `count` receives the sentences about moves, `text` the last of them.
static void capture(struct set *s, bool leave, struct relume_acquisition *out, int *count,
                    char text[512])
{
    const struct relume_acquire_params p = {
        .lights = s->lights, .no_registration = leave, .force = true};
    CHECK_OK(relume_capture_photographs(s->out, s->list, SHOTS, &p, out));
    assert_int_equal(out->lights, SHOTS - (s->black > 0));  // a misfire is left out
    *count = 0;
    *text = '\0';
    for (int i = 0; i < out->warnings; i++)
        if (strstr(out->warning[i], "the scene lies")) {
            ++*count;
            snprintf(text, 512, "%s", out->warning[i]);
        }
}

static struct set set_of(double texture, double (*shift)[2])
{
    return (struct set){.width = 112, .height = 84, .texture = texture, .shift = shift};
}

// Largest difference of a captured image from the photograph of a camera that stood still, away
// from the border, where the moved photograph has nothing.
static double off_still(const struct set *s, int i)
{
    static double none[SHOTS][2];
    struct set still = *s;
    struct relume_image image, wanted;
    char path[160];
    double most = 0.0;
    still.shift = none;
    photograph(&wanted, &still, i);
    snprintf(path, sizeof path, "%s/light%04d.exr", s->out, i);
    CHECK_OK(relume_image_load(&image, path, NULL));
    for (int y = 8; y < s->height - 8; y++)
        for (int x = 8; x < s->width - 8; x++) {
            const int at = 3 * (y * s->width + x);
            most = fmax(most, fabs((double)image.data[at] - (double)wanted.data[at]));
        }
    relume_image_destroy(&image);
    relume_image_destroy(&wanted);
    return most;
}

static void check_moved(double texture, double (*shift)[2], int runs, const char *says)
{
    struct set s = set_of(texture, shift);
    struct relume_acquisition out;
    int count;
    char text[512];
    take(&s);
    capture(&s, false, &out, &count, text);
    assert_int_equal(count, runs);
    assert_non_null(strstr(text, says));
    for (int i = 0; i < SHOTS; i++) {
        CHECK_NEAR(out.photo[i].shift[0], shift[i][0], 0.1);
        CHECK_NEAR(out.photo[i].shift[1], shift[i][1], 0.1);
        // 0.1 pixels on the steepest edges of the paint, which rise by about 1 a pixel
        assert_true(off_still(&s, i) < 0.1);
    }
    relume_acquisition_destroy(&out);
    // with the moves left in, edges of the paint differ by more
    capture(&s, true, &out, &count, text);
    assert_int_equal(count, 0);
    assert_true(off_still(&s, SHOTS - 1) > 0.12 || shift[SHOTS - 1][0] == 0.0);
    relume_acquisition_destroy(&out);
    test_folder_remove(s.folder);
}

static void from_one_photograph_on(void **state)
{
    double shift[SHOTS][2] = {{0}};
    (void)state;
    for (int i = 11; i < SHOTS; i++) {
        shift[i][0] = 3.0;
        shift[i][1] = 0.0;
    }
    check_moved(1.0, shift, 1, "p11.png on the scene lies 3.0 pixels to the right");
}

static void by_parts_of_pixels_and_back(void **state)
{
    double shift[SHOTS][2] = {{0}};
    (void)state;
    for (int i = 4; i < 9; i++) {
        shift[i][0] = -1.4;
        shift[i][1] = 0.7;
    }
    check_moved(1.0, shift, 1, "p08.png the scene lies");
}

static void one_photograph(void **state)
{
    double shift[SHOTS][2] = {{0}};
    (void)state;
    shift[7][1] = 2.5;
    check_moved(1.0, shift, 1, "p07.png: the scene lies 2.5 pixels down");
}

static void twice(void **state)
{
    double shift[SHOTS][2] = {{0}};
    (void)state;
    for (int i = 8; i < SHOTS; i++)
        shift[i][0] = i < 13 ? 2.0 : 5.0;
    check_moved(1.0, shift, 2, "5.0 pixels to the right");
}

static void check_still(double texture, double (*shift)[2], int black)
{
    struct set s = set_of(texture, shift);
    struct relume_acquisition out;
    int count;
    char text[512];
    s.black = black;
    take(&s);
    capture(&s, false, &out, &count, text);
    assert_int_equal(count, 0);
    for (int i = 0; i < out.lights; i++)
        assert_true(out.photo[i].shift[0] == 0.0 && out.photo[i].shift[1] == 0.0);
    relume_acquisition_destroy(&out);
    test_folder_remove(s.folder);
}

// Shadows of a bare relief wander with the lamp; a black photograph lies nowhere.
static void a_camera_that_stood_still(void **state)
{
    double shift[SHOTS][2] = {{0}};
    (void)state;
    check_still(1.0, shift, 0);
    check_still(0.0, shift, 0);
    check_still(1.0, shift, 9);
}

static void less_than_half_a_pixel_stays(void **state)
{
    double shift[SHOTS][2] = {{0}};
    (void)state;
    for (int i = 9; i < SHOTS; i++)
        shift[i][0] = 0.3;
    check_still(1.0, shift, 0);
}

static void pictures_of_a_few_pixels(void **state)
{
    double shift[SHOTS][2] = {{0}};
    static const int size[][2] = {{1, 1}, {9, 2}, {3, 40}, {17, 17}};
    (void)state;
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        struct set s = set_of(1.0, shift);
        struct relume_acquisition out;
        int count;
        char text[512];
        s.width = size[i][0];
        s.height = size[i][1];
        take(&s);
        capture(&s, false, &out, &count, text);
        assert_int_equal(count, 0);
        relume_acquisition_destroy(&out);
        test_folder_remove(s.folder);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(from_one_photograph_on),
        cmocka_unit_test(by_parts_of_pixels_and_back),
        cmocka_unit_test(one_photograph),
        cmocka_unit_test(twice),
        cmocka_unit_test(a_camera_that_stood_still),
        cmocka_unit_test(less_than_half_a_pixel_stays),
        cmocka_unit_test(pictures_of_a_few_pixels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
