// site_relit.c - a published file, relit by a reader of its own: does it show what relume shows?
//
//     site_relit SITE/NAME VIEW x,y,z PICTURE [LEVEL]
// reads scene.json and the tiles as docs/publish.md has them, relights the view by a distant light
// and prints the mean and the largest difference from PICTURE, in 255ths of sRGB codes. Of the
// library it takes what a browser has too: JSON, JPEG, and the functions of the light.
#include <relume/extensions.h>

#include "core/base/json.h"
#include "format/coder/coding.h"
#include "image/image/jpeg.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct scene {
    jvalue *root;
    const char *folder;
    int width, height, tile, functions, planes, level;
    float *transform, *mean;  // [3][planes][functions], [3][functions]
    double *scale, *offset, knee;
    uint8_t *codes;  // [planes][height][width]
};

static void fail(const char *what)
{
    fprintf(stderr, "site_relit: %s\n", what);
    exit(1);
}

static int whole(const jvalue *object, const char *key)
{
    int v;
    if (!jvalue_whole(jvalue_member(object, key), 0, 1 << 20, &v))
        fail(key);
    return v;
}

static float *floats(const jvalue *root, const char *key, size_t n)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *text = jvalue_text(jvalue_member(root, key));
    uint8_t *bytes = malloc(4 * n + 4);
    size_t at = 0;
    uint32_t bits = 0;
    for (int i = 0; text && text[i] && text[i] != '=' && at < 4 * n; i++) {
        const char *digit = strchr(digits, text[i]);
        if (!digit)
            fail(key);
        bits = bits << 6 | (uint32_t)(digit - digits);
        if (i % 4)
            bytes[at++] = (uint8_t)(bits >> (6 - 2 * (i % 4)));
    }
    if (at != 4 * n)
        fail(key);
    return (float *)(void *)bytes;
}

static double *numbers(const jvalue *root, const char *key, size_t n)
{
    double *out = malloc(n * sizeof *out);
    if (!jvalue_numbers(jvalue_member(root, key), out, n))
        fail(key);
    return out;
}

static void load(struct scene *s, const char *folder, int level)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/scene.json", folder);
    if (jvalue_load(&s->root, path, NULL) ||
        (jvalue_check_format(s->root, path, "relume-web", 1, NULL) &&
         jvalue_check_format(s->root, path, "relume-web", 2, NULL)))
        fail("scene.json");
    const jvalue *size = jvalue_item(jvalue_member(s->root, "levels"), (size_t)level);
    s->folder = folder;
    s->level = level;
    s->width = whole(size, "width");
    s->height = whole(size, "height");
    s->tile = whole(s->root, "tile");
    s->functions = whole(s->root, "functions");
    s->planes = whole(s->root, "planes");
    const size_t k = (size_t)s->planes, f = (size_t)s->functions;
    s->transform = floats(s->root, "transform", 3 * k * f);
    s->mean = floats(s->root, "mean", 3 * f);
    s->scale = numbers(s->root, "scale", k);
    s->offset = numbers(s->root, "offset", k);
    jvalue_number(jvalue_member(s->root, "knee"), &s->knee);
    s->codes = calloc(k, (size_t)s->width * (size_t)s->height);
}

static uint32_t word(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static uint8_t *file_of(const char *path, size_t *size)
{
    FILE *f = fopen(path, "rb");
    if (!f || fseek(f, 0, SEEK_END))
        fail(path);
    *size = (size_t)ftell(f);
    uint8_t *bytes = malloc(*size + 1);
    rewind(f);
    if (fread(bytes, 1, *size, f) != *size)
        fail(path);
    fclose(f);
    return bytes;
}

static void put_picture(struct scene *s, const struct jpeg_codes *c, int first, int x, int y)
{
    const size_t pixels = (size_t)s->width * (size_t)s->height, width = (size_t)c->width;
    for (int p = 0; p < c->planes && first + p < s->planes; p++)
        for (int row = 0; row < c->height; row++)
            memcpy(s->codes + (size_t)(first + p) * pixels + (size_t)(y + row) * (size_t)s->width +
                       (size_t)x,
                   c->data + ((size_t)p * (size_t)c->height + (size_t)row) * width, width);
}

static void load_tile(struct scene *s, int view, int column, int row)
{
    char path[4096];
    size_t size;
    snprintf(path, sizeof path, "%s/v%d/%d_%d_%d.bin", s->folder, view, s->level, column, row);
    uint8_t *bytes = file_of(path, &size);
    const uint32_t n = word(bytes);
    size_t at = 4 + 4 * (size_t)n;
    if ((int)n != (s->planes + 2) / 3)
        fail("number of pictures in a tile");
    for (uint32_t i = 0; i < n; i++) {
        struct jpeg_codes c;
        const size_t length = word(bytes + 4 + 4 * i);
        if (at + length > size || jpeg_decode(&c, bytes + at, length, path, NULL, NULL))
            fail(path);
        if (column * s->tile + c.width > s->width || row * s->tile + c.height > s->height)
            fail("size of a tile");
        put_picture(s, &c, 3 * (int)i, column * s->tile, row * s->tile);
        jpeg_codes_free(&c);
        at += length;
    }
    if (at != size)
        fail("size of a tile's file");
    free(bytes);
}

// f(l), and the share of the light; the light is moved to where it was captured.
static double functions_at(const struct scene *s, struct relume_vec3 light, float *f)
{
    const jvalue *b = jvalue_member(s->root, "basis");
    const jvalue *lights = jvalue_member(b, "lights");
    const size_t n = jvalue_count(lights) / 3;
    double *v = malloc(3 * n * sizeof *v);
    struct relume_vec3 *direction = malloc(n * sizeof *direction);
    struct relume_coder_params p = {.struct_size = sizeof p, .decode = true, .force = true};
    const char *between = jvalue_text(jvalue_member(b, "interpolant"));
    if (!jvalue_numbers(lights, v, 3 * n))
        fail("lights");
    for (size_t i = 0; i < n; i++)
        direction[i] = (struct relume_vec3){v[3 * i], v[3 * i + 1], v[3 * i + 2]};
    if (between && (!(p.interpolant = relume_interpolant_find(between)) ||
                    !jvalue_numbers(jvalue_member(b, "parameter"), p.parameter, 4)))
        fail("interpolant");
    if (!between)
        p.coefficients = whole(b, "coefficients");
    p.pole_y = !strcmp(jvalue_text(jvalue_member(b, "pole")), "y");
    jvalue_truth(jvalue_member(b, "hemispherical"), &p.hemispherical);
    relume_coder *coder;
    const struct relume_basis *basis = relume_basis_find(jvalue_text(jvalue_member(b, "name")));
    if (!basis || relume_coder_create(&coder, basis, direction, (int)n, &p) ||
        relume_coder_info(coder)->coefficients != s->functions)
        fail("basis");
    float *w = malloc(3 * (size_t)s->functions * sizeof *w), constant[3];
    const double share = relume_coder_clamp(&light, coder, light);
    relume_coder_weights(coder, light, w, constant);
    memcpy(f, w, (size_t)s->functions * sizeof *f);
    relume_coder_destroy(&coder);
    free(w);
    free(v);
    free(direction);
    return share;
}

static double dot(const float *a, const float *b, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += (double)a[i] * (double)b[i];
    return sum;
}

int main(int argc, char **argv)
{
    struct scene s = {0};
    struct relume_vec3 light;
    struct relume_image picture = {0};
    if (argc < 5 || sscanf(argv[3], "%lf,%lf,%lf", &light.x, &light.y, &light.z) != 3)
        fail("SITE/NAME VIEW x,y,z PICTURE [LEVEL]");
    load(&s, argv[1], argc > 5 ? atoi(argv[5]) : 0);
    for (int y = 0; y * s.tile < s.height; y++)
        for (int x = 0; x * s.tile < s.width; x++)
            load_tile(&s, atoi(argv[2]), x, y);
    if (relume_image_load(&picture, argv[4], relume_image_params(.channels = 3)) ||
        picture.width != s.width || picture.height != s.height)
        fail("the picture, or its size");
    const double length = sqrt(light.x * light.x + light.y * light.y + light.z * light.z);
    light = (struct relume_vec3){light.x / length, light.y / length, light.z / length};
    float *f = malloc((size_t)s.functions * sizeof *f);
    const double share = functions_at(&s, light, f);
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    struct relume_transfer coding;
    if (relume_transfer_parse(&coding, jvalue_text(jvalue_member(s.root, "transfer"))))
        fail("transfer");
    const size_t pixels = (size_t)s.width * (size_t)s.height;
    double sum = 0.0, most = 0.0;
    for (int c = 0; c < 3; c++) {
        double w[128];
        const double mean = dot(s.mean + c * s.functions, f, s.functions);
        for (int k = 0; k < s.planes; k++)
            w[k] = dot(s.transform + (c * s.planes + k) * s.functions, f, s.functions);
        for (size_t i = 0; i < pixels; i++) {
            double sum_k = 0.0;
            for (int k = 0; k < s.planes; k++)
                sum_k += w[k] * (s.codes[(size_t)k * pixels + i] * s.scale[k] + s.offset[k]);
            const double first = s.codes[i] * s.scale[0] + s.offset[0];
            double v = mean + sum_k * (s.knee > 0.0 ? s.knee + fabs(first) : 1.0);
            v = share * (double)relume_transfer_decode(coding, (float)fmax(v, 0.0));
            const double shown =
                (double)relume_transfer_encode(srgb, (float)fmin(fmax(v, 0.0), 1.0));
            const double wanted = (double)relume_transfer_encode(
                srgb, fminf(fmaxf(picture.data[3 * i + (size_t)c], 0.0f), 1.0f));
            const double d = 255.0 * fabs(shown - wanted);
            sum += d;
            most = fmax(most, d);
        }
    }
    printf("%.3f %.1f\n", sum / (3.0 * (double)pixels), most);
    return 0;
}
