// raking.h - raking light in words: the lowest captured light of a side that shows relief
//
//     raking [SIDE | x y] [rgb r g b]      SIDE: left, upper left, top, ...; default: upper left
#ifndef CLI_RAKING_H
#define CLI_RAKING_H

#include "cli.h"

struct raking {
    struct relume_vec3 side;  // in the plane of the picture
    const char *rest;         // of the words: "rgb r g b" or ""
};

// Returns true for a SPEC that begins with "raking".
bool raking_is(const char *spec);
// Reads a SPEC that begins with "raking". RELUME_EINVAL.
relume_status raking_parse(struct raking *out, const char *spec, const struct relume_log *log);
// The direction that stands in until the file is known, and for files lit from all around.
struct relume_vec3 raking_stand_in(struct relume_vec3 side);
// "upper left" for what lies there.
const char *raking_side_name(struct relume_vec3 side);

#endif
