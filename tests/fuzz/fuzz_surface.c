// fuzz_surface.c - folders of surfaces and of models with levels, index maps: one file at a time is
// made of noise
#include "fuzz.h"

#include "btf/npy.h"

#include <relume/surface.h>

static const struct relume_limits limits = {
    .max_side = 256, .max_pixels = 1 << 14, .max_lights = 200, .max_views = 200};

static const char *const words[] = {
    "format", "version", "tiles",     "tile_width", "tile_height", "columns", "rows",
    "model",  "width",   "height",    "levels",     "descr",       "shape",   "<u2",
    "<u4",    "<f2",     "(2, 4, 4)", "[",          "]",           "{",       "}",
    ",",      "1e308",   "-1",        "65536",      NULL};

static const char *const files[] = {"surface.json",
                                    "texel.npy",
                                    "matrix.npy",
                                    "model/model.json",
                                    "model/level1/model.json",
                                    "model/coefficient.npy"};
enum { FILES = sizeof files / sizeof *files };
static struct bytes whole[FILES];  // as they were saved

static void look(const relume_btf_surface *s)
{
    const struct relume_btf_ray ray = {.view = {0.3, 0.0, 0.95}, .light = {-0.5, 0.2, 0.8}};
    const struct relume_btf_surface_info info = relume_btf_surface_info(s);
    float rgb[3];
    for (int i = 0; i < 16; i++)
        relume_btf_surface_evaluate(s, i * info.width / 15.0, i * info.height / 15.0, 0.3 * i, &ray,
                                    rgb);
}

static bool one(struct fuzz *f, struct bytes b)
{
    char path[160], folder[128];
    const size_t which = fuzz_below(f, FILES);
    relume_btf_surface *s;
    relume_btf_map *map;
    fuzz_store(f->path, b);
    if (!relume_btf_map_open(&map, f->path, 8, 4, relume_btf_params(.limits = &limits)))
        relume_btf_map_destroy(&map);
    snprintf(path, sizeof path, "%s/input.npy", f->folder);
    fuzz_store(path, b);
    if (!relume_btf_map_open(&map, path, 8, 4, relume_btf_params(.limits = &limits)))
        relume_btf_map_destroy(&map);
    snprintf(folder, sizeof folder, "%s/surface", f->folder);
    snprintf(path, sizeof path, "%s/%s", folder, files[which]);
    fuzz_store(path, b);
    const relume_status status =
        relume_btf_surface_open(&s, folder, relume_btf_params(.limits = &limits));
    if (!status)
        look(s);
    relume_btf_surface_destroy(&s);
    fuzz_store(path, whole[which]);
    return !status;
}

static void make_surface(const char *folder)
{
    struct relume_vec3 d[19];
    relume_btf_set_directions(relume_btf_set_find("coarse"), d);
    const struct relume_btf_info info = {
        .name = "made", .width = 8, .height = 4, .views = 19, .lights = 19, .view = d, .light = d};
    uint32_t texel[2][4][4];
    const uint16_t matrix[2] = {1, 0};
    for (uint32_t i = 0; i < 32; i++)
        texel[i / 16][i / 4 % 4][i % 4] = i / 4 % 4 * 8 + i % 4 + (i / 16) * 4;
    const struct relume_btf_map_info m = {8, 4, 2, 4, 4, &texel[0][0][0], 2, 1, matrix};
    relume_btf *btf;
    relume_btf_fitted *fitted;
    relume_btf_map *map;
    relume_btf_surface *s;
    if (relume_btf_create(&btf, &info, NULL) ||
        relume_btf_fit(&fitted, btf, relume_btf_model_find("rfp"),
                       relume_btf_fit_params(.levels = 2)) ||
        relume_btf_map_create(&map, &m, NULL) || relume_btf_surface_create(&s, fitted, map, NULL) ||
        relume_btf_surface_save(s, folder, NULL))
        abort();
    relume_btf_surface_destroy(&s);
    relume_btf_map_destroy(&map);
    relume_btf_fitted_destroy(&fitted);
    relume_btf_destroy(&btf);
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    char path[160];
    fuzz_begin(&f, "fuzz_surface", argc, argv);
    snprintf(path, sizeof path, "%s/surface", f.folder);
    make_surface(path);
    for (int i = 0; i < FILES; i++) {
        snprintf(path, sizeof path, "%s/surface/%s", f.folder, files[i]);
        whole[i] = fuzz_load(path);
        fuzz_add(&f, fuzz_load(path));
    }
    return fuzz_run(&f, argc, argv, one);
}
