// ingest.h - the photographs of many cameras, found and checked, and the folder they become
#ifndef MULTIVIEW_VIEWS_H
#define MULTIVIEW_VIEWS_H

#include "core/base/arena.h"
#include "core/base/outdir.h"

#include <relume/capture.h>
#include <relume/capture/ingest.h>

// One camera: what was named, and its photographs, one a light.
struct camera_photos {
    const char *name;
    const char **images;
};

struct photo_set {
    struct arena arena;
    int count, lights;
    struct camera_photos *camera;  // [count]
    int width, height;             // of every photograph, upright
    bool turned;  // some lie on their side in their files: no reader of those shows them upright
    const struct relume_vec3 *directions;  // [lights]
};

// A single folder means the photographs in it. Sizes and counts of lights must agree. An input
// status.
relume_status photo_set_open(struct photo_set *out, const char *const *photos, int n,
                             const struct relume_ingest_params *p);
void photo_set_free(struct photo_set *set);

// One photograph, upright and linear, three channels. An input status, RELUME_ENOMEM.
relume_status photo_load(struct relume_image *out, const struct photo_set *set, int camera,
                         int light, const struct relume_ingest_params *p);

// How `file` is called from inside the folder that is being made and will be `dir`. A file
// elsewhere gets a link in its photos/, since a capture that leaves its folder has to be trusted
// first; where the disk has no links its way from `dir`. NULL: no memory.
const char *path_from(struct arena *arena, const outdir *folder, const char *dir, const char *file);

// Where a file's name puts its camera.
struct view_place {
    int row, column;
    bool has_uv;
    double u, v;  // as written
};
// places[set->count]; `names` as relume_slab_ingest_params. RELUME_EINVAL, an input status.
relume_status view_places(struct view_place *places, const struct photo_set *set, const char *names,
                          const struct relume_log *log);

// capture.json of the folder under construction; names of pictures are those from inside it.
relume_status save_manifest(const outdir *dir, const struct relume_manifest *m,
                            const struct relume_log *log);
// `name` inside the folder under construction.
relume_status save_inside(const outdir *dir, const char *name, const struct relume_image *image,
                          bool half, const struct relume_log *log);

#endif
