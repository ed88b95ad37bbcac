// enhancer.h - passes over relit views: normals are fitted once for each view that is looked at
#ifndef VIEWER_ENHANCER_H
#define VIEWER_ENHANCER_H

#include "image/geometry/geometry.h"
#include "relit/gl_relighter.h"

#include <relume/capture.h>
#include <relume/relight/enhance.h>
#include <relume/relight/slab_set.h>

struct enhanced_view {
    GLuint normal, albedo, detail;  // 0: not fitted yet
    struct relume_image normals;    // the same as `normal`
    int radius;                     // of `detail`
    GLuint reference;               // photograph under captured light `light`
    int light;
    struct relume_image
        albedo_grid;  // every `step`-th pixel of the albedo, for relume_pass_measure
    struct target shown;
};

struct enhancer {
    const struct gl *gl;
    const struct relume_log *log;
    struct code_source source;
    struct relume_geometry geometry;
    const double (*uv)[2];
    const relume_slab_set *around;  // several slabs, or NULL
    const int *slab_of;             // of several: [views]
    const relume_capture *capture;  // to compare with, or NULL
    struct program program;
    GLuint vertices;
    GLuint light_rows;
    GLuint towards[RELUME_MOST_SLABS];  // vectors to the eye of a panorama (the first), or of
                                        // several slabs; 0: not made yet
    struct enhanced_view *view;
    int views;
    int threads;
    struct target grid;                // every `step`-th pixel of a relit view
    struct relume_pass_params params;  // 0: defaults
    struct relume_pass_range range;    // of the view that was shown last
};

// All that is pointed at must outlive it. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status enhancer_create(struct enhancer *enhancer, const struct gl *gl,
                              const struct code_source *source,
                              const struct relume_geometry *geometry, const double (*uv)[2],
                              int views, const struct relume_log *log);
// Several slabs; all of it must outlive the enhancer.
void enhancer_use_slabs(struct enhancer *enhancer, const relume_slab_set *slabs,
                        const double (*uv)[2], const int *slab_of);
void enhancer_destroy(struct enhancer *enhancer);

// What `pass` shows of `relit`, view number `view` under `n` lights; valid until the next call for
// that view. The first call for a view may take seconds. An input status, RELUME_ENOMEM,
// RELUME_ESYSTEM.
relume_status enhancer_view(const struct target **out, struct enhancer *enhancer, int view,
                            const struct target *relit, enum relume_pass pass,
                            const struct relume_light *lights, int n);

#endif
