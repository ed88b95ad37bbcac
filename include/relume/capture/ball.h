// ball.h - where the light stands, found by a ball in the photograph
//
// A mirror ball shows the lamp as one bright spot; the ray of the camera reflected there points to
// the lamp. A matte white ball is shaded by n.L (Lambert), so that the shading gives direction and
// intensity. Positions in pictures are pixels from the top left corner, pixel centres at +0.5.
#ifndef RELUME_BALL_H
#define RELUME_BALL_H

#include <relume/base.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// How the camera saw the ball. World axes: the camera looks along -z, image up is +y.
struct relume_ball_camera {
    int width, height;  // of the photographs
    double focal_px;    // focal length in pixels; 0: orthographic (far away)
};

// A ball as outlined. Thread-safety: plain data.
struct relume_ball {
    double x, y, radius;      // the outline; perspective: the circle nearest to its ellipse
    double sigma;             // standard error of the outline's middle, pixels; 0: not known
    double coverage;          // share of the outline at which an edge was seen, [0, 1]
    struct relume_vec3 axis;  // perspective: unit vector from the eye to the middle of the ball
    double half_angle_rad;    // perspective: of the cone that touches the ball; else 0
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
RELUME_API struct relume_ball relume_ball_outlined(double x, double y, double radius,
                                                   const struct relume_ball_camera *camera);

// Find `count` balls in `mean`, the geometric mean of photographs under all lights (linear,
// one channel: highlights, which move, hardly show in it),
// from left to right: circles of edges (Hough 1962, voted along the gradient), each refined by a
// robust fit to the edge along its radii. With a mask its border is fitted instead. RELUME_EUNFIT
// with a sentence where fewer can be seen, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_ball_find(struct relume_ball *out, int count,
                                             const struct relume_image *mean,
                                             const struct relume_ball_camera *camera,
                                             const struct relume_ball_params *params);
// The same, up to `most` circles that may be balls and do not overlap, the roundest first; *found
// of them, perhaps none. Which one is a ball is for its highlights to say. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_ball_candidates(struct relume_ball *out, int most, int *found,
                                                   const struct relume_image *mean,
                                                   const struct relume_ball_camera *camera,
                                                   const struct relume_ball_params *params);

// What of a ball was seen. Constant names by relume_ball_finding_text.
enum relume_ball_finding {
    RELUME_BALL_SEEN = 0,
    RELUME_BALL_DARK,  // no highlight: no light reaches the ball, or the photograph is black
    RELUME_BALL_FULL,  // bright all over: overexposed, or no mirror
    RELUME_BALL_RIM,   // the highlight lies at the outline, where directions cannot be measured
    RELUME_BALL_TWO,   // a second highlight of similar size; the larger one is taken
};
// A few words for people, never NULL.
RELUME_API const char *relume_ball_finding_text(enum relume_ball_finding finding);

// Where the light of a ball comes from. Plain data.
struct relume_ball_light {
    enum relume_ball_finding finding;  // what was seen; a direction is only there for some of them
    struct relume_vec3 direction;      // unit, world; zero when DARK or FULL
    struct relume_vec3 origin;         // the point of the ball where it was read, in units of the
                                       // ball's radius from its middle
    double x, y;                       // the highlight, pixels
    double sigma_deg;    // standard error of the direction, as far as the picture shows:
                         // of the outline and the spot; matte: of the fit
    double spread_deg;   // mirror: how wide the lamp looks, RMS
    float intensity[3];  // matte: value of a white surface facing the light; else 0
};

// The light of one photograph (linear, of the camera's size). RELUME_ENOMEM.
RELUME_RESULT relume_status relume_ball_mirror(struct relume_ball_light *out,
                                               const struct relume_ball *ball,
                                               const struct relume_ball_camera *camera,
                                               const struct relume_image *photograph);
// The ball is white (reflects all light) and matte. Shadow, highlights and what shines on it from
// elsewhere are left out by reweighting.
RELUME_RESULT relume_status relume_ball_matte(struct relume_ball_light *out,
                                              const struct relume_ball *ball,
                                              const struct relume_ball_camera *camera,
                                              const struct relume_image *photograph);

// Unit vector from the eye through (x, y).
RELUME_API struct relume_vec3 relume_ball_ray(const struct relume_ball_camera *camera, double x,
                                              double y);

// The point nearest to `n` lines from `origin` along unit `direction`, by least squares, and its
// standard error. RELUME_EUNFIT when the lines are nearly parallel or fewer than 2.
RELUME_RESULT relume_status relume_light_triangulate(struct relume_vec3 *position, double *sigma,
                                                     const struct relume_vec3 *origin,
                                                     const struct relume_vec3 *direction, int n);

#ifdef __cplusplus
}
#endif
#endif
