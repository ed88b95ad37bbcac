// How far environment light on models of materials is from brute force, every cell of the
// environment being a light: the tables of docs/measurements/surfaces.md.
//
//   bench_ambient SKY.hdr... -- MODEL...
//
// Relative RMS over 8 texels from one eye: `plane` are the maps of the environment and `own` those
// of the one orientation (relume_btf_oriented_light), of a wall that faces +z; `plane, any` and
// `ball` are relume_btf_environment on that wall and over orientations all around, the latter
// relative to all of them.
#define RELUME_VEC3_SHORT
#include "material/model/environment.h"
#include "material/surface/texels.h"
#include "relight/light/environment.h"

#include <relume/extensions.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXELS = 8, NORMALS = 24 };

static void must(relume_status status, const char *what)
{
    if (!status)
        return;
    fprintf(stderr, "bench_ambient: %s: %s\n", what, relume_status_text(status));
    exit(1);
}

static struct relume_vec3 unit(double x, double y, double z)
{
    return vec3_unit(vec3_of(x, y, z));
}

// Number 0 faces +z with x right; the others spiral over the sphere.
static struct relume_btf_frame frame_of(int i)
{
    if (i == 0)
        return (struct relume_btf_frame){{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double y = 1.0 - 2.0 * (i - 0.5) / (NORMALS - 1), turn = 2.399963 * i;
    const struct relume_vec3 n = unit(sqrt(1 - y * y) * cos(turn), y, sqrt(1 - y * y) * sin(turn));
    const struct relume_vec3 side = vec3_cross((struct relume_vec3){0, 1, 0}, n);
    const struct relume_vec3 right = unit(side.x, side.y, side.z);
    return (struct relume_btf_frame){right, vec3_cross(n, right), n};
}

struct trial {
    const relume_btf_fitted *model;
    const relume_btf_surface *surface;
    const struct relume_light *light;
    const relume_prefiltered_maps *prefiltered;
    const relume_btf_environment *sky;
    struct relume_btf_frame frame;
    struct relume_vec3 view;
    int width, height;
};

static void place(const struct trial *t, int i, int *x, int *y)
{
    *x = (5 + 7 * i) % t->width;
    *y = (3 + 11 * i) % t->height;
}

static void brute(const struct trial *t, double rgb[TEXELS][3])
{
    int n;
    const struct relume_environment_cell *cell =
        relume_environment_cells(&n, t->light->environment);
    memset(rgb, 0, TEXELS * sizeof *rgb);
    for (int i = 0; i < n; i++) {
        const struct relume_vec3 d = cell[i].direction;
        const struct relume_vec3 l = {vec3_dot(d, t->frame.right), vec3_dot(d, t->frame.up),
                                      vec3_dot(d, t->frame.normal)};
        for (int k = 0; k < TEXELS && l.z > 0.0; k++) {
            float value[3];
            int x, y;
            place(t, k, &x, &y);
            relume_btf_fitted_evaluate(t->model, x, y, t->view, l, value);
            for (int c = 0; c < 3; c++)
                rgb[k][c] += (double)value[c] * (double)cell[i].rgb[c];
        }
    }
}

static void ambient(const struct trial *t, bool own, double rgb[TEXELS][3])
{
    relume_btf_oriented_light *a;
    must(relume_btf_oriented_light_create(&a, t->model, t->prefiltered, &t->frame,
                                          relume_btf_oriented_light_params(.own_maps = own)),
         "ambient");
    for (int k = 0; k < TEXELS; k++) {
        float value[3];
        int x, y;
        place(t, k, &x, &y);
        relume_btf_oriented_light_evaluate(a, 0, x, y, t->view, value);
        for (int c = 0; c < 3; c++)
            rgb[k][c] = (double)value[c];
    }
    relume_btf_oriented_light_destroy(&a);
}

static void any(const struct trial *t, double rgb[TEXELS][3])
{
    const struct relume_btf_ray ray = {.view = t->view, .sky = t->sky, .frame = t->frame};
    for (int k = 0; k < TEXELS; k++) {
        float value[3];
        int x, y;
        place(t, k, &x, &y);
        relume_btf_surface_evaluate(t->surface, x + 0.5, y + 0.5, 0, &ray, value);
        for (int c = 0; c < 3; c++)
            rgb[k][c] = (double)value[c];
    }
}

static void add(double sums[2], double got[TEXELS][3], double want[TEXELS][3])
{
    for (int k = 0; k < TEXELS; k++)
        for (int c = 0; c < 3; c++) {
            sums[0] += (got[k][c] - want[k][c]) * (got[k][c] - want[k][c]);
            sums[1] += want[k][c] * want[k][c];
        }
}

static double percent(const double sums[2])
{
    return 100.0 * sqrt(sums[0] / sums[1]);
}

static void judge(struct trial *t, const char *sky, const char *name)
{
    double want[TEXELS][3], got[TEXELS][3], sums[4][2] = {{0}};
    t->frame = frame_of(0);
    brute(t, want);
    for (int own = 0; own < 2; own++) {
        ambient(t, own, got);
        add(sums[own], got, want);
    }
    any(t, got);
    add(sums[2], got, want);
    for (int i = 1; i < NORMALS; i++) {
        t->frame = frame_of(i);
        brute(t, want);
        any(t, got);
        add(sums[3], got, want);
    }
    printf("| %s | %s | %.2f %% | %.2f %% | %.2f %% | %.2f %% |\n", name, sky, percent(sums[0]),
           percent(sums[1]), percent(sums[2]), percent(sums[3]));
    fflush(stdout);
}

static void run(const char *sky, const char *folder)
{
    struct relume_image map;
    relume_environment *e;
    relume_btf_fitted *model;
    relume_btf_surface *surface;
    relume_prefiltered_maps *prefiltered;
    relume_btf_environment *any_way;
    must(relume_image_load(&map, sky, NULL), sky);
    must(relume_environment_create(&e, &map, NULL), sky);
    must(relume_btf_fitted_open(&model, folder, NULL), folder);
    must(relume_btf_surface_create(&surface, model, NULL, NULL), folder);
    const struct relume_btf_fitted_info *info = relume_btf_fitted_info(model);
    const struct relume_light light = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .environment = e, .rgb = {1, 1, 1}};
    must(relume_prefiltered_maps_create(&prefiltered, &light,
                                        relume_prefiltered_maps_params(.rim = info->rim)),
         sky);
    must(relume_btf_environment_create(&any_way, model, prefiltered), folder);
    struct trial t = {
        model,       surface,     &light, prefiltered, any_way, frame_of(0), unit(0.28, 0, 0.96),
        info->width, info->height};
    judge(&t, sky, folder);
    relume_btf_environment_destroy(&any_way);
    relume_prefiltered_maps_destroy(&prefiltered);
    relume_btf_surface_destroy(&surface);
    relume_btf_fitted_destroy(&model);
    relume_environment_destroy(&e);
    relume_image_destroy(&map);
}

int main(int argc, char **argv)
{
    if (argc == 1) {
        puts("skipped: bench_ambient SKY... -- MODEL...");
        return 0;
    }
    int split = 1;
    while (split < argc && strcmp(argv[split], "--"))
        split++;
    if (split == 1 || split + 1 >= argc) {
        fputs("usage: bench_ambient SKY... -- MODEL...\n", stderr);
        return 2;
    }
    puts("| model | sky | plane | plane, own | plane, any | ball |\n|---|---|---|---|---|---|");
    for (int m = split + 1; m < argc; m++)
        for (int s = 1; s < split; s++)
            run(argv[s], argv[m]);
    return 0;
}
