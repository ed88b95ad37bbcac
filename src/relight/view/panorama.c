// panorama.c - all directions around one eye in one image: cylinder, sphere, cube (Wong 1998, 8.2)
// A cylinder's end discs are panorama_discs.c.
//
// Layouts are those of docs/conventions.md: azimuth phi = x/W*360-180 looks along
// (sin phi, ., -cos phi); the cylinder's rows are tangents of elevation, the sphere's are
// elevations; a cube is six faces side by side. Texels beyond a border are the ones that lie there
// on the sphere, so that a bilinear value is continuous over the wrap, the poles and the cube's
// edges.
#include <relume/relight/view.h>

#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "image/geometry/geometry.h"
#include "image/image/footprint.h"
#include "relight/view/view.h"
#include "relight/view/panorama.h"

#include <string.h>

// The face of a cube: looking along `ahead`, with `right` = ahead x up.
struct face {
    vec3 ahead, right, up;
};
static const struct face faces[6] = {
    {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},    // +x
    {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},  // -x
    {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},    // +y
    {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},  // -y
    {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},   // +z
    {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}},   // -z
};

// What differs from layout to layout.
struct layout {
    vec3 (*ray)(const struct panorama *p, double x, double y);
    bool (*pixel)(double xy[2], const struct panorama *p, vec3 direction);
    // Texel (x, y), which may lie two steps outside the image or, for a cube, outside `face`.
    panorama_texel *texel;
    // How many texels further a direction comes to lie that moves by `step`, to first order; at a
    // sphere's poles as at its equator: rows stay as far apart.
    double (*texels)(const struct panorama *p, vec3 d, vec3 step);
};

// ---------------------------------------------------------------- shared

void panorama_fetch(float rgb[3], const struct panorama *p, int x, int y)
{
    if (p->params && p->params->need)
        p->params->need(p->params->user, 0, x, y);
    const float *from = p->data + 3 * ((size_t)y * (size_t)p->width + (size_t)x);
    memcpy(rgb, from, 3 * sizeof *rgb);
}

void panorama_bilinear(float rgb[3], const struct panorama *p, panorama_texel *texel, int face,
                       double x, double y)
{
    const int left = relume_whole(floor(x)), top = relume_whole(floor(y));
    const struct bilinear b = {.across = x - left, .down = y - top};
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (int k = 0; k < 4; k++) {
        const float w = (float)bilinear_share(&b, k, 1.0);
        float t[3];
        if (w == 0.0f)
            continue;
        texel(t, p, face, left + k % 2, top + k / 2);
        for (int c = 0; c < 3; c++)
            rgb[c] += w * t[c];
    }
}

static void cubic(float rgb[3], const struct panorama *p, panorama_texel *texel, int face, double x,
                  double y)
{
    const int left = relume_whole(floor(x)), top = relume_whole(floor(y));
    double across[4], down[4], sum[3] = {0.0, 0.0, 0.0};
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    footprint_cubic(across, x - left);
    footprint_cubic(down, y - top);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            float t[3];
            texel(t, p, face, left - 1 + i, top - 1 + j);
            for (int c = 0; c < 3; c++) {
                sum[c] += across[i] * down[j] * (double)t[c];
                low[c] = fminf(low[c], t[c]);
                high[c] = fmaxf(high[c], t[c]);
            }
        }
    for (int c = 0; c < 3; c++)
        rgb[c] = fminf(fmaxf((float)sum[c], low[c]), high[c]);
}

// As the panorama's filter has it.
static void between(float rgb[3], const struct panorama *p, panorama_texel *texel, int face,
                    double x, double y)
{
    if (p->filter == RELUME_FILTER_NEAREST)
        texel(rgb, p, face, relume_whole(floor(x + 0.5)), relume_whole(floor(y + 0.5)));
    else if (p->filter == RELUME_FILTER_CUBIC)
        cubic(rgb, p, texel, face, x, y);
    else
        panorama_bilinear(rgb, p, texel, face, x, y);
}

static vec3 azimuth_ray(const struct panorama *p, double x, double across, double up)
{
    const double phi = x / p->width * 2.0 * M_PI - M_PI;
    return vec3_of(across * sin(phi), up, -across * cos(phi));
}

// In [0, W): azimuth 180 is column 0.
static double azimuth_column(const struct panorama *p, vec3 d)
{
    const double x = (atan2(d.x, -d.z) + M_PI) / (2.0 * M_PI) * p->width;
    return x < p->width ? x : 0.0;
}

// ---------------------------------------------------------------- cylinder

static vec3 cylinder_ray(const struct panorama *p, double x, double y)
{
    const struct relume_geometry *c = p->geometry;
    const int rows = panorama_rows(p);
    if (c->disc && y >= rows)
        return disc_ray(p, x, y);
    const double h = c->v_max - y / rows * (c->v_max - c->v_min);
    return vec3_unit(azimuth_ray(p, x, 1.0, h));
}

static bool cylinder_pixel(double xy[2], const struct panorama *p, vec3 d)
{
    const struct relume_geometry *c = p->geometry;
    const double h = d.y / hypot(d.x, d.z);
    const double slack = 1e-9 * (c->v_max - c->v_min);  // computed directions on the rim
    const bool shown = h >= c->v_min - slack && h <= c->v_max + slack;
    const int rows = panorama_rows(p);
    if (!shown && c->disc) {
        disc_pixel(xy, p, d);
        return true;
    }
    xy[0] = azimuth_column(p, d);
    xy[1] = fmin(fmax((c->v_max - h) / (c->v_max - c->v_min), 0.0), 1.0) * rows;
    if (c->disc)  // the disc's square begins at the last row's end
        xy[1] = fmin(xy[1], nextafter(rows, 0.0));
    return shown;
}

void panorama_cylinder_texel(float rgb[3], const struct panorama *p, int face, int x, int y)
{
    (void)face;
    panorama_fetch(rgb, p, index_wrapped(x, p->width), index_clamped(y, panorama_rows(p)));
}

static double cylinder_texels(const struct panorama *p, vec3 d, vec3 step)
{
    const struct relume_geometry *c = p->geometry;
    const double square = d.x * d.x + d.z * d.z, across = sqrt(square);
    const double h = d.y / across;
    if (c->disc && !(h >= c->v_min && h <= c->v_max))
        return disc_texels(p, d, step);
    const double turn = (d.x * step.z - d.z * step.x) / square;
    const double rise = step.y / across - h * (d.x * step.x + d.z * step.z) / square;
    return hypot(turn * p->width / (2.0 * M_PI), rise * panorama_rows(p) / (c->v_max - c->v_min));
}

// ---------------------------------------------------------------- sphere

static vec3 sphere_ray(const struct panorama *p, double x, double y)
{
    const double elevation = 0.5 * M_PI - y / p->height * M_PI;
    return azimuth_ray(p, x, cos(elevation), sin(elevation));
}

static bool sphere_pixel(double xy[2], const struct panorama *p, vec3 d)
{
    xy[0] = azimuth_column(p, d);
    xy[1] = (0.5 - atan2(d.y, hypot(d.x, d.z)) / M_PI) * p->height;
    return true;
}

// Beyond a pole lies the same row half a turn away; of an odd width that falls between two columns
// (and is blurred by half a column: a step at the pole that smooth pictures do not show).
static void sphere_texel(float rgb[3], const struct panorama *p, int face, int x, int y)
{
    (void)face;
    if (y >= 0 && y < p->height) {
        panorama_fetch(rgb, p, index_wrapped(x, p->width), y);
        return;
    }
    const int row = index_clamped(y < 0 ? -1 - y : 2 * p->height - 1 - y, p->height);
    float other[3];
    panorama_fetch(rgb, p, index_wrapped(x + p->width / 2, p->width), row);
    panorama_fetch(other, p, index_wrapped(x + (p->width + 1) / 2, p->width), row);
    for (int c = 0; c < 3; c++)
        rgb[c] = 0.5f * (rgb[c] + other[c]);
}

static double sphere_texels(const struct panorama *p, vec3 d, vec3 step)
{
    const double angle = vec3_length(vec3_cross(d, step)) / vec3_dot(d, d);
    return angle * fmax(p->width / (2.0 * M_PI), p->height / M_PI);
}

// ---------------------------------------------------------------- cube

static int cube_face_of(vec3 d)
{
    const double x = fabs(d.x);
    const double y = fabs(d.y);
    const double z = fabs(d.z);
    if (x >= y && x >= z)
        return d.x >= 0.0 ? 0 : 1;
    if (y >= z)
        return d.y >= 0.0 ? 2 : 3;
    return d.z >= 0.0 ? 4 : 5;
}

// Direction at (x, y) in pixels from the corner of a face; beyond its rim too. Not of unit length.
static vec3 face_ray(const struct panorama *p, int face, double x, double y)
{
    const struct face *f = &faces[face];
    const double a = 2.0 * x / (p->width / 6) - 1.0;
    const double b = 1.0 - 2.0 * y / p->height;
    return vec3_add(f->ahead, vec3_along(vec3_scale(f->right, a), f->up, b));
}

static vec3 cube_ray(const struct panorama *p, double x, double y)
{
    const int side = p->width / 6;
    const int face = index_clamped(relume_whole(floor(x / side)), 6);
    return vec3_unit(face_ray(p, face, x - face * side, y));
}

// A position on the right rim stays below the first column of the next face.
static bool cube_pixel(double xy[2], const struct panorama *p, vec3 d)
{
    const int side = p->width / 6;
    const int face = cube_face_of(d);
    const struct face *f = &faces[face];
    const double ahead = vec3_dot(d, f->ahead);
    const double x = (0.5 + 0.5 * vec3_dot(d, f->right) / ahead + face) * side;
    xy[0] = fmin(fmax(x, face * side), nextafter((face + 1.0) * side, 0.0));
    xy[1] = (0.5 - 0.5 * vec3_dot(d, f->up) / ahead) * p->height;
    return true;
}

// The texel of the neighbouring face that lies where (x, y) beyond the rim of `face` points.
static void across_edge(float rgb[3], const struct panorama *p, int face, int x, int y)
{
    double xy[2];
    cube_pixel(xy, p, face_ray(p, face, x + 0.5, y + 0.5));
    panorama_fetch(rgb, p, relume_whole(xy[0]), index_clamped(relume_whole(xy[1]), p->height));
}

// A corner has three faces: the missing fourth texel is the mean of their corner texels, which
// is the same seen from each of them.
static void cube_texel(float rgb[3], const struct panorama *p, int face, int x, int y)
{
    const int side = p->width / 6;
    const int inner_x = index_clamped(x, side);
    const int inner_y = index_clamped(y, p->height);
    if (x == inner_x && y == inner_y) {
        panorama_fetch(rgb, p, face * side + x, y);
        return;
    }
    if (x == inner_x || y == inner_y) {
        across_edge(rgb, p, face, x, y);
        return;
    }
    float beside[3], above[3];
    panorama_fetch(rgb, p, face * side + inner_x, inner_y);
    across_edge(beside, p, face, x, inner_y);
    across_edge(above, p, face, inner_x, y);
    for (int c = 0; c < 3; c++)
        rgb[c] = (rgb[c] + beside[c] + above[c]) / 3.0f;
}

static double cube_texels(const struct panorama *p, vec3 d, vec3 step)
{
    const struct face *f = &faces[cube_face_of(d)];
    const double ahead = vec3_dot(d, f->ahead), nearer = vec3_dot(step, f->ahead) / ahead;
    const double a = vec3_dot(step, f->right) - nearer * vec3_dot(d, f->right);
    const double b = vec3_dot(step, f->up) - nearer * vec3_dot(d, f->up);
    return 0.5 * p->height * hypot(a, b) / ahead;
}

// ---------------------------------------------------------------- public

static const struct layout layouts[] = {
    [RELUME_CYLINDRICAL] = {cylinder_ray, cylinder_pixel, panorama_cylinder_texel, cylinder_texels},
    [RELUME_SPHERICAL] = {sphere_ray, sphere_pixel, sphere_texel, sphere_texels},
    [RELUME_CUBE] = {cube_ray, cube_pixel, cube_texel, cube_texels},
};

static const struct layout *layout_of(const struct relume_geometry *geometry)
{
    const size_t n = sizeof layouts / sizeof *layouts;
    const size_t i = (size_t)geometry->projection;
    return i < n && layouts[i].ray ? &layouts[i] : NULL;
}

static bool has_direction(vec3 d)
{
    return isfinite(d.x) && isfinite(d.y) && isfinite(d.z) && (d.x != 0 || d.y != 0 || d.z != 0);
}

// A camera, with what is the same in all its pixels.
struct camera {
    vec3 right, up, ahead;
    bool stereographic;
    double pixel;  // of the plane before the eye, at distance 1
    double half_width, half_height;
};

static struct camera camera_of(struct relume_pan_tilt look, int width, int height)
{
    const double tilt = look.tilt_deg * M_PI / 180.0, pan = look.pan_deg * M_PI / 180.0;
    return (struct camera){
        .right = {cos(pan), 0.0, sin(pan)},
        .up = {-sin(tilt) * sin(pan), cos(tilt), sin(tilt) * cos(pan)},
        .ahead = {cos(tilt) * sin(pan), sin(tilt), -cos(tilt) * cos(pan)},
        .stereographic = look.stereographic,
        .pixel = 2.0 / width * (look.zoom > 0.0 ? 1.0 / look.zoom : 1.0),
        .half_width = 0.5 * width,
        .half_height = 0.5 * height,
    };
}

// Not of unit length. Stereographic: seen from the far end of a sphere's axis.
static vec3 camera_way(const struct camera *c, double x, double y)
{
    const double a = (x - c->half_width) * c->pixel, b = (c->half_height - y) * c->pixel;
    const double depth = c->stereographic ? 0.5 * (1.0 - a * a - b * b) : 1.0;
    return vec3_along(vec3_along(vec3_scale(c->right, a), c->up, b), c->ahead, depth);
}

static vec3 camera_ray(const struct camera *c, double x, double y)
{
    return vec3_unit(camera_way(c, x, y));
}

// How that goes on over a pixel, to the right and down.
static void camera_steps(vec3 step[2], const struct camera *c, double x, double y)
{
    const double bent = c->stereographic ? c->pixel : 0.0;
    const double a = (x - c->half_width) * bent, b = (c->half_height - y) * bent;
    step[0] = vec3_scale(vec3_sub(c->right, vec3_scale(c->ahead, a)), c->pixel);
    step[1] = vec3_scale(vec3_sub(vec3_scale(c->ahead, b), c->up), c->pixel);
}

struct relume_vec3 relume_pan_tilt_ray(struct relume_pan_tilt look, int width, int height, double x,
                                       double y)
{
    const struct camera c = camera_of(look, width, height);
    return camera_ray(&c, x, y);
}

struct relume_vec3 relume_panorama_ray(const struct relume_geometry *geometry, int width,
                                       int height, double x, double y)
{
    const struct panorama p = {.geometry = geometry, .width = width, .height = height};
    const struct layout *layout = layout_of(geometry);
    return layout ? layout->ray(&p, x, y) : (vec3){0};
}

bool relume_panorama_pixel(double xy[2], const struct relume_geometry *geometry, int width,
                           int height, struct relume_vec3 direction)
{
    const struct panorama p = {.geometry = geometry, .width = width, .height = height};
    const struct layout *layout = layout_of(geometry);
    return layout && has_direction(direction) && layout->pixel(xy, &p, direction);
}

static bool sample(float rgb[3], const struct panorama *p, const struct layout *layout,
                   vec3 direction)
{
    double xy[2];
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (!has_direction(direction) || !layout->pixel(xy, p, direction))
        return false;
    if (p->geometry->disc) {
        disc_sample(rgb, p, xy);
        return true;
    }
    const int side = p->geometry->projection == RELUME_CUBE ? p->width / 6 : p->width;
    const int face = index_clamped(relume_whole(xy[0] / side), 6);
    between(rgb, p, layout->texel, face, xy[0] - face * side - 0.5, xy[1] - 0.5);
    return true;
}

// Three channels, for a cube six square faces, discs that fit.
static const struct layout *usable_layout(const struct relume_geometry *geometry,
                                          const struct relume_image *image)
{
    const bool cube = geometry->projection == RELUME_CUBE;
    if (!image->data || image->channels != 3 || (cube && image->width != 6 * image->height) ||
        !relume_geometry_fits(geometry, image->width, image->height))
        return NULL;
    return layout_of(geometry);
}

bool relume_panorama_sample(float rgb[3], const struct relume_geometry *geometry,
                            const struct relume_image *image, struct relume_vec3 direction,
                            const struct relume_view_params *params)
{
    const bool nearest = params && params->filter == RELUME_FILTER_NEAREST;
    const struct panorama p = {geometry,
                               image->width,
                               image->height,
                               image->data,
                               nearest ? RELUME_FILTER_NEAREST : RELUME_FILTER_LINEAR,
                               params};
    const struct layout *layout = usable_layout(geometry, image);
    if (layout)
        return sample(rgb, &p, layout, direction);
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    return false;
}

struct frame {
    const struct relume_image *out;
    struct camera camera;
    struct panorama panorama;
    const struct layout *layout;
    float nothing;
    bool one;  // ray a pixel
};

// The mean of what a pixel covers.
static void draw_pixel(float rgb[3], const struct frame *f, double x, double y)
{
    const vec3 way = camera_way(&f->camera, x, y);
    double texels[2] = {0.0, 0.0}, sum[3] = {0.0, 0.0, 0.0};
    vec3 step[2];
    camera_steps(step, &f->camera, x, y);
    for (int k = 0; k < 2 && !f->one; k++)
        texels[k] = f->layout->texels(&f->panorama, way, step[k]);
    const struct footprint across = footprint_of(texels[0], FOOTPRINT_MOST);
    const struct footprint down = footprint_of(texels[1], FOOTPRINT_MOST);
    const int n = across.count * down.count;
    if (n == 1) {
        if (!sample(rgb, &f->panorama, f->layout, vec3_unit(way)))
            rgb[0] = rgb[1] = rgb[2] = f->nothing;
        return;
    }
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++) {
            float part[3];
            sample(part, &f->panorama, f->layout,
                   camera_ray(&f->camera, x + footprint_place(across, i),
                              y + footprint_place(down, j)));
            for (int c = 0; c < 3; c++)
                sum[c] += (double)part[c];
        }
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(sum[c] / n);
}

static void draw_row(void *context, size_t row, int worker)
{
    const struct frame *f = context;
    (void)worker;
    float *rgb = f->out->data + 3 * row * (size_t)f->out->width;
    for (int x = 0; x < f->out->width; x++, rgb += 3)
        draw_pixel(rgb, f, x + 0.5, (double)row + 0.5);
}

relume_status relume_panorama_frame(struct relume_image *out,
                                    const struct relume_geometry *geometry,
                                    const struct relume_image *image, struct relume_pan_tilt look,
                                    const struct relume_view_params *params)
{
    const struct layout *layout = usable_layout(geometry, image);
    const bool finite = isfinite(look.pan_deg) && isfinite(look.tilt_deg) && isfinite(look.zoom);
    if (!layout || !finite || look.zoom < 0.0 || !out->data || out->channels != 3)
        return RELUME_EINVAL;
    const struct relume_view_params p = PARAMS(relume_view_params, params);
    struct frame frame = {
        .out = out,
        .camera = camera_of(look, out->width, out->height),
        .panorama = {geometry, image->width, image->height, image->data, p.filter},
        .layout = layout,
        .nothing = p.nothing,
        .one = p.one || p.filter == RELUME_FILTER_NEAREST,
    };
    thread_for(p.threads, (size_t)out->height, draw_row, &frame);
    return RELUME_OK;
}
