// kernels_neon.c - NEON of 64-bit ARM: four lanes
#include "core/kernel/kernels.h"

#if defined(__aarch64__)
#include <arm_neon.h>

enum { WIDTH = 4 };
typedef float32x4_t lanes;
typedef int32x4_t whole;

static inline lanes lanes_all(float v)
{
    return vdupq_n_f32(v);
}

static inline lanes lanes_load(const void *p)
{
    return vld1q_f32(p);
}

static inline void lanes_store(float *p, lanes v)
{
    vst1q_f32(p, v);
}

// a b + c
static inline lanes lanes_madd(lanes a, lanes b, lanes c)
{
    return vfmaq_f32(c, a, b);
}

// c - a b
static inline lanes lanes_minus(lanes c, lanes a, lanes b)
{
    return vfmsq_f32(c, a, b);
}

static inline lanes lanes_min(lanes a, lanes b)
{
    return vminq_f32(a, b);
}

static inline lanes lanes_max(lanes a, lanes b)
{
    return vmaxq_f32(a, b);
}

static inline whole whole_all(int v)
{
    return vdupq_n_s32(v);
}

static inline void whole_store(int32_t *p, whole v)
{
    vst1q_s32(p, v);
}

// x < y ? a : b
static inline whole whole_where_lower(lanes x, lanes y, whole a, whole b)
{
    return vbslq_s32(vcltq_f32(x, y), a, b);
}

static inline lanes load_words(const void *p)
{
    return vcvtq_f32_u32(vmovl_u16(vld1_u16(p)));
}

static inline lanes load_bytes(const void *p)
{
    const uint32x2_t four = vld1_dup_u32(p);
    return vcvtq_f32_u32(vmovl_u16(vget_low_u16(vmovl_u8(vreinterpret_u8_u32(four)))));
}

static inline lanes load_halves(const void *p)
{
    return vcvt_f32_f16(vreinterpret_f16_u16(vld1_u16(p)));
}

#include "core/kernel/dot_lanes.h"
#include "core/kernel/nearest_lanes.h"

// Each lane adds its own terms in order, with a rounded product: no fused one here.
static void measure(double distance[TILE], const float *point, const float *tile, int dim)
{
    float64x2_t low = vdupq_n_f64(0.0), high = low;
    for (int i = 0; i < dim; i++) {
        const float64x2_t x = vdupq_n_f64((double)point[i]);
        const lanes code = lanes_load(tile + i * TILE);
        const float64x2_t a = vsubq_f64(x, vcvt_f64_f32(vget_low_f32(code)));
        const float64x2_t b = vsubq_f64(x, vcvt_high_f64_f32(code));
        low = vaddq_f64(low, vmulq_f64(a, a));
        high = vaddq_f64(high, vmulq_f64(b, b));
    }
    vst1q_f64(distance, low);
    vst1q_f64(distance + 2, high);
}

static inline void store_thirds(float *out, uint8x8_t bytes)
{
    const uint16x8_t words = vmovl_u8(bytes);
    const lanes all = lanes_all(255.0f);
    lanes_store(out, vdivq_f32(vcvtq_f32_u32(vmovl_u16(vget_low_u16(words))), all));
    lanes_store(out + 4, vdivq_f32(vcvtq_f32_u32(vmovl_u16(vget_high_u16(words))), all));
}

static void thirds(const uint8_t *in, size_t n, float *r, float *g, float *b)
{
    size_t i = 0;
    for (; i + 8 <= n; i += 8, in += 24) {
        const uint8x8x3_t rgb = vld3_u8(in);
        store_thirds(r + i, rgb.val[0]);
        store_thirds(g + i, rgb.val[1]);
        store_thirds(b + i, rgb.val[2]);
    }
    unpack_c.thirds(in, n - i, r + i, g + i, b + i);
}

static inline uint16x4_t four_codes(const uint16_t *in, float a, float b)
{
    const lanes v = vaddq_f32(vmulq_n_f32(load_words(in), a), lanes_all(b));
    const lanes cut = lanes_min(lanes_max(v, lanes_all(0.0f)), lanes_all(255.0f));
    return vmovn_u32(vcvtq_u32_f32(cut));
}

static void codes(const uint16_t *in, size_t n, float a, float b, uint8_t *out)
{
    size_t i = 0;
    for (; i + 8 <= n; i += 8) {
        const uint16x4_t low = four_codes(in + i, a, b), high = four_codes(in + i + 4, a, b);
        vst1_u8(out + i, vmovn_u16(vcombine_u16(low, high)));
    }
    unpack_c.codes(in + i, n - i, a, b, out + i);
}

const struct dot_kernels dot_neon = {dot_bytes, dot_words, dot_halves, dot_floats};
const struct nearest_kernels nearest_neon = {scan, measure};
const struct unpack_kernels unpack_neon = {thirds, codes, words_c, range_c};
#endif
