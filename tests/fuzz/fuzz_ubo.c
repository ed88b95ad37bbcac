// fuzz_ubo.c - .btf files of Bonn made of noise
#include "fuzz.h"
#include "made_ubo.h"

#include <relume/material/btf.h>

static const struct relume_limits limits = {
    .max_side = 16, .max_pixels = 64, .max_lights = 16, .max_views = 16};

static const char *const words[] = {"!DFMF08FC", "!FMF12FCE", "!FMF06FC", "R", "<xml/>", NULL};

static double number(const struct made_ubo *m, int colour, int k, int i)
{
    (void)m;
    return ((colour * 5 + k * 3 + i * 7) % 17 - 8) / 4.0;
}

static void make_seeds(struct fuzz *f)
{
    static const double d[4][2] = {{0, 0}, {0.9, 0}, {0.9, 2}, {0.9, 4}};
    static const char *const signatures[] = {"!DFMF08FCR", "!FMF12FCER", "!FMF06FC"};
    static const int colours[] = {0, 1, 3, 4, 9, 10, 11, 12};
    for (int i = 0; i < 24; i++) {
        const struct made_ubo m = {.signature = signatures[i % 3],
                                   .version = 1 + i % 4,
                                   .cosine = i % 2,
                                   .description = "<xml/>",
                                   .views = 4,
                                   .lights = 4,
                                   .view = d,
                                   .light = d,
                                   .width = 3,
                                   .height = 2,
                                   .extension = i / 3 % 3,
                                   .logarithm = i % 2,
                                   .map_width = 2,
                                   .map_height = 1,
                                   .colours = colours[i / 3],
                                   .scalar = {2, i % 2 ? 4 : 2, i % 4 ? 2 : 8},
                                   .rank = {3, 2, 1},
                                   .turned = i / 6 % 2,
                                   .pair = number,
                                   .texel = number};
        const struct made_bytes b = made_ubo(&m);
        fuzz_add(f, (struct bytes){b.data, b.size});
    }
}

static void look(const relume_btf *btf)
{
    const struct relume_btf_info *info = relume_btf_info(btf);
    for (int i = 0; i < 8; i++) {
        const struct relume_vec3 v = {0.3 * sin(i), 0.5 * cos(2 * i), 0.7};
        const struct relume_vec3 l = {0.9 * sin(3 * i), 0.2 * cos(i), i % 4 ? 0.3 : -0.1};
        float rgb[3];
        relume_btf_evaluate(btf, i % info->width, i * 3 % info->height, v, l, rgb);
        for (int c = 0; c < 3; c++)
            if (!isfinite(rgb[c]) || rgb[c] < 0.0f)
                abort();
    }
}

static bool one(struct fuzz *f, struct bytes b)
{
    relume_btf *btf;
    const bool part = fuzz_random(f) % 4 == 0;
    const struct relume_btf_params p = {.limits = &limits,
                                        .threads = 1,
                                        .fill = fuzz_random(f) % 2,
                                        .crop = {part, 0, part * 2, part}};
    fuzz_store(f->path, b);
    if (relume_btf_open(&btf, f->path, &p))
        return false;
    look(btf);
    relume_btf_destroy(&btf);
    return true;
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    fuzz_begin(&f, "fuzz_ubo", argc, argv);
    make_seeds(&f);
    return fuzz_run(&f, argc, argv, one);
}
