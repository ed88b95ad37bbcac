// bright.c - numbers drawn by how much light is behind each
#include "world/transport/bright.h"

#include "core/base/memory.h"

void bright_take(struct bright *b, double *light, size_t count)
{
    bright_forget(b);
    for (size_t i = 1; i < count; i++)
        light[i] += light[i - 1];
    *b = (struct bright){light, count};
}

void bright_forget(struct bright *b)
{
    mem_free(b->sum);
    *b = (struct bright){0};
}

static double total(const struct bright *b)
{
    return b->count ? b->sum[b->count - 1] : 0.0;
}

bool bright_draw(size_t *number, const struct bright *b, double u)
{
    const double wanted = u * total(b);
    size_t low = 0, high = b->count;
    if (!(total(b) > 0.0))
        return false;
    while (low + 1 < high) {  // sum[low - 1] <= wanted < sum[high - 1]
        const size_t middle = low + (high - low) / 2;
        if (b->sum[middle - 1] <= wanted)
            low = middle;
        else
            high = middle;
    }
    *number = low;
    return true;
}

double bright_chance(const struct bright *b, size_t number)
{
    const double all = total(b), before = number ? b->sum[number - 1] : 0.0;
    return all > 0.0 ? (b->sum[number] - before) / all : 0.0;
}
