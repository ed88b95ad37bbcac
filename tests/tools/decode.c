// decode.c - one pixel of a relume file, read by docs/format.md and nothing else: this program uses
// OpenEXR's C library and no header or function of relume. The slow and plain way everywhere.
//
//   decode FILE VIEW X Y LX LY LZ      prints linear r g b under `dir LX LY LZ`
#include <math.h>
#include <openexr.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

static void fail(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    fputs("decode: ", stderr);
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
    va_end(list);
    exit(1);
}

// ---------------------------------------------------------------- the container

static exr_context_t file;

static const exr_attribute_t *attribute(int part, const char *name, exr_attribute_type_t type)
{
    const exr_attribute_t *a = NULL;
    if (exr_get_attribute_by_name(file, part, name, &a) || a->type != type)
        return NULL;
    return a;
}

static const char *text_of(const char *name)
{
    const exr_attribute_t *a = attribute(0, name, EXR_ATTR_STRING);
    if (!a)
        fail("no text %s", name);
    return a->string->str;
}

static int int_of(const char *name)
{
    const exr_attribute_t *a = attribute(0, name, EXR_ATTR_INT);
    if (!a)
        fail("no number %s", name);
    return a->i;
}

static const float *floats_of(int part, const char *name, int *count)
{
    const exr_attribute_t *a = attribute(part, name, EXR_ATTR_FLOAT_VECTOR);
    *count = a ? a->floatvector->length : 0;
    return a ? a->floatvector->arr : NULL;
}

static int find_part(const char *wanted)
{
    int count = 0;
    if (exr_get_count(file, &count))
        fail("no parts");
    for (int part = 0; part < count; part++) {
        const char *name;
        if (!exr_get_name(file, part, &name) && name && !strcmp(name, wanted))
            return part;
    }
    fail("no part %s", wanted);
    return -1;
}

// Every channel of pixel (x, y), in the order of the file, as float. Halves become floats, which is
// exact; so do integers below 2^24.
static int read_pixel(int part, int x, int y, const char **name, float *value, int most)
{
    exr_attr_box2i_t window;
    exr_chunk_info_t chunk;
    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    if (exr_get_data_window(file, part, &window) ||
        exr_read_scanline_chunk_info(file, part, window.min.y + y, &chunk) ||
        exr_decoding_initialize(file, part, &chunk, &decoder))
        fail("pixel (%d, %d) cannot be found", x, y);
    const int channels = decoder.channel_count;
    if (channels > most)
        fail("%d channels", channels);
    const size_t line = (size_t)chunk.width, plane = line * (size_t)chunk.height;
    float *all = calloc(plane * (size_t)channels, sizeof *all);
    for (int c = 0; all && c < channels; c++) {
        exr_coding_channel_info_t *channel = &decoder.channels[c];
        channel->decode_to_ptr = (uint8_t *)(all + (size_t)c * plane);
        channel->user_bytes_per_element = 4;
        channel->user_pixel_stride = 4;
        channel->user_line_stride = (int32_t)(4 * line);
        channel->user_data_type =
            channel->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
    }
    if (!all || exr_decoding_choose_default_routines(file, part, &decoder) ||
        exr_decoding_run(file, part, &decoder))
        fail("pixel (%d, %d) cannot be decoded", x, y);
    const exr_attr_chlist_t *list;
    if (exr_get_channels(file, part, &list))
        fail("no channels");
    for (int c = 0; c < channels; c++) {
        const float *at =
            all + (size_t)c * plane + (size_t)(window.min.y + y - chunk.start_y) * line + x;
        uint32_t code;
        memcpy(&code, at, sizeof code);
        value[c] = decoder.channels[c].data_type == EXR_PIXEL_UINT ? (float)code : *at;
        name[c] = list->entries[c].name.str;
    }
    exr_decoding_destroy(file, &decoder);
    free(all);
    return channels;
}

// ---------------------------------------------------------------- vectors

struct vector {
    double x, y, z;
};

static struct vector unit(struct vector v)
{
    const double n = sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return (struct vector){v.x / n, v.y / n, v.z / n};
}

static double dot(struct vector a, struct vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static struct vector cross(struct vector a, struct vector b)
{
    return (struct vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static struct vector minus(struct vector a, struct vector b)
{
    return (struct vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static struct vector pole_frame(struct vector w)
{
    return !strcmp(text_of("relume.pole"), "y") ? (struct vector){-w.z, w.x, w.y} : w;
}

// ---------------------------------------------------------------- basis sh

static double factorial(int n)
{
    return n < 2 ? 1.0 : n * factorial(n - 1);
}

// Associated Legendre function with the sign (-1)^m, from its definition by derivatives of
// (x^2 - 1)^l written out as a sum.
static double legendre(int l, int m, double x)
{
    double sum = 0.0;
    for (int k = m; k <= l; k++) {
        double binomial = 1.0;  // (l + k - 1)/2 over l, generalised
        for (int i = 0; i < l; i++)
            binomial *= ((l + k - 1) / 2.0 - i) / (i + 1);
        sum += factorial(k) / factorial(k - m) * pow(x, k - m) * factorial(l) /
               (factorial(k) * factorial(l - k)) * binomial;
    }
    return (m % 2 ? -1 : 1) * pow(2, l) * pow(1 - x * x, m / 2.0) * sum;
}

static void sh(int count, struct vector d, double *value)
{
    const double phi = atan2(d.y, d.x);
    for (int l = 0, k = 0; k < count; l++)
        for (int m = -l; m <= l; m++, k++) {
            const int a = abs(m);
            const double n = sqrt((2 * l + 1) / (2 * PI) * factorial(l - a) / factorial(l + a));
            value[k] = n * legendre(l, a, d.z) *
                       (m > 0   ? cos(m * phi)
                        : m < 0 ? sin(a * phi)
                                : sqrt(0.5));
        }
}

// ---------------------------------------------------------------- basis table

enum { MOST_POINTS = 256, CANDIDATES = 2048, HELPERS = 6 };

static double angle(struct vector a, struct vector b)
{
    return atan2(sqrt(dot(cross(a, b), cross(a, b))), dot(a, b));
}

static int add_helpers(struct vector *point, int lights)
{
    int n = lights;
    while (n < lights + HELPERS) {
        struct vector best = {0, 0, -1};
        double widest = 0.0;
        for (int i = 0; i <= CANDIDATES; i++) {
            const double z = 2.0 * i / CANDIDATES - 1.0, r = sqrt(1.0 - z * z);
            const double phi = i * PI * (3.0 - sqrt(5.0));
            const struct vector d = {r * cos(phi), r * sin(phi), z};
            double nearest = PI;
            for (int j = 0; j < n; j++)
                nearest = fmin(nearest, angle(d, point[j]));
            if (nearest > widest + 0.02) {
                widest = nearest;
                best = d;
            }
        }
        if (widest < PI / 3.0)
            break;
        point[n++] = best;
    }
    return n;
}

// Lights on a common circle have several triangulations; tiny shifts outwards choose one.
static struct vector shifted(struct vector v, int index)
{
    const uint32_t h = ((uint32_t)index + 1u) * 2654435761u;
    const double s = 1.0 + 1e-7 * ((h >> 8) / 16777216.0);
    return (struct vector){v.x * s, v.y * s, v.z * s};
}

// Whether no point lies outside the plane of the triangle: then it belongs to the hull.
static int on_hull(const struct vector *p, int n, int a, int b, int c)
{
    const struct vector normal = cross(minus(p[b], p[a]), minus(p[c], p[a]));
    for (int i = 0; i < n; i++)
        if (i != a && i != b && i != c && dot(normal, minus(p[i], p[a])) > 0.0)
            return 0;
    return 1;
}

static void table(const struct vector *light, int lights, struct vector d, double *value)
{
    struct vector p[MOST_POINTS + HELPERS], outside[MOST_POINTS + HELPERS];
    memcpy(p, light, (size_t)lights * sizeof *p);
    const int n = add_helpers(p, lights);
    for (int i = 0; i < n; i++)
        outside[i] = shifted(p[i], i);
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++)
            for (int c = 0; c < n; c++) {
                if (b <= a || c <= a || b == c)
                    continue;
                const double volume = dot(p[a], cross(p[b], p[c]));
                const double w[3] = {dot(d, cross(p[b], p[c])) / volume,
                                     dot(p[a], cross(d, p[c])) / volume,
                                     dot(p[a], cross(p[b], d)) / volume};
                if (volume < 1e-12 || w[0] < -1e-9 || w[1] < -1e-9 || w[2] < -1e-9 ||
                    !on_hull(outside, n, a, b, c))
                    continue;
                const int corner[3] = {a, b, c};
                double sum = 0.0;
                for (int i = 0; i < 3; i++)
                    sum += corner[i] < lights ? fmax(w[i], 0.0) : 0.0;
                for (int i = 0; sum > 1e-9 && i < 3; i++)
                    if (corner[i] < lights)
                        value[corner[i]] = fmax(w[i], 0.0) / sum;
                if (sum > 1e-9)
                    return;
            }
    fail("the direction lies in no triangle with a light");
}

// ---------------------------------------------------------------- decoding

static void basis(int k, struct vector light, double *stored)
{
    struct vector d = pole_frame(unit(light));
    if (int_of("relume.hemispherical") && d.z < 0.0)
        d = unit((struct vector){d.x, d.y, 0.0});
    double *value = calloc((size_t)k, sizeof *value);
    int n, size;
    const float *xyz = floats_of(0, "relume.lights", &n);
    const float *transform = floats_of(0, "relume.transform", &size);
    const char *name = text_of("relume.basis");
    if (!strcmp(name, "sh")) {
        sh(k, d, value);
    } else if (!strcmp(name, "table") && n == 3 * k && k <= MOST_POINTS) {
        struct vector light_of[MOST_POINTS];
        for (int i = 0; i < k; i++)
            light_of[i] = pole_frame(unit((struct vector){
                (double)xyz[3 * i], (double)xyz[3 * i + 1], (double)xyz[3 * i + 2]}));
        table(light_of, k, d, value);
    } else {
        fail("basis %s with %d coefficients", name, k);
    }
    for (int i = 0; i < k; i++) {
        stored[i] = size ? 0.0 : value[i];
        for (int j = 0; size && j < k; j++)
            stored[i] += (double)transform[i * k + j] * value[j];
    }
    free(value);
}

static double linearised(double v)
{
    const char *display = text_of("relume.display");
    const double a = fabs(v);
    if (!strcmp(text_of("relume.domain"), "linear"))
        return v;
    if (!strncmp(display, "gamma:", 6))
        return copysign(pow(a, atof(display + 6)), v);
    return copysign(a <= 0.04045 ? a / 12.92 : pow((a + 0.055) / 1.055, 2.4), v);
}

int main(int argc, char **argv)
{
    enum { MOST = 3 * 4096 };
    static const char *name[MOST];
    static float code[MOST];
    if (argc != 8)
        fail("usage: decode FILE VIEW X Y LX LY LZ");
    if (exr_start_read(&file, argv[1], NULL))
        fail("%s cannot be opened", argv[1]);
    if (strcmp(text_of("relume.format"), "relume") || int_of("relume.version") != 1)
        fail("%s: no relume file of version 1", argv[1]);
    char part_name[32];
    snprintf(part_name, sizeof part_name, "view%04d", atoi(argv[2]));
    const int part = find_part(part_name), k = int_of("relume.coefficients");
    const int channels = read_pixel(part, atoi(argv[3]), atoi(argv[4]), name, code, MOST);
    int scales, offsets;
    const float *scale = floats_of(part, "relume.scale", &scales);
    const float *offset = floats_of(part, "relume.offset", &offsets);
    if (channels != 3 * k || scales != 3 * k || offsets != 3 * k)
        fail("%d channels, %d scales; expected %d", channels, scales, 3 * k);

    double *weight = calloc((size_t)k, sizeof *weight), rgb[3] = {0, 0, 0};
    basis(k, (struct vector){atof(argv[5]), atof(argv[6]), atof(argv[7])}, weight);
    for (int i = 0; i < channels; i++) {
        int number;
        char letter;
        if (sscanf(name[i], "c%4d.%c", &number, &letter) != 2 || number >= k)
            fail("channel %s", name[i]);
        const int c = letter == 'R' ? 0 : letter == 'G' ? 1 : 2;
        const int plane = 3 * number + c;
        rgb[c] += weight[number] * ((double)code[i] * (double)scale[plane] + (double)offset[plane]);
    }
    printf("%.9g %.9g %.9g\n", linearised(rgb[0]), linearised(rgb[1]), linearised(rgb[2]));
    free(weight);
    exr_finish(&file);
    return 0;
}
