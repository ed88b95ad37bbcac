// mesh_other.c - models that Assimp reads in a process of their own; what comes back is believed as
// little as the file
#include "shape/mesh/mesh_other.h"

#include "core/base/tree.h"
#include "core/base/channel.h"
#include "core/base/inputs.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "shape/mesh/mesh_serve.h"

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
    char *beside = stays_below(name) ? path_beside(path, name) : NULL;
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
    helper_bool(&answer->has_colours);
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
    uint64_t count = 0;
    for (uint64_t i = 0; i < a->names_bytes; i++)
        count += !names[i];
    return count == a->parts + a->pictures && (!a->names_bytes || !names[a->names_bytes - 1]);
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

static bool in_range(float x)
{
    return x >= 0.0f && x <= 1.0f;
}

static bool is_light(float x)
{
    return x >= 0.0f && x <= 65504.0f;
}

static bool look_is_sound(const struct mesh_look *l, int pictures)
{
    return in_range(l->colour[0]) && in_range(l->colour[1]) && in_range(l->colour[2]) &&
           in_range(l->metallic) && in_range(l->roughness) && l->picture >= -1 &&
           l->picture < pictures && l->surface >= -1 && l->surface < pictures &&
           in_range(l->opacity) && in_range(l->cutoff) && l->cover >= MESH_WHOLE &&
           l->cover <= MESH_BLENDED && l->normal >= -1 && l->normal < pictures &&
           fabsf(l->bump) <= 16.0f && l->emitted >= -1 && l->emitted < pictures &&
           is_light(l->emission[0]) && is_light(l->emission[1]) && is_light(l->emission[2]);
}

// %20 and the like, which URIs have in place of a letter.
static void decode_uri(char *name)
{
    char *to = name;
    for (const char *from = name; *from; from++) {
        char byte[3] = "", *end = byte;
        if (*from == '%' && from[1] && from[2])
            memcpy(byte, from + 1, 2);
        const long value = strtol(byte, &end, 16);
        const bool is_code = end == byte + 2 && value > 0;
        *to++ = is_code ? (char)value : *from;
        from += is_code ? 2 : 0;
    }
    *to = '\0';
}

// The file of a picture: below the folder of the model, whatever was on the disk of its maker.
static char *picture_file(const char *path, const char *name)
{
    const char *slash = strrchr(name, '/'), *back = strrchr(name, '\\');
    const char *last = slash && (!back || slash > back) ? slash + 1 : back ? back + 1 : name;
    char *file = path_beside(path, stays_below(name) ? name : last);
    if (!file || !access(file, R_OK))
        return file;
    char *decoded = mem_text(name);
    if (decoded)
        decode_uri(decoded);
    if (decoded && strcmp(decoded, name) && stays_below(decoded)) {
        mem_free(file);
        file = path_beside(path, decoded);
    }
    mem_free(decoded);
    return file;
}

// What follows the arrays: sizes, looks, names, pictures.
static relume_status copy_parts(struct mesh_file *out, const char *from, const char *path,
                                const struct mesh_answer *a)
{
    const char *look = from + a->pictures * sizeof(uint64_t);
    const char *name = look + a->parts * sizeof *out->look;
    const char *bytes = name + a->names_bytes;
    uint64_t left = a->picture_bytes;
    if (!names_are_whole(name, a))
        return RELUME_EDAMAGED;
    for (uint64_t i = 0; i < a->parts; i++, name += strlen(name) + 1) {
        if (mesh_file_new_part(out, name) != (int)i)
            return RELUME_EDAMAGED;
        memcpy(&out->look[i], look + i * sizeof *out->look, sizeof *out->look);
        helper_bool(&out->look[i].given);
        if (!look_is_sound(&out->look[i], (int)a->pictures))
            return RELUME_EDAMAGED;
    }
    for (uint64_t i = 0; i < a->pictures; i++, name += strlen(name) + 1) {
        uint64_t size;
        memcpy(&size, from + i * sizeof size, sizeof size);
        if (size > left)
            return RELUME_EDAMAGED;
        char *beside = size ? mem_text(name) : picture_file(path, name);
        const int number =
            beside ? mesh_file_picture_of(out, beside, size ? bytes : NULL, (size_t)size) : -1;
        mem_free(beside);
        if (number != (int)i)
            return RELUME_ENOMEM;
        bytes += size, left -= size;
    }
    return RELUME_OK;
}

// From memory that the process cannot change any more: it has ended.
static relume_status copy(struct mesh_file *out, const char *map, const char *path,
                          const struct mesh_answer *a)
{
    struct mesh *m = &out->mesh;
    const size_t vertices = (size_t)a->vertices, triangles = (size_t)a->triangles;
    const char *const from = map + vertices * sizeof *m->vertices;
    const char *const colour = from + triangles * sizeof *m->triangles;
    m->vertices = mem_copy(map, vertices, sizeof *m->vertices);
    m->triangles = mem_copy(from, triangles, sizeof *m->triangles);
    if (a->has_colours)
        out->colour = mem_copy(colour, vertices, sizeof *out->colour);
    if (!m->vertices || !m->triangles || (a->has_colours && !out->colour))
        return RELUME_ENOMEM;
    m->vertex_count = vertices;
    m->triangle_count = triangles;
    out->has_uv = a->has_uv;
    out->made_normals = a->made_normals;
    const relume_status status =
        copy_parts(out, colour + (a->has_colours ? vertices * sizeof *out->colour : 0), path, a);
    return status ? status : triangles_are_sound(m, a->parts) ? RELUME_OK : RELUME_EDAMAGED;
}

static relume_status fetch(struct mesh_file *out, struct helper_job *job, const char *path,
                           const struct mesh_answer *read, size_t bytes)
{
    const struct mesh_ask take = {.what = MESH_TAKE};
    struct mesh_answer answer;
    const int memory = channel_memory(bytes);
    char *map = memory < 0 ? NULL : channel_map(memory, bytes);
    relume_status status = map ? ask(job, &answer, &take, memory) : RELUME_ENOMEM;
    helper_end(job);
    if (!status)
        status = copy(out, map, path, read);
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
    struct mesh_answer answer;
    struct mesh_ask what = {
        .what = MESH_OPEN, .file_bytes = file_bytes, .max_memory = limits.max_memory};
    strncpy(what.name, path_name(path), sizeof what.name - 1);
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
    const size_t bytes = mesh_answer_bytes(&answer);
    if (answer.triangles && (!bytes || bytes > limits.max_memory))
        return log_fail(log, RELUME_ELIMIT,
                        "%s: a model of %llu vertices and %llu triangles; expected one that fits "
                        "%llu MB (--max-memory)",
                        path, (unsigned long long)answer.vertices,
                        (unsigned long long)answer.triangles,
                        (unsigned long long)(limits.max_memory >> 20));
    status = answer.triangles ? fetch(out, job, path, &answer, bytes) : RELUME_OK;
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
