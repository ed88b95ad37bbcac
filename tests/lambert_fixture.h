// lambert_fixture.h - captures of a bumpy matte surface under lights that are known exactly
#ifndef LAMBERT_FIXTURE_H
#define LAMBERT_FIXTURE_H

#include "test.h"

enum { BUMP_SIDE = 40, BUMP_LIGHTS = 14 };

struct bump {
    bool near;     // lights at 3 world units, falling with the square of the distance
    bool uneven;   // lamps of equal power at 2.2 to 3.8 units instead
    bool level;    // photographs are equally bright at 0, 0, 0
    bool flat;     // a plane instead of the bump
    double gloss;  // height of a highlight at each pixel under one light
    double shine;  // strength of a highlight around the mirror direction, seen from above
    bool shadows;  // two lights are blocked at each pixel
    bool no_falloff;
    const double *brightness;  // [BUMP_LIGHTS], or NULL: all 1
    struct relume_vec3 normal_of_plane;
};

static inline struct relume_vec3 bump_light(int i)
{
    const double z = 0.45 + 0.5 * (i + 0.5) / BUMP_LIGHTS, r = sqrt(1.0 - z * z);
    return (struct relume_vec3){r * cos(2.4 * i), r * sin(2.4 * i), z};
}

static inline double bump_distance(const struct bump *s, int i)
{
    return s->uneven ? 2.2 + 1.6 * (5 * i % BUMP_LIGHTS) / (BUMP_LIGHTS - 1.0) : 3.0;
}

static inline struct relume_vec3 bump_position(const struct bump *s, int i)
{
    return vec3_scale(bump_light(i), bump_distance(s, i));
}

// Light of a lamp of power 1 at the distance 1 (docs/conventions.md).
static inline double bump_power(const struct bump *s, int light)
{
    double sum = 0.0;
    for (int i = 0; i < BUMP_LIGHTS; i++)
        sum += pow(bump_distance(s, s->level ? light : i), 2.0) / BUMP_LIGHTS;
    return sum;
}

// Pixel centres as the default window has them, on z = 0.
static inline struct relume_vec3 bump_point(int x, int y)
{
    return (struct relume_vec3){2.0 * (x + 0.5) / BUMP_SIDE - 1.0,
                                1.0 - 2.0 * (y + 0.5) / BUMP_SIDE, 0.0};
}

// Height 0.25 cos^2 cos^2 over the window; world units.
static inline double bump_height(struct relume_vec3 p)
{
    const double a = cos(M_PI / 2 * p.x), b = cos(M_PI / 2 * p.y);
    return 0.25 * a * a * b * b;
}

static inline struct relume_vec3 bump_normal(const struct bump *s, struct relume_vec3 p)
{
    if (s->flat)
        return vec3_unit(s->normal_of_plane);
    const double a = cos(M_PI / 2 * p.x), b = cos(M_PI / 2 * p.y);
    const double dx = -0.25 * M_PI * a * sin(M_PI / 2 * p.x) * b * b;
    const double dy = -0.25 * M_PI * b * sin(M_PI / 2 * p.y) * a * a;
    return vec3_unit((struct relume_vec3){-dx, -dy, 1.0});
}

static inline double bump_value(const struct bump *s, int light, int x, int y)
{
    const struct relume_vec3 p = bump_point(x, y), n = bump_normal(s, p), d = bump_light(light);
    struct relume_vec3 l = d;
    double fall = s->brightness ? s->brightness[light] : 1.0;
    if (s->near) {
        l = vec3_sub(bump_position(s, light), p);
        fall *= s->no_falloff ? 1.0 : bump_power(s, light) / vec3_dot(l, l);
        l = vec3_unit(l);
    }
    const int odd = (7 * x + 13 * y) % BUMP_LIGHTS;
    if (s->shadows && (light == odd || light == (odd + 5) % BUMP_LIGHTS))
        return 0.0;
    const double gloss = s->gloss > 0.0 && light == (odd + 3) % BUMP_LIGHTS ? s->gloss : 0.0;
    const struct relume_vec3 h = vec3_unit((struct relume_vec3){l.x, l.y, l.z + 1.0});
    const double shine = s->shine * pow(fmax(vec3_dot(n, h), 0.0), 15.0);
    return fall * (0.7 * fmax(vec3_dot(n, l), 0.0) + gloss + shine);
}

// FOLDER/capture.json and its images.
static inline void bump_write(const struct bump *s, const char *folder)
{
    struct relume_vec3 direction[BUMP_LIGHTS], position[BUMP_LIGHTS];
    char name[BUMP_LIGHTS][32], path[256];
    const char *images[BUMP_LIGHTS];
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, BUMP_SIDE, BUMP_SIDE, 3));
    for (int i = 0; i < BUMP_LIGHTS; i++) {
        direction[i] = bump_light(i);
        position[i] = bump_position(s, i);
        for (int k = 0; k < BUMP_SIDE * BUMP_SIDE; k++)
            for (int c = 0; c < 3; c++)
                image.data[3 * k + c] = (float)bump_value(s, i, k % BUMP_SIDE, k / BUMP_SIDE);
        snprintf(name[i], sizeof name[i], "l%d.exr", i);
        images[i] = name[i];
        snprintf(path, sizeof path, "%s/%s", folder, name[i]);
        CHECK_OK(relume_image_save(&image, path, NULL));
    }
    const struct relume_manifest_view view = {.images = images};
    const struct relume_manifest m = {
        .geometry = relume_geometry_default(RELUME_PLANAR, BUMP_SIDE, BUMP_SIDE),
        .lights = BUMP_LIGHTS,
        .directions = direction,
        .positions = s->near ? position : NULL,
        .no_falloff = s->no_falloff,
        .intensities_at_origin = s->level,
        .views = 1,
        .view = &view,
    };
    snprintf(path, sizeof path, "%s/capture.json", folder);
    CHECK_OK(relume_manifest_write(&m, path, NULL));
    relume_image_destroy(&image);
}

static inline relume_capture *bump_open(const struct bump *s, char folder[64])
{
    relume_capture *capture;
    test_folder(folder);
    bump_write(s, folder);
    CHECK_OK(relume_capture_open(&capture, folder, NULL));
    return capture;
}

static inline void bump_close(relume_capture **capture, const char *folder)
{
    relume_capture_destroy(capture);
    test_folder_remove(folder);
}

#endif
