// bracket.h - the photographs of one radiance map on their way through `relume hdr`
#ifndef CLI_BRACKET_H
#define CLI_BRACKET_H

#include "cli/cli.h"

enum { MAX_BRACKET = 64 };

// What `relume hdr` is asked.
enum align_mode { ALIGN_NONE, ALIGN_BLOCKS, ALIGN_HOMOGRAPHY };
struct hdr_options {
    struct args args;
    const char *output, *times, *response, *save_response, *flat;
    struct relume_transfer transfer;
    enum relume_merge_weights weights;
    enum align_mode align;
    double white[4];
    bool old, json, skip_bad, ghosts, radial;
};

struct bracket {
    int n, anchor;
    bool aligned;  // to the anchor
    const char *path[MAX_BRACKET];
    struct relume_exif notes[MAX_BRACKET];
    struct relume_image codes[MAX_BRACKET], masks[MAX_BRACKET];  // masks may be empty: all good
    double exposure[MAX_BRACKET];
    double shift[MAX_BRACKET];   // median displacement, pixels; 0 when not aligned
    double ghosts[MAX_BRACKET];  // part of the pixels
    struct relume_exposure_report report[MAX_BRACKET];
    struct relume_response response;
    char response_name[32];
    const char *response_source;  // "recovered", "linear", or where it was read
    struct relume_image out;
};

// Reads the photographs that `path`, `notes` and `n` name. With `skip_bad` those that cannot be
// read or are of another size are left out with a warning.
relume_status bracket_load(struct bracket *b, const struct hdr_options *o);
// One scene, and longer exposures are brighter.
relume_status bracket_check(struct bracket *b, const struct hdr_options *o);
relume_status bracket_align(struct bracket *b, const struct hdr_options *o);
relume_status bracket_merge(struct bracket *b, const struct hdr_options *o);
// Leave photograph i out; RELUME_EUNFIT with a sentence when none remains.
void bracket_drop(struct bracket *b, int i);
relume_status bracket_remains(const struct bracket *b);
void bracket_free(struct bracket *b);

#endif
