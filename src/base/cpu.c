// cpu.c - what the processor can do, asked once
#include <relume/base.h>

#include <stdlib.h>
#include <string.h>
#if defined(__x86_64__)
#include <cpuid.h>

// clang 14 does not know this one by name.
static bool has_f16c(void)
{
    unsigned a, b, c = 0, d;
    return __get_cpuid(1, &a, &b, &c, &d) && (c & bit_F16C);
}
#endif

unsigned relume_cpu_features(void)
{
    unsigned features = 0;
    const char *most = getenv("RELUME_CPU");
    if (most && strcmp(most, "plain") == 0)
        return 0;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && has_f16c())
        features |= RELUME_CPU_AVX2;
#endif
    return features;
}
