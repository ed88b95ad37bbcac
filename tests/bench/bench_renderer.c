// bench_renderer.c FILE - another light on the same view: a renderer against the bare kernel and
// against relume_frame, which keeps nothing; of a slab also one ray, by its texels and by whole
// views
#include "relight/frame/renderer_views.h"

#include "bench.h"

enum { RUNS = 41 };

static struct relume_light light_of(int i)
{
    return (struct relume_light){.direction = {0.3, 0.02 * i, 0.8}, .rgb = {1, 1, 1}};
}

static struct relume_image image_like(const struct relume_pack_info *info)
{
    struct relume_image image;
    bench_check(relume_image_create(&image, info->width, info->height, 3));
    return image;
}

static void compare(relume_pack *pack)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const struct relume_camera view = {.framing = RELUME_FRAME_VIEW};
    struct relume_image image = image_like(info);
    uint8_t *rgba8 = malloc(4 * (size_t)info->width * (size_t)info->height);
    const struct relume_codes *codes;
    struct times kernel = {.n = 0}, drawn = kernel, kernel8 = kernel, drawn8 = kernel,
                 frame = kernel;
    struct relume_target floats = {
        .data = image.data, .width = info->width, .height = info->height};
    struct relume_target bytes = floats;
    relume_renderer *r;
    bytes.data = rgba8;
    bytes.format = RELUME_TARGET_RGBA8;
    bench_check(relume_pack_codes(&codes, pack, 0));
    bench_check(relume_renderer_create(&r, pack, NULL));
    for (int i = 0; i < RUNS; i++) {
        const struct relume_light light = light_of(i);
        struct relume_image fresh;
        double t = now_s();
        bench_check(relume_relight(&image, codes, &light, 1, NULL));
        times_add(&kernel, now_s() - t);
        t = now_s();
        bench_check(relume_renderer_set_lights(r, &light, 1));
        bench_check(relume_renderer_draw(r, &view, &floats));
        times_add(&drawn, now_s() - t);
        t = now_s();
        bench_check(relume_relight_rgba8(rgba8, codes, &light, 1, NULL));
        times_add(&kernel8, now_s() - t);
        t = now_s();
        bench_check(relume_renderer_set_lights(r, &light, 1));
        bench_check(relume_renderer_draw(r, &view, &bytes));
        times_add(&drawn8, now_s() - t);
        t = now_s();
        bench_check(relume_frame(&fresh, pack, &view, &light, 1, NULL));
        times_add(&frame, now_s() - t);
        relume_image_destroy(&fresh);
    }
    printf("%d x %d, another light each time\n", info->width, info->height);
    bench_print("relume_relight", &kernel);
    bench_print("renderer, RGB", &drawn);
    bench_print("relume_relight_rgba8", &kernel8);
    bench_print("renderer, RGBA8", &drawn8);
    bench_print("relume_frame", &frame);
    printf("  renderer / bare kernel: RGB %.3f, RGBA8 %.3f (target 1.1)\n",
           times_median(&drawn) / times_median(&kernel),
           times_median(&drawn8) / times_median(&kernel8));
    relume_renderer_destroy(&r);
    relume_image_destroy(&image);
    free(rgba8);
}

// Rays through one point of the window: so many that whole views are relit, or one, whose texels
// are.
static void compare_rays(relume_pack *pack)
{
    enum { MANY = 65, SINGLE = 200 };
    struct relume_ray rays[MANY];
    float(*rgb)[3] = malloc(MANY * sizeof *rgb);
    struct times whole = {.n = 0}, texels = whole;
    relume_renderer *r;
    for (int i = 0; i < MANY; i++)
        rays[i] = (struct relume_ray){{0.01, 0.02, 3.5}, {0.02, -0.03, -1}};
    bench_check(relume_renderer_create(&r, pack, NULL));
    bench_check(relume_renderer_rays(rgb, r, rays, MANY));  // reads the views
    for (int i = 0; i < RUNS; i++) {
        struct relume_light light = light_of(i);
        double t = now_s();
        bench_check(relume_renderer_set_lights(r, &light, 1));
        bench_check(relume_renderer_rays(rgb, r, rays, MANY));
        times_add(&whole, now_s() - t);
        t = now_s();
        for (int k = 0; k < SINGLE; k++) {
            light.direction.x += 1e-4;
            bench_check(relume_renderer_set_lights(r, &light, 1));
            bench_check(relume_renderer_rays(rgb, r, rays, 1));
        }
        times_add(&texels, (now_s() - t) / SINGLE);
    }
    bench_print("many rays, whole views", &whole);
    bench_print("one ray, its texels", &texels);
    printf("  whole views / texels: %.0f (target 1000)\n",
           times_median(&whole) / times_median(&texels));
    relume_renderer_destroy(&r);
    free(rgb);
}

int main(int argc, char **argv)
{
    relume_pack *pack;
    if (argc < 2)
        return 0;
    bench_check(relume_pack_open(&pack, argv[1], NULL));
    compare(pack);
    if (relume_pack_info(pack)->geometry.projection == RELUME_SLAB)
        compare_rays(pack);
    relume_pack_destroy(&pack);
    return 0;
}
