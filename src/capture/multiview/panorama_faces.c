// panorama_faces.c - six faces become a cube side by side
#include "capture/multiview/panorama.h"

#include "core/base/tree.h"
#include "core/base/log.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

enum { FACES = 6 };
enum face { PX, NX, PY, NY, PZ, NZ };

// What names call the faces. Pictures of cubes for graphics cards (posz) count z the other way
// round than the world does: that shows at the edges.
static const struct {
    const char *word;
    enum face face;
} words[] = {
    {"posx", PX},  {"negx", NX}, {"posy", PY}, {"negy", NY},   {"posz", PZ}, {"negz", NZ},
    {"px", PX},    {"nx", NX},   {"py", PY},   {"ny", NY},     {"pz", PZ},   {"nz", NZ},
    {"+x", PX},    {"-x", NX},   {"+y", PY},   {"-y", NY},     {"+z", PZ},   {"-z", NZ},
    {"right", PX}, {"left", NX}, {"top", PY},  {"bottom", NY}, {"back", PZ}, {"front", NZ},
    {"up", PY},    {"down", NY},
};
enum { WORDS = sizeof words / sizeof *words };

// The face that a name ends in, before its extension; FACES: none.
static int face_named(const char *path)
{
    const char *name = path_name(path);
    const char *dot = strrchr(name, '.');
    const size_t length = dot ? (size_t)(dot - name) : strlen(name);
    for (int i = 0; i < WORDS; i++) {
        const size_t n = strlen(words[i].word);
        if (length >= n && !strncasecmp(name + length - n, words[i].word, n) &&
            (length == n || !isalpha((unsigned char)name[length - n - 1]) || n > 2))
            return (int)words[i].face;
    }
    return FACES;
}

static relume_status order_faces(int camera[FACES], const struct photo_set *set,
                                 const struct relume_log *log)
{
    if (set->count != FACES)
        return log_fail(log, RELUME_EUNFIT, "%s: one of %d picture%s; expected six faces of a cube",
                        set->camera[0].name, set->count, relume_plural(set->count));
    for (int f = 0; f < FACES; f++)
        camera[f] = -1;
    int named = 0;
    for (int i = 0; i < FACES; i++)
        named += face_named(set->camera[i].name) < FACES;
    for (int i = 0; i < FACES; i++) {
        const int f = named ? face_named(set->camera[i].name) : i;
        if (f == FACES)
            return log_fail(log, RELUME_EUNFIT,
                            "%s: no face in the name; expected px nx py ny pz nz, posx ..., or "
                            "right left top bottom back front at its end, as in the others",
                            set->camera[i].name);
        if (camera[f] >= 0)
            return log_fail(log, RELUME_EUNFIT, "%s: the same face as %s", set->camera[i].name,
                            set->camera[camera[f]].name);
        camera[f] = i;
    }
    return RELUME_OK;
}

// Mean difference of the right edge of one picture and the left edge of another.
static double edge_difference(const struct relume_image *left, const struct relume_image *right)
{
    double sum = 0.0;
    const size_t row = 3 * (size_t)left->width;
    for (int y = 0; y < left->height; y++)
        for (size_t c = 0; c < 3; c++)
            sum += fabs((double)left->data[((size_t)y + 1) * row - 3 + c] -
                        (double)right->data[(size_t)y * row + c]);
    return sum;
}

// The sides in the order in which a turn to the right shows them.
static double around(const struct relume_image faces[FACES], bool swapped)
{
    const int turn[4] = {swapped ? PZ : NZ, PX, swapped ? NZ : PZ, NX};
    double sum = 0.0;
    for (int i = 0; i < 4; i++)
        sum += edge_difference(&faces[turn[i]], &faces[turn[(i + 1) % 4]]);
    return sum;
}

static relume_status load_faces(struct relume_image faces[FACES], const struct panorama_job *job,
                                const int camera[FACES], int light)
{
    relume_status status = RELUME_OK;
    for (int f = 0; f < FACES && !status; f++)
        status = panorama_load(&faces[f], job, camera[f], light);
    return status;
}

static void free_faces(struct relume_image faces[FACES])
{
    for (int f = 0; f < FACES; f++)
        relume_image_destroy(&faces[f]);
}

static relume_status check_edges(int camera[FACES], const struct panorama_job *job)
{
    struct relume_image faces[FACES] = {{0}};
    const relume_status status = load_faces(faces, job, camera, 0);
    if (!status && around(faces, true) < around(faces, false)) {
        const int front = camera[NZ];
        camera[NZ] = camera[PZ];
        camera[PZ] = front;
        log_line(job->common->log, RELUME_NOTE,
                 "the edges fit if %s is the face in front (-z) and %s the one behind (+z); relume "
                 "uses them so",
                 job->set.camera[camera[NZ]].name, job->set.camera[camera[PZ]].name);
    }
    free_faces(faces);
    return status;
}

static relume_status save_cube(struct panorama_job *job, const int camera[FACES], int light)
{
    struct relume_image faces[FACES] = {{0}}, out = {0};
    const int side = job->set.width;
    const size_t row = 3 * (size_t)side;
    relume_status status = load_faces(faces, job, camera, light);
    if (!status)
        status = relume_image_create(&out, job->width, job->height, 3);
    for (int f = 0; f < FACES && !status; f++)
        for (size_t y = 0; y < (size_t)side; y++)
            memcpy(out.data + (y * FACES + (size_t)f) * row, faces[f].data + y * row,
                   row * sizeof *out.data);
    if (!status)
        status =
            panorama_picture_name(job, light)
                ? save_inside(job->folder, job->view.images[light], &out, true, job->common->log)
                : RELUME_ENOMEM;
    free_faces(faces);
    relume_image_destroy(&out);
    return status;
}

relume_status panorama_from_cube(struct panorama_job *job)
{
    int camera[FACES];
    relume_status status = order_faces(camera, &job->set, job->common->log);
    if (!status && job->set.width != job->set.height)
        status = log_fail(job->common->log, RELUME_EUNFIT,
                          "%s: %d x %d pixels; expected square faces of a cube",
                          job->set.camera[0].name, job->set.width, job->set.height);
    if (!status)
        status = check_edges(camera, job);
    job->width = FACES * job->set.width;
    job->height = job->set.height;
    job->geometry = relume_geometry_default(RELUME_CUBE, job->width, job->height);
    job->transfer = (struct relume_transfer){.curve = RELUME_CURVE_LINEAR};
    for (int k = 0; k < job->set.lights && !status; k++) {
        status = save_cube(job, camera, k);
        if (!status && !log_progress(job->common->log, "writing", (k + 1.0) / job->set.lights))
            status = RELUME_ECANCEL;
    }
    return status;
}
