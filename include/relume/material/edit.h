// edit.h - changing materials without losing them: lists of operations on g-BRDFs
// (relume/material/btf.h, docs/gbrdf.md) and on folders of maps (relume/material/maps.h), kept
// beside what they change (Menzel's thesis, "Perceptually Driven Image Based Rendering", 2011,
// section 6.4)
//
// An edit is one operation with its parameters; a list of them, of which the last may be undone, is
// kept in a small JSON file with what it was made for: found.exr has found.edits.json, a folder
// DIR has DIR/edits.json (docs/editing.md). The measured maps never change. Who opens a g-BRDF sees
// it edited; of a folder of maps relume_maps_edit makes others. A list knows the values that it was
// made for by their fingerprint, and is refused for others.
#ifndef RELUME_EDIT_H
#define RELUME_EDIT_H

#include <relume/base.h>
#include <relume/image.h>
#include <relume/material/btf.h>
#include <relume/material/maps.h>

#ifdef __cplusplus
extern "C" {
#endif

// What can be done. Constant; a NULL-terminated list of all is relume_edit_operations.
struct relume_edit_operation;
// All operations; NULL ends the list.
extern RELUME_API const struct relume_edit_operation *const relume_edit_operations[];
// NULL when there is none of that name.
RELUME_API const struct relume_edit_operation *relume_edit_operation_find(const char *name);
// As people write it: emboss, engrave, roughness, tint, channels, swap, turn, add-material;
// constant.
RELUME_API const char *relume_edit_operation_name(const struct relume_edit_operation *operation);
// The name of its parameter number `i`, NULL beyond the last; the first is the one that has no
// default.
RELUME_API const char *relume_edit_operation_parameter(
    const struct relume_edit_operation *operation, int i);

// One operation; of the parameters those of the operation count. "Width" is that of the sample or
// the picture; materials are told by their labels, counted from 0. Thread-safety: plain data.
struct relume_edit {
    const struct relume_edit_operation *operation;  // what is done
    // emboss, engrave: grey, 0 (the ground) to 1 (the full height). Code values, not light.
    struct relume_image drawing;
    double height;  // ... of white, widths; (0, 1]; default 0.02
    double at[2];   // ... the middle of the drawing: from the left, from the top, of the width and
                    // of the height; [0, 1]; default 0.5, 0.5
    double size;    // ... width of the drawing, widths; (0, 1]; default 1
    // roughness: glTF's, which is multiplied; slopes of micro-normals by its square; [0.1, 10].
    double factor;
    double factors[3];  // tint: red, green and blue are multiplied; [0, 16]
    char channels[4];   // channels: which take the place of red, green, blue, as "GBR"
    int labels[2];      // swap: two materials of a g-BRDF
    double degrees;     // turn: counter-clockwise; [-3600, 3600]
    // add-material: glTF's roughness; [0.1, 1].
    double roughness;
    double r0;            // ... reflectance at normal incidence; [0, 1]; default 0.04
    double colour[3];     // ... diffuse, linear; [0, 1]; default NaN: that of the place stays
    double highlight[3];  // ... colour of what shines; [0, 1]; default white
    int label;  // all but emboss, engrave, swap and add-material: only this one; default -1: all
    // Where, of all but emboss and engrave: stretched over the sample, where at least 0.5 (of maps:
    // in proportion); default: everywhere.
    struct relume_image mask;
};
// All defaults.
RELUME_API struct relume_edit relume_edit_of(const struct relume_edit_operation *operation);
// Set a parameter by its name from what people write: "0.5", "0.5,0.2", "GBR"; a drawing or mask is
// a picture that is loaded, which relume_edit_destroy frees. RELUME_EINVAL with a sentence for
// other parameters and values, an input status.
RELUME_RESULT relume_status relume_edit_set(struct relume_edit *edit, const char *parameter,
                                            const char *text, const struct relume_log *log);
// As people read it, "emboss height 0.02 at 0.5,0.5 size 1 drawing 64x64": writes at most `size`
// bytes, always terminated.
RELUME_API void relume_edit_text(const struct relume_edit *edit, char *text, size_t size);
// Free drawing and mask.
RELUME_API void relume_edit_destroy(struct relume_edit *edit);

// A list of edits of one g-BRDF or folder of maps. Thread-safety: one thread at a time.
typedef struct relume_edits relume_edits;

// An empty list for values of that fingerprint. RELUME_ENOMEM.
RELUME_RESULT relume_status relume_edits_create(relume_edits **out, uint64_t fingerprint);
// The list kept with the g-BRDF or folder of maps `path`, an empty one where there is none.
// RELUME_EUNFIT for a list that was made for other values, RELUME_EFORMAT for what is no list, an
// input status, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_edits_open(relume_edits **out, const char *path,
                                              uint64_t fingerprint, const struct relume_log *log);
// Keep it with `path`, in place of the list that is there. RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_edits_save(const relume_edits *edits, const char *path,
                                              const struct relume_log *log);
RELUME_API void relume_edits_destroy(relume_edits **edits);

// Append a copy, with its drawing and mask reduced to 8 bits and RELUME_EDIT_MOST_SIDE; what was
// undone is forgotten. RELUME_EINVAL with a sentence for parameters out of range and a list that is
// full, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_edits_add(relume_edits *edits, const struct relume_edit *edit,
                                             const struct relume_log *log);
// Undo the last one that is not undone; false: there is none.
RELUME_API bool relume_edits_undo(relume_edits *edits);
// Redo the first one that is undone; false: there is none.
RELUME_API bool relume_edits_redo(relume_edits *edits);
// How many there are, with those that are undone.
RELUME_API int relume_edits_count(const relume_edits *edits);
// How many of them, the last ones, are undone.
RELUME_API int relume_edits_undone(const relume_edits *edits);
// Number `i` from 0, in the order in which they apply; belongs to the list.
RELUME_API const struct relume_edit *relume_edits_get(const relume_edits *edits, int i);

// Of what a model keeps.
RELUME_API uint64_t relume_btf_fitted_fingerprint(const relume_btf_fitted *fitted);
// A g-BRDF with edits, which the caller destroys; `fitted` stays as it is, and must have been
// opened unedited (relume_btf_params). No texel sends back more light than it gets. RELUME_EUNFIT
// with a sentence for a list of other values, a label or a size that the g-BRDF has not, other
// models and levels of detail; RELUME_ENOMEM.
RELUME_RESULT relume_status relume_btf_fitted_edit(relume_btf_fitted **out,
                                                   const relume_btf_fitted *fitted,
                                                   const relume_edits *edits,
                                                   const struct relume_log *log);

// How two photographs become a g-BRDF.
struct relume_gbrdf_make_params {  // zero in a field means its default
    size_t struct_size;            // filled by the macro (base.h)
    const struct relume_log *log;
    int width;                 // texels; default: those of `colour`, at most 256; [1, 1024]
    double relief;             // height of white over black, widths; default 0.03; [0, 1]
    double roughness;          // of the one material, as in struct relume_edit; default 0.5
    double r0;                 // default 0.04; [0, 1]
    double turn_degrees;       // the same everywhere
    struct relume_vec3 shine;  // red, green, blue of what shines; default white; [0, 1]
    const struct relume_btf_set *directions;  // of views and lights; default: bonn
};
#define relume_gbrdf_make_params(...)                                                              \
    (&(const struct relume_gbrdf_make_params){RELUME_SIZED(relume_gbrdf_make_params), __VA_ARGS__})
// `colour` (three channels, linear) is the diffuse colour, `height` (one channel, 0 to 1) the
// relief; it may have another size, and is stretched. The caller destroys `*out`. RELUME_EINVAL,
// RELUME_EUNFIT for pictures that are not finite, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_gbrdf_make(relume_btf_fitted **out,
                                              const struct relume_image *colour,
                                              const struct relume_image *height,
                                              const struct relume_gbrdf_make_params *params);

// Of their pictures.
RELUME_API uint64_t relume_maps_fingerprint(const struct relume_maps *maps);
// Apply a list to maps, in place: normals and occlusion follow the relief. Whoever needs the
// measured ones keeps them. RELUME_EUNFIT with a sentence for a list of other values and for
// operations on what maps have not, RELUME_ENOMEM; then some of it may be done.
RELUME_RESULT relume_status relume_maps_edit(struct relume_maps *maps, const relume_edits *edits,
                                             int threads, const struct relume_log *log);

#ifdef __cplusplus
}
#endif
#endif
