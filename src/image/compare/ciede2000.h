// ciede2000.h - perceived colour difference (Sharma, Wu, Dalal 2005, kL = kC = kH = 1)
#ifndef COMPARE_CIEDE2000_H
#define COMPARE_CIEDE2000_H

// Between two colours in CIE L*a*b*, as the paper writes it.
double ciede2000(const double lab1[3], const double lab2[3]);

// The same for many pixels at once, in loops that compilers turn into vector code, without angles.
// Relative error below 1e-5 for a pixel, of no preferred sign.
struct ciede_tables;
// Made on first use, constant from then on. Thread-safety: safe.
const struct ciede_tables *ciede_tables(void);

enum { CIEDE_BLOCK = 128 };
struct lab_block {
    double l[CIEDE_BLOCK], a[CIEDE_BLOCK], b[CIEDE_BLOCK];
};
// rgb[n][3]: linear sRGB in [0, 1], white point D65; n <= CIEDE_BLOCK.
void lab_from_linear(const struct ciede_tables *tables, struct lab_block *lab, const float *rgb,
                     int n);
void ciede2000_block(const struct ciede_tables *tables, const struct lab_block *lab1,
                     const struct lab_block *lab2, float *delta_e);

#endif
