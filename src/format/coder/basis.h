// basis.h - the inside of a coder, for the files basis_*.c
//
// A basis fills in three functions (struct relume_basis): evaluate gives its K functions at a
// direction; prepare builds private data and, when encoding, the map from the N captured samples
// to the K coefficients. Least-squares bases call fit_map for that.
#ifndef CODER_BASIS_H
#define CODER_BASIS_H

#include "core/math/vec.h"
#include "format/coder/coding.h"

#include <relume/format/coder.h>

// The captured lights as a triangulated sphere (mesh.c).
typedef struct mesh mesh;

struct relume_coder {
    struct relume_coder_info info;
    vec3 *world;       // [lights]
    vec3 *frame;       // [lights], in the pole's frame
    float *transform;  // [K][functions], joint [3][K][functions], or NULL
    float *mean;       // joint: [3][functions], or NULL
    float *map;        // coefficients = map x samples + base; [K][lights], joint [K][3][lights];
                       // NULL when only decoding
    float *base;       // joint: [K]
    struct robust *robust;                 // or NULL: plain least squares
    const struct relume_samples *samples;  // while being prepared
    int threads;                           // for that
    bool decode, force, no_ridge;
    void *interpolant;  // data of info.interpolant
    struct relume_captured_region zone;
    mesh *around;  // of the lights, where the interpolant has none and extrapolates; or NULL
    void *data;    // the basis's own
};

// Of bases that can have any number of coefficients.
static inline bool basis_takes_any(int count)
{
    return count >= 1 && count <= RELUME_MOST_COEFFICIENTS;
}

// The functions of a basis that interpolates.
void coder_interpolate(const relume_coder *coder, struct relume_vec3 light, double *values);

// Pixels that are multiplied by the map at once.
enum { CODER_CHUNK = 1024 };
// As relume_coder_apply for at most CODER_CHUNK pixels, with coder_work floats at `work`.
size_t coder_work(const relume_coder *coder);
void coder_apply(const relume_coder *coder, const float *samples, size_t stride, size_t n,
                 float *planes, size_t plane_stride, float *work);
// The same for samples that lie in `work` as [channel][light][pixel]; they are lost.
void coder_apply_separated(const relume_coder *coder, size_t n, float *planes, size_t plane_stride,
                           float *work);

// samples[light][pixel][channel] -> to[channel][light][pixel], lights `stride` apart.
void coder_separate(float *to, const float *samples, size_t stride, int lights, size_t n);
// The same; luminance coders: the luminances [light][pixel], and the
// pixels' colours into their planes.
void coder_part(const relume_coder *coder, float *parted, const float *samples, size_t stride,
                size_t n, float *planes, size_t plane_stride);

// The stored functions at some lights: basis[3][lights][K] and constant[3][lights].
struct captured {
    int lights;
    float *basis, *constant;
};
relume_status captured_create(struct captured *out, const relume_coder *coder,
                              const struct relume_vec3 *directions, int n);
void captured_destroy(struct captured *c);
// What `n` pixels of coefficients say for those lights, one channel: out[light * n + pixel].
void captured_predict(const struct captured *c, const relume_coder *coder, int channel,
                      const float *planes, size_t plane_stride, size_t n, float *out);

// Mean squared error of each light predicted from the others, never 0 (choose.c).
void predict_errors(double *error, const double *b, const double *gram, int lights);

// Refits coefficients that are there already (robust.c); `separated` as [channel][light][pixel],
// luminance coders: the first channel. It needs robust_work doubles at `work`.
relume_status robust_create(struct robust **out, const relume_coder *coder);
void robust_destroy(struct robust *r);
size_t robust_work(const struct robust *r);
void robust_apply(const struct robust *r, const relume_coder *coder, const float *separated,
                  size_t n, float *planes, size_t plane_stride, double *work);

// Regularised least squares on the captured directions, for bases with smooth functions:
// fills coder->map and coder->transform. `roughness[K]` is what the ridge multiplies.
relume_status fit_map(relume_coder *coder, const double *roughness, const struct relume_log *log);

// vectors[count][lights], the leading eigenvectors of the Gram matrix of the samples' images, the
// largest first (basis_eigen.c): of that matrix, and by Lanczos's method. RELUME_ENOMEM.
relume_status eigen_by_gram(double *vectors, int count, const struct relume_samples *s,
                            int threads);
relume_status eigen_by_steps(double *vectors, int count, const struct relume_samples *s,
                             int threads);

// Interpolation weights of the captured lights, at most three.
struct blend {
    int count;
    int light[3];
    double weight[3];
};

relume_status mesh_create(mesh **out, const vec3 *lights, int n);
void mesh_destroy(mesh **m);
// `d` unit, in the frame of the lights. Always sums to 1; outside the captured region the weights
// are those of its border.
struct blend mesh_blend(const mesh *m, vec3 d);
struct relume_coder_triangles mesh_triangles(const mesh *m);
// The direction that is farthest from every light, as near to the south pole as may be. Gaps
// between the lights of real domes are below 40 degrees: one of MESH_WIDE was not captured.
static const double MESH_WIDE = M_PI / 3.0;
vec3 mesh_widest_gap(const vec3 *lights, int n, double *angle);

// The direction at which the basis is really evaluated: below the horizon of a hemispherical
// capture that is the horizon at the same azimuth.
vec3 clamp_to_captured(bool hemispherical, vec3 d);

#endif
