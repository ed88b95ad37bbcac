// kernels.c - the table of instruction sets, fastest first
#include "core/kernel/kernels.h"

#include "core/kernel/lsq_kernels.h"

enum { AVX512 = RELUME_CPU_AVX2 | RELUME_CPU_AVX512 };

// clang-format off
static const struct kernels table[] = {
#if defined(__x86_64__)
    {"avx512", AVX512, &dot_avx512, look_up_avx2, &nearest_avx512, &unpack_avx2, &psf_avx512, &turn_avx512, &lsq_kernels_avx512},
    {"avx2", RELUME_CPU_AVX2, &dot_avx2, look_up_avx2, &nearest_avx2, &unpack_avx2, &psf_avx2, &turn_avx2, &lsq_kernels_avx2},
#elif defined(__aarch64__)
    {"neon", RELUME_CPU_NEON, &dot_neon, look_up_c, &nearest_neon, &unpack_neon, &psf_c, &turn_c, &lsq_kernels_plain},
#endif
    {"plain", 0, &dot_c, look_up_c, &nearest_c, &unpack_c, &psf_c, &turn_c, &lsq_kernels_plain},
};
// clang-format on

const struct kernels *kernels_choose(unsigned cpu_off)
{
    const unsigned features = relume_cpu_features() & ~cpu_off;
    const struct kernels *row = table;
    while (row->needs & ~features)
        row++;
    return row;
}
