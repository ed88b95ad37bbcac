// picture_exr.c - EXR pictures of the plain kind: one part of scanlines, grey or red, green and
// blue, perhaps with alpha, and nothing noted in the header; and those of luminance and colour
#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/exr.h"
#include "core/base/half.h"
#include "image/image/luma_chroma.h"
#include "image/image/picture.h"
#include "image/image/picture_format.h"

#include <errno.h>
#include <string.h>

struct exr_picture {
    picture_reader reader;  // first
    exr_file *file;
    exr_blocks *blocks;
    luma_chroma *coarse;  // or NULL
    bool half, failed;
};

static relume_status read_floats(picture_reader *reader, int row, int rows, float *out)
{
    struct exr_picture *p = (struct exr_picture *)reader;
    const size_t n = (size_t)reader->info.channels, width = (size_t)reader->info.width;
    for (int y = row; y < row + rows; y++) {
        const void *from;
        const relume_status status = exr_blocks_row(p->blocks, y, &from);
        p->failed |= relume_status_is_input(status);
        if (status)
            return status;
        for (size_t c = 0; c < n; c++)
            for (size_t x = 0; x < width; x++)
                out[x * n + c] = p->half ? float_from_half(((const uint16_t *)from)[c * width + x])
                                         : ((const float *)from)[c * width + x];
        out += n * width;
    }
    return RELUME_OK;
}

static relume_status read_coarse(picture_reader *reader, int row, int rows, float *out)
{
    struct exr_picture *p = (struct exr_picture *)reader;
    relume_status status = RELUME_OK;
    (void)row;  // from the top on
    for (; !status && rows > 0; rows--, out += 3 * (size_t)reader->info.width)
        status = luma_chroma_next(p->coarse, out);
    p->failed |= relume_status_is_input(status);
    return status;
}

static const char *error(const picture_reader *reader)
{
    return ((const struct exr_picture *)reader)->failed ? "truncated or damaged" : "";
}

static void close(picture_reader *reader)
{
    struct exr_picture *p = (struct exr_picture *)reader;
    exr_blocks_close(&p->blocks);
    luma_chroma_close(&p->coarse);
    exr_close(&p->file);
    mem_free(p);
}

static const struct picture_format format = {
    .read_floats = read_floats, .error = error, .close = close};
static const struct picture_format coarse_format = {
    .read_floats = read_coarse, .error = error, .close = close};

// What is neither grey nor R, G, B with or without A is left to OpenImageIO.
static bool find_colour(struct picture_info *info, const exr_file *file)
{
    const char *names[4];
    if (info->channels != 1 && info->channels != 3 && info->channels != 4)
        return false;
    for (int i = 0; i < info->channels; i++)
        names[i] = exr_channel_name(file, 0, i);
    picture_find_colour(info, names);
    return !info->other[0] && (info->channels == 1) == (info->rgb[0] == info->rgb[2]);
}

static bool is_plain(struct picture_info *out, const exr_file *file)
{
    const struct exr_part_info info = exr_part_info(file, 0);
    *out = (struct picture_info){.width = info.width,
                                 .height = info.height,
                                 .x = info.x,
                                 .y = info.y,
                                 .channels = info.channels,
                                 .floats = true,
                                 .linear = true,
                                 .jumps = true};
    return exr_part_count(file) == 1 && info.uniform && info.sample != EXR_SAMPLE_UINT &&
           strcmp(info.codec, "other") && exr_is_plain(file, 0) && find_colour(out, file);
}

// OpenImageIO does not read these either, and says so once for each channel.
static relume_status refuse_subsampled(const exr_file *file, const char *path,
                                       const struct relume_log *log)
{
    const struct exr_part_info info = exr_part_info(file, 0);
    if (!info.subsampled)
        return RELUME_OK;
    return log_fail(
        log, RELUME_EUNSUPPORTED,
        "%s: its channels (%s, ...) differ in resolution, as luminance with coarser colour (Y, "
        "RY, BY); convert it to RGB first, with ImageMagick: convert %s rgb.exr",
        path, exr_channel_name(file, 0, 0), path);
}

relume_status exr_picture_open(picture_reader **out, const char *path,
                               const struct relume_reader *from, const struct relume_limits *limits,
                               const struct relume_log *log)
{
    exr_file *file;
    struct picture_info info;
    *out = NULL;
    relume_status status = exr_open(&file, path, from, limits, NULL);
    if (status == RELUME_ESYSTEM)  // said to nobody: the module would be next to fail
        return relume_input_fail(log, path, "cannot be opened", EMFILE);
    if (status)
        return status == RELUME_ENOMEM ? status : RELUME_OK;
    struct exr_picture *p = mem_zeroed(1, sizeof *p);
    status = p ? luma_chroma_open(&p->coarse, file) : RELUME_ENOMEM;
    const bool plain = p && is_plain(&info, file) && !p->coarse;
    if (!status && plain)
        status = exr_blocks_open(&p->blocks, file, 0);
    if (relume_status_is_input(status))
        status = RELUME_OK;
    else if (!status && !plain && !p->coarse)
        status = refuse_subsampled(file, path, log);
    if (status || !(p->blocks || p->coarse)) {
        mem_free(p);
        exr_close(&file);
        return status;
    }
    p->reader = (picture_reader){.format = p->coarse ? &coarse_format : &format, .info = info};
    if (p->coarse) {
        p->reader.info.jumps = false;
        p->reader.info.channels = 3;
        for (int c = 0; c < 3; c++)
            p->reader.info.rgb[c] = c;
        p->reader.info.other[0] = '\0';
    }
    p->file = file;
    p->half = exr_part_info(file, 0).sample == EXR_SAMPLE_HALF;
    *out = &p->reader;
    return RELUME_OK;
}
