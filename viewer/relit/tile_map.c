// tile_map.c - a large view and its reduced levels as many small views, by one number
#include "relit/tile_map.h"

#include "format/pack/views.h"
#include "relit/gl_relighter.h"

static const int64_t LARGE = 64 << 20, MOST_PIXELS = 2 << 20;

static int across(int side)
{
    return (side + TILE_SIDE - 1) / TILE_SIDE;
}

// Passes, near lights and looks into a panorama have only this level, so that it is the finest that
// is held; but a plane that would be long in coming is known by few pixels.
static int find_base(const relume_pack *pack, size_t bytes)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const bool planar = info->geometry.projection == RELUME_PLANAR;
    const bool large = planar && (int64_t)info->width * info->height > LARGE;
    for (int level = 0; level < info->levels; level++) {
        struct relume_codes codes = {.planes = info->planes, .storage = info->storage};
        relume_pack_level_size(&codes.width, &codes.height, pack, level);
        if (gl_relighter_view_bytes(&codes) <= (planar && level ? bytes / 2 : bytes) &&
            (!large || (int64_t)codes.width * codes.height <= MOST_PIXELS))
            return level;
    }
    return info->levels;
}

void tile_map_make(struct tile_map *map, const relume_pack *pack, size_t bytes)
{
    *map = (struct tile_map){.levels = find_base(pack, bytes)};
    for (int i = 0; i < map->levels; i++) {
        relume_pack_level_size(&map->width[i], &map->height[i], pack, i);
        map->first[i + 1] = map->first[i] + across(map->width[i]) * across(map->height[i]);
    }
}

int tile_map_number(const struct tile_map *map, int level, int column, int row)
{
    return map->first[level] + row * across(map->width[level]) + column;
}

static struct relume_rect with_margin(struct relume_rect inner, int width, int height)
{
    const int left = inner.left < TILE_MARGIN ? 0 : inner.left - TILE_MARGIN;
    const int top = inner.top < TILE_MARGIN ? 0 : inner.top - TILE_MARGIN;
    const int right = inner.left + inner.width + TILE_MARGIN;
    const int bottom = inner.top + inner.height + TILE_MARGIN;
    return (struct relume_rect){left, top, (right < width ? right : width) - left,
                                (bottom < height ? bottom : height) - top};
}

struct tile tile_map_tile(const struct tile_map *map, int number)
{
    int level = 0;
    while (number >= map->first[level + 1])
        level++;
    const int width = map->width[level], height = map->height[level];
    const int n = number - map->first[level];
    const int left = n % across(width) * TILE_SIDE, top = n / across(width) * TILE_SIDE;
    const struct relume_rect inner = {left, top,
                                      width - left < TILE_SIDE ? width - left : TILE_SIDE,
                                      height - top < TILE_SIDE ? height - top : TILE_SIDE};
    return (struct tile){level, inner, with_margin(inner, width, height)};
}
