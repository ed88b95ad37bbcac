// btf.h - measured materials: bidirectional texture functions, and the models that compress them
// (Meseth, "Towards Predictive Rendering in Virtual Reality", 2008, chapter 3; Meseth, Mueller,
// Sattler, Klein, "BTF Rendering for Virtual Environments", 2003)
//
// A BTF is a plane of texels seen from a set of view directions under a set of light directions.
// Directions are unit vectors from the sample towards the eye or the light, in the sample's frame:
// x right, y up in the picture, z off the plane; all have z > 0. Values are the linear radiance
// that a directional light of value 1 gives (a white Lambertian facing it shows 1).
#ifndef RELUME_BTF_H
#define RELUME_BTF_H

#include <relume/base.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// Rings about the z axis. Constant; a NULL-terminated list of all is relume_btf_sets.
struct relume_btf_set {
    const char *name;
    const char *summary;  // one line for help texts
    int count;            // directions
    int rings;
    // Directions at one height above the plane, evenly around.
    struct relume_btf_ring {
        double theta_deg, first_phi_deg;  // from the pole; of the first of them
        int count;                        // at phi = first_phi_deg + 360 i / count
    } ring[10];                           // [rings]
};
// NULL when there is none of that name.
RELUME_API const struct relume_btf_set *relume_btf_set_find(const char *name);
// Fill `out[set->count]`, ring by ring from the pole.
RELUME_API void relume_btf_set_directions(const struct relume_btf_set *set,
                                          struct relume_vec3 *out);

// Directions triangulated over the hemisphere. Never changes. Thread-safety: safe.
typedef struct relume_direction_mesh relume_direction_mesh;
// At least 3 unit directions with z > 0, not all on one great circle. RELUME_EUNFIT, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_direction_mesh_create(relume_direction_mesh **out,
                                                         const struct relume_vec3 *directions,
                                                         int n, const struct relume_log *log);
RELUME_API void relume_direction_mesh_destroy(relume_direction_mesh **mesh);

// Half-float values, mapped from their file, so that they need not fit into memory.
// Thread-safety: safe while nobody stores.
typedef struct relume_btf relume_btf;

// What a BTF is. Pointers belong to it. Thread-safety: plain data.
struct relume_btf_info {
    const char *name;   // of the material
    int width, height;  // texels
    int views, lights;
    const struct relume_vec3 *view, *light;  // [views], [lights]: unit, in the frame of the sample
    // Whether values hold the factor n.l, as photographs do. Evaluation never multiplies twice.
    bool without_cosine;
    // Ground truth of synthetic samples, or empty: height over the plane in widths of the sample
    // (1 channel), unit normals (3 channels: x, y, z).
    struct relume_image relief, normals;
};

// How BTFs and models of them are opened, kept and saved. `scratch`, `log` and `limits` are
// borrowed during the call.
struct relume_btf_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    const char *scratch;  // the folder of temporary data; default $TMPDIR or /tmp
    bool fill;   // folders of pictures: a missing pair is interpolated rather than an error
    bool force;  // saving: replace an existing folder
    // Files of Bonn: only these texels, x, y (of the upper left one), width, height; zeros: all.
    int crop[4];
    // Files of Bonn: without values, which take long; only relume_btf_info may be asked for.
    bool outline;
    int threads;
    bool unedited;  // models: without the edits that are kept with them (relume/material/edit.h)
};
#define relume_btf_params(...)                                                                     \
    (&(const struct relume_btf_params){RELUME_SIZED(relume_btf_params), __VA_ARGS__})

// Values all zero, to be stored; copies what `info` points to. RELUME_EINVAL, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_btf_create(relume_btf **out, const struct relume_btf_info *info,
                                              const struct relume_btf_params *params);
// Open a folder: btf.json beside values.npy (docs/btf.md); a capture.json of the views of one slab
// under distant lights (the window is the sample); or pictures whose names hold the angles
// in degrees, tl (light elevation from the pole), pl (light azimuth), tv, pv in any order, like
// tl030_pl120_tv045_pv020.png, there or one level below. Or a .btf file of the University of Bonn,
// whose values are multiplied out into temporary data. Returns an input status, RELUME_ENOMEM,
// RELUME_ECANCEL, RELUME_ESYSTEM without space for temporary data, RELUME_EINVAL for a part that is
// not there.
RELUME_RESULT relume_status relume_btf_open(relume_btf **out, const char *path,
                                            const struct relume_btf_params *params);
// The folder appears whole or not at all. RELUME_EINVAL (also for a part), RELUME_EIO.
RELUME_RESULT relume_status relume_btf_save(const relume_btf *btf, const char *path,
                                            const struct relume_btf_params *params);
RELUME_API void relume_btf_destroy(relume_btf **btf);

// Belongs to the BTF.
RELUME_API const struct relume_btf_info *relume_btf_info(const relume_btf *btf);
// Bytes of its half-float values: 6 a texel and pair of directions.
RELUME_API uint64_t relume_btf_bytes(int width, int height, int views, int lights);

// Some views and lights of a BTF, which must outlive the part. RELUME_EUNFIT when too few are left
// to interpolate, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_btf_part(relume_btf **out, const relume_btf *whole,
                                            const int *views, int view_count, const int *lights,
                                            int light_count, const struct relume_log *log);

// The reference: three views times three lights of the measured values, weighted. Below the lowest
// lights the value falls with the cosine to 0 at the horizon; views and lights below it give 0.
RELUME_API void relume_btf_evaluate(const relume_btf *btf, int x, int y, struct relume_vec3 view,
                                    struct relume_vec3 light, float rgb[3]);

// A way to compress a BTF. Constant; a NULL-terminated list of all is relume_btf_models.
struct relume_btf_model;
// All models; NULL ends the list.
extern RELUME_API const struct relume_btf_model *const relume_btf_models[];
// NULL when there is none of that name.
RELUME_API const struct relume_btf_model *relume_btf_model_find(const char *name);
// As people write it; constant.
RELUME_API const char *relume_btf_model_name(const struct relume_btf_model *model);
// One line for help texts; constant.
RELUME_API const char *relume_btf_model_summary(const struct relume_btf_model *model);

struct relume_btf_fit_params {  // zero in a field means its default
    size_t struct_size;         // filled by the macro (base.h)
    const struct relume_log *log;
    // lpca 32, cmf 512, rfnlc 1024; at most one a texel, [1, 65536] (lpca: 256, gbrdf: 64). gbrdf,
    // the number of materials: as many as are distinct, at most 8.
    int clusters;
    int components;  // vpca 4, lpca 8, fmf 100; [1, 256]; qmf: at most, 512; [1, 1024]
    int lobes;       // rfnl, rfnlc, laf, slaf: 2; [1, 4]
    uint64_t seed;   // equal seeds give equal bytes, whatever the thread count
    int threads;     // default: all cores
    // Levels of detail: each is fitted to means of 2 x 2 texels of the level before, with a quarter
    // of its clusters. Default 1: the BTF alone; -1: down to one texel.
    int levels;
    // qmf: bytes measured over bytes of the model, at least where one component allows; 200;
    // [1, 1e6]
    double ratio;
    // gbrdf: where no light stands where a view is, find the relief with lights between the
    // measured ones; without it such a BTF is refused.
    bool resample;
};
#define relume_btf_fit_params(...)                                                                 \
    (&(const struct relume_btf_fit_params){RELUME_SIZED(relume_btf_fit_params), __VA_ARGS__})

// A fitted model. Never changes. Thread-safety: safe.
typedef struct relume_btf_fitted relume_btf_fitted;

// Whether a model can be fitted to a BTF of such directions without `resample`; only gbrdf asks for
// some.
RELUME_API bool relume_btf_model_fits(const struct relume_btf_model *model, const relume_btf *btf);
// Returns RELUME_EINVAL for parameters out of range, RELUME_EDAMAGED for values that are not
// finite, RELUME_EUNFIT for directions that the model cannot use, RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_btf_fit(relume_btf_fitted **out, const relume_btf *btf,
                                           const struct relume_btf_model *model,
                                           const struct relume_btf_fit_params *params);
// A folder with model.json and one .npy file for each array (docs/btf.md), or, where `path` ends in
// .exr, one file, which only g-BRDFs of one level have (docs/gbrdf.md). RELUME_EINVAL, RELUME_EIO;
// an input status.
RELUME_RESULT relume_status relume_btf_fitted_save(const relume_btf_fitted *fitted,
                                                   const char *path,
                                                   const struct relume_btf_params *params);
// The folder or file again, with the edits that are kept with a g-BRDF (relume/material/edit.h);
// the caller destroys `*out`. An input status with a sentence, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_btf_fitted_open(relume_btf_fitted **out, const char *path,
                                                   const struct relume_btf_params *params);
RELUME_API void relume_btf_fitted_destroy(relume_btf_fitted **fitted);

// What a fitted model is.
struct relume_btf_fitted_info {
    const struct relume_btf_model *model;  // the kind of model
    int width, height, views, lights;
    int clusters, components, lobes;  // 0: the model has none
    uint64_t bytes;                   // of its arrays
    uint64_t bytes_each;              // of those a texel: the rest is shared by all texels
    int levels;                       // at least 1
    uint64_t bytes_levels;            // of the arrays of all levels
    double rim;  // mean cosine of the lowest measured lights, below which values fall to 0
    int edits, edits_undone;  // that apply, and that are undone (relume/material/edit.h)
};
// It belongs to `fitted`.
RELUME_API const struct relume_btf_fitted_info *relume_btf_fitted_info(
    const relume_btf_fitted *fitted);

// What a graphics processor has to do for a pixel between the measured directions (2003 paper,
// Tab. 3): vector operations (of up to four numbers; a power counts as one) and texture fetches (up
// to four numbers or 16 bytes of one place, bilinear ones as one). Looking up the measured
// directions around one costs two fetches, from cube maps (thesis, chapter 9).
struct relume_btf_cost {
    int ops, fetches;              // once
    int light_ops, light_fetches;  // and for each light
};
// The cost of one evaluation.
RELUME_API struct relume_btf_cost relume_btf_fitted_cost(const relume_btf_fitted *fitted);

// The measured values as a model that is exact, for what takes models. Nothing is copied: the BTF
// must outlive it; it cannot be saved. RELUME_EDAMAGED for values that are not finite,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_btf_as_model(relume_btf_fitted **out, const relume_btf *btf,
                                                const struct relume_log *log);

// What a model shows in its own directions, as a BTF whose values have n.l; those of a g-BRDF know
// its relief and normals. RELUME_ENOMEM, RELUME_ESYSTEM.
RELUME_RESULT relume_status relume_btf_expand(relume_btf **out, const relume_btf_fitted *fitted,
                                              const struct relume_btf_params *params);

// A g-BRDF of which everything is known, to hold fits against: plateaus of a brushed metal that is
// turned differently in each quarter, over ground that is half glossy and half dusty.
struct relume_gbrdf_plant_params {  // zero in a field means its default
    size_t struct_size;             // filled by the macro (base.h)
    const struct relume_log *log;
    int size;                                 // texels on a side; default 64; [1, 1024]
    const struct relume_btf_set *directions;  // of views and lights; default: bonn
    uint64_t seed;                            // of the spots of its colour
};
#define relume_gbrdf_plant_params(...)                                                             \
    (&(const struct relume_gbrdf_plant_params){RELUME_SIZED(relume_gbrdf_plant_params),            \
                                               __VA_ARGS__})
// The caller destroys `*out`. RELUME_EINVAL, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_gbrdf_plant(relume_btf_fitted **out,
                                               const struct relume_gbrdf_plant_params *params);

// The same question as relume_btf_evaluate.
RELUME_API void relume_btf_fitted_evaluate(const relume_btf_fitted *fitted, int x, int y,
                                           struct relume_vec3 view, struct relume_vec3 light,
                                           float rgb[3]);

// What a model keeps, for clients that evaluate it themselves: the arrays of its folder
// (docs/btf.md). Pointers belong to the model.
struct relume_btf_array {
    const char *name;
    // The type of its numbers.
    enum { RELUME_BTF_U8, RELUME_BTF_U16, RELUME_BTF_HALF, RELUME_BTF_FLOAT, RELUME_BTF_U32 } kind;
    int dims;
    size_t shape[5];   // [dims], the last runs fastest
    const void *data;  // that many numbers
};
// Array number `i`; false when there are fewer.
RELUME_API bool relume_btf_fitted_array(struct relume_btf_array *out,
                                        const relume_btf_fitted *fitted, int i);
// The directions that a model was fitted to; they belong to it.
struct relume_btf_directions {
    const struct relume_vec3 *view, *light;  // as many as relume_btf_fitted_info says
    bool without_cosine;                     // as relume_btf_info
};
// A copy; what it points to belongs to the model.
RELUME_API struct relume_btf_directions relume_btf_fitted_directions(
    const relume_btf_fitted *fitted);

// How far a model is from a BTF of as many texels (its directions may be others).
struct relume_btf_error {
    // |difference| averaged over directions and colours (thesis, Eq. 3.2), over texels
    double mean_avg, mean_min, mean_max;
    double rms;       // over everything, absolute: 0.01 is 1 % of a white Lambertian lit head-on
    double relative;  // rms over the rms of the values
    double delta_e;   // mean CIEDE2000 of `pictures` pairs; NaN when not asked for
    double ssim;      // their mean
    int pictures;
    size_t pairs;  // of directions compared
};
struct relume_btf_judge_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    bool unseen;   // only pairs with a direction that the model was not fitted to
    int pictures;  // pairs whose pictures are compared by eye (delta_e, ssim); default 0
    int threads;
};
#define relume_btf_judge_params(...)                                                               \
    (&(const struct relume_btf_judge_params){RELUME_SIZED(relume_btf_judge_params), __VA_ARGS__})
// RELUME_EINVAL when texels differ or no pair is left, RELUME_ENOMEM, RELUME_ECANCEL.
RELUME_RESULT relume_status relume_btf_judge(struct relume_btf_error *out,
                                             const relume_btf_fitted *fitted, const relume_btf *btf,
                                             const struct relume_btf_judge_params *params);

#ifdef __cplusplus
}
#endif
#endif
