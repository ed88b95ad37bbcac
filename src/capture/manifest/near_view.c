// near_view.c - directions and fall-off of near lights, pixel by pixel
#include "capture/manifest/near_view.h"

#include "core/base/log.h"

static bool is_panorama(enum relume_projection p)
{
    return p == RELUME_SPHERICAL || p == RELUME_CYLINDRICAL;
}

static bool has_depth(const relume_capture *capture, int view)
{
    return capture->draft.m.view[view].depth || capture->assume_depth > 0.0;
}

bool near_view_applies(const relume_capture *capture, int view)
{
    const struct relume_manifest *m = &capture->draft.m;
    const enum relume_projection p = m->geometry.projection;
    if (!m->positions)
        return false;
    return p == RELUME_PLANAR || p == RELUME_SLAB || (is_panorama(p) && has_depth(capture, view));
}

void near_view_warn(const relume_capture *capture, const struct relume_log *log)
{
    const struct relume_manifest *m = &capture->draft.m;
    const enum relume_projection p = m->geometry.projection;
    int without = 0;
    for (int i = 0; m->positions && p != RELUME_PLANAR && i < m->views; i++)
        without += p == RELUME_CUBE || !has_depth(capture, i);
    if (without && p == RELUME_SLAB)
        log_line(log, RELUME_WARNING,
                 "%s: lights are near, but %d of %d views have no depth; their surfaces are "
                 "treated as lying on the st plane",
                 capture->path, without, m->views);
    else if (without)
        log_line(log, RELUME_WARNING, "%s: lights are near, but %s; they are treated as distant",
                 capture->path,
                 p == RELUME_CUBE ? "in a cube near lights are not supported"
                                  : "the panorama has no depth (--assume-depth)");
}

relume_status near_view_open(struct near_view *out, const relume_capture *capture, int view,
                             const struct relume_log *log)
{
    const struct relume_manifest *m = &capture->draft.m;
    *out = (struct near_view){
        .lights = m->lights,
        .width = capture->width,
        .height = capture->height,
        .position = m->positions,
        .falls = !m->no_falloff,
        .geometry = m->slabs ? m->slab[m->view[view].slab] : m->geometry,
        .uv = {m->view[view].uv[0], m->view[view].uv[1]},
        .assumed = capture->assume_depth > 0.0 ? capture->assume_depth : -1.0,
    };
    return relume_capture_depth(&out->depth, capture, view, log);
}

void near_view_close(struct near_view *near)
{
    relume_image_destroy(&near->depth);
}

static vec3 local_point(const struct near_view *near, double x, double y, double depth)
{
    const struct relume_geometry *g = &near->geometry;
    const bool slab = g->projection == RELUME_SLAB;
    const double *min = slab ? g->st_min : g->window_min, *max = slab ? g->st_max : g->window_max;
    const vec3 on_plane =
        vec3_of(min[0] + x / near->width * (max[0] - min[0]),
                max[1] - y / near->height * (max[1] - min[1]), slab ? g->st_z : 0.0);
    if (!(depth >= 0.0) || isinf(depth))
        return on_plane;
    if (!slab && !g->perspective)
        return vec3_of(on_plane.x, on_plane.y, g->camera_z - depth);
    const vec3 eye =
        slab ? vec3_of(near->uv[0], near->uv[1], g->uv_z) : vec3_of(0.0, 0.0, g->camera_z);
    return vec3_along(eye, vec3_unit(vec3_sub(on_plane, eye)), depth);
}

// docs/conventions.md, panoramas.
static vec3 panorama_point(const struct near_view *near, double x, double y, double depth)
{
    const struct relume_geometry *g = &near->geometry;
    const double phi = (2.0 * x / near->width - 1.0) * M_PI, down = y / near->height;
    const double elevation = (0.5 - down) * M_PI;
    const vec3 ray =
        g->projection == RELUME_SPHERICAL
            ? vec3_of(cos(elevation) * sin(phi), sin(elevation), -cos(elevation) * cos(phi))
            : vec3_unit(vec3_of(sin(phi), g->v_max - down * (g->v_max - g->v_min), -cos(phi)));
    if (!(depth >= 0.0) || isinf(depth))
        return vec3_of(0.0, 0.0, 0.0);
    return vec3_along(g->center, ray, depth);
}

vec3 near_view_point(const struct near_view *near, double x, double y, double depth)
{
    if (is_panorama(near->geometry.projection))
        return panorama_point(near, x, y, depth);
    const vec3 local = local_point(near, x, y, depth);
    return near->geometry.projection == RELUME_SLAB ? relume_pose_world(&near->geometry.pose, local)
                                                    : local;
}

vec3 near_view_pixel(const struct near_view *near, int x, int y)
{
    const size_t at = (size_t)y * (size_t)near->width + (size_t)x;
    const double depth = near->depth.data ? (double)near->depth.data[at] : near->assumed;
    return near_view_point(near, x + 0.5, y + 0.5, depth);
}

// The mean of the finite depths in a rectangle of pixels, below 0 when there is none; where no
// depth is known, what is assumed.
static double mean_depth(const struct near_view *near, int x0, int y0, int x1, int y1)
{
    double sum = 0.0;
    size_t n = 0;
    for (int y = y0 < 0 ? 0 : y0; near->depth.data && y < y1 && y < near->height; y++)
        for (int x = x0 < 0 ? 0 : x0; x < x1 && x < near->width; x++) {
            const float d = near->depth.data[(size_t)y * (size_t)near->width + (size_t)x];
            if (isfinite(d)) {
                sum += (double)d;
                n++;
            }
        }
    return n ? sum / (double)n : near->depth.data ? -1.0 : near->assumed;
}

vec3 near_view_around(const struct near_view *near, double x, double y, int reach)
{
    const int cx = relume_whole(fmin(x, near->width)), cy = relume_whole(fmin(y, near->height));
    return near_view_point(near, x, y,
                           mean_depth(near, cx - reach, cy - reach, cx + reach, cy + reach));
}

vec3 near_view_direction(double *gain, const struct near_view *near, int light, vec3 point)
{
    const vec3 to = vec3_sub(near->position[light], point);
    const double far = vec3_dot(near->position[light], near->position[light]);
    const double squared = fmax(vec3_dot(to, to), 1e-6 * far);
    *gain = near->falls ? squared / far : 1.0;
    return vec3_scale(to, 1.0 / sqrt(squared));
}

void near_view_level(const struct near_view *near, int light, struct relume_image *image)
{
    float *p = image->data;
    for (int y = 0; near->falls && y < near->height; y++)
        for (int x = 0; x < near->width; x++, p += 3) {
            double gain;
            near_view_direction(&gain, near, light, near_view_pixel(near, x, y));
            for (int c = 0; c < 3; c++)
                p[c] *= (float)gain;
        }
}
