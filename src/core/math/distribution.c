// distribution.c - whole numbers drawn in proportion to a weight of each
#include "core/math/distribution.h"

#include "core/base/memory.h"

void distribution_make(struct distribution *d, double *weight, size_t count)
{
    distribution_free(d);
    for (size_t i = 1; i < count; i++)
        weight[i] += weight[i - 1];
    *d = (struct distribution){weight, count};
}

void distribution_free(struct distribution *d)
{
    mem_free(d->sum);
    *d = (struct distribution){0};
}

static double total(const struct distribution *d)
{
    return d->count ? d->sum[d->count - 1] : 0.0;
}

bool distribution_draw(size_t *number, const struct distribution *d, double u)
{
    const double wanted = u * total(d);
    size_t low = 0, high = d->count;
    if (!(total(d) > 0.0))
        return false;
    while (low + 1 < high) {  // sum[low - 1] <= wanted < sum[high - 1]
        const size_t middle = low + (high - low) / 2;
        if (d->sum[middle - 1] <= wanted)
            low = middle;
        else
            high = middle;
    }
    *number = low;
    return true;
}

double distribution_chance(const struct distribution *d, size_t number)
{
    const double all = total(d), before = number ? d->sum[number - 1] : 0.0;
    return all > 0.0 ? (d->sum[number] - before) / all : 0.0;
}
