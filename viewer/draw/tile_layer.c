// tile_layer.c - a large view in its own pixels: tiles of the level that the frame asks for, over
// all of it at a coarser one
#include "draw/tile_layer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

relume_status tile_layer_create(struct tile_layer *l, const struct code_source *source,
                                const struct tile_map *map, struct gl_relighter *view)
{
    const int tiles = map->first[map->levels];
    l->tile = calloc((size_t)tiles, sizeof *l->tile);
    if (!l->tile)
        return RELUME_ENOMEM;
    const relume_status status =
        gl_relighter_create(&l->relighter, view->gl, source, tiles, view->log);
    if (!status)
        l->map = map;
    l->relighter.by_library = view->by_library;
    l->relighter.threads = view->threads;
    view->memory.most /= 2;
    l->relighter.memory.most = view->memory.most;
    return status;
}

void tile_layer_destroy(struct tile_layer *l)
{
    gl_relighter_destroy(&l->relighter);
    free(l->tile);
    *l = (struct tile_layer){.map = NULL};
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

static struct tiles_seen find_seen(const struct tile_layer *l, const struct frame_request *q,
                                   int level)
{
    const struct app_rectangle *p = &q->picture;
    struct tiles_seen s = {.level = level};
    find_range(&s, 0, -p->left, q->width - p->left, p->right - p->left,
               ldexp(l->map->width[0], -level));
    find_range(&s, 1, -p->top, q->height - p->top, p->bottom - p->top,
               ldexp(l->map->height[0], -level));
    return s;
}

static int count(const struct tiles_seen *s)
{
    const int wide = s->end[0] - s->begin[0], high = s->end[1] - s->begin[1];
    return wide > 0 && high > 0 ? wide * high : 0;
}

// The level that has at least a pixel for each of the frame, coarser where its tiles would be more
// than the memory; map->levels: all of it is fine enough.
static struct tiles_seen choose_level(const struct tile_layer *l, const struct frame_request *q)
{
    const double each = l->map->width[0] / fmax(q->picture.right - q->picture.left, 1e-6);
    int level = 0;
    while (level < l->map->levels && ldexp(each, -level - 1) >= 1.0)
        level++;
    struct tiles_seen seen = find_seen(l, q, level);
    while (level < l->map->levels &&
           (size_t)count(&seen) * l->tile_bytes > l->relighter.memory.most)
        seen = find_seen(l, q, ++level);
    return seen;
}

relume_status tile_layer_relight(struct tile_layer *l, const struct frame_request *q,
                                 const struct relume_light *lights, int n)
{
    const struct tiles_seen seen = choose_level(l, q);
    const bool suits = q->camera.framing == RELUME_FRAME_VIEW && q->pass == RELUME_PASS_COLOUR;
    bool near = false;
    for (int i = 0; i < n; i++)
        near |= relume_light_is_near(lights[i].kind);
    memset(l->tile, 0, (size_t)l->map->first[l->map->levels] * sizeof *l->tile);
    l->relighter.pending = false;
    if (!suits || near || seen.level == l->map->levels)
        return RELUME_OK;
    relume_status status = gl_relighter_begin(&l->relighter, lights, n);
    for (int y = seen.begin[1]; !status && y < seen.end[1]; y++)
        for (int x = seen.begin[0]; !status && x < seen.end[0]; x++) {
            const int number = tile_map_number(l->map, seen.level, x, y);
            status = gl_relighter_view(&l->tile[number], &l->relighter, number);
        }
    return status;
}

// A rectangle of a level in the frame.
static struct app_rectangle rectangle_of(const struct tile_layer *l,
                                         const struct app_rectangle *picture, int level,
                                         const struct relume_rect *rect)
{
    const double x = ldexp((picture->right - picture->left) / l->map->width[0], level);
    const double y = ldexp((picture->bottom - picture->top) / l->map->height[0], level);
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
static void draw_rect(const struct tile_layer *l, const struct program *picture,
                      const struct frame_area *area, const struct target *relit, int level,
                      const struct relume_rect *rect, const struct relume_rect *inner)
{
    const struct app_rectangle within = rectangle_of(l, &area->picture, level, inner);
    struct frame_area own = *area;
    own.picture = rectangle_of(l, &area->picture, level, rect);
    draw_picture_within(picture, l->relighter.gl, &own, relit, clipped(within, &area->picture));
}

void tile_layer_draw(const struct tile_layer *l, const struct program *picture,
                     const struct frame_area *area, const struct target *view)
{
    const struct relume_rect all = {0, 0, view->width, view->height};
    draw_rect(l, picture, area, view, l->map->levels, &all, &all);
    for (int i = 0; i < l->map->first[l->map->levels]; i++) {
        const struct tile tile = tile_map_tile(l->map, i);
        if (l->tile[i])
            draw_rect(l, picture, area, l->tile[i], tile.level, &tile.rect, &tile.inner);
    }
}
