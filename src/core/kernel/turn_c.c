// turn_c.c - rotations between constraints for the baseline: the reference
#include "core/kernel/turn_blocks.h"

const struct turn_kernels turn_c = {turn_sum, turn_rotation};
