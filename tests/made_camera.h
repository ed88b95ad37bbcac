// made_camera.h - a camera whose truth is known: a scene of smooth noise with a wide range of
// light, seen by hand (roll, shift), through a vignetting lens, a film-like response, noise and 8
// bits; something may move
#ifndef MADE_CAMERA_H
#define MADE_CAMERA_H

#include <math.h>
#include <relume/extensions.h>
#include <stdlib.h>

struct made_shot {
    double time;        // exposure 1 of radiance 1 saturates
    double roll_deg;    // about the middle of the picture
    double shift[2];    // pixels
    double object[3];   // x, y, radius of a ball in pixels of this picture; 0: none
    double noise;       // standard deviation, codes of 255
    double vignetting;  // light lost in the corners, [0, 1)
    bool night;         // the scene is that of made_night
    uint32_t seed;
};

static inline double made_hash(int x, int y, int k)
{
    uint32_t h = (uint32_t)x * 0x8da6b343u ^ (uint32_t)y * 0xd8163841u ^ (uint32_t)k * 0xcb1ab31fu;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return (h >> 8) / 16777216.0;
}

// Values at whole numbers, between them a smooth curve; [0, 1].
static inline double made_noise(double x, double y, int k)
{
    const double fx = floor(x), fy = floor(y), s = x - fx, t = y - fy;
    const double u = s * s * (3 - 2 * s), v = t * t * (3 - 2 * t);
    const int i = (int)fx, j = (int)fy;
    const double a = made_hash(i, j, k), b = made_hash(i + 1, j, k);
    const double c = made_hash(i, j + 1, k), d = made_hash(i + 1, j + 1, k);
    return a + u * (b - a) + v * (c - a + u * (a - b - c + d));
}

// Radiance of the scene around 0.2, over about ten stops; a smooth quarter has no texture.
static inline double made_radiance(double x, double y, int c)
{
    const double range = 4.0 * (made_noise(x / 190, y / 190, 1) - 0.5);
    const double coarse = made_noise(x / 23, y / 23, 2 + c) - 0.5;
    const double fine = made_noise(x / 6, y / 6, 5) - 0.5;
    return 0.2 * exp2(range + 2.0 * coarse + 1.5 * fine);
}

// Lamps and windows, small and bright, far apart in the dark: averages over many pixels show
// little.
static inline double made_night(double x, double y, int c)
{
    const int i = (int)floor(x / 40), j = (int)floor(y / 40);
    const double dx = x / 40 - i - 0.5, dy = y / 40 - j - 0.5;
    const double side = 0.12 * (0.3 + made_hash(i, j, 12));
    const bool lit = made_hash(i, j, 11) < 0.4 && fabs(dx) < side && fabs(dy) < 1.5 * side;
    const double fine = made_noise(x / 8, y / 8, 13) - 0.5;
    return 0.03 * exp2(3.0 * fine) + (lit ? 0.4 * exp2(3.0 * made_hash(i, j, 14 + c)) : 0.0);
}

static inline double made_object(double x, double y, int c)
{
    static const double tint[3] = {0.5, 0.22, 0.08};
    return tint[c] * exp2(2.0 * made_noise(x / 7, y / 7, 9) - 1.0);
}

// Exposure -> code and back: a gamma with a shoulder.
static inline double made_encode(double exposure)
{
    const double c = pow(fmin(fmax(exposure, 0.0), 1.0), 1 / 2.2);
    return c + 0.08 * sin(6.283185307179586 * c) * (1 - c);
}
static inline double made_decode(double code)
{
    double low = 0, high = 1;
    for (int i = 0; i < 50; i++) {
        const double middle = 0.5 * (low + high);
        *(made_encode(middle) < code ? &low : &high) = middle;
    }
    return 0.5 * (low + high);
}

// Where the pixel of a picture looks in the scene.
static inline void made_place(const struct made_shot *s, int width, int height, double x, double y,
                              double at[2])
{
    const double a = s->roll_deg * 0.017453292519943295;
    const double dx = x - 0.5 * width, dy = y - 0.5 * height;
    at[0] = 0.5 * width + cos(a) * dx - sin(a) * dy + s->shift[0];
    at[1] = 0.5 * height + sin(a) * dx + cos(a) * dy + s->shift[1];
}
// The inverse.
static inline void made_pixel(const struct made_shot *s, int width, int height, const double at[2],
                              double *x, double *y)
{
    const double a = s->roll_deg * 0.017453292519943295;
    const double dx = at[0] - s->shift[0] - 0.5 * width, dy = at[1] - s->shift[1] - 0.5 * height;
    *x = 0.5 * width + cos(a) * dx + sin(a) * dy;
    *y = 0.5 * height - sin(a) * dx + cos(a) * dy;
}

static inline bool made_covers(const struct made_shot *s, double x, double y)
{
    return hypot(x - s->object[0], y - s->object[1]) < s->object[2];
}

static inline double made_vignette(const struct made_shot *s, int width, int height, double x,
                                   double y)
{
    const double r = hypot(x - 0.5 * width, y - 0.5 * height) / hypot(0.5 * width, 0.5 * height);
    return 1 - s->vignetting * r * r;
}

// About normal, of deviation 1.
static inline double made_gauss(uint32_t *state)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        *state = *state * 1664525u + 1013904223u;
        sum += (*state >> 8) / 16777216.0;
    }
    return sum;
}

// Codes as 8 bits hold them.
static inline struct relume_image made_acquisition(const struct made_shot *s, int width, int height)
{
    struct relume_image image;
    uint32_t state = s->seed + 1;
    if (relume_image_create(&image, width, height, 3))
        abort();
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++) {
                const double px = x + 0.5, py = y + 0.5;
                double at[2];
                made_place(s, width, height, px, py, at);
                const double radiance =
                    made_covers(s, px, py)
                        ? made_object(px - s->object[0], py - s->object[1], c)
                        : (s->night ? made_night : made_radiance)(at[0], at[1], c);
                const double lens = made_vignette(s, width, height, px, py);
                const double code = 255.0 * made_encode(radiance * s->time * lens) +
                                    (s->noise > 0.0 ? s->noise * made_gauss(&state) : 0.0);
                image.data[3 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)c] =
                    (float)(fmin(fmax(floor(code + 0.5), 0.0), 255.0) / 255.0);
            }
    return image;
}

#endif
