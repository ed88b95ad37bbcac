// bench_fusion: how far meshes of depth are from what the depth was captured of
//
//     bench_fusion SCENE CAPTURE.exr [VOXEL]
//
// SCENE is a built-in one, CAPTURE.exr what `relume synth SCENE` and `relume encode` have made of
// it. Distances are the shortest of rays in 26 directions and along the normal: none is too short,
// and of a flat surface the last is exact.
#include "bench.h"

#include "relight/view/view.h"
#include "world/stage/scene.h"

struct distances {
    double sum, most;
    size_t count, beyond;  // by more than two voxels
    float *all;
};

static double nearest(const tracer *t, const float p[3], const float n[3])
{
    double least = INFINITY;
    for (int i = -1; i < 27; i++)
        for (int way = -1; way <= 1; way += 2) {
            const int x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1;
            const vec3 raw =
                i < 0 ? vec3_of((double)n[0], (double)n[1], (double)n[2]) : vec3_of(x, y, z);
            if (!(vec3_length(raw) > 0.0))
                continue;
            const vec3 u = vec3_scale(vec3_unit(raw), way);
            const float d[3] = {(float)u.x, (float)u.y, (float)u.z};
            struct trace_hit hit;
            if (trace_closest(t, p, d, &hit))
                least = fmin(least, (double)hit.distance);
        }
    return least;
}

static void add(struct distances *d, double distance, double voxel)
{
    d->beyond += distance > 2.0 * voxel;
    if (!isfinite(distance))  // no ray has met anything
        return;
    d->sum += distance;
    d->most = fmax(d->most, distance);
    d->all[d->count++] = (float)distance;
}

static int compare(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

static void print(const char *what, struct distances *d, double voxel)
{
    qsort(d->all, d->count, sizeof *d->all, compare);
    printf("  %-28s mean %.3f, 95 %% below %.3f, most %.2f voxels; %.2f %% beyond 2\n", what,
           d->sum / (double)d->count / voxel, (double)d->all[d->count * 95 / 100] / voxel,
           d->most / voxel, 100.0 * (double)d->beyond / (double)d->count);
    free(d->all);
}

// From the middle of every triangle, and every vertex, to the scene.
static void to_scene(const struct relume_mesh *m, const tracer *scene, double voxel)
{
    struct distances d = {.all = malloc((m->triangle_count + m->vertex_count) * sizeof *d.all)};
    for (size_t i = 0; i < m->vertex_count; i++)
        add(&d, nearest(scene, m->position[i], m->normal[i]), voxel);
    for (size_t i = 0; i < m->triangle_count; i++) {
        float p[3] = {0};
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 3; c++)
                p[c] += m->position[m->triangle[i][k]][c] / 3.0f;
        add(&d, nearest(scene, p, m->normal[m->triangle[i][0]]), voxel);
    }
    print("mesh to scene", &d, voxel);
}

// From every fifth place that a pixel shows to the mesh.
static void to_mesh(const struct relume_mesh *m, relume_pack *pack, double voxel)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct mesh mesh = {0};
    tracer *t;
    relume_renderer *renderer;
    struct distances d = {.all = malloc((size_t)info->views * (size_t)info->width *
                                        (size_t)info->height * sizeof *d.all)};
    for (size_t i = 0; i < m->vertex_count; i++)
        mesh_vertex(&mesh,
                    vec3_of((double)m->position[i][0], (double)m->position[i][1],
                            (double)m->position[i][2]),
                    vec3_of(0, 0, 1), vec3_of(0, 0, 0));
    for (size_t i = 0; i < m->triangle_count; i++)
        mesh_triangle(&mesh, m->triangle[i][0], m->triangle[i][1], m->triangle[i][2], 0);
    bench_check(trace_create(&t, &mesh, NULL));
    bench_check(relume_renderer_create(&renderer, pack, NULL));
    for (int view = 0; view < info->views; view++) {
        struct relume_image depth, places;
        bench_check(relume_pack_depth(&depth, pack, view));
        bench_check(relume_view_positions(&places, relume_pack_geometry(pack, view),
                                          info->uv ? info->uv[view] : (const double[2]){0, 0},
                                          &depth, info->width, info->height));
        for (size_t i = 0; i < (size_t)info->width * (size_t)info->height; i += 5) {
            const float *p = places.data + 3 * i;
            if (isfinite(p[0]) && isfinite(depth.data[i]))
                add(&d, nearest(t, p, (const float[3]){0, 0, 1}), voxel);
        }
        relume_image_destroy(&depth);
        relume_image_destroy(&places);
    }
    relume_renderer_destroy(&renderer);
    trace_destroy(&t);
    mesh_free(&mesh);
    print("what pixels see to mesh", &d, voxel);
}

// What the relit views lose in colours of vertices, and in a picture.
static void colours(relume_pack *pack, int block, double voxel)
{
    for (int side = 0; side <= 2048; side = side ? 4 * side : 512) {
        struct relume_mesh mesh;
        struct relume_fusion_report r;
        bench_check(relume_fusion(
            &mesh, &r, pack,
            relume_fusion_params(.block = block, .judge = true, .voxel = voxel, .texture = side)));
        printf("  colours, texture of %d: %.2f dB over %.2f %%\n", side, r.psnr_db,
               100.0 * r.shown);
        relume_image_destroy(&r.picture);
        relume_mesh_free(&mesh);
    }
}

int main(int argc, char **argv)
{
    if (argc < 3)
        return 0;
    relume_scene *scene;
    relume_pack *pack;
    bench_check(relume_scene_create(&scene, relume_scene_find(argv[1]), NULL));
    bench_check(relume_open(&pack, argv[2], NULL));
    for (int block = 1; block <= 8; block *= 2) {
        struct relume_mesh mesh;
        struct relume_fusion_report r;
        bench_check(relume_fusion(&mesh, &r, pack,
                                  relume_fusion_params(.block = block, .no_colours = true,
                                                       .voxel = argc > 3 ? atof(argv[3]) : 0)));
        printf("%s, N=%d: %zu triangles, voxels of %.4f, %d x %d x %d, %.2f s\n", argv[1], block,
               mesh.triangle_count, r.voxel, r.size[0], r.size[1], r.size[2], r.seconds);
        to_scene(&mesh, scene->tracer, r.voxel);
        to_mesh(&mesh, pack, r.voxel);
        colours(pack, block, r.voxel);
        relume_mesh_free(&mesh);
    }
    relume_pack_destroy(&pack);
    relume_scene_destroy(&scene);
    return 0;
}
