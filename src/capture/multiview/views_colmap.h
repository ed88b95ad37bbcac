// views_colmap.h - the text files of COLMAP: cameras.txt, images.txt, points3D.txt
#ifndef MULTIVIEW_VIEWS_COLMAP_H
#define MULTIVIEW_VIEWS_COLMAP_H

#include "core/base/arena.h"

#include <relume/base.h>

// A photograph's camera: x right, y down, z ahead; pixels from the corner of the picture.
struct posed_camera {
    const char *name;
    int width, height;
    double focal[2], center[2];
    double radial[2], tangential[2];
    double rotation[9];  // world -> camera, row by row
    struct relume_vec3 place;
};

struct posed_model {
    struct arena arena;
    int count;
    struct posed_camera *camera;  // [count], in the order of their names
    struct relume_vec3 *point;    // [points], may be NULL
    size_t points;
};

// An input status names the file and the line that is not understood.
relume_status posed_model_read(struct posed_model *out, const char *folder,
                               const struct relume_log *log);
void posed_model_free(struct posed_model *model);

// Where a camera sees a point of its own coordinates, with lens distortion; false behind it.
bool posed_project(double xy[2], const struct posed_camera *camera, struct relume_vec3 point);

#endif
