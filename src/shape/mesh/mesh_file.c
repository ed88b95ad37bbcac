// mesh_file.c - what is read from the file of a model, and what its readers share
#include "shape/mesh/mesh_file.h"

#include "core/base/memory.h"

#include <string.h>

void mesh_file_free(struct mesh_file *file)
{
    mesh_free(&file->mesh);
    mem_free(file->colour);
    mem_free(file->picture);
    for (int i = 0; i < file->parts; i++)
        mem_free(file->part[i]);
    mem_free(file->part);
    mem_free(file->look);
    for (int i = 0; i < file->picture_count; i++) {
        mem_free(file->pictures[i].name);
        mem_free(file->pictures[i].bytes);
    }
    mem_free(file->pictures);
    *file = (struct mesh_file){0};
}

int mesh_file_new_part(struct mesh_file *file, const char *name)
{
    enum { MOST_PARTS = 1024 };
    const size_t count = (size_t)file->parts;
    if (file->parts == MOST_PARTS || !mem_grow(&file->part, count, sizeof *file->part) ||
        !mem_grow(&file->look, count, sizeof *file->look))
        return -1;
    file->look[count] = mesh_look_none;
    file->part[count] = mem_text(name);
    return file->part[count] ? file->parts++ : -1;
}

int mesh_file_part(struct mesh_file *file, const char *name)
{
    for (int i = 0; i < file->parts; i++)
        if (!strcmp(file->part[i], name))
            return i;
    return mesh_file_new_part(file, name);
}

int mesh_file_picture_of(struct mesh_file *file, const char *name, const void *bytes, size_t size)
{
    enum { MOST_PICTURES = 4096 };
    const size_t count = (size_t)file->picture_count;
    if (file->picture_count == MOST_PICTURES ||
        !mem_grow(&file->pictures, count, sizeof *file->pictures))
        return -1;
    struct mesh_picture *p = &file->pictures[count];
    *p = (struct mesh_picture){mem_text(name), bytes ? mem_copy(bytes, size, 1) : NULL, size};
    if (p->name && (p->bytes || !bytes))
        return file->picture_count++;
    mem_free(p->name);
    mem_free(p->bytes);
    return -1;
}

int mesh_file_picture(struct mesh_file *file, const char *name)
{
    for (int i = 0; i < file->picture_count; i++)
        if (!file->pictures[i].bytes && !strcmp(file->pictures[i].name, name))
            return i;
    return mesh_file_picture_of(file, name, NULL, 0);
}
