// views_shift.h - pictures of parallel cameras moved so that a plane stands still in them
#ifndef MULTIVIEW_VIEWS_SHIFT_H
#define MULTIVIEW_VIEWS_SHIFT_H

#include "capture/multiview/views_order.h"
#include "core/base/outdir.h"

// Save every camera's pictures, moved by `disparity` pixels for each step of the grid from its
// middle and cropped to what all show, as linear half EXR files inside `folder`, and name them in
// view[rows * columns]. The size they have in common comes back. RELUME_EUNFIT when nothing is
// left.
relume_status save_shifted(struct relume_manifest_view *view, int *width, int *height,
                           const outdir *folder, struct photo_set *set,
                           const struct camera_grid *grid, double disparity,
                           const struct relume_ingest_params *p);

#endif
