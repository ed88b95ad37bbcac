// Ways to reflections that were used before rays: Meseth 2008, chapter 11.
//
//   bench_mirrors [MESH...]
//
// Where a bulging mirror reflects 20000 places: by Newton's method on a Bezier patch, by the cubic
// of one triangle out of N x N x 2; microseconds each, and how far from the law of reflection. Then
// rays off a mirror ball that meet a mesh, 200000 of them, by an octree of each depth and by the
// ray tracer: seconds to build, MB, millions of rays a second on one core, rays that only one of
// both lets meet something, and the median distance between them, in parts of the mesh's size.
#include "bench.h"

#include "core/math/random.h"
#include "core/math/sort.h"
#include "shape/mesh/mesh_read.h"
#include "shape/mesh/octree.h"
#include "shape/mesh/trace.h"
#include "world/reflect/bezier.h"
#include "world/reflect/triangle.h"
#include "world/stage/shapes.h"

enum { PLACES = 20000, RAYS = 200000 };

static const vec3 eye = {0.4, -0.3, 3.0};

static void make_bulge(struct bezier *out)
{
    vec3 control[4][4];
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++) {
            const bool inner = i % 3 && k % 3, corner = !(i % 3) && !(k % 3);
            control[i][k] = vec3_of((2 * i - 3) / 3.0, (2 * k - 3) / 3.0,
                                    0.25 * (inner    ? 1.0
                                            : corner ? 0.0
                                                     : 0.5));
        }
    bezier_make(out, (const vec3(*)[4])control);
}

static double off_law(const struct bezier *b, double u, double v, vec3 at, vec3 place)
{
    struct bezier_point p;
    bezier_at(&p, b, u, v);
    const vec3 n = vec3_unit(vec3_cross(p.u, p.v)), in = vec3_unit(vec3_sub(eye, at));
    const vec3 out = vec3_sub(vec3_scale(n, 2.0 * vec3_dot(n, in)), in);
    return vec3_length(vec3_sub(out, vec3_unit(vec3_sub(place, at))));
}

static vec3 place_number(int i)
{
    struct random r = random_stream(1, (uint64_t)i, 0);
    const double x = random_range(&r, -1.5, 1.5), y = random_range(&r, -1.5, 1.5);
    return vec3_of(x, y, random_range(&r, 1, 4));
}

static void by_patch(const struct bezier *b)
{
    double iterations = 0.0, off = 0.0;
    int found = 0;
    const double start = now_s();
    for (int i = 0; i < PLACES; i++) {
        struct bezier_reflection f;
        if (!bezier_reflect(&f, b, eye, place_number(i)))
            continue;
        found++;
        iterations += f.iterations;
        off = fmax(off, off_law(b, f.u, f.v, f.place, place_number(i)));
    }
    printf("  patch             %8.2f us  %.1f iterations, off by at most %.1e, %d of %d found\n",
           1e6 * (now_s() - start) / PLACES, iterations / found, off, found, PLACES);
}

// The triangle is chosen by the patch's own answer; only finding within it is timed.
static void by_triangles(const struct bezier *b, int n)
{
    double off = 0.0, seconds = 0.0;
    int found = 0;
    for (int i = 0; i < PLACES; i++) {
        struct bezier_reflection f;
        vec3 corner[3], normal[3];
        double at[3][2];
        if (!bezier_reflect(&f, b, eye, place_number(i)))
            continue;
        const double x = floor(f.u * n), y = floor(f.v * n);
        const bool upper = f.u * n - x + f.v * n - y > 1.0;
        for (int k = 0; k < 3; k++) {
            struct bezier_point p;
            at[k][0] = (x + (k == 1 || (upper && k == 2))) / n;
            at[k][1] = (y + (k == 2 || (upper && k == 0))) / n;
            if (upper && k == 0)
                at[k][0] = (x + 1) / n;
            if (upper && k == 1)
                at[k][1] = y / n, at[k][0] = (x + 1) / n;
            if (upper && k == 2)
                at[k][0] = x / n;
            bezier_at(&p, b, at[k][0], at[k][1]);
            corner[k] = p.s;
            normal[k] = vec3_unit(vec3_cross(p.u, p.v));
        }
        struct mirror_triangle m;
        struct triangle_reflection r;
        const vec3 place = place_number(i);
        const double start = now_s();
        mirror_triangle_make(&m, corner, normal, eye);
        const bool is = mirror_triangle_reflect(&r, &m, place);
        seconds += now_s() - start;
        if (!is)
            continue;
        found++;
        const double w = 1.0 - r.a - r.b;
        const double u = w * at[0][0] + r.a * at[1][0] + r.b * at[2][0];
        const double v = w * at[0][1] + r.a * at[1][1] + r.b * at[2][1];
        const vec3 s =
            vec3_along(vec3_along(vec3_scale(corner[0], w), corner[1], r.a), corner[2], r.b);
        off = fmax(off, off_law(b, u, v, s, place));
    }
    printf("  triangles %3d x %3d %6.2f us  off by at most %.1e, %d of %d found\n", n, n,
           1e6 * seconds / PLACES, off, found, PLACES);
}

// ---------------------------------------------------------------- rays

struct rays {
    vec3 *from, *along;
    double *distance;  // infinite: nothing is met
};

// Off a ball beside the mesh, as an eye far away sees it.
static void off_ball(struct rays *r, const struct mesh *m)
{
    const struct bounds b = mesh_bounds(m);
    const vec3 middle = vec3_scale(vec3_add(b.min, b.max), 0.5);
    const double size = vec3_length(vec3_sub(b.max, b.min));
    const vec3 ball = vec3_along(middle, vec3_of(0.8, 0, 0.6), 0.9 * size);
    for (int i = 0; i < RAYS; i++) {
        struct random at = random_stream(2, (uint64_t)i, 0);
        const double z = random_range(&at, -1, 1), a = random_range(&at, 0, 2 * M_PI);
        const vec3 n = vec3_of(sqrt(1 - z * z) * cos(a), z, sqrt(1 - z * z) * sin(a));
        r->from[i] = vec3_along(ball, n, 0.3 * size);
        const vec3 in =
            vec3_unit(vec3_sub(vec3_along(ball, vec3_of(-0.6, 0, 0.8), 9 * size), r->from[i]));
        r->along[i] = vec3_sub(vec3_scale(n, 2.0 * vec3_dot(n, in)), in);
    }
}

static double by_octree(double *distance, const struct rays *r, const octree *o, double cone)
{
    const double start = now_s();
    for (int i = 0; i < RAYS; i++) {
        struct octree_hit hit;
        distance[i] =
            octree_trace(&hit, o, r->from[i], r->along[i], cone) ? hit.distance : INFINITY;
    }
    return now_s() - start;
}

static double by_tracer(double *distance, const struct rays *r, const tracer *t)
{
    const double start = now_s();
    for (int i = 0; i < RAYS; i++) {
        const vec3 p = r->from[i], d = r->along[i];
        const float from[3] = {(float)p.x, (float)p.y, (float)p.z};
        const float along[3] = {(float)d.x, (float)d.y, (float)d.z};
        struct trace_hit hit;
        distance[i] = trace_closest(t, from, along, &hit) ? (double)hit.distance : INFINITY;
    }
    return now_s() - start;
}

static void compare(const char *name, double built, size_t bytes, double seconds,
                    const double *distance, const struct rays *r, double size)
{
    double *off = malloc(RAYS * sizeof *off);
    int both = 0, one = 0;
    for (int i = 0; i < RAYS; i++) {
        const bool a = distance[i] < INFINITY, b = r->distance[i] < INFINITY;
        one += a != b;
        if (a && b)
            off[both++] = fabs(distance[i] - r->distance[i]) / size;
    }
    sort_doubles(off, (size_t)both);
    printf("  %-18s %6.2f s %7.1f MB %7.2f M rays/s  %5.2f %%  %.5f\n", name, built,
           (double)bytes / (1 << 20), 1e-6 * RAYS / seconds, 100.0 * one / RAYS,
           both ? off[both / 2] : 0.0);
    free(off);
}

static void trace(const char *path)
{
    struct mesh_file file = {.has_uv = true};
    struct rays r = {malloc(RAYS * sizeof *r.from), malloc(RAYS * sizeof *r.along),
                     malloc(RAYS * sizeof *r.distance)};
    double *distance = malloc(RAYS * sizeof *distance);
    if (path)
        bench_check(mesh_read(&file, path, NULL));
    else
        shape_teapot(&file.mesh, 16);
    const struct bounds b = mesh_bounds(&file.mesh);
    const double size = vec3_length(vec3_sub(b.max, b.min));
    printf("%s, %zu triangles\n", path && strrchr(path, '/') ? strrchr(path, '/') + 1 : "teapot",
           file.mesh.triangle_count);
    off_ball(&r, &file.mesh);
    tracer *t;
    double start = now_s();
    bench_check(trace_create(&t, &file.mesh, NULL));
    const double built = now_s() - start;
    const double seconds = by_tracer(r.distance, &r, t);
    compare("ray tracer", built, 0, seconds, r.distance, &r, size);
    for (int depth = 7; depth <= 9; depth++) {
        octree *o;
        char name[32];
        start = now_s();
        bench_check(octree_create(&o, &file.mesh, depth));
        const double made = now_s() - start;
        for (int wide = 0; wide < 2; wide++) {
            snprintf(name, sizeof name, "octree, depth %d%s", depth, wide ? ", cone" : "");
            const double s = by_octree(distance, &r, o, wide ? 0.01 : 0.0);
            compare(name, made, octree_bytes(o), s, distance, &r, size);
        }
        octree_destroy(&o);
    }
    trace_destroy(&t);
    mesh_file_free(&file);
    free(r.from);
    free(r.along);
    free(r.distance);
    free(distance);
}

int main(int argc, char **argv)
{
    struct bezier b;
    make_bulge(&b);
    puts("reflections of places in a bulging mirror");
    by_patch(&b);
    for (int n = 4; n <= 64; n *= 4)
        by_triangles(&b, n);
    trace(NULL);
    for (int i = 1; i < argc; i++)
        trace(argv[i]);
    return 0;
}
