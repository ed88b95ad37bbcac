// acquire.h - a capture being made of photographs
#ifndef ACQUIRE_ACQUIRE_H
#define ACQUIRE_ACQUIRE_H

#include "capture/acquire/ball.h"
#include "capture/acquire/sha256.h"
#include "capture/manifest/capture.h"
#include "core/base/outdir.h"
#include "core/math/vec.h"

#include <relume/capture/acquire.h>
#include <relume/image/photograph.h>

// One photograph and, where balls have photographs of their own, that of the ball under its light.
struct shot {
    const char *path, *ball_path;  // borrowed
    int number;                    // among those that were given
    char name[32];                 // of the image in the folder
    struct relume_exif notes;
    struct relume_image small;  // three channels, linear, at most SHOT_SMALL pixels a side
    struct relume_image luma;   // root of the mean channel, at most acquire_luma_side pixels a side
    double shift[2];  // where the scene lies, pixels to the right and down from where most
                      // photographs have it; taken out when the photograph is read
    float saturated, black, similarity;
    float outside;        // share of the pixels whose colour lies outside sRGB, by their profile
    double fine, coarse;  // detail.c: curvature from pixel to pixel, differences farther off
    struct changed_picture changed;  // where there is no folder for it, and it is not as its file
    char sha256[SHA256_TEXT];        // of the file
    uint64_t bytes;
    float sharpness;  // of the ratio of both, relative to the median; NaN: not measured
    double sigma_deg;
    struct relume_ball_light light;  // of the first ball
    vec3 direction, position;
    float intensity[3];
    double position_sigma;
    bool misfit;   // contradicts its light
    bool strange;  // of another scene
    bool stray;    // a ball shows its light elsewhere
};
enum { SHOT_SMALL = 168 };

// Warnings that many photographs may share.
enum acquire_alike {
    ALIKE_TURNED,
    ALIKE_SATURATED,
    ALIKE_SCENE,
    ALIKE_BLURRED,
    ALIKE_UNALIGNED,
    ALIKE_RIM,
    ALIKE_TWO,
    ALIKE_STRAY,
    ALIKE_MISFIT,
    ALIKE_POWER,
    ALIKE_EXPOSURE,
    ALIKE_PARTS,
    ALIKE_KINDS
};
enum { SHOOT_FEW = 3 };  // said one by one
struct alike {
    int count, first[SHOOT_FEW], worst;  // indices of warnings
    double how_bad;                      // the worst one
};

// Lights that are known before the photographs are looked at.
struct listed_lights {
    const vec3 *direction;  // [photographs]
    bool turns;             // they belong to the photographs as these lie in their files
};

struct acquisition {
    struct relume_acquire_params p;  // masks and lights as they were found
    struct relume_photographs photographs, balls, flats;
    bool named_singly;         // the photographs were named one by one
    int *given_index;          // [photographs.count] on the command line, or NULL where names are
                               // given in the order in which a shell sorts them
    char likely_lights[4096];  // a file that may be meant as lights: where no ball is found the
                               // sentence names it; "": none
    const struct listed_lights *listed;  // of a list that named the photographs, or NULL
    struct relume_acquisition *out;
    outdir *dir;                                  // NULL: the photographs stay in their files
    const struct relume_capture_params *opening;  // without a folder
    size_t left_bytes;                            // of opening->keep_bytes
    int shots;
    struct shot *shot;
    int width, height;  // of the photographs, cropped once the lights are known
    int whole[2];       // before that
    int orientation;    // of the first, which all have: the camera stands still; 0: none yet
    bool again;         // photographs are read a second time, since some were moved
    struct relume_image first;  // that others are aligned to; empty unless params.align
    struct relume_image gain;   // that evens out the light, of one flat field; empty: none yet
    struct relume_image grey;   // sum of what photographs show in params.white
    bool has_intensities;
    // of the photographs in which the balls stand
    struct relume_ball_camera camera;
    struct relume_image mean, peak;
    struct relume_image change;  // how light differs between photographs: RMS of its logarithm
    int summed;
    bool still;                  // reflections that never move are left out of the balls
    bool judged;                 // photographs were compared with those under similar lights
    bool coplanar;               // the lights, nearly: no surface follows from them
    bool turned;                 // the lights of the list were turned by `orientation`
    bool witnessed;              // a ball in the photographs agrees with the list of lights, ...
    struct relume_ball witness;  // ... this one
    struct alike alike[ALIKE_KINDS];
};

// Log a warning and keep it for the report. RELUME_ENOMEM.
__attribute__((format(printf, 2, 3))) relume_status acquire_warn(struct acquisition *s,
                                                                 const char *format, ...);
// The same for one of a kind, kept for the report; what was kept is said by acquire_say_alike, of
// more than a few only the worst and their number.
__attribute__((format(printf, 4, 5))) relume_status acquire_warn_alike(struct acquisition *s,
                                                                       enum acquire_alike kind,
                                                                       double how_bad,
                                                                       const char *format, ...);
void acquire_say_alike(struct acquisition *s);
// Photograph `i` is of no use: leaves it out with a warning where that is allowed, else fails.
__attribute__((format(printf, 4, 5))) relume_status acquire_drop(struct acquisition *s, int i,
                                                                 bool allowed, const char *format,
                                                                 ...);

static inline bool acquire_refines(const struct acquisition *s)
{
    return s->p.refine_lights || s->p.refine_brightness;
}
// Returns true where the surface is fitted to photographs of full size.
static inline bool acquire_keeps_surface(const struct acquisition *s)
{
    return s->p.surface || s->p.normals || s->p.albedo || s->p.height;
}

// The steps of relume_capture_photographs. acquire_begin finds the inputs, acquire_look reads the
// pictures and finds the lights, acquire_describe gives `use` what capture.json says, acquire_fit
// compares the photographs with their lights. An input status and those of
// relume_capture_photographs.
relume_status acquire_begin(struct acquisition *s, const char *const *photographs, int count);
relume_status acquire_look(struct acquisition *s);
relume_status acquire_describe(const struct acquisition *s,
                               relume_status (*use)(void *, const struct relume_manifest *),
                               void *context);
relume_status acquire_fit(struct acquisition *s, const relume_capture *capture);
void acquire_release(struct acquisition *s);
// Saves a picture in the folder, and reads it again. An input status, RELUME_EIO, RELUME_ENOMEM.
relume_status acquire_save(struct acquisition *s, struct shot *shot,
                           const struct relume_image *image);
relume_status acquire_fetch(struct relume_image *out, const struct acquisition *s,
                            const struct shot *shot);
// The same without a folder: a picture is kept where it is not as its file is.
relume_status acquire_keep(struct acquisition *s, struct shot *shot,
                           const struct relume_image *image);
relume_status acquire_kept(struct relume_image *out, const struct acquisition *s,
                           const struct shot *shot);
// The mask of the pictures, cropped as they are; empty without one. An input status.
relume_status acquire_load_mask(struct relume_image *out, const struct acquisition *s);

// Returns RELUME_EINVAL, and says so, where members of the params need or exclude each other.
relume_status acquire_check_params(const struct relume_acquire_params *p);

// Finds the photographs, masks and lights that the params name, or that lie beside. An input
// status.
relume_status acquire_find_inputs(struct acquisition *s, const char *const *paths, int count);
// Fills out->chart from the colour target, where there is one. An input status.
relume_status acquire_read_target(struct acquisition *s);
// Writes normals, albedo and height, where they are wanted. RELUME_EUNFIT, RELUME_EIO.
relume_status acquire_write_products(const struct acquisition *s);
// The same for the capture in a folder, by the params alone. RELUME_EUNFIT, RELUME_EIO, an input
// status.
relume_status acquire_write_products_of(const char *folder, const struct relume_acquire_params *p);

// One photograph of the camera that stands still, turned as the first is. `notes` may be NULL. An
// input status.
relume_status acquire_load(struct relume_image *out, struct relume_exif *notes,
                           const struct acquisition *s, const char *path,
                           struct relume_transfer transfer);
// Read all photographs into the folder; an input status.
relume_status acquire_read(struct acquisition *s);
relume_status acquire_check_size(const struct acquisition *s, const struct relume_image *image,
                                 const char *path, int width, int height);
// Multiply a photograph by what its flat field says. RELUME_EUNFIT.
relume_status acquire_flatten(struct acquisition *s, const struct shot *shot,
                              struct relume_image *image);
// Make the colours right by the matrix of a colour target, where there is one.
void acquire_correct(const struct acquisition *s, struct relume_image *image, bool floats);
// Finds photographs whose scene lies elsewhere by half a pixel or more, since the camera was
// moved: says which, and fills their shift; `*moved`: there are some. RELUME_ENOMEM.
relume_status acquire_register(struct acquisition *s, bool *moved);
// Returns the most pixels that a side of a luma has, where there are `shots` photographs.
int acquire_luma_side(int shots);
// Moves a picture back by a shift; its border is repeated. RELUME_ENOMEM.
relume_status acquire_move_back(struct relume_image *image, const double shift[2]);
// Returns how many pixels along a side become one of a small photograph.
int acquire_small_step(int width, int height);
// Makes a small photograph, of at most SHOT_SMALL pixels a side. RELUME_ENOMEM.
relume_status acquire_shrink(struct relume_image *out, const struct relume_image *from);
// Crops the photographs in the folder, and the small ones, as params.crop says. RELUME_EINVAL,
// RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL.
relume_status acquire_crop(struct acquisition *s);
// The part that was kept; width 0: all.
struct relume_rect acquire_part(const struct acquisition *s);
// Returns how many balls stand in the photographs themselves.
int acquire_balls_inside(const struct relume_ball **ball, const struct acquisition *s);
// Says why --crop auto crops nothing: there is no relief, or the object fills the photographs.
void acquire_say_no_object(bool relief, const struct relume_log *log);
// How sharp a photograph is by itself.
void acquire_measure_detail(struct shot *shot, const struct relume_image *image);
// Check sums of the photographs' files. An input status, RELUME_ENOMEM.
relume_status acquire_sum_files(struct acquisition *s);
// Where the photographs come from, for capture.json: JSON, to be freed; NULL: no memory.
char *acquire_provenance(const struct acquisition *s);
// Remember the grey region of a photograph; make its mean the colour of all lights.
relume_status acquire_add_grey(struct acquisition *s, const struct relume_image *image);
relume_status acquire_whiten(struct acquisition *s);
// What is wrong with the pictures themselves: other scenes, clipping, blackness.
relume_status acquire_check_pictures(struct acquisition *s);
// The photograph that shows the balls under a shot's light, linear.
relume_status acquire_load_balls(struct relume_image *out, const struct acquisition *s, int i);
// Mirror balls found as the horizon of the table they stand on: find their outlines.
relume_status acquire_seek_tables(struct acquisition *s);
// Directions, positions, intensities and their errors, from balls or from a file.
relume_status acquire_find_lights(struct acquisition *s);
// Compares the lights of a list with those that balls in the photographs show: warns of single
// ones that differ. RELUME_EUNFIT where the list has other axes or another order,
// RELUME_ENOMEM.
relume_status acquire_ask_balls(struct acquisition *s);
// Turns the lights as a photograph of that EXIF orientation is turned.
void acquire_turn_lights(struct acquisition *s, int orientation);
// The same from a folder: the text files of COLMAP, with cameras that are tied to the lamp.
bool acquire_has_poses(const char *path);
relume_status acquire_lights_from_poses(struct acquisition *s);
// out->photometric by the small photographs; an input status, RELUME_EUNFIT.
relume_status acquire_fit_small(struct acquisition *s, const relume_capture *capture);
// Leaves out photographs that are black, though their light stands above the object: misfires.
// Light from the side and from behind may show nothing. RELUME_EUNFIT when fewer than 3 are left.
relume_status acquire_leave_black_out(struct acquisition *s);
// Returns whether there are enough photographs to compare them with those under similar lights.
bool acquire_can_judge(const struct acquisition *s);
// Names photographs that contradict those under similar lights, and lights in another order.
// RELUME_ENOMEM.
relume_status acquire_judge(struct acquisition *s);
// Warns of light that belongs to no lamp. RELUME_ENOMEM.
relume_status acquire_check_blacks(struct acquisition *s);
// Returns the median correlation of a photograph's edges with several other photographs; NAN
// without edges. One photograph in ACQUIRE_SIMILAR tells what is usual.
float acquire_similarity(const struct acquisition *s, int i);
enum { ACQUIRE_SIMILAR = 4 };
// Names photographs with other edges than most.
relume_status acquire_name_scenes(struct acquisition *s);
// Warns where the slopes of the surface belong to lights with another axis, by the lumas. An input
// status of the mask, RELUME_ENOMEM.
relume_status acquire_check_relief(struct acquisition *s);
// Uneven coverage, coplanar lights.
relume_status acquire_check_lights(struct acquisition *s);

// lights.svg and report.html into the folder `dir`.
relume_status acquire_report(const struct acquisition *s, const char *dir);
// The lights on the sphere, as SVG, to be freed; NULL when memory is short.
char *acquire_light_sphere(const struct relume_acquisition *out);

#endif
