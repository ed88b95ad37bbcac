#include "image/ciede2000.h"

#include <relume/image.h>

#include <math.h>

static double lab_curve(double t)
{
    return t > 216.0 / 24389.0 ? cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
}

static void lab_from_srgb(double lab[3], const float rgb[3])
{
    static const double xyz[3][3] = {{0.4124564, 0.3575761, 0.1804375},
                                     {0.2126729, 0.7151522, 0.0721750},
                                     {0.0193339, 0.1191920, 0.9503041}};
    static const double white[3] = {0.95047, 1.0, 1.08883};
    const struct relume_transfer srgb = {RELUME_CURVE_SRGB, 0.0f};
    double linear[3], f[3];
    for (int c = 0; c < 3; c++)
        linear[c] = (double)relume_transfer_decode(srgb, rgb[c]);
    for (int i = 0; i < 3; i++)
        f[i] = lab_curve((xyz[i][0] * linear[0] + xyz[i][1] * linear[1] + xyz[i][2] * linear[2]) /
                         white[i]);
    lab[0] = 116.0 * f[1] - 16.0;
    lab[1] = 500.0 * (f[0] - f[1]);
    lab[2] = 200.0 * (f[1] - f[2]);
}

static double degrees(double radians)
{
    return radians * (180.0 / M_PI);
}

static double cosine(double deg)
{
    return cos(deg * (M_PI / 180.0));
}

static double hue(double a, double b)
{
    const double h = a == 0.0 && b == 0.0 ? 0.0 : degrees(atan2(b, a));
    return h < 0.0 ? h + 360.0 : h;
}

static double mean_hue(double h1, double h2, double chroma_product)
{
    if (chroma_product == 0.0)
        return h1 + h2;
    if (fabs(h1 - h2) <= 180.0)
        return 0.5 * (h1 + h2);
    return h1 + h2 < 360.0 ? 0.5 * (h1 + h2 + 360.0) : 0.5 * (h1 + h2 - 360.0);
}

static double power7(double v)
{
    const double v3 = v * v * v;
    return v3 * v3 * v;
}

// Names and equation numbers as in the paper.
double ciede2000(const double lab1[3], const double lab2[3])
{
    const double c_mean = 0.5 * (hypot(lab1[1], lab1[2]) + hypot(lab2[1], lab2[2]));
    const double c7 = power7(c_mean), seven = power7(25.0);
    const double g = 0.5 * (1.0 - sqrt(c7 / (c7 + seven)));           // (4)
    const double a1 = (1.0 + g) * lab1[1], a2 = (1.0 + g) * lab2[1];  // (5)
    const double c1 = hypot(a1, lab1[2]), c2 = hypot(a2, lab2[2]);    // (6)
    const double h1 = hue(a1, lab1[2]), h2 = hue(a2, lab2[2]);        // (7)
    double dh = c1 * c2 == 0.0 ? 0.0 : h2 - h1;                       // (10)
    dh += dh > 180.0 ? -360.0 : dh < -180.0 ? 360.0 : 0.0;
    const double dl = lab2[0] - lab1[0], dc = c2 - c1;                      // (8), (9)
    const double dhh = 2.0 * sqrt(c1 * c2) * sin(0.5 * dh * M_PI / 180.0);  // (11)
    const double l = 0.5 * (lab1[0] + lab2[0]), c = 0.5 * (c1 + c2);        // (12), (13)
    const double h = mean_hue(h1, h2, c1 * c2);                             // (14)
    const double t = 1.0 - 0.17 * cosine(h - 30.0) + 0.24 * cosine(2.0 * h) +
                     0.32 * cosine(3.0 * h + 6.0) - 0.20 * cosine(4.0 * h - 63.0);  // (15)
    const double turn = (h - 275.0) / 25.0;
    const double theta = 30.0 * exp(-turn * turn);                  // (16)
    const double rc = 2.0 * sqrt(power7(c) / (power7(c) + seven));  // (17)
    const double l50 = (l - 50.0) * (l - 50.0);
    const double sl = 1.0 + 0.015 * l50 / sqrt(20.0 + l50);       // (18)
    const double sc = 1.0 + 0.045 * c, sh = 1.0 + 0.015 * c * t;  // (19), (20)
    const double rt = -sin(2.0 * theta * M_PI / 180.0) * rc;      // (21)
    const double x = dl / sl, y = dc / sc, z = dhh / sh;
    return sqrt(x * x + y * y + z * z + rt * y * z);  // (22)
}

double ciede2000_srgb(const float a[3], const float b[3])
{
    if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2])
        return 0.0;
    double lab1[3], lab2[3];
    lab_from_srgb(lab1, a);
    lab_from_srgb(lab2, b);
    return ciede2000(lab1, lab2);
}
