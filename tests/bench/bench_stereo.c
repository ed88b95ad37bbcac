// How far normals are from the truth, on objects of DiLiGenT (Shi et al. 2016).
//
//   bench_stereo [FOLDER]
//
// FOLDER (default ../shared/data/diligent) holds ball and bear: 001.png ... 096.png, mask.png,
// light_directions.txt, light_intensities.txt and normals.npy. Mean angle in degrees for all
// lights, over five draws of ten of them, and where the lamps' brightness is not known.
#define RELUME_VEC3_SHORT
#include "capture/acquire/photometric.h"
#include "capture/acquire/refine.h"

#include <relume/extensions.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LIGHTS = 96, DRAWS = 5, FEW = 10 };

struct object {
    struct relume_vec3 direction[LIGHTS], intensity[LIGHTS];
    struct relume_image mask, photograph[LIGHTS];
    float *truth;     // [height][width][3]
    bool by_columns;  // [3][width][height]: what numpy calls the order of Fortran
};

static void must(relume_status status, const char *what)
{
    if (!status)
        return;
    fprintf(stderr, "bench_stereo: %s: %s\n", what, relume_status_text(status));
    exit(1);
}

static FILE *open_in(const char *folder, const char *object, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s/%s", folder, object, name);
    return fopen(path, "rb");
}

static bool read_table(struct relume_vec3 *to, const char *folder, const char *object,
                       const char *name)
{
    FILE *f = open_in(folder, object, name);
    int n = 0;
    while (f && n < LIGHTS && fscanf(f, "%lf %lf %lf", &to[n].x, &to[n].y, &to[n].z) == 3)
        n++;
    if (f)
        fclose(f);
    return n == LIGHTS;
}

static void load_picture(struct relume_image *out, const char *folder, const char *object,
                         const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s/%s", folder, object, name);
    must(relume_image_load(out, path, relume_image_params(.transfer.curve = RELUME_CURVE_LINEAR)),
         path);
}

static bool load(struct object *o, const char *folder, const char *name)
{
    char file[16];
    if (!read_table(o->direction, folder, name, "light_directions.txt") ||
        !read_table(o->intensity, folder, name, "light_intensities.txt"))
        return false;
    load_picture(&o->mask, folder, name, "mask.png");
    for (int i = 0; i < LIGHTS; i++) {
        snprintf(file, sizeof file, "%03d.png", i + 1);
        load_picture(o->photograph + i, folder, name, file);
    }
    char header[128] = "";
    const size_t bytes = sizeof(float) * 3 * (size_t)o->mask.width * (size_t)o->mask.height;
    FILE *f = open_in(folder, name, "normals.npy");
    o->truth = malloc(bytes);
    const bool read = f && o->truth && fread(header, 1, sizeof header - 1, f) &&
                      !fseek(f, -(long)bytes, SEEK_END) && fread(o->truth, 1, bytes, f) == bytes;
    if (f)
        fclose(f);
    o->by_columns = strstr(header + 10, "'fortran_order': True");
    return read;
}

static double mean_angle(const struct relume_image *normal, const struct object *o,
                         const float *mask)
{
    double sum = 0.0, n = 0.0;
    const size_t width = (size_t)normal->width, height = (size_t)normal->height;
    for (size_t k = 0; k < width * height; k++) {
        const float *a = normal->data + 3 * k;
        const float *b = o->truth + (o->by_columns ? k % width * height + k / width : 3 * k);
        const size_t step = o->by_columns ? width * height : 1;
        const double c = (double)(a[0] * b[0] + a[1] * b[step] + a[2] * b[2 * step]);
        if (mask[k] > 0.5f) {
            sum += acos(fmax(fmin(c, 1.0), -1.0)) * 180.0 / M_PI;
            n += 1.0;
        }
    }
    return sum / n;
}

static relume_capture *create(int width, int height, int lights, struct relume_vec3 *direction,
                              float (*intensity)[3], float *data, float *mask)
{
    relume_capture *capture;
    must(relume_capture_create(
             &capture,
             &(struct relume_manifest){.geometry =
                                           relume_geometry_default(RELUME_PLANAR, width, height),
                                       .lights = lights,
                                       .directions = direction,
                                       .intensities = (const float(*)[3])intensity},
             &(struct relume_pictures){
                 .width = width, .height = height, .channels = 3, .data = data, .mask = mask},
             NULL),
         "capture");
    return capture;
}

// What the fit is told of the lamps' brightness, and by what it fits.
enum way { TOLD, LEAST_SQUARES, UNTOLD, ESTIMATED };

static double measure(const struct object *o, const int *light, int lights, enum way way)
{
    const int width = o->mask.width, height = o->mask.height;
    const size_t pixels = (size_t)width * (size_t)height;
    float *data = malloc(sizeof(float) * 3 * pixels * (size_t)lights);
    float *mask = malloc(sizeof(float) * pixels);
    struct relume_vec3 direction[LIGHTS];
    float intensity[LIGHTS][3];
    must(data && mask ? RELUME_OK : RELUME_ENOMEM, "memory");
    for (size_t k = 0; k < pixels; k++)
        mask[k] = o->mask.data[k * (size_t)o->mask.channels];
    for (int i = 0; i < lights; i++) {
        const struct relume_vec3 rgb = o->intensity[light[i]];
        direction[i] = o->direction[light[i]];
        intensity[i][0] = way < UNTOLD ? (float)rgb.x : 1.0f;
        intensity[i][1] = way < UNTOLD ? (float)rgb.y : 1.0f;
        intensity[i][2] = way < UNTOLD ? (float)rgb.z : 1.0f;
        for (size_t k = 0; k < 3 * pixels; k++)
            data[3 * pixels * (size_t)i + k] = 8.0f * o->photograph[light[i]].data[k];
    }
    struct relume_photometric fit;
    relume_capture *capture = create(width, height, lights, direction, intensity, data, mask);
    if (way == ESTIMATED) {
        double found[LIGHTS], residual[2];
        must(relume_acquire_refine(direction, found, residual, capture,
                                   relume_acquire_refine_params(.brightness = true)),
             "brightness");
        relume_capture_destroy(&capture);
        for (int i = 0; i < lights; i++)
            for (int c = 0; c < 3; c++)
                intensity[i][c] = (float)found[i];
        capture = create(width, height, lights, direction, intensity, data, mask);
    }
    must(relume_photometric_fit(&fit, capture, 0,
                                relume_photometric_params(.plain = way == LEAST_SQUARES)),
         "fit");
    const double angle = mean_angle(&fit.normal, o, mask);
    relume_photometric_destroy(&fit);
    relume_capture_destroy(&capture);
    free(data);
    free(mask);
    return angle;
}

// `few` of all lights, the same ones for the same draw.
static void draw(int *light, unsigned seed)
{
    for (int i = 0; i < LIGHTS; i++)
        light[i] = i;
    for (int i = 0; i < FEW; i++) {
        seed = seed * 1664525u + 1013904223u;
        const int k = i + (int)((seed >> 8) % (unsigned)(LIGHTS - i)), kept = light[i];
        light[i] = light[k];
        light[k] = kept;
    }
}

int main(int argc, char **argv)
{
    static const char *const names[] = {"ball", "bear"};
    const char *folder = argc > 1 ? argv[1] : "../shared/data/diligent";
    for (int n = 0; n < 2; n++) {
        static struct object o;
        int light[LIGHTS];
        double few = 0.0;
        if (!load(&o, folder, names[n])) {
            printf("skipped: normals of DiLiGenT: no %s in %s\n", names[n], folder);
            return 0;
        }
        for (int k = 0; k < DRAWS; k++) {
            draw(light, (unsigned)k + 1);
            few += measure(&o, light, FEW, TOLD) / DRAWS;
        }
        draw(light, 1);
        printf("normals of %s: %.2f degrees, least squares %.2f; of ten lights %.2f; brightness of "
               "lamps not told %.2f, estimated %.2f\n",
               names[n], measure(&o, light, LIGHTS, TOLD),
               measure(&o, light, LIGHTS, LEAST_SQUARES), few, measure(&o, light, LIGHTS, UNTOLD),
               measure(&o, light, LIGHTS, ESTIMATED));
        relume_image_destroy(&o.mask);
        for (int i = 0; i < LIGHTS; i++)
            relume_image_destroy(o.photograph + i);
        free(o.truth);
    }
    return 0;
}
