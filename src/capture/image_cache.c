// image_cache.c - decoded images that stay in memory for tables to come, within a budget
#include "capture/image_cache.h"

#include "base/memory.h"

#include <stdlib.h>
#include <sys/mman.h>

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
        free(k->image[i]);
    free(k->image);
    pthread_mutex_destroy(&k->lock);
    free(k);
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

// Memory of its own pages, large ones where the system has them: far fewer faults.
static void *large(size_t bytes)
{
    enum { LARGE_PAGE = 2 << 20 };
    if (bytes < LARGE_PAGE)
        return malloc(bytes);
    void *memory = NULL;
    if (posix_memalign(&memory, LARGE_PAGE, bytes))
        return NULL;
    madvise(memory, bytes, MADV_HUGEPAGE);
    return memory;
}

uint8_t *image_cache_reserve(struct image_cache *cache, size_t bytes)
{
    pthread_mutex_lock(&cache->lock);
    const bool fits = bytes <= cache->left;
    cache->left -= fits ? bytes : 0;
    pthread_mutex_unlock(&cache->lock);
    uint8_t *rows = fits ? large(bytes) : NULL;
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
    free(rows);
    give_back(cache, bytes);
}
