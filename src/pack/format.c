// format.c - what writer and reader of a relume file agree on beside names
#include "pack/format.h"

#include "geometry/camera.h"

#include <math.h>
#include <string.h>

const char *const format_book_kinds[3] = {
    [RELUME_BOOK_PLANES] = "planes", [RELUME_BOOK_LUMA] = "luma", [RELUME_BOOK_CHROMA] = "chroma"};

int format_plane(const struct relume_coder_info *info, int channel)
{
    if (info->luminance && channel >= info->coefficients)
        return 2 * info->coefficients + 2 - channel;
    return info->joint ? channel : channel / 3 * 3 + 2 - channel % 3;
}

// ---------------------------------------------------------------- functions

static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
enum { BASE = 64, NOTHING = BASE * BASE / 2, MOST = NOTHING - 1 };

void format_functions_text(char *text, const float *numbers, const float *most, int rows, int each)
{
    for (int r = 0; r < rows; r++)
        for (int i = 0; i < each; i++, text += 2) {
            const float part = most[r] > 0.0f ? numbers[r * each + i] / most[r] : 0.0f;
            const int code = NOTHING + (int)lrintf(MOST * part);
            text[0] = DIGITS[code / BASE];
            text[1] = DIGITS[code % BASE];
        }
    *text = 0;
}

static int digit_of(char c)
{
    const char *found = c ? strchr(DIGITS, c) : NULL;
    return found ? (int)(found - DIGITS) : -1;
}

bool format_functions_of_text(float *numbers, const char *text, const float *most, int rows,
                              int each)
{
    for (int r = 0; r < rows; r++)
        for (int i = 0; i < each; i++, text += 2) {
            const int high = digit_of(text[0]), low = digit_of(text[1]);
            if (high < 0 || low < 0)
                return false;
            *numbers++ = most[r] * (float)(BASE * high + low - NOTHING) / (float)MOST;
        }
    return true;
}

// ---------------------------------------------------------------- depth

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
