// scenery.c - a captured view as rays meet it
#include "world/transport/scenery.h"

#include "core/base/memory.h"
#include "core/math/distribution.h"
#include "relight/view/view.h"
#include "shape/mesh/places.h"

#include <relume/relight/view.h>
#include <string.h>

// Neighbours are one surface where none is farther from the eye than the other by more than a
// fifth: at 5 degrees, a pixel of half a degree of floor is farther than the one below by a tenth.
static const double STEP = 1.2;
// Directions of neighbours of a panorama are apart by a pixel; beside the border of a face or disc
// they are not.
static const double APART = 4.0;
enum { MOST_VERTICES = 1 << 19 };

struct scenery {
    struct relume_geometry geometry;
    vec3 eye;
    double farthest;  // of surfaces; infinite: there is no background
    int width, height;
    int block;         // pixels along each side of a vertex
    int across, down;  // vertices
    struct mesh mesh;
    tracer *tracer;
    float (*sent)[3];             // [vertices]
    struct distribution senders;  // triangles, and behind them vertices of the background
    struct relume_image far, relit;
};

void scenery_destroy(struct scenery **c)
{
    struct scenery *old = *c;
    *c = NULL;
    if (!old)
        return;
    trace_destroy(&old->tracer);
    mesh_free(&old->mesh);
    relume_image_destroy(&old->far);
    relume_image_destroy(&old->relit);
    distribution_free(&old->senders);
    mem_free(old->sent);
    mem_free(old);
}

bool scenery_is_around(const struct scenery *c)
{
    return c->geometry.projection >= RELUME_CYLINDRICAL;
}

static double distance_to(const struct scenery *c, vec3 place)
{
    return vec3_length(vec3_sub(place, c->eye));
}

// Of all pixels, the part that is about as far as `most`.
static double part_at(const struct scenery *c, const struct relume_image *places, double most)
{
    const double ABOUT = 0.999;
    size_t n = 0;
    for (int y = 0; y < c->height; y++)
        for (int x = 0; x < c->width; x++)
            n += distance_to(c, places_at_xy(places, x, y)) >= ABOUT * most;
    return (double)n / ((double)c->width * c->height);
}

// Renderers put the background a thousand times as far as the farthest surface. Depth maps of
// photographs end at the largest number that they can hold, and many pixels have that: the sky.
// Without any surface all is background.
static double find_farthest(const struct scenery *c, const struct relume_image *places)
{
    const double BACKGROUND = 1000.0, NEAR = 0.5, MANY = 0.01, ALL = 0.9, BEFORE = 0.998;
    double least = INFINITY, most = 0.0;
    for (int y = 0; y < c->height; y++)
        for (int x = 0; x < c->width; x++) {
            const double d = distance_to(c, places_at_xy(places, x, y));
            least = fmin(least, d);
            most = fmax(most, d);
        }
    if (!(most > 0.0))
        return 0.0;
    if (most * NEAR > least * BACKGROUND)
        return most / BACKGROUND / NEAR;
    const double part = part_at(c, places, most);
    return part > MANY && part < ALL ? BEFORE * most : INFINITY;
}

static bool is_surface(const struct scenery *c, vec3 place)
{
    return distance_to(c, place) <= c->farthest;
}

bool scenery_holds(const struct scenery *c, vec3 place)
{
    return is_surface(c, place);
}

// ---------------------------------------------------------------- the mesh

static size_t vertex_of(const struct scenery *c, int column, int row)
{
    return (size_t)row * (size_t)c->across + (size_t)(column % c->across);
}

static void add_vertices(struct scenery *c, const struct relume_image *places)
{
    for (int row = 0; row < c->down; row++)
        for (int column = 0; column < c->across; column++) {
            const vec3 place = places_at_xy(places, column * c->block + c->block / 2,
                                            row * c->block + c->block / 2);
            const bool is = is_surface(c, place);
            (void)mesh_vertex(&c->mesh, is ? place : c->eye, vec3_of(0, 0, 1), vec3_of(0, 0, 0));
        }
}

static double nominal_angle(const struct scenery *c)
{
    const double around = c->geometry.projection == RELUME_CUBE ? 3.0 * M_PI : 2.0 * M_PI;
    return c->geometry.projection >= RELUME_CYLINDRICAL ? around / c->across : INFINITY;
}

static bool are_neighbours(const struct scenery *c, size_t a, size_t b)
{
    const vec3 to_a = vec3_sub(vertex_position(&c->mesh.vertices[a]), c->eye);
    const vec3 to_b = vec3_sub(vertex_position(&c->mesh.vertices[b]), c->eye);
    const double la = vec3_length(to_a), lb = vec3_length(to_b);
    if (!(la > 0.0 && lb > 0.0 && la <= STEP * lb && lb <= STEP * la))
        return false;
    const double sine = vec3_length(vec3_cross(to_a, to_b)) / (la * lb);
    return vec3_dot(to_a, to_b) > 0.0 && sine <= sin(fmin(APART * nominal_angle(c), 0.5 * M_PI));
}

static void add_triangle(struct scenery *c, size_t i, size_t j, size_t k)
{
    if (are_neighbours(c, i, j) && are_neighbours(c, j, k) && are_neighbours(c, k, i))
        mesh_triangle(&c->mesh, (uint32_t)i, (uint32_t)j, (uint32_t)k, 0);
}

static void add_triangles(struct scenery *c)
{
    const bool wraps =
        c->geometry.projection == RELUME_CYLINDRICAL || c->geometry.projection == RELUME_SPHERICAL;
    const int last = wraps ? c->across : c->across - 1;
    for (int row = 0; row + 1 < c->down; row++)
        for (int column = 0; column < last; column++) {
            const size_t at = vertex_of(c, column, row), right = vertex_of(c, column + 1, row);
            const size_t below = vertex_of(c, column, row + 1),
                         beyond = vertex_of(c, column + 1, row + 1);
            add_triangle(c, at, below, right);
            add_triangle(c, right, below, beyond);
        }
}

// Above and below the outermost rows of a sphere.
static void add_poles(struct scenery *c)
{
    if (c->geometry.projection != RELUME_SPHERICAL)
        return;
    for (int column = 1; column + 1 < c->across; column++) {
        add_triangle(c, vertex_of(c, 0, 0), vertex_of(c, column, 0), vertex_of(c, column + 1, 0));
        add_triangle(c, vertex_of(c, 0, c->down - 1), vertex_of(c, column + 1, c->down - 1),
                     vertex_of(c, column, c->down - 1));
    }
}

static relume_status build(struct scenery *c, const struct relume_image *places,
                           const struct relume_log *log)
{
    c->farthest = find_farthest(c, places);
    add_vertices(c, places);
    if (!c->mesh.failed) {
        add_triangles(c);
        add_poles(c);
    }
    c->sent = mem_zeroed((size_t)c->across * (size_t)c->down, sizeof *c->sent);
    if (c->mesh.failed || !c->sent)
        return RELUME_ENOMEM;
    return c->mesh.triangle_count ? trace_create(&c->tracer, &c->mesh, log) : RELUME_OK;
}

// Which pixels are background, as 1 in `far`.
static relume_status mark_far(struct scenery *c, const struct relume_image *places)
{
    const relume_status status = relume_image_create(&c->far, c->width, c->height, 3);
    if (status)
        return status;
    for (int y = 0; y < c->height; y++)
        for (int x = 0; x < c->width; x++) {
            const vec3 place = places_at_xy(places, x, y);
            float *to = c->far.data + 3 * ((size_t)y * (size_t)c->width + (size_t)x);
            const bool shows = !isnan(place.x) || c->farthest == 0.0;
            to[0] = to[1] = to[2] = shows && !is_surface(c, place) ? 1.0f : 0.0f;
        }
    return RELUME_OK;
}

relume_status scenery_create(struct scenery **out, const struct relume_geometry *geometry, vec3 eye,
                             const struct relume_image *places, const struct relume_log *log)
{
    struct scenery *c = mem_zeroed(1, sizeof *c);
    *out = NULL;
    if (!c)
        return RELUME_ENOMEM;
    *c = (struct scenery){.geometry = *geometry, .eye = eye, .block = 1};
    c->width = places->width, c->height = places->height;
    while ((c->width / c->block) * (c->height / c->block) > MOST_VERTICES)
        c->block++;
    c->across = c->width / c->block > 0 ? c->width / c->block : 1;
    c->down = c->height / c->block > 0 ? c->height / c->block : 1;
    relume_status status = build(c, places, log);
    if (!status)
        status = mark_far(c, places);
    if (status)
        scenery_destroy(&c);
    *out = c;
    return status;
}

// ---------------------------------------------------------------- light

static void mean_of_block(float rgb[3], const struct scenery *c, const struct relume_image *relit,
                          int column, int row)
{
    double sum[3] = {0.0, 0.0, 0.0};
    for (int y = row * c->block; y < (row + 1) * c->block; y++)
        for (int x = column * c->block; x < (column + 1) * c->block; x++)
            for (int k = 0; k < 3; k++)
                sum[k] +=
                    (double)relit->data[3 * ((size_t)y * (size_t)c->width + (size_t)x) + (size_t)k];
    for (int k = 0; k < 3; k++)
        rgb[k] = (float)fmax(sum[k] / (c->block * c->block), 0.0);
}

// ---------------------------------------------------------------- senders of light

static size_t background_count(const struct scenery *c)
{
    return c->geometry.projection >= RELUME_CYLINDRICAL ? (size_t)c->across * (size_t)c->down : 0;
}

static double luminous(const float rgb[3])
{
    return (double)(rgb[0] + rgb[1] + rgb[2]);
}

// Its area times its normal.
static vec3 area_of(const vec3 corner[3])
{
    return vec3_scale(mesh_twice_area(corner), 0.5);
}

// The light of a triangle as it arrives at a place, but for what turns away.
static double light_of(const struct scenery *c, size_t triangle, vec3 middle)
{
    const uint32_t *v = c->mesh.triangles[triangle].vertex;
    vec3 corner[3];
    mesh_corners(corner, &c->mesh, triangle);
    const vec3 to = vec3_sub(corner[0], middle), area = area_of(corner);
    const double distance = fmax(vec3_length(to), 1e-9);
    const double sent = luminous(c->sent[v[0]]) + luminous(c->sent[v[1]]) + luminous(c->sent[v[2]]);
    return sent / 3.0 * fabs(vec3_dot(area, to)) / (distance * distance * distance);
}

// A vertex of the background is a block of pixels.
static vec3 block_direction(const struct scenery *c, size_t block, double x, double y)
{
    const size_t column = block % (size_t)c->across, row = block / (size_t)c->across;
    return relume_panorama_ray(&c->geometry, c->width, c->height, ((double)column + x) * c->block,
                               ((double)row + y) * c->block);
}

static double block_angle(const struct scenery *c, size_t block)
{
    const vec3 across =
        vec3_sub(block_direction(c, block, 1.0 - 1e-6, 0.5), block_direction(c, block, 1e-6, 0.5));
    const vec3 down =
        vec3_sub(block_direction(c, block, 0.5, 1.0 - 1e-6), block_direction(c, block, 0.5, 1e-6));
    return vec3_length(vec3_cross(across, down));
}

static bool is_background(const struct scenery *c, size_t block)
{
    const size_t column = block % (size_t)c->across, row = block / (size_t)c->across;
    const size_t x = column * (size_t)c->block + (size_t)c->block / 2,
                 y = row * (size_t)c->block + (size_t)c->block / 2;
    return c->far.data[3 * (y * (size_t)c->width + x)] > 0.0f;
}

static relume_status find_senders(struct scenery *c, vec3 middle)
{
    const size_t triangles = c->mesh.triangle_count, blocks = background_count(c);
    double *light = mem_array(triangles + blocks, sizeof *light);
    if (!light)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < triangles; i++)
        light[i] = light_of(c, i, middle);
    for (size_t i = 0; i < blocks; i++)
        light[triangles + i] = is_background(c, i) ? luminous(c->sent[i]) * block_angle(c, i) : 0.0;
    distribution_make(&c->senders, light, triangles + blocks);
    return RELUME_OK;
}

bool scenery_draw(vec3 *towards, size_t *source, const struct scenery *c, vec3 origin,
                  const double random[3])
{
    vec3 corner[3];
    if (!distribution_draw(source, &c->senders, random[0]))
        return false;
    if (*source >= c->mesh.triangle_count) {
        *towards = block_direction(c, *source - c->mesh.triangle_count, random[1], random[2]);
        return true;
    }
    mesh_corners(corner, &c->mesh, *source);
    const double r = sqrt(random[1]);  // evenly over the triangle (Turk 1990)
    const vec3 place =
        vec3_along(vec3_along(vec3_scale(corner[0], 1.0 - r), corner[1], r * (1.0 - random[2])),
                   corner[2], r * random[2]);
    *towards = vec3_unit(vec3_sub(place, origin));
    return vec3_length(vec3_sub(place, origin)) > 0.0;
}

double scenery_density(const struct scenery *c, const struct scenery_hit *hit, vec3 direction)
{
    vec3 corner[3];
    if (hit->source >= c->mesh.triangle_count + background_count(c))
        return 0.0;
    const double chance = distribution_chance(&c->senders, hit->source);
    if (hit->source >= c->mesh.triangle_count)
        return chance / fmax(block_angle(c, hit->source - c->mesh.triangle_count), 1e-12);
    mesh_corners(corner, &c->mesh, hit->source);
    const double facing = fabs(vec3_dot(area_of(corner), direction));
    return chance * hit->distance * hit->distance / fmax(facing, 1e-30);
}

relume_status scenery_light(struct scenery *c, const struct relume_image *relit, vec3 middle)
{
    if (relit->width != c->width || relit->height != c->height)
        return RELUME_EINVAL;
    relume_image_destroy(&c->relit);
    const relume_status status = relume_image_create(&c->relit, c->width, c->height, 3);
    if (status)
        return status;
    const size_t values = 3 * (size_t)c->width * (size_t)c->height;
    for (size_t i = 0; i < values; i++)
        c->relit.data[i] = isfinite(relit->data[i]) ? fmaxf(relit->data[i], 0.0f) : 0.0f;
    for (int row = 0; row < c->down; row++)
        for (int column = 0; column < c->across; column++)
            mean_of_block(c->sent[vertex_of(c, column, row)], c, &c->relit, column, row);
    return find_senders(c, middle);
}

static void far_value(float rgb[3], const struct scenery *c, vec3 direction)
{
    if (!c->relit.data || !relume_panorama_sample(rgb, &c->geometry, &c->relit, direction, NULL))
        rgb[0] = rgb[1] = rgb[2] = 0.0f;
}

size_t scenery_pieces(const struct scenery *c)
{
    return background_count(c);
}

double scenery_piece(vec3 *direction, float sent[3], const struct scenery *c, size_t piece,
                     double x, double y)
{
    if (!is_background(c, piece))
        return 0.0;
    *direction = block_direction(c, piece, x, y);
    memcpy(sent, c->sent[piece], 3 * sizeof *sent);
    return block_angle(c, piece);
}

static void background(struct scenery_hit *out, const struct scenery *c, vec3 direction)
{
    double at[2];
    *out = (struct scenery_hit){.distance = INFINITY, .source = SIZE_MAX};
    if (!background_count(c) ||
        !relume_panorama_pixel(at, &c->geometry, c->width, c->height, direction))
        return;
    const size_t column = (size_t)at[0] / (size_t)c->block, row = (size_t)at[1] / (size_t)c->block;
    if (column >= (size_t)c->across || row >= (size_t)c->down)
        return;
    const size_t block = row * (size_t)c->across + column;
    if (!is_background(c, block))
        return;
    out->source = c->mesh.triangle_count + block;
    far_value(out->sent, c, direction);
}

void scenery_mean(float rgb[3], const struct scenery *c)
{
    enum { DIRECTIONS = 1024 };
    const double golden = M_PI * (3.0 - sqrt(5.0));
    double sum[3] = {0.0, 0.0, 0.0};
    const size_t pixels = (size_t)c->width * (size_t)c->height;
    const bool around = c->geometry.projection >= RELUME_CYLINDRICAL;
    for (int i = 0; i < DIRECTIONS && c->relit.data; i++) {
        const double z = 1.0 - (2.0 * i + 1.0) / DIRECTIONS, r = sqrt(1.0 - z * z);
        const vec3 d = vec3_of(r * cos(golden * i), z, r * sin(golden * i));
        const float *pixel = c->relit.data + 3 * (pixels * (size_t)i / DIRECTIONS);
        float value[3] = {pixel[0], pixel[1], pixel[2]};
        if (around)
            far_value(value, c, d);
        for (int k = 0; k < 3; k++)
            sum[k] += (double)value[k] / DIRECTIONS;
    }
    for (int k = 0; k < 3; k++)
        rgb[k] = (float)sum[k];
}

vec3 scenery_eye(const struct scenery *c)
{
    return c->eye;
}

const struct mesh *scenery_mesh(const struct scenery *c)
{
    return &c->mesh;
}

int scenery_blocks(int *across, const struct scenery *c)
{
    *across = c->across;
    return c->block;
}

void scenery_sent(float rgb[3], const struct scenery *c, size_t triangle, float u, float v)
{
    const uint32_t *vertex = c->mesh.triangles[triangle].vertex;
    for (int k = 0; k < 3; k++)
        rgb[k] = (1.0f - u - v) * c->sent[vertex[0]][k] + u * c->sent[vertex[1]][k] +
                 v * c->sent[vertex[2]][k];
}

// ---------------------------------------------------------------- rays

static vec3 normal_of(const struct scenery *c, const struct triangle *t, vec3 towards)
{
    const vec3 a = vertex_position(&c->mesh.vertices[t->vertex[0]]);
    const vec3 b = vertex_position(&c->mesh.vertices[t->vertex[1]]);
    const vec3 d = vertex_position(&c->mesh.vertices[t->vertex[2]]);
    const vec3 n = vec3_unit(vec3_cross(vec3_sub(b, a), vec3_sub(d, a)));
    return vec3_dot(n, towards) < 0.0 ? vec3_scale(n, -1.0) : n;
}

bool scenery_meet(struct scenery_hit *out, const struct scenery *c, vec3 origin, vec3 direction)
{
    float from[3], along[3];
    struct trace_hit hit;
    vec3_store(from, origin);
    vec3_store(along, direction);
    if (!c->tracer || !trace_closest(c->tracer, from, along, &hit)) {
        background(out, c, direction);
        return false;
    }
    out->source = hit.triangle;
    out->distance = (double)hit.distance;
    out->place = vec3_along(origin, direction, out->distance);
    out->normal = normal_of(c, &c->mesh.triangles[hit.triangle], vec3_scale(direction, -1.0));
    scenery_sent(out->sent, c, hit.triangle, hit.u, hit.v);
    return true;
}

vec3 scenery_leave(const struct scenery *c, vec3 place, vec3 normal)
{
    const double OFF = 0.005;
    return vec3_along(place, normal, OFF * distance_to(c, place));
}

bool scenery_reached(const struct scenery *c, vec3 start, vec3 towards, double distance)
{
    float from[3], along[3];
    struct trace_hit hit;
    vec3_store(from, start);
    vec3_store(along, towards);
    return !c->tracer || !trace_closest(c->tracer, from, along, &hit) ||
           (double)hit.distance >= distance;
}
