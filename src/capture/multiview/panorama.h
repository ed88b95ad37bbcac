// panorama.h - the sources of panoramas
#ifndef MULTIVIEW_PANORAMA_H
#define MULTIVIEW_PANORAMA_H

#include "capture/multiview/views.h"
#include "core/base/outdir.h"

struct panorama_job {
    struct photo_set set;
    const struct relume_panorama_params *p;
    const struct relume_ingest_params *common;
    const char *dir;       // the final name
    const outdir *folder;  // where it is made
    struct relume_manifest_view view;
    struct relume_geometry geometry;
    struct relume_transfer transfer;
    int width, height;  // of the panorama
};

// Write pictures and fill view, geometry, transfer, width, height.
relume_status panorama_from_cube(struct panorama_job *job);
relume_status panorama_from_stitch(struct panorama_job *job);

// Name the picture of one light, "light0000.exr"; NULL: no memory.
const char *panorama_picture_name(struct panorama_job *job, int light);
relume_status panorama_load(struct relume_image *out, const struct panorama_job *job, int camera,
                            int light);

#endif
