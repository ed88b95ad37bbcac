// Light below surfaces, in the form of Table 7.1 of Menzel's thesis: objects by points and error.
//
//   bench_translucent [MESH...]
//
// A ball, and each mesh, of marble, the longest side 50 mm, under one lamp. Of 2000 places each:
// the time to find what leaves one, the pieces that it asks, and the difference to asking all
// points. Then frames of 640 x 512 pixels by the library, in which the object fills the window.
#include "bench.h"

#include "shape/mesh/mesh_read.h"
#include "world/object/object.h"
#include "world/stage/shapes.h"
#include "world/transport/glow.h"

enum { PLACES = 2000, WIDE = 1280, HIGH = 1024 };

static const vec3 lamp = {0.6, 0.64, 0.48};

static double longest_of(const struct mesh *m)
{
    const struct bounds b = mesh_bounds(m);
    return fmax(fmax(b.max.x - b.min.x, b.max.y - b.min.y), b.max.z - b.min.z);
}

static vec3 vector(const float v[3])
{
    return vec3_of((double)v[0], (double)v[1], (double)v[2]);
}

static void light(struct glow *g)
{
    const struct glow_tree *t = g->tree;
    for (size_t i = 0; i < t->points; i++) {
        const double cosine = vec3_dot(lamp, vector(t->point[i].normal));
        for (int c = 0; c < 3; c++)
            g->light[i][c] =
                (float)(fmax(cosine, 0.0) * dipole_passes(t->dipole.index, fmax(cosine, 0.0)));
    }
    glow_sum_up(g);
}

static void ask(float (*out)[3], double *seconds, double *pieces, const struct glow *g,
                double error)
{
    const struct glow_tree *t = g->tree;
    const double start = now_s();
    *pieces = 0.0;
    for (int i = 0; i < PLACES; i++) {
        const struct spread_point *p = &t->point[(size_t)i * t->points / PLACES];
        *pieces += glow_leaves(out[i], g, vector(p->position), vector(p->normal), error);
    }
    *seconds = (now_s() - start) / PLACES;
    *pieces /= PLACES;
}

static double rms(float (*a)[3], float (*b)[3])
{
    double wrong = 0.0, all = 0.0;
    for (int i = 0; i < PLACES; i++)
        for (int c = 0; c < 3; c++) {
            wrong += pow((double)(a[i][c] - b[i][c]), 2.0);
            all += pow((double)b[i][c], 2.0);
        }
    return sqrt(wrong / all);
}

static void points(const char *name, const struct mesh *mesh, size_t wanted)
{
    static const double errors[] = {0.0, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0};
    static float got[PLACES][3], want[PLACES][3];
    const struct scattering *marble = &scattering_find("marble")->scattering;
    uint32_t *all = malloc(mesh->triangle_count * sizeof *all);
    struct spread s;
    struct glow_tree t;
    struct glow g;
    for (size_t i = 0; i < mesh->triangle_count; i++)
        all[i] = (uint32_t)i;
    const double start = now_s();
    bench_check(spread_make(&s, mesh, all, mesh->triangle_count, wanted));
    bool *thin = calloc(s.count + 1, sizeof *thin);
    bench_check(glow_tree_make(&t, &s, thin, marble, 50.0 / longest_of(mesh), 1));
    const double made = now_s() - start;
    bench_check(glow_make(&g, &t));
    light(&g);
    for (size_t i = 0; i < sizeof errors / sizeof *errors; i++) {
        double seconds, pieces;
        ask(i ? got : want, &seconds, &pieces, &g, errors[i]);
        printf("  %-16s %8zu %6.2f  %4.2f %9.0f %9.1f %8.4f\n", name, s.count, made, errors[i],
               pieces, 1e6 * seconds, i ? rms(got, want) : 0.0);
    }
    glow_free(&g);
    glow_tree_free(&t);
    spread_free(&s);
    free(thin);
    free(all);
}

static void object(const char *path)
{
    struct mesh_file file = {.has_uv = true};
    const char *name = path && strrchr(path, '/') ? strrchr(path, '/') + 1 : path ? path : "ball";
    if (path)
        bench_check(mesh_read(&file, path, NULL));
    else
        shape_sphere(&file.mesh, vec3_of(0, 0, 0), 1.0, 64);
    for (size_t wanted = 1 << 12; wanted <= 1 << 17; wanted *= 32)
        points(name, &file.mesh, wanted);
    mesh_file_free(&file);
}

// ---------------------------------------------------------------- frames

struct frame_view {
    const relume_objects *o;
    struct relume_window window;
    struct lighting lighting;
    struct seen *seen;
    size_t pixels, alone;
    double wrong, all;
};

static struct ray ray_at(const void *context, double x, double y)
{
    const struct relume_window *w = &((const struct frame_view *)context)->window;
    const vec3 at = vec3_along(vec3_along(w->corner, w->right, x / WIDE), w->down, y / HIGH);
    return (struct ray){w->eye, vec3_unit(vec3_sub(at, w->eye))};
}

static void compare_pixel(struct frame_view *v, double x, double y)
{
    const struct ray ray = ray_at(v, x, y);
    struct surface_point p;
    float fast[3], slow[3];
    if (!objects_hit(&p, v->o, ray.origin, ray.direction) ||
        !translucent_shade(slow, &v->lighting, &p, ray.origin) ||
        !seen_shade(fast, v->seen, &p, ray.origin, x, y))
        return;
    v->pixels++;
    v->alone += fabsf(fast[1] - slow[1]) <= 1e-5f * slow[1];
    for (int c = 0; c < 3; c++) {
        v->wrong += pow((double)(fast[c] - slow[c]), 2.0);
        v->all += pow((double)slow[c], 2.0);
    }
}

static void frame(const char *path)
{
    char folder[] = "/tmp/bench-translucent-XXXXXX", file[64];
    struct frame_view v = {.pixels = 0};
    struct bodies *bodies = NULL;
    relume_objects *o;
    const struct relume_light light = {.direction = lamp, .rgb = {1, 1, 1}};
    const struct relume_render_params one = {.threads = 1};
    double at[5];
    if (!mkdtemp(folder))
        exit(1);
    snprintf(file, sizeof file, "%s/objects.json", folder);
    FILE *description = fopen(file, "w");
    fprintf(description,
            "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"%s\","
            "\"parts\":[{\"material\":{\"translucent\":\"marble\"}}]}]}",
            path);
    fclose(description);
    bench_check(relume_objects_open(&o, file, NULL));
    unlink(file);
    rmdir(folder);
    v.o = o;
    const struct relume_objects_info *info = relume_objects_info(o);
    const vec3 middle = vec3_scale(vec3_add(info->min, info->max), 0.5);
    const double away = 2.0 * vec3_length(vec3_sub(info->max, info->min));
    (void)relume_objects_window(&v.window, o, vec3_along(middle, vec3_of(0, 0, 1), away), NULL,
                                WIDE, HIGH);
    bench_check(lighting_create(&v.lighting, o, &light, 1, &one));
    at[0] = now_s();
    bench_check(bodies_need(&bodies, o, 1, NULL));
    at[1] = now_s();
    bench_check(lighting_enters(&v.lighting, o, bodies, 1, NULL));
    at[2] = now_s();
    bench_check(seen_create(&v.seen, o, &v.lighting, WIDE, HIGH, ray_at, &v, &one));
    at[3] = now_s();
    for (int i = 0; i < WIDE * HIGH; i++)
        compare_pixel(&v, i % WIDE + 0.5, i / WIDE + 0.5);
    at[4] = now_s();
    const char *name = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    printf("  %-20s %9zu %8zu %7.0f %7.0f %7.0f %8.0f  %4.1f %% %8.4f\n", name,
           info->triangle_count, v.pixels, 1e3 * (at[1] - at[0]), 1e3 * (at[2] - at[1]),
           1e3 * (at[3] - at[2]), 1e3 * (at[4] - at[3]), 100.0 * (double)v.alone / (double)v.pixels,
           sqrt(v.wrong / v.all));
    seen_destroy(&v.seen);
    lighting_destroy(&v.lighting);
    bodies_destroy(&bodies);
    relume_objects_destroy(&o);
}

int main(int argc, char **argv)
{
    puts("light below surfaces\n  object             points  made s error    pieces   us each   "
         "off by");
    object(NULL);
    for (int i = 1; i < argc; i++)
        object(argv[i]);
    if (argc > 1)
        puts("  frames             triangles   pixels  spread   enter  leaves     each   alone   "
             "off by");
    for (int i = 1; i < argc; i++)
        frame(argv[i]);
    return 0;
}
