// made_btf.h - a BTF of pictures that a test makes
#ifndef MADE_BTF_H
#define MADE_BTF_H

#include "material/btf/values.h"

#include "test.h"

enum { MADE_DIRECTIONS = 19, MADE_MOST_DIRECTIONS = 81 };  // of the coarse set, of any

struct made_btf {
    const char *name;  // NULL: "made"
    const char *set;   // of directions; NULL: "coarse"
    int width, height;
    bool without_cosine;
    // Picture [height][width][3] of the view `v` and the light `l`; `context` is the caller's.
    void (*fill)(const void *context, struct relume_vec3 v, struct relume_vec3 l, float *rgb);
    const void *context;
};

static inline relume_btf *made_btf(const struct made_btf *m)
{
    struct relume_vec3 d[MADE_MOST_DIRECTIONS];
    const struct relume_btf_set *set = relume_btf_set_find(m->set ? m->set : "coarse");
    const int n = set->count;
    relume_btf_set_directions(set, d);
    const struct relume_btf_info info = {.name = m->name ? m->name : "made",
                                         .width = m->width,
                                         .height = m->height,
                                         .views = n,
                                         .lights = n,
                                         .view = d,
                                         .light = d,
                                         .without_cosine = m->without_cosine};
    relume_btf *btf;
    CHECK_OK(relume_btf_create(&btf, &info, NULL));
    float *rgb = malloc(3 * (size_t)m->width * (size_t)m->height * sizeof *rgb);
    for (int v = 0; v < n; v++)
        for (int l = 0; l < n; l++) {
            m->fill(m->context, d[v], d[l], rgb);
            relume_btf_store(btf, v, l, rgb);
        }
    free(rgb);
    return btf;
}

#endif
