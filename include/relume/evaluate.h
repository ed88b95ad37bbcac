// evaluate.h - how well a file shows a capture: relit with every light, compared with every image
#ifndef RELUME_EVALUATE_H
#define RELUME_EVALUATE_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/pack.h>

#ifdef __cplusplus
extern "C" {
#endif

// Display values are coded by sRGB, or by the capture's own gamma, and clipped to [0, 1]; NaN where
// nothing could be measured.
struct relume_evaluation_light {
    double rms;      // linear, all views pooled
    double psnr_db;  // mean over views
};
// How far a file is from a capture. The caller destroys it.
struct relume_evaluation {
    int views, lights;                      // of the capture
    int width, height;                      // of each view
    size_t images;                          // images compared: those with a pixel inside the mask
    double rms;                             // linear values, all channels, pooled
    double psnr_db;                         // mean over images of the PSNR of 8-bit display values
    double psnr_pooled_db;                  // of the unrounded error over all images; at most 200
    double ssim, delta_e;                   // means over images
    double jnd, jnd_worst;                  // what 1 % of the pixels of an image exceed
                                            // (relume_jnd.most): mean over images, and most; NaN
                                            // without relume_evaluate_params.jnd
    double file_bytes, raw_bytes, ratio;    // raw: three floats a pixel, light and view
    double bits_per_pixel;                  // of the file, per pixel and view
    struct relume_evaluation_light *light;  // [lights], from malloc
};
RELUME_API void relume_evaluation_destroy(struct relume_evaluation *evaluation);

// What is measured, and how sentences call the two sides. Borrowed during the call.
struct relume_evaluate_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const char *file, *capture;  // how sentences call the two; default: "the file", "the capture"
    int threads;                 // default: all cores
    bool no_ssim, no_delta_e;    // leave these out (NaN), they take most of the time
    bool jnd;                    // what people see of it, on a desktop screen (jnd.h)
    int every;                   // compare one of so many images, evenly spread; default: all
};
#define relume_evaluate_params(...)                                                                \
    (&(const struct relume_evaluate_params){RELUME_SIZED(relume_evaluate_params), __VA_ARGS__})

// Slab views are matched by slab and place on the uv plane, or rendered at that eye through that
// slab's window where the file has none there; near lights of the capture are evaluated as point
// lights that do not fall off.
// `*out` is empty on failure. Returns an input status (sizes, projections or slabs differ, an image
// is broken), RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_evaluate(struct relume_evaluation *out, relume_pack *pack,
                                            const relume_capture *capture,
                                            const struct relume_evaluate_params *params);

#ifdef __cplusplus
}
#endif
#endif
