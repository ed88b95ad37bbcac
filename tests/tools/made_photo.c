// made_photo.c - pictures of the made camera, and how far a radiance map is from another
//
//   made_photo photo OUT W H TIME ROLL DX DY NOISE [X Y RADIUS]   one exposure; a ball at X, Y
//   made_photo truth OUT.exr W H                                      the radiance that is there
//   made_photo logrms A B BORDER    RMS of ln A / B after one scale, inside of the border, where
//   both are
//                              above 0 in all channels
#include "made_camera.h"

#include "image/image/picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Where the camera stands: there a quarter of a picture saturates in an exposure of 4.
static const double from[2] = {3310, 1730};

static double number(char **argv, int argc, int i)
{
    return i < argc ? atof(argv[i]) : 0.0;
}

static int photo(int argc, char **argv)
{
    const struct made_shot s = {
        .time = number(argv, argc, 5),
        .roll_deg = number(argv, argc, 6),
        .shift = {from[0] + number(argv, argc, 7), from[1] + number(argv, argc, 8)},
        .noise = number(argv, argc, 9),
        .object = {number(argv, argc, 10), number(argv, argc, 11), number(argv, argc, 12)},
        .seed = (uint32_t)(1000.0 * number(argv, argc, 5)),
    };
    struct relume_image image = made_acquisition(&s, atoi(argv[3]), atoi(argv[4]));
    const size_t n = 3 * (size_t)image.width * (size_t)image.height;
    uint8_t *codes = malloc(n);
    for (size_t i = 0; codes && i < n; i++)
        codes[i] = (uint8_t)lroundf(255.0f * image.data[i]);
    const bool good =
        codes && !picture_write_bytes(argv[2], NULL, image.width, image.height, 3, codes, NULL);
    relume_image_destroy(&image);
    free(codes);
    return !good;
}

static int truth(char **argv)
{
    struct relume_image image;
    const int width = atoi(argv[3]), height = atoi(argv[4]);
    if (relume_image_create(&image, width, height, 3))
        return 1;
    for (int i = 0; i < width * height; i++)
        for (int c = 0; c < 3; c++)
            image.data[3 * i + c] =
                (float)made_radiance(from[0] + i % width + 0.5, from[1] + i / width + 0.5, c);
    const int failed = relume_image_save(&image, argv[2], NULL);
    relume_image_destroy(&image);
    return failed;
}

static int logrms(char **argv)
{
    struct relume_image a, b;
    const int border = atoi(argv[4]);
    double sum = 0.0, squares = 0.0, n = 0.0;
    if (relume_image_load(&a, argv[2], NULL) || relume_image_load(&b, argv[3], NULL) ||
        a.width != b.width || a.height != b.height)
        return 1;
    for (int y = border; y < a.height - border; y++)
        for (int x = border; x < a.width - border; x++) {
            const float *p = a.data + 3 * (y * a.width + x), *q = b.data + 3 * (y * a.width + x);
            if (!(fminf(fminf(p[0], p[1]), p[2]) > 0.0f && fminf(fminf(q[0], q[1]), q[2]) > 0.0f))
                continue;
            for (int c = 0; c < 3; c++, n++) {
                const double l = log((double)p[c] / (double)q[c]);
                sum += l;
                squares += l * l;
            }
        }
    printf("%g\n", sqrt(squares / n - sum * sum / n / n));
    relume_image_destroy(&a);
    relume_image_destroy(&b);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc >= 10 && !strcmp(argv[1], "photo"))
        return photo(argc, argv);
    if (argc == 5 && !strcmp(argv[1], "truth"))
        return truth(argv);
    if (argc == 5 && !strcmp(argv[1], "logrms"))
        return logrms(argv);
    fprintf(stderr, "made_photo: photo, truth or logrms; see its source\n");
    return 2;
}
