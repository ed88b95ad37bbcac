// kept.c - decoded images that stay in memory for tables to come, within a budget
#include "capture/kept.h"

#include "base/memory.h"

#include <stdlib.h>
#include <sys/mman.h>

relume_status kept_create(struct kept **out, int images, size_t budget)
{
    struct kept *k = *out = mem_zeroed(1, sizeof *k);
    if (!k)
        return RELUME_ENOMEM;
    pthread_mutex_init(&k->lock, NULL);
    k->left = budget;
    k->images = images;
    k->image = mem_zeroed((size_t)images, sizeof *k->image);
    return k->image ? RELUME_OK : RELUME_ENOMEM;
}

void kept_destroy(struct kept **kept)
{
    struct kept *k = *kept;
    *kept = NULL;
    if (!k)
        return;
    for (int i = 0; k->image && i < k->images; i++)
        free(k->image[i]);
    free(k->image);
    pthread_mutex_destroy(&k->lock);
    free(k);
}

const uint8_t *kept_find(struct kept *kept, int image)
{
    pthread_mutex_lock(&kept->lock);
    const uint8_t *found = kept->image[image];
    pthread_mutex_unlock(&kept->lock);
    return found;
}

static void give_back(struct kept *kept, size_t bytes)
{
    pthread_mutex_lock(&kept->lock);
    kept->left += bytes;
    pthread_mutex_unlock(&kept->lock);
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

uint8_t *kept_reserve(struct kept *kept, size_t bytes)
{
    pthread_mutex_lock(&kept->lock);
    const bool fits = bytes <= kept->left;
    kept->left -= fits ? bytes : 0;
    pthread_mutex_unlock(&kept->lock);
    uint8_t *rows = fits ? large(bytes) : NULL;
    if (fits && !rows)
        give_back(kept, bytes);
    return rows;
}

void kept_settle(struct kept *kept, int image, uint8_t *rows, size_t bytes, bool whole)
{
    pthread_mutex_lock(&kept->lock);
    const bool wanted = whole && !kept->image[image];
    if (wanted)
        kept->image[image] = rows;
    pthread_mutex_unlock(&kept->lock);
    if (wanted)
        return;
    free(rows);
    give_back(kept, bytes);
}
