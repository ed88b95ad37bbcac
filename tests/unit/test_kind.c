// test_kind.c - what a file or folder is: one of every kind, by its contents and by its name
#include "test.h"

#include "capture_fixture.h"
#include "core/base/memory.h"
#include "pack_in_folder.h"

#include <relume/exchange.h>
#include <sys/stat.h>

#define EXR_HEAD      "\x76\x2f\x31\x01\x02\0\0\0"
#define KIND_OF(name) relume_kind_of(path_of(name))

static void write_bytes(const char *name, const char *bytes, size_t size)
{
    test_write(path_of(name), bytes, size);
}

// A folder with one file that has nothing in it.
static void make_with(const char *name, const char *entry)
{
    char file[48];
    snprintf(file, sizeof file, "%s/%s", name, entry);
    assert_int_equal(mkdir(path_of(name), 0700), 0);
    write_text(file, "{}");
}

static void folders_are_told_by_what_they_hold(void **state)
{
    (void)state;
    static const struct {
        const char *name, *entry;
        enum relume_kind kind;
    } rows[] = {
        {"web", "info.json", RELUME_KIND_FOREIGN},
        {"captured", "capture.json", RELUME_KIND_CAPTURE},
        {"listed", "lights.LP", RELUME_KIND_CAPTURE},
        {"btf", "btf.json", RELUME_KIND_MATERIAL},
        {"model", "model.json", RELUME_KIND_FITTED},
        {"surface", "surface.json", RELUME_KIND_SURFACE},
        {"maps", "maps.json", RELUME_KIND_MAPS},
        {"other", "scene.json", RELUME_KIND_UNKNOWN},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        make_with(rows[i].name, rows[i].entry);
        assert_int_equal(KIND_OF(rows[i].name), rows[i].kind);
    }
    assert_int_equal(mkdir(path_of("above"), 0700), 0);
    make_with("above/below", "lights.lp");
    assert_int_equal(KIND_OF("above"), RELUME_KIND_CAPTURE);
    // two lists are ambiguous
    write_text("listed/more.lp", "0\n");
    assert_int_equal(KIND_OF("listed"), RELUME_KIND_UNKNOWN);
    // a surface has the model that it is laid out from
    write_text("surface/model.json", "{}");
    assert_int_equal(KIND_OF("surface"), RELUME_KIND_SURFACE);
    assert_int_equal(KIND_OF("missing"), RELUME_KIND_UNKNOWN);
}

// What relume writes itself.
static void written_files_are_told(void **state)
{
    (void)state;
    const struct fixture f = {.width = 20, .height = 16, .lights = 5, .views = 1};
    float pixel[12] = {0.5f};
    const struct relume_image image = {.data = pixel, .width = 2, .height = 2, .channels = 3};
    fixture_write(&f, folder);
    CHECK_OK(fixture_encode(folder, path, &relume_basis_table, 0, NULL));
    assert_int_equal(relume_kind_of(path), RELUME_KIND_RELUME);
    assert_int_equal(relume_kind_of(folder), RELUME_KIND_CAPTURE);
    assert_int_equal(KIND_OF("capture.json"), RELUME_KIND_CAPTURE);
    CHECK_OK(relume_image_save(&image, path_of("picture.exr"), NULL));
    assert_int_equal(KIND_OF("picture.exr"), RELUME_KIND_PICTURE);
    // without an ending of a relume file
    assert_int_equal(rename(path, path_of("pack")), 0);
    assert_int_equal(KIND_OF("pack"), RELUME_KIND_RELUME);
}

static void exr_files_are_told_by_attributes(void **state)
{
    (void)state;
    static const char baked[] = EXR_HEAD "bakedVersion\0int",
                      gbrdf[] = EXR_HEAD "gbrdfVersion\0int", lit[] = EXR_HEAD "relume.format\0int",
                      plain[] = EXR_HEAD "channels\0chlist";
    write_bytes("baked.exr", baked, sizeof baked);
    write_bytes("baked", baked, sizeof baked);
    write_bytes("gbrdf.exr", gbrdf, sizeof gbrdf);
    write_bytes("lit.exr", lit, sizeof lit);
    write_bytes("plain.exr", plain, sizeof plain);
    write_text("text.exr", "bakedVersion");
    assert_int_equal(KIND_OF("baked.exr"), RELUME_KIND_BAKED);
    assert_int_equal(KIND_OF("baked"), RELUME_KIND_BAKED);
    assert_int_equal(KIND_OF("gbrdf.exr"), RELUME_KIND_FITTED);
    assert_int_equal(KIND_OF("lit.exr"), RELUME_KIND_RELUME);
    assert_int_equal(KIND_OF("plain.exr"), RELUME_KIND_PICTURE);
    assert_int_equal(KIND_OF("text.exr"), RELUME_KIND_RELUME);
}

static void json_files_are_told_by_their_format(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        enum relume_kind kind;
    } rows[] = {
        {"{\"format\": \"relume-capture\"}", RELUME_KIND_CAPTURE},
        {"{\"format\":\"relume-scene\"}", RELUME_KIND_SCENE},
        {"{\n \"format\" :\n\t\"relume-objects\", \"a\": \"relume-scene\"}", RELUME_KIND_OBJECTS},
        {"{\"captures\": [{\"file\": \"relume-capture\"}], \"format\": \"relume-scene\"}",
         RELUME_KIND_SCENE},
        {"{\"image\": {\"format\": \"jpg\"}, \"colorspace\": \"rgb\"}", RELUME_KIND_FOREIGN},
        {"{\"format\": \"relume-scene", RELUME_KIND_SCENE},  // damaged: its reader says how
        {"{}", RELUME_KIND_OBJECTS},
        {"\"format\"", RELUME_KIND_OBJECTS},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        write_text("a.json", rows[i].text);
        if (KIND_OF("a.json") != rows[i].kind)
            fail_msg("%s: %s", rows[i].text, relume_kind_name(KIND_OF("a.json")));
    }
    write_text("a.txt", rows[1].text);
    assert_int_equal(KIND_OF("a.txt"), RELUME_KIND_UNKNOWN);
    write_text("info.json", "{}");
    assert_int_equal(KIND_OF("info.json"), RELUME_KIND_FOREIGN);
}

// Members of JSON come in any order, so "format" may lie far from the beginning.
static void a_format_is_found_anywhere(void **state)
{
    (void)state;
    enum { BLANKS = 6000 };
    for (int before = 4060; before < 4110; before++) {
        char *text = mem_format("{%*s\"format\": \"relume-scene\"%*s}", before, "", BLANKS, "");
        write_text("far.json", text);
        mem_free(text);
        assert_int_equal(KIND_OF("far.json"), RELUME_KIND_SCENE);
    }
    char *text = mem_format("{%*s\"format\": \"relume-scene\"", BLANKS, "");
    write_text("far.json", text);
    mem_free(text);
    assert_int_equal(KIND_OF("far.json"), RELUME_KIND_OBJECTS);
}

static void other_files_are_told_by_their_names(void **state)
{
    (void)state;
    static const struct {
        const char *names[12];
        enum relume_kind kind;
    } rows[] = {
        {{"a.ptm", "a.LPTM", "a.rti", "a.hsh"}, RELUME_KIND_FOREIGN},
        {{"a.lp", "a.LP"}, RELUME_KIND_CAPTURE},
        {{"a.btf"}, RELUME_KIND_MATERIAL},
        {{"a.obj", "a.ply", "a.gltf", "a.glb", "a.fbx", "a.dae", "a.stl", "a.3ds", "a.OFF"},
         RELUME_KIND_MODEL},
        {{"a.png", "a.jpg", "a.tif", "a.hdr", "a.pfm", "a.NEF", "a.dng", "a.rw2"},
         RELUME_KIND_PICTURE},
        {{"a.exr"}, RELUME_KIND_RELUME},
        {{"a.txt", "exr", "a.zip"}, RELUME_KIND_UNKNOWN},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int k = 0; k < 12 && rows[i].names[k]; k++) {
            write_text(rows[i].names[k], "");
            if (KIND_OF(rows[i].names[k]) != rows[i].kind)
                fail_msg("%s: %s", rows[i].names[k], relume_kind_name(KIND_OF(rows[i].names[k])));
        }
}

static void every_kind_has_a_name(void **state)
{
    (void)state;
    for (int a = RELUME_KIND_RELUME; a <= RELUME_KIND_SURFACE; a++)
        for (int b = RELUME_KIND_RELUME; b < a; b++)
            assert_string_not_equal(relume_kind_name((enum relume_kind)a),
                                    relume_kind_name((enum relume_kind)b));
    assert_string_equal(relume_kind_name(RELUME_KIND_UNKNOWN), "nothing known");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(folders_are_told_by_what_they_hold, setup, teardown),
        cmocka_unit_test_setup_teardown(written_files_are_told, setup, teardown),
        cmocka_unit_test_setup_teardown(exr_files_are_told_by_attributes, setup, teardown),
        cmocka_unit_test_setup_teardown(json_files_are_told_by_their_format, setup, teardown),
        cmocka_unit_test_setup_teardown(a_format_is_found_anywhere, setup, teardown),
        cmocka_unit_test_setup_teardown(other_files_are_told_by_their_names, setup, teardown),
        cmocka_unit_test(every_kind_has_a_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
