// model.h - what a model of a BTF is: some arrays, a way to fill them, a way to read a value back
//
// A model says which arrays it keeps, of which types and sizes; fitting fills them; what is read
// back, saved and counted is these arrays and nothing else. So the bytes of the tables are the
// bytes of the files.
#ifndef BTF_MODEL_MODEL_H
#define BTF_MODEL_MODEL_H

#include "core/base/half.h"
#include "material/btf/btf.h"
#include "material/btf/values.h"
#include "material/model/environment.h"

#include <math.h>

enum { MODEL_ARRAYS = 7, MODEL_LOBES = 4 };

struct model_array {
    const char *name;
    struct npy npy;
    bool each;     // one entry a texel: shape[0] is their number or [1] with `by_view`
    size_t below;  // integers: all are below this
    void *data;
    struct npy_file file;  // or empty: `data` is malloc'd
};

struct relume_btf_fitted {
    const struct relume_btf_model *model;
    int width, height, views, lights;
    size_t texels;
    int clusters, components, lobes;  // 0: the model has none
    int texel_bytes, pair_bytes;      // of a row of bits, where the model has such
    bool without_cosine;
    vec3 *view, *light;
    relume_direction_mesh *view_mesh, *light_mesh;
    struct model_array array[MODEL_ARRAYS];
    int arrays;
    void *prepared;                      // what the model's `prepare` made of them, or NULL
    relume_btf_fitted *half;             // the next level of detail, or NULL
    const relume_btf *table;             // the measured values, where they are the model
    struct relume_btf_fitted_info info;  // of the whole, by model_settle
};

// One value that is asked for. Models that are gridded over views (lights) get measured ones only.
struct model_at {
    size_t texel;
    const double *place;  // in texels, where the model is `continuous`; NULL: the texel's middle
    int view, light;      // of the fitted directions, where the model is gridded
    vec3 v, l;
};

// What fitting works with.
struct fitting {
    const relume_btf *btf;
    relume_btf_fitted *out;
    const struct relume_log *log;
    uint64_t seed;
    int threads;
    double ratio;       // asked for; 0: the model's choice
    bool counts_given;  // clusters were asked for
    bool resample;      // lights may be interpolated
};

struct relume_btf_oriented_light;

struct relume_btf_model {
    const char *name;
    const char *summary;
    bool view_grid, light_grid;            // known at measured views (lights) only
    bool continuous;                       // knows all places of the sample, not texels only
    int clusters, components, lobes;       // defaults; 0: the model has none
    int most_clusters;                     // 0: 65536
    int most_components;                   // 0: 256
    bool of_views;                         // components are of each view's pictures, not of texels
    void (*layout)(relume_btf_fitted *m);  // adds the arrays, with model_add
    relume_status (*fit)(struct fitting *f);
    void (*eval)(const relume_btf_fitted *m, const struct model_at *at, float rgb[3]);
    // Whether directions are of use; NULL: all are.
    bool (*fits)(const relume_btf *btf);
    // Whatever makes reading faster, into m->prepared, which mem_free() frees; NULL: nothing does.
    relume_status (*prepare)(relume_btf_fitted *m);
    struct relume_btf_cost (*cost)(const relume_btf_fitted *m);
    // NULL, or what arrays that are fine by themselves should hold and do not; NULL: nothing can
    // be.
    const char *(*fault)(const relume_btf_fitted *m);
    bool bit_rows;  // has rows of bits: texel_bytes and pair_bytes
    // Height in widths of the sample and unit normals of each texel, which the caller destroys;
    // NULL: it knows none.
    relume_status (*truth)(const relume_btf_fitted *m, struct relume_image *relief,
                           struct relume_image *normals);
    bool lobes_times_cosine;  // where values include n.l
    // Under an environment (material/model/ambient.h); NULL: the sum over the measured lights.
    void (*lit)(const relume_btf_fitted *m, const struct model_at *at,
                const struct relume_btf_oriented_light *ambient, float rgb[3]);
};

extern const struct relume_btf_model model_lit, model_bump, model_laf, model_slaf, model_rfp,
    model_rfnl, model_rfnlc, model_cmf, model_vpca, model_lpca, model_fmf, model_qmf, model_gbrdf,
    model_painted, model_table;

// An array of up to five sizes; unused ones are 0.
void model_add(relume_btf_fitted *m, const char *name, enum npy_kind kind, bool each, size_t below,
               const size_t shape[NPY_DIMS]);
// Zeroed arrays as the layout says, in place of what there is. RELUME_ENOMEM.
relume_status model_make_arrays(relume_btf_fitted *m);
// Fill `info` of all levels, once these and their directions are there.
void model_settle(relume_btf_fitted *m);
#define MODEL_SHAPE(...) ((const size_t[NPY_DIMS]){__VA_ARGS__})

static inline uint16_t *model_halfs(const relume_btf_fitted *m, int array)
{
    return m->array[array].data;
}

// What a model stores must stay finite, also where values are as large as halfs can be.
static inline uint16_t model_half(double x)
{
    return half_from_float((float)fmin(fmax(x, -65504.0), 65504.0));
}

static inline float *model_floats(const relume_btf_fitted *m, int array)
{
    return m->array[array].data;
}

// Write the files of a model and of its levels of detail into an existing folder.
relume_status model_save_into(const relume_btf_fitted *m, const char *folder,
                              const struct relume_log *log);

// Value of the fitted model between its directions.
struct model_blend {
    struct relume_direction_blend view, light;
    vec3 v, l;
    const double *place;  // as model_at
};
void model_blend(const relume_btf_fitted *m, size_t texel, const struct model_blend *at,
                 float rgb[3]);
// Light number `i` alone. What is summed over lights has n.l in its weights: model_blend.l is then
// the pole.
static inline struct relume_direction_blend model_measured_light(const relume_btf_fitted *m, int i)
{
    return (struct relume_direction_blend){.count = 1,
                                           .index = {i},
                                           .weight = {1.0},
                                           .direction = m->light[i],
                                           .rim = 1.0,
                                           .length = 1.0};
}

static inline size_t model_pairs(const relume_btf_fitted *m)
{
    return (size_t)m->views * (size_t)m->lights;
}

// Add the components' patterns of one pair, each times the texel's weight for it.
static inline void model_add_components(float rgb[3], const relume_btf_fitted *m,
                                        const uint16_t *weight, const uint16_t *pattern)
{
    const size_t values = 3 * model_pairs(m);
    for (int k = 0; k < m->components; k++, pattern += values) {
        const float w = float_from_half(weight[k]);
        for (int c = 0; c < 3; c++)
            rgb[c] += w * float_from_half(pattern[c]);
    }
}

#endif
