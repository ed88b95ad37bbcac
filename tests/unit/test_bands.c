// test_bands.c - every reader of pictures gives the same rows in bands of any height, or says why
// not
#include "in_folder.h"
#include "made_exr.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/thread.h"
#include "image/image/exr.h"
#include "image/image/image.h"

#include <limits.h>

enum { WIDTH = 22, HEIGHT = 38, SAMPLES = WIDTH * HEIGHT * 4 };

static const int bands[] = {1, 2, 3, 5, 7, 16, 17, HEIGHT};
enum { BANDS = sizeof bands / sizeof *bands };

// ---------------------------------------------------------------- pictures

struct source {
    const char *file;            // or NULL:
    struct picture_array array;  // samples in memory
};

static relume_status open_source(picture_reader **out, const struct source *s)
{
    return s->file ? picture_open(out, path_of(s->file), NULL, NULL, NULL)
                   : array_picture_open(out, &s->array);
}

static size_t row_bytes(const struct picture_info *i)
{
    return (size_t)i->width * (size_t)i->channels * (i->bytes ? 1 : sizeof(float));
}

static relume_status read_rows(picture_reader *r, int row, int rows, void *out)
{
    return picture_info_of(r)->bytes ? picture_read_bytes(r, row, rows, out)
                                     : picture_read_floats(r, row, rows, out);
}

// Into memory that ends where the rows end, for ASan.
static bool are_rows(picture_reader *r, int row, int rows, const uint8_t *whole)
{
    const size_t line = row_bytes(picture_info_of(r)), n = (size_t)rows * line;
    uint8_t *band = malloc(n);
    const bool same =
        !read_rows(r, row, rows, band) && !memcmp(band, whole + (size_t)row * line, n);
    free(band);
    return same;
}

static bool are_bands(picture_reader *r, int height, const uint8_t *whole)
{
    bool same = true;
    for (int y = 0; same && y < HEIGHT; y += height)
        same = are_rows(r, y, y + height < HEIGHT ? height : HEIGHT - y, whole);
    return same;
}

static void check_any_order(picture_reader *r, const uint8_t *whole)
{
    for (int b = 0; b < BANDS; b++) {
        const int height = bands[b];
        for (int y = (HEIGHT - 1) / height * height; y >= 0; y -= height)
            assert_true(are_rows(r, y, y + height < HEIGHT ? height : HEIGHT - y, whole));
    }
    uint32_t seed = 7;
    for (int k = 0; k < 50; k++) {
        const int row = (int)(test_random(&seed) % HEIGHT);
        assert_true(
            are_rows(r, row, 1 + (int)(test_random(&seed) % (uint32_t)(HEIGHT - row)), whole));
        assert_true(are_rows(r, row, 1, whole));
    }
}

// Nothing is written, a sentence says why.
static void check_refused(picture_reader *r, int row, int rows)
{
    float untouched = 0.5f;
    assert_int_equal(read_rows(r, row, rows, &untouched), RELUME_EINVAL);
    assert_true(untouched == 0.5f);
    assert_string_not_equal(picture_error(r), "");
}

static void check_rows_that_are_not(picture_reader *r)
{
    static const int none[][2] = {{-1, 1},      {0, 0},          {0, -1},      {HEIGHT, 1},
                                  {5, HEIGHT},  {0, HEIGHT + 1}, {INT_MAX, 1}, {1, INT_MAX},
                                  {INT_MIN, 1}, {0, INT_MIN}};
    float untouched = 0.5f;
    for (size_t i = 0; i < sizeof none / sizeof *none; i++)
        check_refused(r, none[i][0], none[i][1]);
    assert_int_equal(picture_info_of(r)->bytes ? picture_read_floats(r, 0, 1, &untouched)
                                               : picture_read_bytes(r, 0, 1, (uint8_t *)&untouched),
                     RELUME_EINVAL);
    assert_true(untouched == 0.5f);
}

// After each refusal the next rows come as if it had not been asked.
static void check_top_down(picture_reader *r, const uint8_t *whole)
{
    check_refused(r, 1, 1);
    for (int y = 0; y < HEIGHT; y++) {
        assert_true(are_rows(r, y, 1, whole));
        assert_string_equal(picture_error(r), "");
        check_refused(r, y, 1);
        check_refused(r, 0, 1);
        if (y + 2 < HEIGHT)
            check_refused(r, y + 2, 1);
    }
}

struct many {
    picture_reader *reader[4];
    const uint8_t *whole;
    bool same[4];
};

static void read_many(void *context, size_t item, int worker)
{
    struct many *m = context;
    (void)worker;
    m->same[item] = are_bands(m->reader[item], bands[item + 1], m->whole);
}

static void check_threads(const struct source *s, const uint8_t *whole)
{
    struct many m = {.whole = whole};
    for (int i = 0; i < 4; i++)
        CHECK_OK(open_source(&m.reader[i], s));
    thread_for(4, 4, read_many, &m);
    for (int i = 0; i < 4; i++) {
        assert_true(m.same[i]);
        picture_close(&m.reader[i]);
    }
}

static struct image_stream stream_of(const struct source *s)
{
    static const float no_gain[3] = {1, 1, 1};
    const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};
    struct image_stream stream;
    picture_reader *r;
    CHECK_OK(open_source(&r, s));
    CHECK_OK(image_stream_open(&stream, r, 3, linear, linear, no_gain));
    return stream;
}

// Bands that are left out change nothing of the others.
static void check_streams(const struct source *s)
{
    static float whole[SAMPLES], some[SAMPLES];
    const size_t line = 3 * WIDTH;
    struct image_stream stream = stream_of(s);
    CHECK_OK(image_stream_read(&stream, 0, HEIGHT, whole));
    image_stream_close(&stream);
    for (int b = 0; b < BANDS; b++)
        for (int skipped = 0; skipped < 3; skipped++) {  // 0: none, 1: odd bands, 2: even ones
            stream = stream_of(s);
            for (int y = 0, k = 1; y < HEIGHT; y += bands[b], k++) {
                const int rows = y + bands[b] < HEIGHT ? bands[b] : HEIGHT - y;
                if (skipped == 1 + k % 2) {
                    CHECK_OK(image_stream_skip(&stream, y, rows));
                    continue;
                }
                CHECK_OK(image_stream_read(&stream, y, rows, some));
                assert_memory_equal(some, whole + (size_t)y * line,
                                    (size_t)rows * line * sizeof *some);
            }
            image_stream_close(&stream);
        }
}

static void check_source(const struct source *s)
{
    picture_reader *r;
    CHECK_OK(open_source(&r, s));
    const struct picture_info info = *picture_info_of(r);
    assert_true(info.width == WIDTH && info.height == HEIGHT);
    uint8_t *whole = malloc(HEIGHT * row_bytes(&info));
    check_rows_that_are_not(r);
    CHECK_OK(read_rows(r, 0, HEIGHT, whole));
    picture_close(&r);
    for (int b = 0; b < BANDS; b++) {
        CHECK_OK(open_source(&r, s));
        assert_true(are_bands(r, bands[b], whole));
        picture_close(&r);
    }
    CHECK_OK(open_source(&r, s));
    if (info.jumps)
        check_any_order(r, whole);
    else
        check_top_down(r, whole);
    check_rows_that_are_not(r);
    picture_close(&r);
    check_threads(s, whole);
    check_streams(s);
    free(whole);
}

static void fill(uint8_t *bytes, float *floats)
{
    uint32_t seed = 11;
    for (int i = 0; i < SAMPLES; i++) {
        bytes[i] = (uint8_t)test_random(&seed);
        floats[i] = (float)test_uniform(&seed);
    }
}

static void arrays_in_memory(void **state)
{
    (void)state;
    static uint8_t bytes[SAMPLES];
    static float floats[SAMPLES];
    static const size_t sizes[] = {1, 2, 4};
    static const int channels[] = {1, 3, 4};
    fill(bytes, floats);
    for (int k = 0; k < 9; k++) {
        const size_t size = sizes[k / 3],
                     n = (size_t)WIDTH * HEIGHT * (size_t)channels[k % 3] * size;
        for (size_t off = 0; off < 2; off++) {  // 1: at an odd address
            uint8_t *data = malloc(n + off);
            memcpy(data + off, size == 1 ? (const void *)bytes : floats, n);
            check_source(
                &(struct source){.array = {data + off, size, WIDTH, HEIGHT, channels[k % 3]}});
            free(data);
        }
    }
}

// ---------------------------------------------------------------- files

// Formats that the installed OpenImageIO does not write are left out.
static void files_of_bytes(void **state)
{
    (void)state;
    static uint8_t bytes[SAMPLES];
    static float floats[SAMPLES];
    static const char *const names[] = {"a.png", "a.jpg", "a.tif", "a.bmp",
                                        "a.tga", "a.ppm", "a.webp"};
    int checked = 0;
    fill(bytes, floats);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        for (int channels = 1; channels <= 4; channels += channels == 1 ? 2 : 1) {
            if (picture_write_bytes(path_of(names[i]), NULL, WIDTH, HEIGHT, channels, bytes, NULL))
                continue;
            check_source(&(struct source){.file = names[i]});
            checked++;
        }
    assert_true(checked >= 12);
    // PNG with a profile is OpenImageIO's
    const struct relume_image image = {WIDTH, HEIGHT, 3, .data = floats};
    CHECK_OK(relume_image_save(&image, path_of("p.png"), relume_image_params(.profile = true)));
    check_source(&(struct source){.file = "p.png"});
}

static void files_of_words_and_floats(void **state)
{
    (void)state;
    static uint8_t bytes[SAMPLES];
    static float floats[SAMPLES];
    static const char *const names[] = {"a.hdr", "a.pfm", "f.tif"};
    fill(bytes, floats);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        CHECK_OK(picture_write_floats(path_of(names[i]), NULL, WIDTH, HEIGHT, 3, floats, NULL));
        check_source(&(struct source){.file = names[i]});
    }
    char head[32];
    const int n = snprintf(head, sizeof head, "P6 %d %d 65535\n", WIDTH, HEIGHT);
    uint8_t *file = malloc((size_t)n + SAMPLES * 2);
    memcpy(file, head, (size_t)n);
    memcpy(file + n, floats, (size_t)WIDTH * HEIGHT * 6);
    test_write(path_of("w.ppm"), file, (size_t)n + (size_t)WIDTH * HEIGHT * 6);
    free(file);
    check_source(&(struct source){.file = "w.ppm"});
}

struct rows_of {
    enum exr_sample sample;
    int channels;
};

static float value_at(int row, int channel, int x)
{
    return (float)((row * 131 + channel * 37 + x * 11) % 251) / 256.0f;
}

static relume_status make_rows(void *context, int row, int rows, void *samples)
{
    const struct rows_of *m = context;
    const size_t bytes = exr_sample_bytes(m->sample);
    char *to = samples;
    for (int y = row; y < row + rows; y++)
        for (int c = 0; c < m->channels; c++)
            for (int x = 0; x < WIDTH; x++, to += bytes) {
                const float v = value_at(y, c, x);
                exr_from_floats(to, m->sample, &v, 1);
            }
    return RELUME_OK;
}

static void exr_files(void **state)
{
    (void)state;
    static const char *const names[][4] = {{"Y"}, {"B", "G", "R"}, {"A", "B", "G", "R"}};
    static const int tiles[] = {0, 16}, channels[] = {1, 3, 4};
    for (int k = 0; k < 48; k++) {
        struct rows_of rows = {k % 2 ? EXR_SAMPLE_HALF : EXR_SAMPLE_FLOAT, channels[k / 2 % 3]};
        const struct exr_part part = {.name = "image",
                                      .width = WIDTH,
                                      .height = HEIGHT,
                                      .sample = rows.sample,
                                      .codec = (enum exr_codec)(k / 12),
                                      .tile = tiles[k / 6 % 2],
                                      .channels = rows.channels,
                                      .channel = names[rows.channels / 2],
                                      .rows = make_rows,
                                      .context = &rows};
        CHECK_OK(exr_write(path_of("a.exr"), NULL, &part, 1, false, 1, NULL));
        check_source(&(struct source){.file = "a.exr"});
    }
}

static float coarse_at(char channel, int x, int y)
{
    return channel == 'Y' ? 0.2f + 0.01f * (float)(x + y % 7) : 0.05f * (float)((x + y) % 5);
}

static void coarse_exr_at_an_offset(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        const struct made_exr m = {
            .x = 4, .y = -6, .width = WIDTH, .height = HEIGHT, .alpha = k, .at = coarse_at};
        made_exr_write(path_of("yc.exr"), &m);
        check_source(&(struct source){.file = "yc.exr"});
    }
}

// Rows behind damage are not the rows of another place.
static void damage_ends_what_goes_top_down(void **state)
{
    (void)state;
    static uint8_t bytes[SAMPLES];
    static float floats[SAMPLES];
    uint8_t row[WIDTH * 3];
    size_t size;
    picture_reader *r;
    fill(bytes, floats);
    CHECK_OK(picture_write_bytes(path_of("a.png"), NULL, WIDTH, HEIGHT, 3, bytes, NULL));
    uint8_t *file = test_read(path_of("a.png"), &size);
    memset(file + size / 2, 0xff, 40);
    test_write(path_of("a.png"), file, size);
    free(file);
    CHECK_OK(picture_open(&r, path_of("a.png"), NULL, NULL, NULL));
    int y = 0;
    while (y < HEIGHT && !picture_read_bytes(r, y, 1, row))
        y++;
    assert_true(y < HEIGHT);
    for (int again = 0; again < HEIGHT; again++) {
        assert_int_equal(picture_read_bytes(r, again, 1, row), RELUME_EDAMAGED);
        assert_non_null(strstr(picture_error(r), "truncated or damaged"));
    }
    picture_close(&r);
}

// ---------------------------------------------------------------- captures

enum { LIGHTS = 6, PIXELS = WIDTH * HEIGHT };
static struct relume_vec3 directions[LIGHTS];

static void check_table(const relume_capture *c, const float *whole, int height, int skipped)
{
    const int lights = relume_capture_manifest(c)->lights;
    const size_t line = 3 * WIDTH;
    relume_table *table;
    CHECK_OK(relume_table_open(&table, c, 0, relume_table_params(.threads = 2)));
    for (int y = 0, k = 1; y < HEIGHT; y += height, k++) {
        const int rows = y + height < HEIGHT ? height : HEIGHT - y;
        const size_t n = (size_t)rows * line;
        float *out = malloc((size_t)lights * n * sizeof *out);
        if (skipped == 1 + k % 2)
            CHECK_OK(relume_table_skip(table, rows));
        else
            CHECK_OK(relume_table_read(table, rows, out));
        for (int i = 0; skipped != 1 + k % 2 && i < lights; i++)
            assert_memory_equal(out + (size_t)i * n,
                                whole + ((size_t)i * HEIGHT + (size_t)y) * line, n * sizeof *out);
        free(out);
    }
    float none[3];
    assert_int_equal(relume_table_read(table, 1, none), RELUME_EINVAL);
    relume_table_destroy(&table);
}

static float *read_table(const relume_capture *c)
{
    const size_t n = (size_t)relume_capture_manifest(c)->lights * PIXELS * 3;
    relume_table *table;
    float *whole = malloc(n * sizeof *whole);
    CHECK_OK(relume_table_open(&table, c, 0, NULL));
    CHECK_OK(relume_table_read(table, HEIGHT, whole));
    relume_table_destroy(&table);
    return whole;
}

static void check_bands(const relume_capture *c)
{
    static const int heights[] = {1, 7, 16, HEIGHT};
    float *whole = read_table(c);
    for (int b = 0; b < 4; b++)
        check_table(c, whole, heights[b], 0);
    check_table(c, whole, 5, 1);
    check_table(c, whole, 17, 2);
    free(whole);
}

// Some of the lights are the capture's own; the capture stays whole when they are gone.
static void check_selections(const relume_capture *c)
{
    static const int chosen[] = {4, 0, 5, 0, 2, 1, 3, 4}, of_these[] = {7, 2};
    relume_capture *some, *fewer;
    char digest[2][RELUME_DIGEST];
    float *whole = read_table(c);
    CHECK_OK(relume_capture_digest(digest[0], c, NULL));
    for (int again = 0; again < 2; again++) {
        CHECK_OK(relume_capture_select(&some, c, chosen, 8));
        CHECK_OK(relume_capture_select(&fewer, some, of_these, 2));
        CHECK_OK(relume_capture_digest(digest[1], some, NULL));
        float *rest = read_table(some), *two = read_table(fewer);
        for (size_t i = 0; i < 8; i++)
            assert_memory_equal(rest + i * 3 * PIXELS, whole + (size_t)chosen[i] * 3 * PIXELS,
                                3 * PIXELS * sizeof *whole);
        assert_memory_equal(two, whole + 4 * 3 * PIXELS, 3 * PIXELS * sizeof *whole);
        assert_memory_equal(two + 3 * PIXELS, whole + 5 * 3 * PIXELS, 3 * PIXELS * sizeof *whole);
        free(rest);
        free(two);
        check_bands(some);
        relume_capture_destroy(&fewer);
        relume_capture_destroy(&some);
        check_bands(c);
    }
    CHECK_OK(relume_capture_digest(digest[1], c, NULL));
    assert_string_equal(digest[0], digest[1]);
    free(whole);
}

static void check_capture(relume_capture *c)
{
    check_bands(c);
    for (int i = LIGHTS - 1, k = 0; k < 2 * LIGHTS; i = (i + LIGHTS - 1) % LIGHTS, k++) {
        struct relume_image image;
        CHECK_OK(relume_capture_image(&image, c, 0, i, NULL));
        relume_image_destroy(&image);
    }
    if (!relume_capture_manifest(c)->positions)  // what is near mixes lights
        check_selections(c);
    relume_capture_destroy(&c);
}

static void captures_in_memory(void **state)
{
    (void)state;
    static const int channels[] = {1, 3, 4};
    static const size_t sizes[] = {4, 1, 2};  // in the order of enum relume_sample
    static float mask[PIXELS], depth[PIXELS];
    struct relume_vec3 near[LIGHTS];
    uint32_t seed = 3;
    for (int i = 0; i < PIXELS; i++) {
        mask[i] = (float)(i % 3 > 0);
        depth[i] = 2.0f + 0.01f * (float)(i % 9);
    }
    for (int i = 0; i < LIGHTS; i++)
        near[i] = (struct relume_vec3){3 * directions[i].x, 3 * directions[i].y, 3};
    for (int k = 0; k < 18; k++) {
        const size_t size = sizes[k / 3 % 3], n = (size_t)LIGHTS * PIXELS * (size_t)channels[k % 3];
        uint8_t *data = malloc(n * size);
        for (size_t i = 0; i < n; i++) {
            const float v = (float)test_uniform(&seed);
            if (size == 4)
                memcpy(data + i * size, &v, size);
            else
                for (size_t b = 0; b < size; b++)
                    data[i * size + b] = (uint8_t)(v * 255.0f);
        }
        const struct relume_manifest m = {
            .lights = LIGHTS, .directions = directions, .positions = k < 9 ? NULL : near};
        const struct relume_pictures pictures = {.sample = (enum relume_sample)(k / 3 % 3),
                                                 .width = WIDTH,
                                                 .height = HEIGHT,
                                                 .channels = channels[k % 3],
                                                 .data = data,
                                                 .mask = k % 2 ? mask : NULL,
                                                 .depth = k < 9 ? NULL : depth};
        relume_capture *c;
        CHECK_OK(relume_capture_create(&c, &m, &pictures, NULL));
        check_capture(c);
        free(data);
    }
}

static void write_picture(const char *name, int light)
{
    static float data[PIXELS * 3];
    const struct relume_image image = {WIDTH, HEIGHT, 3, .data = data};
    for (int i = 0; i < PIXELS * 3; i++)
        data[i] = value_at(i / (3 * WIDTH), light, i % (3 * WIDTH));
    CHECK_OK(relume_image_save(&image, path_of(name), NULL));
}

// Without room for decoded images, with some, with all.
static void captures_of_files(void **state)
{
    (void)state;
    static const char *const endings[] = {"exr", "png", "jpg", "tif", "hdr", "png", "jpg"};
    static const size_t room[] = {0, PIXELS * 3 * 2, 1 << 20};
    char name[LIGHTS][32], text[LIGHTS * 128];
    for (size_t e = 0; e < sizeof endings / sizeof *endings; e++) {
        int n = snprintf(text, sizeof text, "%d\n", LIGHTS);
        for (int i = 0; i < LIGHTS; i++) {
            snprintf(name[i], sizeof name[i], "light%d.%s", i, endings[e]);
            write_picture(name[i], i);
            n += snprintf(text + n, sizeof text - (size_t)n, "%s %g %g %g\n", name[i],
                          directions[i].x, directions[i].y, directions[i].z);
        }
        write_text("lights.lp", text);
        relume_capture *c;
        CHECK_OK(relume_capture_open(&c, path_of("lights.lp"),
                                     relume_capture_params(.keep_bytes = room[e % 3])));
        check_capture(c);
    }
}

static void captures_of_layers(void **state)
{
    (void)state;
    static const char *const colours[] = {"B", "G", "R"};
    static char text[LIGHTS * 3][32];
    static const char *names[LIGHTS * 3];
    float numbers[LIGHTS * 3];
    for (int i = 0; i < 3 * LIGHTS; i++) {
        snprintf(text[i], sizeof text[i], "light%04d.%s", i / 3, colours[i % 3]);
        names[i] = text[i];
        const struct relume_vec3 d = directions[i / 3];
        numbers[i] = (float)(i % 3 == 0 ? d.x : i % 3 == 1 ? d.y : d.z);
    }
    const struct exr_attribute attribute = {
        .name = "olat.directions", .kind = EXR_FLOATS, .floats = numbers, .count = 3 * LIGHTS};
    for (int k = 0; k < 8; k++) {
        const bool apart = k & 4;  // a part for each light
        struct rows_of rows = {k & 1 ? EXR_SAMPLE_HALF : EXR_SAMPLE_FLOAT, apart ? 3 : 3 * LIGHTS};
        struct exr_part part[LIGHTS];
        char name[LIGHTS][16];
        for (int i = 0; i < LIGHTS; i++) {
            snprintf(name[i], sizeof name[i], "light%04d", i);
            part[i] = (struct exr_part){.name = name[i],
                                        .width = WIDTH,
                                        .height = HEIGHT,
                                        .sample = rows.sample,
                                        .codec = EXR_CODEC_ZIP,
                                        .tile = k & 2 ? 16 : 0,
                                        .channels = rows.channels,
                                        .channel = apart ? colours : names,
                                        .attributes = i == 0,
                                        .attribute = &attribute,
                                        .rows = make_rows,
                                        .context = &rows};
        }
        CHECK_OK(exr_write(path_of("olat.exr"), NULL, part, apart ? LIGHTS : 1, false, 1, NULL));
        relume_capture *c;
        struct relume_image image;
        CHECK_OK(relume_capture_open(&c, path_of("olat.exr"), NULL));
        CHECK_OK(relume_capture_image(&image, c, 0, 3, NULL));
        for (int i = 0; i < 3 * PIXELS; i++)  // blue is the first channel of a layer
            assert_true(image.data[i] ==
                        value_at(i / 3 / WIDTH, (apart ? 0 : 9) + 2 - i % 3, i / 3 % WIDTH));
        relume_image_destroy(&image);
        check_capture(c);
    }
}

// Data windows of so many of the parts lie 4 pixels to the right.
static void move_windows(const char *path, int parts)
{
    static const char key[] = "dataWindow\0box2i\0\20\0\0";
    size_t size;
    uint8_t *bytes = test_read(path, &size), *at = bytes;
    for (; parts > 0; parts--) {
        int box[4];
        at = memmem(at, size - (size_t)(at - bytes), key, sizeof key);
        assert_non_null(at);
        at += sizeof key;
        memcpy(box, at, sizeof box);
        box[0] += 4, box[2] += 4;
        memcpy(at, box, sizeof box);
    }
    test_write(path, bytes, size);
    free(bytes);
}

static void layers_of_several_windows(void **state)
{
    (void)state;
    struct rows_of rows = {EXR_SAMPLE_HALF, 3};
    static const char *const colours[] = {"B", "G", "R"}, *const names[] = {"a", "b", "c"};
    static const float numbers[9] = {0, 0, 1, 1, 0, 1, 0, 1, 1};
    const struct exr_attribute attribute = {
        .name = "olat.directions", .kind = EXR_FLOATS, .floats = numbers, .count = 9};
    struct exr_part part[3];
    for (int i = 0; i < 3; i++)
        part[i] = (struct exr_part){.name = names[i],
                                    .width = WIDTH,
                                    .height = HEIGHT,
                                    .sample = rows.sample,
                                    .codec = EXR_CODEC_ZIP,
                                    .channels = 3,
                                    .channel = colours,
                                    .attributes = i == 0,
                                    .attribute = &attribute,
                                    .rows = make_rows,
                                    .context = &rows};
    for (int moved = 0; moved <= 3; moved++) {
        struct test_log log;
        struct relume_image image;
        relume_capture *c;
        test_log_init(&log);
        CHECK_OK(exr_write(path_of("olat.exr"), NULL, part, 3, false, 1, NULL));
        move_windows(path_of("olat.exr"), moved);
        const relume_status status =
            relume_capture_open(&c, path_of("olat.exr"), relume_capture_params(.log = &log.log));
        assert_int_equal(status, moved % 3 ? RELUME_EUNSUPPORTED : RELUME_OK);
        if (status) {
            assert_non_null(strstr(log.text, "data window"));
            continue;
        }
        CHECK_OK(relume_capture_image(&image, c, 0, 1, NULL));
        for (int i = 0; i < 3 * PIXELS; i++)
            assert_true(image.data[i] == value_at(i / 3 / WIDTH, 2 - i % 3, i / 3 % WIDTH));
        relume_image_destroy(&image);
        relume_capture_destroy(&c);
    }
}

static int make_lights(void **state)
{
    return make_folder(state) ||
           relume_directions_make(directions, LIGHTS, relume_pattern_find("hammersley"),
                                  relume_directions_params(.hemisphere = true));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_in_memory),
        cmocka_unit_test(files_of_bytes),
        cmocka_unit_test(files_of_words_and_floats),
        cmocka_unit_test(exr_files),
        cmocka_unit_test(coarse_exr_at_an_offset),
        cmocka_unit_test(damage_ends_what_goes_top_down),
        cmocka_unit_test(captures_in_memory),
        cmocka_unit_test(captures_of_files),
        cmocka_unit_test(captures_of_layers),
        cmocka_unit_test(layers_of_several_windows),
    };
    return cmocka_run_group_tests(tests, make_lights, remove_folder);
}
