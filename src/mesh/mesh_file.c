// mesh_file.c - what is read from the file of a model, and what its readers share
#include "mesh/mesh_file.h"

#include "base/memory.h"

#include <string.h>

void mesh_file_free(struct mesh_file *file)
{
    mesh_free(&file->mesh);
    mem_free(file->colour);
    mem_free(file->picture);
    for (int i = 0; i < file->parts; i++)
        mem_free(file->part[i]);
    mem_free(file->part);
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
