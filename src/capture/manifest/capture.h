// capture.h - the inside of an opened capture
#ifndef CAPTURE_CAPTURE_H
#define CAPTURE_CAPTURE_H

#include "capture/manifest/image_cache.h"
#include "capture/manifest/manifest.h"
#include "image/image/image.h"

// A picture that is not as its file is: turned, in other colours, or moved back. Linear, as a
// capture's folder holds it.
struct changed_picture {
    uint16_t *halves;  // [height][width][3], or NULL: as the file
    size_t mapped;     // bytes of a mapped file (core/base/scratch.h); 0: memory
};
void changed_picture_free(struct changed_picture *picture);

struct relume_capture {
    struct draft draft;
    char *path;
    struct relume_pictures pictures;  // `data` is NULL: files
    int pictured;                     // lights of `pictures`
    void *owned;  // what `pictures` are in, where that is the capture's own (core/base/scratch.h)
    size_t owned_bytes;
    const struct changed_picture *changed;  // [pictured], or NULL: all are as their files
    struct changed_picture *owned_changed;  // the same where they are the capture's own
    struct relume_image owned_mask;         // pictures.mask where it is the capture's own
    bool rounded;         // integers of files are rounded as in a capture's folder
    const int *light_of;  // [lights]: of those; NULL: the same
    int width, height;
    struct relume_rect part;  // of the images, which are
    int whole[2];             // ... so wide and high, that is the capture; width 0: all of them
    int x, y;                 // origin of the images' data windows
    bool floats;              // an image holds floating-point numbers
    bool repair;
    const char *scratch;  // beside which large depth and masks are kept, or NULL
    double assume_depth;  // of near lights' views without depth; 0: none
    struct image_cache *cache;
    struct relume_limits limits;
    relume_context *context;          // of the log that it was opened with, or NULL
    struct relume_transfer stated;    // for all images; AUTO: each file's own
    struct relume_transfer transfer;  // of the first image, never AUTO
};

// One light at a time: an EXR of layers named by lights, which becomes a capture of pictures; and a
// folder of pictures with a list of directions, which becomes a draft, and the list's path.
bool olat_is_stage(const char *path, const struct relume_log *log);
relume_status olat_open(relume_capture **out, const char *path,
                        const struct relume_capture_params *p);
bool olat_is_folder(const char *folder, const struct relume_log *log);
relume_status olat_read_folder(struct draft *out, char **path, const char *folder,
                               const struct relume_capture_params *p);

// What opening a capture does after its manifest is known: its images are looked at, defaults
// filled in. Frees `c` on failure.
relume_status capture_finish(relume_capture **out, relume_capture *c,
                             const struct relume_capture_params *p);

// Photographs in their files, which become the capture that their folder would be.
struct capture_files {
    struct draft *draft;              // what capture.json would say, the files being its images; is
                                      // taken over
    struct changed_picture *changed;  // [lights], or NULL; belongs to the capture, unless it fails
    struct relume_image mask;         // empty: none; likewise
    int width, height;
    const char *path;  // begins sentences
};
relume_status capture_of_files(relume_capture **out, const struct capture_files *files,
                               const struct relume_capture_params *params);

// From now on the capture is that part of its images, depth and masks; its window and provenance
// follow. Before anything is read of it. RELUME_EINVAL for a part that does not lie within them,
// RELUME_EUNFIT for panoramas and slabs around an object, RELUME_ENOMEM.
relume_status capture_crop(relume_capture *capture, const struct relume_rect *part,
                           const struct relume_log *log);

// One image of a capture of pictures in memory, which follow each other there.
struct picture_array capture_array(const relume_capture *capture, int view, int light);

// One image of the capture, wherever it is.
relume_status capture_picture(picture_reader **out, const relume_capture *capture, int view,
                              int light, const struct relume_limits *limits,
                              const struct relume_log *log);

// The rows of one image, light intensity divided out, coded by `to`; NaN and infinity are errors
// unless the capture is repaired.
relume_status capture_stream(struct image_stream *out, const relume_capture *capture, int view,
                             int light, struct relume_transfer to, const struct relume_log *log);

#endif
