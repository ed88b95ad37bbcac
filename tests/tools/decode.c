// decode.c - one pixel of a relume file, read by docs/format.md and nothing else: this program uses
// OpenEXR's C library and no header or function of relume. The slow and plain way everywhere.
//
//   decode FILE VIEW X Y LX LY LZ      prints linear r g b under `dir LX LY LZ`
//   decode FILE                        is the file one that every OpenEXR program opens?
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

static const char *text_or(const char *name, const char *otherwise)
{
    const exr_attribute_t *a = attribute(0, name, EXR_ATTR_STRING);
    return a ? a->string->str : otherwise;
}

static int int_of_part(int part, const char *name)
{
    const exr_attribute_t *a = attribute(part, name, EXR_ATTR_INT);
    if (!a)
        fail("no number %s", name);
    return a->i;
}

static int int_of(const char *name)
{
    return int_of_part(0, name);
}

static const float *floats_of(int part, const char *name, int *count)
{
    const exr_attribute_t *a = attribute(part, name, EXR_ATTR_FLOAT_VECTOR);
    *count = a ? a->floatvector->length : 0;
    return a ? a->floatvector->arr : NULL;
}

// -1 when there is none.
static int look_for_part(const char *wanted)
{
    int count = 0;
    if (exr_get_count(file, &count))
        fail("no parts");
    for (int part = 0; part < count; part++) {
        const char *name;
        if (!exr_get_name(file, part, &name) && name && !strcmp(name, wanted))
            return part;
    }
    return -1;
}

static int find_part(const char *wanted)
{
    const int part = look_for_part(wanted);
    if (part < 0)
        fail("no part %s", wanted);
    return part;
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

// ---------------------------------------------------------------- bases ptm, hsh, dct

static void ptm(int count, struct vector d, double *value)
{
    const double terms[6] = {d.x * d.x, d.y * d.y, d.x * d.y, d.x, d.y, 1.0};
    memcpy(value, terms + 6 - count, (size_t)count * sizeof *value);
}

static void hsh(int count, struct vector d, double *value)
{
    const double x = 2.0 * fmax(d.z, sin(0.01)) - 1.0, phi = atan2(d.y, d.x);
    for (int l = 0, k = 0; k < count; l++)
        for (int m = l; m >= -l; m--, k++) {
            const int a = abs(m), sign = a * (a - 1) / 2 % 2 ? -1 : 1;
            const double n = sqrt((2 * l + 1) / (2 * PI) * factorial(l - a) / factorial(l + a));
            value[k] = sign * n * (a % 2 ? -1 : 1) * legendre(l, a, x) *
                       (m > 0   ? sqrt(2.0) * cos(a * phi)
                        : m < 0 ? sqrt(2.0) * sin(a * phi)
                                : 1.0);
        }
}

static void dct(int count, int hemispherical, struct vector d, double *value)
{
    const int upper = hemispherical ? count : (count + 1) / 2;
    const int first = d.z < 0.0 ? upper : 0, last = d.z < 0.0 ? count : upper;
    const double x = (1.0 + d.x / (1.0 + fabs(d.z))) / 2.0;
    const double y = (1.0 - d.y / (1.0 + fabs(d.z))) / 2.0;
    for (int zone = 0, k = first; k < last; zone++)
        for (int u = 0; u <= zone && k < last; u++, k++) {
            const int v = zone - u;
            value[k] =
                (u ? sqrt(2.0) : 1.0) * cos(PI * u * x) * (v ? sqrt(2.0) : 1.0) * cos(PI * v * y);
        }
}

// ---------------------------------------------------------------- interpolants

enum { MOST_POINTS = 256, CANDIDATES = 2048, HELPERS = 6, VORONOI = 8192 };

struct set {
    int n;
    struct vector light[MOST_POINTS];
};

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

static void delaunay(const struct set *s, struct vector d, double *value)
{
    const int lights = s->n;
    struct vector p[MOST_POINTS + HELPERS], outside[MOST_POINTS + HELPERS];
    memcpy(p, s->light, (size_t)lights * sizeof *p);
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

static double angular(const double *parameter, struct vector a, struct vector b)
{
    (void)parameter;
    return -angle(a, b);
}

static double thin_plate(const double *parameter, struct vector a, struct vector b)
{
    (void)parameter;
    const double r = sqrt(dot(minus(a, b), minus(a, b)));
    return r > 0.0 ? r * r * log(r) : 0.0;
}

static double gaussian(const double *parameter, struct vector a, struct vector b)
{
    return exp(-dot(minus(a, b), minus(a, b)) / (parameter[0] * parameter[0]));
}

static double chord(const double *parameter, struct vector a, struct vector b)
{
    const struct vector d = minus(a, b);
    const double z = parameter[1] * d.z, r = sqrt(d.x * d.x + d.y * d.y + z * z);
    const double t = dot(a, b);
    // the five products of second degree sum to P_2(t) without its factor
    const double second = (3.0 * t * t - 1.0) / 6.0;
    return 30.0 * t - pow(r, parameter[0]) + parameter[3] * second;
}

// a[n][n] x = b by elimination with the largest pivot; x is left in b.
static void solve(double *a, double *b, int n)
{
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++)
            best = fabs(a[i * n + k]) > fabs(a[best * n + k]) ? i : best;
        for (int j = 0; j < n; j++) {
            const double t = a[k * n + j];
            a[k * n + j] = a[best * n + j];
            a[best * n + j] = t;
        }
        const double t = b[k];
        b[k] = b[best];
        b[best] = t;
        for (int i = k + 1; i < n; i++) {
            const double f = a[i * n + k] / a[k * n + k];
            for (int j = k; j < n; j++)
                a[i * n + j] -= f * a[k * n + j];
            b[i] -= f * b[k];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int j = k + 1; j < n; j++)
            b[k] -= a[k * n + j] * b[j];
        b[k] /= a[k * n + k];
    }
}

// With `terms` of the trend 1, x, y, z, and `nugget` on the diagonal.
static void kernel(const struct set *s, double (*phi)(const double *, struct vector, struct vector),
                   const double *parameter, int terms, double nugget, struct vector d,
                   double *value)
{
    enum { MOST = MOST_POINTS + 4 };
    static double a[MOST * MOST], b[MOST];
    const int n = s->n + terms;
    for (int i = 0; i < s->n; i++) {
        const double trend[4] = {1.0, s->light[i].x, s->light[i].y, s->light[i].z};
        for (int j = 0; j < s->n; j++)
            a[i * n + j] = phi(parameter, s->light[i], s->light[j]) + (i == j ? nugget : 0.0);
        for (int t = 0; t < terms; t++)
            a[i * n + s->n + t] = a[(s->n + t) * n + i] = trend[t];
        b[i] = phi(parameter, s->light[i], d);
    }
    const double trend[4] = {1.0, d.x, d.y, d.z};
    for (int t = 0; t < terms; t++) {
        for (int u = 0; u < terms; u++)
            a[(s->n + t) * n + s->n + u] = t == u ? -1e-9 : 0.0;
        b[s->n + t] = trend[t];
    }
    solve(a, b, n);
    memcpy(value, b, (size_t)s->n * sizeof *value);
}

// The mean distance to the nearest other light.
static double spacing(const struct set *s)
{
    double sum = 0.0;
    for (int i = 0; i < s->n; i++) {
        double nearest = 2.0;
        for (int j = 0; j < s->n; j++) {
            const struct vector e = minus(s->light[i], s->light[j]);
            const double r = sqrt(dot(e, e));
            nearest = j != i && r > 1e-6 ? fmin(nearest, r) : nearest;
        }
        sum += nearest;
    }
    return sum / s->n;
}

static void rbf(const struct set *s, double sigma, struct vector d, double *value)
{
    const double width = sigma > 0.0 ? sigma : spacing(s);
    for (int round = 0; round < 2; round++) {
        double total = 0.0;
        for (int i = 0; i < s->n; i++) {
            const struct vector e = minus(d, s->light[i]);
            value[i] = round ? value[i] : exp(-dot(e, e) / (width * width));
            total += value[i];
        }
        for (int i = 0; i < s->n; i++) {
            value[i] /= total;
            value[i] = value[i] > 0.001 || round || s->n > 200 ? value[i] : 0.0;
        }
    }
}

static void natural(const struct set *s, struct vector d, double *value)
{
    double sum = 0.0;
    for (int i = 0; i < VORONOI; i++) {
        const double z = 1.0 - (2.0 * i + 1.0) / VORONOI, r = sqrt(1.0 - z * z);
        const double phi = i * PI * (3.0 - sqrt(5.0));
        const struct vector p = {r * cos(phi), r * sin(phi), z};
        int owner = 0;
        for (int j = 1; j < s->n; j++)
            owner = dot(p, s->light[j]) > dot(p, s->light[owner]) ? j : owner;
        const double gain = dot(p, d) - dot(p, s->light[owner]);
        value[owner] += fmax(gain, 0.0);
        sum += fmax(gain, 0.0);
    }
    for (int j = 0; j < s->n; j++)
        value[j] /= sum;
}

static void trend_of_nine(const struct set *s, double ridge, struct vector d, double *value)
{
    double a[81] = {0}, b[9], row[9];
    for (int i = 0; i < s->n; i++) {
        hsh(9, s->light[i], row);
        for (int j = 0; j < 81; j++)
            a[j] += row[j / 9] * row[j % 9];
    }
    for (int j = 0; j < 9; j++)
        a[10 * j] += j ? (ridge > 0.0 ? ridge : 0.1) : 1e-9;
    hsh(9, d, b);
    solve(a, b, 9);
    for (int i = 0; i < s->n; i++) {
        hsh(9, s->light[i], row);
        for (int j = 0; j < 9; j++)
            value[i] += row[j] * b[j];
    }
}

static void octahedral(const struct set *s, double side, struct vector d, double *value)
{
    const int r = (int)lround(side > 0.0 ? side : sqrt(s->n));
    const double sum = fabs(d.x) + fabs(d.y) + fabs(d.z);
    const double u = ((d.x + d.y) / sum + 1.0) / 2.0 * (r - 1);
    const double v = ((d.y - d.x) / sum + 1.0) / 2.0 * (r - 1);
    for (int i = 0; i < s->n; i++)
        value[i] = fmax(1.0 - fabs(u - i % r), 0.0) * fmax(1.0 - fabs(v - i / r), 0.0);
}

static void interpolate(struct vector d, double *value)
{
    static struct set s;
    int n, four;
    const float *xyz = floats_of(0, "relume.lights", &n);
    const float *parameter = floats_of(0, "relume.parameter", &four);
    double p[4] = {0};
    for (int i = 0; i < 4 && four == 4; i++)
        p[i] = (double)parameter[i];
    const char *name = text_or("relume.interpolant",
                               strcmp(text_of("relume.basis"), "table") ? "chord" : "delaunay");
    if (n > 3 * MOST_POINTS)
        fail("%d lights", n / 3);
    s.n = n / 3;
    double lowest = 1.0;
    for (int i = 0; i < s.n; i++)
        s.light[i] = pole_frame(unit(
            (struct vector){(double)xyz[3 * i], (double)xyz[3 * i + 1], (double)xyz[3 * i + 2]}));
    for (int i = 0; i < s.n; i++)
        lowest = fmin(lowest, s.light[i].z);
    const int both = lowest < -0.1;  // hemispheres
    if (!strcmp(name, "delaunay"))
        delaunay(&s, d, value);
    else if (!strcmp(name, "chord"))
        kernel(&s, chord,
               (const double[]){p[0] > 0.0 ? p[0] : 1.5,
                                p[1] > 0.0 ? p[1]
                                : both     ? 1.0
                                           : 1.5,
                                p[2], p[3]},
               1, 1e-5 + p[2], d, value);
    else if (!strcmp(name, "angular"))
        kernel(&s, angular, p, both ? 4 : 3, 1e-9, d, value);
    else if (!strcmp(name, "tps"))
        kernel(&s, thin_plate, p, both ? 4 : 3, 1e-9, d, value);
    else if (!strcmp(name, "gaussian"))
        kernel(&s, gaussian, (const double[]){p[0] > 0.0 ? p[0] : 2.0 * spacing(&s)}, 1, 1e-6, d,
               value);
    else if (!strcmp(name, "rbf"))
        rbf(&s, p[0], d, value);
    else if (!strcmp(name, "natural"))
        natural(&s, d, value);
    else if (!strcmp(name, "octahedral"))
        octahedral(&s, p[0], d, value);
    else if (!strcmp(name, "hsh"))
        trend_of_nine(&s, p[0], d, value);
    else
        fail("interpolant %s", name);
}

// ---------------------------------------------------------------- decoding

static double between(struct vector a, struct vector b)
{
    return 2.0 * asin(0.5 * sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) +
                                 (a.z - b.z) * (a.z - b.z)));
}

// How far caps about the lights reach along each of 256 azimuths of the stereographic plane.
static void find_reach(double *reach, double part)
{
    int n;
    const float *xyz = floats_of(0, "relume.lights", &n);
    for (int s = 0; s < 256; s++)
        reach[s] = -1e9;
    for (int i = 0; i < n / 3; i++) {
        const struct vector l = pole_frame(unit(
            (struct vector){(double)xyz[3 * i], (double)xyz[3 * i + 1], (double)xyz[3 * i + 2]}));
        double nearest = M_PI / 3.0;
        for (int j = 0; j < n / 3; j++) {
            const struct vector m = pole_frame(unit((struct vector){
                (double)xyz[3 * j], (double)xyz[3 * j + 1], (double)xyz[3 * j + 2]}));
            nearest = between(l, m) > 1e-3 ? fmin(nearest, between(l, m)) : nearest;
        }
        const double cap = fmax(part * nearest, M_PI / 90.0), theta = acos(fmin(l.z, 1.0));
        const double low = tan((theta - cap) / 2.0);
        const double high = tan(fmin(theta + cap, 17.0 / 18.0 * M_PI) / 2.0);
        for (int s = 0; s < 256; s++)
            reach[s] =
                fmax(reach[s], (high - low) / 2.0 +
                                   (high + low) / 2.0 * cos(s * M_PI / 128.0 - atan2(l.y, l.x)));
    }
}

// Beyond the lights of one planar hemisphere: `d` moves to their edge; the share that is left.
static double captured(struct vector *d)
{
    static double reach[256];
    const char *name =
        text_or("relume.interpolant", strcmp(text_of("relume.basis"), "table") ? "" : "delaunay");
    int n;
    (void)floats_of(0, "relume.lights", &n);
    if (!int_of("relume.hemispherical") || strcmp(text_of("relume.pole"), "z") || n / 3 < 4)
        return 1.0;
    const int bounded = !strcmp(name, "delaunay") || !strcmp(name, "natural") ||
                        !strcmp(name, "gaussian") || !strcmp(name, "rbf") ||
                        !strcmp(name, "octahedral");
    find_reach(reach, bounded ? 0.25 : 0.5);
    const double at = (atan2(d->y, d->x) / (2.0 * M_PI) + 1.0) * 256.0;
    double border = 0.0;
    for (int side = 0; side < 2; side++) {
        double radius = 1e9;
        for (int s = 0; s < 256; s++) {
            if (reach[s] <= 0.0)
                return 1.0;  // about another middle than the pole: not read here
            const double along = cos((floor(at) + side - s) * M_PI / 128.0);
            radius = along > 1e-3 ? fmin(radius, reach[s] / along) : radius;
        }
        border += (side ? at - floor(at) : 1.0 - (at - floor(at))) * 2.0 * atan(radius);
    }
    const double r = hypot(d->x, d->y), z = d->z;
    if (atan2(r, z) <= border)
        return 1.0;
    *d = (struct vector){sin(border) * d->x / r, sin(border) * d->y / r, cos(border)};
    return d->z > 0.0 ? (z + 0.05) / (d->z + 0.05) : 1.0;
}

// What the coefficients multiply, stored[3][k], and the constants. Returns the share of the light.
static double functions(int k, struct vector light, double *stored, double *constant)
{
    struct vector d = pole_frame(unit(light));
    const int hemispherical = int_of("relume.hemispherical");
    if (hemispherical && d.z < 0.0)
        d = unit((struct vector){d.x, d.y, 0.0});
    const double share = captured(&d);
    int n, size, means;
    (void)floats_of(0, "relume.lights", &n);
    const float *transform = floats_of(0, "relume.transform", &size);
    const float *mean = floats_of(0, "relume.mean", &means);
    const char *name = text_of("relume.basis");
    const int pca = !strcmp(name, "pca"), eigen = !strcmp(name, "eigen");
    const int raw = pca || eigen || !strcmp(name, "table") ? n / 3 : k;
    double *value = calloc((size_t)raw, sizeof *value);
    if (!strcmp(name, "sh"))
        sh(k, d, value);
    else if (!strcmp(name, "ptm"))
        ptm(k, d, value);
    else if (!strcmp(name, "hsh"))
        hsh(k, d, value);
    else if (!strcmp(name, "dct") || !strcmp(name, "dct-resampled"))
        dct(k, hemispherical, d, value);
    else if (!strcmp(name, "table") || pca || eigen)
        interpolate(d, value);
    else
        fail("basis %s", name);
    if ((pca && size != 3 * k * raw) || (!pca && size && size != k * raw))
        fail("%d numbers of a transform", size);
    for (int c = 0; c < 3; c++) {
        const float *matrix = pca ? transform + c * k * raw : transform;
        for (int i = 0; i < k; i++) {
            stored[c * k + i] = size ? 0.0 : value[i];
            for (int j = 0; size && j < raw; j++)
                stored[c * k + i] += (double)matrix[i * raw + j] * value[j];
        }
        for (int j = 0; means && j < raw; j++)
            constant[c] += (double)mean[c * raw + j] * value[j];
    }
    free(value);
    return share;
}

static double linearised(double v)
{
    const char *display = text_of("relume.display");
    const double a = fabs(v);
    if (!strcmp(text_of("relume.domain"), "linear"))
        return v;
    if (!strncmp(display, "gamma:", 6))
        return copysign(pow(a, atof(display + 6)), v);
    if (!strncmp(display, "log:", 4))
        return atof(display + 4) * (pow(1.0 + 1.0 / atof(display + 4), v) - 1.0);
    return copysign(a <= 0.04045 ? a / 12.92 : pow((a + 0.055) / 1.055, 2.4), v);
}

// ---------------------------------------------------------------- coefficients

enum { MOST = 3 * 4096 + 3 };
static double coefficient[MOST];  // by plane
static int k, shared, luminance, planes;

// A channel of planes or of a codebook that covers planes from `first` on: what it adds, and to
// what.
static void add_number(const char *name, double code, const float *scale, const float *offset,
                       int numbers, int first)
{
    int number = 0;
    char letter = 0;
    const int colours = sscanf(name, "colour.%c", &letter) == 1;
    const int words = sscanf(name, "c%4d.%c", &number, &letter);
    const int triple = 3 * number, wide = letter == 'Y' || letter == 'U' || letter == 'V';
    const int c = letter == 'R' ? 0 : letter == 'G' ? 1 : 2;
    if (number >= k || (!colours && words != (shared ? 1 : 2)))
        fail("channel %s", name);
    const int plane = colours ? k + c : shared ? number : triple + (wide ? 0 : c);
    const int d = letter == 'Y' ? number - first / 3
                  : wide        ? 2 * (number - first / 3) + (letter == 'V')
                                : plane - first;
    if (d < 0 || d >= numbers)
        fail("channel %s is number %d of %d", name, d, numbers);
    const double v = code * (double)scale[d] + (double)offset[d];
    if (!wide)
        coefficient[plane] += v;
    for (int each = 0; wide && each < 3; each++) {
        static const double u_part[] = {1, 0, -1}, v_part[] = {1, -2, 1};
        coefficient[triple + each] += letter == 'Y'   ? v / sqrt(3)
                                      : letter == 'U' ? v * u_part[each] / sqrt(2)
                                                      : v * v_part[each] / sqrt(6);
    }
}

static void add_part(int part, int x, int y, int first)
{
    static const char *name[MOST];
    static float code[MOST];
    int scales, offsets;
    const float *scale = floats_of(part, "relume.scale", &scales);
    const float *offset = floats_of(part, "relume.offset", &offsets);
    const int channels = read_pixel(part, x, y, name, code, MOST);
    if (scales != channels || offsets != channels)
        fail("%d channels, %d scales", channels, scales);
    for (int i = 0; i < channels; i++)
        add_number(name[i], (double)code[i], scale, offset, scales, first);
}

// Whether the view's mask, if it has one, shows the pixel.
static int is_shown(const char *view, int x, int y)
{
    char name[64];
    const char *channel;
    float value = 1.0f;
    snprintf(name, sizeof name, "%s.mask", view);
    const int part = look_for_part(name);
    if (part >= 0)
        read_pixel(part, x, y, &channel, &value, 1);
    return value > 0.5f;
}

static void add_books(int part, const char *view, int x, int y)
{
    const char *name[8];
    float index[8];
    const int books = read_pixel(part, x, y, name, index, 8);
    for (int b = 0; b < books; b++) {
        char wanted[64], channel[16];
        snprintf(channel, sizeof channel, "i%d", b);
        if (strcmp(name[b], channel))
            fail("channel %s; expected %s", name[b], channel);
        snprintf(wanted, sizeof wanted, "book%d", b);
        int book = look_for_part(wanted);
        if (book < 0) {
            snprintf(wanted, sizeof wanted, "%s.book%d", view, b);
            book = find_part(wanted);
        }
        add_part(book, (int)index[b], 0, int_of_part(book, "relume.first"));
    }
}

// ---------------------------------------------------------------- rays

static struct vector turned(const float *axes, double a, double b, double c)
{
    const double v[3] = {a, b, c};
    double w[3] = {0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            w[j] += v[i] * (double)axes[3 * i + j];
    return (struct vector){w[0], w[1], w[2]};
}

// Where the middle of a pixel of a slab looks, as `relume query` takes it.
static void print_ray(int view, int part, int x, int y)
{
    static const float world[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    exr_attr_box2i_t window;
    if (exr_get_data_window(file, part, &window))
        fail("no window");
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    const int several = attribute(0, "relume.pose", EXR_ATTR_FLOAT_VECTOR) != NULL;
    const int slab = several ? int_of_part(part, "relume.member") : 0;
    int n;
    const float *g = floats_of(0, "relume.slab", &n) + 6 * slab;
    const float *uv = floats_of(0, "relume.uv", &n) + 2 * view;
    const float *pose = several ? floats_of(0, "relume.pose", &n) + 12 * slab : world;
    if (several && (int_of("relume.version") != 2 || slab < 0 || slab >= n / 12))
        fail("slab %d", slab);
    const double s = g[2] + (x + 0.5) / width * (g[4] - g[2]);
    const double t = g[5] - (y + 0.5) / height * (g[5] - g[3]);
    const struct vector eye = turned(pose + 3, uv[0], uv[1], g[0]);
    const struct vector way = turned(pose + 3, s - uv[0], t - uv[1], g[1] - g[0]);
    printf("--eye %.9f,%.9f,%.9f --direction=%.9f,%.9f,%.9f\n", eye.x + pose[0], eye.y + pose[1],
           eye.z + pose[2], way.x, way.y, way.z);
}

// Attributes that OpenEXR wants equal in all parts. The C library does not look at them, the C++
// library opens no file in which they differ.
static void check_shared(int part)
{
    exr_attr_box2i_t first, window;
    float first_aspect, aspect;
    if (exr_get_display_window(file, 0, &first) || exr_get_display_window(file, part, &window) ||
        exr_get_pixel_aspect_ratio(file, 0, &first_aspect) ||
        exr_get_pixel_aspect_ratio(file, part, &aspect))
        fail("part %d has no display window or pixel aspect ratio", part);
    if (memcmp(&first, &window, sizeof first))
        fail("part %d: another displayWindow than part 0", part);
    if (first_aspect != aspect)
        fail("part %d: another pixelAspectRatio than part 0", part);
    static const char *const absent[] = {"timeCode", "chromaticities"};
    const exr_attribute_t *a;
    for (int i = 0; i < 2; i++)
        if (!exr_get_attribute_by_name(file, part, absent[i], &a))
            fail("part %d has %s; expected none in any part", part, absent[i]);
}

static void check_container(const char *path)
{
    exr_context_initializer_t strict = EXR_DEFAULT_CONTEXT_INITIALIZER;
    strict.flags = EXR_CONTEXT_FLAG_STRICT_HEADER;
    if (exr_start_read(&file, path, &strict))
        fail("%s: the header is refused when it is read strictly", path);
    int count = 0;
    if (exr_get_count(file, &count) || count < 1)
        fail("no parts");
    for (int part = 0; part < count; part++) {
        const char *name;
        check_shared(part);
        for (int other = 0; count > 1 && other < part; other++)
            if (exr_get_name(file, part, &name) || look_for_part(name) != part)
                fail("part %d: its name is not its own", part);
    }
    exr_finish(&file);
}

int main(int argc, char **argv)
{
    if (argc == 2) {
        check_container(argv[1]);
        return 0;
    }
    if (argc != 8 && argc != 5)
        fail("usage: decode FILE [VIEW X Y [LX LY LZ]]");
    if (exr_start_read(&file, argv[1], NULL))
        fail("%s cannot be opened", argv[1]);
    if (strcmp(text_of("relume.format"), "relume") || int_of("relume.version") < 1 ||
        int_of("relume.version") > 3)
        fail("%s: no relume file of version 1 to 3", argv[1]);
    char view[32];
    snprintf(view, sizeof view, "view%04d", atoi(argv[2]));
    const int part = find_part(view), x = atoi(argv[3]), y = atoi(argv[4]);
    if (argc == 5) {
        print_ray(atoi(argv[2]), part, x, y);
        exr_finish(&file);
        return 0;
    }
    k = int_of("relume.coefficients");
    luminance = !strcmp(text_or("relume.colour", "rgb"), "luminance");
    shared = luminance || !strcmp(text_of("relume.basis"), "pca");
    planes = luminance ? k + 3 : shared ? k : 3 * k;
    if (attribute(0, "relume.books", EXR_ATTR_INT) && int_of("relume.books"))
        add_books(part, view, x, y);
    else
        add_part(part, x, y, 0);

    double *weight = calloc(3 * (size_t)k, sizeof *weight), rgb[3] = {0};
    const double share =
        functions(k, (struct vector){atof(argv[5]), atof(argv[6]), atof(argv[7])}, weight, rgb);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < k; i++)
            rgb[c] += weight[c * k + i] * coefficient[shared ? i : 3 * i + c];
        rgb[c] = share * linearised(rgb[c] * (luminance ? coefficient[k + c] : 1.0));
        rgb[c] = is_shown(view, x, y) ? rgb[c] : 0.0;
    }
    printf("%.9g %.9g %.9g\n", rgb[0], rgb[1], rgb[2]);
    free(weight);
    exr_finish(&file);
    return 0;
}
