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

// A ball as outlined. Thread-safety: plain data.
struct relume_ball {
    double x, y, radius;      // the outline; perspective: the circle nearest to its ellipse
    double sigma;             // standard error of the outline's middle, pixels; 0: not known
    double coverage;          // share of the outline at which an edge was seen, [0, 1]
    struct relume_vec3 axis;  // perspective: unit vector from the eye to the middle of the ball
    double half_angle_rad;    // perspective: of the cone that touches the ball; else 0
};

// The highlight that was seen on a ball.
enum relume_ball_finding {
    RELUME_BALL_SEEN = 0,
    RELUME_BALL_DARK,  // no highlight: no light reaches the ball, or the photograph is black
    RELUME_BALL_FULL,  // bright all over: overexposed, or no mirror
    RELUME_BALL_RIM,   // the highlight lies at the outline, where directions cannot be measured
    RELUME_BALL_TWO,   // a second highlight of similar size; the larger one is taken
};

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

#ifdef __cplusplus
}
#endif
#endif
