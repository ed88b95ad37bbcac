// without_sums.h - a relume file, or a part, as versions before check sums wrote it
#ifndef TESTS_WITHOUT_SUMS_H
#define TESTS_WITHOUT_SUMS_H

#include "core/base/arena.h"
#include "image/image/exr.h"

#include <relume/context.h>
#include <string.h>

// The attribute that says so goes, the others stay in their order.
static inline void without_sums_attribute(struct exr_part *part)
{
    struct exr_attribute *a = (struct exr_attribute *)(uintptr_t)part->attribute;
    int kept = 0;
    for (int i = 0; i < part->attributes; i++)
        if (strcmp(a[i].name, "relume.sums") != 0)
            a[kept++] = a[i];
    part->attributes = kept;
}

// The file `file_path` into `to`, which the caller destroys.
static inline relume_status without_sums(struct relume_buffer *to, const char *file_path)
{
    const struct relume_writer writer = relume_buffer_writer(to);
    struct arena arena = {0};
    exr_file *file;
    relume_status status = exr_open(&file, file_path, NULL, NULL, NULL);
    const int count = status ? 0 : exr_part_count(file);
    struct exr_part *part = arena_array(&arena, (size_t)count, sizeof *part);
    for (int i = 0; !status && i < count; i++)
        status = exr_part_again(&part[i], file, i, &arena);
    if (!status)
        without_sums_attribute(part);
    if (!status)
        status = exr_write(NULL, &writer, part, count, false, 1, NULL);
    arena_free(&arena);
    exr_close(&file);
    return status;
}

#endif
