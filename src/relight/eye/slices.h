// slices.h - the wave on its way through the vitreous body, from one depth to the next
//
// In a beam that converges on the retina at distance d, what stands at depth z casts its shadow as
// if it stood in the pupil, larger by d / (d - z), and a step to depth z diffracts the wave as one
// of z d / (d - z) does a parallel beam (Talanov's lens transform of the Fresnel integral). The
// last step changes phases of the transform only, which nobody sees.
#ifndef POST_SLICES_H
#define POST_SLICES_H

#include "relight/eye/aperture.h"
#include "relight/eye/pupil.h"

// Working memory for one size. Thread-safety: one thread at a time.
struct slices;
void slices_destroy(struct slices **slices);
// The wave behind the last of `planes` depths, pairs [canvas.n][canvas.n], from the drawn canvas
// (without vitreous body) times the phases exp(i phi) along each axis. It belongs to `*slices`,
// which is made when it is NULL. RELUME_ENOMEM.
relume_status slices_run(float **wave, struct slices **slices, struct canvas *canvas,
                         const float *phase, const struct relume_aperture *aperture, int planes,
                         int threads);

#endif
