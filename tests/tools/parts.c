// parts.c - FILE x y w h ...: whether parts of a relume file's views are those pixels of the whole
//
// Compares coefficients, depth, masks and the models of shadows and highlights, number by number,
// and the geometry; prints the first difference of a file.
#include "format/pack/views.h"
#include "image/image/image.h"

#include <math.h>
#include <relume/pack.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *why;

static bool same_image(const char *what, struct relume_image *whole, struct relume_image *part,
                       const struct relume_rect *at)
{
    bool same = !whole->data == !part->data;
    if (same && whole->data)
        same = !image_crop(whole, at) && whole->width == part->width &&
               whole->height == part->height && whole->channels == part->channels &&
               !memcmp(whole->data, part->data,
                       (size_t)part->width * (size_t)part->height * (size_t)part->channels *
                           sizeof *part->data);
    relume_image_destroy(whole);
    relume_image_destroy(part);
    why = same ? why : what;
    return same;
}

static bool same_codes(const struct relume_codes *whole, const struct relume_codes *part,
                       const struct relume_rect *at)
{
    float *a = calloc((size_t)at->width, sizeof *a), *b = calloc((size_t)at->width, sizeof *b);
    bool same = a && b && part->width == at->width && part->height == at->height &&
                whole->planes == part->planes && whole->books == part->books;
    for (int p = 0; same && p < whole->planes; p++)
        for (int y = 0; same && y < at->height; y++) {
            const size_t row = (size_t)(at->top + y) * (size_t)whole->width + (size_t)at->left;
            relume_codes_plane(whole, p, row, (size_t)at->width, a);
            relume_codes_plane(part, p, (size_t)y * (size_t)at->width, (size_t)at->width, b);
            same = !memcmp(a, b, (size_t)at->width * sizeof *a);
        }
    free(a);
    free(b);
    why = same ? why : "coefficients";
    return same;
}

typedef relume_status reader(struct relume_image *out, relume_pack *pack, int view);

static bool same_view(relume_pack *whole, relume_pack *part, int view, const struct relume_rect *at)
{
    static reader *const readers[] = {relume_pack_depth, relume_pack_mask, relume_pack_shadow,
                                      relume_pack_gloss};
    static const char *const names[] = {"depth", "mask", "shadows", "highlights"};
    const struct relume_codes *a, *b;
    bool same = !relume_pack_codes(&a, whole, view) && !relume_pack_codes(&b, part, view) &&
                same_codes(a, b, at);
    why = same || why ? why : "reading";
    for (size_t i = 0; same && i < sizeof readers / sizeof *readers; i++) {
        struct relume_image x = {0}, y = {0};
        same = !readers[i](&x, whole, view) && !readers[i](&y, part, view);
        why = same ? why : names[i];
        same = same && same_image(names[i], &x, &y, at);
    }
    return same;
}

// A place of the window in a part is where it is in the whole.
static bool same_places(const struct relume_pack_info *whole, const struct relume_pack_info *part,
                        const struct relume_rect *at)
{
    const bool slab = whole->geometry.projection == RELUME_SLAB;
    const struct relume_geometry *g = &whole->geometry, *h = &part->geometry;
    const double *low = slab ? g->st_min : g->window_min, *high = slab ? g->st_max : g->window_max;
    const double *from = slab ? h->st_min : h->window_min, *to = slab ? h->st_max : h->window_max;
    const double pixel[2] = {(high[0] - low[0]) / whole->width, (high[1] - low[1]) / whole->height};
    const double off[4] = {from[0] - (low[0] + pixel[0] * at->left),
                           to[0] - (low[0] + pixel[0] * (at->left + at->width)),
                           to[1] - (high[1] - pixel[1] * at->top),
                           from[1] - (high[1] - pixel[1] * (at->top + at->height))};
    bool same = true;
    for (int i = 0; i < 4; i++)
        same = same && fabs(off[i]) < 1e-12;
    why = same ? why : "window";
    return same;
}

static bool same_file(const char *path, const struct relume_rect *at)
{
    relume_pack *whole = NULL, *part = NULL;
    bool same = !relume_pack_open(&whole, path, NULL) && !relume_pack_open(&part, path, NULL) &&
                !relume_pack_crop(part, at);
    why = same ? why : "opening";
    same = same && same_places(relume_pack_info(whole), relume_pack_info(part), at);
    for (int v = 0; same && v < relume_pack_info(whole)->views; v++)
        same = same_view(whole, part, v, at);
    relume_pack_destroy(&whole);
    relume_pack_destroy(&part);
    return same;
}

int main(int argc, char **argv)
{
    for (int i = 2; i + 3 < argc; i += 4) {
        const struct relume_rect at = {atoi(argv[i]), atoi(argv[i + 1]), atoi(argv[i + 2]),
                                       atoi(argv[i + 3])};
        if (!same_file(argv[1], &at)) {
            printf("%s: %s differ in %d,%d,%d,%d\n", argv[1], why, at.left, at.top, at.width,
                   at.height);
            return 1;
        }
    }
    return argc < 6;
}
