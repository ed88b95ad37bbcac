// The virtual light stage: cameras, radiometry, shadows, depth, indirect light, capture folders.
#include "core/base/memory.h"
#include "relight/view/view.h"
#include "world/stage/render.h"

#include <relume/capture.h>
#include <relume/image/directions.h>
#include <relume/relight/view.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static void check_near(double got, double want, double tolerance)
{
    if (!(fabs(got - want) <= tolerance))
        fail_msg("found %.9g; expected %.9g within %g", got, want, tolerance);
}

static bool go_on(void *user, double done)
{
    (void)user, (void)done;
    return true;
}

static relume_scene *make_scene(const struct relume_scene_kind *kind)
{
    relume_scene *scene;
    assert_int_equal(relume_scene_create(&scene, kind, NULL), RELUME_OK);
    return scene;
}

static struct render_job job_for(const relume_scene *scene, enum relume_projection projection,
                                 int width, int height)
{
    return (struct render_job){
        .scene = scene,
        .camera = {.geometry = relume_geometry_default(projection, width, height),
                   .width = width,
                   .height = height},
        .samples = 4,
        .threads = 1,
    };
}

static struct relume_image render(struct render_job job, vec3 light)
{
    struct relume_image image;
    assert_int_equal(relume_image_create(&image, job.camera.width, job.camera.height, 3),
                     RELUME_OK);
    job.lights = &light;
    job.light_count = 1;
    assert_int_equal(render_lights(&job, &image, go_on, NULL), RELUME_OK);
    return image;
}

static const float *at(const struct relume_image *image, int x, int y)
{
    return image->data + ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
}

static double mean(const struct relume_image *image)
{
    double sum = 0.0;
    const size_t n = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < n; i++)
        sum += image->data[i];
    return sum / (double)n;
}

// ---------------------------------------------------------------- scenes of our own

static relume_status build_plane(struct relume_scene_builder *b)
{
    struct mesh part = {0};
    shape_quad(&part, vec3_of(-9, -9, 0), vec3_of(18, 0, 0), vec3_of(0, 18, 0));
    build_put_exact(b, &part, build_material(b, build_matte(1, 1, 1)));
    return RELUME_OK;
}

static relume_status build_ball(struct relume_scene_builder *b)
{
    struct mesh part = {0};
    shape_sphere(&part, vec3_of(0, 0, 0), 0.9, 256);
    build_put_exact(b, &part, build_material(b, build_matte(1, 1, 1)));
    return RELUME_OK;
}

static struct material coated(float diffuse, float f0, float alpha, float mirror)
{
    struct material m = build_matte(diffuse, diffuse, diffuse);
    m.f0[0] = m.f0[1] = m.f0[2] = f0;
    m.alpha = alpha;
    m.mirror = mirror;
    return m;
}

static void add_corner(struct relume_scene_builder *b, struct material material)
{
    const uint32_t m = build_material(b, material);
    struct mesh part = {0};
    shape_quad(&part, vec3_of(-99, -99, 0), vec3_of(198, 0, 0), vec3_of(0, 198, 0));
    build_put_exact(b, &part, m);
    shape_box(&part, vec3_of(-0.5, -0.5, 0), vec3_of(0.5, 0.5, 1));
    build_put_exact(b, &part, m);
}

static relume_status build_white(struct relume_scene_builder *b)
{
    add_corner(b, build_matte(1, 1, 1));
    return RELUME_OK;
}

static relume_status build_coated(struct relume_scene_builder *b)
{
    add_corner(b, coated(1.0f, 0.3f, 0.4f, 0.0f));
    return RELUME_OK;
}

// A mirror over the lower half of the window shows a ball that hangs before it.
static relume_status build_mirror(struct relume_scene_builder *b)
{
    struct mesh part = {0};
    shape_quad(&part, vec3_of(-2, -2, -1), vec3_of(4, 0, 0), vec3_of(0, 4, 0));
    build_put_exact(b, &part, build_material(b, coated(0.0f, 1.0f, 0.1f, 1.0f)));
    shape_quad(&part, vec3_of(-2, -2, 5), vec3_of(0, 4, 0), vec3_of(4, 0, 0));
    build_put_exact(b, &part, build_material(b, build_matte(0.5f, 0.25f, 1.0f)));
    return RELUME_OK;
}

static const struct relume_scene_kind plane = {.name = "plane", .build = build_plane},
                                      ball = {.name = "ball", .build = build_ball},
                                      white = {.name = "white", .build = build_white},
                                      coat = {.name = "coat", .build = build_coated},
                                      mirror = {.name = "mirror", .build = build_mirror};

// ---------------------------------------------------------------- cameras

static void check_direction(struct camera_ray ray, double x, double y, double z)
{
    const vec3 want = vec3_unit(vec3_of(x, y, z));
    check_near(vec3_length(vec3_sub(ray.direction, want)), 0.0, 1e-12);
}

static void slab_rays_pass_their_window_points(void **state)
{
    (void)state;
    struct camera c = {.geometry = relume_geometry_default(RELUME_SLAB, 8, 4),
                       .width = 8,
                       .height = 4,
                       .uv = {0.5, -0.25}};
    // Row 0 is the top, column 0 the left.
    const struct camera_ray r = camera_ray_at(&c, 0.5, 0.5);
    const vec3 target = vec3_of(-1.0 + 2.0 * 0.5 / 8, 1.0 - 2.0 * 0.5 / 4, 0.0);
    check_near(r.origin.x, 0.5, 0.0);
    check_near(r.origin.y, -0.25, 0.0);
    check_near(r.origin.z, 3.0, 0.0);
    check_direction(r, target.x - 0.5, target.y + 0.25, -3.0);
}

static void panorama_rays_follow_the_contract(void **state)
{
    (void)state;
    struct camera c = {.width = 8, .height = 4};
    c.geometry = relume_geometry_default(RELUME_CYLINDRICAL, 8, 4);
    check_direction(camera_ray_at(&c, 4, 2), 0, 0, -1);
    check_direction(camera_ray_at(&c, 6, 2), 1, 0, 0);
    check_direction(camera_ray_at(&c, 0, 2), 0, 0, 1);
    check_direction(camera_ray_at(&c, 4, 0), 0, 1, -1);
    c.height = 4 + 3;
    c.geometry.disc = 3;
    check_direction(camera_ray_at(&c, 0, 2), 0, 0, 1);
    check_direction(camera_ray_at(&c, 1.5, 5.5), 0, 1, 0);
    check_direction(camera_ray_at(&c, 3, 5.5 - 1e-13), -1, -1, 0);
    check_direction(camera_ray_at(&c, 1.5, 7), 0, 1, -1);  // up is +z
    check_direction(camera_ray_at(&c, 4.5, 7), 0, -1, 1);  // up is -z
    c.height = 4;
    c.geometry = relume_geometry_default(RELUME_SPHERICAL, 8, 4);
    check_direction(camera_ray_at(&c, 6, 2), 1, 0, 0);
    check_direction(camera_ray_at(&c, 4, 1), 0, 1, -1);
    check_direction(camera_ray_at(&c, 4, 0), 0, 1, 0);
    c.geometry = relume_geometry_default(RELUME_CUBE, 24, 4);
    c.width = 24;
    static const double axes[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                      {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    for (int f = 0; f < 6; f++)
        check_direction(camera_ray_at(&c, 4 * f + 2, 2), axes[f][0], axes[f][1], axes[f][2]);
    check_direction(camera_ray_at(&c, 3, 2), 1, 0, 0.5);     // +x: right is direction x up = +z
    check_direction(camera_ray_at(&c, 23, 2), 0.5, 0, -1);   // -z: right is +x
    check_direction(camera_ray_at(&c, 2, 1), 1, 0.5, 0);     // up is +y
    check_direction(camera_ray_at(&c, 10, 1), 0, 1, 0.5);    // +y: up is +z
    check_direction(camera_ray_at(&c, 14, 1), 0, -1, -0.5);  // -y: up is -z
}

// ---------------------------------------------------------------- light

static void a_white_plane_shows_the_cosine(void **state)
{
    (void)state;
    relume_scene *scene = make_scene(&plane);
    for (int degrees = 0; degrees < 90; degrees += 15) {
        const double a = degrees * M_PI / 180.0;
        struct relume_image image =
            render(job_for(scene, RELUME_PLANAR, 8, 8), vec3_of(sin(a), 0, cos(a)));
        for (int i = 0; i < 8 * 8 * 3; i++)
            check_near(image.data[i], cos(a), 1e-6);
        relume_image_destroy(&image);
    }
    struct relume_image behind = render(job_for(scene, RELUME_PLANAR, 8, 8), vec3_of(0, 0, -1));
    check_near(mean(&behind), 0.0, 0.0);
    relume_image_destroy(&behind);
    relume_scene_destroy(&scene);
}

// As strong at the origin as a distant light, by the square of the distance, to the cosine.
static void near_lamps_fall_off_and_throw_shadows(void **state)
{
    (void)state;
    const vec3 lamp = {0.3, -0.2, 0.8}, below = {0.3, -0.2, -0.8};
    relume_scene *scene = make_scene(&plane);
    enum { SIDE = 32 };
    struct render_job job = job_for(scene, RELUME_PLANAR, SIDE, SIDE);
    job.samples = 64;  // the mean of a pixel is compared with its middle
    job.near = true;
    struct relume_image fine = render(job, lamp), behind = render(job, below);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double x = 2.0 * (i % SIDE + 0.5) / SIDE - 1.0,
                     y = 1.0 - 2.0 * (i / SIDE + 0.5) / SIDE;
        const vec3 to = vec3_sub(lamp, vec3_of(x, y, 0.0));
        const double squared = vec3_dot(to, to);
        check_near(fine.data[3 * i], vec3_dot(lamp, lamp) * to.z / (squared * sqrt(squared)), 2e-3);
        check_near(behind.data[3 * i], 0.0, 0.0);
    }
    relume_image_destroy(&behind);
    relume_image_destroy(&fine);
    relume_scene_destroy(&scene);
    // between the lamp and the ground the box, but not what is beyond the lamp
    scene = make_scene(&white);
    job = job_for(scene, RELUME_PLANAR, 16, 16);
    job.near = true;
    struct relume_image above = render(job, vec3_of(0.9, 0, 1.2)),
                        beside = render(job, vec3_of(0.9, 0, 0.5));
    check_near(*at(&above, 1, 8), 0.0, 0.0);
    assert_true(*at(&beside, 15, 8) > 0.1f);
    relume_image_destroy(&above);
    relume_image_destroy(&beside);
    relume_scene_destroy(&scene);
}

static void light_comes_from_its_own_side(void **state)
{
    (void)state;
    relume_scene *scene = make_scene(&ball);
    static const enum relume_projection projections[] = {RELUME_PLANAR, RELUME_SLAB};
    for (int i = 0; i < 2; i++) {
        const struct render_job job = job_for(scene, projections[i], 32, 32);
        struct relume_image right = render(job, vec3_of(1, 0, 0)),
                            up = render(job, vec3_of(0, 1, 0));
        assert_true(*at(&right, 26, 16) > 0.5f && *at(&right, 5, 16) == 0.0f);
        assert_true(*at(&up, 16, 5) > 0.5f && *at(&up, 16, 26) == 0.0f);
        relume_image_destroy(&right);
        relume_image_destroy(&up);
    }
    relume_scene_destroy(&scene);
}

// The box's upper front edge (z = 0.5, y = -0.35) throws its shadow to y = -0.35 - 0.5 ly / lz.
static void the_shadow_of_the_box_ends_where_it_must(void **state)
{
    (void)state;
    relume_scene *scene = make_scene(relume_scene_find("box"));
    struct render_job job = job_for(scene, RELUME_PLANAR, 200, 200);
    job.samples = 16;
    struct relume_image image = render(job, vec3_of(0, 0.6, 0.8));
    const int x = 60, edge = 172;  // x = -0.395; row 172 spans y from -0.72 to -0.73
    check_near(*at(&image, x, edge - 1), 0.0, 1e-6);
    // Half of the row's samples lie below -0.725, give or take one of 16.
    check_near(*at(&image, x, edge), 0.5 * 0.64, 0.64 / 15.0);
    check_near(*at(&image, x, edge + 1), 0.8 * 0.8, 1e-6);
    relume_image_destroy(&image);
    relume_scene_destroy(&scene);
}

static void mirrors_show_what_is_behind_the_eye(void **state)
{
    (void)state;
    relume_scene *scene = make_scene(&mirror);
    // The painted wall at z = 5 faces -z: only light from -z that passes the mirror would reach it,
    // so the mirror, which is 4 wide, must let light in from the side.
    struct relume_image image =
        render(job_for(scene, RELUME_PLANAR, 4, 4), vec3_unit(vec3_of(1, 0, -0.5)));
    const double cosine = 0.5 / sqrt(1.25);
    check_near(at(&image, 2, 2)[0], 0.5 * cosine, 1e-5);
    check_near(at(&image, 2, 2)[1], 0.25 * cosine, 1e-5);
    relume_image_destroy(&image);
    relume_scene_destroy(&scene);
}

// Mean over the image under a uniform sky of radiance 1: `n` lights each weigh 2 / n.
static double under_a_sky(const relume_scene *scene, int bounces)
{
    enum { LIGHTS = 256 };
    vec3 lights[LIGHTS];
    assert_int_equal(relume_directions_make(lights, LIGHTS, relume_pattern_find("spiral"),
                                            relume_directions_params(.hemisphere = true)),
                     RELUME_OK);
    struct render_job job = job_for(scene, RELUME_PLANAR, 16, 16);
    job.samples = 16;
    job.bounces = bounces;
    job.lights = lights;
    job.light_count = LIGHTS;
    struct relume_image images[LIGHTS];
    for (int i = 0; i < LIGHTS; i++)
        assert_int_equal(relume_image_create(&images[i], 16, 16, 3), RELUME_OK);
    assert_int_equal(render_lights(&job, images, go_on, NULL), RELUME_OK);
    double sum = 0.0;
    for (int i = 0; i < LIGHTS; i++) {
        sum += mean(&images[i]) * 2.0 / LIGHTS;
        relume_image_destroy(&images[i]);
    }
    return sum;
}

// In a furnace of radiance 1 a white world looks like the sky (and no other is brighter).
static void indirect_light_completes_the_furnace(void **state)
{
    (void)state;
    relume_scene *scene = make_scene(&white);
    const double direct = under_a_sky(scene, 0), full = under_a_sky(scene, 12);
    assert_true(direct < 0.95);
    check_near(full, 1.0, 0.01);  // 4096 paths of standard deviation below 0.3
    relume_scene_destroy(&scene);
    scene = make_scene(&coat);
    const double glossy = under_a_sky(scene, 12);
    assert_true(glossy > 0.5 && glossy < 1.0);
    relume_scene_destroy(&scene);
}

static void depth_is_the_closed_form(void **state)
{
    (void)state;
    relume_scene *scene = make_scene(relume_scene_find("box"));
    struct render_job job = job_for(scene, RELUME_PLANAR, 200, 200);
    struct relume_image depth;
    assert_int_equal(relume_image_create(&depth, 200, 200, 1), RELUME_OK);
    render_depth(&job, &depth);
    check_near(*at(&depth, 10, 190), 4.0, 1e-6);
    check_near(*at(&depth, 60, 100), 3.5, 1e-6);
    const double x = -1.0 + 0.01 * 150.5 - 0.4, y = 1.0 - 0.01 * 80.5 - 0.1;
    // The sphere is a polyhedron of 192 segments: up to r (pi / 192)^2 / 2 inside.
    check_near(*at(&depth, 150, 80), 4.0 - 0.35 - sqrt(0.35 * 0.35 - x * x - y * y), 2e-4);
    relume_image_destroy(&depth);

    job = job_for(scene, RELUME_SLAB, 64, 64);
    job.camera.uv[0] = 1.0;
    assert_int_equal(relume_image_create(&depth, 64, 64, 1), RELUME_OK);
    render_depth(&job, &depth);
    const double s = -1.0 + 2.0 * 2.5 / 64, t = 1.0 - 2.0 * 60.5 / 64;
    check_near(*at(&depth, 2, 60), sqrt((s - 1) * (s - 1) + t * t + 9.0), 1e-5);
    relume_image_destroy(&depth);
    relume_scene_destroy(&scene);

    scene = make_scene(&ball);
    job = job_for(scene, RELUME_PLANAR, 8, 8);
    assert_int_equal(relume_image_create(&depth, 8, 8, 1), RELUME_OK);
    render_depth(&job, &depth);
    assert_true(isinf(*at(&depth, 0, 0)));
    relume_image_destroy(&depth);
    relume_scene_destroy(&scene);
}

static void threads_do_not_change_a_bit(void **state)
{
    (void)state;
    relume_scene *scene = make_scene(relume_scene_find("teapot"));
    struct render_job job = job_for(scene, RELUME_SLAB, 70, 50);
    job.bounces = 1;
    const vec3 light = vec3_unit(vec3_of(-0.3, 0.7, 0.6));
    struct relume_image one = render(job, light);
    for (int threads = 2; threads <= 7; threads += 5) {
        job.threads = threads;
        struct relume_image many = render(job, light);
        assert_memory_equal(one.data, many.data, 70 * 50 * 3 * sizeof(float));
        relume_image_destroy(&many);
    }
    assert_true(mean(&one) > 0.05);
    relume_image_destroy(&one);
    relume_scene_destroy(&scene);
}

static void every_scene_shows_something(void **state)
{
    (void)state;
    for (const struct relume_scene_kind *const *k = relume_scenes; *k; k++) {
        relume_scene *scene = make_scene(*k);
        assert_ptr_equal(relume_scene_find((*k)->name), *k);
        struct relume_image image =
            render(job_for(scene, (*k)->projection, 64, 32), vec3_unit(vec3_of(0.4, 0.8, 0.5)));
        assert_true(mean(&image) > 0.02);
        relume_image_destroy(&image);
        relume_scene_destroy(&scene);
    }
}

// ---------------------------------------------------------------- folders

static char folder[64];

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/relume-synth-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

static bool exists(const char *name)
{
    char path[128];
    struct stat s;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return !lstat(path, &s);
}

static relume_status capture(const relume_scene *scene, const char *name,
                             const struct relume_synth_params *params)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return relume_scene_capture(scene, path, params);
}

static const vec3 two_lights[2] = {{0, 0, 1}, {0.6, 0, 0.8}};

static void a_capture_reads_back(void **state)
{
    (void)state;
    relume_scene *scene = make_scene(relume_scene_find("box"));
    const vec3 eyes[2] = {{0.5, 0.25, 2.5}, {-1, 0, 2.5}};
    const struct relume_synth_params p = {.projection = RELUME_SLAB,
                                          .projection_set = true,
                                          .size = 24,
                                          .eyes = eyes,
                                          .eye_count = 2,
                                          .lights = two_lights,
                                          .light_count = 2,
                                          .samples = 1};
    assert_int_equal(capture(scene, "slab", &p), RELUME_OK);
    assert_false(exists("slab.part"));
    char path[128];
    snprintf(path, sizeof path, "%s/slab", folder);
    relume_capture *c;
    assert_int_equal(relume_capture_open(&c, path, NULL), RELUME_OK);
    const struct relume_manifest *m = relume_capture_manifest(c);
    assert_int_equal(m->geometry.projection, RELUME_SLAB);
    assert_int_equal(m->lights, 2);
    assert_int_equal(m->views, 2);
    check_near(m->geometry.uv_z, 2.5, 0.0);
    check_near(m->view[0].uv[1], 0.25, 0.0);
    check_near(m->directions[1].x, 0.6, 1e-9);
    struct relume_image image, depth;
    assert_int_equal(relume_capture_image(&image, c, 1, 1, NULL), RELUME_OK);
    check_near(*at(&image, 0, 23), 0.8 * 0.8, 0.64 * 0x1p-11);  // half floats
    assert_int_equal(relume_capture_depth(&depth, c, 1, NULL), RELUME_OK);
    check_near(*at(&depth, 0, 23), sqrt(pow(1.0 / 24, 2) + pow(1 - 1.0 / 24, 2) + 6.25), 1e-5);
    relume_image_destroy(&image);
    relume_image_destroy(&depth);
    relume_capture_destroy(&c);
    relume_scene_destroy(&scene);
}

// The plane z = 0 of the box scene from 45 degrees beside: what a turned camera measures lies on
// it.
static void a_ring_looks_at_the_origin(void **state)
{
    (void)state;
    relume_scene *scene = make_scene(relume_scene_find("box"));
    const struct relume_synth_params p = {.projection = RELUME_SLAB,
                                          .projection_set = true,
                                          .size = 8,
                                          .grid = {2, 1},
                                          .ring = RELUME_RING_8,
                                          .lights = two_lights,
                                          .light_count = 1,
                                          .samples = 1};
    assert_int_equal(capture(scene, "ring", &p), RELUME_OK);
    char path[128];
    snprintf(path, sizeof path, "%s/ring", folder);
    relume_capture *c;
    assert_int_equal(relume_capture_open(&c, path, NULL), RELUME_OK);
    const struct relume_manifest *m = relume_capture_manifest(c);
    assert_int_equal(m->slabs, 8);
    assert_int_equal(m->views, 16);
    check_near(m->view[1].uv[0], 1.15 * 3 * tan(M_PI / 8), 1e-8);
    for (int view = 2; view < 4; view++) {
        const struct relume_geometry *g = &m->slab[m->view[view].slab];
        struct relume_image depth, surface;
        assert_int_equal(m->view[view].slab, 1);
        assert_int_equal(relume_capture_depth(&depth, c, view, NULL), RELUME_OK);
        assert_int_equal(relume_view_positions(&surface, g, m->view[view].uv, &depth, 8, 8),
                         RELUME_OK);
        // the picture's right is on the near side of the plane
        for (int y = 0; y < 8; y += 7) {
            check_near(at(&surface, 7, y)[2], 0.0, 1e-5);
            assert_true(at(&surface, 7, y)[0] > 0.5f);
        }
        assert_true(g->pose.axis[2].x > 0.7 && g->pose.axis[2].z > 0.7);
        relume_image_destroy(&depth);
        relume_image_destroy(&surface);
    }
    relume_capture_destroy(&c);
    relume_scene_destroy(&scene);
}

static void wrong_requests_are_refused(void **state)
{
    (void)state;
    relume_scene *scene = make_scene(relume_scene_find("box"));
    const vec3 beside = {1, 0, 4}, uneven[2] = {{0, 0, 3}, {0, 0, 2}};
    const struct relume_synth_params good = {
        .size = 4, .lights = two_lights, .light_count = 2, .samples = 1};
    enum { WRONG = 11 };
    struct relume_synth_params p[WRONG];
    for (int i = 0; i < WRONG; i++)
        p[i] = good;
    p[0].light_count = 0;
    p[1].size = -1;
    p[2].size = 1 << 30;
    p[3].samples = -1;
    p[4].bounces = -1;
    p[5].eyes = &beside, p[5].eye_count = 1;
    p[6].projection = RELUME_SLAB, p[6].projection_set = true;
    p[6].eyes = uneven, p[6].eye_count = 2;
    p[7].projection = (enum relume_projection)9, p[7].projection_set = true;
    p[8].ring = RELUME_RING_4;
    p[9].projection = RELUME_SLAB, p[9].projection_set = true;
    p[9].ring = RELUME_RING_4, p[9].eyes = &beside, p[9].eye_count = 1;
    p[10].near = true, p[10].lights = &(const vec3){0, 0, 0}, p[10].light_count = 1;
    for (int i = 0; i < WRONG; i++)
        assert_int_equal(capture(scene, "wrong", &p[i]), RELUME_EINVAL);
    assert_false(exists("wrong") || exists("wrong.part"));
    relume_scene_destroy(&scene);
    assert_int_equal(relume_scene_create(&scene, relume_scene_find("box"),
                                         relume_scene_params(.mesh = "some.obj")),
                     RELUME_EINVAL);
    assert_null(scene);
    assert_null(relume_scene_find("nothing"));
}

static bool stop(void *user, const char *what, double done)
{
    (void)user, (void)what, (void)done;
    return false;
}

static void cancelling_and_failing_leave_nothing(void **state)
{
    (void)state;
    relume_scene *scene = make_scene(relume_scene_find("box"));
    const struct relume_log stopping = {.progress = stop};
    struct relume_synth_params p = {
        .log = &stopping, .size = 8, .lights = two_lights, .light_count = 2, .samples = 1};
    assert_int_equal(capture(scene, "stopped", &p), RELUME_ECANCEL);
    assert_false(exists("stopped") || exists("stopped.part"));
    p.log = NULL;
    assert_int_equal(capture(scene, "missing/folder", &p), RELUME_EIO);
    assert_int_equal(capture(scene, "twice", &p), RELUME_OK);
    assert_int_equal(capture(scene, "twice", &p), RELUME_EINVAL);
    p.force = true;
    assert_int_equal(capture(scene, "twice", &p), RELUME_OK);
    relume_scene_destroy(&scene);
}

// Whichever allocation fails, the status says so and nothing is left behind (or leaks, under asan).
static void short_memory_is_survived(void **state)
{
    (void)state;
    const struct relume_synth_params p = {.size = 4,
                                          .lights = two_lights,
                                          .light_count = 2,
                                          .samples = 1,
                                          .threads = 2,
                                          .bounces = 1};
    int failures = 0;
    for (long n = 1;; n++) {
        relume_scene *scene = NULL;
        mem_fail_after(n);
        relume_status status = relume_scene_create(&scene, relume_scene_find("box"), NULL);
        if (!status)
            status = capture(scene, "short", &p);
        mem_fail_after(0);
        relume_scene_destroy(&scene);
        if (!status)
            break;
        failures++;
        assert_true(status == RELUME_ENOMEM || status == RELUME_EIO);
        assert_false(exists("short") || exists("short.part"));
    }
    assert_true(failures > 20 && exists("short"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slab_rays_pass_their_window_points),
        cmocka_unit_test(panorama_rays_follow_the_contract),
        cmocka_unit_test(a_white_plane_shows_the_cosine),
        cmocka_unit_test(near_lamps_fall_off_and_throw_shadows),
        cmocka_unit_test(light_comes_from_its_own_side),
        cmocka_unit_test(the_shadow_of_the_box_ends_where_it_must),
        cmocka_unit_test(mirrors_show_what_is_behind_the_eye),
        cmocka_unit_test(indirect_light_completes_the_furnace),
        cmocka_unit_test(depth_is_the_closed_form),
        cmocka_unit_test(threads_do_not_change_a_bit),
        cmocka_unit_test(every_scene_shows_something),
        cmocka_unit_test_setup_teardown(a_capture_reads_back, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(a_ring_looks_at_the_origin, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(wrong_requests_are_refused, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(short_memory_is_survived, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(cancelling_and_failing_leave_nothing, make_folder,
                                        remove_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
