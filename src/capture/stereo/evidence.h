// evidence.h - what each sample of a pixel counts
#ifndef STEREO_EVIDENCE_H
#define STEREO_EVIDENCE_H

#include "capture/stereo/pixel.h"

// Fill scratch->base and `middle`: relative errors count, of dark samples little, of unknown ones
// nothing. False where all is black.
bool evidence_begin(struct stereo_pixel *pixel, struct stereo_scratch *scratch);
// scratch->weight from what scratch->expected misses.
void evidence_weigh(const struct stereo_pixel *pixel, struct stereo_scratch *scratch);
// What is missed, 0 to 1: no sample adds more than one that is wholly missed.
float evidence_miss(const struct stereo_pixel *pixel, const struct stereo_scratch *scratch);

#endif
