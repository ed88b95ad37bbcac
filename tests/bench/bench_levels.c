// Levels of detail in a film of 60 distances, frame by frame.
//
//   bench_levels MESH [PIXELS [SAMPLES]]: N x N rays a pixel, else 4 x 4
//
// A matte mesh under one lamp with shadows, from 2 to 120 diagonals, a field of view that shows all
// of it at 2. For each frame: triangles, JND to the picture of the full mesh, and the pop: JND
// between this eye's pictures of the surface now and of the one of the frame before. Then the same
// where levels change at once: each frame has the level's own surface.
#include "world/object/drawn_objects.h"

#include "bench.h"

#include <math.h>
#include <relume/image.h>
#include <relume/image/jnd.h>
#include <relume/world/object.h>
#define RELUME_VEC3_SHORT
#include <relume/core/vec.h>
#include <string.h>
#include <unistd.h>

enum { FRAMES = 60, SIDE = 160 };

static int samples = 4;

static relume_objects *open_mesh(const char *mesh, double pixels)
{
    char path[] = "/tmp/relume-levels-XXXXXX";
    FILE *file = fdopen(mkstemp(path), "w");
    relume_objects *o = NULL;
    fprintf(file,
            "{\"format\": \"relume-objects\", \"version\": 1, \"objects\": [{\"mesh\": \"%s\", ",
            mesh);
    if (pixels > 0.0)
        fprintf(file, "\"levels\": %g, ", pixels);
    fprintf(file, "\"parts\": [{\"material\": {\"diffuse\": [0.8, 0.5, 0.3]}}]}]}");
    fclose(file);
    const relume_status status = relume_objects_open(&o, path, NULL);
    unlink(path);
    if (status)
        exit(1);
    return o;
}

static struct relume_image picture(const relume_objects *o, const struct relume_window *w)
{
    const struct relume_light light = {
        .kind = RELUME_LIGHT_DIRECTIONAL, .direction = {-0.48, 0.6, 0.64}, .rgb = {1, 1, 1}};
    struct relume_image image;
    if (relume_image_create(&image, SIDE, SIDE, 3) ||
        relume_objects_render(&image, o, w, &light, 1, relume_render_params(.samples = samples)))
        exit(1);
    return image;
}

static struct relume_jnd jnd_of(const struct relume_image *a, const struct relume_image *b)
{
    struct relume_jnd jnd;
    bench_check(relume_image_jnd(&jnd, NULL, a, b, NULL));
    return jnd;
}

struct film {
    const relume_objects *full, *levels;
    double diagonal, pixel;
    vec3 middle;
};

static vec3 eye_of(const struct film *f, double diagonals)
{
    return vec3_along(f->middle, vec3_unit(vec3_of(0.4, 0.35, 1.0)), diagonals * f->diagonal);
}

static relume_objects *shown_at(const struct film *f, double diagonals, bool rays)
{
    relume_objects *shown = NULL;
    if (relume_objects_shown(&shown, f->levels, eye_of(f, diagonals), f->pixel, rays))
        exit(1);
    return shown;
}

static const relume_objects *drawn(const struct film *f, const relume_objects *shown)
{
    return shown ? shown : f->full;
}

static size_t triangles_of(const struct film *f, const relume_objects *shown)
{
    return relume_objects_info(drawn(f, shown))->triangle_count;
}

// The surface of the level in use there, on no way to the next: as where it begins.
static relume_objects *unmoved_at(const struct film *f, double diagonals)
{
    relume_objects *shown = shown_at(f, diagonals, false);
    const size_t n = triangles_of(f, shown);
    double from = 0.5, to = diagonals;
    for (int i = 0; i < 20; i++) {
        const double middle = 0.5 * (from + to);
        relume_objects *other = shown_at(f, middle, false);
        *(triangles_of(f, other) == n ? &to : &from) = middle;
        relume_objects_destroy(&other);
    }
    relume_objects_destroy(&shown);
    return n == relume_objects_info(f->full)->triangle_count ? NULL : shown_at(f, to, true);
}

// What is kept of a film: the worst of its frames.
struct worst {
    double pop, pops, off, step;  // JND in any pixel; in 1 % of them; likewise off; between frames
    int popped;
};

struct frame {
    relume_objects *shown;
    struct relume_image image;
};

static void add_frame(struct worst *w, struct frame *before, struct frame now, const struct film *f,
                      const struct relume_window *window, const struct relume_image *full)
{
    struct relume_jnd pop = {.max = 0.0};
    now.image = picture(drawn(f, now.shown), window);
    if (before->image.data) {
        struct relume_image kept = picture(drawn(f, before->shown), window);
        pop = jnd_of(&now.image, &kept);
        relume_image_destroy(&kept);
        w->step = fmax(w->step, jnd_of(&now.image, &before->image).most);
    }
    w->pop = fmax(w->pop, pop.max);
    w->pops = fmax(w->pops, pop.most);
    w->popped += pop.most > 1.0;
    w->off = fmax(w->off, jnd_of(&now.image, full).most);
    printf("  %zu triangles, pop %.2f, 1 %% %.2f, off %.2f;", triangles_of(f, now.shown), pop.max,
           pop.most, jnd_of(&now.image, full).most);
    relume_objects_destroy(&before->shown);
    relume_image_destroy(&before->image);
    *before = now;
}

static void shoot(const struct film *f)
{
    struct worst way = {0}, once = {0};
    struct frame before[2] = {{0}};
    struct relume_image last = {0};
    double step = 0.0;
    for (int i = 0; i < FRAMES; i++) {
        const double d = 2.0 * pow(30.0, (double)i / (FRAMES - 1));
        const struct relume_look_at look = {.field_of_view_deg = 2.0 * atan(0.25) * 180.0 / M_PI};
        struct relume_window w;
        if (!relume_objects_window(&w, f->full, eye_of(f, d), &look, SIDE, SIDE))
            exit(1);
        struct relume_image full = picture(f->full, &w);
        if (last.data)
            step = fmax(step, jnd_of(&full, &last).most);
        printf("%2d %5.1f:", i, d);
        add_frame(&way, &before[0], (struct frame){.shown = shown_at(f, d, true)}, f, &w, &full);
        add_frame(&once, &before[1], (struct frame){.shown = unmoved_at(f, d)}, f, &w, &full);
        printf("\n");
        relume_image_destroy(&last);
        last = full;
    }
    printf("on the way: pop %.2f, 1 %% %.2f in %d frames; off %.2f; frames %.2f, full %.2f\n",
           way.pop, way.pops, way.popped, way.off, way.step, step);
    printf("at once:    pop %.2f, 1 %% %.2f in %d frames; off %.2f; frames %.2f, full %.2f\n",
           once.pop, once.pops, once.popped, once.off, once.step, step);
}

int main(int argc, char **argv)
{
    if (argc < 2)
        return 2;
    if (argc > 3)
        samples = atoi(argv[3]);
    setvbuf(stdout, NULL, _IOLBF, 0);
    const double start = now_s();
    struct film f = {.full = open_mesh(argv[1], 0.0)};
    const double opened = now_s();
    f.levels = open_mesh(argv[1], argc > 2 ? atof(argv[2]) : 0.25);
    const struct relume_objects_info *info = relume_objects_info(f.full);
    printf("%zu triangles; opened in %.2f s, with levels %.2f s\n", info->triangle_count,
           opened - start, now_s() - opened);
    f.diagonal = vec3_length(vec3_sub(info->max, info->min));
    f.middle = vec3_scale(vec3_add(info->min, info->max), 0.5);
    f.pixel = 0.5 / SIDE;
    shoot(&f);
    return 0;
}
