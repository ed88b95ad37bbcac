// change_scene.c - writes a capture of a relief that is known in closed form, as some camera and
// some lamps see it, and with or without a scratch and a stain
//
//   change_scene DIR [--size W H] [--lights N] [--seed S] [--gain R G B] [--noise D] [--gloss G]
//                [--homography A B C D E F G H] [--roll DEG] [--scratch] [--stain] [--polish]
//                [--truth PNG]
//
// The homography takes pixels of this camera to those of the first (its last entry is 1); the roll
// is by how much the camera is turned with it, counter-clockwise. The truth has red where the
// scratch is and green where the stain is, in pixels of this camera.
#define RELUME_VEC3_SHORT
#include <relume/extensions.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

struct scene {
    const char *folder, *truth;
    int width, height, lights, seed;
    double gain[3], noise, gloss, roll, h[9];
    bool scratch, stain, polish;
};

static uint64_t mix(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

static double random_of(uint64_t a, uint64_t b, uint64_t c)
{
    return (double)(mix(a ^ mix(b ^ mix(c))) >> 11) * 0x1p-53;
}

// Noise of a lattice, smooth, in [0, 1].
static double lattice(int kind, double x, double y)
{
    const double i = floor(x), j = floor(y), u = x - i, v = y - j;
    const double s = u * u * u * (u * (6 * u - 15) + 10), t = v * v * v * (v * (6 * v - 15) + 10);
    double corner[4];
    for (int k = 0; k < 4; k++)
        corner[k] = random_of((uint64_t)kind, (uint64_t)(int64_t)(i + k % 2),
                              (uint64_t)(int64_t)(j + k / 2) + 977);
    return (corner[0] * (1 - s) + corner[1] * s) * (1 - t) +
           (corner[2] * (1 - s) + corner[3] * s) * t;
}

static double octaves(int kind, double x, double y)
{
    double sum = 0.0;
    for (int k = 0; k < 4; k++)
        sum += lattice(kind + k, x * (1 << k), y * (1 << k)) / (1 << k);
    return sum / 1.875;
}

// Places are pixels of the first camera over its width, y downwards.
static double scratch_at(double x, double y)
{
    const double ax = 0.22, ay = 0.25, bx = 0.45, by = 0.33, dx = bx - ax, dy = by - ay;
    const double t = fmin(fmax(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0.0), 1.0);
    return hypot(x - ax - t * dx, y - ay - t * dy);
}

static double stain_at(double x, double y)
{
    return hypot((x - 0.68) / 0.07, (y - 0.5) / 0.05);
}

static double height_at(const struct scene *s, double x, double y)
{
    const double ring = hypot(x - 0.5, y - 0.4) - 0.25;
    double h = 0.05 * octaves(1, 6 * x, 6 * y) + 0.02 * exp(-ring * ring / 8e-4);
    h -= 0.006 * exp(-pow(sin(38.0 * (x + 0.3 * y)), 2.0) / 0.15) *
         fmin(fmax((0.28 - x) / 0.05, 0.0), 1.0);  // grooves
    if (s->scratch) {
        const double d = scratch_at(x, y) / 0.006;
        h -= 0.003 * exp(-d * d);
    }
    return h;
}

static vec3 normal_at(const struct scene *s, double x, double y)
{
    const double e = 1e-3;
    const double dx = (height_at(s, x + e, y) - height_at(s, x - e, y)) / (2 * e),
                 dy = (height_at(s, x, y + e) - height_at(s, x, y - e)) / (2 * e);
    return vec3_unit((vec3){-dx, dy, 1.0});
}

static void albedo_at(double rgb[3], const struct scene *s, double x, double y)
{
    const double a = octaves(20, 9 * x, 9 * y), b = octaves(40, 4 * x, 4 * y);
    const double spot = octaves(60, 14 * x, 14 * y) > 0.62 ? 0.55 : 1.0;
    rgb[0] = spot * (0.25 + 0.5 * a), rgb[1] = spot * (0.2 + 0.4 * a + 0.1 * b),
    rgb[2] = spot * (0.15 + 0.25 * a + 0.25 * b);
    if (s->stain) {
        const double t = fmin(fmax((1.1 - stain_at(x, y)) / 0.2, 0.0), 1.0);
        rgb[0] *= 1.0 - 0.12 * t, rgb[1] *= 1.0 - 0.2 * t, rgb[2] *= 1.0 - 0.3 * t;
    }
}

// Where a pixel of this camera lies on the object.
static void place(double p[2], const struct scene *s, double x, double y)
{
    const double *h = s->h, z = h[6] * x + h[7] * y + 1.0;
    p[0] = (h[0] * x + h[1] * y + h[2]) / z / s->width;
    p[1] = (h[3] * x + h[4] * y + h[5]) / z / s->width;
}

static vec3 turn(vec3 v, double deg)
{
    const double c = cos(deg * 0.017453292519943295), t = sin(deg * 0.017453292519943295);
    return (vec3){c * v.x - t * v.y, t * v.x + c * v.y, v.z};
}

static vec3 light_of(const struct scene *s, int i)
{
    const double z = 0.25 + 0.7 * (i + 0.5) / s->lights, r = sqrt(1 - z * z);
    const double phi =
        2.399963229728653 * i + 6.283185307179586 * random_of((uint64_t)s->seed, 1, 1);
    return (vec3){r * cos(phi), r * sin(phi), z};
}

// Where it was polished highlights are three times as bright.
static double gloss_at(const struct scene *s, size_t k)
{
    double p[2];
    place(p, s, (double)(k % (size_t)s->width) + 0.5, (double)(k / (size_t)s->width) + 0.5);
    return s->gloss * (s->polish && stain_at(p[0], p[1]) < 1.0 ? 3.0 : 1.0);
}

static bool save_light(const struct scene *s, int i, const vec3 *normal, const float *albedo)
{
    char path[4096];
    struct relume_image image;
    const vec3 light = turn(light_of(s, i), s->roll);  // of the object
    const vec3 half = vec3_unit(vec3_add(light, (vec3){0, 0, 1}));
    if (relume_image_create(&image, s->width, s->height, 3))
        return false;
    for (size_t k = 0; k < (size_t)s->width * (size_t)s->height; k++) {
        const double cosine = fmax(vec3_dot(normal[k], light), 0.0);
        const double lobe =
            cosine > 0.0 ? gloss_at(s, k) * pow(fmax(vec3_dot(normal[k], half), 0.0), 60.0) : 0.0;
        for (size_t c = 0; c < 3; c++) {
            double sum = -6.0;  // twelve uniform ones are about normal
            for (uint64_t j = 0; s->noise > 0.0 && j < 12; j++)
                sum += random_of((uint64_t)s->seed * 4096 + (uint64_t)i, 3 * k + c, j);
            image.data[3 * k + c] =
                (float)(s->gain[c] * ((double)albedo[3 * k + c] * cosine + lobe) +
                        (s->noise > 0.0 ? s->noise * sum : 0.0));
        }
    }
    snprintf(path, sizeof path, "%s/light%03d.png", s->folder, i);
    const bool good = !relume_image_save(&image, path, NULL);
    relume_image_destroy(&image);
    return good;
}

static bool save_truth(const struct scene *s)
{
    struct relume_image image;
    if (!s->truth)
        return true;
    if (relume_image_create(&image, s->width, s->height, 3))
        return false;
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            float *to = image.data + 3 * ((size_t)y * (size_t)s->width + (size_t)x);
            double p[2];
            place(p, s, x + 0.5, y + 0.5);
            to[0] = scratch_at(p[0], p[1]) < 0.01 ? 1.0f : 0.0f;
            to[1] = stain_at(p[0], p[1]) < 1.0 ? 1.0f : 0.0f;
        }
    const bool good = !relume_image_save(&image, s->truth, NULL);
    relume_image_destroy(&image);
    return good;
}

static bool save_lp(const struct scene *s)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/lights.lp", s->folder);
    FILE *f = fopen(path, "w");
    if (!f)
        return false;
    fprintf(f, "%d\n", s->lights);
    for (int i = 0; i < s->lights; i++) {
        const vec3 l = light_of(s, i);
        fprintf(f, "light%03d.png %.9f %.9f %.9f\n", i, l.x, l.y, l.z);
    }
    return !fclose(f);
}

static bool save(const struct scene *s)
{
    const size_t n = (size_t)s->width * (size_t)s->height;
    vec3 *normal = malloc(n * sizeof *normal);
    float *albedo = malloc(3 * n * sizeof *albedo);
    bool good = normal && albedo && (!mkdir(s->folder, 0777) || errno == EEXIST);
    for (size_t k = 0; good && k < n; k++) {
        double p[2], rgb[3];
        place(p, s, (double)(k % (size_t)s->width) + 0.5, (double)(k / (size_t)s->width) + 0.5);
        normal[k] = normal_at(s, p[0], p[1]);
        albedo_at(rgb, s, p[0], p[1]);
        for (size_t c = 0; c < 3; c++)
            albedo[3 * k + c] = (float)rgb[c];
    }
    for (int i = 0; good && i < s->lights; i++)
        good = save_light(s, i, normal, albedo);
    free(normal);
    free(albedo);
    return good && save_lp(s) && save_truth(s);
}

static int take(double *to, int count, char **argv, int at, int argc)
{
    for (int k = 0; k < count && at + 1 + k < argc; k++)
        to[k] = atof(argv[at + 1 + k]);
    return count;
}

int main(int argc, char **argv)
{
    struct scene s = {.width = 160,
                      .height = 128,
                      .lights = 24,
                      .seed = 1,
                      .gain = {1, 1, 1},
                      .h = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    double two[2];
    if (argc < 2 || argv[1][0] == '-')
        return fprintf(stderr, "usage: change_scene DIR [OPTION ...]\n"), 2;
    s.folder = argv[1];
    for (int i = 2; i < argc; i++) {
        const char *o = argv[i];
        if (!strcmp(o, "--scratch"))
            s.scratch = true;
        else if (!strcmp(o, "--stain"))
            s.stain = true;
        else if (!strcmp(o, "--polish"))
            s.polish = true;
        else if (!strcmp(o, "--truth") && i + 1 < argc)
            s.truth = argv[++i];
        else if (!strcmp(o, "--size"))
            i += take(two, 2, argv, i, argc), s.width = (int)two[0], s.height = (int)two[1];
        else if (!strcmp(o, "--lights"))
            i += take(two, 1, argv, i, argc), s.lights = (int)two[0];
        else if (!strcmp(o, "--seed"))
            i += take(two, 1, argv, i, argc), s.seed = (int)two[0];
        else if (!strcmp(o, "--gain"))
            i += take(s.gain, 3, argv, i, argc);
        else if (!strcmp(o, "--noise"))
            i += take(&s.noise, 1, argv, i, argc);
        else if (!strcmp(o, "--gloss"))
            i += take(&s.gloss, 1, argv, i, argc);
        else if (!strcmp(o, "--roll"))
            i += take(&s.roll, 1, argv, i, argc);
        else if (!strcmp(o, "--homography"))
            i += take(s.h, 8, argv, i, argc);
        else
            return fprintf(stderr, "change_scene: unknown option %s\n", o), 2;
    }
    return save(&s) ? 0 : 1;
}
