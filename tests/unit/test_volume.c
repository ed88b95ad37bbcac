// Volumes from files of every format, made here byte by byte; what no volume is.
#include "shape/volume/volume.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

#include <cmocka.h>

static int sentences;

static void count_sentence(void *user, enum relume_level level, const char *text)
{
    (void)user;
    assert_true(strlen(text) > 0 && !strchr(text, '\n'));
    sentences += level != RELUME_NOTE;
}

static const struct relume_log counting = {.message = count_sentence};

static const char *name(const char *ending)
{
    static char path[64];
    snprintf(path, sizeof path, "/tmp/relume-volume-%ld%s", (long)getpid(), ending);
    return path;
}

static void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

static void write_packed(const char *path, const void *bytes, size_t size)
{
    gzFile file = gzopen(path, "wb");
    assert_int_equal(gzwrite(file, bytes, (unsigned)size), (int)size);
    gzclose(file);
}

// What is refused says one sentence.
static relume_status open_it(relume_volume **out, const char *path,
                             struct relume_volume_params params)
{
    sentences = 0;
    params.log = &counting;
    const relume_status status = relume_volume_open(out, path, &params);
    assert_int_equal(sentences, status ? 1 : 0);
    return status;
}

static void expect_samples(relume_volume *v, const int size[3], double first, double second,
                           double last)
{
    const size_t count = (size_t)size[0] * (size_t)size[1] * (size_t)size[2];
    for (int c = 0; c < 3; c++)
        assert_int_equal(relume_volume_info(v).size[c], size[c]);
    assert_true((double)volume_sample(v, 0) == first);
    assert_true((double)volume_sample(v, 1) == second);
    assert_true((double)volume_sample(v, count - 1) == last);
}

// ---------------------------------------------------------------- raw samples

static void test_raw_of_every_type(void **state)
{
    (void)state;
    // 300.0 of each type that can be, else -3; both ends; 8 samples of 2 x 2 x 2, the others 1
    static const struct {
        const char *type;
        int bytes;
        uint8_t sample[8], one[8];
        double value;
    } cases[] = {
        {"u8", 1, {253}, {1}, 253},
        {"i8", 1, {253}, {1}, -3},
        {"u16le", 2, {0x2c, 1}, {1, 0}, 300},
        {"u16be", 2, {1, 0x2c}, {0, 1}, 300},
        {"i16", 2, {0xfd, 0xff}, {1, 0}, -3},
        {"i16be", 2, {0xff, 0xfd}, {0, 1}, -3},
        {"u32", 4, {0x2c, 1, 0, 0}, {1, 0, 0, 0}, 300},
        {"i32be", 4, {0xff, 0xff, 0xff, 0xfd}, {0, 0, 0, 1}, -3},
        {"f32", 4, {0, 0, 0x96, 0x43}, {0, 0, 0x80, 0x3f}, 300},
        {"f32be", 4, {0x43, 0x96, 0, 0}, {0x3f, 0x80, 0, 0}, 300},
        {"f64", 8, {0, 0, 0, 0, 0, 0xc0, 0x72, 0x40}, {0, 0, 0, 0, 0, 0, 0xf0, 0x3f}, 300},
        {"f64be", 8, {0x40, 0x72, 0xc0, 0, 0, 0, 0, 0}, {0x3f, 0xf0, 0, 0, 0, 0, 0, 0}, 300},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint8_t file[64];
        const size_t bytes = (size_t)cases[i].bytes;
        relume_volume *v;
        for (size_t k = 0; k < 8; k++)
            memcpy(file + k * bytes, k == 1 ? cases[i].sample : cases[i].one, bytes);
        for (int packed = 0; packed < 2; packed++) {
            const char *path = name(packed ? ".raw.gz" : ".raw");
            (packed ? write_packed : write_file)(path, file, 8 * bytes);
            assert_int_equal(
                open_it(&v, path, *relume_volume_params(.size = {2, 2, 2}, .type = cases[i].type)),
                RELUME_OK);
            expect_samples(v, (const int[3]){2, 2, 2}, 1.0, cases[i].value, 1.0);
            relume_volume_destroy(&v);
            unlink(path);
        }
    }
}

static void test_raw_that_does_not_fit(void **state)
{
    (void)state;
    uint8_t file[30] = {1, 2, 3};
    float broken[8] = {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, NAN, 7.0f, 8.0f};
    relume_volume *v;
    write_file(name(".raw"), file, sizeof file);
    // 3 x 5 x 2 is right, also with what is passed over
    assert_int_equal(open_it(&v, name(".raw"), *relume_volume_params(.size = {3, 5, 2})),
                     RELUME_OK);
    relume_volume_destroy(&v);
    assert_int_equal(open_it(&v, name(".raw"), *relume_volume_params(.size = {2, 2, 7}, .skip = 2)),
                     RELUME_OK);
    relume_volume_destroy(&v);
    static const struct {
        int size[3];
        const char *type;
        relume_status status;
    } wrong[] = {
        {{3, 5, 3}, "u8", RELUME_EUNFIT},     {{3, 3, 3}, "u8", RELUME_EUNFIT},
        {{3, 5, 2}, "u16", RELUME_EUNFIT},    {{30, 1, 1}, "u8", RELUME_EUNFIT},
        {{0, 0, 0}, "u8", RELUME_EINVAL},     {{3, 5, 2}, "u7", RELUME_EINVAL},
        {{70000, 2, 2}, "u8", RELUME_ELIMIT}, {{-3, 5, 2}, "u8", RELUME_EUNFIT},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const struct relume_volume_params p = {
            .size = {wrong[i].size[0], wrong[i].size[1], wrong[i].size[2]}, .type = wrong[i].type};
        assert_int_equal(open_it(&v, name(".raw"), p), wrong[i].status);
        assert_null(v);
    }
    write_file(name(".raw"), broken, sizeof broken);
    assert_int_equal(
        open_it(&v, name(".raw"), *relume_volume_params(.size = {2, 2, 2}, .type = "f32")),
        RELUME_EDAMAGED);
    memset(file, 7, sizeof file);
    write_file(name(".raw"), file, sizeof file);
    assert_int_equal(open_it(&v, name(".raw"), *relume_volume_params(.size = {3, 5, 2})),
                     RELUME_EUNFIT);  // all alike
    unlink(name(".raw"));
    assert_int_equal(open_it(&v, name(".raw"), *relume_volume_params(.size = {3, 5, 2})),
                     RELUME_ENOTFOUND);
}

static void test_raw_whose_name_says_it(void **state)
{
    (void)state;
    static const struct {
        const char *ending, *type;
        size_t bytes;
        double second;  // 0: refused
    } cases[] = {
        {"-3x5x2.raw", NULL, 30, 2},          {"_v2_3x5x2.raw", NULL, 60, 0x403},
        {"_3x5x2_uint8.raw", NULL, 30, 2},    {"_3x5x2_int16.raw", NULL, 60, 0x403},
        {"_3x5x2.raw", "u16be", 60, 0x304},   {"1x2_3x5x2.raw", NULL, 30, 2},
        {"_3x5x2.raw", NULL, 31, 0},          {"_3x5x2_uint8.raw", NULL, 60, 0},
        {"_3x5x2.raw", "f32", 60, 0},         {"_3x5.raw", NULL, 30, 0},
        {"_30x1x1.raw", NULL, 30, 0},         {"_99999x99999x99999.raw", NULL, 30, 0},
        {"_3x5x2_uint8.raw.gz", NULL, 30, 2}, {"_3x5x2.raw.gz", NULL, 30, 0},
    };
    uint8_t samples[61];
    relume_volume *v;
    for (size_t i = 0; i < sizeof samples; i++)
        samples[i] = (uint8_t)(i + 1);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *path = name(cases[i].ending);
        (strstr(path, ".gz") ? write_packed : write_file)(path, samples, cases[i].bytes);
        assert_int_equal(open_it(&v, path, *relume_volume_params(.type = cases[i].type)),
                         cases[i].second > 0.0 ? RELUME_OK : RELUME_EINVAL);
        if (cases[i].second > 0.0)
            expect_samples(v, (const int[3]){3, 5, 2}, (double)volume_sample(v, 0), cases[i].second,
                           (double)volume_sample(v, 29));
        relume_volume_destroy(&v);
        unlink(path);
    }
}

static void test_packed_that_is_damaged(void **state)
{
    (void)state;
    static uint8_t samples[27000], bytes[40000];
    relume_volume *v;
    for (size_t i = 0; i < sizeof samples; i++)
        samples[i] = (uint8_t)(i * i >> 3);
    write_packed(name(".gz"), samples, sizeof samples);
    FILE *file = fopen(name(".gz"), "rb");
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    const struct relume_volume_params p = *relume_volume_params(.size = {30, 30, 30});
    write_file(name(".gz"), bytes, size / 2);
    assert_int_equal(open_it(&v, name(".gz"), p), RELUME_EDAMAGED);
    bytes[size - 6] ^= 1;  // of the check sum
    write_file(name(".gz"), bytes, size);
    assert_int_equal(open_it(&v, name(".gz"), p), RELUME_EDAMAGED);
    write_packed(name(".gz"), samples, sizeof samples - 1);
    assert_int_equal(open_it(&v, name(".gz"), p), RELUME_EUNFIT);
    write_packed(name(".gz"), samples, sizeof samples);
    assert_int_equal(open_it(&v, name(".gz"), *relume_volume_params(.size = {30, 30, 29})),
                     RELUME_EUNFIT);
    unlink(name(".gz"));
}

// Members one after the other, as bgzip makes them, of which the first is as long as what is read
// at once; the last is followed by what is none.
static void test_packed_in_members(void **state)
{
    (void)state;
    static uint8_t samples[343], file[1 << 17];
    const size_t chunk = 65536;
    relume_volume *v;
    size_t size = 0, part[] = {100, 0, 200, 43}, from = 0;
    for (size_t i = 0; i < sizeof samples; i++)
        samples[i] = (uint8_t)(i * 7);
    for (size_t i = 0; i < 4; from += part[i++]) {
        write_packed(name(".gz"), samples + from, part[i]);
        FILE *in = fopen(name(".gz"), "rb");
        size += fread(file + size, 1, sizeof file - size, in);
        fclose(in);
        if (i)
            continue;
        // a comment in the header, so that the second member begins with the last byte of a chunk
        memmove(file + chunk - 1 - (size - 10), file + 10, size - 10);
        file[3] = 16;
        memset(file + 10, '-', chunk - 1 - size);
        file[chunk - 1 - (size - 10) - 1] = '\0';
        size = chunk - 1;
    }
    const struct relume_volume_params p = *relume_volume_params(.size = {7, 7, 7});
    for (int tail = 0; tail < 2; tail++) {
        memcpy(file + size, "\0\0\0", 4);
        write_file(name(".gz"), file, size + (tail ? 4 : 0));
        assert_int_equal(open_it(&v, name(".gz"), p), RELUME_OK);
        assert_memory_equal(v->data, samples, sizeof samples);
        relume_volume_destroy(&v);
    }
    write_file(name(".gz"), file, size - 4);
    assert_int_equal(open_it(&v, name(".gz"), p), RELUME_EDAMAGED);
    unlink(name(".gz"));
}

// ---------------------------------------------------------------- NRRD

static relume_status open_nrrd(relume_volume **out, const char *header, const void *samples,
                               size_t size)
{
    char file[2048];
    const size_t length = strlen(header);
    memcpy(file, header, length);
    memcpy(file + length, samples, size);
    write_file(name(".nrrd"), file, length + size);
    const relume_status status =
        open_it(out, name(".nrrd"), *relume_volume_params(.own_spacing = true));
    unlink(name(".nrrd"));
    return status;
}

static void test_nrrd(void **state)
{
    (void)state;
    static const uint8_t samples[24] = {0, 5, 1, 0x2c, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0, 0, 3};
    relume_volume *v;
    assert_int_equal(open_nrrd(&v,
                               "NRRD0004\n# by hand\ntype: unsigned short\r\ndimension: 3\n"
                               "sizes: 3 2 2\nendian: big\nencoding: raw\nkey:=value\n"
                               "space directions: (0.5,0,0) (0,0,2) (0,3,4)\n\n",
                               samples, 24),
                     RELUME_OK);
    expect_samples(v, (const int[3]){3, 2, 2}, 5.0, 300.0, 0.0);
    const struct relume_volume_info info = relume_volume_info(v);
    assert_true(info.spacing[0] == 0.5 && info.spacing[1] == 2.0 && info.spacing[2] == 5.0);
    assert_string_equal(info.format, "nrrd");
    relume_volume_destroy(&v);
    // samples in another file, packed, behind two bytes of something else
    write_packed(name(".data"), samples, 24);
    char header[512];
    snprintf(header, sizeof header,
             "NRRD0001\ntype: uchar\ndimension: 3\nsizes: 11 2 1\nencoding: gzip\nbyte skip: 2\n"
             "data file: %s\n\n",
             strrchr(name(".data"), '/') + 1);
    assert_int_equal(open_nrrd(&v, header, samples, 0), RELUME_EUNFIT);  // one layer
    *strstr(header, "11 2 1") = ' ';
    memcpy(strstr(header, " 1 2 1"), " 2 5 2", 6);
    assert_int_equal(open_nrrd(&v, header, samples, 0), RELUME_OK);
    expect_samples(v, (const int[3]){2, 5, 2}, 1.0, 44.0, 0.0);
    relume_volume_destroy(&v);
    unlink(name(".data"));
    static const char *const broken[] = {
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nencoding: raw\n",
        "NRRD0004\ntype: block\ndimension: 3\nsizes: 3 2 2\nencoding: raw\n\n",
        "NRRD0004\ntype: uchar\ndimension: 2\nsizes: 3 2\nencoding: raw\n\n",
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2\nencoding: raw\n\n",
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 -2 2\nencoding: raw\n\n",
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nencoding: bzip2\n\n",
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 3\nencoding: raw\n\n",
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nencoding: raw\ndata file: LIST\n\n",
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nencoding: raw\ndata file: none\n\n",
    };
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++)
        assert_true(relume_status_is_input(open_nrrd(&v, broken[i], samples, i ? 12 : 0)));
}

// ---------------------------------------------------------------- NIfTI

static void put_short(uint8_t *at, int value, bool big)
{
    at[big ? 1 : 0] = (uint8_t)value;
    at[big ? 0 : 1] = (uint8_t)(value >> 8);
}

static void put_float(uint8_t *at, float value, bool big)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++)
        at[big ? 3 - i : i] = (uint8_t)(bits >> 8 * i);
}

static void make_nifti(uint8_t file[400], bool big, int type, float slope, const char *magic)
{
    memset(file, 0, 400);
    put_short(file + (big ? 2 : 0), 348, big);
    put_short(file + 40, 3, big);
    put_short(file + 42, 2, big);
    put_short(file + 44, 3, big);
    put_short(file + 46, 4, big);
    put_short(file + 70, type, big);
    put_float(file + 80, 0.5f, big);
    put_float(file + 84, -2.0f, big);
    put_float(file + 88, 3.0f, big);
    put_float(file + 108, 352.0f, big);
    put_float(file + 112, slope, big);
    put_float(file + 116, 10.0f, big);
    memcpy(file + 344, magic, 4);
    for (int i = 0; i < 24; i++)
        put_short(file + 352 + 2 * i, 100 * i, big);
}

static void test_nifti(void **state)
{
    (void)state;
    uint8_t file[400];
    relume_volume *v;
    for (int big = 0; big < 2; big++)
        for (int scaled = 0; scaled < 2; scaled++) {
            make_nifti(file, big, 4, scaled ? 0.5f : 0.0f, "n+1");
            (scaled ? write_packed : write_file)(name(".nii"), file, sizeof file);
            assert_int_equal(open_it(&v, name(".nii"), *relume_volume_params(.own_spacing = true)),
                             RELUME_OK);
            expect_samples(v, (const int[3]){2, 3, 4}, scaled ? 10 : 0, scaled ? 60 : 100,
                           scaled ? 1160 : 2300);
            const struct relume_volume_info info = relume_volume_info(v);
            assert_true(info.spacing[0] == 0.5 && info.spacing[1] == 2.0 && info.spacing[2] == 3.0);
            relume_volume_destroy(&v);
        }
    make_nifti(file, false, 4, 0.0f, "n+1");
    write_file(name(".nii"), file, 399);
    assert_int_equal(open_it(&v, name(".nii"), *relume_volume_params(.own_spacing = true)),
                     RELUME_EUNFIT);
    make_nifti(file, false, 128, 0.0f, "n+1");
    write_file(name(".nii"), file, 400);
    assert_int_equal(open_it(&v, name(".nii"), *relume_volume_params(.own_spacing = true)),
                     RELUME_EUNSUPPORTED);
    unlink(name(".nii"));
    // a header and its samples beside it
    make_nifti(file, false, 4, 0.0f, "ni1");
    put_float(file + 108, 16.0f, false);
    write_file(name(".hdr"), file, 352);
    assert_true(relume_status_is_input(
        open_it(&v, name(".hdr"), *relume_volume_params(.own_spacing = true))));
    write_file(name(".img"), file + 336, 64);
    assert_int_equal(open_it(&v, name(".hdr"), *relume_volume_params(.own_spacing = true)),
                     RELUME_OK);
    expect_samples(v, (const int[3]){2, 3, 4}, 0, 100, 2300);
    relume_volume_destroy(&v);
    write_file(name(".img"), file + 336, 63);
    assert_int_equal(open_it(&v, name(".hdr"), *relume_volume_params(.own_spacing = true)),
                     RELUME_EUNFIT);
    unlink(name(".img"));
    write_packed(name(".img.gz"), file + 336, 64);
    assert_int_equal(open_it(&v, name(".hdr"), *relume_volume_params(.own_spacing = true)),
                     RELUME_OK);
    relume_volume_destroy(&v);
    unlink(name(".img.gz"));
    unlink(name(".hdr"));
}

// ---------------------------------------------------------------- TIFF

// Pages of 4 x 3 samples of 8 or 16 bits, not packed (TIFF 6.0): samples, then the directory.
static size_t make_tiff(uint8_t *file, int pages, int bytes)
{
    const int entries[9][3] = {{256, 4, 4}, {257, 4, 3}, {258, 3, 8 * bytes},
                               {259, 3, 1}, {262, 3, 1}, {273, 4, 0},
                               {277, 3, 1}, {278, 4, 3}, {279, 4, 12 * bytes}};
    uint32_t at = 8, words[2] = {0x002a4949, 0};
    memcpy(file, words, 8);
    uint8_t *next = file + 4;
    for (int p = 0; p < pages; p++) {
        const uint32_t samples = at;
        for (int i = 0; i < 12; i++, at += (uint32_t)bytes) {
            file[at] = (uint8_t)(10 * p + i);
            if (bytes == 2)
                file[at + 1] = 1;
        }
        memcpy(next, &at, 4);
        memcpy(file + at, (const uint16_t[]){9}, 2);
        at += 2;
        for (int e = 0; e < 9; e++, at += 12) {
            const uint16_t head[2] = {(uint16_t)entries[e][0], (uint16_t)entries[e][1]};
            const uint32_t rest[2] = {1, entries[e][0] == 273 ? samples : (uint32_t)entries[e][2]};
            memcpy(file + at, head, 4);
            memcpy(file + at + 4, rest, 8);
        }
        next = file + at;
        memset(next, 0, 4);
        at += 4;
    }
    return at;
}

static void test_pages_of_a_tiff(void **state)
{
    (void)state;
    uint8_t file[2048];
    relume_volume *v;
    for (int bytes = 1; bytes <= 2; bytes++) {
        write_file(name(".tif"), file, make_tiff(file, 5, bytes));
        assert_int_equal(open_it(&v, name(".tif"), *relume_volume_params(.type = NULL)), RELUME_OK);
        const double more = bytes == 2 ? 256.0 : 0.0;
        expect_samples(v, (const int[3]){4, 3, 5}, more, more + 1.0, more + 51.0);
        assert_string_equal(relume_volume_info(v).format, "slices");
        relume_volume_destroy(&v);
    }
    write_file(name(".tif"), file, make_tiff(file, 1, 1));
    assert_int_equal(open_it(&v, name(".tif"), *relume_volume_params(.type = NULL)), RELUME_EUNFIT);
    const size_t size = make_tiff(file, 3, 1);
    write_file(name(".tif"), file, size - 60);  // in the last directory
    assert_true(
        relume_status_is_input(open_it(&v, name(".tif"), *relume_volume_params(.type = NULL))));
    unlink(name(".tif"));
}

// What a file only claims gets no memory: where there is none the sentence is still about the file.
static void test_claims_without_samples(void **state)
{
    (void)state;
    static const char *const claims[] = {
        "NRRD0004\ntype: double\ndimension: 3\nsizes: 65536 65536 65536\nencoding: raw\n\n",
        "NRRD0004\ntype: double\ndimension: 3\nsizes: 65536 65536 2\nencoding: gzip\n\n",
        // beyond the end, and once around to the samples
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
        "byte skip: 18446744073709551607\n\n"};
    relume_volume *v;
    for (size_t i = 0; i < sizeof claims / sizeof *claims; i++) {
        char file[512];
        const size_t length = strlen(claims[i]);
        memcpy(file, claims[i], length);
        memcpy(file + length, "12345678", 8);
        write_file(name(".nrrd"), file, length + 8);
        assert_int_equal(
            open_it(&v, name(".nrrd"), *relume_volume_params(.scratch = "/nonexistent")),
            RELUME_EUNFIT);
    }
    unlink(name(".nrrd"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_raw_of_every_type),
        cmocka_unit_test(test_raw_that_does_not_fit),
        cmocka_unit_test(test_raw_whose_name_says_it),
        cmocka_unit_test(test_packed_that_is_damaged),
        cmocka_unit_test(test_packed_in_members),
        cmocka_unit_test(test_nrrd),
        cmocka_unit_test(test_nifti),
        cmocka_unit_test(test_pages_of_a_tiff),
        cmocka_unit_test(test_claims_without_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
