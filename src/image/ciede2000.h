// ciede2000.h - perceived colour difference (Sharma, Wu, Dalal 2005, kL = kC = kH = 1)
#ifndef IMAGE_CIEDE2000_H
#define IMAGE_CIEDE2000_H

// Between two colours in CIE L*a*b*.
double ciede2000(const double lab1[3], const double lab2[3]);

// Between two sRGB-coded colours in [0, 1], white point D65.
double ciede2000_srgb(const float a[3], const float b[3]);

#endif
