// mkubo.c - a .btf file as Bonn writes them, of a white round bump lit by Lambert's law, which
// three components hold exactly
//
//   mkubo FILE dfmf|fmf SIDE SET [RANK]     SIDE texels a side, directions of a set of relume's;
//                                           components from the fourth on are small noise
#include "made_ubo.h"

#include <relume/material/btf.h>

enum { MOST = 151 };
static double directions[MOST][2];

static double vector_of(const double d[2], int k)
{
    return k == 2 ? cos(d[0]) : sin(d[0]) * (k ? sin(d[1]) : cos(d[1]));
}

static double noise(int k, int i)
{
    return ((i * 37 + k * 101) % 64 - 32) * 1e-4;
}

// Y, U, V of a warm white, or all of one.
static double pair(const struct made_ubo *m, int colour, int k, int pair)
{
    static const double yuv[3] = {1.0, -0.05, 0.08};
    const double n_l = k < 3 ? vector_of(m->light[pair % m->lights], k) : noise(k, pair);
    return n_l * (m->signature[1] == 'D' ? yuv[colour] : 1.0 - 0.1 * colour);
}

// The bump's normal; y is up, rows go down.
static double texel(const struct made_ubo *m, int colour, int k, int texel)
{
    const double x = (texel % m->width + 0.5) / m->width * 2.0 - 1.0;
    const double y = 1.0 - (texel / m->width + 0.5) / m->height * 2.0, r2 = x * x + y * y;
    const double n[3] = {r2 < 0.64 ? x : 0.0, r2 < 0.64 ? y : 0.0,
                         r2 < 0.64 ? sqrt(1.0 - r2) : 1.0};
    (void)colour;
    return 0.8 * (k < 3 ? n[k] : noise(k, texel));
}

static void take_set(const char *name, int *n)
{
    const struct relume_btf_set *set = relume_btf_set_find(name);
    struct relume_vec3 d[MOST];
    if (!set || set->count > MOST)
        exit(2);
    relume_btf_set_directions(set, d);
    for (int i = 0; i < set->count; i++)
        directions[i][0] = acos(d[i].z > 1.0 ? 1.0 : d[i].z),
        directions[i][1] = atan2(d[i].y, d[i].x);
    *n = set->count;
}

int main(int argc, char **argv)
{
    if (argc < 5)
        return 2;
    const int side = atoi(argv[3]), rank = argc > 5 ? atoi(argv[5]) : 3;
    struct made_ubo m = {.signature = strcmp(argv[2], "fmf") ? "!DFMF08FCR" : "!FMF12FCER",
                         .version = 4,
                         .cosine = true,
                         .view = (const double(*)[2])directions,
                         .light = (const double(*)[2])directions,
                         .width = side,
                         .height = side,
                         .extension = 2,
                         .colours = 1,
                         .scalar = {2, 2, 2},
                         .rank = {rank, rank > 3 ? rank / 2 : rank, rank > 3 ? rank / 2 : rank},
                         .pair = pair,
                         .texel = texel};
    take_set(argv[4], &m.views);
    m.lights = m.views;
    made_ubo_save(argv[1], &m);
    return 0;
}
