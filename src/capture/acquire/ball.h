// ball.h - what the files about balls share
#ifndef ACQUIRE_BALL_H
#define ACQUIRE_BALL_H

#include "core/math/vec.h"

#include <relume/capture/ball.h>

// How the camera saw the ball. World axes: the camera looks along -z, image up is +y.
struct relume_ball_camera {
    int width, height;  // of the photographs
    double focal_px;    // focal length in pixels; 0: orthographic (far away)
};

// How balls are looked for and measured. Borrowed during the call; lengths in pixels.
struct relume_ball_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_image *mask;  // one channel, above 0.5 where the ball is; or NULL
    const struct relume_image *peak;  // the brightest value each pixel ever has, one channel; or
                                      // NULL: mirror balls have a highlight, others are no balls
    double smallest, largest;         // radius as share of the image's shorter side; default 0.015
                                      // and 0.6
};
#define relume_ball_params(...)                                                                    \
    (&(const struct relume_ball_params){RELUME_SIZED(relume_ball_params), __VA_ARGS__})

// The ball with this outline.
struct relume_ball relume_ball_outlined(double x, double y, double radius,
                                        const struct relume_ball_camera *camera);

// Find `count` balls in `mean`, the geometric mean of photographs under all lights (linear,
// one channel: highlights, which move, hardly show in it),
// from left to right: circles of edges (Hough 1962, voted along the gradient), each refined by a
// robust fit to the edge along its radii. With a mask its border is fitted instead. RELUME_EUNFIT
// with a sentence where fewer can be seen, RELUME_ENOMEM.
relume_status relume_ball_find(struct relume_ball *out, int count, const struct relume_image *mean,
                               const struct relume_ball_camera *camera,
                               const struct relume_ball_params *params);
// The same, up to `most` circles that may be balls and do not overlap, the roundest first; *found
// of them, perhaps none. Which one is a ball is for its highlights to say. RELUME_ENOMEM.
relume_status relume_ball_candidates(struct relume_ball *out, int most, int *found,
                                     const struct relume_image *mean,
                                     const struct relume_ball_camera *camera,
                                     const struct relume_ball_params *params);

// A few words for people, never NULL.
const char *relume_ball_finding_text(enum relume_ball_finding finding);

// The light of one photograph (linear, of the camera's size). `still` is what all photographs show,
// one channel, which is taken off; NULL: nothing. RELUME_ENOMEM.
relume_status relume_ball_mirror(struct relume_ball_light *out, const struct relume_ball *ball,
                                 const struct relume_ball_camera *camera,
                                 const struct relume_image *photograph,
                                 const struct relume_image *still);
// The ball is white (reflects all light) and matte. Shadow, highlights and what shines on it from
// elsewhere are left out by reweighting.
relume_status relume_ball_matte(struct relume_ball_light *out, const struct relume_ball *ball,
                                const struct relume_ball_camera *camera,
                                const struct relume_image *photograph);

// Unit vector from the eye through (x, y).
struct relume_vec3 relume_ball_ray(const struct relume_ball_camera *camera, double x, double y);

// The point nearest to `n` lines from `origin` along unit `direction`, by least squares, and its
// standard error. RELUME_EUNFIT when the lines are nearly parallel or fewer than 2.
relume_status relume_light_triangulate(struct relume_vec3 *position, double *sigma,
                                       const struct relume_vec3 *origin,
                                       const struct relume_vec3 *direction, int n);

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
