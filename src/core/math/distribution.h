// distribution.h - whole numbers drawn in proportion to a weight of each
#ifndef MATH_DISTRIBUTION_H
#define MATH_DISTRIBUTION_H

#include <stdbool.h>
#include <stddef.h>

// Numbers from 0 to count - 1. A zeroed one has no numbers.
struct distribution {
    double *sum;  // [count]: weights of all numbers up to this one
    size_t count;
};

// Replaces `d` by the distribution of `weight` (each 0 or more), which becomes the running sum and
// belongs to `d`.
void distribution_make(struct distribution *d, double *weight, size_t count);
void distribution_free(struct distribution *d);
// Draws a number by u in [0, 1). Returns false if all weights are 0.
bool distribution_draw(size_t *number, const struct distribution *d, double u);
// Returns the probability of a number.
double distribution_chance(const struct distribution *d, size_t number);

#endif
