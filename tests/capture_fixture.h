// capture_fixture.h - a small capture on disk, made through the public API; for tests and fuzzers
#ifndef CAPTURE_FIXTURE_H
#define CAPTURE_FIXTURE_H

#include "image/geometry/geometry.h"

#include <math.h>
#include <relume/extensions.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct fixture {
    int width, height, lights, views;  // views > 1: a slab of views x 1
    bool hemisphere, depth, mask;
    bool near;  // lamps stand 3 units away, and light does not fall off
    int slabs;  // views are of so many slabs around the y axis in turn; 0: of one
};

// What pixel (x, y) of a view reflects under a light: in the span of four harmonics, plus a kink.
static inline float fixture_value(const struct fixture *f, int view, struct relume_vec3 l, int x,
                                  int y, int c)
{
    const double a = 0.1 * x - 0.05 * y + 0.3 * view, nx = 0.6 * sin(a), ny = 0.5 * cos(3.0 * a);
    const double nz = sqrt(1.0 - nx * nx - ny * ny), d = nx * l.x + ny * l.y + nz * l.z;
    (void)f;
    return (float)((0.4 + 0.2 * c) * (0.5 + 0.5 * d) + 0.3 * fmax(d - 0.6, 0.0));
}

static inline void fixture_must(relume_status status, const char *what)
{
    if (status) {
        fprintf(stderr, "fixture: %s: %s\n", what, relume_status_text(status));
        abort();
    }
}

// Writes FOLDER/capture.json and its images beside each other.
static inline void fixture_write(const struct fixture *f, const char *folder)
{
    struct relume_vec3 *directions = calloc((size_t)f->lights, sizeof *directions);
    struct relume_vec3 *position = calloc((size_t)f->lights, sizeof *position);
    struct relume_manifest_view *view = calloc((size_t)f->views, sizeof *view);
    char path[512];
    struct relume_image image, plane;
    fixture_must(relume_directions_make(directions, f->lights, relume_pattern_find("hammersley"),
                                        relume_directions_params(.hemisphere = f->hemisphere)),
                 "lights");
    for (int i = 0; i < f->lights; i++)
        position[i] =
            (struct relume_vec3){3 * directions[i].x, 3 * directions[i].y, 3 * directions[i].z};
    fixture_must(relume_image_create(&image, f->width, f->height, 3), "image");
    fixture_must(relume_image_create(&plane, f->width, f->height, 1), "plane");
    for (int v = 0; v < f->views; v++) {
        view[v].uv[0] = v;
        view[v].images = calloc((size_t)f->lights, sizeof *view[v].images);
        for (int i = 0; i < f->lights; i++) {
            for (int y = 0; y < f->height; y++)
                for (int x = 0; x < f->width; x++)
                    for (int c = 0; c < 3; c++)
                        image.data[3 * (y * f->width + x) + c] =
                            fixture_value(f, v, directions[i], x, y, c);
            char *name = malloc(32);
            snprintf(name, 32, "v%d-%d.exr", v, i);
            view[v].images[i] = name;
            snprintf(path, sizeof path, "%s/%s", folder, name);
            fixture_must(relume_image_save(&image, path, NULL), path);
        }
        for (int i = 0; i < f->width * f->height; i++)
            plane.data[i] = i % 3 ? 2.5f : INFINITY;
        snprintf(path, sizeof path, "%s/depth.exr", folder);
        fixture_must(relume_image_save(&plane, path, NULL), path);
        for (int i = 0; i < f->width * f->height; i++)
            plane.data[i] = i % 5 > 0;
        snprintf(path, sizeof path, "%s/mask.exr", folder);
        fixture_must(relume_image_save(&plane, path, NULL), path);
        view[v].depth = f->depth ? "depth.exr" : NULL;
        view[v].mask = f->mask ? "mask.exr" : NULL;
    }
    struct relume_geometry slab[RELUME_MOST_SLABS];
    for (int i = 0; i < f->slabs; i++) {
        const double a = 6.283185307179586 * i / f->slabs;
        slab[i] = relume_geometry_default(RELUME_SLAB, f->width, f->height);
        slab[i].pose =
            (struct relume_pose){.axis = {{cos(a), 0, -sin(a)}, {0, 1, 0}, {sin(a), 0, cos(a)}}};
    }
    for (int v = 0; f->slabs && v < f->views; v++) {
        view[v].slab = v % f->slabs;
        view[v].uv[0] = (double)(v / f->slabs);
    }
    struct relume_manifest m = {
        .slabs = f->slabs,
        .slab = slab,
        .geometry = relume_geometry_default(f->views > 1 ? RELUME_SLAB : RELUME_PLANAR, f->width,
                                            f->height),
        .lights = f->lights,
        .directions = directions,
        .positions = f->near ? position : NULL,
        .no_falloff = f->near,
        .views = f->views,
        .view = view,
    };
    snprintf(path, sizeof path, "%s/capture.json", folder);
    fixture_must(relume_manifest_write(&m, path, NULL), path);
    for (int v = 0; v < f->views; v++) {
        for (int i = 0; i < f->lights; i++)
            free((void *)(uintptr_t)view[v].images[i]);
        free(view[v].images);
    }
    free(view);
    free(position);
    free(directions);
    relume_image_destroy(&image);
    relume_image_destroy(&plane);
}

// FOLDER's capture into the relume file `path`.
static inline relume_status fixture_encode_with(const char *folder, const char *path,
                                                const struct relume_basis *basis,
                                                const struct relume_coder_params *how,
                                                const struct relume_pack_encode_params *params)
{
    const struct relume_project_params learn = {.threads = params ? params->threads : 0};
    relume_capture *capture = NULL;
    relume_coder *coder = NULL;
    relume_status status =
        relume_capture_open(&capture, folder, relume_capture_params(.allow_outside = true));
    if (!status)
        status = relume_coder_learn(&coder, basis, capture, how, &learn);
    if (!status)
        status = relume_pack_encode(capture, coder, path, NULL, params);
    relume_coder_destroy(&coder);
    relume_capture_destroy(&capture);
    return status;
}

static inline relume_status fixture_encode(const char *folder, const char *path,
                                           const struct relume_basis *basis, int coefficients,
                                           const struct relume_pack_encode_params *params)
{
    return fixture_encode_with(folder, path, basis,
                               relume_coder_params(.coefficients = coefficients), params);
}

#endif
