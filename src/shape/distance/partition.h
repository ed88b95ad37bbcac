// partition.h - the two ways to find planes: which triangles go to which of them
#ifndef DISTANCE_PARTITION_H
#define DISTANCE_PARTITION_H

#include "shape/distance/plane.h"

#include <relume/shape/billboards.h>

// Triangles of a plane are a list: `head` of a plane, `next` of a triangle; NOBODY ends it.
#define NOBODY 0xffffffffu
struct partition {
    struct plane *plane;  // [count], in the middle of its triangles
    uint32_t *head;       // [count]
    uint32_t *next;       // [triangles]
    size_t count;
};
relume_status partition_create(struct partition *out, const struct soup *s);
void partition_free(struct partition *p);

// `error` is a length here, infinite for none. RELUME_ENOMEM, RELUME_ECANCEL.
relume_status cluster_planes(struct partition *out, const struct soup *s, double error,
                             const struct relume_billboards_params *params);
relume_status greedy_planes(struct partition *out, const struct soup *s, double error,
                            const struct relume_log *log);

#endif
