// bench_transport: imperfect shadow maps in numbers, on a room with a ball whose truth is traced:
// the tables of docs/measurements/transport.md. Errors are RMS over all that the ball changes, over
// the RMS there.
//
//   bench_transport [FOLDER]      the room is photographed into FOLDER, or found there
//   bench_transport FOLDER rows [NAME]  the ways in other scenes, or in one of them, instead
//   bench_transport FOLDER cameras  what further cameras gain and take, instead
//   bench_transport FOLDER screens  times of ssao and ssdo over sizes of pictures, instead
//   bench_transport FOLDER glossy  micro's pictures of a glossy ball, even and warped, instead
#include "bench.h"

#include "capture_fixture.h"
#include "made_room.h"
#include "relight/view/view.h"
#include "world/transport/cut.h"
#include "world/transport/instant.h"

#include <stdatomic.h>
#include <sys/stat.h>

enum { HEIGHT = 96, WIDTH = 2 * HEIGHT, BOUNCES = 2 };

static char folder[256];

static const char *path_of(const char *name)
{
    static char path[4][512];
    static int next;
    char *p = path[next++ % 4];
    snprintf(p, sizeof path[0], "%s/%s", folder, name);
    return p;
}

static struct relume_light sun = {.direction = {0.55, 0.75, 0.6}, .rgb = {1, 1, 1}};

// ---------------------------------------------------------------- the room

static void photograph(const struct relume_scene_kind *kind, const char *name, const char *file,
                       int size, int samples, int light_count)
{
    struct stat is;
    const struct relume_vec3 lights[] = {sun.direction, {0, 1, 0.2}, {1, 1, 0}, {0, 0.2, 1}};
    relume_scene *scene;
    if (!stat(path_of(file), &is))
        return;
    bench_check(relume_scene_create(&scene, kind, NULL));
    bench_check(relume_scene_capture(
        scene, path_of(name),
        relume_synth_params(.projection_set = true, .projection = RELUME_SPHERICAL, .size = size,
                            .lights = lights, .light_count = light_count, .samples = samples,
                            .bounces = BOUNCES + 2)));
    relume_scene_destroy(&scene);
    bench_check(fixture_encode(path_of(name), path_of(file), &relume_basis_table, 0,
                               relume_pack_encode_params(.storage = RELUME_STORE_HALF)));
}

static relume_pack *open_pack(const char *file)
{
    relume_pack *pack;
    bench_check(relume_pack_open(&pack, path_of(file), NULL));
    return pack;
}

static relume_objects *open_ball_at(int segments, vec3 at, double radius)
{
    relume_objects *o;
    char text[512];
    snprintf(text, sizeof text,
             "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"ball.obj\","
             "\"pose\":{\"scale\":%g,\"translate\":[%g,%g,%g]},\"parts\":[{\"material\":"
             "{\"diffuse\":%g}}]}]}",
             radius, at.x, at.y, at.z, (double)ball_grey);
    FILE *file = fopen(path_of("ball.json"), "w");
    if (!file || !write_ball_mesh(path_of("ball.obj"), segments, false) || fputs(text, file) < 0 ||
        fclose(file))
        bench_check(RELUME_EIO);
    bench_check(relume_objects_open(&o, path_of("ball.json"), NULL));
    return o;
}

static relume_objects *open_ball(int segments)
{
    return open_ball_at(segments, vec3_of(ball[0], ball[1], ball[2]), ball_radius);
}

// ---------------------------------------------------------------- ways

// A way of which every number can be chosen, and what its last light took.
static struct instant_params chosen;
static double seconds[INSTANT_STAGES];
static size_t lights;

static relume_status begin(struct world *w, const struct relume_log *log)
{
    return instant_begin(w, &chosen, log);
}

static void end(struct world *w)
{
    const struct instant *s = w->state;
    memcpy(seconds, s->seconds, sizeof seconds);
    lights = s->lights;
    instant_end(w);
}

static struct relume_transport trial = {.name = "trial",
                                        .summary = "",
                                        .samples = INSTANT_SAMPLES,
                                        .begin = begin,
                                        .end = end,
                                        .gather = instant_gather};

struct shot {
    struct relume_image image;
    double seconds;
};

static const struct relume_camera unfolded = {.framing = RELUME_FRAME_VIEW};

static int bounces = BOUNCES, cameras;

static struct shot frame_of(relume_pack *pack, const relume_objects *o,
                            const struct relume_transport *way, int samples,
                            const struct relume_camera *camera)
{
    struct shot f;
    relume_renderer *renderer;
    bench_check(relume_renderer_create(&renderer, pack, NULL));
    bench_check(relume_renderer_set_lights(renderer, &sun, 1));
    bench_check(relume_renderer_set_objects(
        renderer, o,
        relume_render_params(.samples = 2, .transport = way, .transport_samples = samples,
                             .bounces = bounces, .transport_cameras = cameras)));
    const double began = processor_s();
    bench_check(relume_renderer_frame(&f.image, renderer, camera));
    f.seconds = processor_s() - began;
    relume_renderer_destroy(&renderer);
    return f;
}

static struct shot trial_of(relume_pack *pack, const relume_objects *o, struct instant_params p,
                            int samples, const struct relume_camera *camera)
{
    chosen = p;
    trial.pattern = p.pattern;
    return frame_of(pack, o, &trial, samples, camera);
}

// ---------------------------------------------------------------- errors

struct judge {
    relume_pack *room;
    relume_objects *ball;
    struct relume_image before, truth;
    struct relume_image touched;  // where this differs from before counts, too; empty: not
    const bool *left_out;         // [pixels]; NULL: none is
};

// Whether the ball changes a value.
static bool counts(const struct judge *j, size_t i)
{
    const double ENOUGH = 0.02, before = (double)j->before.data[i];
    if (j->left_out && j->left_out[i / 3])
        return false;
    return fabs((double)j->truth.data[i] - before) >= ENOUGH ||
           (j->touched.data && fabs((double)j->touched.data[i] - before) >= ENOUGH);
}

// Else a highlight of metal would be all that counts.
static double as_displayed(float value)
{
    return fmin((double)value, 1.0);
}

static double difference(const struct judge *j, const struct relume_image *got,
                         const struct relume_image *want)
{
    double wrong = 0.0, all = 0.0;
    for (size_t i = 0; i < 3 * (size_t)j->truth.width * (size_t)j->truth.height; i++) {
        if (!counts(j, i))
            continue;
        const double wanted = as_displayed(want->data[i]);
        wrong += pow(as_displayed(got->data[i]) - wanted, 2.0);
        all += pow(wanted, 2.0);
    }
    return sqrt(wrong / all);
}

// The mean of what the ball's shadow shows: where it is black as lamps alone have it.
static void print_shadow(const struct judge *j, const struct relume_image *alone,
                         const struct relume_image *got)
{
    double sum[2] = {0.0, 0.0};
    int n = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        if (!(alone->data[3 * i] < 0.02f && j->before.data[3 * i] > 0.1f))
            continue;
        sum[0] += (double)got->data[3 * i];
        sum[1] += (double)got->data[3 * i + 1];
        n++;
    }
    printf(" %.3f, %.3f |\n", sum[0] / n, sum[1] / n);
    fflush(stdout);
}

static void judge_ways(const struct judge *j)
{
    struct shot alone = frame_of(j->room, j->ball, relume_transports[0], 1, &unfolded);
    printf("\n| way | samples | error | CPU s | shadow |\n|---|---|---|---|---|\n"
           "| truth | | | |");
    print_shadow(j, &alone.image, &j->truth);
    for (const struct relume_transport *const *t = relume_transports; *t; t++)
        for (int samples = 4; samples <= 256; samples *= 4) {
            struct shot f = frame_of(j->room, j->ball, *t, samples, &unfolded);
            printf("| %s | %d | %.4f | %.3f |", relume_transport_name(*t), samples,
                   difference(j, &f.image, &j->truth), f.seconds);
            print_shadow(j, &alone.image, &f.image);
            relume_image_destroy(&f.image);
        }
}

// Fig. 5.8 and 5.10: against exact shadows of the same virtual lights, and against the truth.
static void judge_maps(const struct judge *j)
{
    static const int sizes[] = {32, 64, 128};
    enum { SIZES = sizeof sizes / sizeof *sizes, SAMPLES = 8, PATTERN = 8 };
    struct shot exact =
        trial_of(j->room, j->ball, (struct instant_params){.pattern = PATTERN, .rays = true},
                 SAMPLES, &unfolded);
    printf("\n| size | points | from exact | unfilled | from truth (exact: %.4f) | unfilled | "
           "maps, ms | "
           "unfilled |\n|---|---|---|---|---|---|---|---|\n",
           difference(j, &exact.image, &j->truth));
    for (size_t s = 0; s < SIZES; s++)
        for (size_t points = 64; points <= 4096; points *= 4) {
            double from[2][2], took[2];
            for (int unfilled = 0; unfilled < 2; unfilled++) {
                struct shot f = trial_of(j->room, j->ball,
                                         (struct instant_params){.pattern = PATTERN,
                                                                 .size = sizes[s],
                                                                 .points = points,
                                                                 .unfilled = unfilled},
                                         SAMPLES, &unfolded);
                from[unfilled][0] = difference(j, &f.image, &exact.image);
                from[unfilled][1] = difference(j, &f.image, &j->truth);
                took[unfilled] = 1e3 * seconds[INSTANT_MAPS];
                relume_image_destroy(&f.image);
            }
            printf("| %d | %zu | %.4f | %.4f | %.4f | %.4f | %.0f | %.0f |\n", sizes[s], points,
                   from[0][0], from[1][0], from[0][1], from[1][1], took[0], took[1]);
            fflush(stdout);
        }
    relume_image_destroy(&exact.image);
}

// ---------------------------------------------------------------- times

static const struct relume_camera perspective = {.framing = RELUME_FRAME_LOOK};

// The median of three; of large pictures one.
static double median_of(const struct judge *j, const relume_objects *o, struct instant_params p,
                        int samples, const struct relume_camera *camera)
{
    struct times t = {.n = 0};
    for (int i = 0; i < (camera->width < 320 ? 3 : 1); i++) {
        struct shot s = trial_of(j->room, o, p, samples, camera);
        times_add(&t, s.seconds);
        relume_image_destroy(&s.image);
    }
    return times_median(&t);
}

// A row of docs/data/transport.csv, which scripts/plot_transport.sh draws.
static void keep(const char *growth, double size, const char *what, double ms)
{
    FILE *file = fopen(path_of("growth.csv"), "a");
    if (!file || fprintf(file, "%s,%.0f,%s,%.0f\n", growth, size, what, ms) < 0 || fclose(file))
        bench_check(RELUME_EIO);
}

static void print_stages(double all)
{
    double gather = all;
    for (int i = 0; i < INSTANT_STAGES; i++) {
        printf(" %.0f |", 1e3 * seconds[i]);
        gather -= seconds[i];
    }
    printf(" %.0f | %.0f |\n", 1e3 * gather, 1e3 * all);
    fflush(stdout);
}

// Table 5.1: the same pattern at all sizes, and one that grows with them.
static void time_sizes(const struct judge *j)
{
    static const int sizes[][3] = {{320, 240, 4}, {640, 480, 4}, {1024, 768, 8}};
    puts("\n| picture | 4 x 4, s | pattern | s | exact shadows, s |\n|---|---|---|---|---|");
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const int pattern = sizes[i][2];
        struct relume_camera camera = perspective;
        camera.width = sizes[i][0], camera.height = sizes[i][1];
        const struct instant_params four = {.pattern = 4, .points = 4096},
                                    own = {.pattern = pattern, .points = 4096},
                                    rays = {.pattern = pattern, .rays = true};
        const double fixed = median_of(j, j->ball, four, 64, &camera);
        const double grown = median_of(j, j->ball, own, 1024 / pattern / pattern, &camera);
        printf("| %d x %d | %.2f | %d x %d | %.2f | %.2f |\n", camera.width, camera.height, fixed,
               pattern, pattern, grown,
               median_of(j, j->ball, rays, 1024 / pattern / pattern, &camera));
        fflush(stdout);
    }
}

#define STAGES                                                                                     \
    "lights, ms | points | maps | objects | the rest | all |\n|---|---|---|---|---|---|---|"

static void time_stages(const struct judge *j)
{
    static const struct instant_params p[] = {
        {.pattern = 8, .size = 128, .points = 4096},
        {.pattern = 8, .size = 256, .points = 8192},
        {.pattern = 8, .size = 256, .points = 8192, .unfilled = true},
        {.pattern = 8, .rays = true}};
    static const char *const name[] = {"128 x 128, 4 k points", "256 x 256, 8 k points",
                                       "the same, holes left", "exact shadows"};
    struct relume_camera camera = perspective;
    camera.width = 640, camera.height = 480;
    puts("\n| 1024 lights, 640 x 480 | " STAGES);
    for (size_t i = 0; i < sizeof p / sizeof *p; i++) {
        const double all = median_of(j, j->ball, p[i], 16, &camera);
        printf("| %s |", name[i]);
        print_stages(all);
    }
}

// Fig. 5.14: one number at a time.
static void time_growth(const struct judge *j)
{
    const struct instant_params usual = {.pattern = 8, .size = 64, .points = 1024};
    puts("\n| lights | " STAGES);
    for (int samples = 4; samples <= 256; samples *= 4) {
        const double all = median_of(j, j->ball, usual, samples, &unfolded);
        printf("| %d |", 64 * samples);
        print_stages(all);
        keep("lights", 64.0 * samples, "all", 1e3 * all);
        keep("lights", 64.0 * samples, "maps", 1e3 * seconds[INSTANT_MAPS]);
    }
    puts("\n| points | " STAGES);
    for (size_t points = 256; points <= 16384; points *= 4) {
        struct instant_params p = usual;
        p.points = points;
        const double all = median_of(j, j->ball, p, 16, &unfolded);
        printf("| %zu |", points);
        print_stages(all);
        keep("points of a map", (double)points, "all", 1e3 * all);
        keep("points of a map", (double)points, "maps", 1e3 * seconds[INSTANT_MAPS]);
    }
    puts("\n| maps | " STAGES);
    for (int size = 32; size <= 256; size *= 2) {
        struct instant_params p = usual;
        p.size = size;
        const double all = median_of(j, j->ball, p, 16, &unfolded);
        printf("| %d x %d |", size, size);
        print_stages(all);
    }
    puts("\n| triangles | " STAGES);
    for (int segments = 16; segments <= 1024; segments *= 4) {
        relume_objects *o = open_ball(segments);
        for (int rays = 0; rays < 2; rays++) {
            struct instant_params p = usual;
            p.rays = rays;
            const double all = median_of(j, o, p, 16, &unfolded);
            printf("| %d%s |", (int)relume_objects_info(o)->triangle_count,
                   rays ? ", exact shadows" : "");
            print_stages(all);
            keep("triangles", (double)relume_objects_info(o)->triangle_count,
                 rays ? "exact shadows" : "all", 1e3 * all);
        }
        relume_objects_destroy(&o);
    }
}

// ---------------------------------------------------------------- other scenes

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(path_of(name), "w");
    if (!file || fputs(text, file) < 0 || fclose(file))
        bench_check(RELUME_EIO);
}

// As glossy.obj: a ball of metal, of radius 1.
static void write_glossy_mesh(double roughness)
{
    char text[512];
    snprintf(text, sizeof text, "newmtl own\nKd 0.8 0.8 0.8\nPm 1\nPr %g\n", roughness);
    write_file("glossy.mtl", text);
    if (!write_ball_mesh(path_of("ball.obj"), 64, false))
        bench_check(RELUME_EIO);
    snprintf(text, sizeof text, "(echo mtllib glossy.mtl; echo usemtl own; cat %s) > %s",
             path_of("ball.obj"), path_of("glossy.obj"));
    bench_check(system(text) ? RELUME_EIO : RELUME_OK);
}

// A built-in scene, with a ball in it, under a sun. With a roughness the ball is of metal, and
// another one of matte grey lies beside it; the floor may be of glossy paint.
struct row {
    const char *name, *scene;
    struct relume_vec3 sun, at;
    double radius;
    int samples;
    double roughness;
    bool floor;
};
static const struct row rows[] = {
    {"cornell", "cornell", {-0.2, 1.0, -0.15}, {0.34, -0.16, -0.54}, 0.25, 1024, 0.0, false},
    {"colonnade", "colonnade", {0.8, 0.7, 0.25}, {1.0, -1.25, -0.72}, 0.35, 256, 0.0, false},
    {"metal", "room", {0.55, 0.75, 0.6}, {0.3, -0.6, -1.0}, 0.4, 512, 0.4, false},
    {"gloss", "room", {0.55, 0.75, 0.6}, {0.3, -0.6, -1.0}, 0.4, 512, 0.4, true},
};
static const struct row *row;
static const double beside[4] = {-0.4, -0.75, -1.1, 0.25};

static const struct relume_scene_kind *kind_of(const struct row *r)
{
    return strcmp(r->scene, room.name) ? relume_scene_find(r->scene) : &room;
}

static relume_status build_alone(struct relume_scene_builder *b)
{
    struct mesh part = {0};
    if (row->floor) {
        const struct material paint = {.texture = build_matte(0.5f, 0.5f, 0.5f).texture,
                                       .f0 = {0.2f, 0.2f, 0.2f},
                                       .alpha = 0.1f};
        shape_quad(&part, vec3_of(-2, -0.995, 2), vec3_of(4, 0, 0), vec3_of(0, 0, -4));
        build_put_exact(b, &part, build_material(b, paint));
    }
    return kind_of(row)->build(b);
}

static struct material material_of_ball(void)
{
    const float alpha = (float)(row->roughness * row->roughness);
    const struct material metal = {
        .texture = build_matte(0, 0, 0).texture, .f0 = {0.8f, 0.8f, 0.8f}, .alpha = alpha};
    return row->roughness > 0.0 ? metal : build_matte(ball_grey, ball_grey, ball_grey);
}

static relume_status build_with_ball(struct relume_scene_builder *b)
{
    struct mesh part = {0};
    shape_sphere(&part, row->at, row->radius, 64);
    build_put_exact(b, &part, build_material(b, material_of_ball()));
    if (row->roughness > 0.0) {
        shape_sphere(&part, vec3_of(beside[0], beside[1], beside[2]), beside[3], 64);
        build_put_exact(b, &part, build_material(b, build_matte(ball_grey, ball_grey, ball_grey)));
    }
    return build_alone(b);
}

static relume_objects *open_balls(void)
{
    relume_objects *o;
    char text[1024];
    if (!(row->roughness > 0.0))
        return open_ball_at(64, row->at, row->radius);
    write_glossy_mesh(row->roughness);
    snprintf(
        text, sizeof text,
        "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"glossy.obj\","
        "\"pose\":{\"scale\":%g,\"translate\":[%g,%g,%g]}},{\"mesh\":\"ball.obj\",\"pose\":{"
        "\"scale\":%g,\"translate\":[%g,%g,%g]},\"parts\":[{\"material\":{\"diffuse\":%g}}]}]}",
        row->radius, row->at.x, row->at.y, row->at.z, beside[3], beside[0], beside[1], beside[2],
        (double)ball_grey);
    write_file("balls.json", text);
    bench_check(relume_objects_open(&o, path_of("balls.json"), NULL));
    return o;
}

// Which pixels show the balls.
static bool *find_balls(const struct judge *j, const struct row *r)
{
    const int width = j->truth.width, height = j->truth.height;
    const vec3 at[] = {r->at, vec3_of(beside[0], beside[1], beside[2])};
    const double radius[] = {r->radius, r->roughness > 0.0 ? beside[3] : 0.0};
    bool *shows = calloc((size_t)width * (size_t)height, sizeof *shows);
    for (int i = 0; i < width * height; i++) {
        const vec3 ray = relume_panorama_ray(&relume_pack_info(j->room)->geometry, width, height,
                                             i % width + 0.5, i / width + 0.5);
        for (int k = 0; k < 2; k++) {
            const double sine = 1.05 * radius[k] / vec3_length(at[k]);
            shows[i] |= vec3_dot(ray, vec3_unit(at[k])) > sqrt(1.0 - sine * sine);
        }
    }
    return shows;
}

static void judge_row(const struct row *r)
{
    enum { SIZE = 64 };
    char name[4][64];
    struct relume_scene_kind alone = *kind_of(r), with = alone;
    struct judge j = {.touched = {0}};
    row = r;
    sun.direction = vec3_unit(r->sun);
    alone.build = build_alone;
    with.build = build_with_ball;
    snprintf(name[0], sizeof name[0], "%s", r->name);
    snprintf(name[1], sizeof name[1], "%s.exr", r->name);
    snprintf(name[2], sizeof name[2], "%s-truth", r->name);
    snprintf(name[3], sizeof name[3], "%s-truth.exr", r->name);
    photograph(&alone, name[0], name[1], SIZE, r->samples, 1);
    photograph(&with, name[2], name[3], SIZE, r->samples, 1);
    relume_pack *truth = open_pack(name[3]);
    j.room = open_pack(name[1]);
    j.ball = open_balls();
    bench_check(relume_frame(&j.before, j.room, &unfolded, &sun, 1, NULL));
    bench_check(relume_frame(&j.truth, truth, &unfolded, &sun, 1, NULL));
    struct shot lamps = frame_of(j.room, j.ball, relume_transports[0], 1, &unfolded);
    j.touched = lamps.image;
    bool *balls = find_balls(&j, r);
    printf("\n%s: without the ball %.4f\n", r->name, difference(&j, &j.before, &j.truth));
    for (const struct relume_transport *const *t = relume_transports; *t; t++)
        for (int samples = 0; samples <= 256; samples += 256) {
            struct shot f = frame_of(j.room, j.ball, *t, samples, &unfolded);
            j.left_out = NULL;
            printf("| %s | %d | %.4f |", relume_transport_name(*t), samples,
                   difference(&j, &f.image, &j.truth));
            j.left_out = balls;
            printf(" %.4f | %.2f |\n", difference(&j, &f.image, &j.truth), f.seconds);
            fflush(stdout);
            snprintf(name[0], sizeof name[0], "%s-%s-%d.exr", r->name, relume_transport_name(*t),
                     samples);
            bench_check(relume_image_save(&f.image, path_of(name[0]), NULL));
            relume_image_destroy(&f.image);
        }
    snprintf(name[2], sizeof name[2], "%s-truth-picture.exr", r->name);
    bench_check(relume_image_save(&j.truth, path_of(name[2]), NULL));
    relume_image_destroy(&j.before);
    relume_image_destroy(&j.truth);
    relume_image_destroy(&j.touched);
    free(balls);
    relume_objects_destroy(&j.ball);
    relume_pack_destroy(&j.room);
    relume_pack_destroy(&truth);
}

// ---------------------------------------------------------------- cameras

static relume_objects *open_heap(void)
{
    static const double at[][4] = {
        {0.3, -0.6, -1.0, 0.4}, {-0.35, -0.75, -1.3, 0.25}, {0.75, -0.8, -1.5, 0.2}};
    relume_objects *o;
    FILE *file = fopen(path_of("heap.json"), "w");
    if (!file || !write_ball_mesh(path_of("ball.obj"), 64, false))
        bench_check(RELUME_EIO);
    fputs("{\"format\":\"relume-objects\",\"version\":1,\"objects\":[", file);
    for (int i = 0; i < 3; i++)
        fprintf(file,
                "%s{\"mesh\":\"ball.obj\",\"pose\":{\"scale\":%g,\"translate\":[%g,%g,%g]},"
                "\"parts\":[{\"material\":{\"diffuse\":0.8}}]}",
                i ? "," : "", at[i][3], at[i][0], at[i][1], at[i][2]);
    fputs("]}", file);
    bench_check(fclose(file) ? RELUME_EIO : RELUME_OK);
    bench_check(relume_objects_open(&o, path_of("heap.json"), NULL));
    return o;
}

// Table 4.1: seconds by the size of the picture and the number of directions.
static void time_screens(relume_pack *pack)
{
    relume_objects *o = open_heap();
    static const int sizes[][2] = {{320, 240}, {512, 384}, {1024, 768}};
    static const struct {
        const struct relume_transport *way;
        int bounces, cameras;
    } ways[] = {{&transport_ssao, -1, -1},
                {&transport_ssdo, -1, -1},
                {&transport_ssdo, 1, -1},
                {&transport_ssdo, 1, 4}};
    puts("\n| size | N | ssao | ssdo | a bounce | 4 cameras |\n|---|---|---|---|---|---|");
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (int samples = 8; samples <= 16; samples *= 2) {
            struct relume_camera camera = {.framing = RELUME_FRAME_LOOK};
            camera.width = sizes[s][0], camera.height = sizes[s][1];
            printf("| %d x %d | %d |", camera.width, camera.height, samples);
            for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
                bounces = ways[i].bounces, cameras = ways[i].cameras;
                struct shot f = frame_of(pack, o, ways[i].way, samples, &camera);
                printf(" %.2f |", f.seconds);
                fflush(stdout);
                relume_image_destroy(&f.image);
            }
            puts("");
        }
    bounces = BOUNCES, cameras = 0;
    relume_objects_destroy(&o);
}

// What further cameras gain and take, against paths.
static void judge_cameras(relume_pack *pack)
{
    static const int numbers[] = {0, 1, 2, 4, 8};
    struct judge j = {.room = pack};
    for (int heap = 0; heap < 2; heap++) {
        j.ball = heap ? open_heap() : open_ball(64);
        struct shot truth = frame_of(pack, j.ball, &transport_path, 1024, &unfolded);
        bench_check(relume_frame(&j.before, pack, &unfolded, &sun, 1, NULL));
        j.truth = truth.image;
        for (int way = 0; way < 2; way++)
            for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
                cameras = numbers[i] ? numbers[i] : -1;
                printf("| %s, %s | %d |", heap ? "three balls" : "a ball", way ? "ssdo" : "ssao",
                       numbers[i]);
                for (int samples = 8; samples <= 64; samples *= 2) {
                    struct shot f = frame_of(pack, j.ball, way ? &transport_ssdo : &transport_ssao,
                                             samples, &unfolded);
                    printf(" %.4f, %.2f |", difference(&j, &f.image, &j.truth), f.seconds);
                    relume_image_destroy(&f.image);
                }
                puts("");
                fflush(stdout);
            }
        relume_image_destroy(&j.before);
        relume_image_destroy(&j.truth);
        relume_objects_destroy(&j.ball);
    }
    cameras = 0;
}

// ---------------------------------------------------------------- glossy

static double processor_of_thread(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static atomic_long glossy_places, glossy_nanoseconds;
static bool even;

// As micro does, of the ball alone.
static void gather_glossy(const struct world *w, const struct site *site, take_arrival *arrive,
                          void *context)
{
    struct site one = *site;
    if (!site->answer)
        return;
    if (even)
        one.answer = NULL;
    const double began = processor_of_thread();
    transport_micro.gather(w, &one, arrive, context);
    atomic_fetch_add(&glossy_places, 1);
    atomic_fetch_add(&glossy_nanoseconds, (long)(1e9 * (processor_of_thread() - began)));
}

// The same light by a ray through each of many squares of the disc of directions.
static void gather_by_rays(const struct world *w, const struct site *site, take_arrival *arrive,
                           void *context)
{
    enum { FINE = 80 };
    struct cut_place place;
    if (!site->answer)
        return;
    cut_place_at(&place, NULL, site->start, site->normal);
    for (int i = 0; i < FINE * FINE; i++) {
        const float u = 2.0f * ((float)(i % FINE) + 0.5f) / FINE - 1.0f;
        const float v = 2.0f * ((float)(i / FINE) + 0.5f) / FINE - 1.0f;
        if (u * u + v * v >= 1.0f)
            continue;
        const struct cut_pixel pixel = {.direction = {u, v, sqrtf(1.0f - u * u - v * v)}};
        struct arrival a = {.towards = cut_direction(&place, &pixel),
                            .share = 4.0 / (FINE * FINE * M_PI)};
        struct scenery_hit hit;
        (void)scenery_meet(&hit, w->scenery, site->start, a.towards);
        const double part = hit.distance < INFINITY
                                ? w->dimmed(w->context, hit.place, hit.normal, (uint64_t)i)
                                : 1.0;
        for (int c = 0; c < 3; c++)
            a.without[c] = hit.sent[c], a.with[c] = (float)part * hit.sent[c];
        arrive(context, &a);
    }
}

static relume_objects *open_glossy_ball(double roughness)
{
    relume_objects *o;
    char text[512];
    write_glossy_mesh(roughness);
    snprintf(text, sizeof text,
             "{\"format\":\"relume-objects\",\"version\":1,\"objects\":[{\"mesh\":\"glossy.obj\","
             "\"pose\":{\"scale\":%g,\"translate\":[%g,%g,%g]}}]}",
             ball_radius, ball[0], ball[1], ball[2]);
    write_file("glossy.json", text);
    bench_check(relume_objects_open(&o, path_of("glossy.json"), NULL));
    return o;
}

// Over pixels of the ball, all of whose light is what it has gathered.
static double glossy_difference(const struct relume_image *got, const struct relume_image *want,
                                const struct relume_geometry *geometry)
{
    const vec3 at = vec3_of(ball[0], ball[1], ball[2]);
    const double within = sqrt(1.0 - pow(0.95 * ball_radius / vec3_length(at), 2.0));
    double wrong = 0.0, all = 0.0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        const vec3 ray = relume_panorama_ray(geometry, WIDTH, HEIGHT, (double)(i % WIDTH) + 0.5,
                                             (double)(i / WIDTH) + 0.5);
        for (size_t c = 3 * i; c < 3 * i + 3 && vec3_dot(ray, vec3_unit(at)) > within; c++) {
            wrong += pow((double)got->data[c] - (double)want->data[c], 2.0);
            all += pow((double)want->data[c], 2.0);
        }
    }
    return sqrt(wrong / all);
}

static void judge_glossy(relume_pack *pack)
{
    static const int sides[] = {8, 16, 24};
    static const double roughness[] = {0.25, 0.4, 0.6};
    struct relume_transport rays = transport_path, micro = transport_micro;
    rays.gather = gather_by_rays;
    micro.gather = gather_glossy;
    micro.spacing = 1;
    puts("| roughness | pixels | even | us a place | warped | us a place "
         "|\n|---|---|---|---|---|---|");
    for (size_t r = 0; r < sizeof roughness / sizeof *roughness; r++) {
        char name[64];
        relume_objects *o = open_glossy_ball(roughness[r]);
        struct shot truth = frame_of(pack, o, &rays, 1, &unfolded);
        snprintf(name, sizeof name, "glossy-%g.exr", roughness[r]);
        bench_check(relume_image_save(&truth.image, path_of(name), NULL));
        for (size_t s = 0; s < sizeof sides / sizeof *sides; s++) {
            printf("| %g | %d x %d |", roughness[r], sides[s], sides[s]);
            for (int k = 0; k < 2; k++) {
                even = !k;
                atomic_store(&glossy_places, 0);
                atomic_store(&glossy_nanoseconds, 0);
                struct shot f = frame_of(pack, o, &micro, sides[s] * sides[s], &unfolded);
                printf(" %.4f | %.0f |",
                       glossy_difference(&f.image, &truth.image, &relume_pack_info(pack)->geometry),
                       1e-3 * (double)atomic_load(&glossy_nanoseconds) /
                           (double)atomic_load(&glossy_places));
                snprintf(name, sizeof name, "glossy-%g-%d-%s.exr", roughness[r], sides[s],
                         even ? "even" : "warped");
                bench_check(relume_image_save(&f.image, path_of(name), NULL));
                relume_image_destroy(&f.image);
            }
            puts("");
            fflush(stdout);
        }
        relume_image_destroy(&truth.image);
        relume_objects_destroy(&o);
    }
}

int main(int argc, char **argv)
{
    struct judge j = {.touched = {0}};
    snprintf(folder, sizeof folder, "%s", argc > 1 ? argv[1] : "/tmp/bench-transport-XXXXXX");
    if (argc > 1 ? mkdir(folder, 0777) && access(folder, W_OK) : !mkdtemp(folder))
        bench_check(RELUME_EIO);
    if (argc > 2 && !strcmp(argv[2], "glossy")) {
        photograph(&room, "room", "room.exr", HEIGHT, 256, 4);
        j.room = open_pack("room.exr");
        judge_glossy(j.room);
        relume_pack_destroy(&j.room);
        return 0;
    }
    if (argc > 2 && (!strcmp(argv[2], "cameras") || !strcmp(argv[2], "screens"))) {
        photograph(&room, "room", "room.exr", HEIGHT, 256, 4);
        j.room = open_pack("room.exr");
        if (!strcmp(argv[2], "cameras"))
            judge_cameras(j.room);
        else
            time_screens(j.room);
        relume_pack_destroy(&j.room);
        return 0;
    }
    if (argc > 2) {
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
            if (argc < 4 || !strcmp(argv[3], rows[i].name))
                judge_row(&rows[i]);
        return 0;
    }
    photograph(&room, "room", "room.exr", HEIGHT, 256, 4);
    photograph(&room_with_ball, "truth", "truth.exr", HEIGHT, 256, 4);
    relume_pack *truth = open_pack("truth.exr");
    j.room = open_pack("room.exr");
    j.ball = open_ball(64);
    bench_check(relume_frame(&j.before, j.room, &unfolded, &sun, 1, NULL));
    bench_check(relume_frame(&j.truth, truth, &unfolded, &sun, 1, NULL));
    judge_maps(&j);
    judge_ways(&j);
    time_sizes(&j);
    time_stages(&j);
    time_growth(&j);
    relume_image_destroy(&j.before);
    relume_image_destroy(&j.truth);
    relume_objects_destroy(&j.ball);
    relume_pack_destroy(&j.room);
    relume_pack_destroy(&truth);
    return 0;
}
