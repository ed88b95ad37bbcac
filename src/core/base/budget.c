// budget.c - memory shared by numbered items, of which the least recently used leave first
#include "core/base/budget.h"

#include "core/base/memory.h"

bool budget_create(struct budget *b, int count, uint64_t most)
{
    *b = (struct budget){.most = most, .count = count};
    b->item = mem_zeroed((size_t)count, sizeof *b->item);
    return b->item;
}

void budget_destroy(struct budget *b)
{
    mem_free(b->item);
    *b = (struct budget){0};
}

void budget_use(struct budget *b, int item)
{
    b->item[item].used = b->round;
}

void budget_set(struct budget *b, int item, uint64_t bytes)
{
    struct budget_item *i = &b->item[item];
    b->bytes += bytes - i->bytes;
    i->bytes = bytes;
}

void budget_forget(struct budget *b, int item)
{
    budget_set(b, item, 0);
    b->item[item].used = 0;
}

int budget_excess(const struct budget *b, uint64_t more)
{
    int oldest = -1;
    if (b->bytes + more <= b->most)
        return -1;
    for (int i = 0; i < b->count; i++) {
        const struct budget_item *item = &b->item[i];
        if (item->bytes && item->used < b->round &&
            (oldest < 0 || item->used < b->item[oldest].used))
            oldest = i;
    }
    return oldest;
}
