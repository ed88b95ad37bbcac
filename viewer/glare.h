// glare.h - the frame as a living eye sees it: the eye in time, its pattern, the picture
//
// Compute passes do all of it where OpenGL has them (gl_glare.h), else the library does; where
// OpenGL is software the library is faster and comes first.
#ifndef VIEWER_GLARE_H
#define VIEWER_GLARE_H

#include "app.h"
#include "target.h"

struct glare {
    const struct gl *gl;
    const struct relume_log *log;
    // To be set before the first frame:
    const struct relume_subject *subject;  // NULL: the default one
    int threads;                           // 0: all cores
    int size;                              // texels of the pattern; 0: what suits
    bool by_library;                       // not by passes

    relume_eye *eye;  // NULL: nothing was looked at yet
    double eye_s;     // of the app, that the eye has reached
    relume_psf *psf;
    unsigned parts_off;  // that `psf` leaves out
    relume_glare *work;
    struct relume_image frame;        // that was looked at last
    struct relume_glare_params view;  // and how
    struct target seen;
    bool fresh, warned;
};

void glare_begin(struct glare *glare, const struct gl *gl, const struct relume_log *log);
void glare_end(struct glare *glare);

// `frame`, linear, times `exposure` what the scene sends, as the app's eye sees it now: into
// glare->seen. The eye lives on to app->eye_s. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status glare_see(struct glare *glare, const struct target *frame, const struct app *app,
                        double exposure);

#endif
