// frame.h - a file, a camera and lights become one picture
#ifndef RELUME_FRAME_H
#define RELUME_FRAME_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/image.h>
#include <relume/light.h>
#include <relume/pack.h>

#ifdef __cplusplus
extern "C" {
#endif

// How a slab's cameras become one ray.
enum relume_interpolation {
    RELUME_INTERPOLATE_DEFAULT = 0,  // by depth where disparities are given, else linear
    RELUME_INTERPOLATE_CONSTANT,     // the nearest camera
    RELUME_INTERPOLATE_LINEAR,       // quadralinear: four cameras, all looking at the st plane
    RELUME_INTERPOLATE_DEPTH,        // four cameras, each where it sees the surface of the ray
};

// What a frame shows of a surface.
enum relume_pass {
    RELUME_PASS_COLOUR = 0,
    RELUME_PASS_NORMALS,       // the unit vectors themselves, -1 to 1
    RELUME_PASS_SPECULAR,      // specular enhancement (Malzbender et al. 2001, 4.2)
    RELUME_PASS_DIFFUSE_GAIN,  // the same, 4.1
    RELUME_PASS_UNSHARP,       // shading by normals whose detail is exaggerated
    RELUME_PASS_LUMINANCE,     // Rec. 709
    RELUME_PASS_FALSE_COLOUR,  // luminance from dark blue (`low`) to yellow (`top`); 0 is black
    RELUME_PASS_DIFFERENCE,    // absolute, from `reference`
    RELUME_PASSES
};

// Where an eye looks. All zero: at the middle of the object, +y up, through a window as large as
// the largest st window; for an eye straight before a slab it is that slab's window.
struct relume_look_at {
    bool aimed;             // at `at`; else at the middle
    struct relume_vec3 at;  // world
    struct relume_vec3 up;  // zero: +y, for an eye straight above or below -z or +z
    // horizontal, below 180, with square pixels; 0: the window above
    double field_of_view_deg;
};

// Angles in degrees: pan > 0 turns right (-z towards +x), tilt > 0 looks up; tilt is applied
// first, then pan. The horizontal field of view is 2 atan(1 / zoom), of a stereographic look twice
// that: it shows up to nearly everything, circles stay circles, and tilted by -90 it is a little
// planet.
struct relume_pan_tilt {
    double pan_deg, tilt_deg, zoom;  // zoom 0 means 1
    bool stereographic;              // instead of perspective
};

// Which picture of a file a camera makes.
enum relume_framing {
    RELUME_FRAME_DEFAULT = 0,  // slab: EYE at the middle of the uv grid; else VIEW 0
    RELUME_FRAME_VIEW,         // a captured view at its own size (panoramas: unfolded)
    RELUME_FRAME_EYE,          // slab: the window from `eye`; of several slabs what `look_at` says
    RELUME_FRAME_LOOK,         // panorama: a perspective frame
};

// From where and how a file is looked at. All zero: the default of its projection. Plain data.
struct relume_camera {
    enum relume_framing framing;  // which picture it is
    int view;                     // VIEW: its number
    struct relume_vec3 eye;
    struct relume_look_at
        look_at;  // EYE, several slabs: where it looks. Of one slab: all zero is the window
    int through;  // EYE, several slabs: 1 + the slab whose st window it looks through
    struct relume_pan_tilt look;  // LOOK
    // Default: the view's own size, LOOK 1024 x 512; of one of them the other, by proportion.
    int width, height;
};

// In the middle, as large as a picture of width x height pixels can be without being stretched;
// black is beside it. All of the frame where that leaves less than a pixel.
RELUME_API struct relume_rect relume_rect_fit(int width, int height, int frame_width,
                                              int frame_height);
// Of a frame whose own size is `own`: what `camera` says, one side alone with the other by
// proportion.
RELUME_API void relume_frame_size(int *width, int *height, const int own[2],
                                  const struct relume_camera *camera);
// The frame that `camera` asks for, in `*frame`, and the part of it that shows something: all of it
// in a look and with a field of view, whose pixels are square whatever the frame.
RELUME_API struct relume_rect relume_camera_rect(int frame[2], const struct relume_pack_info *info,
                                                 const struct relume_camera *camera);

// How frames are made. Copied; what it points at is borrowed during the call, of a renderer as long
// as it has these params.
struct relume_frame_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    unsigned cpu_off;  // as relume_relight_params
    int threads;       // default: all cores
    // Near lights on views without depth: the surface lies this far along every ray; default:
    // planar views lie on z = 0, others are refused.
    double assume_depth;
    enum relume_pass pass;  // of every view, before they become a frame
    const relume_capture
        *capture;  // PASS_DIFFERENCE: of the file; the nearest view and light count
    enum relume_interpolation interpolation;  // slab; default: by depth where the file has it
    double aperture, focus;                   // slab; as relume_view_params
    enum relume_filter filter;                // as relume_view_params, and of views in another size
    uint64_t memory;  // bytes that a renderer keeps between frames; default: 1 GiB. One frame may
                      // need more
    // How strong `pass` is; pictures, range and threads in it are not looked at. Default: NULL.
    const struct relume_pass_params *strength;
    bool once;    // a renderer draws one frame, and keeps nothing for the next; relume_frame does
    bool masked;  // relume_frame of a captured view at its own size: black outside of its mask
};
#define relume_frame_params(...)                                                                   \
    (&(const struct relume_frame_params){RELUME_SIZED(relume_frame_params), __VA_ARGS__})

// Create `*out`, linear, three channels; relume_camera_rect says where in it the picture is and a
// note in the log that there is something beside it. Only the views that the frame touches are read
// and relit. Returns RELUME_EINVAL (camera does not fit the file, a light is wrong), RELUME_EUNFIT
// (also: near lights and no depth), RELUME_ENOMEM.
RELUME_RESULT relume_status relume_frame(struct relume_image *out, relume_pack *pack,
                                         const struct relume_camera *camera,
                                         const struct relume_light *lights, int n,
                                         const struct relume_frame_params *params);

// The value seen from `eye` along `direction` (into the scene): the plenoptic-illumination function
// (Wong 1998, 6.4). RELUME_EUNFIT when the file holds no such ray.
RELUME_RESULT relume_status relume_query(float rgb[3], relume_pack *pack, struct relume_vec3 eye,
                                         struct relume_vec3 direction,
                                         const struct relume_light *lights, int n,
                                         const struct relume_frame_params *params);

// From where and where to; `direction` has any length but 0.
struct relume_ray {
    struct relume_vec3 eye, direction;  // of any length, into the scene
};
// The same for many rays, whose views are relit once: what lies in memory is every view that a ray
// needs. Rays that the file does not hold give NaN, a single one RELUME_EUNFIT with a sentence.
RELUME_RESULT relume_status relume_query_rays(float (*rgb)[3], relume_pack *pack,
                                              const struct relume_ray *rays, int n,
                                              const struct relume_light *lights, int light_count,
                                              const struct relume_frame_params *params);

#ifdef __cplusplus
}
#endif
#endif
