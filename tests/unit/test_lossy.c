// test_lossy.c - planes coded with loss: near what they were, alone by tiles, and never believed
#include "test.h"

#include "core/base/memory.h"
#include "format/coder/coding.h"
#include "format/lossy/disparity.h"
#include "format/lossy/slopes.h"

#include <math.h>

enum { LIGHTS = 6 };

static const struct relume_vec3 lights[LIGHTS] = {
    {0, 0, 1}, {0.6, 0, 0.8}, {0, 0.6, 0.8}, {-0.6, 0, 0.8}, {0, -0.6, 0.8}, {0.48, 0.36, 0.8}};

// A smooth picture with an edge, another for every plane; moved a little from view to view.
static uint16_t sample(int plane, int x, int y, int view)
{
    x += 2 * view;
    const double wave = 1200.0 * sin(0.11 * x + 0.5 * plane) * cos(0.07 * y - 0.3 * plane);
    return (uint16_t)(2048.0 + wave + (x + 2 * y > 40 + 9 * plane ? 600.0 : 0.0));
}

struct made {
    relume_coder *coder;
    relume_coefficients *coefficients;
    uint16_t *codes;
    struct lossy_shape shape;
    int *order;
};

// `table` has pictures in colour, `sh` of the luminance grey planes.
static void make_view(struct made *m, int width, int height, bool colour, int view)
{
    *m = (struct made){0};
    assert_int_equal(relume_coder_create(
                         &m->coder, colour ? &relume_basis_table : &relume_basis_sh, lights, LIGHTS,
                         relume_coder_params(.coefficients = colour ? 0 : 4, .luminance = !colour,
                                             .no_ridge = true)),
                     RELUME_OK);
    const int planes = relume_coder_info(m->coder)->planes;
    const size_t pixels = (size_t)width * (size_t)height;
    m->codes = malloc((size_t)planes * pixels * sizeof *m->codes);
    const void *plane[3 * LIGHTS];
    float scale[3 * LIGHTS], offset[3 * LIGHTS];
    for (int p = 0; p < planes; p++) {
        for (size_t i = 0; i < pixels; i++)
            m->codes[(size_t)p * pixels + i] =
                sample(p, (int)(i % (size_t)width), (int)(i / (size_t)width), view);
        plane[p] = m->codes + (size_t)p * pixels;
        scale[p] = 1.0f;
        offset[p] = 0.0f;
    }
    const struct relume_codes codes = {.coder = m->coder,
                                       .width = width,
                                       .height = height,
                                       .planes = planes,
                                       .storage = RELUME_STORE_12,
                                       .plane = plane,
                                       .scale = scale,
                                       .offset = offset};
    assert_int_equal(relume_coefficients_keep(&m->coefficients, &codes, NULL), RELUME_OK);
    m->order = lossy_order(m->coder);
    m->shape =
        (struct lossy_shape){width, height, planes, lossy_in_colour(m->coder), m->order, NULL};
    assert_int_equal(m->shape.colour, colour);
}

static void make(struct made *m, int width, int height, bool colour)
{
    make_view(m, width, height, colour, 0);
}

static void drop(struct made *m)
{
    relume_coefficients_destroy(&m->coefficients);
    relume_coder_destroy(&m->coder);
    free(m->codes);
    relume_free(m->order);
}

static double rms(const uint16_t *a, const uint16_t *b, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += ((double)a[i] - b[i]) * ((double)a[i] - b[i]);
    return sqrt(sum / (double)n);
}

static struct lossy_words encoded(const struct made *m, int quantiser, int threads)
{
    struct lossy_words words;
    assert_int_equal(lossy_encode(&words, &m->coefficients, 1,
                                  &(const struct av1_effort){quantiser, AV1_GOOD_6_SCREEN}, threads,
                                  NULL),
                     RELUME_OK);
    return words;
}

// Odd sizes, sizes below a block, and views of several tiles.
static void test_planes_come_back(void **state)
{
    static const int sizes[][2] = {{37, 21}, {3, 2}, {520, 17}, {16, 530}};
    (void)state;
    for (size_t i = 0; i < 2 * sizeof sizes / sizeof *sizes; i++) {
        struct made m;
        make(&m, sizes[i / 2][0], sizes[i / 2][1], i % 2);
        const size_t n = (size_t)m.shape.planes * (size_t)m.shape.width * (size_t)m.shape.height;
        uint16_t *back = malloc(n * sizeof *back);
        const struct lossy_words fine = encoded(&m, AV1_FINEST, 1),
                                 coarse = encoded(&m, 50 * AV1_STEPS, 1);
        assert_int_equal(
            lossy_decode(back, &m.shape,
                         &(const struct relume_rect){0, 0, m.shape.width, m.shape.height}, &fine,
                         NULL, 1, NULL),
            RELUME_OK);
        // the finest steps are some 8 of 4096 codes, of luma and the differences that make blue
        assert_true(rms(back, m.codes, n) < 8.0);
        assert_int_equal(
            lossy_decode(back, &m.shape,
                         &(const struct relume_rect){0, 0, m.shape.width, m.shape.height}, &coarse,
                         NULL, 1, NULL),
            RELUME_OK);
        assert_true(rms(back, m.codes, n) < 320.0);  // a fifth of what the planes vary by
        assert_true(coarse.count <= fine.count);
        relume_free(fine.word);
        relume_free(coarse.word);
        free(back);
        drop(&m);
    }
}

// Pictures of one component or three, smooth with a little noise; chromas are neutral.
static void fill_pictures(uint16_t *samples, const struct av1_shape *shape)
{
    uint32_t state = 7;
    for (int p = 0; p < shape->pictures; p++)
        for (int c = 0; c < shape->components; c++)
            for (int y = 0; y < shape->height; y++)
                for (int x = 0; x < shape->width; x++) {
                    state = state * 1664525u + 1013904223u;
                    const double v = 2000.0 + 1200.0 * sin(0.1 * x + 0.4 * p) * cos(0.07 * y);
                    *samples++ = c ? AV1_MIDDLE : (uint16_t)(v + (double)(state >> 26));
                }
}

static size_t code_pictures(uint16_t *back, const uint16_t *samples, const struct av1_shape *shape,
                            const struct av1_effort *effort)
{
    struct av1_bytes bytes;
    assert_int_equal(av1_encode(&bytes, &samples, 1, shape, effort, 2, NULL), RELUME_OK);
    assert_int_equal(av1_decode(back, shape, &bytes, NULL), RELUME_OK);
    relume_free(bytes.byte);
    return bytes.size;
}

// A mode of libaom that is broken misses whole blocks. Neutral colours stay neutral with few bits.
static void test_every_preset_comes_back(void **state)
{
    (void)state;
    for (int i = 0; i < 2 * AV1_PRESETS; i++) {
        const struct av1_shape shape = {96, 64, i % 2 ? 3 : 1, 4, NULL};
        const struct av1_effort effort = {AV1_FINEST, (enum av1_preset_number)(i / 2)};
        const size_t plane = 96 * 64, n = plane * 4 * (size_t)shape.components;
        uint16_t *samples = malloc(n * sizeof *samples), *back = malloc(n * sizeof *back);
        fill_pictures(samples, &shape);
        code_pictures(back, samples, &shape, &effort);
        // a step is 77 codes with 8 bits and 32 with 12, and errors are even within it
        assert_true(rms(back, samples, n) < (av1_presets[i / 2].bits == 8 ? 77.0 : 32.0) / 3.0);
        for (size_t k = 0; k < n; k++)
            if (k / plane % (size_t)shape.components)
                assert_int_equal(back[k], AV1_MIDDLE);
        free(samples);
        free(back);
    }
}

// A step that was halved thrice is coded by a quantiser that is eight times as coarse.
static void test_halved_steps_are_coded_coarsely(void **state)
{
    static const unsigned char halved[4] = {3, 3, 3, 3};
    static const enum av1_preset_number preset[] = {AV1_GOOD_6, AV1_REALTIME_7};
    (void)state;
    for (size_t i = 0; i < sizeof preset / sizeof *preset; i++) {
        const struct av1_shape whole = {96, 64, 1, 4, NULL}, shape = {96, 64, 1, 4, halved};
        const struct av1_effort effort = {6 * AV1_STEPS, preset[i]};
        enum { N = 96 * 64 * 4 };
        uint16_t *samples = malloc(N * sizeof *samples), *back = malloc(N * sizeof *back);
        fill_pictures(samples, &whole);
        const size_t fine = code_pictures(back, samples, &whole, &effort);
        const double near = rms(back, samples, N);
        const size_t coarse = code_pictures(back, samples, &shape, &effort);
        const double far = rms(back, samples, N);
        assert_true(2 * coarse < fine);
        // noise of 64 codes is what a coarse step cannot keep
        assert_true(far > 1.2 * near && far < 8.0 * near);
        free(samples);
        free(back);
    }
}

// All of a view and a part of it, as the view of one tile would come back.
static void test_a_trial_is_what_would_be_read(void **state)
{
    (void)state;
    for (int colour = 0; colour < 2; colour++) {
        enum { WIDTH = 37, HEIGHT = 21 };
        struct made m;
        make(&m, WIDTH, HEIGHT, colour);
        const struct relume_rect all = {0, 0, WIDTH, HEIGHT}, some = {5, 3, 16, 9};
        const size_t n = (size_t)m.shape.planes * WIDTH * HEIGHT;
        const struct av1_effort effort = {120, AV1_GOOD_6_SCREEN};
        uint16_t *back = malloc(n * sizeof *back), *before = malloc(n * sizeof *before),
                 *after = malloc(n * sizeof *after);
        const struct lossy_words words = encoded(&m, effort.quantiser, 1);
        size_t bytes;
        assert_int_equal(lossy_decode(back, &m.shape, &all, &words, NULL, 1, NULL), RELUME_OK);
        assert_int_equal(lossy_try(before, after, &bytes, m.coefficients, &all, &effort, 1, NULL),
                         RELUME_OK);
        assert_memory_equal(before, m.codes, n * sizeof *before);
        assert_memory_equal(after, back, n * sizeof *after);
        assert_int_equal((bytes + 3) / 4 + 5, words.count);  // a head of five words
        assert_int_equal(lossy_try(before, after, &bytes, m.coefficients, &some, &effort, 1, NULL),
                         RELUME_OK);
        for (int p = 0; p < m.shape.planes; p++)
            for (int y = 0; y < some.height; y++)
                assert_memory_equal(before + (p * some.height + y) * some.width,
                                    m.codes + (p * HEIGHT + some.top + y) * WIDTH + some.left,
                                    (size_t)some.width * sizeof *before);
        relume_free(words.word);
        free(back);
        free(before);
        free(after);
        drop(&m);
    }
}

// Within a tile, across two, and the last column.
static void test_a_rectangle_is_that_of_the_view(void **state)
{
    static const struct relume_rect rects[] = {{3, 5, 20, 7}, {500, 0, 30, 24}, {599, 23, 1, 1}};
    struct made m;
    (void)state;
    make(&m, 600, 24, true);
    const struct lossy_words w = encoded(&m, 80, 1);
    const size_t n = (size_t)m.shape.planes * 600 * 24;
    uint16_t *whole = malloc(n * sizeof *whole), *part = malloc(n * sizeof *part);
    const struct relume_rect all = {0, 0, 600, 24};
    assert_int_equal(lossy_decode(whole, &m.shape, &all, &w, NULL, 1, NULL), RELUME_OK);
    for (size_t i = 0; i < sizeof rects / sizeof *rects; i++) {
        const struct relume_rect *r = &rects[i];
        assert_int_equal(lossy_decode(part, &m.shape, r, &w, NULL, 2, NULL), RELUME_OK);
        for (int p = 0; p < m.shape.planes; p++)
            for (int y = 0; y < r->height; y++)
                assert_memory_equal(part + ((size_t)p * (size_t)r->height + (size_t)y) *
                                               (size_t)r->width,
                                    whole + ((size_t)p * 24 + (size_t)(r->top + y)) * 600 + r->left,
                                    (size_t)r->width * sizeof *part);
    }
    // a tile beside the rectangle is not looked at
    w.word[w.count - 3] ^= 0x400;
    assert_int_equal(lossy_decode(part, &m.shape, &rects[0], &w, NULL, 1, NULL), RELUME_OK);
    free(whole);
    free(part);
    mem_free(w.word);
    drop(&m);
}

static void test_threads_change_nothing(void **state)
{
    struct made m;
    (void)state;
    make(&m, 600, 40, true);
    const struct lossy_words one = encoded(&m, 122, 1), four = encoded(&m, 122, 4);
    assert_int_equal(one.count, four.count);
    assert_memory_equal(one.word, four.word, one.count * sizeof *one.word);
    relume_free(one.word);
    relume_free(four.word);
    drop(&m);
}

// Three tiles in two pieces, as those of two machines: what they hold, and both together.
static void test_tiles_alone_are_those_of_the_view(void **state)
{
    const struct av1_effort effort = {122, AV1_GOOD_6_SCREEN};
    struct made m;
    struct lossy_held held;
    struct lossy_words some, rest, again;
    (void)state;
    make(&m, 1040, 24, true);
    const struct lossy_words whole = encoded(&m, effort.quantiser, 1);
    const struct lossy_cut cut = lossy_cut_of(m.coder, 1040, 24, 1);
    assert_true(cut.side == 512 && cut.across == 3 && cut.count == 3);
    struct av1_bytes tile[3];
    assert_int_equal(lossy_encode_tiles(tile, &m.coefficients, 1, 0, 1, &effort, 2, NULL),
                     RELUME_OK);
    assert_int_equal(lossy_encode_tiles(tile + 1, &m.coefficients, 1, 1, 3, &effort, 1, NULL),
                     RELUME_OK);
    assert_int_equal(lossy_join(&again, &cut, tile, 1), RELUME_OK);
    assert_int_equal(again.count, whole.count);
    assert_memory_equal(again.word, whole.word, whole.count * sizeof *whole.word);
    assert_int_equal(lossy_keep_tiles(&some, &whole, 0, 1), RELUME_OK);
    assert_int_equal(lossy_keep_tiles(&rest, &whole, 1, 3), RELUME_OK);
    assert_int_equal(lossy_look(&held, some.word, some.count), RELUME_OK);
    assert_true(held.first == 0 && held.end == 1 && held.count == 3 && held.words == some.count);
    assert_int_equal(lossy_look(&held, rest.word, rest.count), RELUME_OK);
    assert_true(held.first == 1 && held.end == 3 && held.side == 512 && held.words == rest.count);
    const size_t head = lossy_words_of(&cut);
    assert_int_equal(some.count + rest.count, whole.count + head);
    lossy_add_tiles(some.word, rest.word, &held);
    assert_memory_equal(some.word, whole.word, some.count * sizeof *some.word);
    assert_memory_equal(rest.word + head, whole.word + some.count, (rest.count - head) * 4);
    // what is missing cannot be decoded, and nothing is believed
    uint16_t *back = malloc((size_t)m.shape.planes * 1040 * 24 * sizeof *back);
    const struct relume_rect first = {0, 0, 512, 24}, last = {1024, 0, 16, 24};
    assert_int_equal(lossy_decode(back, &m.shape, &last, &rest, NULL, 1, NULL), RELUME_OK);
    assert_int_equal(lossy_decode(back, &m.shape, &first, &rest, NULL, 1, NULL), RELUME_EDAMAGED);
    assert_int_equal(lossy_look(&held, rest.word, head - 1), RELUME_EDAMAGED);
    rest.word[3] = rest.word[7];  // the tile between them is missing
    rest.word[5] = 0;
    assert_int_equal(lossy_look(&held, rest.word, rest.count), RELUME_EDAMAGED);
    rest.word[2] = 0xffffffff;
    assert_int_equal(lossy_look(&held, rest.word, rest.count), RELUME_EDAMAGED);
    for (int i = 0; i < 3; i++)
        mem_free(tile[i].byte);
    mem_free(again.word);
    mem_free(some.word);
    mem_free(rest.word);
    relume_free(whole.word);
    free(back);
    drop(&m);
}

static void note_tile(void *user, const struct relume_rect *at)
{
    int *seen = user;
    seen[0]++;
    seen[1] = at->left;
    seen[2] = at->top;
    seen[3] = at->width;
    seen[4] = at->height;
}

// Two tiles: damage to one leaves the other.
static void test_a_damaged_tile_is_lost_alone(void **state)
{
    struct made m;
    int seen[5] = {0};
    const struct lossy_lost lost = {note_tile, seen};
    (void)state;
    make(&m, 600, 24, false);
    struct lossy_words w = encoded(&m, 80, 1);
    const size_t n = (size_t)m.shape.planes * 600 * 24;
    uint16_t *whole = malloc(n * sizeof *whole), *part = malloc(n * sizeof *part);
    assert_int_equal(lossy_decode(whole, &m.shape,
                                  &(const struct relume_rect){0, 0, m.shape.width, m.shape.height},
                                  &w, NULL, 1, NULL),
                     RELUME_OK);
    w.word[w.count - 3] ^= 0x400;
    assert_int_equal(lossy_decode(part, &m.shape,
                                  &(const struct relume_rect){0, 0, m.shape.width, m.shape.height},
                                  &w, NULL, 1, NULL),
                     RELUME_EDAMAGED);
    assert_int_equal(lossy_decode(part, &m.shape,
                                  &(const struct relume_rect){0, 0, m.shape.width, m.shape.height},
                                  &w, NULL, 1, &lost),
                     RELUME_OK);
    const int expected[5] = {1, 512, 0, 88, 24};
    assert_memory_equal(seen, expected, sizeof expected);
    for (size_t i = 0; i < n; i++)
        assert_int_equal(part[i], i % 600 < 512 ? whole[i] : 0);
    free(whole);
    free(part);
    relume_free(w.word);
    drop(&m);
}

static void test_words_are_not_believed(void **state)
{
    struct made m;
    (void)state;
    make(&m, 24, 24, true);
    const struct lossy_words w = encoded(&m, 80, 1);
    uint16_t *back = malloc((size_t)m.shape.planes * 24 * 24 * sizeof *back);
    for (size_t count = 0; count < w.count; count++)
        assert_int_equal(
            lossy_decode(back, &m.shape,
                         &(const struct relume_rect){0, 0, m.shape.width, m.shape.height},
                         &(const struct lossy_words){w.word, count}, NULL, 1, NULL),
            RELUME_EDAMAGED);
    for (size_t i = 0; i < 5; i++) {  // the head: what it is, tiles, bytes, checksum
        w.word[i] ^= 0x80000001u;
        assert_int_equal(
            lossy_decode(back, &m.shape,
                         &(const struct relume_rect){0, 0, m.shape.width, m.shape.height}, &w, NULL,
                         1, NULL),
            RELUME_EDAMAGED);
        w.word[i] ^= 0x80000001u;
    }
    const struct lossy_shape other = {32, 24, m.shape.planes, true, m.order, NULL};
    uint16_t *wide = malloc((size_t)m.shape.planes * 32 * 24 * sizeof *wide);
    assert_int_equal(lossy_decode(wide, &other,
                                  &(const struct relume_rect){0, 0, other.width, other.height}, &w,
                                  NULL, 1, NULL),
                     RELUME_EDAMAGED);
    free(wide);
    free(back);
    relume_free(w.word);
    drop(&m);
}

// Views that hardly differ: each needs its anchor and nothing else, and little more than that.
static void test_a_group_is_predicted_from_its_anchor(void **state)
{
    enum { VIEWS = 3 };
    struct made m[VIEWS];
    relume_coefficients *from[VIEWS];
    struct lossy_words group[VIEWS];
    int seen[5] = {0};
    const struct lossy_lost lost = {note_tile, seen};
    (void)state;
    for (int v = 0; v < VIEWS; v++) {
        make_view(&m[v], 600, 48, true, v);
        from[v] = m[v].coefficients;
    }
    assert_int_equal(lossy_encode(group, from, VIEWS,
                                  &(const struct av1_effort){80, AV1_GOOD_6_SCREEN}, 2, NULL),
                     RELUME_OK);
    const struct lossy_words alone = encoded(&m[2], 80, 1);
    const size_t n = (size_t)m->shape.planes * 600 * 48;
    uint16_t *back = malloc(n * sizeof *back);
    for (int v = 0; v < VIEWS; v++) {
        assert_int_equal(
            lossy_decode(back, &m->shape,
                         &(const struct relume_rect){0, 0, m->shape.width, m->shape.height},
                         &group[v], v ? &group[0] : NULL, 2, NULL),
            RELUME_OK);
        // as near as a view alone at this step: some 20 of 4096 codes
        assert_true(rms(back, m[v].codes, n) < 32.0);
    }
    assert_true(2 * group[2].count < alone.count);
    assert_int_equal(
        lossy_decode(back, &m->shape,
                     &(const struct relume_rect){0, 0, m->shape.width, m->shape.height}, &group[2],
                     NULL, 1, NULL),
        RELUME_EDAMAGED);
    group[0].word[group[0].count - 3] ^= 0x400;
    assert_int_equal(
        lossy_decode(back, &m->shape,
                     &(const struct relume_rect){0, 0, m->shape.width, m->shape.height}, &group[2],
                     &group[0], 1, NULL),
        RELUME_EDAMAGED);
    assert_int_equal(
        lossy_decode(back, &m->shape,
                     &(const struct relume_rect){0, 0, m->shape.width, m->shape.height}, &group[2],
                     &group[0], 1, &lost),
        RELUME_OK);
    assert_int_equal(seen[0], 1);
    assert_int_equal(seen[1], 512);
    free(back);
    mem_free(alone.word);
    for (int v = 0; v < VIEWS; v++) {
        mem_free(group[v].word);
        drop(&m[v]);
    }
}

// ---------------------------------------------------------------- depth

static struct relume_image depth_map(int width, int height)
{
    struct relume_image d;
    assert_int_equal(relume_image_create(&d, width, height, 1), RELUME_OK);
    for (int i = 0; i < width * height; i++) {
        const int x = i % width, y = i / width;
        d.data[i] = x + y < 5 ? INFINITY : x > y ? 2.0f + 0.013f * (float)y : 7.0f;
    }
    return d;
}

// Half a step of rounding, half of smoothing, and float's rounding of the inverse.
static void test_depth_comes_back_within_a_step(void **state)
{
    static const int sizes[][2] = {{1, 1}, {7, 3}, {40, 33}};
    static const float steps[] = {0.01f, 1e-4f, 1e-12f};  // the last has too many steps
    (void)state;
    for (int i = 0; i < 9; i++) {
        struct relume_image d = depth_map(sizes[i / 3][0], sizes[i / 3][1]), back;
        struct lossy_words words;
        float step = steps[i % 3];
        assert_int_equal(relume_image_create(&back, d.width, d.height, 1), RELUME_OK);
        assert_int_equal(disparity_encode(&words, &step, &d), RELUME_OK);
        assert_true(step >= steps[i % 3]);
        assert_int_equal(disparity_decode(&back, &words, step), RELUME_OK);
        for (int k = 0; k < d.width * d.height; k++) {
            const double truth = 1.0 / d.data[k], found = 1.0 / back.data[k];
            assert_true(isinf(d.data[k]) == isinf(back.data[k]));
            assert_true(fabs(truth - found) <= step + 1e-7 * truth);
        }
        for (size_t count = 0; count < words.count; count++)
            assert_int_equal(
                disparity_decode(&back, &(const struct lossy_words){words.word, count}, step),
                RELUME_EDAMAGED);
        words.word[words.count - 1] ^= 1;
        assert_int_equal(disparity_decode(&back, &words, step), RELUME_EDAMAGED);
        mem_free(words.word);
        relume_image_destroy(&back);
        relume_image_destroy(&d);
    }
}

static void steps_of(struct relume_image *inverse, float (*surface)(int x, int y))
{
    uint16_t steps[64 * 48];
    assert_int_equal(relume_image_create(inverse, 64, 48, 1), RELUME_OK);
    for (int i = 0; i < 64 * 48; i++)
        steps[i] = (uint16_t)lrintf(surface(i % 64, i / 64));
    assert_int_equal(slopes_of_steps(inverse, steps), RELUME_OK);
}

static float slanted(int x, int y)
{
    return 100.0f + 0.13f * (float)x - 0.07f * (float)y;
}

// Whole steps are off by 0.29 of one (uniform between +-1/2: 1/sqrt 12); where they change is known
// to a pixel, so slopes are better by as many pixels as a step is long, but at the picture's edges.
static void test_a_slanted_plane_is_smooth(void **state)
{
    struct relume_image found;
    double square = 0.0;
    (void)state;
    steps_of(&found, slanted);
    for (int i = 0; i < 64 * 48; i++) {
        const double miss = (double)(found.data[i] - slanted(i % 64, i / 64));
        square += miss * miss;
        assert_true(fabs(miss) < 1.0);
    }
    assert_true(sqrt(square / (64 * 48)) < 0.5 / sqrt(12.0));
    relume_image_destroy(&found);
}

static float cliff(int x, int y)
{
    (void)y;
    return x < 30 ? 0.0f : x < 40 ? 50.0f : 52.0f;
}

static void test_an_edge_stays_sharp(void **state)
{
    struct relume_image found;
    (void)state;
    steps_of(&found, cliff);
    for (int i = 0; i < 64 * 48; i++)
        assert_true(found.data[i] == cliff(i % 64, i / 64));
    relume_image_destroy(&found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_planes_come_back),
        cmocka_unit_test(test_every_preset_comes_back),
        cmocka_unit_test(test_halved_steps_are_coded_coarsely),
        cmocka_unit_test(test_a_trial_is_what_would_be_read),
        cmocka_unit_test(test_a_rectangle_is_that_of_the_view),
        cmocka_unit_test(test_threads_change_nothing),
        cmocka_unit_test(test_tiles_alone_are_those_of_the_view),
        cmocka_unit_test(test_a_damaged_tile_is_lost_alone),
        cmocka_unit_test(test_words_are_not_believed),
        cmocka_unit_test(test_a_group_is_predicted_from_its_anchor),
        cmocka_unit_test(test_depth_comes_back_within_a_step),
        cmocka_unit_test(test_a_slanted_plane_is_smooth),
        cmocka_unit_test(test_an_edge_stays_sharp),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
