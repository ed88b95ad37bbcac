// notes_file.c - what notes on a relume file are on
#include "cli/program/notes_file.h"

#include <relume/relight/slab_set.h>

#include <math.h>

static void find_box(struct relume_notes_file *file, const struct relume_pack_info *info)
{
    relume_slab_set *set = NULL;
    double reach = 0.0;
    if (relume_slab_set_create(&set, info->slab, info->slabs, info->uv, info->slab_of, info->views))
        return;
    const struct relume_vec3 middle = relume_slab_set_middle(set);
    for (int i = 0; i < info->slabs; i++)
        for (int k = 0; k < 2; k++)
            reach = fmax(reach, 0.5 * fabs(info->slab[i].st_max[k] - info->slab[i].st_min[k]));
    relume_slab_set_destroy(&set);
    file->solid = reach > 0.0;
    for (int k = 0; k < 2; k++) {
        file->box[k][0] = middle.x + (k ? reach : -reach);
        file->box[k][1] = middle.y + (k ? reach : -reach);
        file->box[k][2] = middle.z + (k ? reach : -reach);
    }
}

struct relume_notes_file notes_file_of(const relume_pack *pack, const char *name)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    struct relume_notes_file file = {.name = name,
                                     .width = info->width,
                                     .height = info->height,
                                     .views = info->views,
                                     .inside = info->notes};
    if (info->slabs > 1)
        find_box(&file, info);
    return file;
}
