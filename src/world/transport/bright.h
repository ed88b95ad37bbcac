// bright.h - numbers drawn by how much light is behind each
#ifndef TRANSPORT_BRIGHT_H
#define TRANSPORT_BRIGHT_H

#include <relume/base.h>

#include <stdbool.h>
#include <stddef.h>

// Zeroed: there is no light.
struct bright {
    double *sum;  // [count]: of all up to each
    size_t count;
};

// Of `light` (0 or more), which is changed to its running sum and belongs to `b`.
void bright_take(struct bright *b, double *light, size_t count);
void bright_forget(struct bright *b);
// For u in [0, 1); false: there is no light.
bool bright_draw(size_t *number, const struct bright *b, double u);
// The chance that a number is drawn.
double bright_chance(const struct bright *b, size_t number);

#endif
