// fuzz_btf.c - BTFs and fitted models of every kind, one of their files made of noise
#include "material/btf/values.h"

#include "fuzz.h"

#include <dirent.h>
#include <math.h>
#include <relume/material/btf.h>
#include <sys/stat.h>

enum { SIDE = 2, DIRECTIONS = 4 };

static const struct relume_limits limits = {
    .max_side = 64, .max_pixels = 1 << 12, .max_lights = 64, .max_views = 64};

static const char *const words[] = {"format",
                                    "version",
                                    "model",
                                    "width",
                                    "height",
                                    "clusters",
                                    "lobes",
                                    "components",
                                    "levels",
                                    "pair_bytes",
                                    "texel_bytes",
                                    "includes_cosine",
                                    "lpca",
                                    "qmf",
                                    "cmf",
                                    "rfnl",
                                    "light_directions",
                                    "view_directions",
                                    "descr",
                                    "'<f2'",
                                    "'<f4'",
                                    "'|u1'",
                                    "'<u2'",
                                    "fortran_order",
                                    "'shape':",
                                    "False",
                                    "(2,",
                                    "null",
                                    "1e308",
                                    NULL};

// A seed is the file's name, a line end and the file.
static void add_file(struct fuzz *f, const char *name)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", f->folder, name);
    struct bytes file = fuzz_load(path), seed = {malloc(strlen(name) + 1 + file.size), 0};
    seed.size = strlen(name) + 1 + file.size;
    memcpy(seed.data, name, strlen(name));
    seed.data[strlen(name)] = '\n';
    memcpy(seed.data + strlen(name) + 1, file.data, file.size);
    free(file.data);
    fuzz_add(f, seed);
}

static void add_folder(struct fuzz *f, const char *name)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", f->folder, name);
    DIR *dir = opendir(path);
    if (!dir)
        abort();
    for (struct dirent *e = readdir(dir); e; e = readdir(dir)) {
        if (e->d_name[0] == '.')
            continue;
        snprintf(path, sizeof path, "%s/%s", name, e->d_name);
        add_file(f, path);
    }
    closedir(dir);
}

static relume_btf *make_btf(void)
{
    static const struct relume_vec3 d[DIRECTIONS] = {
        {0, 0, 1}, {0.8, 0, 0.6}, {-0.48, 0.64, 0.6}, {-0.48, -0.64, 0.6}};
    const struct relume_btf_info info = {.name = "made",
                                         .width = SIDE,
                                         .height = SIDE,
                                         .views = DIRECTIONS,
                                         .lights = DIRECTIONS,
                                         .view = d,
                                         .light = d};
    relume_btf *btf;
    if (relume_btf_create(&btf, &info, NULL))
        abort();
    for (int pair = 0; pair < DIRECTIONS * DIRECTIONS; pair++) {
        float rgb[3 * SIDE * SIDE];
        for (int i = 0; i < 3 * SIDE * SIDE; i++)
            rgb[i] = (float)((pair * 7 + i * 5) % 11) / 11.0f;
        relume_btf_store(btf, pair / DIRECTIONS, pair % DIRECTIONS, rgb);
    }
    return btf;
}

static void make_seeds(struct fuzz *f)
{
    char path[512];
    relume_btf *btf = make_btf();
    snprintf(path, sizeof path, "%s/btf", f->folder);
    if (relume_btf_save(btf, path, NULL))
        abort();
    add_folder(f, "btf");
    for (const struct relume_btf_model *const *m = relume_btf_models; *m; m++) {
        const char *name = relume_btf_model_name(*m);
        relume_btf_fitted *fitted;
        snprintf(path, sizeof path, "%s/%s", f->folder, name);
        if (relume_btf_fit(&fitted, btf, *m,
                           relume_btf_fit_params(.clusters = 2, .components = 2, .ratio = 1.0)) ||
            relume_btf_fitted_save(fitted, path, NULL))
            abort();
        relume_btf_fitted_destroy(&fitted);
        add_folder(f, name);
    }
    relume_btf_destroy(&btf);
}

static const struct bytes *seed_of(const struct fuzz *f, struct bytes b, size_t name)
{
    for (int i = 0; i < f->seeds; i++)
        if (f->seed[i].size > name && !memcmp(f->seed[i].data, b.data, name))
            return &f->seed[i];
    return NULL;
}

static void look(const relume_btf *btf, const relume_btf_fitted *fitted, int width, int height)
{
    for (int i = 0; i < 8; i++) {
        const struct relume_vec3 v = {0.3 * sin(i), 0.5 * cos(2 * i), 0.7};
        const struct relume_vec3 l = {0.9 * sin(3 * i), 0.2 * cos(i), i % 4 ? 0.3 : -0.1};
        float rgb[3];
        if (btf)
            relume_btf_evaluate(btf, i % width, i * 3 % height, v, l, rgb);
        else
            relume_btf_fitted_evaluate(fitted, i % width, i * 3 % height, v, l, rgb);
    }
}

static bool open_btf(const char *path)
{
    relume_btf *btf;
    if (relume_btf_open(&btf, path, relume_btf_params(.limits = &limits)))
        return false;
    look(btf, NULL, relume_btf_info(btf)->width, relume_btf_info(btf)->height);
    relume_btf_destroy(&btf);
    return true;
}

static bool open_model(const char *path)
{
    relume_btf_fitted *fitted;
    if (relume_btf_fitted_open(&fitted, path, relume_btf_params(.limits = &limits)))
        return false;
    const struct relume_btf_fitted_info *info = relume_btf_fitted_info(fitted);
    look(NULL, fitted, info->width, info->height);
    (void)relume_btf_fitted_cost(fitted);
    relume_btf_fitted_destroy(&fitted);
    return true;
}

// The noisy file in the place of the good one, which comes back afterwards.
static bool one(struct fuzz *f, struct bytes b)
{
    const uint8_t *end = memchr(b.data, '\n', b.size < 64 ? b.size : 64);
    const size_t name = end ? (size_t)(end - b.data) + 1 : 0;
    const struct bytes *seed = name ? seed_of(f, b, name) : NULL;
    char path[256];
    fuzz_store(f->path, b);
    if (!seed)
        return false;
    snprintf(path, sizeof path, "%s/%.*s", f->folder, (int)name - 1, (const char *)b.data);
    fuzz_store(path, (struct bytes){b.data + name, b.size - name});
    char *slash = strrchr(path, '/');
    *slash = '\0';
    const bool good = strcmp(slash - 3, "btf") ? open_model(path) : open_btf(path);
    *slash = '/';
    fuzz_store(path, (struct bytes){seed->data + name, seed->size - name});
    return good;
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    fuzz_begin(&f, "fuzz_btf", argc, argv);
    make_seeds(&f);
    return fuzz_run(&f, argc, argv, one);
}
