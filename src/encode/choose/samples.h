// samples.h - how many pixels learning looks at
#ifndef SELECTION_SAMPLES_H
#define SELECTION_SAMPLES_H

#include <stddef.h>

// The work of learning grows with the square of the lights.
size_t samples_enough(int lights);

#endif
