// mosaic.h - small pieces from all over a planar capture, as a capture of its own
#ifndef SHADOW_MOSAIC_H
#define SHADOW_MOSAIC_H

#include <relume/capture.h>

struct mosaic {
    relume_capture *capture;
    int columns, rows;  // of its pixels
    int *x, *y;         // [columns], [rows]: where they are in the whole
    void *pictures;     // [lights][rows][columns][3]
    float *mask;        // [rows][columns], or NULL
};

// Of a planar capture with one view and distant lights; where it is small all of it. An input
// status, RELUME_ENOMEM, RELUME_ECANCEL; end with mosaic_close in any case.
relume_status mosaic_open(struct mosaic *m, const relume_capture *capture,
                          const struct relume_log *log);
void mosaic_close(struct mosaic *m);

#endif
