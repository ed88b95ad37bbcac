// gonio.c - goniometric lights from pictures: radiant intensity over all directions as a cube map
// (Meseth 2006, after Dmitriev et al. 2004)
//
// Every map becomes six faces side by side, each with a border of one texel from its neighbours, so
// that a bilinear value is continuous over the edges and needs no neighbour.
#include <relume/light.h>

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/bilinear.h"
#include "core/math/vec.h"
#include "relight/light/environment.h"

#include <string.h>

enum { FACES = 6, MOST_SIDE = 4096, MOST_FROM_SPHERE = 1024 };

struct relume_gonio {
    int side;                   // of a face, texels
    struct relume_image atlas;  // 6 (side + 2) x (side + 2)
};

// right = ahead x up, seen from the light; +x -x +y -y +z -z.
static const struct face {
    vec3 ahead, right, up;
} faces[FACES] = {
    {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},  {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},  {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
    {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}}, {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}},
};

static int face_of(vec3 d)
{
    const double x = fabs(d.x), y = fabs(d.y), z = fabs(d.z);
    if (x >= y && x >= z)
        return d.x >= 0.0 ? 0 : 1;
    if (y >= z)
        return d.y >= 0.0 ? 2 : 3;
    return d.z >= 0.0 ? 4 : 5;
}

// The face that a direction points to, and where, in texels.
static int place_direction(double xy[2], int side, vec3 d)
{
    const int face = face_of(d);
    const double ahead = vec3_dot(d, faces[face].ahead);
    xy[0] = (0.5 + 0.5 * vec3_dot(d, faces[face].right) / ahead) * side;
    xy[1] = (0.5 - 0.5 * vec3_dot(d, faces[face].up) / ahead) * side;
    return face;
}

// Through the middle of a texel, also of the border's.
static vec3 ray(int side, int face, int x, int y)
{
    const double a = (2 * x + 1.0) / side - 1.0, b = 1.0 - (2 * y + 1.0) / side;
    const vec3 across = vec3_along(vec3_scale(faces[face].right, a), faces[face].up, b);
    return vec3_add(faces[face].ahead, across);
}

// x, y in [-1, side].
static float *texel(const struct relume_gonio *g, int face, int x, int y)
{
    const size_t wide = (size_t)g->side + 2;
    const size_t column = (size_t)face * wide + (size_t)(x + 1);
    return g->atlas.data + 3 * ((size_t)(y + 1) * FACES * wide + column);
}

// ---------------------------------------------------------------- from a cube

static int within(double at, int side)
{
    return at > 0.0 ? at < side ? (int)at : side - 1 : 0;
}

static void copy_across(const struct relume_gonio *g, int face, int x, int y)
{
    double xy[2];
    const int other = place_direction(xy, g->side, ray(g->side, face, x, y));
    memcpy(texel(g, face, x, y), texel(g, other, within(xy[0], g->side), within(xy[1], g->side)),
           3 * sizeof(float));
}

// At a corner of three faces.
static void fill_corner(const struct relume_gonio *g, int face, int x, int y)
{
    const int in_x = x < 0 ? 0 : x - 1, in_y = y < 0 ? 0 : y - 1;
    for (int c = 0; c < 3; c++)
        texel(g, face, x, y)[c] = (texel(g, face, in_x, in_y)[c] + texel(g, face, in_x, y)[c] +
                                   texel(g, face, x, in_y)[c]) /
                                  3.0f;
}

static void fill_border(const struct relume_gonio *g, int face)
{
    const int side = g->side;
    for (int i = 0; i < side; i++) {
        copy_across(g, face, i, -1);
        copy_across(g, face, i, side);
        copy_across(g, face, -1, i);
        copy_across(g, face, side, i);
    }
    for (int corner = 0; corner < 4; corner++)
        fill_corner(g, face, corner & 1 ? side : -1, corner & 2 ? side : -1);
}

static void fill_from_cube(const struct relume_gonio *g, const struct relume_image *map)
{
    for (int face = 0; face < FACES; face++)
        for (int y = 0; y < g->side; y++)
            memcpy(texel(g, face, 0, y),
                   map->data + 3 * ((size_t)y * (size_t)map->width + (size_t)(face * g->side)),
                   3 * (size_t)g->side * sizeof(float));
    for (int face = 0; face < FACES; face++)
        fill_border(g, face);
}

// ---------------------------------------------------------------- from a sphere

static void sphere_value(float rgb[3], const struct relume_image *map, vec3 d)
{
    const double height = d.y / vec3_length(d);
    const double x = (atan2(d.x, -d.z) / (2.0 * M_PI) + 0.5) * map->width - 0.5;
    const double y = acos(height) / M_PI * map->height - 0.5;
    const struct bilinear b = bilinear_at(x, y, map->width, map->height, EDGE_WRAPPED);
    for (size_t c = 0; c < 3; c++)
        rgb[c] = bilinear_valuef(&b, map->data, 3, c);
}

static void fill_from_sphere(const struct relume_gonio *g, const struct relume_image *map)
{
    for (int face = 0; face < FACES; face++)
        for (int y = -1; y <= g->side; y++)
            for (int x = -1; x <= g->side; x++)
                sphere_value(texel(g, face, x, y), map, ray(g->side, face, x, y));
}

// ---------------------------------------------------------------- interface

static void clean(struct relume_image *atlas, const char *name, const struct relume_log *log)
{
    const size_t n = (size_t)atlas->width * (size_t)atlas->height * 3;
    size_t bad = 0;
    for (size_t i = 0; i < n; i++)
        if (!(atlas->data[i] >= 0.0f && atlas->data[i] <= 1e9f)) {
            atlas->data[i] = 0.0f;
            bad++;
        }
    if (bad)
        log_line(log, RELUME_WARNING,
                 "%s: some values are negative, not finite or above 1e9; treated as 0", name);
}

relume_status relume_gonio_create(relume_gonio **out, const struct relume_image *map,
                                  const struct relume_gonio_params *params)
{
    const struct relume_gonio_params p = PARAMS(relume_gonio_params, params);
    const char *name = p.name ? p.name : "distribution";
    const bool cube = map->width == 6LL * map->height;
    *out = NULL;
    if (map->channels != 3 || !(cube || map->width == 2LL * map->height))
        return log_fail(p.log, RELUME_EINVAL,
                        "%s: %d x %d pixels; expected six square faces side by side or a sphere "
                        "twice as wide as high",
                        name, map->width, map->height);
    int side = cube ? map->height : (map->height + 1) / 2;
    if (!cube && side > MOST_FROM_SPHERE)
        side = MOST_FROM_SPHERE;
    if (side > MOST_SIDE)
        return log_fail(p.log, RELUME_EINVAL, "%s: expected faces of at most %d pixels, found %d",
                        name, MOST_SIDE, side);
    struct relume_gonio *g = mem_zeroed(1, sizeof *g);
    if (!g)
        return RELUME_ENOMEM;
    g->side = side;
    const relume_status status = relume_image_create(&g->atlas, FACES * (side + 2), side + 2, 3);
    if (status) {
        relume_gonio_destroy(&g);
        return status;
    }
    (cube ? fill_from_cube : fill_from_sphere)(g, map);
    clean(&g->atlas, name, p.log);
    *out = g;
    return RELUME_OK;
}

relume_status relume_gonio_load(relume_gonio **out, const char *path, const struct relume_log *log)
{
    struct relume_image map;
    *out = NULL;
    relume_status status = relume_image_load(&map, path, relume_image_params(.log = log));
    if (status)
        return status;
    status = relume_gonio_create(out, &map, relume_gonio_params(.log = log, .name = path));
    relume_image_destroy(&map);
    return status == RELUME_EINVAL ? RELUME_EUNFIT : status;
}

void relume_gonio_destroy(relume_gonio **gonio)
{
    if (!*gonio)
        return;
    relume_image_destroy(&(*gonio)->atlas);
    mem_free(*gonio);
    *gonio = NULL;
}

const struct relume_image *relume_gonio_map(const relume_gonio *gonio)
{
    return &gonio->atlas;
}

void relume_gonio_value(float rgb[3], const relume_gonio *g, struct relume_vec3 direction)
{
    double xy[2];
    const int face = place_direction(xy, g->side, direction);
    const double x = fmin(fmax(xy[0], 0.0), g->side) - 0.5;
    const double y = fmin(fmax(xy[1], 0.0), g->side) - 0.5;
    const double left = floor(x), top = floor(y);
    const float *data = g->atlas.data;
    struct bilinear b = {.across = x - left, .down = y - top};
    for (int k = 0; k < 4; k++)
        b.at[k] =
            (size_t)(texel(g, face, relume_whole(left) + k % 2, relume_whole(top) + k / 2) - data) /
            3;
    for (size_t c = 0; c < 3; c++)
        rgb[c] = bilinear_valuef(&b, data, 3, c);
}
