// file_views.h - the views of a file: where their cameras stand, which of them a frame needs, and
// their pictures under its lights
#ifndef VIEWER_FILE_VIEWS_H
#define VIEWER_FILE_VIEWS_H

#include "app/frame_request.h"
#include "gl/target.h"
#include "relight/view/view.h"
#include "relit/depths.h"
#include "relit/gl_relighter.h"

struct file_views {
    struct relume_geometry geometry;
    int count;
    double (*uv)[2];                // [count]: cameras of a slab
    bool *needed;                   // [count], by the present frame
    const struct target **relit;    // [count]; NULL where not needed
    relume_slab *grid;              // of one slab; NULL: none, or several
    const relume_slab_set *around;  // several slabs; NULL: none, or one
    const int *slab_of;             // of several: [count]
    struct depths depths;           // of slabs; empty: there is no depth
};

// `uv` [count] are the cameras of one slab, or NULL. RELUME_ENOMEM; RELUME_EUNFIT when they do not
// stand on a grid.
relume_status file_views_create(struct file_views *v, const struct relume_geometry *geometry,
                                const double (*uv)[2], int count, const struct relume_log *log);
void file_views_destroy(struct file_views *v);
// As gl_renderer_use_slabs.
void file_views_use_slabs(struct file_views *v, const relume_slab_set *slabs, const double (*uv)[2],
                          const int *slab_of);
// Reads depth from `source` for slabs; `budget` are bytes of graphics memory. RELUME_ENOMEM.
relume_status file_views_use_depth(struct file_views *v, const struct gl *gl,
                                   const struct depth_source *source, size_t budget);

// Marks the views that the frame needs.
void file_views_mark(struct file_views *v, const struct frame_request *q);
// Number of views that are needed.
int file_views_needed(const struct file_views *v);
// Whether the frame is drawn by depth, and whether through an aperture.
bool file_views_take_depth(const struct file_views *v, const struct frame_request *q);
bool file_views_take_lens(const struct frame_request *q);
// Pixels across the whole picture.
int file_views_picture_width(const struct frame_request *q);
// Lets the nearest views that are in graphics memory stand in for those that are still being read.
// Errors of gl_relighter_view.
relume_status file_views_stand_in(struct file_views *v, struct gl_relighter *relighter);

#endif
