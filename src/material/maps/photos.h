// photos.h - the photographs of a view, pixel by pixel
#ifndef APPEARANCE_PHOTOS_H
#define APPEARANCE_PHOTOS_H

#include "capture/manifest/near_view.h"
#include "material/maps/ggx.h"

struct photos {
    const relume_capture *capture;
    const struct relume_log *log;
    int view, threads;
    int width, height;
    int lights;        // those that are looked at
    const int *light;  // [lights]: of the capture; borrowed
    float gain;        // values are multiplied by it
    bool is_near;
    struct near_view near;
    float (*white)[3];          // [lights]
    struct relume_image known;  // above 0.5: pixels that are looked at
    float *memory;              // [threads][look_size]
    int row, rows;              // of the band in memory
    float *samples;             // [lights of the capture][rows][width][3]
};

// From where a point of the view is seen: its eye, or along -z.
void photos_look_from(struct look *k, const struct near_view *view, vec3 point);

// `light` must outlive it; what is seen through the mask is known.
relume_status photos_open(struct photos *out, const relume_capture *capture, int view,
                          const int *light, int lights, int threads, const struct relume_log *log);
void photos_close(struct photos *p);

// Call row(context, y, worker) for every row, in bands; from it photos_look may be called for that
// row. RELUME_ECANCEL, an input status, RELUME_ENOMEM.
relume_status photos_each(struct photos *p, const char *what,
                          void (*row)(void *context, size_t y, int worker), void *context);
// The pixel as a look in the worker's memory, or in look_size floats of the caller's.
void photos_look(struct look *out, const struct photos *p, int x, int y, int worker);
void photos_look_into(struct look *out, const struct photos *p, int x, int y, float *memory);

#endif
