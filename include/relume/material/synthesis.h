// synthesis.h - more of a texture: its regular structure, and maps that say which of its texels
// lies where on a larger picture (Meseth, "Towards Predictive Rendering in Virtual Reality", Bonn
// 2008, chapter 4)
//
// A map is numbers of texels, so that it serves pictures, BTFs and all of their models alike.
// Texels are counted from the top left, x right, y down.
#ifndef RELUME_SYNTHESIS_H
#define RELUME_SYNTHESIS_H

#include <relume/base.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// ---------------------------------------------------------------- samples

// The piece of a texture that there is: a few numbers for each texel, in which equal steps are
// about equally visible, from 0 to 1 or smaller; the first channel says most. Borrowed by what it
// is given to. Textures of fewer than 8 x 8 texels, of more than 16 channels and with values that
// are not finite are refused (RELUME_EUNFIT).
struct relume_texture {
    int width, height;
    int channels;  // [1, 16]; synthesis compares the first 8
    float *value;  // [height][width][channels]
};
// Y, Cr and Cb (Rec. 601) of a linear picture in display coding; grey pictures have Y alone.
// RELUME_EINVAL, RELUME_EUNFIT for values that are not finite, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_texture_of_image(struct relume_texture *out,
                                                    const struct relume_image *image,
                                                    const struct relume_log *log);
RELUME_API void relume_texture_destroy(struct relume_texture *texture);

// ---------------------------------------------------------------- regular structure

// One wave: Re(F exp(2 pi i (x b_x / width + y b_y / height))) at texel (x, y) of the sample.
struct relume_wave {
    int channel;
    double x, y;    // b: periods across the sample, down the sample; x >= 0
    double re, im;  // F, in steps of 1/255 of the channel
    double above;   // power over what its surroundings in the spectrum have; 0: the mean
};

// The structure that repeats in a sample.
struct relume_regular_info {
    int count;                       // of waves
    const struct relume_wave *wave;  // the means first, then by falling size
    bool regular;                    // whether there is a structure that repeats
    double share;  // of the sample's variance that the waves of the structure explain
    // Periods of the structure across and down the sample, at least 2, all waves being whole
    // multiples; 0: nothing changes that way, or there are no such numbers (`common` false).
    double base[2];
    bool common;  // the waves have a common base
    double rms;   // of what the waves do not explain, 1/255
    int found;    // waves before those of the structure were chosen, the means left out, ...
    double rms_found, rms_fitted;  // ... and what these left, one by one and fitted together
};

// Never changes. Thread-safety: safe.
typedef struct relume_regular relume_regular;

struct relume_regular_params {  // zero in a field means its default
    size_t struct_size;         // filled by the macro (base.h)
    const struct relume_log *log;
    double threshold;  // size of the smallest wave, 1/255; default 1; [0.1, 255]
    int most;          // waves of a channel; default 64; [1, 256]
    bool all;          // keep every wave as found, whether it is of a structure or not
    int threads;       // default: all cores
};
#define relume_regular_params(...)                                                                 \
    (&(const struct relume_regular_params){RELUME_SIZED(relume_regular_params), __VA_ARGS__})

// The waves of which the texture's structure is made, by fractional Fourier analysis of the first
// three channels. A texture that repeats nothing has `regular` false and the means alone.
// RELUME_EINVAL (parameters), RELUME_EUNFIT (texture), RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_regular_find(relume_regular **out,
                                                const struct relume_texture *texture,
                                                const struct relume_regular_params *params);
RELUME_API void relume_regular_destroy(relume_regular **regular);
// Belongs to `regular`.
RELUME_API const struct relume_regular_info *relume_regular_info(const relume_regular *regular);

// The structure alone, over width x height texels from the sample's upper left corner on, however
// large: a picture of its first channels (1 or 3), as values of the texture. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_regular_mask(struct relume_image *out,
                                                const relume_regular *regular, int width,
                                                int height, int threads);

// ---------------------------------------------------------------- maps

// Methods that grow a map from a sample.
enum relume_grow_method {
    RELUME_GROW_PATCH = 0,  // squares joined along the cuts that show least
    RELUME_GROW_PIXEL,      // texel by texel, from coarse to fine, by what stands around
};

struct relume_grow_params {  // zero in a field means its default
    size_t struct_size;      // filled by the macro (base.h)
    const struct relume_log *log;
    enum relume_grow_method method;
    uint64_t seed;  // equal seeds give equal maps, whatever the thread count
    bool tile;      // the map goes on at its other side
    // What must stay where it belongs, or NULL.
    const relume_regular *regular;
    double weight;  // of the structure beside the texels; default 1; [0.01, 100]
    int threads;    // default: all cores
    // PATCH: side of a square, texels, even; default: two periods of the structure, at least a
    // sixth of the sample; without a structure a third; [4, 256]
    int patch;
    // PIXEL:
    int neighbourhood;  // side of what is compared, odd; default 5; [3, 9]
    int alike;          // k: texels that look alike and are tried, with itself; default 2; [1, 8]
    int levels;         // each half as fine, as many as the sample has; default 5; [1, 8]
};
#define relume_grow_params(...)                                                                    \
    (&(const struct relume_grow_params){RELUME_SIZED(relume_grow_params), __VA_ARGS__})

// Fill texel[height][width] with numbers y * texture->width + x. RELUME_EINVAL (parameters),
// RELUME_EUNFIT (texture), RELUME_ELIMIT (size), RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_texture_grow(uint32_t *texel, int width, int height,
                                                const struct relume_texture *texture,
                                                const struct relume_grow_params *params);

// The picture that a map makes of a sample of that size. RELUME_EINVAL where the map names texels
// that the sample has not, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_texture_apply(struct relume_image *out, const uint32_t *texel,
                                                 int width, int height,
                                                 const struct relume_image *sample, int threads);

// ---------------------------------------------------------------- how good a map is

// Measures of how well a grown map resembles its sample.
struct relume_grow_quality {
    // The highest correlation of the map with itself moved, without its regular structure and
    // beyond what is near; 1 for the sample laid side by side.
    double repetition;
    int repetition_at[2];  // the move, texels
    // Mean distance of neighbourhoods of 5 x 5 texels to the nearest of the sample, over that of
    // the sample's own to the nearest elsewhere in it: 0 for copies, 1 for a new piece of the same
    // texture, more where neighbourhoods have nothing like them in the sample.
    double novelty;
    double worst;     // the same of the worst twentieth
    double coverage;  // share of the sample's texels that the map uses
    double cuts;      // share of neighbours in the map that are none in the sample
};
// Parameters of relume_grow_judge; 0 is the default of each field.
struct relume_grow_quality_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const relume_regular *regular;  // taken off before repetition is measured, or NULL
    int threads;                    // default: all cores
};
#define relume_grow_quality_params(...)                                                            \
    (&(const struct relume_grow_quality_params){RELUME_SIZED(relume_grow_quality_params),          \
                                                __VA_ARGS__})
// Of any map, those of others and plain tiling too. RELUME_EINVAL, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_grow_judge(struct relume_grow_quality *out,
                                              const uint32_t *texel, int width, int height,
                                              const struct relume_texture *texture,
                                              const struct relume_grow_quality_params *params);

#ifdef __cplusplus
}
#endif
#endif
