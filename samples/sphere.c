// sphere.c - writes a small capture whose every pixel is known in closed form: a Lambertian sphere
// with a Phong lobe over a floor on which it throws a hard shadow. Uses the public headers only.
//
//   sphere DIR [--size N] [--rows N] [--lights N] [--pattern P] [--seed S] [--hemisphere] [--views
//   G]
//              [--format exr|png|jpg|tif] [--shade full|lambert|wrap] [--grey] [--mask]
//              [--intensities] [--half]
//
// Pictures are --size pixels wide; --rows cuts a strip of that many rows from their middle.
// Shades: `full` is Lambert + lobe + shadow; `lambert` is albedo max(0, n.l); `wrap` is
// albedo (1 + n.l) / 2, which four spherical harmonics hold exactly.
#define RELUME_VEC3_SHORT
#include <relume/extensions.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum shade { FULL, LAMBERT, WRAP };

struct options {
    const char *folder, *format, *pattern;
    int size, rows, lights, views, seed;
    bool hemisphere, grey, mask, intensities, half;
    enum shade shade;
};

static const vec3 center = {0.0, 0.0, 0.5};
static const double radius = 0.45, camera_z = 4.0, uv_z = 3.0;

// Distance to the sphere along unit `d`, or a negative number.
static double hit_sphere(vec3 p, vec3 d)
{
    const vec3 m = vec3_sub(p, center);
    const double b = vec3_dot(m, d), c = vec3_dot(m, m) - radius * radius, q = b * b - c;
    return q < 0.0 ? -1.0 : -b - sqrt(q);
}

struct hit {
    vec3 at, normal;
    double distance;
    bool sphere;
};

static struct hit trace(vec3 eye, vec3 d)
{
    const double t = hit_sphere(eye, d);
    if (t > 0.0) {
        const vec3 at = vec3_along(eye, d, t);
        return (struct hit){at, vec3_unit(vec3_sub(at, center)), t, true};
    }
    const double floor_t = -eye.z / d.z;
    return (struct hit){vec3_along(eye, d, floor_t), {0.0, 0.0, 1.0}, floor_t, false};
}

static void shade(const struct options *o, const struct hit *h, vec3 view, vec3 light, float rgb[3])
{
    static const double sphere_albedo[3] = {0.8, 0.5, 0.3};
    const bool dark = ((int)floor(h->at.x * 4.0) + (int)floor(h->at.y * 4.0)) & 1;
    const double n_l = vec3_dot(h->normal, light);
    double diffuse = o->shade == WRAP ? 0.5 * (1.0 + n_l) : fmax(n_l, 0.0), lobe = 0.0;
    if (o->shade == FULL && !h->sphere && hit_sphere(h->at, light) > 0.0)
        diffuse = 0.0;
    if (o->shade == FULL && h->sphere && n_l > 0.0) {
        const vec3 mirrored =
            vec3_along(vec3_sub((vec3){0.0, 0.0, 0.0}, light), h->normal, 2.0 * n_l);
        lobe = 0.5 * pow(fmax(-vec3_dot(mirrored, view), 0.0), 20.0);
    }
    for (int c = 0; c < 3; c++) {
        const double albedo = !h->sphere ? dark ? 0.35 : 0.6 : sphere_albedo[o->grey ? 1 : c];
        rgb[c] = (float)(albedo * diffuse + lobe);
    }
}

// The ray of pixel (x, y); orthographic without a grid of views.
static void ray(const struct options *o, const double uv[2], int x, int y, vec3 *eye, vec3 *d)
{
    const double s = -1.0 + 2.0 * (x + 0.5) / o->size, t = (o->rows - 2.0 * (y + 0.5)) / o->size;
    if (o->views) {
        *eye = (vec3){uv[0], uv[1], uv_z};
        *d = vec3_unit((vec3){s - uv[0], t - uv[1], -uv_z});
    } else {
        *eye = (vec3){s, t, camera_z};
        *d = (vec3){0.0, 0.0, -1.0};
    }
}

static void fail(const char *what, const char *path)
{
    fprintf(stderr, "sphere: %s: %s\n", path, what);
    exit(1);
}

static void save(const struct options *o, const struct relume_image *image, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", o->folder, name);
    if (relume_image_save(image, path, relume_image_params(.half = o->half)))
        fail("cannot be written", path);
}

static struct relume_image new_image(const struct options *o, int channels)
{
    struct relume_image image;
    if (relume_image_create(&image, o->size, o->rows, channels))
        fail("out of memory", o->folder);
    return image;
}

static char *name_of(const char *format, int view, int light, const char *extension)
{
    char *name = malloc(64);
    if (name)
        snprintf(name, 64, format, view, light, extension);
    else
        fail("out of memory", format);
    return name;
}

static void render(const struct options *o, struct relume_manifest_view *v, int index,
                   const struct relume_manifest *m)
{
    struct relume_image image = new_image(o, 3), depth = new_image(o, 1), mask = new_image(o, 1);
    v->images = calloc((size_t)m->lights, sizeof *v->images);
    if (!v->images)
        fail("out of memory", o->folder);
    for (int i = 0; i < m->lights; i++) {
        for (int y = 0; y < o->rows; y++)
            for (int x = 0; x < o->size; x++) {
                vec3 eye, d;
                ray(o, v->uv, x, y, &eye, &d);
                const struct hit h = trace(eye, d);
                float *rgb = image.data + 3 * ((size_t)y * (size_t)o->size + (size_t)x);
                shade(o, &h, d, m->directions[i], rgb);
                for (int c = 0; c < 3 && m->intensities; c++)
                    rgb[c] *= m->intensities[i][c];
                depth.data[(size_t)y * (size_t)o->size + (size_t)x] = (float)h.distance;
                mask.data[(size_t)y * (size_t)o->size + (size_t)x] = h.sphere;
            }
        v->images[i] = name_of("view%02d/light%04d.%s", index, i, o->format);
        save(o, &image, v->images[i]);
    }
    struct options full = *o;
    full.half = false;
    v->depth = name_of("view%02d/depth%.0d.%s", index, 0, "exr");
    save(&full, &depth, v->depth);
    if (o->mask) {
        v->mask = name_of("view%02d/mask%.0d.%s", index, 0, "png");
        save(o, &mask, v->mask);
    }
    relume_image_destroy(&image);
    relume_image_destroy(&depth);
    relume_image_destroy(&mask);
}

static void make_folder(const char *format, const char *folder, int view)
{
    char path[4096];
    snprintf(path, sizeof path, format, folder, view);
    if (mkdir(path, 0777) && errno != EEXIST)
        fail(strerror(errno), path);
}

static void write_lp(const struct options *o, const struct relume_manifest *m)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/dirs.lp", o->folder);
    FILE *f = fopen(path, "w");
    if (!f)
        fail(strerror(errno), path);
    fprintf(f, "%d\n", m->lights);
    for (int i = 0; i < m->lights; i++)
        fprintf(f, "%s %.9g %.9g %.9g\n", m->view[0].images[i], m->directions[i].x,
                m->directions[i].y, m->directions[i].z);
    if (fclose(f))
        fail(strerror(errno), path);
}

static bool is(const char *a, const char *b)
{
    return !strcmp(a, b);
}

static void parse(struct options *o, int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        const char *name = argv[i], *value = i + 1 < argc ? argv[i + 1] : "";
        const bool flag = is(name, "--hemisphere") || is(name, "--grey") || is(name, "--mask") ||
                          is(name, "--intensities") || is(name, "--half");
        if (is(name, "--size"))
            o->size = atoi(value);
        else if (is(name, "--rows"))
            o->rows = atoi(value);
        else if (is(name, "--lights"))
            o->lights = atoi(value);
        else if (is(name, "--views"))
            o->views = atoi(value);
        else if (is(name, "--seed"))
            o->seed = atoi(value);
        else if (is(name, "--pattern"))
            o->pattern = value;
        else if (is(name, "--format"))
            o->format = value;
        else if (is(name, "--shade"))
            o->shade = is(value, "wrap") ? WRAP : is(value, "lambert") ? LAMBERT : FULL;
        else if (flag) {
            o->hemisphere |= is(name, "--hemisphere");
            o->grey |= is(name, "--grey");
            o->mask |= is(name, "--mask");
            o->intensities |= is(name, "--intensities");
            o->half |= is(name, "--half");
            continue;
        } else if (name[0] == '-' || o->folder) {
            fail("unknown option; usage: sphere DIR [--size N] [--lights N] ...", name);
        } else {
            o->folder = name;
            continue;
        }
        i++;
    }
    if (!o->rows)
        o->rows = o->size;
    if (!o->folder || o->size < 1 || o->rows < 1 || o->lights < 1 || o->views < 0 || o->views > 9)
        fail("usage: sphere DIR [--size N] [--lights N] ...", "options");
}

int main(int argc, char **argv)
{
    struct options o = {.size = 32, .lights = 20, .format = "exr", .pattern = "hammersley"};
    parse(&o, argc, argv);
    const int views = o.views ? o.views * o.views : 1;
    vec3 *directions = calloc((size_t)o.lights, sizeof *directions);
    float(*intensities)[3] = calloc((size_t)o.lights, sizeof *intensities);
    struct relume_manifest_view *view = calloc((size_t)views, sizeof *view);
    const struct relume_pattern *pattern = relume_pattern_find(o.pattern);
    if (!directions || !intensities || !view || !pattern ||
        relume_directions_make(
            directions, o.lights, pattern,
            relume_directions_params(.seed = (uint64_t)o.seed, .hemisphere = o.hemisphere)))
        fail("no such lights", o.pattern);
    for (int i = 0; i < o.lights; i++)
        for (int c = 0; c < 3; c++)
            intensities[i][c] = 0.25f + 1.5f * (float)((i + c) % 3);

    struct relume_manifest m = {
        .geometry = relume_geometry_default(o.views ? RELUME_SLAB : RELUME_PLANAR, o.size, o.rows),
        .lights = o.lights,
        .directions = directions,
        .intensities = o.intensities ? (const float(*)[3])intensities : NULL,
        .views = views,
        .view = view,
    };
    m.geometry.uv_z = uv_z;
    m.geometry.camera_z = camera_z;
    m.geometry.st_max[1] = (double)o.rows / o.size;
    m.geometry.st_min[1] = -m.geometry.st_max[1];
    make_folder("%s", o.folder, 0);
    for (int v = 0; v < views; v++) {
        if (o.views > 1) {
            view[v].uv[0] = -0.5 + 1.0 * (v % o.views) / (o.views - 1);
            view[v].uv[1] = -0.5 + 1.0 * (v / o.views) / (o.views - 1);
        }
        make_folder("%s/view%02d", o.folder, v);
        render(&o, &view[v], v, &m);
    }
    char path[4096];
    snprintf(path, sizeof path, "%s/capture.json", o.folder);
    if (relume_manifest_write(&m, path, NULL))
        fail("cannot be written", path);
    if (!o.views)
        write_lp(&o, &m);
    for (int v = 0; v < views; v++) {
        for (int i = 0; i < o.lights; i++)
            free((void *)(uintptr_t)view[v].images[i]);
        free(view[v].images);
        free((void *)(uintptr_t)view[v].depth);
        free((void *)(uintptr_t)view[v].mask);
    }
    free(directions);
    free(intensities);
    free(view);
    return 0;
}
