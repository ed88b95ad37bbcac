// bench_objects: frames of one object that fills the picture, by OpenGL, in every model: the median
// and the spread of up to nine frames (of two that take a second) with one directional light and
// its shadow map, and what a pixel and lamp cost at least (nearest texel; between texels four times
// the model's part). bench_objects [WIDTH HEIGHT [osmesa|egl]]
#include "bench.h"
#include "draw/objects_drawer.h"
#include "window/context_offscreen.h"

enum { TEXELS = 16, FRAMES = 9 };
static char folder[64];

static void complain(void *user, enum relume_level level, const char *text)
{
    (void)user, (void)level;
    fprintf(stderr, "%s\n", text);
}
static const struct relume_log bench_log = {.message = complain};

static void need(relume_status status)
{
    if (status)
        exit(1);
}

// A wavy sheet.
static void write_mesh(const char *path)
{
    enum { N = 96 };
    FILE *file = fopen(path, "w");
    if (!file)
        exit(1);
    for (int i = 0; i < (N + 1) * (N + 1); i++) {
        const double x = 2.0 * (i % (N + 1)) / N - 1, y = 2.0 * (i / (N + 1)) / N - 1;
        fprintf(file, "v %g %g %g\nvt %g %g\n", x, y, 0.06 * sin(6 * x) * cos(5 * y), 0.5 * x + 0.5,
                0.5 * y + 0.5);
    }
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++) {
            const int a = j * (N + 1) + i + 1, b = a + N + 1;
            fprintf(file, "f %d/%d %d/%d %d/%d %d/%d\n", a, a, a + 1, a + 1, b + 1, b + 1, b, b);
        }
    fclose(file);
}

static void make(char path[][128], int *n)
{
    relume_btf *btf;
    need(relume_btf_synth(&btf, relume_btf_material_find("weave"),
                          relume_btf_synth_params(.log = NULL, .size = TEXELS, .samples = 1)));
    snprintf(path[(*n)++], sizeof path[0], "%s/measured", folder);
    need(relume_btf_save(btf, path[0], NULL));
    for (int i = 0; relume_btf_models[i]; i++) {
        relume_btf_fitted *fitted;
        const char *name = relume_btf_model_name(relume_btf_models[i]);
        if (!btf_shader_find(name))
            continue;
        need(relume_btf_fit(&fitted, btf, relume_btf_models[i], NULL));
        snprintf(path[*n], sizeof path[0], "%s/%s", folder, name);
        need(relume_btf_fitted_save(fitted, path[(*n)++], NULL));
        relume_btf_fitted_destroy(&fitted);
    }
    relume_btf_destroy(&btf);
}

static void measure(struct objects_drawer *t, int width, int height)
{
    const struct gl *gl = t->gl;
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    const struct relume_window window = {{0, 0, 4}, {-0.9, 0.9, 0}, {1.8, 0, 0}, {0, -1.8, 0}};
    const struct relume_light light = {.direction = {-0.4, 0.5, 0.8}, .rgb = {1, 1, 1}};
    const struct app_rectangle all = {0, 0, width, height};
    struct frame_projection projection;
    GLuint array;
    gl->GenVertexArrays(1, &array);
    gl->BindVertexArray(array);
    need(objects_drawer_light(t, &light, 1));
    if (!frame_projection_of_window(&projection, &window, all, width, height, info->min, info->max))
        exit(1);
    for (int m = 0; m < info->materials; m++) {
        struct times b = {.n = 0};
        const double end = now_s() + 2;
        for (int i = -1; i < FRAMES && (b.n < 2 || now_s() < end); i++) {
            const double start = now_s();
            need(objects_drawer_shade(t, &projection, width, height, m));
            gl->Finish();
            if (i >= 0)
                times_add(&b, now_s() - start);
        }
        const struct relume_object_material *material = &info->material[m];
        const struct relume_btf_cost c = material->fitted ? relume_btf_fitted_cost(material->fitted)
                                                          : (struct relume_btf_cost){0, 0, 9, 9};
        printf(
            "%-9s %8.1f ms (%.1f to %.1f), %6.1f frames/s, %4d operations, %4d fetches, %7.3f MB\n",
            info->material[m].model, 1e3 * times_median(&b), 1e3 * b.s[0], 1e3 * b.s[b.n - 1],
            1 / times_median(&b), c.ops + c.light_ops, c.fetches + c.light_fetches,
            (double)objects_drawer_bytes(t, m) * 1e-6);
    }
    gl->DeleteVertexArrays(1, &array);
}

int main(int argc, char **argv)
{
    enum { MOST = 32 };
    static char path[MOST][128];
    const char *materials[MOST];
    const int width = argc > 2 ? atoi(argv[1]) : 320, height = argc > 2 ? atoi(argv[2]) : 256;
    const struct context_backend *backend = context_offscreen(argc > 3 ? argv[3] : "osmesa");
    struct objects_drawer drawer;
    struct gl gl;
    relume_objects *objects;
    void *context;
    int n = 0;
    char command[128];
    snprintf(folder, sizeof folder, "/tmp/relume-bench-%ld", (long)getpid());
    snprintf(command, sizeof command, "mkdir -p %s", folder);
    if (system(command))
        return 1;
    char mesh[128];
    snprintf(mesh, sizeof mesh, "%s/mesh.obj", folder);
    write_mesh(mesh);
    make(path, &n);
    for (int i = 0; i < n; i++)
        materials[i] = path[i];
    need(backend->open(&context, 1, 1, "bench", &bench_log));
    need(gl_load(&gl, backend->get_proc, &bench_log));
    need(relume_objects_of_mesh(&objects, mesh, materials, n, 4, NULL));
    need(objects_drawer_create(&drawer, &gl, objects, &bench_log));
    printf("objects: %d x %d, %s\n", width, height, (const char *)gl.GetString(GL_RENDERER));
    measure(&drawer, width, height);
    objects_drawer_destroy(&drawer);
    relume_objects_destroy(&objects);
    backend->close(context);
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command);
}
