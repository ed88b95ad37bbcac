// folder.c - files of a folder that is being made
#include "material/maps/folder.h"

#include "core/base/memory.h"

relume_status folder_save(const char *folder, const char *name, const struct relume_image *image,
                          int threads, const struct relume_log *log)
{
    char *path = mem_format("%s/%s", folder, name);
    const relume_status status =
        path ? relume_image_save(image, path, relume_image_params(.log = log, .threads = threads))
             : RELUME_ENOMEM;
    mem_free(path);
    return status;
}

relume_status folder_print(const char *folder, const char *name,
                           void (*put)(const void *context, FILE *f), const void *context,
                           const struct relume_log *log)
{
    char *path = mem_format("%s/%s", folder, name);
    const relume_status status = path ? relume_file_print(path, put, context, log) : RELUME_ENOMEM;
    mem_free(path);
    return status;
}
