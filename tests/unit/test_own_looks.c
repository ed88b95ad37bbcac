// Materials that a mesh's own file names: values against what glTF's factors, pictures and colours
// of vertices say; a furnace; files that are broken.
#include "material/btf/values.h"
#include "relight/light/environment.h"

#include "capture_fixture.h"
#include "in_folder.h"

#include <relume/material/btf.h>
#include <relume/world/object.h>

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

// What appendix B of glTF 2.0 says, from its formulas as they stand there.
static double appendix_b(const double base, double metal, double roughness, struct relume_vec3 v,
                         struct relume_vec3 l)
{
    const double hx = v.x + l.x, hy = v.y + l.y, hz = v.z + l.z;
    const double length = sqrt(hx * hx + hy * hy + hz * hz);
    const double nh = hz / length, vh = (v.x * hx + v.y * hy + v.z * hz) / length;
    const double a = pow(roughness, 4), nl = l.z, nv = v.z;  // alpha squared
    const double d = a / (M_PI * pow(nh * nh * (a - 1) + 1, 2));
    const double masked = nl * sqrt(a + (1 - a) * nv * nv) + nv * sqrt(a + (1 - a) * nl * nl);
    const double once = pow(1 - vh, 5), specular = M_PI * d * 0.5 / masked;
    const double conductor = specular * (base + (1 - base) * once);
    const double fresnel = 0.04 + 0.96 * once;
    return nl * (metal * conductor + (1 - metal) * (base * (1 - fresnel) + specular * fresnel));
}

static struct relume_vec3 direction_at(double from_pole_deg, double around_deg)
{
    const double a = from_pole_deg * M_PI / 180, b = around_deg * M_PI / 180;
    return (struct relume_vec3){sin(a) * cos(b), sin(a) * sin(b), cos(a)};
}

// Towards the mirrored side, beside it, and where reflectances grow.
static void gloss_is_what_the_standard_says(void **state)
{
    (void)state;
    static const double pair[][4] = {{37, 0, 37, 180}, {37, 0, 30, 100}, {60, 10, 70, 190},
                                     {85, 0, 86, 180}, {10, 0, 80, 40},  {0, 0, 0, 0}};
    static const float base[3] = {1.0f, 0.8f, 0.3f};
    for (int k = 0; k < 4; k++) {
        const double metal = k % 2 ? 1.0 : 0.25, roughness = k / 2 ? 0.6 : 0.25;
        struct relume_btf_paint_params p =
            *relume_btf_paint_params(.roughness = (float)roughness, .metallic = (float)metal);
        relume_btf_fitted *m;
        memcpy(p.factor, base, sizeof base);
        assert_int_equal(relume_btf_paint(&m, &p), RELUME_OK);
        for (size_t i = 0; i < sizeof pair / sizeof *pair; i++) {
            const struct relume_vec3 v = direction_at(pair[i][0], pair[i][1]),
                                     l = direction_at(pair[i][2], pair[i][3]);
            float rgb[3];
            relume_btf_fitted_evaluate(m, 0, 0, v, l, rgb);
            for (int c = 0; c < 3; c++) {
                const double want = appendix_b((double)base[c], metal, roughness, v, l);
                if (fabs((double)rgb[c] - want) > 0.01 * want + 1e-4)
                    fail_msg("%d, pair %zu: %g, expected %g", k, i, (double)rgb[c], want);
            }
        }
        relume_btf_fitted_destroy(&m);
    }
}

// A normal that leans by 30 degrees to the right, painted: matte, as the tilted plane; and what
// shines does so about the eye mirrored there.
static void normals_lean(void **state)
{
    (void)state;
    struct relume_image normal;
    relume_btf_fitted *m;
    float rgb[3];
    const float leaning[3] = {0.75f, 0.5f, 0.5f + 0.5f * 0.8660254f}, white[3] = {1, 1, 1};
    assert_int_equal(relume_image_create(&normal, 1, 1, 3), RELUME_OK);
    memcpy(normal.data, leaning, sizeof leaning);
    struct relume_btf_paint_params p = *relume_btf_paint_params(.roughness = 1, .normals = &normal);
    memcpy(p.factor, white, sizeof white);
    assert_int_equal(relume_btf_paint(&m, &p), RELUME_OK);
    for (int deg = -80; deg <= 80; deg += 20) {
        const struct relume_vec3 l = direction_at(abs(deg), deg < 0 ? 180 : 0), v = {0, 0, 1};
        const double cosine = cos((deg - 30) * M_PI / 180), turn = M_PI / 180;
        // the frame of the tilted plane, in which the standard's formula holds
        const struct relume_vec3 there = {sin((deg - 30) * turn), 0, cosine},
                                 eye = {sin(-30 * turn), 0, cos(30 * turn)};
        relume_btf_fitted_evaluate(m, 0, 0, v, l, rgb);
        const double want = cosine > 0 ? appendix_b(1, 0, 1, eye, there) : 0;
        assert_float_equal(rgb[1], want, 0.004);
    }
    relume_btf_fitted_destroy(&m);
    relume_image_destroy(&normal);
}

// White in even light is white, by lamps from everywhere and under an even sky.
static void gloss_keeps_energy(void **state)
{
    (void)state;
    static const float white[3] = {1, 1, 1};
    relume_btf_fitted *m;
    float sum[3] = {0, 0, 0};
    struct relume_btf_paint_params p = *relume_btf_paint_params(.roughness = 0.3f);
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
    struct relume_image sky, image;
    relume_environment *environment;
    assert_int_equal(relume_image_create(&sky, 16, 8, 3), RELUME_OK);
    for (int i = 0; i < 3 * 16 * 8; i++)
        sky.data[i] = 1.0f;
    assert_int_equal(relume_environment_create(&environment, &sky, NULL), RELUME_OK);
    const struct relume_light light = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .rgb = {1, 1, 1}, .environment = environment};
    for (int k = 0; k < 3; k++) {
        relume_objects *o;
        char material[128];
        snprintf(material, sizeof material, "\"metallicFactor\":0,\"roughnessFactor\":%g",
                 0.15 + 0.3 * k);
        write_square(material, "", false);
        assert_int_equal(open_mesh(&o, "square.gltf"), RELUME_OK);
        show(&image, o, &light);
        for (int i = 0; i < 3 * SIDE * SIDE; i++)
            assert_float_equal(image.data[i], 1, 0.01);
        relume_image_destroy(&image);
        relume_objects_destroy(&o);
    }
    relume_environment_destroy(&environment);
    relume_image_destroy(&sky);
}

// ---------------------------------------------------------------- opacity and emission

// Texels of an opacity of 0, 1, 0.5 and 1 of white; nearest rows and columns of the pixels show
// them.
static void write_alpha(const char *name)
{
    static const uint8_t texel[4][4] = {
        {255, 255, 255, 0}, {255, 255, 255, 255}, {255, 255, 255, 128}, {255, 255, 255, 255}};
    struct relume_image image;
    assert_int_equal(relume_image_create(&image, 2, 2, 4), RELUME_OK);
    for (int i = 0; i < 16; i++)
        image.data[i] = (float)texel[i / 4][i % 4] / 255.0f;
    assert_int_equal(relume_image_save(&image, path_of(name), NULL), RELUME_OK);
    relume_image_destroy(&image);
}

#define ALPHA "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"alpha.png\"}],"
#define WITH_ALPHA                                                                                 \
    "\"metallicFactor\":0,\"baseColorTexture\":{\"index\":0}},\"alphaMode\":\"%s\","               \
    "\"alphaCutoff\":0.4,\"extras\":{"

// What a texture of 2 x 2 shows at the pixels, bilinear and repeated.
static double between(const double texel[4], int pixel)
{
    const double x = 2 * (pixel % SIDE + 0.5) / SIDE - 0.5,
                 y = 2 * (pixel / SIDE + 0.5) / SIDE - 0.5;
    const double u = x - floor(x), v = y - floor(y);
    const int i = ((int)floor(x) + 2) % 2, j = ((int)floor(y) + 2) % 2;
    return (1 - v) * ((1 - u) * texel[2 * j + i] + u * texel[2 * j + 1 - i]) +
           v * ((1 - u) * texel[2 * (1 - j) + i] + u * texel[2 * (1 - j) + 1 - i]);
}

static void what_is_cut_is_not_there(void **state)
{
    (void)state;
    static const char *const mode[] = {"OPAQUE", "MASK", "BLEND"};
    static const double opacity[4] = {0, 1, 128 / 255.0, 1};
    char material[256];
    write_alpha("alpha.png");
    for (int k = 0; k < 3; k++) {
        relume_objects *o;
        struct relume_image image;
        snprintf(material, sizeof material, WITH_ALPHA, mode[k]);
        write_square(material, ALPHA, false);
        assert_int_equal(open_mesh(&o, "square.gltf"), RELUME_OK);
        show(&image, o, &above);
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double part = between(opacity, i);
            const double want = k == 0 ? 1 : k == 1 ? part >= 0.4 : part;
            if (k != 1 || fabs(part - 0.4) > 0.01)
                assert_float_equal(image.data[3 * i], want, 0.004);
        }
        relume_image_destroy(&image);
        relume_objects_destroy(&o);
    }
}

// A pane of half opacity over another above a floor: the floor is seen through both, in the mean of
// their shadows.
static void panes_let_light_through(void **state)
{
    (void)state;
    enum { N = 64 };
    relume_objects *o;
    struct relume_image image;
    write_text("panes.mtl", "newmtl pane\nKd 0 0 0\nd 0.5\nnewmtl floor\nKd 1 1 1\n");
    write_text("panes.obj",
               "mtllib panes.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
               "v -1 -1 .2\nv 1 -1 .2\nv 1 1 .2\nv -1 1 .2\n"
               "v -1 -1 .4\nv 1 -1 .4\nv 1 1 .4\nv -1 1 .4\n"
               "vt 0 0\nvn 0 0 1\nusemtl floor\nf 1/1/1 2/1/1 3/1/1 4/1/1\n"
               "usemtl pane\nf 5/1/1 6/1/1 7/1/1 8/1/1\nf 9/1/1 10/1/1 11/1/1 12/1/1\n");
    assert_int_equal(open_mesh(&o, "panes.obj"), RELUME_OK);
    const struct relume_window window = {{0, 0, 1e4}, {-1, 1, 0}, {2, 0, 0}, {0, -2, 0}};
    assert_int_equal(relume_image_create(&image, N, N, 3), RELUME_OK);
    assert_int_equal(relume_objects_render(&image, o, &window, &above, 1, NULL), RELUME_OK);
    double mean = 0;
    for (int i = 0; i < N * N; i++)
        mean += (double)image.data[3 * i] / (N * N);
    // black panes: 1/4 of the floor's light is seen, and 1/4 of the lamp's arrives; 4096 tosses
    assert_float_equal(mean, 0.0625, 0.006);
    relume_image_destroy(&image);
    relume_objects_destroy(&o);
}

static void emission_is_seen(void **state)
{
    (void)state;
    relume_objects *o;
    struct relume_image image;
    const struct relume_light dark = {.direction = {0, 0, 1}};
    static const double sent[4] = {0.8, 0.1, 0.1, 0.5};  // red of make_picture
    struct relume_image picture;
    make_picture(&picture);
    assert_int_equal(relume_image_save(&picture, path_of("lamp.png"), NULL), RELUME_OK);
    relume_image_destroy(&picture);
    write_square("\"metallicFactor\":0},\"emissiveFactor\":[0.5,0.5,0.5],"
                 "\"emissiveTexture\":{\"index\":0},\"extras\":{",
                 "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"lamp.png\"}],", false);
    assert_int_equal(open_mesh(&o, "square.gltf"), RELUME_OK);
    show(&image, o, &dark);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_float_equal(image.data[3 * i], 0.5 * between(sent, i), 0.003);
    relume_image_destroy(&image);
    relume_objects_destroy(&o);
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
        cmocka_unit_test(gloss_is_what_the_standard_says),
        cmocka_unit_test(normals_lean),
        cmocka_unit_test(gloss_keeps_energy),
        cmocka_unit_test(what_is_cut_is_not_there),
        cmocka_unit_test(panes_let_light_through),
        cmocka_unit_test(emission_is_seen),
        cmocka_unit_test(smooth_metal_mirrors),
        cmocka_unit_test(what_is_broken_is_told),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
