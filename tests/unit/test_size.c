// test_size.c - how large a file will be, to the byte: against files that are written
#include "test.h"

#include "capture_fixture.h"
#include "core/base/memory.h"
#include "encode/encode/overhead.h"
#include "encode/levels/pyramid.h"
#include "format/pack/pack_write.h"
#include "format/pack/size.h"
#include "in_folder.h"

static uint64_t written(const struct relume_pack_contents *c, enum relume_compression compression)
{
    struct relume_buffer file = {0};
    const struct relume_writer writer = relume_buffer_writer(&file);
    CHECK_OK(relume_pack_write(c, NULL,
                               relume_pack_params(.writer = &writer, .compression = compression)));
    const uint64_t size = file.size;
    relume_buffer_destroy(&file);
    return size;
}

static void check_size(const struct relume_pack_contents *c)
{
    for (int i = RELUME_COMPRESS_NONE; i <= RELUME_COMPRESS_PIZ; i++) {
        const enum relume_compression compression = (enum relume_compression)i;
        uint64_t size = 0;
        CHECK_OK(pack_size(&size, c, relume_pack_params(.compression = compression)));
        assert_int_equal(size, written(c, compression));
    }
}

// A slab of three views with depth and masks, whose planes are coded.
struct coded_slab {
    relume_capture *capture;
    relume_coder *coder;
    struct relume_pack_encode_params p;
    struct relume_project_params encode;
    struct contents made;
    struct view_groups groups;
};

static void open_slab(struct coded_slab *s)
{
    const struct fixture f = {
        .width = 80, .height = 50, .lights = 9, .views = 3, .depth = true, .mask = true};
    fixture_write(&f, folder);
    CHECK_OK(
        relume_capture_open(&s->capture, folder, relume_capture_params(.allow_outside = true)));
    CHECK_OK(relume_coder_learn(&s->coder, &relume_basis_pca, s->capture,
                                &(const struct relume_coder_params){.coefficients = 5}, NULL));
    s->p = (struct relume_pack_encode_params){.bytes_per_pixel = 1.0};
    s->encode = (struct relume_project_params){
        .domain = RELUME_DOMAIN_DISPLAY, .storage = RELUME_STORE_12, .step = RELUME_STEP_COMMON};
    s->made = (struct contents){
        .capture = s->capture, .coder = s->coder, .p = &s->p, .encode = &s->encode};
    CHECK_OK(contents_create(&s->made, &(const struct encode_share){.views = 3}));
    CHECK_OK(groups_make(&s->groups, s->capture, s->coder));
    for (int i = 0; i < 3; i++) {
        CHECK_OK(contents_encode(&s->made, i));
        CHECK_OK(contents_extras(&s->made, i));
        s->made.view[i].depth_step = i ? 0.01f : 0.0f;
        s->made.view[i].predicted = i > 0;
    }
    CHECK_OK(coefficients_share_steps(s->made.coefficients, 3, true, RELUME_STEP_COMMON));
}

static void close_slab(struct coded_slab *s)
{
    groups_destroy(&s->groups);
    contents_destroy(&s->made);
    relume_coder_destroy(&s->coder);
    relume_capture_destroy(&s->capture);
}

static void test_without_loss(void **state)
{
    (void)state;
    struct coded_slab s = {.capture = NULL};
    struct relume_pack_contents c;
    open_slab(&s);
    contents_describe(&c, &s.made);
    check_size(&c);
    close_slab(&s);
}

static void test_with_loss(void **state)
{
    (void)state;
    struct coded_slab s = {.capture = NULL};
    struct relume_pack_contents c;
    const struct av1_effort effort = {40 * AV1_STEPS, AV1_GOOD_6_SCREEN};
    struct lossy_words words = {0};
    open_slab(&s);
    CHECK_OK(lossy_encode(&words, s.made.coefficients, 1, &effort, 1, NULL));
    for (int i = 0; i < 3; i++) {
        s.made.view[i].coded = words.word;
        s.made.view[i].coded_words = words.count;
    }
    contents_describe(&c, &s.made);
    check_size(&c);
    mem_free(words.word);
    close_slab(&s);
}

// A file with a word for each anchor, and one with a word for each view and what is beside it.
static void test_overhead(void **state)
{
    (void)state;
    struct coded_slab s = {.capture = NULL};
    struct relume_pack_contents c;
    struct overhead o;
    const uint32_t word[1] = {0};
    double heads, extras, preview, models;
    open_slab(&s);
    assert_int_equal(s.groups.count, 1);
    CHECK_OK(overhead_create(&o, &s.made, &s.groups));
    CHECK_OK(overhead_heads(&heads, &o));
    CHECK_OK(overhead_extras(&extras, &o, 0));
    CHECK_OK(overhead_preview(&preview, &o));
    CHECK_OK(overhead_models(&models, &o));
    contents_describe(&c, &s.made);
    c.preview = NULL;
    for (int i = 0; i < 3; i++) {
        s.made.view[i].coded = word;
        s.made.view[i].coded_words = 1;
    }
    CHECK_NEAR((double)written(&c, RELUME_COMPRESS_DEFAULT), o.header + extras, 0.0);
    for (int i = 0; i < 3; i++) {
        s.made.view[i].depth = s.made.view[i].mask = NULL;
        s.made.view[i].coded = i ? NULL : word;
    }
    CHECK_NEAR((double)written(&c, RELUME_COMPRESS_DEFAULT), heads, 0.0);
    CHECK_NEAR(o.header, heads, 0.0);  // of one group
    c.preview = relume_pack_preview;
    CHECK_NEAR((double)written(&c, RELUME_COMPRESS_DEFAULT), heads + preview, 0.0);
    assert_true(extras > 0.0 && preview > 0.0);
    CHECK_NEAR(models, 0.0, 0.0);  // there are none
    close_slab(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_without_loss),
        cmocka_unit_test(test_with_loss),
        cmocka_unit_test(test_overhead),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
