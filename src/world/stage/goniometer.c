// goniometer.c - relume_btf_synth: a relief under parallel light from every direction, as a
// gonioreflectometer photographs it
//
// One period of the relief is measured; around it lies as much of the next periods as light and
// eyes at the lowest directions can reach across.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/random.h"
#include "material/btf/values.h"
#include "world/stage/apparatus.h"
#include "world/stage/relief.h"
#include "world/stage/render.h"

#include <string.h>

static const double MOST_MARGIN = 1.0;  // periods on each side
enum { CELLS = 256 };                   // of the mesh on a side, at least
enum { FINE = 2 };                      // pixels of the camera across a texel

const struct relume_btf_material *const relume_btf_materials[] = {
    &material_corduroy,  &material_knit,      &material_stone, &material_leather,
    &material_wallpaper, &material_aluminium, &material_weave, NULL,
};

const struct relume_btf_material *relume_btf_material_find(const char *name)
{
    for (const struct relume_btf_material *const *m = relume_btf_materials; *m; m++)
        if (!strcmp((*m)->name, name))
            return *m;
    return NULL;
}

const char *relume_btf_material_name(const struct relume_btf_material *material)
{
    return material->name;
}

struct goniometer {
    const struct relume_btf_material *material;
    struct relume_btf_synth_params p;  // defaults filled in
    vec3 standard[81];
    int cells;             // of the mesh on a side of one period
    double *height;        // [cells][cells] at corners, from v = 0 up; the mean is 0
    unsigned char *layer;  // the same
    double top;            // the greatest height
    relume_scene *scene;
    struct relume_image relief, normals;
};

// ---------------------------------------------------------------- the relief

static size_t corner(const struct goniometer *g, int i, int j)
{
    const int n = g->cells;
    return (size_t)((j % n + n) % n) * (size_t)n + (size_t)((i % n + n) % n);
}

static relume_status sample_relief(struct goniometer *g)
{
    const int n = g->cells;
    struct relume_scene_builder *stage = &g->scene->stage;
    const size_t count = (size_t)n * (size_t)n;
    g->height = mem_array(count, sizeof *g->height);
    g->layer = mem_array(count, sizeof *g->layer);
    const relume_status status = relume_image_create(&stage->pictures[0], n, n, 3);
    if (status || !g->height || !g->layer)
        return RELUME_ENOMEM;
    stage->picture_count = 1;
    double sum = 0.0;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            struct relief_point at;
            g->material->at((double)i / n, (double)j / n, g->p.extent, random_mix(g->p.seed), &at);
            g->height[corner(g, i, j)] = at.height / g->p.extent;
            g->layer[corner(g, i, j)] = (unsigned char)at.layer;
            sum += g->height[corner(g, i, j)];
            // texture_image has its pixel centres at + 0.5 and row 0 at the top
            float *pixel = stage->pictures[0].data + 3 * corner(g, i, n - 1 - j);
            memcpy(pixel, at.color, sizeof at.color);
        }
    g->top = -INFINITY;
    for (size_t k = 0; k < count; k++) {
        g->height[k] -= sum / (double)count;
        g->top = fmax(g->top, g->height[k]);
    }
    return RELUME_OK;
}

static vec3 normal_at(const struct goniometer *g, int i, int j)
{
    const double per = 0.5 * g->cells;
    return vec3_unit(
        vec3_of(per * (g->height[corner(g, i - 1, j)] - g->height[corner(g, i + 1, j)]),
                per * (g->height[corner(g, i, j - 1)] - g->height[corner(g, i, j + 1)]), 1.0));
}

// How far the lowest rays run across while they cross the relief, in cells.
static int margin(const struct goniometer *g)
{
    double low = 0.0, reach = 0.0;
    for (size_t k = 0; k < (size_t)g->cells * (size_t)g->cells; k++)
        low = fmin(low, g->height[k]);
    const vec3 *sets[2] = {g->p.view, g->p.light};
    const int counts[2] = {g->p.views, g->p.lights};
    for (int s = 0; s < 2; s++)
        for (int i = 0; i < counts[s]; i++) {
            const vec3 d = sets[s][i];
            reach = fmax(reach, (g->top - low) * sqrt(d.x * d.x + d.y * d.y) / d.z);
        }
    return 2 + (int)(fmin(reach, MOST_MARGIN) * g->cells);
}

static void add_materials(struct goniometer *g)
{
    struct relume_scene_builder *stage = &g->scene->stage;
    for (int k = 0; k < RELIEF_LAYERS; k++) {
        const struct relief_gloss *gloss = &g->material->gloss[k];
        struct material m = {
            .texture = {.color = texture_image, .image = &stage->pictures[0]},
            .alpha = gloss->alpha > 0.0f ? gloss->alpha : 1.0f,
        };
        memcpy(m.f0, gloss->f0, sizeof m.f0);
        build_material(stage, m);
    }
}

static void add_mesh(struct goniometer *g)
{
    struct mesh *mesh = &g->scene->stage.mesh;
    const int n = g->cells, from = -margin(g), to = n + margin(g), row = to - from + 1;
    for (int j = from; j <= to; j++)
        for (int i = from; i <= to; i++) {
            const double u = (double)i / n, v = (double)j / n;
            // the colour of corner i is the picture's pixel i, whose centre is half a pixel on
            mesh_vertex(mesh, vec3_of(u - 0.5, v - 0.5, g->height[corner(g, i, j)]),
                        normal_at(g, i, j), vec3_of(u + 0.5 / n, v + 0.5 / n, 0.0));
        }
    for (int j = 0; j + 1 < row; j++)
        for (int i = 0; i + 1 < row; i++) {
            const uint32_t a = (uint32_t)(j * row + i), b = a + 1, c = a + (uint32_t)row, d = c + 1;
            const uint32_t layer = g->layer[corner(g, from + i, from + j)];
            mesh_triangle(mesh, a, b, d, layer);
            mesh_triangle(mesh, a, d, c, layer);
        }
}

static relume_status build_scene(struct goniometer *g)
{
    g->scene = mem_zeroed(1, sizeof *g->scene);
    if (!g->scene)
        return RELUME_ENOMEM;
    relume_status status = sample_relief(g);
    if (status)
        return status;
    add_materials(g);
    add_mesh(g);
    if (g->scene->stage.mesh.failed)
        return RELUME_ENOMEM;
    g->scene->bounds = mesh_bounds(&g->scene->stage.mesh);
    return trace_create(&g->scene->tracer, &g->scene->stage.mesh, g->p.log);
}

// Mean height and normal of each texel.
static relume_status measure_truth(struct goniometer *g)
{
    const int size = g->p.size, per = g->cells / size;
    relume_status status = relume_image_create(&g->relief, size, size, 1);
    if (!status)
        status = relume_image_create(&g->normals, size, size, 3);
    for (int y = 0; y < size && !status; y++)
        for (int x = 0; x < size; x++) {
            double height = 0.0;
            vec3 normal = {0.0, 0.0, 0.0};
            for (int j = 0; j <= per; j++)
                for (int i = 0; i <= per; i++) {
                    // corners on the rim of a texel belong to it by half
                    const double w = (i % per ? 1.0 : 0.5) * (j % per ? 1.0 : 0.5);
                    const int ci = x * per + i, cj = (size - 1 - y) * per + j;
                    height += w * g->height[corner(g, ci, cj)];
                    normal = vec3_along(normal, normal_at(g, ci, cj), w);
                }
            const size_t at = (size_t)y * (size_t)size + (size_t)x;
            normal = vec3_unit(normal);
            g->relief.data[at] = (float)(height / ((double)per * per));
            g->normals.data[3 * at] = (float)normal.x;
            g->normals.data[3 * at + 1] = (float)normal.y;
            g->normals.data[3 * at + 2] = (float)normal.z;
        }
    return status;
}

// ---------------------------------------------------------------- the photographs

struct reporting {
    const struct relume_log *log;
    int view, views;
};

static bool report(void *user, double done)
{
    const struct reporting *t = user;
    return log_progress(t->log, "measuring", (t->view + done) / t->views);
}

// Texels have this many pixels of the camera on a side.
static int fineness(const struct goniometer *g)
{
    return g->p.samples >= FINE * FINE ? FINE : 1;
}

// One texel out of its own pixels and those half a texel around: a tent, as pictures are resampled
// when they are rectified. The sample goes on beyond its rim as on the other side.
static void resample(const struct goniometer *g, const struct relume_image *fine, float *out)
{
    static const float tent[2 * FINE] = {0.125f, 0.375f, 0.375f, 0.125f};
    const int size = g->p.size, n = fine->width;
    memset(out, 0, 3 * (size_t)size * (size_t)size * sizeof *out);
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++, out += 3)
            for (int j = 0; j < 2 * FINE; j++)
                for (int i = 0; i < 2 * FINE; i++) {
                    const int row = (FINE * y + j - 1 + n) % n, column = (FINE * x + i - 1 + n) % n;
                    const float *from = fine->data + 3 * ((size_t)row * (size_t)n + (size_t)column);
                    for (int c = 0; c < 3; c++)
                        out[c] += tent[i] * tent[j] * from[c];
                }
}

// Views share their random numbers, so that what chance adds to a texel looks like a texture that
// all views see rather than like noise.
static relume_status photograph_view(const struct goniometer *g, int view,
                                     struct relume_image *held)
{
    struct reporting reporting = {g->p.log, view, g->p.views};
    const struct render_job job = {
        .scene = g->scene,
        .camera = {.geometry = {.camera_z = g->top + 0.01},
                   .width = held[0].width,
                   .height = held[0].height,
                   .rectified = true,
                   .towards = g->p.view[view]},
        .lights = g->p.light,
        .light_count = g->p.lights,
        .samples = g->p.samples / (fineness(g) * fineness(g)),
        .bounces = g->p.bounces,
        .seed = random_mix(g->p.seed),
        .threads = g->p.threads,
    };
    return render_lights(&job, held, report, &reporting);
}

// Photographs of one view on their way into the BTF.
struct keeping {
    const struct goniometer *g;
    const apparatus *apparatus;  // NULL: without faults
    struct relume_image *held;   // [lights]
    float *texels;               // [workers][size][size][3]
    relume_btf *btf;
    int view;
};

static void keep(void *context, size_t light, int worker)
{
    const struct keeping *k = context;
    const struct goniometer *g = k->g;
    float *texels = k->held[light].data;
    if (fineness(g) > 1) {
        texels = k->texels + 3 * (size_t)worker * (size_t)g->p.size * (size_t)g->p.size;
        resample(g, &k->held[light], texels);
    }
    if (k->apparatus)
        apparatus_spoil(k->apparatus, texels, g->p.view[k->view],
                        (uint64_t)k->view * (uint64_t)g->p.lights + light, worker);
    relume_btf_store(k->btf, k->view, (int)light, texels);
}

static relume_status photograph(const struct goniometer *g, relume_btf *btf)
{
    const int side = g->p.size * fineness(g), workers = thread_count(g->p.threads);
    struct keeping k = {.g = g, .btf = btf};
    apparatus *faulty = NULL;
    k.held = mem_zeroed((size_t)g->p.lights, sizeof *k.held);
    k.texels =
        mem_array(3 * (size_t)workers * (size_t)g->p.size * (size_t)g->p.size, sizeof *k.texels);
    relume_status status = k.held && k.texels ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = apparatus_create(&faulty, &g->p.faults, g->p.size, g->p.seed, workers);
    k.apparatus = faulty;
    for (int l = 0; l < g->p.lights && !status; l++)
        status = relume_image_create(&k.held[l], side, side, 3);
    for (; k.view < g->p.views && !status; k.view++) {
        status = photograph_view(g, k.view, k.held);
        if (!status)
            thread_for(workers, (size_t)g->p.lights, keep, &k);
    }
    for (int l = 0; k.held && l < g->p.lights; l++)
        relume_image_destroy(&k.held[l]);
    apparatus_destroy(&faulty);
    mem_free(k.held);
    mem_free(k.texels);
    return status;
}

static relume_status make_btf(struct goniometer *g, relume_btf **out)
{
    const struct relume_btf_info info = {
        .name = g->material->name,
        .width = g->p.size,
        .height = g->p.size,
        .views = g->p.views,
        .lights = g->p.lights,
        .view = g->p.view,
        .light = g->p.light,
        .relief = g->relief,
        .normals = g->normals,
    };
    return relume_btf_create(out, &info,
                             relume_btf_params(.log = g->p.log, .scratch = g->p.scratch));
}

static relume_status complete(struct goniometer *g, const struct relume_btf_synth_params *params)
{
    const struct relume_btf_set *bonn = relume_btf_set_find("bonn");
    relume_btf_set_directions(bonn, g->standard);
    g->p = PARAMS_WORK(relume_btf_synth_params, params);
    g->p.size = g->p.size ? g->p.size : 64;
    g->p.extent = g->p.extent ? g->p.extent : 1;
    g->p.samples = g->p.samples ? g->p.samples : 4;
    g->p.bounces = g->p.bounces < 0 ? 0 : g->p.bounces ? g->p.bounces : 1;
    if (!g->p.views)
        g->p.view = g->standard, g->p.views = bonn->count;
    if (!g->p.lights)
        g->p.light = g->standard, g->p.lights = bonn->count;
    if (g->p.size < 1 || g->p.size > 1024)
        return log_fail(g->p.log, RELUME_EINVAL, "size: expected 1 to 1024 texels; found %d",
                        g->p.size);
    if (!limits_allow(limits_of(NULL, g->p.log), g->p.size, g->p.size))
        return log_fail(g->p.log, RELUME_EINVAL,
                        "size: expected a picture of at most --max-pixels; found %d x %d",
                        g->p.size, g->p.size);
    if (g->p.extent < 1 || g->p.extent > 16)
        return log_fail(g->p.log, RELUME_EINVAL, "extent: expected 1 to 16; found %d", g->p.extent);
    const struct relume_btf_faults *f = &g->p.faults;
    if (!(f->blur >= 0.0 && f->blur <= 100.0 && f->shift >= 0.0 && f->shift <= 100.0))
        return log_fail(g->p.log, RELUME_EINVAL,
                        "blur, shift: expected 0 to 100 texels; found %g, %g", f->blur, f->shift);
    if (!(f->noise >= 0.0 && f->noise <= 1.0 && f->flicker >= 0.0 && f->flicker <= 1.0))
        return log_fail(g->p.log, RELUME_EINVAL, "noise, flicker: expected 0 to 1; found %g, %g",
                        f->noise, f->flicker);
    const uint64_t side = (uint64_t)g->p.size * (uint64_t)fineness(g);
    const relume_status status = limits_memory(NULL, 12 * side * side * (uint64_t)g->p.lights,
                                               "a view of this size under all lights", g->p.log);
    if (status)
        return status;
    g->cells = g->p.size * (g->p.size >= CELLS / 2 ? 2 : CELLS / g->p.size);
    return RELUME_OK;
}

relume_status relume_btf_synth(relume_btf **out, const struct relume_btf_material *material,
                               const struct relume_btf_synth_params *params)
{
    struct goniometer g = {.material = material};
    *out = NULL;
    relume_status status = complete(&g, params);
    // directions are checked where they are kept
    relume_btf *btf = NULL;
    if (!status)
        status = build_scene(&g);
    if (!status)
        status = measure_truth(&g);
    if (!status)
        status = make_btf(&g, &btf);
    if (!status)
        status = photograph(&g, btf);
    if (status)
        relume_btf_destroy(&btf);
    *out = btf;
    relume_scene_destroy(&g.scene);
    relume_image_destroy(&g.relief);
    relume_image_destroy(&g.normals);
    mem_free(g.height);
    mem_free(g.layer);
    return status;
}
