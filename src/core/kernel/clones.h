// clones.h - functions that the compiler makes a second time for AVX2
//
// A program takes the second where the processor has it, from when it starts. Both have equal bits:
// nothing is fused, and sums run over lanes in memory.
#ifndef KERNEL_CLONES_H
#define KERNEL_CLONES_H

#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) &&       \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CLONED_FOR_AVX2 __attribute__((target_clones("avx2", "default")))
#else
#define CLONED_FOR_AVX2
#endif

#endif
