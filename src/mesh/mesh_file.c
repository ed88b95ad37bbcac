// mesh_file.c - what is read from the file of a model, and what its readers share
#include "mesh/mesh_file.h"

#include "base/inputs.h"
#include "base/log.h"
#include "base/memory.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const off_t MAX_BYTES = (off_t)1 << 31;

void mesh_file_free(struct mesh_file *file)
{
    mesh_free(&file->mesh);
    free(file->picture);
    for (int i = 0; i < file->parts; i++)
        free(file->part[i]);
    free(file->part);
    *file = (struct mesh_file){0};
}

int mesh_file_part(struct mesh_file *file, const char *name)
{
    enum { MOST_PARTS = 1024 };
    for (int i = 0; i < file->parts; i++)
        if (!strcmp(file->part[i], name))
            return i;
    if (file->parts == MOST_PARTS ||
        !mem_grow(&file->part, (size_t)file->parts, sizeof *file->part))
        return -1;
    file->part[file->parts] = mem_text(name);
    return file->part[file->parts] ? file->parts++ : -1;
}

char *mesh_beside(const char *path, const char *name)
{
    const char *slash = strrchr(path, '/');
    if (name[0] == '/' || !slash)
        return mem_text(name);
    return mem_format("%.*s%s", (int)(slash - path) + 1, path, name);
}

relume_status mesh_load_text(char **out, size_t *size, const char *path,
                             const struct relume_log *log)
{
    *out = NULL;
    FILE *file = input_open(path, log);
    struct stat s;
    if (!file || fstat(fileno(file), &s)) {
        const int error = errno;
        if (file)
            fclose(file);
        return relume_input_fail(log, path, "cannot be opened", error);
    }
    if (!S_ISREG(s.st_mode) || s.st_size > MAX_BYTES) {
        fclose(file);
        return log_fail(log, RELUME_EFORMAT, "%s: expected a regular file of at most 2 GiB", path);
    }
    char *text = mem_array((size_t)s.st_size + 1, 1);
    if (text) {
        *size = fread(text, 1, (size_t)s.st_size, file);
        text[*size] = '\0';
    }
    fclose(file);
    *out = text;
    return text ? RELUME_OK : RELUME_ENOMEM;
}
