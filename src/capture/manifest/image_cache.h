// image_cache.h - decoded images that stay in memory for tables to come, within a budget
#ifndef CAPTURE_IMAGE_CACHE_H
#define CAPTURE_IMAGE_CACHE_H

#include <relume/base.h>

#include <pthread.h>

// The rows of an image as they are in its file, in memory or in a file that is mapped.
struct kept_image {
    uint8_t *rows;  // or NULL
    size_t mapped;  // bytes of that file; 0: in memory
};

// Thread-safety: safe between image_cache_create and image_cache_destroy.
struct image_cache {
    pthread_mutex_t lock;
    size_t left, left_on_disk;  // bytes that may still be taken
    const char *scratch;        // beside which files are kept, borrowed
    int images;
    struct kept_image *image;  // [images]
};

// Up to `budget` bytes in memory, then `on_disk` in files beside `scratch`.
relume_status image_cache_create(struct image_cache **out, int images, size_t budget,
                                 size_t on_disk, const char *scratch);
void image_cache_destroy(struct image_cache **cache);

// The rows of an image that has been kept, or none; they stay until image_cache_destroy.
struct kept_image image_cache_find(struct image_cache *cache, int image);
// Memory for an image that is about to be read, or none: no budget, no memory.
struct kept_image image_cache_reserve(struct image_cache *cache, size_t bytes);
// Ends image_cache_reserve: whole images can be found from now on, others and second copies are
// freed.
void image_cache_settle(struct image_cache *cache, int image, struct kept_image kept, size_t bytes,
                        bool whole);

#endif
