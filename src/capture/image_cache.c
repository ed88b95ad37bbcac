// image_cache.c - decoded images that stay in memory for tables to come, within a budget
#include "capture/image_cache.h"

#include "base/memory.h"

relume_status image_cache_create(struct image_cache **out, int images, size_t budget)
{
    struct image_cache *k = *out = mem_zeroed(1, sizeof *k);
    if (!k)
        return RELUME_ENOMEM;
    pthread_mutex_init(&k->lock, NULL);
    k->left = budget;
    k->images = images;
    k->image = mem_zeroed((size_t)images, sizeof *k->image);
    return k->image ? RELUME_OK : RELUME_ENOMEM;
}

void image_cache_destroy(struct image_cache **cache)
{
    struct image_cache *k = *cache;
    *cache = NULL;
    if (!k)
        return;
    for (int i = 0; k->image && i < k->images; i++)
        mem_free(k->image[i]);
    mem_free(k->image);
    pthread_mutex_destroy(&k->lock);
    mem_free(k);
}

const uint8_t *image_cache_find(struct image_cache *cache, int image)
{
    pthread_mutex_lock(&cache->lock);
    const uint8_t *found = cache->image[image];
    pthread_mutex_unlock(&cache->lock);
    return found;
}

static void give_back(struct image_cache *cache, size_t bytes)
{
    pthread_mutex_lock(&cache->lock);
    cache->left += bytes;
    pthread_mutex_unlock(&cache->lock);
}

uint8_t *image_cache_reserve(struct image_cache *cache, size_t bytes)
{
    pthread_mutex_lock(&cache->lock);
    const bool fits = bytes <= cache->left;
    cache->left -= fits ? bytes : 0;
    pthread_mutex_unlock(&cache->lock);
    uint8_t *rows = fits ? mem_large(bytes) : NULL;
    if (fits && !rows)
        give_back(cache, bytes);
    return rows;
}

void image_cache_settle(struct image_cache *cache, int image, uint8_t *rows, size_t bytes,
                        bool whole)
{
    pthread_mutex_lock(&cache->lock);
    const bool wanted = whole && !cache->image[image];
    if (wanted)
        cache->image[image] = rows;
    pthread_mutex_unlock(&cache->lock);
    if (wanted)
        return;
    mem_free(rows);
    give_back(cache, bytes);
}
