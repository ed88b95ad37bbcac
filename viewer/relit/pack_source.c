// pack_source.c - a relume file that several threads read views from, one at a time
#include "format/coder/coding.h"
#include "format/pack/views.h"
#include "relight/frame/renderer_views.h"
#include "relight/shadow/moving.h"
#include "relight/view/view.h"
#include "relit/pack_source.h"

#include <relume/renderer.h>

#include <pthread.h>
#include <stdlib.h>

// Codes of a view, or of a tile of one.
struct piece {
    struct relume_codes_part part;  // of a reduced level or a tile; empty: the pack has them
    int users;
};

struct pack_source {
    relume_pack *pack;
    pthread_mutex_t lock;
    int base;  // the level that views are known by
    struct tile_map map;
    struct piece *view, *tile;  // [views], [tiles]
};

relume_status pack_source_create(struct pack_source **out, relume_pack *pack, size_t bytes)
{
    struct pack_source *s = *out = calloc(1, sizeof *s);
    if (!s)
        return RELUME_ENOMEM;
    s->pack = pack;
    tile_map_make(&s->map, pack, bytes);
    s->base = s->map.levels;
    pthread_mutex_init(&s->lock, NULL);
    s->view = calloc((size_t)relume_pack_info(pack)->views, sizeof *s->view);
    s->tile = calloc((size_t)s->map.first[s->map.levels] + 1, sizeof *s->tile);
    if (s->view && s->tile)
        return RELUME_OK;
    pack_source_destroy(out);
    return RELUME_ENOMEM;
}

void pack_source_destroy(struct pack_source **source)
{
    struct pack_source *s = *source;
    *source = NULL;
    if (!s)
        return;
    pthread_mutex_destroy(&s->lock);
    free(s->view);
    free(s->tile);
    free(s);
}

const struct tile_map *pack_source_map(const struct pack_source *source)
{
    return &source->map;
}

// With the lock.
static relume_status read_piece(const struct relume_codes **out, struct pack_source *s,
                                struct piece *piece, int view, int level,
                                const struct relume_rect *rect)
{
    relume_status status = RELUME_OK;
    if (!piece->part.memory)
        status = relume_pack_codes_level(&piece->part, s->pack, view, level, rect);
    *out = &piece->part.codes;
    piece->users += !status;
    return status;
}

static relume_status read_codes(const struct relume_codes **out, void *user, int view)
{
    struct pack_source *s = user;
    struct relume_rect all = {0};
    relume_status status;
    relume_pack_level_size(&all.width, &all.height, s->pack, s->base);
    pthread_mutex_lock(&s->lock);
    if (s->base) {
        status = read_piece(out, s, &s->view[view], view, s->base, &all);
    } else {
        status = relume_pack_codes(out, s->pack, view);
        s->view[view].users += !status;
    }
    pthread_mutex_unlock(&s->lock);
    return status;
}

static relume_status read_tile(const struct relume_codes **out, void *user, int number)
{
    struct pack_source *s = user;
    const struct tile tile = tile_map_tile(&s->map, number);
    pthread_mutex_lock(&s->lock);
    const relume_status status = read_piece(out, s, &s->tile[number], 0, tile.level, &tile.rect);
    pthread_mutex_unlock(&s->lock);
    return status;
}

static void drop_tile(void *user, int number)
{
    struct pack_source *s = user;
    pthread_mutex_lock(&s->lock);
    if (--s->tile[number].users == 0)
        relume_codes_part_destroy(&s->tile[number].part);
    pthread_mutex_unlock(&s->lock);
}

static relume_status read_part(struct relume_codes_part *out, void *user, int view,
                               const struct relume_rect *at)
{
    struct pack_source *s = user;
    pthread_mutex_lock(&s->lock);
    const relume_status status = relume_pack_codes_part(out, s->pack, view, at);
    pthread_mutex_unlock(&s->lock);
    return status;
}

static void drop_codes(void *user, int view)
{
    struct pack_source *s = user;
    pthread_mutex_lock(&s->lock);
    if (--s->view[view].users == 0 && s->base)
        relume_codes_part_destroy(&s->view[view].part);
    else if (s->view[view].users == 0)
        relume_pack_drop(s->pack, view);
    pthread_mutex_unlock(&s->lock);
}

static relume_status read_depth(struct relume_image *out, void *user, int view)
{
    struct pack_source *s = user;
    pthread_mutex_lock(&s->lock);
    const relume_status status = relume_pack_depth_level(out, s->pack, view, s->base);
    pthread_mutex_unlock(&s->lock);
    return status;
}

static relume_status find_surface(struct relume_image *out, void *user, int view)
{
    struct pack_source *s = user;
    const struct relume_pack_info *info = relume_pack_info(s->pack);
    struct relume_image depth;
    int width, height;
    relume_pack_level_size(&width, &height, s->pack, s->base);
    relume_status status = read_depth(&depth, user, view);
    if (!status)
        status = relume_view_positions(out, relume_pack_geometry(s->pack, view), info->uv[view],
                                       depth.data ? &depth : NULL, width, height);
    relume_image_destroy(&depth);
    return status;
}

static relume_status find_shadows(relume_shadows **out, void *user, int view)
{
    struct pack_source *s = user;
    pthread_mutex_lock(&s->lock);
    const relume_status status = relume_shadows_open(out, s->pack, view);
    pthread_mutex_unlock(&s->lock);
    return status;
}

static relume_status find_places(struct relume_image *out, void *user, int view)
{
    struct pack_source *s = user;
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW, .view = view};
    const struct relume_pack_info *info = relume_pack_info(s->pack);
    const bool is_far = !info->has_depth && info->geometry.projection >= RELUME_CYLINDRICAL;
    const double FAR = 1e6;  // panoramas without depth
    relume_renderer *renderer;
    pthread_mutex_lock(&s->lock);
    relume_status status = relume_renderer_create(
        &renderer, s->pack, relume_frame_params(.assume_depth = is_far ? FAR : 0.0));
    if (!status)
        status = relume_renderer_places(out, renderer, &camera);
    relume_renderer_destroy(&renderer);
    pthread_mutex_unlock(&s->lock);
    return status;
}

struct depth_source pack_source_places(struct pack_source *source)
{
    return (struct depth_source){find_places, source};
}

struct code_source pack_source_codes(struct pack_source *source)
{
    const struct relume_pack_info *info = relume_pack_info(source->pack);
    return (struct code_source){read_codes, drop_codes, source, find_surface,
                                info->has_shadow || info->has_gloss ? find_shadows : NULL};
}

struct code_source pack_source_tiles(struct pack_source *source)
{
    return (struct code_source){.codes = read_tile, .drop = drop_tile, .user = source};
}

struct part_source pack_source_parts(struct pack_source *source)
{
    return (struct part_source){read_part, source};
}

struct depth_source pack_source_depth(struct pack_source *source)
{
    return (struct depth_source){read_depth, source};
}
