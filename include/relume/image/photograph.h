// photograph.h - one photograph as linear light, and what the camera noted about it
#ifndef RELUME_PHOTOGRAPH_H
#define RELUME_PHOTOGRAPH_H

#include <relume/base.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// What the file says. Zero in a field: not noted. Thread-safety: plain data.
struct relume_exif {
    int width, height;   // as shown: after turning by the orientation
    double time_s;       // shutter
    double f_number;     // aperture
    double iso;          // sensitivity
    double focal_mm;     // focal length of the lens
    double focal_35mm;   // the same for a frame of 36 x 24 mm
    int64_t taken_s;     // by the camera's clock, in seconds since 1970
    int orientation;     // EXIF 2.3: 1 to 8
    bool linear;         // code values are linear light: floats, RAW, or the file says so
    bool bytes, floats;  // 8-bit integers; floating point, which does not end at 1
    bool profile;        // an embedded matrix ICC profile says what code values mean
    float to_srgb[9];    // its linear light -> linear sRGB; the identity where there is none
    char camera[64];     // maker and model
};

// Read only the header. Returns an input status, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_exif_read(struct relume_exif *out, const char *path,
                                             const struct relume_log *log);
// How much light the sensor counted, for comparison between photographs of one scene: shutter time
// x ISO / 100 / aperture^2; what is not noted counts as 1. Zero when the shutter is not noted.
RELUME_API double relume_exif_exposure(const struct relume_exif *notes);

// The photographs that somebody named. Thread-safety: plain data.
struct relume_photographs {
    int count;
    char **path;   // [count]
    char *mask;    // the last that its name calls a mask, else NULL
    char *lights;  // the only .lp file beside them, else the only text that by its name is a list
                   // of light directions (light_directions.txt, lights.txt ...); NULL: none
};
struct relume_photographs_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    bool folders;      // keep folders inside folders: they hold the photographs of one camera each
    bool by_products;  // keep pictures whatever their names say
    bool quiet;        // no note
    bool companions;   // `mask` and `lights` are used: the note does not call them left out
    int least;         // fewer than these are none where a folder below has more; 0: 1
    const char *command;  // what a sentence that names a folder says before it and "-o DIR"; NULL:
                          // "give"
};
#define relume_photographs_params(...)                                                             \
    (&(const struct relume_photographs_params){RELUME_SIZED(relume_photographs_params),            \
                                               __VA_ARGS__})

// What `n` paths name: files, and what folders hold in the order of names. Left out, and named in
// one note, is what both first bytes and name say is no photograph (texts, archives, videos), what
// relume wrote, and beside other pictures those named as their mask, depth, normals, disparity or
// albedo. RELUME_ENOTFOUND where a path does not exist or no photograph is left; the sentence names
// the folders below that have some. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_photographs_list(struct relume_photographs *out,
                                                    const char *const *paths, int n,
                                                    const struct relume_photographs_params *params);
// Free what relume_photographs_list has put into `list`, which is empty afterwards.
RELUME_API void relume_photographs_free(struct relume_photographs *list);

// Photographs of one scene that follow each other: group[i] counts from 0 in the order of time (of
// the list where no times are noted). A new group begins after a pause of more than `pause_s`
// beyond the exposure itself (0: 10 s), when the camera or size changes, and when an exposure
// comes again. Returns the number of groups, 0 when memory is short.
RELUME_API int relume_exif_brackets(int *group, const struct relume_exif *notes, int n,
                                    double pause_s);

// How a photograph is read. Borrowed during the call.
struct relume_photograph_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    struct relume_transfer transfer;  // overrides what the file says of itself
    bool codes;  // keep code values, 1 is full scale, as the camera's response made them; turned
                 // but neither linearised nor brought to other primaries
    bool not_turned;  // leave the orientation alone
    int orientation;  // turn by this one, 1 to 8, in place of what the camera noted; 0: its own
};
#define relume_photograph_params(...)                                                              \
    (&(const struct relume_photograph_params){RELUME_SIZED(relume_photograph_params), __VA_ARGS__})

// Read a photograph (JPEG, PNG, TIFF, EXR, HDR, camera RAW where the installed OpenImageIO reads
// it), three channels, turned upright, linear with sRGB primaries: an embedded matrix ICC profile
// is followed (ICC.1:2010 with Bradford adaptation), others are named in a warning and treated as
// sRGB. `notes` may be NULL. An input status (also for NaN and infinity), RELUME_ENOMEM.
RELUME_RESULT relume_status relume_photograph_load(struct relume_image *out,
                                                   struct relume_exif *notes, const char *path,
                                                   const struct relume_photograph_params *params);

// ---- the light's colour, and its fall-off across the picture; all in place, on linear images

// Gains for red, green and blue that make the mean of a rectangle grey and keep its luminance
// (BT.709). RELUME_EINVAL when it does not lie inside, RELUME_EUNFIT when a channel is black there
// or more than a tenth of it clips at 1.
RELUME_RESULT relume_status relume_white_measure(float gain[3], const struct relume_image *image,
                                                 int x, int y, int width, int height,
                                                 const struct relume_log *log);
// pixel = gain pixel, for each channel.
RELUME_API void relume_white_apply(struct relume_image *image, const float gain[3]);
// pixel = m pixel, m row by row: notes.to_srgb for what was merged from code values.
RELUME_API void relume_primaries_apply(struct relume_image *image, const float m[9]);

// Fall-off as an even polynomial of the distance r from the centre, r = 1 in the corners:
// 1 + k[0] r^2 + k[1] r^4 + k[2] r^6, one for all channels.
struct relume_falloff {
    double center[2];  // pixels
    double k[3];       // the coefficients
};
// Least squares on the luminance of a photograph of an evenly lit surface. RELUME_EUNFIT when it is
// black or the fit falls below 0.05 inside the picture, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_falloff_fit(struct relume_falloff *out,
                                               const struct relume_image *flat,
                                               const struct relume_log *log);
// Divide a linear image by the polynomial.
RELUME_API void relume_falloff_divide(struct relume_image *image,
                                      const struct relume_falloff *falloff);
// The same per pixel: divide by the flat field, smoothed over 1/64 of the width against its noise
// and scaled to a mean of 1 per channel. RELUME_EINVAL for other sizes, RELUME_EUNFIT where it is
// black, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_flat_divide(struct relume_image *image,
                                               const struct relume_image *flat,
                                               const struct relume_log *log);

#ifdef __cplusplus
}
#endif
#endif
