// made_target.c - photographs of a scene with a ColorChecker 24 in it, under one light each
//
//   made_target one OUT [X Y PITCH TURN]   one photograph, 360 x 270, under even light
//   made_target set DIR N [BLURRED]        DIR/p00.png ..., and DIR/lights.txt; one is out of focus
#include "made_chart.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 360, HEIGHT = 270 };

static double number(char **argv, int argc, int i, double otherwise)
{
    return i < argc ? atof(argv[i]) : otherwise;
}

static struct made_chart scene(void)
{
    return (struct made_chart){
        .x = 180,
        .y = 135,
        .pitch = 30,
        .camera = {{0.80, 0.25, 0.05}, {0.12, 0.62, 0.10}, {0.02, 0.10, 0.38}},
        .noise = 0.003,
        .clutter = true,
        .seed = 5,
    };
}

static relume_status save(struct relume_image *image, const char *path)
{
    const relume_status status = relume_image_save(image, path, NULL);
    relume_image_destroy(image);
    return status;
}

static int one(int argc, char **argv)
{
    struct made_chart t = scene();
    struct relume_image image;
    t.x = number(argv, argc, 3, t.x);
    t.y = number(argv, argc, 4, t.y);
    t.pitch = number(argv, argc, 5, t.pitch);
    t.turn_deg = number(argv, argc, 6, 0);
    return made_chart(&image, WIDTH, HEIGHT, &t) || save(&image, argv[2]);
}

// A matte surface with dents between which the target lies flat.
static double facing(int x, int y, const double light[3])
{
    const bool flat = abs(x - 180) < 103 && abs(y - 135) < 73;
    const double u = flat ? 0.0 : 0.3 * sin(0.21 * x), v = flat ? 0.0 : 0.3 * cos(0.17 * y);
    return fmax((u * light[0] + v * light[1] + light[2]) / sqrt(1.0 + u * u + v * v), 0.0);
}

static relume_status blur(struct relume_image *image)
{
    struct relume_image small, large;
    relume_status status = relume_image_scale(&small, image, WIDTH / 4, HEIGHT / 4, NULL);
    if (!status)
        status = relume_image_scale(&large, &small, WIDTH, HEIGHT, NULL);
    relume_image_destroy(&small);
    if (status)
        return status;
    relume_image_destroy(image);
    *image = large;
    return RELUME_OK;
}

static int set(int argc, char **argv)
{
    const int n = atoi(argv[3]), blurred = (int)number(argv, argc, 4, -1);
    char path[512];
    snprintf(path, sizeof path, "%s/lights.txt", argv[2]);
    FILE *lights = fopen(path, "w");
    if (!lights)
        return 1;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < n; i++) {
        const double a = 2.4 * i, z = 0.45 + 0.5 * (i + 0.5) / n, r = sqrt(1.0 - z * z);
        const double light[3] = {r * cos(a), r * sin(a), z};
        struct made_chart t = scene();
        struct relume_image image;
        t.seed = (unsigned)i + 5u;
        status = made_chart(&image, WIDTH, HEIGHT, &t);
        for (int k = 0; !status && k < 3 * WIDTH * HEIGHT; k++)
            image.data[k] *= (float)facing(k / 3 % WIDTH, k / 3 / WIDTH, light);
        if (!status && i == blurred)
            status = blur(&image);
        snprintf(path, sizeof path, "%s/p%02d.png", argv[2], i);
        if (!status)
            status = save(&image, path);
        fprintf(lights, "%.6f %.6f %.6f\n", light[0], light[1], light[2]);
    }
    return fclose(lights) || status;
}

int main(int argc, char **argv)
{
    if (argc >= 3 && !strcmp(argv[1], "one"))
        return one(argc, argv);
    if (argc >= 4 && !strcmp(argv[1], "set"))
        return set(argc, argv);
    fputs("usage: made_target one OUT [X Y PITCH TURN] | set DIR N [BLURRED]\n", stderr);
    return 2;
}
