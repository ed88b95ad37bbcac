// test_stack.c - workers need little stack: what a caller's thread has, or musl's default
//
// With one thread everything runs in the caller's. Each job runs in one of STACK bytes, where an
// overflow is a crash. Frames of sanitizers are several times as large: there the same jobs run on
// a larger stack, for what they find; under ThreadSanitizer by two threads, as one races with none.
#include "format/coder/coding.h"
#include "relight/light/environment.h"

#include "test.h"

#include "capture_fixture.h"
#include "made_btf.h"

#include <pthread.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { STACK = 4 << 20 };
#else
enum { STACK = 128 << 10 };
#endif
#ifdef __SANITIZE_THREAD__
enum { THREADS = 2 };
#else
enum { THREADS = 1 };
#endif

static char folder[64], path[96], copy[96];

static int setup(void **state)
{
    (void)state;
    test_folder(folder);
    fixture_write(
        &(struct fixture){
            .width = 120, .height = 90, .lights = 12, .views = 2, .depth = true, .mask = true},
        folder);
    snprintf(path, sizeof path, "%s/pack.exr", folder);
    snprintf(copy, sizeof copy, "%s/capture.json", folder);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

struct job {
    relume_status (*run)(const void *context);
    const void *context;
    relume_status status;
};

static void *run_job(void *context)
{
    struct job *job = context;
    job->status = job->run(job->context);
    return NULL;
}

static void check_small(relume_status (*run)(const void *), const void *context)
{
    struct job job = {.run = run, .context = context};
    pthread_attr_t attributes;
    pthread_t thread;
    assert_int_equal(pthread_attr_init(&attributes), 0);
    assert_int_equal(pthread_attr_setstacksize(&attributes, STACK), 0);
    assert_int_equal(pthread_create(&thread, &attributes, run_job, &job), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    pthread_attr_destroy(&attributes);
    CHECK_OK(job.status);
}

// ---------------------------------------------------------------- files

struct coding {
    const struct relume_basis *basis;
    struct relume_coder_params coder;
    struct relume_pack_encode_params pack;
};

static relume_status encode(const void *context)
{
    const struct coding *c = context;
    struct relume_pack_encode_params p = c->pack;
    p.threads = THREADS;
    return fixture_encode_with(folder, path, c->basis, &c->coder, &p);
}

// All kinds of lights from an eye; as 8 bits where `context` is set.
static relume_status frame(const void *context)
{
    float sky[12 * 6 * 3];
    for (int i = 0; i < 12 * 6 * 3; i++)
        sky[i] = 0.2f + (float)(i % 7);
    const struct relume_image picture = {12, 6, 3, .data = sky};
    relume_environment *environment = NULL;
    relume_pack *pack = NULL;
    struct relume_image out = {0};
    relume_status status = relume_environment_create(&environment, &picture, NULL);
    const struct relume_light lights[] = {
        {.direction = {0.1, 0.2, 0.9}, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_POINT, .position = {0.5, 0.5, 2}, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_POINT, .position = {-0.5, 0.5, 2}, .rgb = {1, 1, 1}},
        {.kind = RELUME_LIGHT_ENVIRONMENT, .environment = environment, .rgb = {1, 1, 1}},
    };
    const struct relume_camera camera = {
        .framing = RELUME_FRAME_EYE, .eye = {0.4, 0.0, 3.0}, .width = 81, .height = 43};
    if (!status)
        status = relume_pack_open(&pack, path, relume_pack_params(.threads = THREADS));
    if (!status && !context)
        status =
            relume_frame(&out, pack, &camera, lights, 4, relume_frame_params(.threads = THREADS));
    if (!status && context) {
        const struct relume_codes *codes;
        uint8_t *bytes = malloc((size_t)4 * 120 * 90);
        status = relume_pack_codes(&codes, pack, 0);
        if (!status)
            status = relume_relight_rgba8(bytes, codes, lights, 1,
                                          relume_relight_params(.threads = THREADS));
        free(bytes);
    }
    relume_image_destroy(&out);
    relume_pack_destroy(&pack);
    relume_environment_destroy(&environment);
    return status;
}

static relume_status evaluate(const void *context)
{
    relume_pack *pack = NULL;
    relume_capture *capture = NULL;
    struct relume_evaluation e = {0};
    (void)context;
    relume_status status =
        relume_capture_open(&capture, copy, relume_capture_params(.allow_outside = true));
    if (!status)
        status = relume_pack_open(&pack, path, relume_pack_params(.threads = THREADS));
    if (!status)
        status = relume_evaluate(&e, pack, capture, relume_evaluate_params(.threads = THREADS));
    relume_evaluation_destroy(&e);
    relume_pack_destroy(&pack);
    relume_capture_destroy(&capture);
    return status;
}

static void test_files(void **state)
{
    (void)state;
    const struct relume_books_params books = {.codes = 16, .stages = 2};
    const struct relume_interpolant *natural = relume_interpolant_find("natural");
    const struct coding codings[] = {
        {&relume_basis_sh, {.coefficients = 9}, {.domain = RELUME_DOMAIN_LINEAR}},
        {&relume_basis_sh, {.coefficients = 9, .robust = true}, {.domain = RELUME_DOMAIN_DISPLAY}},
        {&relume_basis_table, {.interpolant = natural}, {.storage = RELUME_STORE_HALF}},
        {&relume_basis_pca, {.choose = true}, {.storage = RELUME_STORE_16}},
        {&relume_basis_dct, {.luminance = true}, {.storage = RELUME_STORE_FLOAT}},
        {&relume_basis_dct_resampled, {0}, {.compression = RELUME_COMPRESS_ZIP}},
        {&relume_basis_sh, {.coefficients = 4}, {.books = &books}},
        {&relume_basis_pca, {0}, {.books = &books, .domain = RELUME_DOMAIN_DISPLAY}},
    };
    for (size_t i = 0; i < sizeof codings / sizeof *codings; i += TEST_SANITIZED ? 3 : 1) {
        check_small(encode, &codings[i]);
        check_small(frame, NULL);
        check_small(frame, "8 bits");
        check_small(evaluate, NULL);
    }
}

static relume_status hold_out(const void *context)
{
    const struct relume_heldout_store store[] = {{.storage = RELUME_STORE_8},
                                                 {.storage = RELUME_STORE_LOG}};
    struct relume_heldout_quality before, after[2];
    relume_capture *capture = NULL;
    relume_heldout *h = NULL;
    relume_status status =
        relume_capture_open(&capture, copy, relume_capture_params(.allow_outside = true));
    if (!status)
        status = relume_heldout_open(&h, capture,
                                     relume_heldout_params(.leave_out = 4, .threads = THREADS));
    if (!status)
        status = relume_heldout_measure(h, context, relume_coder_params(.threads = THREADS), store,
                                        2, &before, after);
    relume_heldout_destroy(&h);
    relume_capture_destroy(&capture);
    return status;
}

static void test_held_out(void **state)
{
    (void)state;
    check_small(hold_out, &relume_basis_pca);
    check_small(hold_out, &relume_basis_table);
}

// ---------------------------------------------------------------- materials

static void fill(const void *context, struct relume_vec3 v, struct relume_vec3 l, float *rgb)
{
    (void)context;
    for (int i = 0; i < 6 * 5 * 3; i++)
        rgb[i] = (float)(0.2 + 0.1 * (i % 4) * l.z + 0.1 * v.x * l.x);
}

struct fitting {
    const relume_btf *btf;
    const struct relume_btf_model *model;
};

static relume_status fit(const void *context)
{
    const struct fitting *f = context;
    relume_btf_fitted *fitted = NULL;
    const relume_status status =
        relume_btf_fit(&fitted, f->btf, f->model, relume_btf_fit_params(.threads = THREADS));
    float rgb[3];
    if (!status)
        relume_btf_fitted_evaluate(fitted, 3, 2, (struct relume_vec3){0.1, 0.2, 0.97},
                                   (struct relume_vec3){0.3, 0.0, 0.95}, rgb);
    relume_btf_fitted_destroy(&fitted);
    return status;
}

static void test_materials(void **state)
{
    (void)state;
    relume_btf *btf = made_btf(&(struct made_btf){.width = 6, .height = 5, .fill = fill});
    for (const struct relume_btf_model *const *m = relume_btf_models; *m; m++)
        check_small(fit, &(struct fitting){btf, *m});
    relume_btf_destroy(&btf);
}

// ---------------------------------------------------------------- objects in a scene

static relume_status exchange(const void *transport)
{
    relume_pack *pack = NULL;
    relume_objects *objects = NULL;
    relume_renderer *renderer = NULL;
    struct relume_image out = {0};
    char file[96];
    const int samples = transport == relume_transport_find("micro") ? 2304 : 16;  // its largest
    const struct relume_light light = {.direction = {0.3, 0.2, 0.9}, .rgb = {1, 1, 1}};
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW, .width = 6, .height = 4};
    snprintf(file, sizeof file, "%s/objects.json", folder);
    relume_status status = relume_pack_open(&pack, path, relume_pack_params(.threads = THREADS));
    if (!status)
        status = relume_objects_open(&objects, file, relume_objects_params(.threads = THREADS));
    if (!status)
        status = relume_renderer_create(&renderer, pack, relume_frame_params(.threads = THREADS));
    if (!status)
        status = relume_renderer_set_objects(
            renderer, objects,
            relume_render_params(.samples = 1, .threads = THREADS, .transport = transport,
                                 .transport_samples = samples, .bounces = samples > 16 ? -1 : 1));
    if (!status)
        status = relume_renderer_set_lights(renderer, &light, 1);
    if (!status)
        status = relume_renderer_frame(&out, renderer, &camera);
    relume_image_destroy(&out);
    relume_renderer_destroy(&renderer);
    relume_objects_destroy(&objects);
    relume_pack_destroy(&pack);
    return status;
}

static void write_text(const char *name, const char *text)
{
    char file[96];
    snprintf(file, sizeof file, "%s/%s", folder, name);
    FILE *f = fopen(file, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static void test_transports(void **state)
{
    (void)state;
    const struct coding coding = {
        &relume_basis_table, {0}, {.storage = RELUME_STORE_HALF, .domain = RELUME_DOMAIN_LINEAR}};
    write_text("square.obj", "v -0.4 -0.4 0.3\nv 0.4 -0.4 0.3\nv 0.4 0.4 0.3\nv -0.4 0.4 0.3\n"
                             "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
    write_text("objects.json",
               "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":"
               "\"square.obj\",\"parts\":[{\"material\":{\"diffuse\":0.8}}]}]}");
    check_small(encode, &coding);
    for (const struct relume_transport *const *t = relume_transports; *t; t++)
        check_small(exchange, *t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_files),
        cmocka_unit_test(test_held_out),
        cmocka_unit_test(test_materials),
        cmocka_unit_test(test_transports),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
