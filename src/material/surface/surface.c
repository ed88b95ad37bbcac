// surface.c - values of a surface between its texels: texels are found through the map, evaluated,
// then interpolated, so that no cut shows (thesis, 9.5, 9.6)
#include "material/surface/surface.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/bilinear.h"
#include "material/btf/values.h"
#include "material/model/environment.h"
#include "material/surface/texels.h"

// Footprints rounder than 1.06 count as round: their middle is enough. Longer ones than 7 to 1 take
// a coarser level.
static const double SQUARE = 0.0625, MOST_RATIO = 7.0;

// ---------------------------------------------------------------- levels of the map

static size_t texel_of(const struct relume_btf_map_info *m, size_t tile, int x, int y)
{
    return (tile * (size_t)m->height + (size_t)y) * (size_t)m->width + (size_t)x;
}

// The texel of the sample's next level that `texel` is part of.
static uint32_t parent(uint32_t texel, const struct relume_btf_map_info *from,
                       const struct relume_btf_map_info *to)
{
    const uint32_t x = texel % (uint32_t)from->sample_width / 2;
    const uint32_t y = texel / (uint32_t)from->sample_width / 2;
    const uint32_t last_x = (uint32_t)to->sample_width - 1;
    const uint32_t last_y = (uint32_t)to->sample_height - 1;
    return (y < last_y ? y : last_y) * (uint32_t)to->sample_width + (x < last_x ? x : last_x);
}

// What most of the four texels below are part of; where patches keep to the grid of the levels this
// is their mean, on cuts the greatest piece of it.
static uint32_t most_of(const struct relume_btf_map_info *from,
                        const struct relume_btf_map_info *to, size_t tile, int x, int y)
{
    uint32_t of[4];
    int best = 0, most = 0;
    for (int i = 0; i < 4; i++) {
        const int fx = from->width > 1 ? 2 * x + i % 2 : 0;
        const int fy = from->height > 1 ? 2 * y + i / 2 : 0;
        of[i] = parent(from->texel[texel_of(from, tile, fx, fy)], from, to);
    }
    for (int i = 0; i < 4; i++) {
        int count = 0;
        for (int j = 0; j < 4; j++)
            count += of[i] == of[j];
        if (count > most) {
            most = count;
            best = i;
        }
    }
    return of[best];
}

static relume_status make_level(struct surface_level *to, const struct surface_level *from)
{
    struct relume_btf_map_info sizes = from->map;
    sizes.width = btf_half_side(sizes.width);
    sizes.height = btf_half_side(sizes.height);
    sizes.sample_width = to->model->width;
    sizes.sample_height = to->model->height;
    to->map = sizes;
    const relume_status status = map_start(&to->own, &sizes, NULL);
    if (status)
        return RELUME_ENOMEM;
    to->map.texel = to->own->texel;
    uint32_t *out = to->own->texel;
    for (size_t tile = 0; tile < (size_t)sizes.tiles; tile++)
        for (int y = 0; y < sizes.height; y++)
            for (int x = 0; x < sizes.width; x++)
                *out++ = most_of(&from->map, &to->map, tile, x, y);
    // all levels have one matrix
    to->map.matrix = from->map.matrix;
    return RELUME_OK;
}

relume_status surface_start(relume_btf_surface **out, const relume_btf_fitted *model,
                            relume_btf_map *map)
{
    relume_status status = RELUME_OK;
    relume_btf_surface *s = mem_zeroed(1, sizeof *s);
    *out = s;
    if (!s) {
        relume_btf_map_destroy(&map);
        return RELUME_ENOMEM;
    }
    s->level[0] = (struct surface_level){model, map->info, map};
    s->levels = 1;
    while (!status && model->half && s->levels < SURFACE_LEVELS &&
           s->level[s->levels - 1].map.width > 1 && s->level[s->levels - 1].map.height > 1) {
        model = model->half;
        s->level[s->levels].model = model;
        status = make_level(&s->level[s->levels], &s->level[s->levels - 1]);
        s->levels++;
    }
    const struct relume_btf_map_info *m = &s->level[0].map;
    model = s->level[0].model;
    s->info = (struct relume_btf_surface_info){
        .width = m->columns * m->width,
        .height = m->rows * m->height,
        .levels = s->levels,
        .model = model,
        .map = m,
        .bytes = relume_btf_fitted_info(model)->bytes_levels +
                 (model->texels <= 65536 ? 2 : 4) * map_texels(m) +
                 2 * (uint64_t)m->columns * (uint64_t)m->rows,
    };
    if (status)
        relume_btf_surface_destroy(out);
    return status;
}

// The sample as it is.
static relume_status whole_sample(relume_btf_map **out, const relume_btf_fitted *model)
{
    const struct relume_btf_map_info sizes = {.sample_width = model->width,
                                              .sample_height = model->height,
                                              .tiles = 1,
                                              .width = model->width,
                                              .height = model->height,
                                              .columns = 1,
                                              .rows = 1};
    const relume_status status = map_start(out, &sizes, NULL);
    for (size_t i = 0; !status && i < model->texels; i++)
        (*out)->texel[i] = (uint32_t)i;
    return status;
}

relume_status relume_btf_surface_create(relume_btf_surface **out, const relume_btf_fitted *model,
                                        const relume_btf_map *map, const struct relume_log *log)
{
    relume_btf_map *copy;
    *out = NULL;
    if (map && (map->info.sample_width != model->width || map->info.sample_height != model->height))
        return log_fail(
            log, RELUME_EINVAL, "map: of a sample of %d x %d texels; expected %d x %d as the model",
            map->info.sample_width, map->info.sample_height, model->width, model->height);
    relume_status status =
        map ? relume_btf_map_create(&copy, &map->info, log) : whole_sample(&copy, model);
    if (!status)
        status = surface_start(out, model, copy);
    if (!status)
        (*out)->whole = !map;
    return status;
}

void relume_btf_surface_destroy(relume_btf_surface **surface)
{
    relume_btf_surface *s = *surface;
    *surface = NULL;
    if (!s)
        return;
    for (int i = 0; i < s->levels; i++)
        relume_btf_map_destroy(&s->level[i].own);
    relume_btf_fitted_destroy(&s->own);
    mem_free(s);
}

const struct relume_btf_surface_info *relume_btf_surface_info(const relume_btf_surface *s)
{
    return &s->info;
}

struct relume_btf_surface_level relume_btf_surface_level(const relume_btf_surface *s, int level)
{
    return (struct relume_btf_surface_level){s->level[level].model, &s->level[level].map};
}

// ---------------------------------------------------------------- lookups

// A ray between the measured directions.
struct blend {
    struct model_blend at;  // its light is unused under an environment
    const relume_btf_oriented_light *ambient;
    const relume_btf_environment *summed;  // or NULL: an environment that is summed over the lights
    struct relume_btf_oriented_light sky;
    bool between;  // the model says itself what lies between its texels
};

static struct blend blend_of(const relume_btf_surface *s, const struct relume_btf_ray *ray)
{
    const relume_btf_fitted *m = s->level[0].model;
    struct blend b = {.at = {.view = relume_direction_mesh_at(m->view_mesh, ray->view),
                             .v = ray->view,
                             .l = ray->light},
                      .ambient = ray->ambient,
                      .between = s->whole && m->model->continuous && !ray->ambient};
    if (ray->sky && m->model->lit)
        b.sky = sky_ambient(ray->sky, &ray->frame);
    else if (ray->sky)
        b.summed = ray->sky;
    else if (!ray->ambient)
        b.at.light = relume_direction_mesh_at(m->light_mesh, ray->light);
    return b;
}

static void value_of(const relume_btf_fitted *m, size_t texel, const struct blend *b, float rgb[3])
{
    if (b->ambient || b->sky.model)
        ambient_blend(b->ambient ? b->ambient : &b->sky, m, texel, &b->at.view, rgb);
    else
        model_blend(m, texel, &b->at, rgb);
}

// One level, bilinear; (x, y) in texels of the finest.
static void add_level(const struct surface_level *level, const struct relume_btf_map_info *finest,
                      double x, double y, const struct blend *at, float weight, float rgb[3])
{
    const double u = x * level->map.width / finest->width - 0.5;
    const double v = y * level->map.height / finest->height - 0.5;
    const double left = floor(u), top = floor(v);
    if (at->between) {
        struct model_blend one = at->at;
        const double place[2] = {u + 0.5, v + 0.5};
        float value[3];
        one.place = place;
        model_blend(level->model, 0, &one, value);
        for (int c = 0; c < 3; c++)
            rgb[c] += weight * value[c];
        return;
    }
    const struct bilinear b = {.across = u - left, .down = v - top};
    for (int i = 0; i < 4; i++) {
        const float w = bilinear_sharef(&b, i, weight);
        float value[3];
        if (!(w > 0.0f))
            continue;
        value_of(level->model, map_at(&level->map, (int64_t)left + i % 2, (int64_t)top + i / 2), at,
                 value);
        for (int c = 0; c < 3; c++)
            rgb[c] += w * value[c];
    }
}

static void add_point(const relume_btf_surface *s, double x, double y, double level,
                      const struct blend *at, float weight, float rgb[3])
{
    const struct relume_btf_map_info *finest = &s->level[0].map;
    const double l = fmin(fmax(level, 0.0), s->levels - 1);
    const int below = relume_whole(l);
    const float part = (float)(l - below);
    // whole repetitions are dropped, so that far points lose no digits
    const double px =
        x - floor(x / (finest->columns * finest->width)) * finest->columns * finest->width;
    const double py =
        y - floor(y / (finest->rows * finest->height)) * finest->rows * finest->height;
    if (part < 1.0f)
        add_level(&s->level[below], finest, px, py, at, weight * (1.0f - part), rgb);
    if (part > 0.0f)
        add_level(&s->level[below + 1], finest, px, py, at, weight * part, rgb);
}

static bool is_dark(const struct relume_btf_ray *ray)
{
    return !(ray->view.z > 0.0) || (!ray->ambient && !ray->sky && !(ray->light.z > 0.0));
}

// The points that sample a footprint: `ratio` of them `way` apart, on one level. The outermost
// count in part, so that nothing jumps where a footprint grows longer.
struct points {
    double x, y, way[2], level;
    double ratio;
};

static void add_points(const relume_btf_surface *s, const struct points *p, const struct blend *at,
                       float rgb[3])
{
    const int aside = (int)ceil(0.5 * (p->ratio - 1.0));
    for (int i = -aside; i <= aside; i++) {
        const double share = fmin(0.5 * (p->ratio + 1.0) - abs(i), 1.0);
        add_point(s, p->x + i * p->way[0], p->y + i * p->way[1], p->level, at,
                  (float)(share / p->ratio), rgb);
    }
}

// Each measured light alone, times the part of the sky that it represents.
static void sum_sky(const relume_btf_surface *s, const struct points *p, struct blend *at,
                    const struct relume_btf_frame *frame, float rgb[3])
{
    const relume_btf_fitted *m = s->level[0].model;
    at->at.l = vec3_of(0.0, 0.0, 1.0);  // n.l is in the weight
    for (int i = 0; i < m->lights; i++) {
        float weight[3], value[3] = {0.0f, 0.0f, 0.0f};
        relume_btf_environment_weight(weight, at->summed, frame, i);
        at->at.light = model_measured_light(m, i);
        add_points(s, p, at, value);
        for (int c = 0; c < 3; c++)
            rgb[c] += weight[c] * value[c];
    }
}

static void mean_of(const relume_btf_surface *s, const struct points *p,
                    const struct relume_btf_ray *ray, float rgb[3])
{
    struct blend at = blend_of(s, ray);
    if (at.summed)
        sum_sky(s, p, &at, &ray->frame, rgb);
    else
        add_points(s, p, &at, rgb);
}

void relume_btf_surface_evaluate(const relume_btf_surface *s, double x, double y, double level,
                                 const struct relume_btf_ray *ray, float rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (is_dark(ray) || !isfinite(x) || !isfinite(y))
        return;
    mean_of(s, &(struct points){.x = x, .y = y, .level = level, .ratio = 1.0}, ray, rgb);
}

void relume_btf_surface_filter(const relume_btf_surface *s, const struct relume_btf_footprint *f,
                               const struct relume_btf_ray *ray, float rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    const double right = hypot(f->right[0], f->right[1]), down = hypot(f->down[0], f->down[1]);
    if (is_dark(ray) || !isfinite(f->x) || !isfinite(f->y) || !isfinite(right) || !isfinite(down))
        return;
    const double *way = right > down ? f->right : f->down;
    const double longer = fmax(right, down), shorter = fmax(fmin(right, down), 1.0);
    const double ratio = fmin(fmax(longer / shorter - SQUARE, 1.0), MOST_RATIO);
    const double apart = fmax(shorter / fmax(longer, 1.0), 1.0 / MOST_RATIO);
    mean_of(s,
            &(struct points){.x = f->x,
                             .y = f->y,
                             .way = {way[0] * apart, way[1] * apart},
                             .level = log2(fmax(longer / ratio, 1.0)),
                             .ratio = ratio},
            ray, rgb);
}
