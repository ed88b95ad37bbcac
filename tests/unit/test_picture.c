// Plain pictures as our own readers see them, against OpenImageIO; what is not plain is left to it.
#include "in_folder.h"
#include "png_crc.h"

#include "core/base/module.h"
#include "core/base/outfile.h"
#include "image/image/exr.h"
#include "core/base/half.h"
#include "image/image/picture.h"
#include "image/image/picture_format.h"

#include <fcntl.h>
#include <jpeglib.h>

enum { MOST = 70 };

static const struct oiio_bridge *bridge;

// Rows in portions that blocks do not know about.
static void read_all(picture_reader *r, void *out)
{
    const struct picture_info *i = picture_info_of(r);
    const size_t row = (size_t)i->width * (size_t)i->channels;
    for (int y = 0, n = 1; y < i->height; y += n, n = n % 7 + 2) {
        n = y + n > i->height ? i->height - y : n;
        if (i->bytes)
            CHECK_OK(picture_read_bytes(r, y, n, (uint8_t *)out + (size_t)y * row));
        else
            CHECK_OK(picture_read_floats(r, y, n, (float *)out + (size_t)y * row));
    }
}

// Both readers see the same file: size, kind, notes, and every channel that relume uses.
static void compare(const char *path)
{
    static float ours[MOST * MOST * 4], theirs[MOST * MOST * 4];
    picture_reader *a, *b;
    CHECK_OK(picture_open(&a, path, NULL, NULL, NULL));
    CHECK_OK(bridge->open(&b, open(path, O_RDONLY), "", path, NULL, NULL));
    assert_ptr_not_equal(a->format, b->format);
    const struct picture_info i = a->info, j = b->info;
    assert_int_equal(i.width, j.width);
    assert_int_equal(i.height, j.height);
    assert_true(i.x == j.x && i.y == j.y && i.channels == j.channels);
    assert_true(i.bytes == j.bytes && i.floats == j.floats && i.linear == j.linear);
    struct relume_exif n, m;
    size_t size;
    CHECK_OK(picture_notes(a, &n, NULL));
    CHECK_OK(picture_notes(b, &m, NULL));
    assert_memory_equal(&n, &m, sizeof n);
    assert_null(picture_profile(a, &size));
    assert_null(picture_profile(b, &size));
    read_all(a, ours);
    read_all(b, theirs);
    for (int p = 0; p < i.width * i.height; p++)
        for (int c = 0; c < 3; c++) {
            const int at = p * i.channels + i.rgb[c], other = p * j.channels + j.rgb[c];
            if (i.bytes)
                assert_int_equal(((uint8_t *)ours)[at], ((uint8_t *)theirs)[other]);
            else
                assert_true(ours[at] == theirs[other]);
        }
    assert_string_equal(picture_error(a), "");
    picture_close(&a);
    picture_close(&b);
}

// ---------------------------------------------------------------- EXR

struct made {
    int width, channels;
    bool half;
};

static relume_status rows(void *context, int row, int count, void *samples)
{
    const struct made *m = context;
    const int n = m->width * m->channels;
    for (int i = row * n; i < (row + count) * n; i++) {
        const float v = (float)(i * 37 % 1009) / 64.0f - 2.0f;
        if (m->half)
            ((uint16_t *)samples)[i - row * n] = half_from_float(v);
        else
            ((float *)samples)[i - row * n] = v * 1.0001f;
    }
    return RELUME_OK;
}

static void write_exr(const char *path, struct made m, int height, enum exr_codec codec,
                      const struct exr_attribute *attribute)
{
    static const char *const names[][4] = {{"Y"}, {"B", "G", "R"}, {"A", "B", "G", "R"}};
    const struct exr_part part = {.name = "image",
                                  .width = m.width,
                                  .height = height,
                                  .sample = m.half ? EXR_SAMPLE_HALF : EXR_SAMPLE_FLOAT,
                                  .codec = codec,
                                  .channels = m.channels,
                                  .channel = names[m.channels / 2],
                                  .attributes = attribute ? 1 : 0,
                                  .attribute = attribute,
                                  .rows = rows,
                                  .context = &m};
    CHECK_OK(exr_write(path, NULL, &part, 1, false, 1, NULL));
}

static void exr_is_what_openimageio_sees(void **state)
{
    (void)state;
    static const int heights[] = {1, 16, 33}, channels[] = {1, 3, 4};
    for (int codec = EXR_CODEC_NONE; codec <= EXR_CODEC_PIZ; codec++)
        for (int k = 0; k < 9; k++) {
            const struct made m = {5 + 31 * (k % 2), channels[k / 3], k % 2 == 0};
            write_exr(path_of("a.exr"), m, heights[k % 3], (enum exr_codec)codec, NULL);
            compare(path_of("a.exr"));
        }
}

// NULL: the file is another reader's.
static const struct picture_format *format_of(const char *path)
{
    picture_reader *r;
    if (strstr(path, ".exr"))
        CHECK_OK(exr_picture_open(&r, path, NULL, NULL, NULL));
    else
        CHECK_OK(png_picture_open(&r, path, NULL, NULL, NULL));
    const struct picture_format *format = r ? r->format : NULL;
    picture_close(&r);
    return format;
}

static void shorten(const char *path)
{
    size_t size;
    void *bytes = test_read(path, &size);
    test_write(path, bytes, size - 5);
    free(bytes);
}

static void exr_that_is_not_plain(void **state)
{
    (void)state;
    const struct made m = {12, 3, true};
    const struct exr_attribute note = {.name = "Orientation", .kind = EXR_INT, .integer = 6};
    write_exr(path_of("a.exr"), m, 20, EXR_CODEC_ZIP, NULL);
    assert_non_null(format_of(path_of("a.exr")));
    const struct relume_limits small = {.max_side = 11};
    picture_reader *r;
    CHECK_OK(exr_picture_open(&r, path_of("a.exr"), NULL, &small, NULL));
    assert_null(r);
    shorten(path_of("a.exr"));
    assert_null(format_of(path_of("a.exr")));
    write_exr(path_of("a.exr"), m, 20, EXR_CODEC_ZIP, &note);
    assert_null(format_of(path_of("a.exr")));
}

// ---------------------------------------------------------------- PFM

static void pfm_comes_back(void **state)
{
    (void)state;
    float samples[5 * 4 * 3], back[sizeof samples / sizeof *samples];
    picture_reader *r;
    for (int i = 0; i < 60; i++)
        samples[i] = (float)i * 1.1f - 7.0f;
    for (int channels = 1; channels <= 3; channels += 2) {
        CHECK_OK(picture_write_floats(path_of("a.pfm"), NULL, 5, 4, channels, samples, NULL));
        CHECK_OK(picture_open(&r, path_of("a.pfm"), NULL, NULL, NULL));
        assert_true(r->info.width == 5 && r->info.height == 4 && r->info.channels == channels);
        CHECK_OK(picture_read_floats(r, 0, 4, back));
        assert_memory_equal(back, samples, 20 * (size_t)channels * sizeof *samples);
        picture_close(&r);
    }
}

// ---------------------------------------------------------------- PNG

static void fill(uint8_t *samples, int n)
{
    uint32_t seed = 3;
    for (int i = 0; i < n; i++)
        samples[i] = (uint8_t)test_random(&seed);
}

static struct picture_codes codes_of(int width, int height, int channels, const uint8_t *samples)
{
    return (struct picture_codes){.array = {samples, 1, width, height, channels, .halves = false}};
}

static relume_status write_png(const char *path, int width, int height, int channels,
                               const uint8_t *samples, const struct relume_log *log)
{
    const struct picture_codes codes = codes_of(width, height, channels, samples);
    return png_write(path, NULL, &codes, log);
}

static relume_status write_by_bridge(const char *path, int width, int height, int channels,
                                     const uint8_t *samples)
{
    const struct picture_codes codes = codes_of(width, height, channels, samples);
    return bridge->write_codes(path, NULL, &codes, outfile_save_to, NULL);
}

static void png_is_what_openimageio_sees(void **state)
{
    (void)state;
    uint8_t samples[MOST * MOST * 4], back[sizeof samples];
    fill(samples, sizeof samples);
    static const int widths[] = {1, 2, 31, MOST};
    for (int k = 0; k < 16; k++) {
        const int width = widths[k % 4], height = widths[3 - k % 4], channels = k / 4 % 2 ? 3 : 1;
        if (k < 8)
            CHECK_OK(write_png(path_of("a.png"), width, height, channels, samples, NULL));
        else
            CHECK_OK(write_by_bridge(path_of("a.png"), width, height, channels, samples));
        compare(path_of("a.png"));
        picture_reader *r;
        CHECK_OK(picture_open(&r, path_of("a.png"), NULL, NULL, NULL));
        read_all(r, back);
        picture_close(&r);
        assert_memory_equal(back, samples, (size_t)(width * height * channels));
    }
    for (int channels = 2; channels <= 4; channels += 2) {  // alpha
        CHECK_OK(write_by_bridge(path_of("a.png"), 9, 8, channels, samples));
        compare(path_of("a.png"));
    }
}

static void put(uint8_t *to, uint32_t v)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(v >> (24 - 8 * i));
}

// The file with one more chunk behind its header.
static void with_chunk(const char *path, const char *type, const void *data, uint32_t n)
{
    enum { HEADER = 8 + 12 + 13 };
    size_t size;
    uint8_t *bytes = test_read(path, &size), chunk[64];
    put(chunk, n);
    memcpy(chunk + 4, type, 4);
    memcpy(chunk + 8, data, n);
    put(chunk + 8 + n, png_crc(chunk + 4, n + 4));
    bytes = realloc(bytes, size + n + 12);
    memmove(bytes + HEADER + n + 12, bytes + HEADER, size - HEADER);
    memcpy(bytes + HEADER, chunk, n + 12);
    test_write(path, bytes, size + n + 12);
    free(bytes);
}

static void png_that_is_not_plain(void **state)
{
    (void)state;
    static const struct {
        const char *type, *data;
        uint32_t size;
        bool plain;
    } chunks[] = {
        {"gAMA", "\0\0\xb1\x8f", 4, true},   // 1 / 2.2, as beside sRGB
        {"gAMA", "\0\1\x86\xa0", 4, false},  // linear
        {"tEXt", "Software\0x", 10, true},         {"tEXt", "DateTime\0x", 10, false},
        {"eXIf", "MM\0*\0\0\0\10\0\0", 10, false}, {"tRNS", "\0\0\0\0\0\0", 6, false},
        {"tIME", "\7\xe4\1\1\1\1\1", 7, false},    {"oFFs", "\0\0\0\1\0\0\0\0\0", 9, false},
    };
    uint8_t samples[6 * 5 * 3];
    fill(samples, sizeof samples);
    for (size_t i = 0; i < sizeof chunks / sizeof *chunks; i++) {
        CHECK_OK(write_png(path_of("a.png"), 6, 5, 3, samples, NULL));
        with_chunk(path_of("a.png"), chunks[i].type, chunks[i].data, chunks[i].size);
        assert_int_equal(format_of(path_of("a.png")) != NULL, chunks[i].plain);
        if (chunks[i].plain)
            compare(path_of("a.png"));
    }
    CHECK_OK(write_png(path_of("a.png"), 6, 5, 3, samples, NULL));
    shorten(path_of("a.png"));
    assert_null(format_of(path_of("a.png")));
}

// ---------------------------------------------------------------- JPEG

struct kind {
    int channels;
    bool subsampled, progressive, restarts;
};

static void write_jpeg(const char *path, int width, int height, struct kind kind,
                       const uint8_t *samples)
{
    struct jpeg_compress_struct c;
    struct jpeg_error_mgr errors;
    FILE *f = fopen(path, "wb");
    c.err = jpeg_std_error(&errors);
    jpeg_create_compress(&c);
    jpeg_stdio_dest(&c, f);
    c.image_width = (JDIMENSION)width;
    c.image_height = (JDIMENSION)height;
    c.input_components = kind.channels;
    c.in_color_space = kind.channels == 1 ? JCS_GRAYSCALE : kind.channels == 3 ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&c);
    c.comp_info[0].h_samp_factor = c.comp_info[0].v_samp_factor = kind.subsampled ? 2 : 1;
    if (kind.progressive)
        jpeg_simple_progression(&c);
    c.restart_in_rows = kind.restarts;
    jpeg_start_compress(&c, TRUE);
    while (c.next_scanline < c.image_height) {
        JSAMPROW row = (JSAMPROW)samples + c.next_scanline * (size_t)(width * kind.channels);
        jpeg_write_scanlines(&c, &row, 1);
    }
    jpeg_finish_compress(&c);
    jpeg_destroy_compress(&c);
    fclose(f);
}

static void jpeg_is_what_openimageio_sees(void **state)
{
    (void)state;
    static const struct kind kinds[] = {{1, false, false, false}, {3, false, false, false},
                                        {3, true, false, true},   {3, true, true, false},
                                        {4, false, false, false}, {1, false, true, false}};
    static const int sides[] = {1, 16, 33, MOST};
    uint8_t samples[MOST * MOST * 4];
    fill(samples, sizeof samples);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int s = 0; s < 4; s++) {
            write_jpeg(path_of("a.jpg"), sides[s], sides[3 - s], kinds[k], samples);
            compare(path_of("a.jpg"));
        }
}

// The file without the `cut` bytes before its end marker (also of the marker, where it is cut),
// `padding` in their place.
static void respan(const char *path, size_t cut, bool marker, size_t padding)
{
    size_t size;
    uint8_t *bytes = test_read(path, &size), *out = calloc(size + padding, 1);
    const size_t kept = size - 2 - cut;
    memcpy(out, bytes, kept);
    memcpy(out + kept + padding, "\xff\xd9", 2);
    test_write(path, out, kept + padding + (marker ? 2 : 0));
    free(bytes);
    free(out);
}

static relume_status read_jpeg(const char *path)
{
    uint8_t row[MOST * 3];
    picture_reader *r;
    relume_status status = RELUME_OK;
    CHECK_OK(picture_open(&r, path, NULL, NULL, NULL));
    for (int y = 0; y < MOST && !status; y++)
        status = picture_read_bytes(r, y, 1, row);
    assert_int_equal(status != RELUME_OK, strstr(picture_error(r), "truncated or damaged") != NULL);
    picture_close(&r);
    return status;
}

// libjpeg makes pictures of all of them.
static void jpeg_that_is_not_whole(void **state)
{
    (void)state;
    static const struct {
        size_t cut;
        bool marker;
        size_t padding;
        relume_status status;
    } ends[] = {
        {0, true, 0, RELUME_OK},        {0, false, 0, RELUME_EDAMAGED},
        {9, false, 0, RELUME_EDAMAGED}, {100, true, 0, RELUME_EDAMAGED},
        {0, true, 50, RELUME_OK},  // padded, as some cameras do
    };
    static const struct kind kinds[] = {{3, false, false, false}, {3, true, true, false}};
    uint8_t samples[MOST * MOST * 3];
    fill(samples, sizeof samples);
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
            write_jpeg(path_of("a.jpg"), MOST, MOST, kinds[k], samples);
            respan(path_of("a.jpg"), ends[i].cut, ends[i].marker, ends[i].padding);
            assert_int_equal(read_jpeg(path_of("a.jpg")), ends[i].status);
        }
}

// Damage that only reading finds has a sentence.
static void damaged_rows(void **state)
{
    (void)state;
    uint8_t samples[MOST * MOST * 3];
    float out[3 * MOST];
    size_t size;
    picture_reader *r;
    fill(samples, sizeof samples);
    CHECK_OK(write_png(path_of("a.png"), MOST, MOST, 3, samples, NULL));
    write_exr(path_of("a.exr"), (struct made){MOST, 3, false}, MOST, EXR_CODEC_ZIP, NULL);
    write_jpeg(path_of("a.jpg"), MOST, MOST, (struct kind){.channels = 3}, samples);
    static const char *const names[] = {"a.png", "a.exr", "a.jpg"};
    for (int k = 0; k < 3; k++) {
        uint8_t *bytes = test_read(path_of(names[k]), &size);
        memset(bytes + size / 2, 0xff, 40);
        test_write(path_of(names[k]), bytes, size);
        free(bytes);
        CHECK_OK(picture_open(&r, path_of(names[k]), NULL, NULL, NULL));
        relume_status status = RELUME_OK;
        for (int y = 0; y < MOST && !status; y++)
            status = k == 1 ? picture_read_floats(r, y, 1, out)
                            : picture_read_bytes(r, y, 1, (uint8_t *)out);
        assert_int_equal(status, RELUME_EDAMAGED);
        assert_non_null(strstr(picture_error(r), "truncated or damaged"));
        picture_close(&r);
    }
    struct test_log log;
    test_log_init(&log);
    assert_int_equal(write_png("/dev/full", 6, 5, 3, samples, &log.log), RELUME_EIO);
    assert_non_null(strstr(log.text, "/dev/full"));
}

int main(void)
{
    char why[MODULE_WHY];
    int lacks;
    bridge = module_open("oiio", why, &lacks);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exr_is_what_openimageio_sees),
        cmocka_unit_test(exr_that_is_not_plain),
        cmocka_unit_test(pfm_comes_back),
        cmocka_unit_test(png_is_what_openimageio_sees),
        cmocka_unit_test(png_that_is_not_plain),
        cmocka_unit_test(jpeg_is_what_openimageio_sees),
        cmocka_unit_test(jpeg_that_is_not_whole),
        cmocka_unit_test(damaged_rows),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
