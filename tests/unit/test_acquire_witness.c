// Lists of lights that are not those of the photographs: a ball shows it, or the surface does
#include "capture/acquire/acquire.h"
#include "made_ball.h"
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

static void photograph(struct photographs *p)
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
        snprintf(p->path[i], sizeof p->path[i], "%.63s/p%d.png", p->folder, i);
        p->list[i] = p->path[i];
        CHECK_OK(relume_image_save(&image, p->path[i], NULL));
        relume_image_destroy(&image);
    }
}

static void write_list(const struct photographs *p, vec3 scale, int first, int second)
{
    FILE *f = fopen(p->lights, "w");
    assert_non_null(f);
    fprintf(f, "%d\n", LAMPS);
    for (int i = 0; i < LAMPS; i++) {
        const vec3 l = lamp_at(i == first ? second : i == second ? first : i);
        fprintf(f, "p%d.png %.6f %.6f %.6f\n", i, scale.x * l.x, scale.y * l.y, scale.z * l.z);
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
    photograph(&p);
    write_list(&p, vec3_of(1, 1, 1), -1, -1);
    CHECK_OK(capture(&p, &log));
    assert_non_null(strstr(log.text, "agrees with the ball"));
    assert_null(strstr(log.text, "elsewhere"));
    write_list(&p, vec3_of(1, -1, 1), -1, -1);
    assert_int_equal(capture(&p, &log), RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "if y is negated"));
    write_list(&p, vec3_of(-1, -1, 1), -1, -1);
    CHECK_OK(capture(&p, &log));
    assert_non_null(strstr(log.text, "if x and y are negated, or that round thing is hollow"));
    write_list(&p, vec3_of(1, 1, 1), 1, 5);
    CHECK_OK(capture(&p, &log));
    assert_non_null(strstr(log.text, "it shows the light that the list gives to p5.png"));
    test_folder_remove(p.folder);
}

// The normals of a bump under lights whose axes are mirrored.
static int warnings_of_bump(double x_scale, double y_scale)
{
    enum { SIDE = 60 };
    struct relume_acquisition out = {0};
    struct acquisition s = {.p = {.lights = "l.lp"}, .out = &out};
    CHECK_OK(relume_image_create(&out.photometric.normal, SIDE, SIDE, 3));
    for (int k = 0; k < SIDE * SIDE; k++) {
        const double x = (k % SIDE - 27) / 15.0, y = -(k / SIDE - 33) / 20.0;
        const double h = 0.8 * exp(-x * x - y * y - 0.7 * x * y);
        const vec3 n = vec3_unit(
            vec3_of(x_scale * h * (2.0 * x + 0.7 * y), y_scale * h * (2.0 * y + 0.7 * x), 1.0));
        vec3_store(out.photometric.normal.data + 3 * k, n);
    }
    CHECK_OK(acquire_check_relief(&s));
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
        cmocka_unit_test(a_surface_without_a_ball),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
