// budget.h - memory shared by numbered items, of which the least recently used leave first
#ifndef BASE_BUDGET_H
#define BASE_BUDGET_H

#include <stdbool.h>
#include <stdint.h>

// The owner of the items frees their memory. A budget only counts it.
struct budget {
    uint64_t most;   // bytes that all items together may take
    uint64_t bytes;  // that they take
    uint64_t round;  // number of the present round, such as a frame
    int count;
    struct budget_item {
        uint64_t bytes;  // 0: the item holds no memory
        uint64_t used;   // last round that used it; 0: none
    } * item;            // [count]
};

// Starts round 0 of `count` items without memory. False when memory is short.
bool budget_create(struct budget *b, int count, uint64_t most);
void budget_destroy(struct budget *b);

// Marks an item as used in the present round.
void budget_use(struct budget *b, int item);
// Sets the bytes of an item.
void budget_set(struct budget *b, int item, uint64_t bytes);
// Makes an item one without memory that was never used.
void budget_forget(struct budget *b, int item);
// Returns the item that must leave so that `more` bytes fit: of the items with memory that the
// present round has not used, the least recently used. -1: they fit, or there is no such item.
int budget_excess(const struct budget *b, uint64_t more);

#endif
