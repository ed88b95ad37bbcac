// frame_projection.c - where objects stand in the frame: a matrix for OpenGL, and the eye
#include "draw/frame_projection.h"

#include "common/vec.h"

#include <string.h>

static void set_row(float clip[16], int row, struct relume_vec3 axis, double offset)
{
    clip[row] = (float)axis.x;
    clip[4 + row] = (float)axis.y;
    clip[8 + row] = (float)axis.z;
    clip[12 + row] = (float)offset;
}

static struct relume_vec3 corner_of(int i, struct relume_vec3 min, struct relume_vec3 max)
{
    return (struct relume_vec3){i & 1 ? max.x : min.x, i & 2 ? max.y : min.y,
                                i & 4 ? max.z : min.z};
}

static struct relume_vec3 sum(struct relume_vec3 a, double s, struct relume_vec3 b, double t)
{
    return (struct relume_vec3){a.x * s + b.x * t, a.y * s + b.y * t, a.z * s + b.z * t};
}

// A point p has p - eye = a right + b down + c (corner - eye): it is seen at (a, b) / c of the
// picture, c counts the distance in distances of the window.
bool frame_projection_of_window(struct frame_projection *out, const struct relume_window *w,
                                struct app_rectangle picture, int width, int height,
                                struct relume_vec3 min, struct relume_vec3 max)
{
    const struct relume_vec3 ahead = vec3_sub(w->corner, w->eye);
    const struct relume_vec3 normal = vec3_cross(w->right, w->down);
    const double volume = vec3_dot(normal, ahead);
    if (volume == 0.0)
        return false;
    const struct relume_vec3 a = vec3_scale(vec3_cross(w->down, ahead), 1.0 / volume);
    const struct relume_vec3 b = vec3_scale(vec3_cross(ahead, w->right), 1.0 / volume);
    const struct relume_vec3 c = vec3_scale(normal, 1.0 / volume);
    double from = INFINITY, to = -INFINITY;
    for (int i = 0; i < 8; i++) {
        const double depth = vec3_dot(c, vec3_sub(corner_of(i, min, max), w->eye));
        from = fmin(from, depth);
        to = fmax(to, depth);
    }
    if (!(to > 0.0))
        return false;
    to *= 1.001;
    from = fmax(from * 0.999, 1e-4 * to);
    const double wide = picture.right - picture.left, high = picture.bottom - picture.top;
    const struct relume_vec3 x = sum(a, 2.0 * wide / width, c, 2.0 * picture.left / width - 1.0);
    const struct relume_vec3 y = sum(b, 2.0 * high / height, c, 2.0 * picture.top / height - 1.0);
    const struct relume_vec3 z = vec3_scale(c, (to + from) / (to - from));
    set_row(out->clip, 0, x, -vec3_dot(x, w->eye));
    set_row(out->clip, 1, y, -vec3_dot(y, w->eye));
    set_row(out->clip, 2, z, -vec3_dot(z, w->eye) - 2.0 * to * from / (to - from));
    set_row(out->clip, 3, c, -vec3_dot(c, w->eye));
    const float eye[4] = {(float)w->eye.x, (float)w->eye.y, (float)w->eye.z, 1.0f};
    memcpy(out->eye, eye, sizeof eye);
    const double away = fabs(volume) / vec3_length(normal);
    out->pixel = fmin(vec3_length(w->right) / wide, vec3_length(w->down) / high) / away;
    return true;
}

void frame_projection_of_plane(struct frame_projection *out, const double window_min[2],
                               const double window_max[2], struct app_rectangle picture, int width,
                               int height, struct relume_vec3 min, struct relume_vec3 max)
{
    const double across = (picture.right - picture.left) / (window_max[0] - window_min[0]);
    const double down = (picture.bottom - picture.top) / (window_max[1] - window_min[1]);
    const double depth = fmax(max.z - min.z, 1e-6) * 1.001;
    memset(out, 0, sizeof *out);
    set_row(out->clip, 0, (struct relume_vec3){2.0 * across / width, 0, 0},
            2.0 * (picture.left - window_min[0] * across) / width - 1.0);
    set_row(out->clip, 1, (struct relume_vec3){0, -2.0 * down / height, 0},
            2.0 * (picture.top + window_max[1] * down) / height - 1.0);
    set_row(out->clip, 2, (struct relume_vec3){0, 0, -2.0 / depth}, (max.z + min.z) / depth);
    out->clip[15] = 1.0f;
    out->eye[2] = 1.0f;
}
