// pack_parts.h - parts of a view's codes, against the whole; after test.h
#ifndef PACK_PARTS_H
#define PACK_PARTS_H

#include "format/coder/coding.h"
#include "format/pack/views.h"

#include <relume/pack.h>
#include <string.h>

// Part of a view is read as it is in the whole, whether that is in memory or not; what is no part
// is refused.
static void check_parts(relume_pack *pack, int view)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const int w = info->width, h = info->height;
    const struct relume_rect some[] = {
        {0, 0, w, h}, {w / 3, h / 2, w - w / 3, 1}, {0, h - 1, 1, 1}, {w / 2, h / 4, 1, h - h / 4}};
    const struct relume_rect wrong[] = {{-1, 0, 1, 1}, {0, 0, w + 1, 1}, {0, h, 1, 1},
                                        {0, 0, 0, 1},  {1, 0, w, 1},     {0, 1, 1, h}};
    const struct relume_codes *whole;
    struct relume_codes_part part;
    for (int i = 0; i < 2 * (int)(sizeof some / sizeof *some); i++) {
        const struct relume_rect at = some[i / 2];
        relume_pack_drop(pack, view);
        if (i % 2)
            CHECK_OK(relume_pack_codes(&whole, pack, view));
        CHECK_OK(relume_pack_codes_part(&part, pack, view, &at));
        CHECK_OK(relume_pack_codes(&whole, pack, view));
        assert_true(part.codes.width == at.width && part.codes.height == at.height);
        for (int y = 0; y < at.height; y++)
            for (int p = 0; p < whole->planes; p++) {
                float got[64], want[64];
                relume_codes_plane(&part.codes, p, (size_t)(y * at.width), (size_t)at.width, got);
                relume_codes_plane(whole, p, (size_t)((at.top + y) * w + at.left), (size_t)at.width,
                                   want);
                assert_memory_equal(got, want, sizeof *got * (size_t)at.width);
            }
        relume_codes_part_destroy(&part);
    }
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(relume_pack_codes_part(&part, pack, view, &wrong[i]), RELUME_EINVAL);
    assert_int_equal(relume_pack_codes_part(&part, pack, info->views, &some[0]), RELUME_EINVAL);
}

#endif
