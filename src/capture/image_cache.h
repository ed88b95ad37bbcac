// image_cache.h - decoded images that stay in memory for tables to come, within a budget
#ifndef CAPTURE_IMAGE_CACHE_H
#define CAPTURE_IMAGE_CACHE_H

#include <relume/base.h>

#include <pthread.h>

// Thread-safety: safe between image_cache_create and image_cache_destroy.
struct image_cache {
    pthread_mutex_t lock;
    size_t left;  // bytes that may still be taken
    int images;
    uint8_t **image;  // [images]: file rows, or NULL
};

relume_status image_cache_create(struct image_cache **out, int images, size_t budget);
void image_cache_destroy(struct image_cache **cache);

// The rows of an image that has been kept, or NULL; they stay until image_cache_destroy.
const uint8_t *image_cache_find(struct image_cache *cache, int image);
// Room for an image that is about to be read, or NULL: no budget, no memory.
uint8_t *image_cache_reserve(struct image_cache *cache, size_t bytes);
// Ends image_cache_reserve: whole images can be found from now on, others and second copies are
// freed.
void image_cache_settle(struct image_cache *cache, int image, uint8_t *rows, size_t bytes,
                        bool whole);

#endif
