// ball.c - outlines and surfaces of balls, orthographic and in perspective
//
// In perspective the rays that touch a ball form a circular cone around the ray to its middle: unit
// rays u on the outline satisfy u.b = 1 with b = axis / cos(half angle), which is linear in b. The
// picture of the outline is an ellipse that need not be fitted.
#include "capture/acquire/ball.h"

#include "core/math/lsq.h"

enum { ROUNDS = 12 };

struct relume_vec3 relume_ball_ray(const struct relume_ball_camera *camera, double x, double y)
{
    if (!(camera->focal_px > 0.0))
        return vec3_of(0.0, 0.0, -1.0);
    return vec3_unit(vec3_of((x - 0.5 * camera->width) / camera->focal_px,
                             (0.5 * camera->height - y) / camera->focal_px, -1.0));
}

static bool fit_cone(struct relume_ball *ball, const struct relume_ball_camera *camera,
                     const struct ball_point *point, int n)
{
    double m[9] = {0.0}, b[3] = {0.0};
    for (int i = 0; i < n; i++) {
        const vec3 u = relume_ball_ray(camera, point[i].x, point[i].y);
        const double row[3] = {u.x, u.y, u.z};
        for (int j = 0; j < 9; j++)
            m[j] += point[i].weight * row[j / 3] * row[j % 3];
        for (int j = 0; j < 3; j++)
            b[j] += point[i].weight * row[j];
    }
    if (!lsq_solve(m, 3, b, 1))
        return false;
    const vec3 v = vec3_of(b[0], b[1], b[2]);
    const double length = vec3_length(v);
    if (!(length > 1.0) || !isfinite(length))
        return false;
    ball->axis = vec3_scale(v, 1.0 / length);
    ball->half_angle_rad = acos(1.0 / length);
    return true;
}

// Gauss-Newton on the distances from the circle.
static bool fit_circle(struct relume_ball *ball, const struct ball_point *point, int n)
{
    for (int round = 0; round < ROUNDS; round++) {
        double m[9] = {0.0}, step[3] = {0.0};
        for (int i = 0; i < n; i++) {
            const double dx = point[i].x - ball->x, dy = point[i].y - ball->y;
            const double d = fmax(hypot(dx, dy), 1e-6), w = point[i].weight;
            const double row[3] = {dx / d, dy / d, 1.0};
            for (int j = 0; j < 9; j++)
                m[j] += w * row[j / 3] * row[j % 3];
            for (int j = 0; j < 3; j++)
                step[j] += w * row[j] * (d - ball->radius);
        }
        if (!lsq_solve(m, 3, step, 1))
            return false;
        ball->x += step[0];
        ball->y += step[1];
        ball->radius += step[2];
        if (fabs(step[0]) + fabs(step[1]) + fabs(step[2]) < 1e-6)
            break;
    }
    return ball->radius > 0.0 && isfinite(ball->x + ball->y + ball->radius);
}

bool ball_fit(struct relume_ball *ball, const struct relume_ball_camera *camera,
              const struct ball_point *point, int n)
{
    if (n < 3 || !fit_circle(ball, point, n))
        return false;
    return !(camera->focal_px > 0.0) || fit_cone(ball, camera, point, n);
}

double ball_distance(const struct relume_ball *ball, const struct relume_ball_camera *camera,
                     double x, double y)
{
    if (!(camera->focal_px > 0.0))
        return hypot(x - ball->x, y - ball->y) - ball->radius;
    const vec3 u = relume_ball_ray(camera, x, y);
    return (vec3_angle(u, ball->axis) - ball->half_angle_rad) * camera->focal_px / (u.z * u.z);
}

struct relume_ball relume_ball_outlined(double x, double y, double radius,
                                        const struct relume_ball_camera *camera)
{
    enum { POINTS = 64 };
    struct ball_point point[POINTS];
    struct relume_ball ball = {.x = x, .y = y, .radius = radius, .coverage = 1.0};
    for (int i = 0; i < POINTS; i++) {
        const double a = 2.0 * M_PI * i / POINTS;
        point[i] = (struct ball_point){x + radius * cos(a), y + radius * sin(a), 1.0};
    }
    if (camera->focal_px > 0.0 && !fit_cone(&ball, camera, point, POINTS))
        ball.radius = 0.0;
    return ball;
}

bool ball_normal(vec3 *normal, vec3 *to_eye, const struct relume_ball *ball,
                 const struct relume_ball_camera *camera, double x, double y)
{
    if (!(camera->focal_px > 0.0)) {
        const double nx = (x - ball->x) / ball->radius, ny = (ball->y - y) / ball->radius;
        const double flat = nx * nx + ny * ny;
        *normal = vec3_of(nx, ny, sqrt(fmax(1.0 - flat, 0.0)));
        *to_eye = vec3_of(0.0, 0.0, 1.0);
        return flat < 1.0;
    }
    // The ball of radius 1 at distance 1 / sin(half angle).
    const vec3 ray = relume_ball_ray(camera, x, y);
    const vec3 middle = vec3_scale(ball->axis, 1.0 / sin(ball->half_angle_rad));
    const double along = vec3_dot(ray, middle);
    const double inside = along * along - vec3_dot(middle, middle) + 1.0;
    *normal = vec3_sub(vec3_scale(ray, along - sqrt(fmax(inside, 0.0))), middle);
    *to_eye = vec3_scale(ray, -1.0);
    return inside > 0.0;
}
