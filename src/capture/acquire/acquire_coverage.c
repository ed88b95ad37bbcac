// acquire_coverage.c - the lights on the sphere, seen from the viewer, as SVG
#include "capture/acquire/acquire.h"

#include "core/base/memory.h"

#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 420, RADIUS = 180 };

// Equidistant: the distance from the middle is the angle from the viewer's direction.
static void project(vec3 d, double xy[2])
{
    const double flat = hypot(d.x, d.y), angle = atan2(flat, d.z) / (M_PI / 2.0);
    const double r = RADIUS * fmin(angle, 1.12);
    xy[0] = SIZE / 2.0 + (flat > 0.0 ? r * d.x / flat : 0.0);
    xy[1] = SIZE / 2.0 - (flat > 0.0 ? r * d.y / flat : 0.0);
}

static void put_grid(FILE *f)
{
    for (int i = 1; i <= 6; i++)
        fprintf(f, "<circle cx=\"%d\" cy=\"%d\" r=\"%g\" fill=\"none\" stroke=\"%s\"/>\n", SIZE / 2,
                SIZE / 2, RADIUS * i / 6.0, i == 6 ? "#555" : "#ddd");
    for (int i = 0; i < 6; i++) {
        const double a = i * M_PI / 6.0, x = RADIUS * cos(a), y = RADIUS * sin(a);
        fprintf(f, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n",
                SIZE / 2 - x, SIZE / 2 - y, SIZE / 2 + x, SIZE / 2 + y);
    }
    fprintf(f, "<text x=\"%d\" y=\"16\">up</text><text x=\"%d\" y=\"%d\">right</text>\n",
            SIZE / 2 - 8, SIZE - 28, SIZE / 2 - 6);
    fprintf(f, "<text x=\"%d\" y=\"%g\" fill=\"#999\">45&#176;</text>\n", SIZE / 2 + 3,
            SIZE / 2.0 - RADIUS / 2.0 - 3.0);
}

static void put_gap(FILE *f, const struct relume_acquisition *out)
{
    double xy[2];
    project(out->gap, xy);
    const double r = fmax(0.5 * out->gap_deg / 90.0 * RADIUS, 4.0);
    fprintf(f,
            "<clipPath id=\"sky\"><circle cx=\"%d\" cy=\"%d\" r=\"%d\"/></clipPath>"
            "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"#c33\" fill-opacity=\"0.12\" "
            "stroke=\"#c33\" stroke-dasharray=\"4 3\" clip-path=\"url(#sky)\"><title>widest gap: "
            "%.0f degrees</title></circle>\n",
            SIZE / 2, SIZE / 2, RADIUS, xy[0], xy[1], r, out->gap_deg);
}

static void put_wanted(FILE *f, vec3 d)
{
    double xy[2];
    project(d, xy);
    fprintf(f, "<path d=\"M%.1f %.1fh10m-5 -5v10\" stroke=\"#c33\" stroke-width=\"2\"/>\n",
            xy[0] - 5.0, xy[1]);
}

static void put_light(FILE *f, const struct relume_acquisition *out, int i)
{
    const double sigma = out->photo[i].sigma_deg;
    double xy[2];
    project(out->direction[i], xy);
    if (sigma > 0.0)
        fprintf(
            f, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"#38c\" fill-opacity=\"0.25\"/>\n",
            xy[0], xy[1], 2.0 * sigma / 90.0 * RADIUS);
    fprintf(f,
            "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"#036\"><title>%d: %.3f %.3f %.3f, "
            "error %.2f degrees</title></circle>\n",
            xy[0], xy[1], i, out->direction[i].x, out->direction[i].y, out->direction[i].z, sigma);
    if (out->lights <= 100)
        fprintf(f, "<text x=\"%.1f\" y=\"%.1f\">%d</text>\n", xy[0] + 5.0, xy[1] - 4.0, i);
}

char *acquire_light_sphere(const struct relume_acquisition *out)
{
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);
    if (!f)
        return NULL;
    fprintf(f,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d "
            "%d\" font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%%\" "
            "height=\"100%%\" fill=\"#fff\"/>\n",
            SIZE, SIZE, SIZE, SIZE);
    put_grid(f);
    put_gap(f, out);
    for (int i = 0; i < out->wanted_count; i++)
        put_wanted(f, out->wanted[i]);
    for (int i = 0; i < out->lights; i++)
        put_light(f, out, i);
    fputs("</svg>\n", f);
    if (!fclose(f))
        return mem_take(text);
    mem_free_libc(text);
    return NULL;
}
