// lens.c - a lens before an eye: pinholes all over it whose pictures agree on the plane in focus
//
// A picture through a lens is the mean of those from all points of it (Cook, Porter, Carpenter
// 1984). The points lie on Vogel's spiral (1979), as evenly as so many can; how many follows from
// the largest blur.
#include "core/math/vec.h"
#include "relight/view/slab_set.h"

#include <relume/relight/slab_set.h>

enum { FEWEST = 8, MOST = 64 };
// Of how near and how far things lie, by how far away the window is.
static const double depth_of_scene = 1.5;
// Points for each square pixel of blur: less than three pixels apart, all drawn bilinearly.
static const double density = 0.12;

// Unit, from the eye to the window.
static vec3 ahead_of(const struct relume_window *w)
{
    const vec3 ahead = vec3_unit(vec3_cross(w->down, w->right));
    const bool behind = vec3_dot(ahead, vec3_sub(w->corner, w->eye)) < 0.0;
    return vec3_scale(ahead, behind ? -1.0 : 1.0);
}

double relume_window_distance(const struct relume_window *w)
{
    return vec3_dot(vec3_sub(w->corner, w->eye), ahead_of(w));
}

bool relume_lens_fits(const struct relume_window *w, double aperture, double focus)
{
    return aperture >= 0.0 && isfinite(aperture) && isfinite(focus) &&
           focus < relume_window_distance(w);
}

int relume_lens_points(const struct relume_window *w, double aperture, double focus, int width)
{
    const double window = relume_window_distance(w), sharp = window - focus;
    const double near = window / depth_of_scene, far = window * depth_of_scene;
    const double off = fmax(fabs(near - sharp) / near, fabs(far - sharp) / far);
    const double blur = aperture * off * window / sharp * width / vec3_length(w->right);
    if (aperture == 0.0)
        return 1;
    return relume_whole(ceil(fmin(fmax(density * blur * blur, FEWEST), MOST)));
}

struct relume_window relume_lens_window(const struct relume_window *w, double aperture,
                                        double focus, int i, int n)
{
    const double golden_rad = M_PI * (3.0 - sqrt(5.0));
    const double r = n > 1 ? 0.5 * aperture * sqrt((i + 0.5) / n) : 0.0;
    const vec3 beside = vec3_scale(vec3_unit(w->right), r * cos(i * golden_rad));
    const vec3 below = vec3_scale(vec3_unit(w->down), r * sin(i * golden_rad));
    const double grown = 1.0 - focus / relume_window_distance(w);
    return (struct relume_window){
        .eye = vec3_add(w->eye, vec3_add(beside, below)),
        .corner = vec3_along(w->eye, vec3_sub(w->corner, w->eye), grown),
        .right = vec3_scale(w->right, grown),
        .down = vec3_scale(w->down, grown),
    };
}
