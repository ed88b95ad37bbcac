// sum.h - sums over lights in a fixed order, eight at a time, and the value at a rank
#ifndef STEREO_SUM_H
#define STEREO_SUM_H

#include <stddef.h>

// Of a[i] b[i]; n is a multiple of 8.
static inline float sum_products(const float *a, const float *b, size_t n)
{
    float part[8] = {0};
    for (size_t i = 0; i < n; i += 8)
        for (size_t k = 0; k < 8; k++)
            part[k] += a[i + k] * b[i + k];
    return ((part[0] + part[4]) + (part[2] + part[6])) +
           ((part[1] + part[5]) + (part[3] + part[7]));
}

// The value that would stand at `rank` were the n values sorted (Hoare 1961); they change their
// order.
static inline float value_at_rank(float *v, int n, int rank)
{
    int low = 0, high = n - 1;
    while (low < high) {
        const float pivot = v[(low + high) / 2];
        int i = low, j = high;
        while (i <= j) {
            while (v[i] < pivot)
                i++;
            while (v[j] > pivot)
                j--;
            if (i <= j) {
                const float t = v[i];
                v[i++] = v[j];
                v[j--] = t;
            }
        }
        if (rank <= j)
            high = j;
        else if (rank >= i)
            low = i;
        else
            break;
    }
    return v[rank];
}

#endif
