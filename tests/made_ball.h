// made_ball.h - photographs of balls under one lamp, ray by ray: the truth that ball.h is held to
#ifndef MADE_BALL_H
#define MADE_BALL_H

#include <math.h>
#define RELUME_VEC3_SHORT
#include <relume/extensions.h>
#include <stdlib.h>

enum { MADE_WIDTH = 320, MADE_HEIGHT = 240, MADE_RAYS = 3, MADE_BALLS = 4 };

struct made_scene {
    double fov_deg;  // 0: orthographic
    int balls;
    struct relume_vec3 middle[MADE_BALLS];  // world: the window is 2 wide on z = 0
    double radius[MADE_BALLS];
    bool matte;
    struct relume_vec3 lamp;  // its place; a direction where `distant`
    bool distant;
    double brightness;
    struct relume_vec3 second;  // another lamp, likewise; zero: none
    double table;               // z of a table that the balls stand on; 0: cloth without end
};

static inline void made_ray(const struct made_scene *s, double x, double y,
                            struct relume_vec3 *from, struct relume_vec3 *ray)
{
    const struct relume_vec3 on = {2.0 * x / MADE_WIDTH - 1.0, (MADE_HEIGHT - 2.0 * y) / MADE_WIDTH,
                                   0.0};
    if (s->fov_deg <= 0.0) {
        *from = (struct relume_vec3){on.x, on.y, 100.0};
        *ray = (struct relume_vec3){0, 0, -1};
        return;
    }
    *from = (struct relume_vec3){0, 0, 1.0 / tan(s->fov_deg * M_PI / 360.0)};
    *ray = vec3_unit(vec3_sub(on, *from));
}

// Whether the ray hits ball `b`, where and with which normal.
static inline bool made_hit(const struct made_scene *s, int b, struct relume_vec3 from,
                            struct relume_vec3 ray, struct relume_vec3 *at, struct relume_vec3 *n)
{
    const struct relume_vec3 to = vec3_sub(s->middle[b], from);
    const double along = vec3_dot(to, ray), r = s->radius[b];
    const double inside = along * along - vec3_dot(to, to) + r * r;
    if (inside <= 0.0)
        return false;
    *at = vec3_along(from, ray, along - sqrt(inside));
    *n = vec3_unit(vec3_sub(*at, s->middle[b]));
    return true;
}

static inline struct relume_vec3 made_towards(const struct made_scene *s, struct relume_vec3 lamp,
                                              struct relume_vec3 at)
{
    return vec3_unit(s->distant ? lamp : vec3_sub(lamp, at));
}

// A lamp that looks 3 degrees wide in the mirror.
static inline double made_glint(const struct made_scene *s, struct relume_vec3 lamp,
                                struct relume_vec3 at, struct relume_vec3 mirrored)
{
    return vec3_dot(made_towards(s, lamp, at), mirrored) > cos(1.5 * M_PI / 180.0) ? s->brightness
                                                                                   : 0.0;
}

// Where a ray that points down hits the table: bright, patterned, with the shadows of the balls,
// up to some three units from the middle.
static inline double made_table(const struct made_scene *s, struct relume_vec3 from,
                                struct relume_vec3 ray)
{
    const struct relume_vec3 at = vec3_along(from, ray, (s->table - from.z) / ray.z);
    const struct relume_vec3 lamp = made_towards(s, s->lamp, at);
    const double far = hypot(at.x, at.y);
    double light = fmax(lamp.z, 0.0);
    for (int b = 0; b < s->balls; b++) {
        struct relume_vec3 on, n;
        if (made_hit(s, b, at, lamp, &on, &n))
            light = 0.0;
    }
    const double albedo = 0.45 + 0.4 * sin(23.0 * at.x + 2.0 * sin(9.0 * at.y)) * sin(19.0 * at.y);
    return albedo * (0.6 * light + 0.02) * exp(-2.0 * fmax(far - 3.0, 0.0));
}

static inline double made_shade(const struct made_scene *s, struct relume_vec3 ray,
                                struct relume_vec3 at, struct relume_vec3 n)
{
    if (s->matte)
        return s->brightness * fmax(vec3_dot(n, made_towards(s, s->lamp, at)), 0.0);
    const struct relume_vec3 mirrored = vec3_along(ray, n, -2.0 * vec3_dot(ray, n));
    if (s->table < 0.0 && mirrored.z < 0.0)
        return 0.7 * made_table(s, at, mirrored);
    double v = 0.01 + 0.01 * mirrored.y + made_glint(s, s->lamp, at, mirrored);
    if (vec3_dot(s->second, s->second) > 0.0)
        v += made_glint(s, s->second, at, mirrored);
    return v;
}

// What a ray sees of the balls and the table; false where it sees the cloth behind them.
static inline bool made_value(double *value, const struct made_scene *s, double x, double y)
{
    struct relume_vec3 from, ray, at, n;
    made_ray(s, x, y, &from, &ray);
    for (int b = 0; b < s->balls; b++)
        if (made_hit(s, b, from, ray, &at, &n)) {
            *value = made_shade(s, ray, at, n);
            return true;
        }
    if (s->table < 0.0)
        *value = made_table(s, from, ray);
    return s->table < 0.0;
}

static inline double made_cloth(int x, int y)
{
    return 0.12 + 0.04 * sin(0.7 * x + 2.0 * sin(0.11 * y)) * sin(0.45 * y);
}

// Three channels, clipped at 1 as a camera does, with noise of `noise`.
static inline relume_status made_photograph(struct relume_image *out, const struct made_scene *s,
                                            double noise)
{
    uint32_t random = 12345;
    const relume_status status = relume_image_create(out, MADE_WIDTH, MADE_HEIGHT, 3);
    for (int i = 0; !status && i < MADE_WIDTH * MADE_HEIGHT; i++) {
        const int x = i % MADE_WIDTH, y = i / MADE_WIDTH;
        const double cloth = made_cloth(x, y);
        double sum = 0.0;
        for (int k = 0; k < MADE_RAYS * MADE_RAYS; k++) {
            double value = cloth;
            made_value(&value, s, x + (k % MADE_RAYS + 0.5) / MADE_RAYS,
                       y + (k / MADE_RAYS + 0.5) / MADE_RAYS);
            sum += value;
        }
        random = random * 1664525u + 1013904223u;
        const double v = sum / (MADE_RAYS * MADE_RAYS) + noise * (random / 2147483648.0 - 1.0);
        for (int c = 0; c < 3; c++)
            out->data[3 * i + c] = (float)fmin(fmax(v, 0.0), 1.0);
    }
    return status;
}

#endif
