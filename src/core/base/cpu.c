// cpu.c - what the processor can do, asked once
#include "core/base/log.h"

#include <relume/base.h>

#include <stdlib.h>
#include <string.h>
#if defined(__x86_64__)
#include <cpuid.h>
#include <stdatomic.h>

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

// What RELUME_CPU may say.
static const struct {
    const char *name;
    unsigned features;
} named[] = {
    {"plain", 0},
    {"avx2", RELUME_CPU_AVX2},
    {"avx512", RELUME_CPU_AVX2 | RELUME_CPU_AVX512},
    {"neon", RELUME_CPU_NEON},
};

static unsigned features_here(void)
{
    unsigned features = 0;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && has_f16c())
        features |= RELUME_CPU_AVX2;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        features |= RELUME_CPU_AVX512;
#elif defined(__aarch64__)
    features |= RELUME_CPU_NEON;
#endif
    return features;
}

// Of the set that the environment asks for; all where it names none.
static unsigned features_wanted(bool *known)
{
    const char *name = getenv("RELUME_CPU");
    const bool asked = name && *name;
    *known = !asked;
    for (size_t i = 0; asked && i < sizeof named / sizeof *named; i++)
        if ((*known = strcmp(name, named[i].name) == 0))
            return named[i].features;
    return ~0u;
}

unsigned relume_cpu_features(void)
{
    bool known;
    return features_here() & features_wanted(&known);
}

relume_status relume_cpu_check(const struct relume_log *log)
{
    bool known;
    const unsigned wanted = features_wanted(&known), here = features_here();
    if (known && (wanted == ~0u || !(wanted & ~here)))
        return RELUME_OK;
    return log_fail(
        log, RELUME_EINVAL, "RELUME_CPU: expected plain%s%s%s on this processor; found %s",
        here & RELUME_CPU_AVX2 ? ", avx2" : "", here & RELUME_CPU_AVX512 ? ", avx512" : "",
        here & RELUME_CPU_NEON ? ", neon" : "", getenv("RELUME_CPU"));
}
