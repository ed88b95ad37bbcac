// format.c - what writer and reader of a relume file agree on beside names
#include "pack/format.h"

const char *const format_book_kinds[3] = {
    [RELUME_BOOK_PLANES] = "planes", [RELUME_BOOK_LUMA] = "luma", [RELUME_BOOK_CHROMA] = "chroma"};

int format_plane(const struct relume_coder_info *info, int channel)
{
    if (info->luminance && channel >= info->coefficients)
        return 2 * info->coefficients + 2 - channel;
    return info->joint ? channel : channel / 3 * 3 + 2 - channel % 3;
}
