// photometric.h - photometric stereo of a capture
#ifndef ACQUIRE_PHOTOMETRIC_H
#define ACQUIRE_PHOTOMETRIC_H

#include <relume/capture/photometric.h>

// How normals and albedo are fitted to photographs. Borrowed during the call.
struct relume_photometric_params {
    size_t struct_size;            // filled by the macro (base.h)
    const struct relume_log *log;  // progress
    int threads;                   // default: all cores
    bool plain;                    // matte, least squares of all samples: no trimming, no weights
};
#define relume_photometric_params(...)                                                             \
    (&(const struct relume_photometric_params){RELUME_SIZED(relume_photometric_params),            \
                                               __VA_ARGS__})

// Fit every pixel of one view that its mask shows; the caller destroys `out`, which is empty on
// failure. RELUME_EUNFIT when the lights do not span space, RELUME_ENOMEM, RELUME_ECANCEL.
relume_status relume_photometric_fit(struct relume_photometric *out, const relume_capture *capture,
                                     int view, const struct relume_photometric_params *params);
void relume_photometric_destroy(struct relume_photometric *photometric);

// How normals become heights. Borrowed during the call; heights are in world units.
struct relume_height_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    double pixel;   // width of a pixel, world units; default 1
    double screen;  // how strongly the height is held at 0, per pixel^2; default: so little that
                    // the widest shape of the picture loses a thousandth
    int threads;    // default: all cores
    bool smooth;    // steps are smoothed: least squares of all slopes
    const struct relume_image *confidence;  // one channel, of the normals' size: how far each is
                                            // believed, 0 to 1; default: all alike
};
#define relume_height_params(...)                                                                  \
    (&(const struct relume_height_params){RELUME_SIZED(relume_height_params), __VA_ARGS__})

// Height over the image plane, world units, mean 0 over the known pixels, towards the viewer, seen
// orthographically. At a step slopes hold on one side only (after bilateral normal integration, Cao
// et al. 2022), so that what stands before something else is not bent to meet it. How high a step
// is follows where the surface goes around it; a box of which only the top is seen has no height.
// `smooth`: screened Poisson (Bhat et al. 2008; Frankot and Chellappa 1988), solved by cosine
// transforms. Unknown pixels (zero normals) bridge smoothly; slopes end at 80 degrees. One channel;
// the caller destroys it. RELUME_EINVAL, RELUME_ENOMEM, RELUME_ECANCEL.
relume_status relume_height_integrate(struct relume_image *out, const struct relume_image *normal,
                                      const struct relume_height_params *params);

#endif
