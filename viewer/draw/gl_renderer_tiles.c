// gl_renderer_tiles.c - a large view in its own pixels: tiles of the level that the frame asks for,
// over all of it at a coarser one
#include "draw/gl_renderer.h"
#include "draw/gl_renderer_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

relume_status gl_renderer_use_tiles(struct gl_renderer *r, const struct code_source *source,
                                    const struct tile_map *map)
{
    const int tiles = map->first[map->levels];
    if (!tiles || r->views > 1)
        return RELUME_OK;
    r->tile = calloc((size_t)tiles, sizeof *r->tile);
    if (!r->tile)
        return RELUME_ENOMEM;
    const relume_status status = gl_relighter_create(&r->tiles, r->gl, source, tiles, r->log);
    if (!status)
        r->map = map;
    r->tiles.by_library = r->relighter.by_library;
    r->tiles.threads = r->relighter.threads;
    r->relighter.budget /= 2;
    r->tiles.budget = r->relighter.budget;
    return status;
}

void gl_renderer_tiles_destroy(struct gl_renderer *r)
{
    gl_relighter_destroy(&r->tiles);
    free(r->tile);
}

// Tiles of a level that the frame shows, columns and rows: first and behind the last.
struct tiles_seen {
    int level, begin[2], end[2];
};

static void find_range(struct tiles_seen *s, int axis, double from, double to, double of,
                       double side)
{
    const double scale = side / of;  // pixels of the level for each of the frame
    const int most = (int)ceil(side / TILE_SIDE);
    s->begin[axis] = (int)fmax(floor(from * scale / TILE_SIDE), 0.0);
    s->end[axis] = (int)fmin(ceil(to * scale / TILE_SIDE), most);
}

static struct tiles_seen find_seen(const struct gl_renderer *r, const struct frame_request *q,
                                   int level)
{
    const struct app_rectangle *p = &q->picture;
    struct tiles_seen s = {.level = level};
    find_range(&s, 0, -p->left, q->width - p->left, p->right - p->left,
               ldexp(r->map->width[0], -level));
    find_range(&s, 1, -p->top, q->height - p->top, p->bottom - p->top,
               ldexp(r->map->height[0], -level));
    return s;
}

static int count(const struct tiles_seen *s)
{
    const int wide = s->end[0] - s->begin[0], high = s->end[1] - s->begin[1];
    return wide > 0 && high > 0 ? wide * high : 0;
}

static size_t tile_bytes(const struct gl_renderer *r)
{
    return r->view_bytes
               ? r->view_bytes / (size_t)r->size[0] * TILE_SIDE / (size_t)r->size[1] * TILE_SIDE
               : 0;
}

// The level that has at least a pixel for each of the frame, coarser where its tiles would be more
// than the memory; map->levels: all of it is fine enough.
static struct tiles_seen choose_level(const struct gl_renderer *r, const struct frame_request *q)
{
    const double each = r->map->width[0] / fmax(q->picture.right - q->picture.left, 1e-6);
    int level = 0;
    while (level < r->map->levels && ldexp(each, -level - 1) >= 1.0)
        level++;
    struct tiles_seen seen = find_seen(r, q, level);
    while (level < r->map->levels && (size_t)count(&seen) * tile_bytes(r) > r->tiles.budget)
        seen = find_seen(r, q, ++level);
    return seen;
}

relume_status gl_renderer_relight_tiles(struct gl_renderer *r, const struct frame_request *q,
                                        const struct relume_light *lights, int n)
{
    const struct tiles_seen seen = choose_level(r, q);
    const bool suits = q->camera.framing == RELUME_FRAME_VIEW && q->pass == RELUME_PASS_COLOUR;
    bool near = false;
    for (int i = 0; i < n; i++)
        near |= relume_light_is_near(lights[i].kind);
    memset(r->tile, 0, (size_t)r->map->first[r->map->levels] * sizeof *r->tile);
    r->tiles.pending = false;
    if (!suits || near || seen.level == r->map->levels)
        return RELUME_OK;
    relume_status status = gl_relighter_begin(&r->tiles, lights, n);
    for (int y = seen.begin[1]; !status && y < seen.end[1]; y++)
        for (int x = seen.begin[0]; !status && x < seen.end[0]; x++) {
            const int number = tile_map_number(r->map, seen.level, x, y);
            status = gl_relighter_view(&r->tile[number], &r->tiles, number);
        }
    return status;
}

// A rectangle of a level in the frame.
static struct app_rectangle place_of(const struct gl_renderer *r,
                                     const struct app_rectangle *picture, int level,
                                     const struct relume_rect *rect)
{
    const double x = ldexp((picture->right - picture->left) / r->map->width[0], level);
    const double y = ldexp((picture->bottom - picture->top) / r->map->height[0], level);
    return (struct app_rectangle){picture->left + x * rect->left, picture->top + y * rect->top,
                                  picture->left + x * (rect->left + rect->width),
                                  picture->top + y * (rect->top + rect->height)};
}

static struct app_rectangle clipped(struct app_rectangle a, const struct app_rectangle *to)
{
    return (struct app_rectangle){fmax(a.left, to->left), fmax(a.top, to->top),
                                  fmin(a.right, to->right), fmin(a.bottom, to->bottom)};
}

// What a level's last pixel covers may reach beyond the view.
static void draw_rect(struct gl_renderer *r, const struct frame_area *area,
                      const struct target *relit, int level, const struct relume_rect *rect,
                      const struct relume_rect *inner)
{
    const struct app_rectangle within = place_of(r, &area->picture, level, inner);
    struct frame_area own = *area;
    own.picture = place_of(r, &area->picture, level, rect);
    draw_picture_within(&r->picture, r->gl, &own, relit, clipped(within, &area->picture));
}

void gl_renderer_draw_tiles(struct gl_renderer *r, const struct frame_area *area,
                            const struct target *view)
{
    const struct relume_rect all = {0, 0, view->width, view->height};
    draw_rect(r, area, view, r->map->levels, &all, &all);
    for (int i = 0; i < r->map->first[r->map->levels]; i++) {
        const struct tile tile = tile_map_tile(r->map, i);
        if (r->tile[i])
            draw_rect(r, area, r->tile[i], tile.level, &tile.rect, &tile.inner);
    }
}
