#include <relume/base.h>

unsigned relume_cpu_features(void)
{
    unsigned features = 0;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
        __builtin_cpu_supports("f16c"))
        features |= RELUME_CPU_AVX2;
#endif
    return features;
}
