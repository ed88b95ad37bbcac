// fuzz_surface.c - folders of surfaces and of models with levels, index maps: one file at a time is
// made of noise
#include "fuzz.h"

#include "material/btf/npy.h"
#include "material/surface/texels.h"

#include <relume/material/surface.h>

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
    const struct relume_btf_surface_info *info = relume_btf_surface_info(s);
    float rgb[3];
    for (int i = 0; i < 16; i++)
        relume_btf_surface_evaluate(s, i * info->width / 15.0, i * info->height / 15.0, 0.3 * i,
                                    &ray, rgb);
}

static bool open_map(const char *path)
{
    relume_btf_map *map;
    const bool read = !relume_btf_map_open(&map, path, 8, 4, relume_btf_params(.limits = &limits));
    if (read)
        relume_btf_map_destroy(&map);
    return read;
}

// The first byte says which file of a surface is replaced; beyond them is a map alone.
static bool one(struct fuzz *f, struct bytes b)
{
    char path[160], folder[128];
    const size_t which = b.data[0] % (FILES + 1);
    relume_btf_surface *s;
    b.data++, b.size--;
    if (which == FILES) {
        snprintf(path, sizeof path, "%s/input.npy", f->folder);
        fuzz_store(path, b);
        return open_map(path);
    }
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
    // few, since each opening makes a net of them
    static const struct relume_vec3 d[4] = {
        {0, 0, 1}, {0.8, 0, 0.6}, {-0.48, 0.64, 0.6}, {-0.48, -0.64, 0.6}};
    const struct relume_btf_info info = {
        .name = "made", .width = 8, .height = 4, .views = 4, .lights = 4, .view = d, .light = d};
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

static void add(struct fuzz *f, int which, struct bytes file)
{
    struct bytes b = {malloc(file.size + 1), file.size + 1};
    if (!b.data)
        abort();
    b.data[0] = (uint8_t)which;
    memcpy(b.data + 1, file.data, file.size);
    fuzz_add(f, b);
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
        add(&f, i, whole[i]);
    }
    const struct bytes flat = {malloc(whole[1].size), whole[1].size};
    memcpy(flat.data, whole[1].data, flat.size);
    memcpy(memmem(flat.data, flat.size, "(2, 4, 4,)", 10), "(8, 4)    ", 10);
    add(&f, FILES, flat);
    free(flat.data);

    return fuzz_run(&f, argc, argv, one);
}
