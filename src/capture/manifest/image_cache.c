// image_cache.c - decoded images that stay for tables to come, within a budget: in memory, then on
// disk, where the system holds them as long as it has memory
#include "capture/manifest/image_cache.h"

#include "core/base/memory.h"
#include "core/base/scratch.h"

relume_status image_cache_create(struct image_cache **out, int images, size_t budget,
                                 size_t on_disk, const char *scratch)
{
    struct image_cache *k = *out = mem_zeroed(1, sizeof *k);
    if (!k)
        return RELUME_ENOMEM;
    pthread_mutex_init(&k->lock, NULL);
    k->left = budget;
    k->left_on_disk = on_disk;
    k->scratch = scratch;
    k->images = images;
    k->image = mem_zeroed((size_t)images, sizeof *k->image);
    return k->image ? RELUME_OK : RELUME_ENOMEM;
}

static void free_rows(struct kept_image kept)
{
    if (kept.mapped)
        scratch_unmap(kept.rows, kept.mapped);
    else
        mem_free(kept.rows);
}

void image_cache_destroy(struct image_cache **cache)
{
    struct image_cache *k = *cache;
    *cache = NULL;
    if (!k)
        return;
    for (int i = 0; k->image && i < k->images; i++)
        free_rows(k->image[i]);
    mem_free(k->image);
    pthread_mutex_destroy(&k->lock);
    mem_free(k);
}

struct kept_image image_cache_find(struct image_cache *cache, int image)
{
    pthread_mutex_lock(&cache->lock);
    const struct kept_image found = cache->image[image];
    pthread_mutex_unlock(&cache->lock);
    return found;
}

// Bytes of a budget, or bytes given back to it.
static bool take_memory(struct image_cache *cache, size_t *left, size_t bytes)
{
    pthread_mutex_lock(&cache->lock);
    const bool fits = bytes <= *left;
    *left -= fits ? bytes : 0;
    pthread_mutex_unlock(&cache->lock);
    return fits;
}

static void give_back(struct image_cache *cache, size_t *left, size_t bytes)
{
    pthread_mutex_lock(&cache->lock);
    *left += bytes;
    pthread_mutex_unlock(&cache->lock);
}

struct kept_image image_cache_reserve(struct image_cache *cache, size_t bytes)
{
    struct kept_image kept = {.rows = NULL};
    if (take_memory(cache, &cache->left, bytes)) {
        kept.rows = mem_large(bytes);
        if (!kept.rows)
            give_back(cache, &cache->left, bytes);
    } else if (take_memory(cache, &cache->left_on_disk, bytes)) {
        kept.rows = scratch_map(cache->scratch, bytes);
        kept.mapped = kept.rows ? bytes : 0;
        if (!kept.rows)
            give_back(cache, &cache->left_on_disk, bytes);
    }
    return kept;
}

void image_cache_settle(struct image_cache *cache, int image, struct kept_image kept, size_t bytes,
                        bool whole)
{
    pthread_mutex_lock(&cache->lock);
    const bool wanted = whole && !cache->image[image].rows;
    if (wanted)
        cache->image[image] = kept;
    pthread_mutex_unlock(&cache->lock);
    if (wanted)
        return;
    free_rows(kept);
    give_back(cache, kept.mapped ? &cache->left_on_disk : &cache->left, bytes);
}
