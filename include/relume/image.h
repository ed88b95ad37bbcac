// image.h - float images, their files, and how far apart two of them are
#ifndef RELUME_IMAGE_H
#define RELUME_IMAGE_H

#include <relume/base.h>
#include <relume/context.h>

#ifdef __cplusplus
extern "C" {
#endif

// Interleaved float samples, row 0 at the top, no padding. Colour is linear with sRGB primaries
// unless a name says otherwise. Thread-safety: plain data.
struct relume_image {
    int width, height;
    int channels;   // 1: grey, depth or mask; 3: red, green, blue
    float *data;    // [height][width][channels], from malloc, ...
    size_t mapped;  // ... or that many bytes of a temporary file; else 0
};

// Zero-filled; `*out` is empty on failure. RELUME_EINVAL for sizes below 1, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_image_create(struct relume_image *out, int width, int height,
                                                int channels);
RELUME_API void relume_image_destroy(struct relume_image *image);

// Where a picture lies in a frame, or a part in a picture, pixels.
struct relume_rect {
    int left, top, width, height;
};

// How code values in a file relate to linear light.
enum relume_curve {
    RELUME_CURVE_AUTO = 0,  // float files linear, integer files sRGB unless they say otherwise
    RELUME_CURVE_LINEAR,
    RELUME_CURVE_SRGB,      // IEC 61966-2-1, continued above 1 and mirrored below 0
    RELUME_CURVE_GAMMA,     // code = linear^(1/gamma)
    RELUME_CURVE_RESPONSE,  // a camera's, measured (relume/image/response.h)
    RELUME_CURVE_LOG,  // code = ln(1 + linear / delta) / ln(1 + 1 / delta): black is 0, white 1
};
struct relume_response;
// What code values mean. All zero: as the file says. Plain data; `response` is borrowed.
struct relume_transfer {
    enum relume_curve curve;  // which curve
    float gamma;  // RELUME_CURVE_GAMMA: (0.1, 10]; RELUME_CURVE_LOG: its delta, [1e-6, 1]
    const struct relume_response *response;  // only for RELUME_CURVE_RESPONSE, borrowed
};

// "linear", "srgb", "gamma:2.2" or "log:0.001". RELUME_EINVAL when `text` is none of these.
RELUME_RESULT relume_status relume_transfer_parse(struct relume_transfer *out, const char *text);
// The inverse; writes at most `size` bytes, always terminated.
RELUME_API void relume_transfer_text(struct relume_transfer transfer, char *text, size_t size);
// Code value -> linear light and back. AUTO behaves as SRGB. Of a response the green curve counts,
// for pictures each channel's own.
RELUME_API float relume_transfer_decode(struct relume_transfer transfer, float code);
// The code of a linear value; the inverse of relume_transfer_decode.
RELUME_API float relume_transfer_encode(struct relume_transfer transfer, float linear);

// How pictures are loaded and saved. Borrowed during the call.
struct relume_image_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    struct relume_transfer transfer;  // loading: overrides what the file's type implies
    const struct relume_limits *limits;
    int channels;  // loading: 1, 3 or 4, converted to; default 3. Grey is spread; alpha is
                   // dropped but with 4, where it is 1 in pictures that have none
    bool half;     // saving EXR: half instead of float samples
    int threads;   // saving EXR and PNG: worker threads; default: one
    const struct relume_reader *reader;  // loading: read this in place of the file; `path` is only
                                         // a name, or NULL
    const struct relume_writer
        *writer;   // saving: write here; `path` is a name that says the format
    bool profile;  // saving .jpg and .tif: with an ICC profile of sRGB (PNG always says sRGB)
    int bits;      // saving .png and .tif: 8 or 16 a sample; default 8
    bool codes;    // saving integers: samples are values in [0, 1], not light to be sRGB-coded
};
#define relume_image_params(...)                                                                   \
    (&(const struct relume_image_params){RELUME_SIZED(relume_image_params), __VA_ARGS__})

// Read `path` (any format OpenImageIO knows) as linear light. Returns an input status,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_image_load(struct relume_image *out, const char *path,
                                              const struct relume_image_params *params);
// Write linear `image` in the format of the file name's extension: EXR, HDR, PFM linear, every
// other sRGB-coded and clipped to [0, 1], 8 bits unless `bits` says 16. A
// device or pipe without an extension gets EXR. A fourth channel is alpha, in .png and .exr only.
// The file appears under its name whole or not at all. Returns RELUME_EINVAL for an unknown
// extension, RELUME_EIO.
RELUME_RESULT relume_status relume_image_save(const struct relume_image *image, const char *path,
                                              const struct relume_image_params *params);

// Whether relume_image_save has a format for that name's ending: .exr, .hdr, .rgbe, .pfm, .png,
// .jpg, .jpeg, .jpe, .tif, .tiff, .bmp, .tga, .targa, .ppm, .pnm, .webp, .jp2, .j2k, .avif, .heic,
// .heif; devices without an ending get OpenEXR.
RELUME_API bool relume_image_can_save(const char *path);

// Whether relume_image_save writes pictures of four channels under that name: .png and .exr.
RELUME_API bool relume_image_saves_alpha(const char *path);

// Whether relume_image_save would write linear light under that name.
RELUME_API bool relume_image_saves_linear(const char *path);

// How a picture is looked at between its texels. Reduced, all but NEAREST show the mean of what a
// pixel covers, in linear light.
enum relume_filter {
    RELUME_FILTER_DEFAULT = 0,  // LINEAR
    RELUME_FILTER_NEAREST,      // one texel, however large a pixel is
    RELUME_FILTER_LINEAR,
    RELUME_FILTER_CUBIC,  // enlarged: Catmull-Rom, within the range of the texels around
};

// How pictures are scaled. Borrowed during the call.
struct relume_scale_params {
    size_t struct_size;  // filled by the macro (base.h)
    int threads;         // default: all cores
    enum relume_filter filter;
    bool wrap;  // the left border goes on at the right one
    int tiles;  // that many pictures side by side do not mix at their borders; default 1
    // What of the image becomes the picture, pixels: left, top, width, height; default: all of it.
    // Not with `wrap` and `tiles`. Pixels beside it count where a mean reaches them.
    double from[4];
};
#define relume_scale_params(...)                                                                   \
    (&(const struct relume_scale_params){RELUME_SIZED(relume_scale_params), __VA_ARGS__})

// Create `*out`: the whole of `image`, or a part, in another size. The same size gives the same
// values.
// RELUME_EINVAL, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_image_scale(struct relume_image *out,
                                               const struct relume_image *image, int width,
                                               int height,
                                               const struct relume_scale_params *params);

// How far `image` is from `reference`. All but rms and max_abs are of display values:
// coded by `display`, clipped to [0, 1].
struct relume_difference {
    double rms;      // linear, all channels
    double max_abs;  // linear
    double psnr_db;  // of the RGB MSE with both sides rounded to 8 bits; at most 200
    double mse;      // display, unrounded
    double ssim;     // Wang et al. 2004: luma, 11x11 Gaussian, sigma 1.5
    double delta_e;  // mean CIEDE2000 (Sharma, Wu, Dalal 2005), D65
    size_t pixels;   // pixels compared
};
struct relume_compare_params {
    size_t struct_size;               // filled by the macro (base.h)
    const struct relume_image *mask;  // one channel, compare where > 0.5; NULL: everywhere
    struct relume_transfer display;   // default sRGB
    int threads;                      // default: all cores
    bool no_ssim, no_delta_e;         // leave these out (NaN), they take most of the time
};
#define relume_compare_params(...)                                                                 \
    (&(const struct relume_compare_params){RELUME_SIZED(relume_compare_params), __VA_ARGS__})

// Both images must have 3 channels and equal sizes, else RELUME_EINVAL. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_image_compare(struct relume_difference *out,
                                                 const struct relume_image *image,
                                                 const struct relume_image *reference,
                                                 const struct relume_compare_params *params);

// Contours in smooth ramps (Wong 1998, Fig 9-11): what codes do to slopes that are too gentle to
// hide them. Display luma of both images is smoothed (Gaussian, sigma 2 pixels: noise averages out
// for the eye as well). Ramps are the pixels where the reference's slope is 0.2 to 4 of 255 levels
// a pixel and changes by at most 0.25 levels from pixel to pixel.
struct relume_ramps {
    double error;   // mean squared difference of the slopes, (levels of 255 a pixel)^2
    double slope;   // mean square of the reference's slopes
    size_t pixels;  // of ramps
};
// Both images must have 3 channels and equal sizes, else RELUME_EINVAL. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_image_ramps(struct relume_ramps *out,
                                               const struct relume_image *image,
                                               const struct relume_image *reference,
                                               const struct relume_compare_params *params);

#ifdef __cplusplus
}
#endif
#endif
