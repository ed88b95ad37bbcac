// charts.h - triangles in groups that lie flat
#ifndef SHAPE_CHARTS_H
#define SHAPE_CHARTS_H

#include <relume/base.h>

// A corner of a triangle that is flattened.
struct atlas_corner {
    float position[3], normal[3];
    float place[2];  // in the atlas, 0 to 1, from its upper left corner
};

struct charts {
    size_t *of;     // [triangles]
    uint8_t *face;  // [triangles]: which of six ways its chart faces
    size_t count;
};

// Neighbours over an edge, by the places of its ends, that face the same of six ways; those of the
// `alone` (NULL: none) are a chart each. Charts of less area than `small` go over to larger ones
// beside them as far as they face these, too. RELUME_ENOMEM.
relume_status charts_make(struct charts *out, struct atlas_corner (*triangle)[3], size_t n,
                          const bool *alone, double small);
void charts_free(struct charts *charts);

// Places for all corners: every chart as it is seen from where it faces, as large as fits, packed
// in rows with a texel around each. RELUME_EUNFIT with a sentence, RELUME_ENOMEM.
relume_status charts_place(const struct charts *charts, struct atlas_corner (*triangle)[3],
                           size_t n, int width, int height, const struct relume_log *log);

#endif
