// mesh_other.c - models that Assimp reads in a process of their own; what comes back is believed as
// little as the file
#include "mesh/mesh_other.h"

#include "base/channel.h"
#include "base/inputs.h"
#include "base/log.h"
#include "base/memory.h"
#include "mesh/mesh_serve.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

// Pipes are not waited for. The log has heard why, if there is one.
static relume_status open_regular(int *file, const char *path, uint64_t *bytes,
                                  const struct relume_log *log)
{
    static const off_t MAX_BYTES = (off_t)1 << 31;
    struct stat s;
    input_note(log, path);
    *file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (*file < 0 || fstat(*file, &s))
        return relume_input_fail(log, path, "cannot be opened", errno);
    if (S_ISREG(s.st_mode) && s.st_size <= MAX_BYTES) {
        *bytes = (uint64_t)s.st_size;
        return RELUME_OK;
    }
    close(*file);
    *file = -1;
    return log_fail(log, S_ISREG(s.st_mode) ? RELUME_ELIMIT : RELUME_EFORMAT,
                    "%s: expected a regular file of at most 2 GiB", path);
}

// Models name files below their own folder, nothing else.
static bool stays_below(const char *name)
{
    const size_t n = strlen(name);
    return name[0] && name[0] != '/' && strncmp(name, "../", 3) && !strstr(name, "/../") &&
           strcmp(name, "..") && (n < 3 || strcmp(name + n - 3, "/.."));
}

static int open_beside(const char *path, const char *name, const struct relume_log *log)
{
    uint64_t bytes;
    char *beside = stays_below(name) ? mesh_beside(path, name) : NULL;
    int file = -1;
    if (beside && !open_regular(&file, beside, &bytes, NULL))
        input_note(log, beside);
    mem_free(beside);
    return file;
}

static relume_status ask(struct helper_job *job, struct mesh_answer *answer,
                         const struct mesh_ask *what, int file)
{
    const relume_status status = helper_ask(job, what, sizeof *what, file, answer, sizeof *answer);
    if (status)
        return status;
    answer->text[sizeof answer->text - 1] = '\0';
    helper_bool(&answer->has_uv);
    helper_bool(&answer->made_normals);
    return RELUME_OK;
}

// Gives what the model names until it is read, or is not to be read.
static relume_status have_read(struct helper_job *job, struct mesh_answer *answer, const char *path,
                               int file, const struct mesh_ask *open, const struct relume_log *log)
{
    enum { MOST_FILES = 4096 };
    const struct mesh_ask beside = {.what = MESH_BESIDE};
    relume_status status = ask(job, answer, open, file);
    for (int i = 0; !status && answer->what == MESH_NEEDS; i++) {
        const int other = i < MOST_FILES ? open_beside(path, answer->text, log) : -1;
        status = ask(job, answer, &beside, other);
        if (other >= 0)
            close(other);
    }
    return status;
}

static bool names_are_whole(const char *names, const struct mesh_answer *a)
{
    uint64_t parts = 0;
    for (uint64_t i = 0; i < a->names_bytes; i++)
        parts += !names[i];
    return parts == a->parts && (!a->names_bytes || !names[a->names_bytes - 1]);
}

static bool triangles_are_sound(const struct mesh *mesh, uint64_t parts)
{
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const struct triangle *t = &mesh->triangles[i];
        for (int k = 0; k < 3; k++)
            if (t->vertex[k] >= mesh->vertex_count)
                return false;
        if (t->material >= parts)
            return false;
    }
    return true;
}

// From memory that the process cannot change any more: it has ended.
static relume_status copy(struct mesh_file *out, const char *map, const struct mesh_answer *a)
{
    struct mesh *m = &out->mesh;
    const size_t vertices = (size_t)a->vertices, triangles = (size_t)a->triangles;
    const char *const from = map + vertices * sizeof *m->vertices;
    const char *name = from + triangles * sizeof *m->triangles;
    if (!names_are_whole(name, a))
        return RELUME_EDAMAGED;
    m->vertices = mem_copy(map, vertices, sizeof *m->vertices);
    m->triangles = mem_copy(from, triangles, sizeof *m->triangles);
    if (!m->vertices || !m->triangles)
        return RELUME_ENOMEM;
    m->vertex_count = vertices;
    m->triangle_count = triangles;
    out->has_uv = a->has_uv;
    out->made_normals = a->made_normals;
    for (uint64_t i = 0; i < a->parts; i++, name += strlen(name) + 1)
        if (mesh_file_part(out, name) != (int)i)
            return RELUME_EDAMAGED;
    return triangles_are_sound(m, a->parts) ? RELUME_OK : RELUME_EDAMAGED;
}

// Bytes of the model, 0 where the numbers make no sense or exceed `most`.
static size_t model_bytes(const struct mesh_answer *a, uint64_t most)
{
    const uint64_t bound = UINT32_MAX;
    if (a->vertices > bound || a->triangles > bound || a->names_bytes > 1 << 20)
        return 0;
    const uint64_t bytes = a->vertices * sizeof(struct vertex) +
                           a->triangles * sizeof(struct triangle) + a->names_bytes;
    return bytes <= most ? (size_t)bytes : 0;
}

static relume_status fetch(struct mesh_file *out, struct helper_job *job,
                           const struct mesh_answer *read, size_t bytes)
{
    const struct mesh_ask take = {.what = MESH_TAKE};
    struct mesh_answer answer;
    const int memory = channel_memory(bytes);
    char *map = memory < 0 ? NULL : channel_map(memory, bytes);
    relume_status status = map ? ask(job, &answer, &take, memory) : RELUME_ENOMEM;
    helper_end(job);
    if (!status)
        status = copy(out, map, read);
    if (map)
        munmap(map, bytes);
    if (memory >= 0)
        close(memory);
    return status;
}

static relume_status read_there(struct mesh_file *out, struct helper_job *job, const char *path,
                                int file, uint64_t file_bytes, const struct relume_log *log)
{
    const struct relume_limits *given = limits_of(NULL, log), limits = limits_or_default(given);
    const char *slash = strrchr(path, '/');
    struct mesh_answer answer;
    struct mesh_ask what = {
        .what = MESH_OPEN, .file_bytes = file_bytes, .max_memory = limits.max_memory};
    strncpy(what.name, slash ? slash + 1 : path, sizeof what.name - 1);
    job->processor_s = mesh_read_s(file_bytes);
    relume_status status = have_read(job, &answer, path, file, &what, log);
    if (status)
        return log_fail(log, status, "%s: cannot be read as a 3D model; %s", path, job->why);
    if (answer.what != MESH_READ) {
        const bool read = answer.text[0] != '\0';
        const char *why =
            read ? answer.text : helper_short_of(answer.memory, given && given->max_memory);
        return why ? log_fail(log, read ? RELUME_EDAMAGED : RELUME_ELIMIT,
                              "%s: cannot be read as a 3D model; %s", path, why)
                   : RELUME_ENOMEM;
    }
    const size_t bytes = model_bytes(&answer, limits.max_memory);
    if (answer.triangles && !bytes)
        return log_fail(log, RELUME_ELIMIT,
                        "%s: a model of %llu vertices and %llu triangles; expected one that fits "
                        "%llu MB (--max-memory)",
                        path, (unsigned long long)answer.vertices,
                        (unsigned long long)answer.triangles,
                        (unsigned long long)(limits.max_memory >> 20));
    status = answer.triangles ? fetch(out, job, &answer, bytes) : RELUME_OK;
    return status != RELUME_EDAMAGED
               ? status
               : log_fail(log, status, "%s: cannot be read as a 3D model; its parts do not fit",
                          path);
}

relume_status mesh_read_other(struct mesh_file *out, const char *path, const struct relume_log *log)
{
    struct helper_job job;
    uint64_t bytes = 0;
    int file;
    relume_status status = open_regular(&file, path, &bytes, log);
    if (status)
        return status;
    status = helper_start(&job, HELPER_MESH, path, log);
    if (!status)
        status = read_there(out, &job, path, file, bytes, log);
    helper_end(&job);
    close(file);
    if (status)
        mesh_file_free(out);
    return status;
}
