// bench_viewer.c - frames of a panorama while the light moves: codebook, planes, many lights, near
// lights. On a graphics card where EGL finds one, else by llvmpipe.
// Usage: bench_viewer [WIDTHxHEIGHT [library]]; default 1024x512 in software, 3840x2160 on a card
//        bench_viewer open FILE: a relume file, from the name to the first picture
#include "bench.h"

#include "draw/draw.h"
#include "relight/light/environment.h"
#include "relight/view/view.h"
#include "relit/gl_relighter.h"
#include "session/session.h"
#include "window/context_offscreen.h"

enum { CODES = 4096, RUNS = 9, LIGHTS = 1000, MOST_PLANES = 75 };

static struct gl gl;
static bool by_library;
static int width, height;

struct file {
    relume_coder *coder;
    struct relume_codes codes;
    uint16_t *index;
    float *vectors;
    uint8_t *bytes;
};

static relume_status fetch(const struct relume_codes **out, void *user, int view)
{
    (void)view;
    *out = &((struct file *)user)->codes;
    return RELUME_OK;
}

// The inside of a ball around the eye.
static relume_status find_surface(struct relume_image *out, void *user, int view)
{
    (void)user, (void)view;
    const struct relume_geometry g = relume_geometry_default(RELUME_SPHERICAL, width, height);
    const relume_status status = relume_image_create(out, width, height, 3);
    for (int i = 0; !status && i < width * height; i++) {
        const struct relume_vec3 d =
            relume_panorama_ray(&g, width, height, i % width + 0.5, i / width + 0.5);
        out->data[3 * i] = (float)(3.0 * d.x);
        out->data[3 * i + 1] = (float)(3.0 * d.y);
        out->data[3 * i + 2] = (float)(3.0 * d.z);
    }
    return status;
}

static float noise(size_t i)
{
    return (float)(i * 2654435761u >> 8 & 0xffff) / 65536.0f;
}

static struct file make_file(bool book)
{
    static float scale[MOST_PLANES], offset[MOST_PLANES];
    static const void *plane[MOST_PLANES];
    static const uint16_t *index[1];
    static const float *vectors[1];
    static const int count = CODES;
    struct relume_vec3 lights[100];
    struct file f = {.coder = NULL};
    const size_t pixels = (size_t)width * (size_t)height;
    bench_check(relume_directions_make(lights, 100, relume_pattern_find("hammersley"), NULL));
    bench_check(relume_coder_create(&f.coder, &relume_basis_sh, lights, 100,
                                    relume_coder_params(.coefficients = 25, .pole_y = true)));
    f.index = calloc(pixels, sizeof *f.index);
    f.vectors = calloc((size_t)CODES * MOST_PLANES, sizeof *f.vectors);
    f.bytes = calloc(pixels, MOST_PLANES);
    for (size_t i = 0; i < pixels; i++)
        f.index[i] = (uint16_t)((i / 9 + i / (size_t)width / 7 * 31) % CODES);
    for (size_t i = 0; i < (size_t)CODES * MOST_PLANES; i++)
        f.vectors[i] = noise(i) - 0.4f;
    for (size_t i = 0; i < pixels * MOST_PLANES; i++)
        f.bytes[i] = (uint8_t)(255.0f * noise(i));
    for (int p = 0; p < MOST_PLANES; p++) {
        scale[p] = 1e-3f;
        plane[p] = f.bytes + (size_t)p * pixels;
    }
    index[0] = f.index;
    vectors[0] = f.vectors;
    f.codes = (struct relume_codes){
        .coder = f.coder,
        .domain = book ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR,
        .display = {.curve = RELUME_CURVE_SRGB},
        .width = width,
        .height = height,
        .planes = MOST_PLANES,
        .storage = RELUME_STORE_8,
        .plane = plane,
        .scale = scale,
        .offset = offset,
        .books = book ? 1 : 0,
        .index = index,
        .vectors = vectors,
        .book_codes = &count,
    };
    return f;
}

static void free_file(struct file *f)
{
    relume_coder_destroy(&f->coder);
    free(f->index);
    free(f->vectors);
    free(f->bytes);
}

static int moving = LIGHTS;  // so many of them, the first

// Lights that differ from run to run, as a hand would move them.
static void move_lights(struct relume_light *lights, int n, enum relume_light_kind kind, int run)
{
    for (int i = 0; i < n; i++) {
        const double a = 0.7 * i + (i < moving ? 0.05 * run : 0.0);
        lights[i] = (struct relume_light){
            .kind = kind,
            .direction = {cos(a), 0.3, sin(a)},
            .position = {0.5 * sin(a), 0.2, 0.5 * cos(a)},
            .half_angle_deg = 30.0,
            .rgb = {1.0f / (float)n, 1.0f / (float)n, 1.0f / (float)n},
        };
    }
}

struct scene {
    struct gl_relighter relighter;
    struct program panorama;
    struct target frame;
};

// Relight and look ahead: what a window does between a drag and the picture. Seconds.
static double draw_frame(struct scene *s, const struct relume_light *lights, int n)
{
    const struct relume_geometry g = relume_geometry_default(RELUME_SPHERICAL, width, height);
    const struct frame_area area = {.width = width, .height = height, .exposure = 1.0f};
    const struct target *view;
    const double start = now_s();
    bench_check(gl_relighter_begin(&s->relighter, lights, n));
    bench_check(gl_relighter_view(&view, &s->relighter, 0));
    gl.BindVertexArray(s->relighter.vertices);
    target_begin(&s->frame, &gl);
    draw_panorama(&s->panorama, &gl, &area, &g, (struct relume_pan_tilt){.zoom = 1.0}, view);
    gl.Finish();
    return now_s() - start;
}

static double measure(struct scene *s, const char *what, int n, enum relume_light_kind kind,
                      const struct relume_light *environment)
{
    static struct relume_light lights[LIGHTS + 1];
    struct times b = {.n = 0};
    const int all = n + (environment != NULL);
    for (int run = -1; run < RUNS; run++) {  // the first uploads
        move_lights(lights, n, kind, run);
        if (environment)
            lights[n] = *environment;
        const double t = draw_frame(s, lights, all);
        if (run >= 0)
            times_add(&b, t);
    }
    bench_print(what, &b);
    return times_median(&b);
}

static void open_scene(struct scene *s, struct file *f)
{
    const struct code_source source = {.codes = fetch, NULL, f, find_surface};
    *s = (struct scene){.frame = {0}};
    bench_check(gl_relighter_create(&s->relighter, &gl, &source, 1, NULL));
    s->relighter.by_library = by_library;
    const struct relume_geometry sphere = {.projection = RELUME_SPHERICAL};
    bench_check(draw_panorama_create(&s->panorama, &gl, &sphere, NULL));
    bench_check(target_create(&s->frame, &gl, width, height, NULL));
}

static void close_scene(struct scene *s)
{
    target_destroy(&s->frame, &gl);
    program_destroy(&s->panorama, &gl);
    gl_relighter_destroy(&s->relighter);
}

static void bench_codebook(void)
{
    struct file f = make_file(true);
    struct scene s;
    open_scene(&s, &f);
    const double t =
        measure(&s, "codebook of 4096, one light moves", 1, RELUME_LIGHT_DIRECTIONAL, NULL);
    printf("    %.0f frames/s (target 30 without a graphics card)\n", 1.0 / t);
    close_scene(&s);
    free_file(&f);
}

static void bench_planes(void)
{
    static const int counts[] = {1, 10, 100, 1000};
    struct file f = make_file(false);
    struct relume_image map;
    relume_environment *sky;
    struct scene s;
    bench_check(relume_image_create(&map, 256, 128, 3));
    for (int i = 0; i < 256 * 128 * 3; i++)
        map.data[i] = noise((size_t)i);
    bench_check(relume_environment_create(&sky, &map, NULL));
    const struct relume_light environment = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .environment = sky, .rgb = {1, 1, 1}};
    open_scene(&s, &f);
    for (int i = 0; i < 4; i++) {
        char what[64];
        snprintf(what, sizeof what, "75 planes, %d directional", counts[i]);
        measure(&s, what, counts[i], RELUME_LIGHT_DIRECTIONAL, NULL);
    }
    const double all = measure(&s, "75 planes, environment and 8 directional", 8,
                               RELUME_LIGHT_DIRECTIONAL, &environment);
    printf("    %.1f GB/s of coefficients\n", (double)width * height * MOST_PLANES / all * 1e-9);
    const double near = measure(&s, "75 planes, 8 spots", 8, RELUME_LIGHT_SPOT, NULL);
    printf("    %.1f frames/s (target 60 on a graphics card)\n", 1.0 / near);
    measure(&s, "75 planes, 8 points", 8, RELUME_LIGHT_POINT, NULL);
    moving = 1;
    measure(&s, "75 planes, 8 spots, one of them moves", 8, RELUME_LIGHT_SPOT, NULL);
    measure(&s, "75 planes, 8 points, one of them moves", 8, RELUME_LIGHT_POINT, NULL);
    moving = LIGHTS;
    close_scene(&s);
    relume_environment_destroy(&sky);
    relume_image_destroy(&map);
    free_file(&f);
}

// ---------------------------------------------------------------- opening

static void say_so(void *user, enum relume_level level, const char *text)
{
    (void)user, (void)level;
    fprintf(stderr, "%s\n", text);
}

static int bench_opening(const struct context_backend *backend, const char *path)
{
    static const struct relume_log log = {.message = say_so};
    static const char *const what[] = {"open the file", "make OpenGL ready", "first frame",
                                       "light moved, next frame"};
    struct times bench[4] = {{.n = 0}};
    for (int run = 0; run < RUNS; run++) {
        struct session s = {.log = &log, .settings = {.vram_bytes = (size_t)1 << 30}};
        struct app_state start = {.lights = 0};
        relume_rig *rig = NULL;
        double then = now_s();
        bench_check(session_take_rig(&s, &rig, &start));
        for (int step = 0; step < 4; step++) {
            if (step == 0)
                bench_check(session_open(&s, path, &start, true));
            else if (step == 1)
                bench_check(session_start(&s, backend, s.app.width, s.app.height));
            else
                bench_check(session_draw(&s));
            if (step)
                s.window.gl.Finish();
            times_add(&bench[step], now_s() - then);
            app_turn_light(&s.app, 10, 0);
            then = now_s();
        }
        session_close(&s);
    }
    for (int step = 0; step < 4; step++)
        bench_print(what[step], &bench[step]);
    return 0;
}

int main(int argc, char **argv)
{
    void *context;
    const struct context_backend *backend = context_offscreen("auto");
    if (argc == 3 && !strcmp(argv[1], "open"))
        return bench_opening(backend, argv[2]);
    const bool card = backend == &context_egl_card;
    width = card ? 3840 : 1024;
    height = card ? 2160 : 512;
    if (argc > 1 && sscanf(argv[1], "%5dx%5d", &width, &height) != 2)
        return 2;
    bench_check(backend->open(&context, 1, 1, "", NULL));
    bench_check(gl_load(&gl, backend->get_proc, NULL));
    printf("viewer: panorama of %d x %d, frame of the same size, drawn by %s\n", width, height,
           backend->name);
    for (int i = argc > 2; i < 2; i++) {  // a second argument: by the library alone
        by_library = i;
        printf("%s\n", by_library ? "relit by the library" : "relit by passes");
        bench_codebook();
        bench_planes();
    }
    backend->close(context);
    return 0;
}
