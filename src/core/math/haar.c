// haar.c - the pyramid of means and differences
#include "core/math/haar.h"

#include <string.h>

enum { MOST = 32 };

// A row or column of n: halves of sums, then of differences, by 1/sqrt(2), which keeps the squares.
static void line(float *data, int n, size_t step, bool back)
{
    const float root = 0.70710678118654752f;
    float made[MOST] = {0};
    for (int i = 0; i < n / 2; i++) {
        const size_t first = back ? (size_t)i : 2 * (size_t)i;
        const size_t second = back ? (size_t)(i + n / 2) : first + 1;
        const float a = data[first * step], b = data[second * step];
        made[back ? 2 * i : i] = (a + b) * root;
        made[back ? 2 * i + 1 : i + n / 2] = (a - b) * root;
    }
    for (int i = 0; i < n; i++)
        data[(size_t)i * step] = made[i];
}

static void level(float *data, int n, int side, size_t step, bool back)
{
    for (int i = 0; i < n; i++)
        line(data + (size_t)(i * side) * step, n, step, back);
    for (int i = 0; i < n; i++)
        line(data + (size_t)i * step, n, step * (size_t)side, back);
}

void haar_square(float *data, int side, size_t step, bool back)
{
    if (back)
        for (int n = 2; n <= side; n *= 2)
            level(data, n, side, step, true);
    else
        for (int n = side; n > 1; n /= 2)
            level(data, n, side, step, false);
}
