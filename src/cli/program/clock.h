// clock.h - the clock, for the programs
#ifndef PROGRAM_CLOCK_H
#define PROGRAM_CLOCK_H

#include "core/base/clock.h"

#endif
