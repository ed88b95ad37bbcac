// photograph.c - one photograph: what the camera noted, its pixels turned upright and linearised
#include "image/image/photograph.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "image/image/image.h"
#include "image/image/pages.h"
#include "image/image/picture.h"
#include "image/image/profile.h"

#include <math.h>
#include <string.h>

static const float identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

// ---------------------------------------------------------------- notes

static bool is_turned_sideways(int orientation)
{
    return orientation >= 5;
}

// `profile` may be NULL.
static relume_status notes_of(struct relume_exif *out, const picture_reader *reader,
                              struct profile *profile, const struct relume_log *log)
{
    size_t size;
    const void *icc = picture_profile(reader, &size);
    struct profile own = {0};
    const relume_status status = picture_notes(reader, out, log);
    profile = profile ? profile : &own;
    out->profile =
        icc && picture_info_of(reader)->channels >= 3 && profile_read(profile, icc, size);
    memcpy(out->to_srgb, out->profile ? profile->to_srgb : identity, sizeof out->to_srgb);
    if (is_turned_sideways(out->orientation)) {
        out->width = picture_info_of(reader)->height;
        out->height = picture_info_of(reader)->width;
    }
    return status;
}

relume_status photograph_notes(struct relume_exif *out, const char *path,
                               const struct relume_limits *limits, const struct relume_log *log)
{
    picture_reader *reader;
    *out = (struct relume_exif){0};
    relume_status status = page_open(&reader, path, limits, log);
    if (status)
        return status;
    status = notes_of(out, reader, NULL, log);
    picture_close(&reader);
    return status;
}

relume_status relume_exif_read(struct relume_exif *out, const char *path,
                               const struct relume_log *log)
{
    return photograph_notes(out, path, NULL, log);
}

double relume_exif_exposure(const struct relume_exif *notes)
{
    const double f = notes->f_number > 0.0 ? notes->f_number : 1.0;
    const double iso = notes->iso > 0.0 ? notes->iso / 100.0 : 1.0;
    return notes->time_s * iso / (f * f);
}

// ---------------------------------------------------------------- pixels

// Where pixel (x, y) of the upright picture lies in the file of `width` x `height` (EXIF 2.3, tag
// 274).
static size_t place_in_file(int orientation, int x, int y, int width, int height)
{
    const int right = width - 1, bottom = height - 1;
    const int u[] = {x, right - x, right - x, x, y, y, right - y, right - y};
    const int v[] = {y, y, bottom - y, bottom - y, x, bottom - x, bottom - x, x};
    return (size_t)v[orientation - 1] * (size_t)width + (size_t)u[orientation - 1];
}

void photograph_turn_vector(double xy[2], int orientation)
{
    const double x = xy[0], y = xy[1];
    const double u[] = {x, -x, -x, x, -y, y, y, -y}, v[] = {y, y, -y, -y, -x, -x, x, x};
    if (orientation >= 1 && orientation <= 8) {
        xy[0] = u[orientation - 1];
        xy[1] = v[orientation - 1];
    }
}

static relume_status turn(struct relume_image *image, int orientation)
{
    struct relume_image upright;
    const bool sideways = is_turned_sideways(orientation);
    const relume_status status =
        relume_image_create(&upright, sideways ? image->height : image->width,
                            sideways ? image->width : image->height, 3);
    if (status)
        return status;
    float *out = upright.data;
    for (int y = 0; y < upright.height; y++)
        for (int x = 0; x < upright.width; x++, out += 3)
            memcpy(out,
                   image->data + 3 * place_in_file(orientation, x, y, image->width, image->height),
                   3 * sizeof *out);
    relume_image_destroy(image);
    *image = upright;
    return RELUME_OK;
}

static void follow_profile(struct relume_image *image, const struct profile *profile)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++)
        for (int c = 0; c < 3; c++)
            image->data[3 * i + (size_t)c] =
                profile_decode(profile, c, image->data[3 * i + (size_t)c]);
    relume_primaries_apply(image, profile->to_srgb);
}

static relume_status read_pixels(struct relume_image *out, const char *path, picture_reader *reader,
                                 struct relume_transfer from, const struct relume_log *log)
{
    static const float no_gain[3] = {1.0f, 1.0f, 1.0f};
    const struct picture_info info = *picture_info_of(reader);
    struct image_stream stream;
    relume_status status =
        image_stream_open(&stream, reader, 3, image_transfer(from, &info),
                          (struct relume_transfer){.curve = RELUME_CURVE_LINEAR}, no_gain);
    if (status)
        return status;
    stream.finite_only = true;
    status = relume_image_create(out, info.width, info.height, 3);
    if (!status)
        status = image_stream_read(&stream, 0, info.height, out->data);
    if (relume_status_is_input(status))
        (void)log_fail(log, status, "%s: %s", path, image_stream_error(&stream));
    image_stream_close(&stream);
    return status;
}

relume_status relume_photograph_load(struct relume_image *out, struct relume_exif *notes,
                                     const char *path,
                                     const struct relume_photograph_params *params)
{
    const struct relume_photograph_params p = PARAMS(relume_photograph_params, params);
    struct relume_exif own = {0};
    picture_reader *reader;
    size_t icc_size;
    *out = (struct relume_image){0};
    notes = notes ? notes : &own;
    *notes = (struct relume_exif){0};
    struct profile *profile = mem_array(1, sizeof *profile);
    if (!profile)
        return RELUME_ENOMEM;
    relume_status status = page_open(&reader, path, p.limits, p.log);
    if (status) {
        mem_free(profile);
        return status;
    }
    status = picture_need_colour(reader, path, p.log);
    if (!status)
        status = notes_of(notes, reader, profile, p.log);
    const bool follow = notes->profile && !p.codes && p.transfer.curve == RELUME_CURVE_AUTO;
    if (!notes->profile && picture_profile(reader, &icc_size))
        log_line(p.log, RELUME_WARNING,
                 "%s: its colour profile is of a kind that relume does not read; treated as sRGB",
                 path);
    struct relume_transfer from = {.curve = RELUME_CURVE_LINEAR};
    if (!p.codes && !follow)
        from = p.transfer;
    if (status)
        picture_close(&reader);
    else
        status = read_pixels(out, path, reader, from, p.log);
    if (!status && follow)
        follow_profile(out, profile);
    const int orientation = p.orientation ? p.orientation : notes->orientation;
    if (!status && !p.not_turned && orientation > 1)
        status = turn(out, orientation);
    notes->width = out->width;
    notes->height = out->height;
    if (status)
        relume_image_destroy(out);
    mem_free(profile);
    return status;
}
