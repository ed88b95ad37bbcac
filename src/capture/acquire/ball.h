// ball.h - what the files about balls share
#ifndef ACQUIRE_BALL_H
#define ACQUIRE_BALL_H

#include "core/math/vec.h"

#include <relume/capture/ball.h>

struct ball_point {
    double x, y;
    double weight;
};

// The ball whose outline lies nearest to the weighted points, from the guess in `*ball`; false when
// they do not determine it. x, y, radius, axis and half_angle_rad are set.
bool ball_fit(struct relume_ball *ball, const struct relume_ball_camera *camera,
              const struct ball_point *point, int n);
// How far a point lies outside the outline, pixels.
double ball_distance(const struct relume_ball *ball, const struct relume_ball_camera *camera,
                     double x, double y);

// The ball's surface where the picture shows it: unit normal, and the unit vector to the eye. False
// outside the outline.
bool ball_normal(vec3 *normal, vec3 *to_eye, const struct relume_ball *ball,
                 const struct relume_ball_camera *camera, double x, double y);

// Follow the outline in `edges` (one channel) along `angles` radii from the guess in `*ball`, at
// first up to `reach` times its radius away: fits it and sets sigma and coverage. RELUME_EUNFIT
// when it is lost, RELUME_ENOMEM.
relume_status ball_follow(struct relume_ball *ball, const struct relume_ball_camera *camera,
                          const struct relume_image *edges, int angles, double reach);

// Whether `*ball` is a circle that a mirror ball on a level table reflects, seen along the table's
// normal, in `photos` pictures (one channel, values that differ as the logarithm of light does). If
// so it becomes the ball's outline, with sigma; its coverage stays. RELUME_ENOMEM.
relume_status ball_on_table(struct relume_ball *ball, bool *is,
                            const struct relume_ball_camera *camera,
                            const struct relume_image *photo, int photos);

// Order balls from left to right.
void ball_sort(struct relume_ball *ball, int n);

// The mean of a pixel's channels.
static inline float ball_grey(const struct relume_image *image, int x, int y)
{
    const float *p =
        image->data + (size_t)image->channels * ((size_t)y * (size_t)image->width + (size_t)x);
    return image->channels == 3 ? (p[0] + p[1] + p[2]) / 3.0f : p[0];
}

// One channel between pixel centres; beyond the border as at it.
static inline float ball_at(const struct relume_image *image, double x, double y)
{
    const double cx = fmin(fmax(x - 0.5, 0.0), image->width - 1.001);
    const double cy = fmin(fmax(y - 0.5, 0.0), image->height - 1.001);
    const int ix = (int)cx, iy = (int)cy;
    const float fx = (float)(cx - ix), fy = (float)(cy - iy);
    const float *p = image->data + (size_t)iy * (size_t)image->width + (size_t)ix;
    const float *q = p + image->width;
    return (p[0] * (1 - fx) + p[1] * fx) * (1 - fy) + (q[0] * (1 - fx) + q[1] * fx) * fy;
}

#endif
