// made_chart.h - a photograph of a ColorChecker 24 by a camera whose colours are known
#ifndef MADE_CHART_H
#define MADE_CHART_H

#include "capture/acquire/chart.h"

#include <math.h>
#include <relume/extensions.h>

struct made_chart {
    double x, y, pitch, turn_deg;   // where its middle lies, pixels from patch to patch
    double tilt;                    // perspective
    double camera[3][3];            // reflectance (linear sRGB) -> what the camera sees
    double noise, vignette, slope;  // standard deviation at 1; loss in the corners; light from left
                                    // to right
    unsigned seed;
    bool clutter;  // other things around it
};

// The place of a cell in the picture.
static inline void made_chart_place(double at[2], const struct made_chart *t, double x, double y)
{
    const double a = x - 2.5, b = y - 1.5, v = b / (1.0 - t->tilt * b);
    const double u = a * (1.0 + t->tilt * v), w = t->turn_deg * M_PI / 180.0;
    at[0] = t->x + t->pitch * (cos(w) * u - sin(w) * v);
    at[1] = t->y + t->pitch * (sin(w) * u + cos(w) * v);
}

static inline double made_chart_random(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

static inline void made_chart_ground(double rgb[3], const struct made_chart *t, double x, double y)
{
    const int column = (int)floor(x / 61.0), row = (int)floor(y / 47.0);
    unsigned s = 7919u * (unsigned)column + 104729u * (unsigned)row;
    const double grain = 0.04 * sin(x * 0.9) * sin(y * 1.1);
    for (int c = 0; c < 3; c++)
        rgb[c] = 0.35 + 0.1 * sin(0.003 * x + c) + grain;
    for (int c = 0; t->clutter && (column + row) % 3 == 0 && c < 3; c++)
        rgb[c] = 0.05 + 0.9 * made_chart_random(&s);
}

// What lies at a place of the picture.
static inline void made_chart_at(double rgb[3], const struct made_chart *t,
                                 const double (*colour)[3], double px, double py)
{
    const double w = t->turn_deg * M_PI / 180.0;
    const double u = (cos(w) * (px - t->x) + sin(w) * (py - t->y)) / t->pitch;
    const double v = (cos(w) * (py - t->y) - sin(w) * (px - t->x)) / t->pitch;
    const double x = 2.5 + u / (1.0 + t->tilt * v), y = 1.5 + v / (1.0 + t->tilt * v);
    const double nx = floor(x + 0.5), ny = floor(y + 0.5);
    if (!(1.0 + t->tilt * v > 0.1) || x < -0.7 || y < -0.7 || x > 5.7 || y > 3.7)
        made_chart_ground(rgb, t, px, py);
    else
        for (int c = 0; c < 3; c++)
            rgb[c] = fabs(x - nx) < 0.44 && fabs(y - ny) < 0.44 && nx >= 0.0 && nx < 6.0 &&
                             ny >= 0.0 && ny < 4.0
                         ? colour[(int)nx + 6 * (int)ny][c]
                         : 0.025;
}

static inline relume_status made_chart(struct relume_image *out, int width, int height,
                                       const struct made_chart *t)
{
    double colour[RELUME_CHART_PATCHES][3];
    unsigned state = t->seed;
    relume_chart_colours(colour, NULL);
    const relume_status status = relume_image_create(out, width, height, 3);
    for (int i = 0; !status && i < width * height; i++) {
        double sum[3] = {0.0, 0.0, 0.0};
        const int px = i % width, py = i / width;
        for (int k = 0; k < 4; k++) {
            double rgb[3];
            made_chart_at(rgb, t, (const double(*)[3])colour, px + 0.25 + 0.5 * (k % 2),
                          py + 0.25 + 0.5 * (k / 2));
            for (int c = 0; c < 3; c++)
                sum[c] += 0.25 * rgb[c];
        }
        const double dx = 2.0 * px / width - 1.0, dy = 2.0 * py / height - 1.0;
        const double light =
            (1.0 - t->vignette * 0.5 * (dx * dx + dy * dy)) * (1.0 + t->slope * dx);
        for (int c = 0; c < 3; c++) {
            const double *m = t->camera[c];
            const double bell = made_chart_random(&state) + made_chart_random(&state) +
                                made_chart_random(&state) - 1.5;
            const double seen = light * (m[0] * sum[0] + m[1] * sum[1] + m[2] * sum[2]);
            out->data[3 * i + c] = (float)fmax(seen + 2.0 * t->noise * bell, 0.0);
        }
    }
    return status;
}

#endif
