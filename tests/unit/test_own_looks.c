// Materials that a mesh's own file names: values against what glTF's factors, pictures and colours
// of vertices say; a furnace; files that are broken.
#include "capture_fixture.h"
#include "in_folder.h"

#include <relume/btf.h>
#include <relume/object.h>

static char last[1024];

static void hear(void *user, enum relume_level level, const char *text)
{
    (void)user;
    (void)level;
    snprintf(last, sizeof last, "%s", text);
}
static const struct relume_log hearing = {.message = hear};

// A square of side 2 on z = 0: places, texture coordinates, indices, and colours of its corners,
// which are red, green, blue and white from the lower left on.
static const char arrays[] =
    "\"buffers\":[{\"byteLength\":108,\"uri\":\"data:application/octet-stream;base64,"
    "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAACAPwAAgD8AAAAAAACAvwAAgD8AAAAAAAAAAAAA"
    "gD8AAIA/AACAPwAAgD8AAAAAAAAAAAAAAAAAAAEAAgAAAAIAAwD/AAD/AP8A/wAA////////"
    "\"}],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},"
    "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":32},"
    "{\"buffer\":0,\"byteOffset\":80,\"byteLength\":12},"
    "{\"buffer\":0,\"byteOffset\":92,\"byteLength\":16}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","
    "\"min\":[-1,-1,0],\"max\":[1,1,0]},"
    "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
    "{\"bufferView\":2,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"
    "{\"bufferView\":3,\"componentType\":5121,\"normalized\":true,\"count\":4,"
    "\"type\":\"VEC4\"}]";

// It as square.gltf, with what a material and the rest of the file say.
static void write_square(const char *material, const char *rest, bool coloured)
{
    char text[4096];
    snprintf(text, sizeof text,
             "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
             "\"nodes\":[{\"mesh\":0}],\"materials\":[{\"name\":\"own\","
             "\"pbrMetallicRoughness\":{%s}}],\"meshes\":[{\"primitives\":[{\"attributes\":"
             "{\"POSITION\":0,\"TEXCOORD_0\":1%s},\"indices\":2,\"material\":0}]}],%s%s}",
             material, coloured ? ",\"COLOR_0\":3" : "", rest, arrays);
    write_text("square.gltf", text);
}

static relume_status open_mesh(relume_objects **out, const char *mesh)
{
    char text[256];
    snprintf(text, sizeof text,
             "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"%s\"}]}", mesh);
    write_text("own.json", text);
    return relume_objects_open(out, path_of("own.json"), relume_objects_params(.log = &hearing));
}

// Pixels of the square as seen from far above, under one light; [SIDE][SIDE][3].
enum { SIDE = 8 };
static void show(struct relume_image *out, relume_objects *o, const struct relume_light *light)
{
    const struct relume_window window = {{0, 0, 1e4}, {-1, 1, 0}, {2, 0, 0}, {0, -2, 0}};
    assert_int_equal(relume_image_create(out, SIDE, SIDE, 3), RELUME_OK);
    assert_int_equal(relume_objects_render(out, o, &window, light, 1, NULL), RELUME_OK);
}

static const struct relume_light above = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}};

static void factors_are_the_colour(void **state)
{
    (void)state;
    relume_objects *o;
    struct relume_image image;
    write_square("\"baseColorFactor\":[0.2,0.4,0.6,1],\"metallicFactor\":0", "", false);
    assert_int_equal(open_mesh(&o, "square.gltf"), RELUME_OK);
    const struct relume_objects_info *i = relume_objects_info(o);
    assert_string_equal(i->material[0].name, "own");
    assert_string_equal(i->material[0].model, "lit");
    assert_null(i->tint);
    show(&image, o, &above);
    for (int k = 0; k < SIDE * SIDE; k++)
        for (int c = 0; c < 3; c++)  // halfs
            assert_float_equal(image.data[3 * k + c], 0.2 * (c + 1), 5e-4);
    relume_image_destroy(&image);
    relume_objects_destroy(&o);
}

// Four texels; the pixels at the middle of each show it, times the factor.
static void make_picture(struct relume_image *out)
{
    static const float texel[4][3] = {
        {0.8f, 0.1f, 0.1f}, {0.1f, 0.8f, 0.1f}, {0.1f, 0.1f, 0.8f}, {0.5f, 0.5f, 0.5f}};
    assert_int_equal(relume_image_create(out, 2, 2, 3), RELUME_OK);
    memcpy(out->data, texel, sizeof texel);
}

static void expect_picture(relume_objects *o, double factor)
{
    struct relume_image image, picture;
    make_picture(&picture);
    show(&image, o, &above);
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < 3; c++) {
            // the mean of the four pixels around the middle of a texel
            double sum = 0.0;
            for (int p = 0; p < 4; p++)
                sum += (double)image
                           .data[3 * ((k / 2 * 4 + 1 + p / 2) * SIDE + k % 2 * 4 + 1 + p % 2) + c];
            // four pixels mix in 15/16 and 1/4 ways with neighbours alike on both sides: 49/64 of
            // it
            const float *t = picture.data;
            const double own = 0.875 * 0.875, beside = 0.875 * 0.125, across = 0.125 * 0.125;
            const double want = own * (double)t[3 * k + c] + beside * (double)t[3 * (k ^ 1) + c] +
                                beside * (double)t[3 * (k ^ 2) + c] +
                                across * (double)t[3 * (k ^ 3) + c];
            assert_float_equal(0.25 * sum, factor * want, 4e-3);  // 8 bits
        }
    relume_image_destroy(&picture);
    relume_image_destroy(&image);
}

static size_t base64(char *to, const unsigned char *from, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t n = 0;
    for (size_t i = 0; i < size; i += 3) {
        uint32_t word = 0;
        for (size_t k = 0; k < 3; k++)
            word = word << 8 | (i + k < size ? from[i + k] : 0u);
        for (size_t k = 0; k < 4; k++)
            to[n++] = i + k <= size || k < 2 ? digits[word >> (18 - 6 * k) & 63] : '=';
    }
    to[n] = '\0';
    return n;
}

#define PICTURED                                                                                   \
    "\"baseColorFactor\":[0.5,0.5,0.5,1],\"metallicFactor\":0,\"baseColorTexture\":{\"index\":0}"

static void pictures_are_shown(void **state)
{
    (void)state;
    relume_objects *o;
    struct relume_image picture;
    struct relume_buffer bytes = {0};
    const struct relume_writer writer = relume_buffer_writer(&bytes);
    char text[2048], rest[2560];
    make_picture(&picture);
    assert_int_equal(relume_image_save(&picture, path_of("a picture.png"), NULL), RELUME_OK);
    assert_int_equal(relume_image_save(&picture, "x.png", relume_image_params(.writer = &writer)),
                     RELUME_OK);
    base64(text, bytes.data, bytes.size);
    const char *const uri[] = {"a picture.png", "a%20picture.png", "data:image/png;base64,"};
    for (int i = 0; i < 3; i++) {
        snprintf(rest, sizeof rest,
                 "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"%s%s\"}],", uri[i],
                 i == 2 ? text : "");
        write_square(PICTURED, rest, false);
        assert_int_equal(open_mesh(&o, "square.gltf"), RELUME_OK);
        assert_int_equal(relume_objects_info(o)->material[0].width, 2);
        expect_picture(o, 0.5);
        relume_objects_destroy(&o);
    }
    relume_buffer_destroy(&bytes);
    relume_image_destroy(&picture);
}

// An OBJ whose library names the same picture.
static void libraries_are_read(void **state)
{
    (void)state;
    relume_objects *o;
    write_text("two.mtl", "newmtl plain\nKd 0.2 0.4 0.6\nnewmtl own\nKd 0 0 0\n"
                          "map_Kd a picture.png\n");
    write_text("two.obj", "mtllib two.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nusemtl own\n"
                          "f 1/1/1 2/2/1 3/3/1 4/4/1\nv 5 0 0\nv 6 0 0\nv 5 1 0\nusemtl plain\n"
                          "f 5/1/1 6/2/1 7/3/1\n");
    assert_int_equal(open_mesh(&o, "two.obj"), RELUME_OK);
    const struct relume_objects_info *i = relume_objects_info(o);
    assert_int_equal(i->materials, 2);
    float rgb[3];
    relume_btf_fitted_evaluate(i->material[1].fitted, 0, 0, (struct relume_vec3){0, 0, 1},
                               (struct relume_vec3){0, 0, 1}, rgb);
    for (int c = 0; c < 3; c++)
        assert_float_equal(rgb[c], 0.2 * (c + 1), 5e-4);
    expect_picture(o, 1.0);
    relume_objects_destroy(&o);
}

// Red, green, blue and white at the corners, the square cut from the red one to the blue one.
static void colours_of_vertices_multiply(void **state)
{
    (void)state;
    relume_objects *o;
    struct relume_image image;
    write_square("\"baseColorFactor\":[0.5,0.5,0.5,1],\"metallicFactor\":0", "", true);
    assert_int_equal(open_mesh(&o, "square.gltf"), RELUME_OK);
    show(&image, o, &above);
    for (int k = 0; k < SIDE * SIDE; k++) {
        const double x = (k % SIDE + 0.5) / SIDE, y = 1 - (k / SIDE + 0.5) / SIDE;
        const double low[3] = {1 - x, x - y, y}, high[3] = {1 - y + (y - x), y - x, x + (y - x)};
        for (int c = 0; c < 3; c++)
            assert_float_equal(image.data[3 * k + c], 0.5 * (x > y ? low[c] : high[c]), 1e-3);
    }
    relume_image_destroy(&image);
    relume_objects_destroy(&o);
}

// Gloss sends light to the mirrored side, in the colour of the metal; white in even light is white.
static void gloss_shines_and_keeps_energy(void **state)
{
    (void)state;
    static const float white[3] = {1, 1, 1}, gold[3] = {1.0f, 0.8f, 0.3f};
    const struct relume_vec3 v = {0.6, 0, 0.8}, mirrored = {-0.6, 0, 0.8}, beside = {0, 0.6, 0.8};
    relume_btf_fitted *m;
    float shines[3], dull[3], sum[3] = {0, 0, 0};
    struct relume_btf_paint_params p = *relume_btf_paint_params(.roughness = 0.5f, .metallic = 1);
    memcpy(p.factor, gold, sizeof gold);
    assert_int_equal(relume_btf_paint(&m, &p), RELUME_OK);
    relume_btf_fitted_evaluate(m, 0, 0, v, mirrored, shines);
    relume_btf_fitted_evaluate(m, 0, 0, v, beside, dull);
    // n = (2 / 0.5^4 - 2) / 4 = 7.5: F0 (n + 2) / 2 n.l at the peak
    for (int c = 0; c < 3; c++) {
        assert_float_equal(shines[c], gold[c] * 0.5f * 9.5f * 0.8f, 0.01 * shines[c]);
        assert_true(dull[c] < 0.05f * shines[c]);
    }
    relume_btf_fitted_destroy(&m);
    p = *relume_btf_paint_params(.roughness = 0.3f);
    memcpy(p.factor, white, sizeof white);
    assert_int_equal(relume_btf_paint(&m, &p), RELUME_OK);
    const int n = 40000;
    for (int i = 0; i < n; i++) {  // directions by n.l, on a spiral
        const double r = sqrt((i + 0.5) / n), phi = 2.399963 * i;
        const struct relume_vec3 l = {r * cos(phi), r * sin(phi), sqrt(1 - r * r)};
        float rgb[3];
        relume_btf_fitted_evaluate(m, 0, 0, (struct relume_vec3){0, 0, 1}, l, rgb);
        for (int c = 0; c < 3; c++)
            sum[c] += rgb[c] / (float)(n * l.z);
    }
    for (int c = 0; c < 3; c++)
        assert_float_equal(sum[c], 1, 0.02);
    relume_btf_fitted_destroy(&m);
}

static void smooth_metal_mirrors(void **state)
{
    (void)state;
    relume_objects *o;
    write_square("\"baseColorFactor\":[0.9,0.8,0.7,1],\"metallicFactor\":1,\"roughnessFactor\":0",
                 "", false);
    assert_int_equal(open_mesh(&o, "square.gltf"), RELUME_OK);
    const struct relume_object_material *m = &relume_objects_info(o)->material[0];
    assert_true(m->mirror);
    assert_float_equal(m->reflectance[2], 0.7, 1e-6);
    relume_objects_destroy(&o);
}

static void what_is_broken_is_told(void **state)
{
    (void)state;
    static const struct {
        const char *uri, *sentence;
    } list[] = {
        {"nowhere.png", "nowhere.png: "},
        {"../../secret.png", "/secret.png: "},
        {"data:image/png;base64,iVBORw0KGgo=", "square.gltf, picture 0: "},
        {"square.gltf", "square.gltf: "},
    };
    relume_objects *o;
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        char rest[256];
        snprintf(rest, sizeof rest, "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"%s\"}],",
                 list[i].uri);
        write_square(PICTURED, rest, false);
        last[0] = '\0';
        assert_true(relume_status_is_input(open_mesh(&o, "square.gltf")));
        assert_null(o);
        if (!strstr(last, list[i].sentence) || strchr(last, '\n') || strstr(last, "../"))
            fail_msg("%s: '%s' does not say '%s'", list[i].uri, last, list[i].sentence);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(factors_are_the_colour),
        cmocka_unit_test(pictures_are_shown),
        cmocka_unit_test(libraries_are_read),
        cmocka_unit_test(colours_of_vertices_multiply),
        cmocka_unit_test(gloss_shines_and_keeps_energy),
        cmocka_unit_test(smooth_metal_mirrors),
        cmocka_unit_test(what_is_broken_is_told),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
