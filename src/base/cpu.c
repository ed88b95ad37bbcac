#include <relume/base.h>

#include <stdlib.h>
#include <string.h>

unsigned relume_cpu_features(void)
{
    unsigned features = 0;
    const char *most = getenv("RELUME_CPU");
    if (most && strcmp(most, "plain") == 0)
        return 0;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
        __builtin_cpu_supports("f16c"))
        features |= RELUME_CPU_AVX2;
#endif
    return features;
}
