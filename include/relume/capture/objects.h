// objects.h - many objects, a folder of photographs each, become captures, and one page shows them
//
// `relume capture A B C -o DIR` makes the same call: DIR/A, DIR/B, DIR/C, and DIR/report.html.
#ifndef RELUME_OBJECTS_H
#define RELUME_OBJECTS_H

#include <relume/base.h>
#include <relume/capture/acquire.h>

#ifdef __cplusplus
extern "C" {
#endif

// One object, and what became of it.
struct relume_captured_object {
    char *name;            // of its folder, and what sentences about it begin with
    char *photographs;     // the folder that was given
    char *path;            // the folder of the capture: DIR/NAME
    relume_status status;  // RELUME_OK: the capture is there; RELUME_ECANCEL: not reached
    char *reason;          // a sentence about the failure, or NULL
    bool kept;             // the capture was there already, and was left as it is
    // Empty without a capture. A kept one has what its folder tells: size, lights, the
    // photographs' paths and `sigma_deg`, warnings, left_out.
    struct relume_acquisition capture;
};
struct relume_captured_objects {
    int count;
    struct relume_captured_object *object;  // [count], in the order of their folders
};

// Parameters of captures of many objects. Zero or NULL in a field means its default. Borrowed
// during the call.
struct relume_capture_objects_params {
    size_t struct_size;            // filled by the macro (base.h)
    const struct relume_log *log;  // sentences begin with the name of their object
    // Holds for every object, but for its log. `normals`, `albedo` and `height` are names of files
    // in the folders of the objects. `force` makes captures again that are there.
    const struct relume_acquire_params *each;
    // Called once the capture of an object is there, also for a kept one: may write further files
    // into its folder. Another status than RELUME_OK becomes the object's, and the error that the
    // log was given its reason.
    relume_status (*follow)(void *user, const struct relume_captured_object *object,
                            const struct relume_log *log);
    void *user;
    const char *const *files;  // [file_count] names that `follow` writes in each folder: `force`
    int file_count;            // replaces them with the capture
};
#define relume_capture_objects_params(...)                                                         \
    (&(const struct relume_capture_objects_params){RELUME_SIZED(relume_capture_objects_params),    \
                                                   __VA_ARGS__})

// Decides whether paths are objects of their own (`*many`): two folders or more, and no photograph
// beside them. Otherwise they are the photographs of one capture. RELUME_EINVAL for photographs
// beside two folders, which may be either, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_capture_find_objects(bool *many, const char *const *paths,
                                                        int count, const struct relume_log *log);

// Makes the capture DIR/NAME of each folder of photographs, NAME being the folder's own name, and
// the page DIR/report.html, which shows all of them. Folders of one name get a number. Left out,
// with a note, are files, folders that are named twice, `dir` itself, captures, and folders that
// `each` names (balls, flat fields). After one that fails the next object follows. A capture that
// is there is kept unless `each->force`; it fails if it was made of other photographs. The page is
// written again after each object, and shows earlier captures in `dir` as well.
// Returns the status of the first object that failed. `out` (may be NULL, to be destroyed) has all
// objects also then; after an error before the first it is empty. RELUME_EINVAL: members exclude
// each other, or the name of a file holds a folder. RELUME_EINVAL as well where `dir` is a file, a
// folder of photographs or another output, or its report.html another page. RELUME_ENOTFOUND: no
// folder is left, or a file that `each` names is missing. RELUME_EIO, RELUME_ENOMEM.
// RELUME_ECANCEL: the objects before it stay. Thread-safe.
RELUME_RESULT relume_status relume_capture_objects(
    const char *dir, const char *const *folders, int count,
    const struct relume_capture_objects_params *params, struct relume_captured_objects *out);
RELUME_API void relume_captured_objects_destroy(struct relume_captured_objects *objects);

#ifdef __cplusplus
}
#endif
#endif
