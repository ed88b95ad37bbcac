// turn_avx512.c - rotations between constraints, compiled for AVX-512
#include "core/kernel/kernels.h"

#if defined(__x86_64__)
#include "core/kernel/turn_blocks.h"

const struct turn_kernels turn_avx512 = {turn_sum, turn_rotation};
#endif
