// What a file is by its first bytes: the formats for photographs, and what is none.
#include "test.h"

#include "image/image/picture_kind.h"

#include <string.h>

static const struct picture_kind *kind(const void *head, size_t size, const char *path)
{
    struct picture_look look = {.bytes = 1000};
    memcpy(look.head, head, size);
    return picture_kind_of(&look, path);
}
#define KIND(text, path) kind(text, sizeof(text) - 1, path)

static void photographs_are_known(void **state)
{
    (void)state;
    assert_string_equal(KIND("II*\0\10\0\0\0", "a.jpg")->reader, "tiff");
    assert_string_equal(KIND("MM\0*\0\0\0\10", "a")->reader, "tiff");
    assert_string_equal(KIND("II*\0\10\0\0\0", "a.NEF")->reader, "raw");
    assert_string_equal(KIND("II*\0\20\0\0\0CR\2\0", "a.tif")->reader, "raw");
    assert_string_equal(KIND("\0\0\0\30ftypcrx ", "a")->reader, "raw");
    assert_string_equal(KIND("#?RADIANCE\n", "a")->reader, "hdr");
    assert_string_equal(KIND("RIFF\0\0\0\0WEBPVP8 ", "a")->reader, "webp");
    assert_string_equal(KIND("P6 3 3 255 ", "a")->reader, "pnm");
    assert_string_equal(KIND("PF\n3 3\n-1\n", "a")->reader, "pnm");
    assert_string_equal(KIND("\0\0\0\34ftypavif", "a")->reader, "heif");
    assert_true(KIND("\xff\xd8\xff\xe0", "a")->inside);
    assert_true(KIND("\x76\x2f\x31\x01", "a")->listed);
    assert_string_equal(KIND("text", "a.dng")->reader, "raw");
}

// Formats without a magic number need more than two letters.
static void weak_marks_are_looked_at(void **state)
{
    (void)state;
    static const char tga[] = "\0\0\2\0\0\0\0\0\0\0\0\0\4\0\4\0\30\0";
    static const char bmp[] = "BM\0\0\0\0\0\0\0\0\0\0\0\0\50\0\0\0";
    assert_string_equal(KIND(bmp, "a")->reader, "bmp");
    assert_null(KIND("BM is a text", "a.bmp")->what);
    assert_string_equal(KIND(tga, "a.tga")->reader, "targa");
    assert_null(KIND(tga, "a.jpg")->what);
    struct picture_look look = {.bytes = 100};
    memcpy(look.head, tga, sizeof tga);
    memcpy(look.foot, "TRUEVISION-XFILE.", 18);
    assert_string_equal(picture_kind_of(&look, "a.jpg")->reader, "targa");
    look.head[16] = 7;  // bits of a pixel
    assert_null(picture_kind_of(&look, "a.tga")->what);
    assert_null(KIND("P6x3", "a.ppm")->what);
}

static void the_rest_is_named(void **state)
{
    (void)state;
    assert_string_equal(KIND("\0\0\0\30ftypisom", "a.jpg")->what, "a video");
    assert_string_equal(KIND("RIFF\0\0\0\0AVI LIST", "a.jpg")->what, "a video");
    assert_string_equal(KIND("RIFF\0\0\0\0WAVEfmt ", "a.jpg")->what, "a sound");
    assert_string_equal(KIND("%PDF-1.4", "a.jpg")->what, "a PDF document");
    const struct picture_kind *gif = KIND("GIF89a", "a.jpg");
    assert_false(gif->listed);
    assert_non_null(gif->reader);
    assert_null(KIND("", "a")->what);
}

// Whatever claims to be a picture of one colour may be one; nothing counts more.
static void claims_are_bounded(void **state)
{
    (void)state;
    const struct picture_kind *jpeg = KIND("\xff\xd8\xff", "a");
    assert_true(picture_kind_is_likely(jpeg, 1, 64 << 20));
    assert_false(picture_kind_is_likely(jpeg, 1, (64 << 20) + 1));
    assert_true(picture_kind_is_likely(jpeg, 1 << 20, (uint64_t)jpeg->ratio << 20));
    assert_false(picture_kind_is_likely(jpeg, 1 << 20, ((uint64_t)jpeg->ratio << 20) + 1));
    assert_true(picture_kind_is_likely(jpeg, UINT64_MAX, UINT64_MAX));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photographs_are_known),
        cmocka_unit_test(weak_marks_are_looked_at),
        cmocka_unit_test(the_rest_is_named),
        cmocka_unit_test(claims_are_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
