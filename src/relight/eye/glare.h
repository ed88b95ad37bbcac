// glare.h - what the steps from pattern to picture share
#ifndef POST_GLARE_H
#define POST_GLARE_H

#include <relume/relight/glare.h>

// `params` (NULL: all default) with defaults filled in. RELUME_EINVAL with a sentence.
relume_status glare_defaults(struct relume_glare_params *out,
                             const struct relume_glare_params *params);

// The pattern in pixels: three planes of (2 reach + 1)^2, each summing to 1.
struct kernel {
    int reach;
    float *v[3];
};
// The eye's pattern, the veil beyond it, or both, which sum to 1 together.
enum kernel_part { KERNEL_PATTERN = 1, KERNEL_VEIL = 2, KERNEL_ALL = 3 };
relume_status kernel_create(struct kernel *out, const relume_psf *psf, double pixel,
                            enum kernel_part part, const struct relume_glare_params *params);
void kernel_destroy(struct kernel *kernel);

// Light of one place: in pixels from the frame's left and top edge, centres at + 0.5.
struct source {
    float x, y, rgb[3];
};
struct sources {
    struct source *source;  // by rows, from the top
    int count;
};
// The luminance of which at most `most` pixels of in[height][width][3] have more; infinite when
// the brightest are too many.
double sources_threshold(const float *in, size_t pixels, int most);
// Every pixel's light beyond that luminance, as a source each or one for every connected spot; it
// is taken out of `rest`, which is a copy of the frame. RELUME_ENOMEM.
relume_status sources_find(struct sources *out, float *rest, int width, int height,
                           double threshold, bool spots);
void sources_destroy(struct sources *sources);
// out[height][width][3] += every source through the kernel.
relume_status sources_splat(float *out, int width, int height, const struct sources *sources,
                            const struct kernel *kernel, int threads);

// Convolution of pictures of one size, in tiles where they are large. Keeps the spectrum of the
// last picture. Thread-safety: one thread at a time.
typedef struct convolver convolver;
relume_status convolver_create(convolver **out, int width, int height, int reach,
                               enum relume_glare_border border, int threads);
// The same in tiles of that side, or more where the kernel is large.
relume_status convolver_create_tiled(convolver **out, int width, int height, int reach,
                                     enum relume_glare_border border, int threads, int side);
void convolver_destroy(convolver **c);
// Whether it is for such pictures.
bool convolver_fits(const convolver *c, int width, int height, int reach,
                    enum relume_glare_border border, int threads);
// out[height][width][3] = in * kernel; `same` promises that `in` is as it was. RELUME_ENOMEM.
relume_status convolver_run(convolver *c, float *out, const float *in, bool same,
                            const struct kernel *kernel);

// ---------------------------------------------------------------- glare_veil.c

struct veil_work {
    convolver *convolver;
};
// The glare of what is not a source, at a quarter of the resolution: `out` is the frame `in`
// without its sources and becomes what is seen of it, and the far veil of everything is added.
relume_status veil_add(float *out, struct veil_work *work, const float *in, int width, int height,
                       const relume_psf *psf, double pixel,
                       const struct relume_glare_params *params);
void veil_destroy(struct veil_work *work);

#endif
