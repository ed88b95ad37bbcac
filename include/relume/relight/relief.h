// relief.h - the captured lights that show relief, and the lowest of them on a side
//
// Light that stands too low leaves a surface black, for raking light and for an opening picture.
// A light shows relief if RELUME_RELIEF_SHARE of the object is brighter than RELUME_RELIEF_LEVEL of
// the 99th percentile of its picture. That percentile must be at least RELUME_RELIEF_DIM of its
// median over all captured lights. The object is the mask, or what any light shows.
#ifndef RELUME_RELIEF_H
#define RELUME_RELIEF_H

#include <relume/base.h>
#include <relume/pack.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RELUME_RELIEF_SHARE 0.7
#define RELUME_RELIEF_LEVEL 0.04
#define RELUME_RELIEF_DIM   0.25

// Captured lights that show relief, in the order of the capture. Plain data.
struct relume_relief {
    int count;                      // 0: unknown, or the file is a panorama or lit all around
    int *light;                     // [count]: their numbers in the file
    struct relume_vec3 *direction;  // [count]: world, unit; z is the height above the picture
};

// Parameters of relume_relief_find. Borrowed during the call.
struct relume_relief_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;  // default: all cores
};
#define relume_relief_params(...)                                                                  \
    (&(const struct relume_relief_params){RELUME_SIZED(relume_relief_params), __VA_ARGS__})

// Finds the captured lights that show relief in a planar file or in the middle view of one slab,
// whose lights stand in one hemisphere. Other files get a count of 0. If no light qualifies, takes
// those with 0.9 of the best share. Looks at some 16,000 pixels. The codes of the view stay in the
// pack. The caller destroys `out`, which is empty on failure. An input status, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_relief_find(struct relume_relief *out, relume_pack *pack,
                                               const struct relume_relief_params *params);
RELUME_API void relume_relief_destroy(struct relume_relief *relief);

// Returns the index in `relief` of the lowest light whose azimuth lies within 60 degrees of that of
// `side`, or of the lowest with the nearest azimuth. Among lights within two degrees of the lowest
// it takes the one nearest to the azimuth. Only x and y of `side` count; a side that is overhead
// means the upper left. Leaves out the light with index `except` (-1: none). Returns -1 without a
// light.
RELUME_API int relume_relief_lowest(const struct relume_relief *relief, struct relume_vec3 side,
                                    int except);

#ifdef __cplusplus
}
#endif
#endif
