// synth.c - relume_scene_capture: every view under every light into a capture folder
#include "core/base/arena.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/names.h"
#include "core/base/outdir.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "image/geometry/geometry.h"
#include "world/stage/render.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

// Images of as many lights as fit here are held at once; beyond that a view is walked again.
static const size_t HELD_BYTES = (size_t)512 << 20;

// How many slabs stand around the object, and how far they overlap.
static const int ring_around[] = {
    [RELUME_RING_NONE] = 0, [RELUME_RING_4] = 4,    [RELUME_RING_6] = 6,
    [RELUME_RING_8] = 8,    [RELUME_RING_CUBE] = 4,
};
static const double overlap = 1.15;

struct synth {
    const relume_scene *scene;
    struct relume_synth_params p;  // defaults filled in
    enum relume_projection projection;
    int width, height, disc;
    struct relume_geometry geometry;
    int slabs;  // 0: one, or no slab at all
    struct relume_geometry slab[RELUME_MOST_SLABS];
    int views;
    double (*uv)[2];  // [views]
    int *slab_of;     // [views]
    struct arena arena;
    struct relume_manifest_view *view;
    const char *folder;
    int view_now, lights_before;  // for progress
};

static int or_default(int value, int otherwise)
{
    return value ? value : otherwise;
}

// `size` is within the limits of a side, so nothing overflows.
static void choose_size(struct synth *s)
{
    const int size = s->p.size;
    s->width = size;
    s->height = size;
    if (s->projection == RELUME_CYLINDRICAL)
        s->width = 4 * size;
    // A disc's rim is as long as the cylinder is around.
    if (s->projection == RELUME_CYLINDRICAL && s->p.discs)
        s->disc = (int)fmax(lround(s->width / M_PI), 1);
    s->height += s->disc;
    if (s->projection == RELUME_SPHERICAL)
        s->width = 2 * size;
    if (s->projection == RELUME_CUBE)
        s->width = 6 * size;
}

static relume_status expected(const struct synth *s, const char *what, const char *range, int found)
{
    return log_fail(s->p.log, RELUME_EINVAL, "%s: expected %s; found %d", what, range, found);
}

static relume_status check(const struct synth *s)
{
    const struct relume_synth_params *p = &s->p;
    const struct relume_limits limits = limits_or_default(limits_of(NULL, p->log));
    if (!relume_projection_name(s->projection))
        return expected(s, "projection", "planar, slab, cylindrical, spherical or cube",
                        (int)s->projection);
    if (!limits_allow(&limits, s->width, s->height))
        return expected(s, "size", "1 or more, and an image of at most --max-pixels", p->size);
    if (p->light_count < 1 || p->light_count > limits.max_lights)
        return expected(s, "lights", "1 to 65536", p->light_count);
    for (int i = 0; p->near && i < p->light_count; i++)
        if (!(vec3_length(p->lights[i]) > 1e-6))
            return log_fail(p->log, RELUME_EINVAL,
                            "lamps: expected places apart from 0,0,0, where their strength is "
                            "measured; found %g,%g,%g",
                            p->lights[i].x, p->lights[i].y, p->lights[i].z);
    if (p->samples < 1 || p->samples > 65536)
        return expected(s, "samples", "1 to 65536", p->samples);
    if (p->bounces < 0 || p->bounces > 64)
        return expected(s, "bounces", "0 to 64", p->bounces);
    for (int i = 0; i < 2; i++)
        if (s->projection == RELUME_SLAB && (p->grid[i] < 1 || p->grid[i] > 256))
            return expected(s, "views", "a grid of 1 to 256 by 1 to 256", p->grid[i]);
    if (p->ring && s->projection != RELUME_SLAB)
        return log_fail(p->log, RELUME_EINVAL, "slabs: expected a slab; found a %s capture",
                        relume_projection_name(s->projection));
    if (p->ring && p->eye_count)
        return log_fail(p->log, RELUME_EINVAL,
                        "slabs: expected a grid of cameras; found eyes of one slab");
    if (p->discs && s->projection != RELUME_CYLINDRICAL)
        return log_fail(p->log, RELUME_EINVAL, "discs: expected a cylinder; found a %s capture",
                        relume_projection_name(s->projection));
    if (!(p->spread >= 0.0 && p->spread <= 1000.0))
        return log_fail(p->log, RELUME_EINVAL, "spread: expected 0 to 1000; found %g", p->spread);
    // a picture of three floats and its depth
    return limits_memory(NULL, (uint64_t)s->width * (uint64_t)s->height * 16,
                         "a picture of this size", p->log);
}

static relume_status one_eye_at_most(const struct synth *s)
{
    if (s->p.eye_count <= 1)
        return RELUME_OK;
    return log_fail(s->p.log, RELUME_EINVAL, "eyes: expected one for a %s capture; found %d",
                    relume_projection_name(s->projection), s->p.eye_count);
}

static relume_status place_planar(struct synth *s)
{
    if (!s->p.eye_count)
        return RELUME_OK;
    const vec3 eye = s->p.eyes[0];
    if (eye.x != 0.0 || eye.y != 0.0 || !(eye.z > 0.0))
        return log_fail(s->p.log, RELUME_EINVAL,
                        "eye: expected 0,0,z with z > 0 for a planar capture; found %g,%g,%g",
                        eye.x, eye.y, eye.z);
    s->geometry.perspective = true;
    s->geometry.camera_z = eye.z;
    return RELUME_OK;
}

static relume_status place_eyes(struct synth *s)
{
    s->geometry.uv_z = s->p.eyes[0].z;
    for (int i = 0; i < s->views; i++) {
        const vec3 eye = s->p.eyes[i];
        if (eye.z != s->geometry.uv_z || !(eye.z > s->geometry.st_z))
            return log_fail(s->p.log, RELUME_EINVAL,
                            "eyes: expected all on one plane z > %g for a slab; found z = %g",
                            s->geometry.st_z, eye.z);
        s->uv[i][0] = eye.x;
        s->uv[i][1] = eye.y;
    }
    return RELUME_OK;
}

// Rows from the top, as images are read; slab after slab.
static void place_grid(struct synth *s, double spread)
{
    const int columns = s->p.grid[0], rows = s->p.grid[1];
    for (int i = 0; i < s->views; i++) {
        const int column = i % columns, row = i / columns % rows;
        s->slab_of[i] = i / (columns * rows);
        s->uv[i][0] = columns > 1 ? spread * (2.0 * column / (columns - 1) - 1.0) : 0.0;
        s->uv[i][1] = rows > 1 ? spread * (1.0 - 2.0 * row / (rows - 1)) : 0.0;
    }
}

// Quarter turns are exact.
static double whole(double x)
{
    return fabs(x - round(x)) < 1e-12 ? round(x) + 0.0 : x;
}

static void place_ring(struct synth *s)
{
    const int around = ring_around[s->p.ring];
    const double distance = s->geometry.uv_z;
    const double spread = overlap * distance * tan(M_PI / around);
    // Half the window through which a camera anywhere within `spread` sees a ball of radius 1
    // around the origin: where the rays that touch it cross the st plane.
    const double away = hypot(spread, distance);
    const double angle = atan2(spread, distance) + asin(1.0 / away);
    const double window = distance * tan(angle) - spread;
    for (int axis = 0; axis < 2; axis++) {
        s->geometry.st_min[axis] = -window;
        s->geometry.st_max[axis] = window;
    }
    for (int i = 0; i < s->slabs; i++) {
        const double c = whole(cos(2.0 * M_PI * i / around));
        const double n = whole(sin(2.0 * M_PI * i / around));
        s->slab[i] = s->geometry;
        s->slab[i].pose.axis[0] = vec3_of(c, 0, 0.0 - n);
        s->slab[i].pose.axis[1] = vec3_of(0, 1, 0);
        s->slab[i].pose.axis[2] = vec3_of(n, 0, c);
        if (i >= around)
            s->slab[i].pose = (struct relume_pose){
                .axis = {vec3_of(1, 0, 0), vec3_of(0, 0, -1), vec3_of(0, 1, 0)}};
    }
    place_grid(s, s->p.spread != 0.0 ? s->p.spread : spread);
}

static int count_views(const struct synth *s)
{
    if (s->projection != RELUME_SLAB)
        return 1;
    if (s->p.eye_count)
        return s->p.eye_count;
    return s->p.grid[0] * s->p.grid[1] * (s->slabs ? s->slabs : 1);
}

static relume_status place_slab(struct synth *s)
{
    if (s->p.eye_count)
        return place_eyes(s);
    if (s->slabs)
        place_ring(s);
    else
        place_grid(s, s->p.spread != 0.0 ? s->p.spread : 0.5);
    return RELUME_OK;
}

static relume_status place_views(struct synth *s)
{
    s->geometry = relume_geometry_default(s->projection, s->width, s->height);
    s->geometry.disc = s->disc;
    s->slabs = ring_around[s->p.ring] + (s->p.ring == RELUME_RING_CUBE);
    s->views = count_views(s);
    s->uv = arena_array(&s->arena, (size_t)s->views, sizeof *s->uv);
    s->slab_of = arena_array(&s->arena, (size_t)s->views, sizeof *s->slab_of);
    if (!s->uv || !s->slab_of)
        return RELUME_ENOMEM;
    if (s->projection == RELUME_SLAB)
        return place_slab(s);
    const relume_status status = one_eye_at_most(s);
    if (status || s->projection == RELUME_PLANAR)
        return status ? status : place_planar(s);
    if (s->p.eye_count)
        s->geometry.center = s->p.eyes[0];
    return RELUME_OK;
}

static relume_status name_files(struct synth *s)
{
    s->view = arena_array(&s->arena, (size_t)s->views, sizeof *s->view);
    if (!s->view)
        return RELUME_ENOMEM;
    for (int v = 0; v < s->views; v++) {
        struct relume_manifest_view *view = &s->view[v];
        view->uv[0] = s->uv[v][0];
        view->uv[1] = s->uv[v][1];
        view->slab = s->slab_of[v];
        view->depth = arena_format(&s->arena, "view%02d/depth.exr", v);
        view->images = arena_array(&s->arena, (size_t)s->p.light_count, sizeof *view->images);
        if (!view->depth || !view->images)
            return RELUME_ENOMEM;
        for (int l = 0; l < s->p.light_count; l++)
            if (!(view->images[l] = arena_format(&s->arena, "view%02d/light%04d.exr", v, l)))
                return RELUME_ENOMEM;
    }
    return RELUME_OK;
}

static relume_status save(const struct synth *s, const struct relume_image *image, const char *name,
                          bool half, const struct relume_log *log)
{
    char *path = mem_format("%s/%s", s->folder, name);
    if (!path)
        return RELUME_ENOMEM;
    const relume_status status =
        relume_image_save(image, path, relume_image_params(.log = log, .half = half));
    mem_free(path);
    return status;
}

struct saving {
    const struct synth *synth;
    const struct relume_image *images;
    const char **names;
    relume_status *status;  // [lights]
};

static void save_one(void *context, size_t item, int worker)
{
    (void)worker;
    struct saving *s = context;
    s->status[item] = save(s->synth, &s->images[item], s->names[item], true, NULL);
}

// The log may only be called from here, so what failed silently is tried once more aloud.
static relume_status save_lights(struct synth *s, const struct relume_image *images, int first,
                                 int count)
{
    const char **names = s->view[s->view_now].images + first;
    relume_status *each = mem_zeroed((size_t)count, sizeof *each);
    if (!each)
        return RELUME_ENOMEM;
    struct saving saving = {s, images, names, each};
    thread_for(s->p.threads, (size_t)count, save_one, &saving);
    relume_status status = RELUME_OK;
    for (int i = 0; i < count && !status; i++)
        if (each[i])
            status = save(s, &images[i], names[i], true, s->p.log);
    mem_free(each);
    return status;
}

static bool report(void *user, double done)
{
    const struct synth *s = user;
    const double lights = s->lights_before + done * s->p.light_count;
    const double views = s->view_now + fmin(lights / s->p.light_count, 1.0);
    return log_progress(s->p.log, "rendering", views / s->views);
}

static struct render_job job_of(const struct synth *s)
{
    return (struct render_job){
        .scene = s->scene,
        .camera = {.geometry = s->slabs ? s->slab[s->slab_of[s->view_now]] : s->geometry,
                   .width = s->width,
                   .height = s->height,
                   .uv = {s->uv[s->view_now][0], s->uv[s->view_now][1]}},
        .samples = s->p.samples,
        .bounces = s->p.bounces,
        .seed = s->p.seed,
        .threads = s->p.threads,
    };
}

static relume_status write_depth(const struct synth *s)
{
    struct relume_image depth;
    relume_status status = relume_image_create(&depth, s->width, s->height, 1);
    if (status)
        return status;
    const struct render_job job = job_of(s);
    render_depth(&job, &depth);
    status = save(s, &depth, s->view[s->view_now].depth, false, s->p.log);
    relume_image_destroy(&depth);
    return status;
}

static relume_status write_view(struct synth *s, struct relume_image *held, int held_count)
{
    relume_status status = write_depth(s);
    for (int first = 0; first < s->p.light_count && !status; first += held_count) {
        const int left = s->p.light_count - first;
        struct render_job job = job_of(s);
        job.lights = s->p.lights + first;
        job.light_count = left < held_count ? left : held_count;
        job.near = s->p.near;
        s->lights_before = first;
        status = render_lights(&job, held, report, s);
        if (!status)
            status = save_lights(s, held, first, job.light_count);
    }
    return status;
}

static relume_status make_view_folder(const struct synth *s)
{
    char *path = mem_format("%s/view%02d", s->folder, s->view_now);
    relume_status status = path ? RELUME_OK : RELUME_ENOMEM;
    if (path && mkdir(path, 0777))
        status = log_fail(s->p.log, RELUME_EIO, "%s: cannot be created; %s", path, strerror(errno));
    mem_free(path);
    return status;
}

static relume_status write_views(struct synth *s)
{
    const size_t bytes = (size_t)s->width * (size_t)s->height * 3 * sizeof(float);
    const size_t fit = HELD_BYTES / bytes;
    const size_t most = (size_t)s->p.light_count;
    const int held_count = (int)(fit < 1 ? 1 : fit < most ? fit : most);
    struct relume_image *held = arena_array(&s->arena, (size_t)held_count, sizeof *held);
    relume_status status = held ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; i < held_count && !status; i++)
        status = relume_image_create(&held[i], s->width, s->height, 3);
    for (s->view_now = 0; s->view_now < s->views && !status; s->view_now++) {
        status = make_view_folder(s);
        if (!status)
            status = write_view(s, held, held_count);
    }
    for (int i = 0; held && i < held_count; i++)
        relume_image_destroy(&held[i]);
    return status;
}

static relume_status write_manifest(struct synth *s)
{
    char *path = mem_format("%s/capture.json", s->folder);
    vec3 *towards = arena_array(&s->arena, (size_t)s->p.light_count, sizeof *towards);
    if (!path || !towards) {
        mem_free(path);
        return RELUME_ENOMEM;
    }
    for (int i = 0; i < s->p.light_count; i++)
        towards[i] = vec3_unit(s->p.lights[i]);
    const struct relume_manifest manifest = {
        .transfer = {.curve = RELUME_CURVE_LINEAR},
        .geometry = s->geometry,
        .slabs = s->slabs,
        .slab = s->slab,
        .lights = s->p.light_count,
        .directions = s->p.near ? towards : s->p.lights,
        .positions = s->p.near ? s->p.lights : NULL,
        .intensities_at_origin = true,
        .views = s->views,
        .view = s->view,
    };
    const relume_status status = relume_manifest_write(&manifest, path, s->p.log);
    mem_free(path);
    return status;
}

static relume_status write_folder(struct synth *s, const char *path)
{
    outdir *dir;
    relume_status status = outdir_open(&dir, path, s->p.force, s->p.log);
    if (status)
        return status;
    s->folder = outdir_path(dir);
    status = write_views(s);
    if (!status)
        status = write_manifest(s);
    return outdir_end(&dir, status);
}

relume_status relume_scene_capture(const relume_scene *scene, const char *dir,
                                   const struct relume_synth_params *params)
{
    struct synth s = {.scene = scene, .p = PARAMS_WORK(relume_synth_params, params)};
    s.projection = s.p.projection_set ? s.p.projection : scene->kind->projection;
    s.p.size = or_default(s.p.size, 256);
    s.p.samples = or_default(s.p.samples, 16);
    s.p.grid[0] = or_default(s.p.grid[0], 5);
    s.p.grid[1] = or_default(s.p.grid[1], s.p.grid[0]);
    if (s.p.size > 0 && s.p.size <= limits_or_default(NULL).max_side)
        choose_size(&s);
    relume_status status = check(&s);
    if (!status)
        status = place_views(&s);
    if (!status)
        status = name_files(&s);
    if (!status)
        status = write_folder(&s, dir);
    arena_free(&s.arena);
    return status;
}
