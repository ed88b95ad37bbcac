// pack_source.c - a relume file that several threads read views from, one at a time
#include "relit/pack_source.h"

#include <relume/renderer.h>

#include <pthread.h>
#include <stdlib.h>

struct pack_source {
    relume_pack *pack;
    pthread_mutex_t lock;
    int *users;  // [views]: of its codes
};

relume_status pack_source_create(struct pack_source **out, relume_pack *pack)
{
    struct pack_source *s = *out = calloc(1, sizeof *s);
    if (!s)
        return RELUME_ENOMEM;
    s->pack = pack;
    pthread_mutex_init(&s->lock, NULL);
    s->users = calloc((size_t)relume_pack_info(pack)->views, sizeof *s->users);
    if (s->users)
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
    free(s->users);
    free(s);
}

static relume_status read_codes(const struct relume_codes **out, void *user, int view)
{
    struct pack_source *s = user;
    pthread_mutex_lock(&s->lock);
    const relume_status status = relume_pack_codes(out, s->pack, view);
    s->users[view] += !status;
    pthread_mutex_unlock(&s->lock);
    return status;
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
    if (--s->users[view] == 0)
        relume_pack_drop(s->pack, view);
    pthread_mutex_unlock(&s->lock);
}

static relume_status read_depth(struct relume_image *out, void *user, int view)
{
    struct pack_source *s = user;
    pthread_mutex_lock(&s->lock);
    const relume_status status = relume_pack_depth(out, s->pack, view);
    pthread_mutex_unlock(&s->lock);
    return status;
}

static relume_status find_surface(struct relume_image *out, void *user, int view)
{
    struct pack_source *s = user;
    const struct relume_pack_info *info = relume_pack_info(s->pack);
    struct relume_image depth;
    relume_status status = read_depth(&depth, user, view);
    if (!status)
        status = relume_view_positions(out, relume_pack_geometry(s->pack, view), info->uv[view],
                                       depth.data ? &depth : NULL, info->width, info->height);
    relume_image_destroy(&depth);
    return status;
}

static relume_status find_places(struct relume_image *out, void *user, int view)
{
    struct pack_source *s = user;
    const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW, .view = view};
    relume_renderer *renderer;
    pthread_mutex_lock(&s->lock);
    relume_status status = relume_renderer_create(&renderer, s->pack, NULL);
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
    return (struct code_source){read_codes, drop_codes, source, find_surface};
}

struct part_source pack_source_parts(struct pack_source *source)
{
    return (struct part_source){read_part, source};
}

struct depth_source pack_source_depth(struct pack_source *source)
{
    return (struct depth_source){read_depth, source};
}
