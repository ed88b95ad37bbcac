// format.c - what writer and reader of a relume file agree on beside names
#include "format/pack/format.h"

#include "format/codebook/books.h"
#include "image/geometry/camera.h"

#include <math.h>

const char *const format_book_kinds[3] = {
    [RELUME_BOOK_PLANES] = "planes", [RELUME_BOOK_LUMA] = "luma", [RELUME_BOOK_CHROMA] = "chroma"};

int format_plane(const struct relume_coder_info *info, int channel)
{
    if (info->luminance && channel >= info->coefficients)
        return 2 * info->coefficients + 2 - channel;
    return info->joint ? channel : channel / 3 * 3 + 2 - channel % 3;
}

void format_turn_depth(struct relume_image *depth, const struct relume_geometry *g,
                       const double uv[2], bool to_axis)
{
    struct camera c = {*g, depth->width, depth->height, {uv[0], uv[1]}, .rectified = false};
    c.geometry.pose = (struct relume_pose){{0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int y = 0, i = 0; g->projection == RELUME_SLAB && y < depth->height; y++)
        for (int x = 0; x < depth->width; x++, i++) {
            const double cosine = fabs(camera_ray_at(&c, x + 0.5, y + 0.5).direction.z);
            depth->data[i] *= (float)(to_axis ? cosine : 1.0 / cosine);
        }
}
