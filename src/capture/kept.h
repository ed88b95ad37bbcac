// kept.h - decoded images that stay in memory for tables to come, within a budget
#ifndef CAPTURE_KEPT_H
#define CAPTURE_KEPT_H

#include <relume/base.h>

#include <pthread.h>

// Thread-safety: safe between kept_create and kept_destroy.
struct kept {
    pthread_mutex_t lock;
    size_t left;  // bytes that may still be taken
    int images;
    uint8_t **image;  // [images]: file rows, or NULL
};

relume_status kept_create(struct kept **out, int images, size_t budget);
void kept_destroy(struct kept **kept);

// The rows of an image that has been kept, or NULL; they stay until kept_destroy.
const uint8_t *kept_find(struct kept *kept, int image);
// Room for an image that is about to be read, or NULL: no budget, no memory.
uint8_t *kept_reserve(struct kept *kept, size_t bytes);
// Ends kept_reserve: whole images can be found from now on, others and second copies are freed.
void kept_settle(struct kept *kept, int image, uint8_t *rows, size_t bytes, bool whole);

#endif
