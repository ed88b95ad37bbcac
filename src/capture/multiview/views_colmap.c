// views_colmap.c - the text files of COLMAP (Schoenberger, Frahm 2016), format of its documentation
#include "capture/multiview/views_colmap.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/vec.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PARAMS = 8, MOST_CAMERAS = 65536 };

// Which parameters a model has, by place: fx, fy, cx, cy, k1, k2, p1, p2; -1: none.
static const struct {
    const char *name;
    int count;
    signed char at[8];
} models[] = {
    {"SIMPLE_PINHOLE", 3, {0, 0, 1, 2, -1, -1, -1, -1}},
    {"PINHOLE", 4, {0, 1, 2, 3, -1, -1, -1, -1}},
    {"SIMPLE_RADIAL", 4, {0, 0, 1, 2, 3, -1, -1, -1}},
    {"RADIAL", 5, {0, 0, 1, 2, 3, 4, -1, -1}},
    {"OPENCV", 8, {0, 1, 2, 3, 4, 5, 6, 7}},
};
enum { MODELS = sizeof models / sizeof *models };

struct lens {
    long id;
    struct posed_camera camera;
};

struct text {
    FILE *file;
    char *path;
    int line;
    char *buffer;
    size_t capacity;
    const struct relume_log *log;
};

static relume_status text_open(struct text *t, const char *folder, const char *name,
                               const struct relume_log *log)
{
    *t = (struct text){.path = mem_format("%s/%s", folder, name), .log = log};
    if (!t->path)
        return RELUME_ENOMEM;
    t->file = input_open(t->path, log);
    return t->file ? RELUME_OK
                   : relume_input_fail(log, t->path, "COLMAP's text file cannot be opened", errno);
}

static void text_close(struct text *t)
{
    if (t->file)
        fclose(t->file);
    mem_free(t->path);
    mem_free_libc(t->buffer);
}

// The next line; comments are passed over, empty lines are not.
static bool text_next(struct text *t)
{
    ssize_t n;
    do {
        n = getline(&t->buffer, &t->capacity, t->file);
        t->line++;
    } while (n > 0 && t->buffer[0] == '#');
    if (n <= 0)
        return false;
    t->buffer[strcspn(t->buffer, "\r\n")] = '\0';
    return true;
}

static relume_status not_understood(const struct text *t, const char *expected)
{
    return log_fail(t->log, RELUME_EFORMAT, "%s: line %d is not understood; expected %s", t->path,
                    t->line, expected);
}

static bool is_blank(const char *text)
{
    return !text[strspn(text, " \t")];
}

static relume_status read_lens(struct lens *out, const struct text *t)
{
    char name[32];
    int used = 0, m = 0;
    double p[MOST_PARAMS] = {0.0}, full[8];
    struct posed_camera *c = &out->camera;
    if (sscanf(t->buffer, "%ld %31s %d %d%n", &out->id, name, &c->width, &c->height, &used) != 4 ||
        c->width < 1 || c->height < 1)
        return not_understood(t, "CAMERA_ID MODEL WIDTH HEIGHT PARAMS");
    while (m < MODELS && strcmp(models[m].name, name))
        m++;
    if (m == MODELS)
        return log_fail(t->log, RELUME_EUNSUPPORTED,
                        "%s: line %d: camera model %s; expected SIMPLE_PINHOLE, PINHOLE, "
                        "SIMPLE_RADIAL, RADIAL or OPENCV (undistort the photographs)",
                        t->path, t->line, name);
    const char *rest = t->buffer + used;
    for (int i = 0; i < models[m].count; i++) {
        char *end;
        p[i] = strtod(rest, &end);
        if (end == rest || !isfinite(p[i]))
            return not_understood(t, "the parameters of its camera model");
        rest = end;
    }
    for (int i = 0; i < 8; i++)
        full[i] = models[m].at[i] < 0 ? 0.0 : p[models[m].at[i]];
    memcpy(c->focal, full, sizeof c->focal);
    memcpy(c->center, full + 2, sizeof c->center);
    memcpy(c->radial, full + 4, sizeof c->radial);
    memcpy(c->tangential, full + 6, sizeof c->tangential);
    return c->focal[0] > 0.0 && c->focal[1] > 0.0 ? RELUME_OK
                                                  : not_understood(t, "a focal length above 0");
}

static relume_status read_lenses(struct lens **out, int *count, const char *folder,
                                 const struct relume_log *log)
{
    struct text t;
    relume_status status = text_open(&t, folder, "cameras.txt", log);
    while (!status && text_next(&t)) {
        if (is_blank(t.buffer))
            continue;
        const bool allocated = *count < MOST_CAMERAS && mem_grow(out, (size_t)*count, sizeof **out);
        status = allocated ? read_lens(&(*out)[(*count)++], &t) : RELUME_ENOMEM;
    }
    text_close(&t);
    return status;
}

// Rotation by a quaternion w, x, y, z.
static bool rotation_of(double r[9], const double q[4])
{
    const double n = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(n > 1e-9) || !isfinite(n))
        return false;
    const double w = q[0] / n, x = q[1] / n, y = q[2] / n, z = q[3] / n;
    const double m[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                         2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                         2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    memcpy(r, m, sizeof m);
    return true;
}

static relume_status read_pose(struct posed_camera *out, struct arena *arena, const struct text *t,
                               const struct lens *lens, int lenses)
{
    long id, camera;
    double q[4], v[3];
    int used = 0, k = 0;
    if (sscanf(t->buffer, "%ld %lf %lf %lf %lf %lf %lf %lf %ld %n", &id, &q[0], &q[1], &q[2], &q[3],
               &v[0], &v[1], &v[2], &camera, &used) != 9 ||
        !used || is_blank(t->buffer + used))
        return not_understood(t, "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME");
    while (k < lenses && lens[k].id != camera)
        k++;
    if (k == lenses)
        return not_understood(t, "a CAMERA_ID of cameras.txt");
    *out = lens[k].camera;
    out->name = arena_text(arena, t->buffer + used);
    if (!out->name)
        return RELUME_ENOMEM;
    const double *r = out->rotation;
    if (!rotation_of(out->rotation, q) || !isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2]))
        return not_understood(t, "a rotation and a translation");
    out->place = vec3_of(-(r[0] * v[0] + r[3] * v[1] + r[6] * v[2]),
                         -(r[1] * v[0] + r[4] * v[1] + r[7] * v[2]),
                         -(r[2] * v[0] + r[5] * v[1] + r[8] * v[2]));
    return RELUME_OK;
}

static int by_name(const void *a, const void *b)
{
    const struct posed_camera *x = a, *y = b;
    return strcmp(x->name, y->name);
}

// Every pose is followed by a line of what the photograph shows, which may be empty.
static relume_status read_poses(struct posed_model *m, const char *folder, const struct lens *lens,
                                int lenses, const struct relume_log *log)
{
    struct text t;
    struct posed_camera *all = NULL;
    relume_status status = text_open(&t, folder, "images.txt", log);
    while (!status && text_next(&t)) {
        if (is_blank(t.buffer))
            continue;
        const bool allocated =
            m->count < MOST_CAMERAS && mem_grow(&all, (size_t)m->count, sizeof *all);
        status =
            allocated ? read_pose(&all[m->count++], &m->arena, &t, lens, lenses) : RELUME_ENOMEM;
        if (!status)
            text_next(&t);
    }
    if (!status && m->count < 2)
        status = log_fail(log, RELUME_EUNFIT, "%s: %d photograph%s; expected two or more", t.path,
                          m->count, relume_plural(m->count));
    if (!status) {
        qsort(all, (size_t)m->count, sizeof *all, by_name);
        m->camera = arena_array(&m->arena, (size_t)m->count, sizeof *all);
        if (m->camera)
            memcpy(m->camera, all, (size_t)m->count * sizeof *all);
        status = m->camera ? RELUME_OK : RELUME_ENOMEM;
    }
    mem_free(all);
    text_close(&t);
    return status;
}

// Points are welcome, not needed.
static relume_status read_points(struct posed_model *m, const char *folder)
{
    struct text t;
    struct relume_vec3 p;
    long long id;
    relume_status status = RELUME_OK;
    if (text_open(&t, folder, "points3D.txt", NULL))
        t.line = -1;
    while (t.file && !status && text_next(&t)) {
        if (sscanf(t.buffer, "%lld %lf %lf %lf", &id, &p.x, &p.y, &p.z) != 4)
            continue;
        if (mem_grow(&m->point, (size_t)m->points, sizeof *m->point))
            m->point[m->points++] = p;
        else
            status = RELUME_ENOMEM;
    }
    text_close(&t);
    return status;
}

relume_status posed_model_read(struct posed_model *out, const char *folder,
                               const struct relume_log *log)
{
    struct lens *lens = NULL;
    int lenses = 0;
    *out = (struct posed_model){.count = 0};
    relume_status status = read_lenses(&lens, &lenses, folder, log);
    if (!status)
        status = read_poses(out, folder, lens, lenses, log);
    if (!status)
        status = read_points(out, folder);
    mem_free(lens);
    if (status)
        posed_model_free(out);
    return status;
}

void posed_model_free(struct posed_model *model)
{
    mem_free(model->point);
    arena_free(&model->arena);
    *model = (struct posed_model){.count = 0};
}

bool posed_project(double xy[2], const struct posed_camera *c, struct relume_vec3 p)
{
    if (!(p.z > 0.0))
        return false;
    const double x = p.x / p.z, y = p.y / p.z, r2 = x * x + y * y;
    const double k = 1.0 + r2 * (c->radial[0] + r2 * c->radial[1]);
    const double *t = c->tangential;
    const double dx = 2.0 * t[0] * x * y + t[1] * (r2 + 2.0 * x * x);
    const double dy = t[0] * (r2 + 2.0 * y * y) + 2.0 * t[1] * x * y;
    xy[0] = c->focal[0] * (x * k + dx) + c->center[0];
    xy[1] = c->focal[1] * (y * k + dy) + c->center[1];
    return true;
}
