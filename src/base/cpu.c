// cpu.c - what the processor can do, asked once
#include <relume/base.h>

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#if defined(__x86_64__)
#include <cpuid.h>

// clang 14 does not know this one by name. Asking takes 20 us in a virtual machine, so the answer,
// which cannot change, is kept.
static bool has_f16c(void)
{
    static atomic_int known;  // 0: not asked yet; 1: no; 2: yes
    int answer = atomic_load_explicit(&known, memory_order_relaxed);
    if (!answer) {
        unsigned a, b, c = 0, d;
        answer = 1 + (__get_cpuid(1, &a, &b, &c, &d) && (c & bit_F16C));
        atomic_store_explicit(&known, answer, memory_order_relaxed);
    }
    return answer == 2;
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
