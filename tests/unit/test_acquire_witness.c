// Lists of lights that are not those of the photographs: a ball shows it, or the surface does
#include "capture/acquire/acquire.h"
#include "image/image/photograph.h"
#include "made_ball.h"
#include "made_exif.h"
#include "test.h"

enum { LAMPS = 8 };

static vec3 lamp_at(int i)
{
    const double z = 0.5 + 0.4 * i / LAMPS, phi = 2.4 * i, r = sqrt(1.0 - z * z);
    return vec3_of(r * cos(phi), r * sin(phi), z);
}

struct photographs {
    char folder[64], out[96], lights[96];
    char path[LAMPS][96];
    const char *list[LAMPS];
};

// Photographs with an EXIF orientation are JPEG files.
static void photograph(struct photographs *p, int orientation)
{
    struct made_scene s = {.balls = 1,
                           .middle = {{0.4, -0.2, 0}},
                           .radius = {0.3},
                           .brightness = 8.0,
                           .distant = true};
    test_folder(p->folder);
    snprintf(p->out, sizeof p->out, "%.63s/out", p->folder);
    snprintf(p->lights, sizeof p->lights, "%.63s/l.lp", p->folder);
    for (int i = 0; i < LAMPS; i++) {
        struct relume_image image;
        s.lamp = lamp_at(i);
        CHECK_OK(made_photograph(&image, &s, 0.003));
        snprintf(p->path[i], sizeof p->path[i], "%.63s/p%d.%s", p->folder, i,
                 orientation ? "jpg" : "png");
        p->list[i] = p->path[i];
        CHECK_OK(relume_image_save(&image, p->path[i], NULL));
        if (orientation) {
            struct exif_bytes exif;
            exif_make(&exif, orientation);
            exif_insert(p->path[i], 0xe1, &exif);
        }
        relume_image_destroy(&image);
    }
}

// Lights `first` and `second` change places; all turn as photographs of an EXIF orientation do.
static void write_list(const struct photographs *p, vec3 scale, int first, int second, int turned)
{
    FILE *f = fopen(p->lights, "w");
    assert_non_null(f);
    fprintf(f, "%d\n", LAMPS);
    for (int i = 0; i < LAMPS; i++) {
        const vec3 l = lamp_at(i == first ? second : i == second ? first : i);
        double xy[] = {scale.x * l.x, scale.y * l.y};
        photograph_turn_vector(xy, turned);
        fprintf(f, "p%d %.6f %.6f %.6f\n", i, xy[0], xy[1], scale.z * l.z);
    }
    fclose(f);
}

// All lines.
struct lines {
    struct relume_log log;
    char text[8192];
};

static void keep_line(void *user, enum relume_level level, const char *text)
{
    struct lines *lines = user;
    const size_t at = strlen(lines->text);
    (void)level;
    snprintf(lines->text + at, sizeof lines->text - at, "%s\n", text);
}

static relume_status capture(const struct photographs *p, struct lines *lines)
{
    struct relume_acquire_params params = {.lights = p->lights, .force = true};
    *lines = (struct lines){.log = {.user = lines, .message = keep_line}};
    params.log = &lines->log;
    return relume_capture_photographs(p->out, p->list, LAMPS, &params, NULL);
}

static void a_ball_beside_a_list(void **state)
{
    (void)state;
    struct photographs p;
    struct lines log;
    photograph(&p, 0);
    write_list(&p, vec3_of(1, 1, 1), -1, -1, 1);
    CHECK_OK(capture(&p, &log));
    assert_non_null(strstr(log.text, "agrees with the ball"));
    assert_null(strstr(log.text, "elsewhere"));
    write_list(&p, vec3_of(1, -1, 1), -1, -1, 1);
    assert_int_equal(capture(&p, &log), RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "if y is negated"));
    write_list(&p, vec3_of(-1, -1, 1), -1, -1, 1);
    CHECK_OK(capture(&p, &log));
    assert_non_null(strstr(log.text, "if x and y are negated, or that round thing is hollow"));
    write_list(&p, vec3_of(1, 1, 1), 1, 5, 1);
    CHECK_OK(capture(&p, &log));
    assert_non_null(strstr(log.text, "it shows the light that the list gives to p5.png"));
    test_folder_remove(p.folder);
}

// Some lists belong to the photographs as they lie in their files, others to the upright ones.
static void photographs_held_sideways(void **state)
{
    (void)state;
    static const int orientation[] = {6, 7};
    for (size_t k = 0; k < sizeof orientation / sizeof *orientation; k++) {
        struct photographs p;
        struct lines log;
        photograph(&p, orientation[k]);
        write_list(&p, vec3_of(1, 1, 1), -1, -1, 1);
        CHECK_OK(capture(&p, &log));
        assert_non_null(strstr(log.text, "agrees with the ball"));
        assert_null(strstr(log.text, "not turned"));
        write_list(&p, vec3_of(1, 1, 1), -1, -1, orientation[k]);
        CHECK_OK(capture(&p, &log));
        assert_non_null(strstr(log.text, "agrees with the ball"));
        assert_non_null(strstr(log.text, "those of the upright photographs; not turned"));
        write_list(&p, vec3_of(1, -1, 1), -1, -1, 1);
        assert_int_equal(capture(&p, &log), RELUME_EUNFIT);
        test_folder_remove(p.folder);
    }
}

// A matte bump under lights whose axes are mirrored in the list.
static int warnings_of_bump(double x_scale, double y_scale)
{
    enum { SIDE = 90 };
    struct relume_acquisition out = {0};
    struct shot shot[LAMPS] = {{0}};
    struct acquisition s = {
        .p = {.lights = "l.lp"}, .out = &out, .shot = shot, .shots = LAMPS, .width = SIDE};
    for (int i = 0; i < LAMPS; i++) {
        const vec3 l = lamp_at(i);
        shot[i].direction = vec3_of(x_scale * l.x, y_scale * l.y, l.z);
        CHECK_OK(relume_image_create(&shot[i].luma, SIDE, SIDE, 1));
        for (int k = 0; k < SIDE * SIDE; k++) {
            const double x = (k % SIDE - 40) / 22.0, y = -(k / SIDE - 49) / 30.0;
            const double h = 0.8 * exp(-x * x - y * y - 0.7 * x * y);
            const vec3 n =
                vec3_unit(vec3_of(h * (2.0 * x + 0.7 * y), h * (2.0 * y + 0.7 * x), 1.0));
            shot[i].luma.data[k] = (float)sqrt(0.6 * fmax(vec3_dot(n, l), 0.0));
        }
    }
    CHECK_OK(acquire_check_relief(&s));
    for (int i = 0; i < LAMPS; i++)
        relume_image_destroy(&shot[i].luma);
    const int warnings = out.warnings;
    relume_acquisition_destroy(&out);
    return warnings;
}

static void a_surface_without_a_ball(void **state)
{
    (void)state;
    assert_int_equal(warnings_of_bump(1.0, 1.0), 0);
    assert_int_equal(warnings_of_bump(-1.0, 1.0), 1);
    assert_int_equal(warnings_of_bump(1.0, -1.0), 1);
    assert_int_equal(warnings_of_bump(-1.0, -1.0), 0);  // looks like inverted relief
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_beside_a_list),
        cmocka_unit_test(photographs_held_sideways),
        cmocka_unit_test(a_surface_without_a_ball),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
