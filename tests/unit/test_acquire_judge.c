// Photographs that contradict those under similar lights, and those that only look as if they did
#include "capture/acquire/acquire.h"
#include "test.h"

enum { SHOTS = 24, WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT };

struct photographs {
    struct shot shot[SHOTS];
    struct relume_acquisition out;
    struct acquisition s;
    char name[SHOTS][16];
};

static vec3 lamp_at(int i)
{
    const double z = 0.25 + 0.72 * (i + 0.5) / SHOTS, r = sqrt(1.0 - z * z), a = 2.4 * i;
    return vec3_of(r * cos(a), r * sin(a), z);
}

// A glossy bump on a board; the highlight makes it far brighter under the last lights.
static void show(struct relume_image *image, vec3 light)
{
    const vec3 half = vec3_unit(vec3_add(light, vec3_of(0, 0, 1)));
    CHECK_OK(relume_image_create(image, WIDTH, HEIGHT, 3));
    for (int i = 0; i < PIXELS; i++) {
        const double x = (i % WIDTH - 28) / 14.0, y = (20 - i / WIDTH) / 11.0;
        const double h = exp(-x * x - y * y);
        const vec3 n = vec3_unit(vec3_of(1.4 * h * x, 1.8 * h * y, 1.0));
        const double paint = 0.3 + 0.15 * ((i % WIDTH / 8 + i / WIDTH / 8) % 2);
        const double cosine = fmax(vec3_dot(n, light), 0.0);
        const double gloss = cosine > 0.0 ? 0.3 * pow(fmax(vec3_dot(n, half), 0.0), 40.0) : 0.0;
        for (int c = 0; c < 3; c++)
            image->data[3 * i + c] = (float)fmin(paint * cosine + gloss + 0.002, 1.0);
    }
}

static void take(struct photographs *p)
{
    *p = (struct photographs){0};
    p->s = (struct acquisition){.out = &p->out, .shots = SHOTS, .shot = p->shot};
    for (int i = 0; i < SHOTS; i++) {
        snprintf(p->name[i], sizeof p->name[i], "p%02d.jpg", i);
        p->shot[i].path = p->name[i];
        p->shot[i].direction = lamp_at(i);
        p->shot[i].similarity = 1.0f;
        p->shot[i].fine = 0.01 * (3.0 + 0.1 * (i % 3));
        p->shot[i].coarse = 0.05;
        show(&p->shot[i].small, lamp_at(i));
    }
}

static void scale(struct photographs *p, int i, double from, double to)
{
    for (int k = 0; k < PIXELS; k++)
        for (int c = 0; c < 3; c++)
            p->shot[i].small.data[3 * k + c] *=
                (float)(from + (to - from) * (k % WIDTH > WIDTH / 3));
}

static void exchange(struct photographs *p, int i, int k)
{
    p->shot[i].direction = lamp_at(k);
    p->shot[k].direction = lamp_at(i);
}

// The warnings that hold `words`.
static int judged(struct photographs *p, const char *words)
{
    int found = 0;
    CHECK_OK(acquire_judge(&p->s));
    CHECK_OK(acquire_check_blacks(&p->s));
    for (int i = 0; i < p->out.warnings; i++)
        found += strstr(p->out.warning[i], words) != NULL;
    if (!found)
        for (int i = 0; i < p->out.warnings; i++)
            print_message("%s\n", p->out.warning[i]);
    for (int i = 0; i < SHOTS; i++)
        relume_image_destroy(&p->shot[i].small);
    return found;
}

static void expect(struct photographs *p, int warnings, const char *words)
{
    assert_int_equal(judged(p, words), warnings);
    assert_int_equal(p->out.warnings, warnings);
    relume_acquisition_destroy(&p->out);
}

static void gloss_and_raking_light(void **state)
{
    (void)state;
    struct photographs p;
    take(&p);
    expect(&p, 0, "");
}

static void an_exposure(void **state)
{
    (void)state;
    struct photographs p;
    take(&p);
    scale(&p, 13, 0.5, 0.5);
    expect(&p, 1, "p13.jpg does not fit its light: 0.9 stops darker");
}

static void a_shadow(void **state)
{
    (void)state;
    struct photographs p;
    take(&p);
    scale(&p, 10, 0.25, 1.0);
    expect(&p, 1, "p10.jpg does not fit its light: parts of it");
}

static void two_lights(void **state)
{
    (void)state;
    struct photographs p;
    take(&p);
    exchange(&p, 4, 15);
    assert_int_equal(judged(&p, "looks as under a light"), 2);
    assert_true(p.shot[4].misfit && p.shot[15].misfit);
    relume_acquisition_destroy(&p.out);
}

static void another_order(void **state)
{
    (void)state;
    struct photographs p;
    take(&p);
    for (int i = 0; i < SHOTS; i++)
        p.shot[i].direction = lamp_at((7 * i + 3) % SHOTS);
    expect(&p, 1, "do not look alike");
}

static void another_scene(void **state)
{
    (void)state;
    struct photographs p;
    take(&p);
    p.shot[8].similarity = 0.1f;
    for (int k = 0; k < PIXELS; k++)
        for (int c = 0; c < 3; c++)
            p.shot[8].small.data[3 * k + c] = k / WIDTH % 12 < 6 ? 0.4f : 0.1f;
    expect(&p, 1, "p08.jpg: seems to show another scene");
}

// The scene's own edges under a light that fits badly.
static void the_same_edges(void **state)
{
    (void)state;
    struct photographs p;
    take(&p);
    p.shot[8].similarity = 0.1f;
    for (int k = 0; k < PIXELS; k++)
        for (int c = 0; c < 3; c++)
            p.shot[8].small.data[3 * k + c] *= (float)exp2(4.0 * (k % WIDTH) / WIDTH - 3.0);
    expect(&p, 1, "p08.jpg does not fit its light: parts of it");
}

// Gloss that flashes under the light nearest to the camera.
static void a_flash(void **state)
{
    (void)state;
    struct photographs p;
    take(&p);
    for (int k = 0; k < PIXELS; k++)
        for (int c = 0; c < 3; c++)
            p.shot[SHOTS - 1].small.data[3 * k + c] +=
                (float)(0.4 + 0.4 * sin(k % WIDTH * 0.3) * cos(k / WIDTH * 0.25));
    expect(&p, 0, "");
}

// Two exchanged photographs that a ball has named.
static void a_stray(void **state)
{
    (void)state;
    struct photographs p;
    take(&p);
    exchange(&p, 4, 15);
    p.shot[4].stray = p.shot[15].stray = true;
    expect(&p, 0, "");
}

static void a_blurred_one(void **state)
{
    (void)state;
    struct photographs p;
    take(&p);
    p.shot[17].fine *= 0.1;
    expect(&p, 1, "p17.jpg: less sharp");
}

static void lifted_blacks(void **state)
{
    (void)state;
    struct photographs p;
    take(&p);
    for (int i = 0; i < SHOTS; i++)
        for (int k = 0; k < 3 * PIXELS; k++)
            p.shot[i].small.data[k] = 0.9f * p.shot[i].small.data[k] + 0.06f;
    expect(&p, 1, "blacks are lifted");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gloss_and_raking_light),
        cmocka_unit_test(an_exposure),
        cmocka_unit_test(a_shadow),
        cmocka_unit_test(two_lights),
        cmocka_unit_test(another_order),
        cmocka_unit_test(another_scene),
        cmocka_unit_test(the_same_edges),
        cmocka_unit_test(a_flash),
        cmocka_unit_test(a_stray),
        cmocka_unit_test(a_blurred_one),
        cmocka_unit_test(lifted_blacks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
