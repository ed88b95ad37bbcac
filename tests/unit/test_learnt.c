// test_learnt.c - models of pixels as coded bytes: what comes back, and what cannot be one
#include "test.h"

#include "core/base/memory.h"
#include "format/pack/learnt.h"
#include "format/pack/views.h"

#include <math.h>

enum { WIDTH = 70, HEIGHT = 53, PIXELS = WIDTH * HEIGHT };

// Smooth, as learnt models are for the most part, with an edge in the middle.
static float number(int x, int y, int channel)
{
    const double slope = 0.5 + 0.4 * sin(0.05 * x + 0.3 * channel) * cos(0.04 * y);
    return (float)(x < WIDTH / 2 ? slope : 1.0 - slope);
}

static void make(struct relume_image *out, enum learnt_kind kind)
{
    CHECK_OK(relume_image_create(out, WIDTH, HEIGHT, LEARNT));
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < LEARNT; c++)
            out->data[i * LEARNT + c] = number(i % WIDTH, i / WIDTH, c);
    for (int i = 0; i < PIXELS; i++) {
        float *pixel = out->data + i * LEARNT;
        if (kind == LEARNT_GLOSS && i % WIDTH < WIDTH / 2)
            pixel[RELUME_GLOSS_SHINE] = -1.0f;  // a metal
        else if (kind == LEARNT_GLOSS)
            pixel[RELUME_GLOSS_SHINE] *= 1e-3f;
        if (kind == LEARNT_SHADOW && i / WIDTH < 20)
            pixel[RELUME_SHADOW_THICK] = INFINITY;
    }
}

// A model, its words, and what they are read as.
struct trip {
    struct relume_image model, back;
    struct learnt_steps steps;
    struct lossy_words words;
};

// Of a model that is there.
static void code(struct trip *t, enum learnt_kind kind)
{
    CHECK_OK(learnt_encode(&t->words, &t->steps, &t->model, kind, INFINITY, 2, NULL));
    CHECK_OK(relume_image_create(&t->back, WIDTH, HEIGHT, LEARNT));
    CHECK_OK(learnt_decode(&t->back, &t->words, &t->steps, kind, 2));
}

static void code_made(struct trip *t, enum learnt_kind kind)
{
    make(&t->model, kind);
    code(t, kind);
}

static void trip_destroy(struct trip *t)
{
    mem_free(t->words.word);
    relume_image_destroy(&t->model);
    relume_image_destroy(&t->back);
}

// Root mean square over the finite numbers of a channel.
static double missed(const struct relume_image *a, const struct relume_image *b, int channel)
{
    double sum = 0.0;
    for (int i = 0; i < PIXELS; i++) {
        const float x = a->data[i * LEARNT + channel], y = b->data[i * LEARNT + channel];
        sum += isfinite(x) ? (double)(x - y) * (double)(x - y) : 0.0;
    }
    return sqrt(sum / PIXELS);
}

// The quantiser errs by ten codes; a root of 0.1 to 0.9 has 600, so its square is off by 0.02.
static void numbers_come_back(void **state)
{
    (void)state;
    for (int kind = LEARNT_SHADOW; kind <= LEARNT_GLOSS; kind++) {
        struct trip t;
        code_made(&t, (enum learnt_kind)kind);
        for (int c = 0; c < LEARNT; c++)
            assert_true(missed(&t.model, &t.back, c) < 0.02);
        assert_true(4 * t.words.count < PIXELS * LEARNT * sizeof(uint16_t) / 8);
        trip_destroy(&t);
    }
}

static void infinity_stays(void **state)
{
    (void)state;
    struct trip t;
    code_made(&t, LEARNT_SHADOW);
    for (int i = 0; i < PIXELS; i++) {
        const int from_edge = abs(i / WIDTH - 20);
        if (from_edge > 1)  // at the edge coding may err by more
            assert_int_equal(isinf(t.back.data[i * LEARNT + RELUME_SHADOW_THICK]) != 0,
                             isinf(t.model.data[i * LEARNT + RELUME_SHADOW_THICK]) != 0);
    }
    trip_destroy(&t);
}

// What shines a little must not become a metal, whose highlights have its colour.
static void metals_stay_metals(void **state)
{
    (void)state;
    struct trip t;
    code_made(&t, LEARNT_GLOSS);
    for (int i = 0; i < PIXELS; i++)
        if (abs(i % WIDTH - WIDTH / 2) > 1)
            assert_int_equal(t.back.data[i * LEARNT + RELUME_GLOSS_SHINE] < 0.0f,
                             i % WIDTH < WIDTH / 2);
    trip_destroy(&t);
}

// One number everywhere is the offset and codes of 0, which the quantiser makes ten at most: a two
// hundredth of a root, twice that of the number.
static void even_models_come_back(void **state)
{
    (void)state;
    static const float values[] = {0.0f, 1e-30f, 0.25f, 65536.0f};
    for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
        struct trip t;
        CHECK_OK(relume_image_create(&t.model, WIDTH, HEIGHT, LEARNT));
        for (int i = 0; i < PIXELS * LEARNT; i++)
            t.model.data[i] = values[k];
        code(&t, LEARNT_GLOSS);
        for (int i = 0; i < PIXELS * LEARNT; i++)
            CHECK_NEAR(t.back.data[i], values[k], 1e-4 + 0.03 * values[k]);
        trip_destroy(&t);
    }
}

// Noise costs most: coded within a quarter of what it takes, it is still the same on average.
static void noise_becomes_smooth(void **state)
{
    (void)state;
    struct trip t;
    struct lossy_words fewer;
    uint32_t noise = 1;
    double sum = 0.0;
    CHECK_OK(relume_image_create(&t.model, WIDTH, HEIGHT, LEARNT));
    for (int i = 0; i < PIXELS * LEARNT; i++) {
        noise = noise * 1664525u + 1013904223u;
        t.model.data[i] = (float)(noise >> 8) / 16777216.0f;
    }
    code(&t, LEARNT_GLOSS);
    CHECK_OK(
        learnt_encode(&fewer, &t.steps, &t.model, LEARNT_GLOSS, (double)t.words.count, 2, NULL));
    assert_true(fewer.count < t.words.count / 4);
    CHECK_OK(learnt_decode(&t.back, &fewer, &t.steps, LEARNT_GLOSS, 2));
    for (int i = 0; i < PIXELS; i++)
        sum += t.back.data[i * LEARNT + RELUME_GLOSS_SHARE] / PIXELS;
    CHECK_NEAR(sum, 0.5, 0.05);
    mem_free(fewer.word);
    trip_destroy(&t);
}

static void numbers_that_cannot_be_are_refused(void **state)
{
    (void)state;
    static const struct {
        enum learnt_kind kind;
        int channel;
        float values[2];
    } bad[] = {{LEARNT_SHADOW, RELUME_SHADOW_THICK, {NAN, 1.0f}},
               {LEARNT_SHADOW, RELUME_SHADOW_THICK, {-1.0f, 1.0f}},
               {LEARNT_SHADOW, RELUME_SHADOW_COLOUR, {INFINITY, 1.0f}},
               {LEARNT_GLOSS, RELUME_GLOSS_SHINE, {NAN, 1.0f}},
               {LEARNT_GLOSS, RELUME_GLOSS_NORMAL, {-INFINITY, 0.0f}},
               // finite, but no float holds how far they are apart
               {LEARNT_GLOSS, RELUME_GLOSS_NORMAL, {3e38f, -3e38f}}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct relume_image model;
        struct learnt_steps steps;
        struct lossy_words words;
        make(&model, bad[i].kind);
        for (int k = 0; k < 2; k++)
            model.data[k * LEARNT + bad[i].channel] = bad[i].values[k];
        assert_int_equal(learnt_encode(&words, &steps, &model, bad[i].kind, INFINITY, 2, NULL),
                         RELUME_EINVAL);
        assert_null(words.word);
        relume_image_destroy(&model);
    }
}

static void other_words_are_damaged(void **state)
{
    (void)state;
    struct trip t;
    code_made(&t, LEARNT_GLOSS);
    t.words.word[t.words.count - 1] ^= 1;
    assert_int_equal(learnt_decode(&t.back, &t.words, &t.steps, LEARNT_GLOSS, 2), RELUME_EDAMAGED);
    t.words.count = 2;
    assert_int_equal(learnt_decode(&t.back, &t.words, &t.steps, LEARNT_GLOSS, 2), RELUME_EDAMAGED);
    trip_destroy(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_come_back),
        cmocka_unit_test(infinity_stays),
        cmocka_unit_test(metals_stay_metals),
        cmocka_unit_test(even_models_come_back),
        cmocka_unit_test(noise_becomes_smooth),
        cmocka_unit_test(numbers_that_cannot_be_are_refused),
        cmocka_unit_test(other_words_are_damaged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
