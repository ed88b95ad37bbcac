// glare.h - the frame as a living eye sees it: the eye in time, its pattern, the picture
//
// Compute shaders do all of it where OpenGL has them (gl_glare.h), else the library does; where
// OpenGL is software the library is faster and comes first. Bright spots alone (OBSERVER_BILLBOARD,
// OBSERVER_HYBRID) are the library's.
#ifndef VIEWER_GLARE_H
#define VIEWER_GLARE_H

#include "app/frame_request.h"
#include "glare/gl_glare.h"

// What the library works with.
struct glare_library {
    relume_psf *psf;
    relume_glare *work;
    struct relume_image frame;  // that was looked at last
};

// Patterns that are computed once; the library shows them.
struct glare_loop {
    relume_psf_cycle *cycle;  // NULL: the eye lives on
    double seconds, squint;   // that it was made for
};

struct glare {
    const struct gl *gl;
    const struct relume_log *log;
    // To be set before the first frame:
    const struct relume_subject *subject;  // NULL: the default one
    int threads;                           // 0: all cores
    int size;                              // texels of the pattern; 0: what suits
    double field_deg;                      // to either side of it; 0: 4
    bool by_library;                       // not on the GPU

    relume_eye *eye;     // NULL: nothing was looked at yet
    double eye_s;        // of the app, that the eye has reached
    bool ready, by_gpu;  // the pattern is made, on the GPU
    unsigned parts_off;  // that it leaves out
    struct glare_library library;
    struct glare_loop loop;
    struct gl_glare card;
    struct relume_glare_params view;  // how the last frame was seen
    struct target seen;
    bool fresh;   // `seen` is what the eye sees of that frame
    bool warned;  // of pixels that are no numbers
};

void glare_begin(struct glare *glare, const struct gl *gl, const struct relume_log *log);
void glare_end(struct glare *glare);

// `frame`, linear, times the request's exposure what the scene sends, as the request's eye sees it
// now: into glare->seen. The eye lives on to request->eye_s, or its loop goes on, which takes as
// long as its patterns when it begins. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status glare_see(struct glare *glare, const struct target *frame,
                        const struct frame_request *request);

#endif
