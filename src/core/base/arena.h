// arena.h - many small allocations that live and die together
#ifndef BASE_ARENA_H
#define BASE_ARENA_H

#include <stddef.h>

struct arena {
    struct arena_block *blocks;
};

// Zeroed memory for `count` items; NULL when memory is short. Freed only with the arena.
void *arena_array(struct arena *arena, size_t count, size_t size);
char *arena_text(struct arena *arena, const char *text);
__attribute__((format(printf, 2, 3))) char *arena_format(struct arena *arena, const char *format,
                                                         ...);
void arena_free(struct arena *arena);

#endif
