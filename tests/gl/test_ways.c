// Light between a scene and objects, made by the library in a thread of its own while frames are
// drawn: what is asked for, in time for it, and nothing else
#include "test.h"

#include "capture_fixture.h"
#include "relit/exchanger.h"
#include "world/object/drawn_objects.h"

#include <relume/exchange.h>
#include <relume/world/tableau.h>
#include <relume/world/transport.h>

#include <time.h>
#include <unistd.h>

enum { W = 24, H = 16, LARGE = 160 };

static char folder[64], file[96], scene[96];
static relume_objects *objects;
static const struct relume_light lights[] = {{.direction = {0.3, 0.4, 0.8}, .rgb = {1, 1, 1}},
                                             {.direction = {-0.5, 0.4, 0.7}, .rgb = {1, 1, 1}}};
static int said;
static char last[512];

static void hear(void *user, enum relume_level level, const char *text)
{
    (void)user, (void)level;
    said++;
    snprintf(last, sizeof last, "%s", text);
}
static const struct relume_log quiet = {.message = hear};

// A square before the plane that the photographs show.
static int open_all(void **state)
{
    (void)state;
    test_folder(folder);
    fixture_write(&(struct fixture){.width = W, .height = H, .lights = 9, .views = 1}, folder);
    snprintf(file, sizeof file, "%s/capture.json", folder);
    char path[96];
    snprintf(path, sizeof path, "%s/square.obj", folder);
    FILE *f = fopen(path, "w");
    fputs("v -0.4 -0.4 0.3\nv 0.4 -0.4 0.3\nv 0.4 0.4 0.3\nv -0.4 0.4 0.3\nvt 0 0\nvt 1 0\nvt 1 1\n"
          "vt 0 1\nf 1/1 2/2 3/3 4/4\n",
          f);
    fclose(f);
    snprintf(path, sizeof path, "%s/objects.json", folder);
    f = fopen(path, "w");
    fputs("{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"square.obj\","
          "\"parts\":[{\"material\":[{\"diffuse\":0.8},{\"diffuse\":[1,0,0]}]}]}]}",
          f);
    fclose(f);
    snprintf(scene, sizeof scene, "%s/scene.json", folder);
    f = fopen(scene, "w");
    fputs("{\"format\":\"relume-scene\",\"version\":1,\"captures\":[{\"file\":\"capture.json\"}],"
          "\"objects\":[{\"mesh\":\"square.obj\",\"parts\":[{\"material\":{\"diffuse\":0.8}}]}]}",
          f);
    fclose(f);
    return relume_objects_open(&objects, path, NULL) != 0;
}

static int close_all(void **state)
{
    (void)state;
    relume_objects_destroy(&objects);
    test_folder_remove(folder);
    return 0;
}

static void setup_exchanger(struct exchanger **e)
{
    const struct exchange_source source = {
        .file = file, .objects = objects, .log = &quiet, .threads = 2};
    assert_int_equal(exchanger_create(e, &source), RELUME_OK);
    said = 0;
}

static struct exchange_request request_of(const char *way, int width, int height, int light)
{
    return (struct exchange_request){
        .transport = relume_transport_find(way),
        .camera = {.framing = RELUME_FRAME_VIEW, .width = width, .height = height},
        .lights = &lights[light],
        .count = 1,
    };
}

// As `relume relight` would draw it.
static struct relume_image want(const struct exchange_request *q)
{
    struct relume_image image;
    relume_renderer *renderer;
    relume_pack *pack;
    const struct relume_render_params *params =
        relume_render_params(.samples = 3, .threads = 2, .transport = q->transport);
    assert_int_equal(relume_open(&pack, file, NULL), RELUME_OK);
    assert_int_equal(relume_renderer_create(&renderer, pack, NULL), RELUME_OK);
    assert_int_equal(relume_renderer_set_objects(renderer, objects, params), RELUME_OK);
    assert_int_equal(relume_renderer_set_lights(renderer, q->lights, q->count), RELUME_OK);
    assert_int_equal(relume_renderer_frame(&image, renderer, &q->camera), RELUME_OK);
    relume_renderer_destroy(&renderer);
    relume_pack_destroy(&pack);
    return image;
}

static bool same_image(const struct relume_image *a, const struct relume_image *b)
{
    return a->width == b->width && a->height == b->height &&
           !memcmp(a->data, b->data, 3 * (size_t)a->width * (size_t)a->height * sizeof *a->data);
}

static void check_picture(struct exchanger *e, int slot, const struct exchange_request *q)
{
    const struct relume_image *image;
    struct relume_image wanted = want(q);
    bool fresh;
    assert_int_equal(exchanger_show(&image, &fresh, e, slot), EXCHANGE_FINE);
    assert_true(fresh);
    assert_true(same_image(image, &wanted));
    relume_image_destroy(&wanted);
}

static void test_two_ways(void **state)
{
    (void)state;
    struct exchanger *e;
    setup_exchanger(&e);
    const struct exchange_request a = request_of("path", W, H, 0), b = request_of("ssdo", W, H, 0);
    assert_false(exchanger_is_busy(e));
    assert_int_equal(exchanger_ask(e, 0, &a), RELUME_OK);
    assert_int_equal(exchanger_ask(e, 1, &b), RELUME_OK);
    assert_true(exchanger_is_busy(e) || exchanger_has_news(e));
    assert_int_equal(exchanger_wait(e), RELUME_OK);
    assert_true(exchanger_has_news(e));
    check_picture(e, 0, &a);
    check_picture(e, 1, &b);
    assert_false(exchanger_is_busy(e));
    exchanger_destroy(&e);
}

// Under the hand a picture is rough, and stays so; at rest it becomes fine.
static void test_rough_first(void **state)
{
    (void)state;
    struct exchanger *e;
    const struct relume_image *image;
    bool fresh;
    setup_exchanger(&e);
    struct exchange_request q = request_of("ssao", LARGE, LARGE, 0);
    q.moves = true;
    assert_int_equal(exchanger_ask(e, 0, &q), RELUME_OK);
    assert_int_equal(exchanger_wait(e), RELUME_OK);
    assert_int_equal(exchanger_show(&image, &fresh, e, 0), EXCHANGE_ROUGH);
    assert_int_equal(image->width, LARGE / 4);
    q.lights = &lights[1];
    q.count = 1;
    q.moves = false;
    assert_int_equal(exchanger_ask(e, 0, &q), RELUME_OK);
    const enum exchange_fit fit = exchanger_show(&image, &fresh, e, 0);
    assert_true(fit == EXCHANGE_OLDER || fresh);
    assert_int_equal(exchanger_wait(e), RELUME_OK);
    assert_int_equal(exchanger_show(&image, &fresh, e, 0), EXCHANGE_FINE);
    assert_int_equal(image->width, LARGE);
    q.camera.width = LARGE / 2;  // another eye: nothing that is there is of use
    assert_int_equal(exchanger_ask(e, 0, &q), RELUME_OK);
    assert_true(exchanger_show(&image, &fresh, e, 0) == EXCHANGE_NONE || fresh);
    exchanger_destroy(&e);
}

// What would take minutes ends when something else is asked for, and when nothing is.
static void test_cancelled(void **state)
{
    (void)state;
    struct exchanger *e;
    setup_exchanger(&e);
    struct exchange_request slow = request_of("path", 4 * LARGE, 4 * LARGE, 0);
    const struct exchange_request quick = request_of("ssao", W, H, 0);
    slow.samples = 65536;
    slow.waits = true;
    const time_t start = time(NULL);
    for (int i = 0; i < 3; i++) {
        slow.lights = &lights[i % 2];
        assert_int_equal(exchanger_ask(e, 0, &slow), RELUME_OK);
        usleep(20000);
    }
    assert_int_equal(exchanger_ask(e, 0, &quick), RELUME_OK);
    assert_int_equal(exchanger_wait(e), RELUME_OK);
    check_picture(e, 0, &quick);
    assert_int_equal(exchanger_ask(e, 1, &slow), RELUME_OK);
    usleep(20000);
    assert_int_equal(exchanger_ask(e, 1, NULL), RELUME_OK);
    assert_int_equal(exchanger_wait(e), RELUME_OK);
    assert_int_equal(exchanger_ask(e, 1, &slow), RELUME_OK);
    exchanger_destroy(&e);
    assert_true(time(NULL) - start < 60);
}

// Objects change while nobody looks at them; pictures of the old ones are gone.
static void test_rest(void **state)
{
    (void)state;
    struct exchanger *e;
    const struct relume_image *image;
    bool fresh;
    setup_exchanger(&e);
    const struct exchange_request q = request_of("ssdo", W, H, 0);
    for (int i = 0; i < 6; i++) {
        assert_int_equal(exchanger_ask(e, 0, &q), RELUME_OK);
        if (i % 2)
            assert_int_equal(exchanger_wait(e), RELUME_OK);
        exchanger_rest(e);
        assert_false(exchanger_is_busy(e));
        assert_int_equal(exchanger_show(&image, &fresh, e, 0), EXCHANGE_NONE);
        assert_int_equal(relume_objects_choose(objects, 0, i % 2), RELUME_OK);
    }
    assert_int_equal(exchanger_ask(e, 0, &q), RELUME_OK);
    assert_int_equal(exchanger_wait(e), RELUME_OK);
    check_picture(e, 0, &q);
    exchanger_destroy(&e);
}

// What cannot be drawn is said once, and is no reason to wait.
static void test_error(void **state)
{
    (void)state;
    struct exchanger *e;
    struct exchange_state now;
    setup_exchanger(&e);
    struct exchange_request q = request_of("ssdo", W, H, 0);
    q.interpolation = RELUME_INTERPOLATE_LINEAR;
    q.camera.framing = RELUME_FRAME_EYE;
    for (int i = 0; i < 2; i++) {
        q.camera.eye.z = 3 + i;
        assert_int_equal(exchanger_ask(e, 0, &q), RELUME_OK);
        assert_int_equal(exchanger_wait(e), RELUME_OK);
        exchanger_state(&now, e, 0);
        assert_int_not_equal(now.status, RELUME_OK);
        exchanger_speak(e);
    }
    assert_int_equal(said, 1);
    const struct exchange_request good = request_of("ssdo", W, H, 0);
    assert_int_equal(exchanger_ask(e, 0, &good), RELUME_OK);
    assert_int_equal(exchanger_wait(e), RELUME_OK);
    check_picture(e, 0, &good);
    exchanger_destroy(&e);
}

// From another eye the last picture stays until there is a new one; every way is the library's.
static void test_scene_file(void **state)
{
    (void)state;
    struct exchanger *e;
    relume_tableau *tableau;
    const struct relume_image *image;
    struct relume_image wanted;
    bool fresh;
    const struct exchange_source source = {
        .file = scene, .scene = true, .log = &quiet, .threads = 2};
    const char *const ways[] = {"none", "ssdo"};
    assert_int_equal(exchanger_create(&e, &source), RELUME_OK);
    assert_int_equal(relume_tableau_open(&tableau, scene, NULL), RELUME_OK);
    struct exchange_request q = request_of("none", W, H, 0);
    q.camera = relume_tableau_info(tableau)->camera;
    q.camera.width = W, q.camera.height = H;
    for (int i = 0; i < 2; i++) {
        q.transport = relume_transport_find(ways[i]);
        q.camera.eye.x += 0.1;
        assert_int_equal(exchanger_ask(e, 0, &q), RELUME_OK);
        const enum exchange_fit fit = exchanger_show(&image, &fresh, e, 0);
        assert_true(fresh || fit == (i ? EXCHANGE_ELSEWHERE : EXCHANGE_NONE));
        assert_int_equal(exchanger_wait(e), RELUME_OK);
        assert_int_equal(exchanger_show(&image, &fresh, e, 0), EXCHANGE_FINE);
        assert_int_equal(
            relume_tableau_frame(&wanted, tableau, &q.camera, q.lights, q.count,
                                 relume_render_params(.samples = 3, .transport = q.transport)),
            RELUME_OK);
        assert_true(same_image(image, &wanted));
        relume_image_destroy(&wanted);
    }
    relume_tableau_destroy(&tableau);
    exchanger_destroy(&e);
}

// The newest sentences are heard, however many there were before.
static void test_many_sentences(void **state)
{
    (void)state;
    enum { MANY = 40 };
    struct exchanger *e;
    setup_exchanger(&e);
    struct exchange_request q = request_of("ssdo", W, H, 0);
    for (int i = 0; i < MANY; i++) {
        q.camera.view = 1 + i;
        assert_int_equal(exchanger_ask(e, 0, &q), RELUME_OK);
        assert_int_equal(exchanger_wait(e), RELUME_OK);
        exchanger_speak(e);
        char number[16];
        snprintf(number, sizeof number, "%d", 1 + i);
        assert_int_equal(said, 1 + i);
        assert_non_null(strstr(last, number));
    }
    exchanger_destroy(&e);
}

// All lights are off.
static void test_dark(void **state)
{
    (void)state;
    struct exchanger *e;
    setup_exchanger(&e);
    struct exchange_request q = request_of("ssdo", W, H, 0);
    q.count = 0;
    assert_int_equal(exchanger_ask(e, 0, &q), RELUME_OK);
    assert_int_equal(exchanger_wait(e), RELUME_OK);
    check_picture(e, 0, &q);
    exchanger_destroy(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_two_ways),  cmocka_unit_test(test_rough_first),
        cmocka_unit_test(test_cancelled), cmocka_unit_test(test_rest),
        cmocka_unit_test(test_error),     cmocka_unit_test(test_scene_file),
        cmocka_unit_test(test_dark),      cmocka_unit_test(test_many_sentences),
    };
    return cmocka_run_group_tests(tests, open_all, close_all);
}
