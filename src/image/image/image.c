// image.c - images made and destroyed, and code values as linear light, whole and as streams
#include "image/image/image.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/scratch.h"
#include "core/base/thread.h"
#include "core/base/tree.h"
#include "image/image/exr.h"
#include "core/base/half.h"
#include "core/math/float_steps.h"
#include "image/image/picture_kind.h"
#include "image/image/profile.h"

#include <errno.h>
#include <math.h>
#include <relume/image/response.h>
#include <stdio.h>
#include <string.h>

relume_status relume_image_create(struct relume_image *out, int width, int height, int channels)
{
    *out = (struct relume_image){0};
    if (width < 1 || height < 1 || channels < 1)
        return RELUME_EINVAL;
    float *data = mem_zeroed((size_t)width * (size_t)height, (size_t)channels * sizeof *data);
    if (!data)
        return RELUME_ENOMEM;
    *out = (struct relume_image){width, height, channels, .data = data};
    return RELUME_OK;
}

// From so many bytes on an image is better kept on disk.
static const size_t LARGE = 64 << 20;

relume_status image_create_large(struct relume_image *out, int width, int height, int channels,
                                 const char *near, const struct relume_log *log)
{
    const size_t bytes = (size_t)width * (size_t)height * (size_t)channels * sizeof *out->data;
    if (bytes <= LARGE)
        return relume_image_create(out, width, height, channels);
    *out = (struct relume_image){width, height, channels, .mapped = bytes};
    out->data = scratch_map(near, bytes);
    if (out->data)
        return RELUME_OK;
    *out = (struct relume_image){0};
    return log_fail(log, RELUME_EIO, "%s: no room for temporary data of %zu MB; %s",
                    near ? near : "$TMPDIR", bytes >> 20, strerror(errno));
}

void image_forget(const struct relume_image *image, int row, int rows)
{
    const size_t line = (size_t)image->width * (size_t)image->channels * sizeof *image->data;
    if (image->mapped)
        scratch_forget(image->data, image->mapped, (size_t)row * line, (size_t)rows * line);
}

void relume_image_destroy(struct relume_image *image)
{
    if (image->mapped)
        scratch_unmap(image->data, image->mapped);
    else
        mem_free(image->data);
    *image = (struct relume_image){0};
}

relume_status image_part(struct relume_image *out, const struct relume_image *image,
                         const struct relume_rect *part)
{
    const size_t channels = (size_t)image->channels, row = channels * (size_t)part->width;
    const relume_status status =
        relume_image_create(out, part->width, part->height, image->channels);
    for (size_t y = 0; !status && y < (size_t)part->height; y++)
        memcpy(out->data + y * row,
               image->data +
                   channels * (((size_t)part->top + y) * (size_t)image->width + (size_t)part->left),
               row * sizeof *out->data);
    return status;
}

relume_status image_crop(struct relume_image *image, const struct relume_rect *part)
{
    struct relume_image cropped;
    const relume_status status = image_part(&cropped, image, part);
    if (!status) {
        relume_image_destroy(image);
        *image = cropped;
    }
    return status;
}

// ---------------------------------------------------------------- streams

struct relume_transfer image_transfer(struct relume_transfer transfer,
                                      const struct picture_info *info)
{
    if (transfer.curve == RELUME_CURVE_AUTO)
        transfer.curve = info->linear ? RELUME_CURVE_LINEAR : RELUME_CURVE_SRGB;
    return transfer;
}

static bool is_same(struct relume_transfer a, struct relume_transfer b)
{
    return a.curve == b.curve &&
           ((a.curve != RELUME_CURVE_GAMMA && a.curve != RELUME_CURVE_LOG) || a.gamma == b.gamma) &&
           (a.curve != RELUME_CURVE_RESPONSE || a.response == b.response);
}

static float decode(struct relume_transfer transfer, int channel, float code)
{
    return transfer.curve == RELUME_CURVE_RESPONSE
               ? relume_response_decode(transfer.response, channel, code)
               : relume_transfer_decode(transfer, code);
}

static float recode(const struct image_stream *s, int channel, float code)
{
    if (s->gain[channel] == 1.0f && is_same(s->from, s->to) && !s->rounded)
        return code;
    float linear = decode(s->from, channel, code);
    if (s->rounded)
        linear = float_from_half(half_from_float(linear));
    return relume_transfer_encode(s->to, linear / s->gain[channel]);
}

static bool is_plain(const struct image_stream *s, const struct picture_info *info)
{
    bool plain = s->channels == 3 && info->channels == 3;
    for (int c = 0; c < 3; c++) {
        plain = plain && info->rgb[c] == c;
        for (int v = 0; v < 256; v++)
            plain = plain && s->table[c][v] == (float)v / 255.0f;
    }
    return plain;
}

static void make_tables(struct image_stream *s)
{
    for (int c = 0; c < 3; c++)
        for (int v = 0; v < 256; v++)
            s->table[c][v] = recode(s, c, (float)v / 255.0f);
    s->plain = is_plain(s, picture_info_of(s->reader));
}

relume_status image_stream_open(struct image_stream *stream, picture_reader *reader, int channels,
                                struct relume_transfer from, struct relume_transfer to,
                                const float gain[3])
{
    const struct picture_info *info = picture_info_of(reader);
    *stream = (struct image_stream){
        .reader = reader,
        .channels = channels,
        .from = from,
        .to = to,
        .gain = {gain[0], gain[1], gain[2]},
        .scratch = mem_array((size_t)info->width * (size_t)info->channels,
                             IMAGE_STREAM_ROWS * (info->bytes ? 1 : sizeof(float))),
    };
    if (!stream->scratch) {
        image_stream_close(stream);
        return RELUME_ENOMEM;
    }
    make_tables(stream);
    stream->unpack = kernels_choose(0)->unpack;
    return RELUME_OK;
}

void image_stream_round(struct image_stream *stream)
{
    if (picture_info_of(stream->reader)->floats)
        return;
    stream->rounded = true;
    make_tables(stream);
}

void image_stream_close(struct image_stream *stream)
{
    picture_close(&stream->reader);
    mem_free(stream->scratch);
    stream->scratch = NULL;
}

// Which channel is alpha: of two or four the one that is no colour; -1: none.
static int alpha_of(const struct picture_info *info)
{
    const int n = info->channels;
    return n == 2 ? 1 - info->rgb[0] : n == 4 ? 6 - info->rgb[0] - info->rgb[1] - info->rgb[2] : -1;
}

static void convert_bytes(const struct image_stream *s, const struct picture_info *info,
                          const uint8_t *in, size_t pixels, float *out)
{
    const int alpha = alpha_of(info);
    if (s->channels == 3 && info->channels == 3)
        for (size_t x = 0; x < pixels; x++, in += 3, out += 3)
            for (int c = 0; c < 3; c++)
                out[c] = s->table[c][in[info->rgb[c]]];
    else
        for (size_t x = 0; x < pixels; x++, in += info->channels)
            for (int c = 0; c < s->channels; c++)
                *out++ = c < 3       ? s->table[c][in[info->rgb[c]]]
                         : alpha < 0 ? 1.0f
                                     : (float)in[alpha] / 255.0f;
}

// False when a sample is NaN or infinite, or becomes so: 1e30 is, as a code value.
static bool convert_floats(const struct image_stream *s, const struct picture_info *info,
                           size_t pixels, float *out)
{
    const float *in = s->scratch;
    const int alpha = alpha_of(info);
    float sum = 0.0f;  // 0 x finite is 0, 0 x anything else is NaN
    for (size_t x = 0; x < pixels; x++, in += info->channels)
        for (int c = 0; c < s->channels; c++) {
            const float v = c < 3 ? in[info->rgb[c]] : alpha < 0 ? 1.0f : in[alpha];
            const float recoded = c < 3 ? recode(s, c, v) : v;
            sum += 0.0f * v + 0.0f * recoded;
            *out++ = recoded;
        }
    return sum == 0.0f;
}

// Of rows that are mapped no more than some MB stay in memory behind those that are fetched.
static void let_go(const struct image_stream *s, size_t at, size_t bytes)
{
    enum { RUN = 1 << 20 };
    const size_t first = at > 2 * RUN ? at - 2 * RUN : 0;
    if (s->mapped && at / RUN != (at + bytes) / RUN)
        scratch_forget(s->keep ? s->keep : (uint8_t *)(uintptr_t)s->kept, s->mapped, first,
                       at - first);
}

relume_status image_stream_fetch(struct image_stream *s, int row, int rows, const uint8_t **bytes)
{
    const struct picture_info *info = picture_info_of(s->reader);
    const size_t line = (size_t)info->width * (size_t)info->channels, at = (size_t)row * line;
    if (rows > IMAGE_STREAM_ROWS || !picture_has_rows(info, row, rows))
        return RELUME_EINVAL;
    let_go(s, at, (size_t)rows * line);
    if (s->kept) {
        *bytes = s->kept + at;
        return RELUME_OK;
    }
    uint8_t *to = s->keep ? s->keep + at : s->scratch;
    *bytes = to;
    return picture_read_bytes(s->reader, row, rows, to);
}

void image_stream_planes(const struct image_stream *s, const uint8_t *bytes, size_t pixels,
                         float *out, size_t stride)
{
    const struct picture_info *info = picture_info_of(s->reader);
    if (s->plain) {
        s->unpack->thirds(bytes, pixels, out, out + stride, out + 2 * stride);
        return;
    }
    for (size_t c = 0; c < 3; c++) {
        const float *table = s->table[c];
        const uint8_t *in = bytes + info->rgb[c];
        float *to = out + c * stride;
        for (size_t x = 0; x < pixels; x++)
            to[x] = table[in[x * (size_t)info->channels]];
    }
}

static relume_status read_bytes(struct image_stream *s, const struct picture_info *info, int row,
                                int rows, float *out)
{
    const uint8_t *in;
    const relume_status status = image_stream_fetch(s, row, rows, &in);
    if (!status)
        convert_bytes(s, info, in, (size_t)rows * (size_t)info->width, out);
    return status;
}

static relume_status read_floats(const struct image_stream *s, const struct picture_info *info,
                                 int row, int rows, float *out)
{
    const relume_status status = picture_read_floats(s->reader, row, rows, s->scratch);
    if (status)
        return status;
    const bool finite = convert_floats(s, info, (size_t)rows * (size_t)info->width, out);
    return finite || !s->finite_only ? RELUME_OK : RELUME_EDAMAGED;
}

relume_status image_stream_read(struct image_stream *stream, int row, int rows, float *out)
{
    const struct picture_info *info = picture_info_of(stream->reader);
    for (int end = row + rows; row < end; row += IMAGE_STREAM_ROWS) {
        const int n = end - row < IMAGE_STREAM_ROWS ? end - row : IMAGE_STREAM_ROWS;
        const relume_status status = info->bytes ? read_bytes(stream, info, row, n, out)
                                                 : read_floats(stream, info, row, n, out);
        if (status)
            return status;
        out += (size_t)n * (size_t)info->width * (size_t)stream->channels;
    }
    return RELUME_OK;
}

relume_status image_stream_skip(struct image_stream *stream, int row, int rows)
{
    const struct picture_info *info = picture_info_of(stream->reader);
    relume_status status = RELUME_OK;
    const uint8_t *bytes;
    if (stream->kept || (info->jumps && !stream->keep))
        return RELUME_OK;
    for (int end = row + rows, n; !status && row < end; row += n) {
        n = end - row < IMAGE_STREAM_ROWS ? end - row : IMAGE_STREAM_ROWS;
        status = info->bytes ? image_stream_fetch(stream, row, n, &bytes)
                             : picture_read_floats(stream->reader, row, n, stream->scratch);
    }
    return status;
}

bool image_stream_is_broken(const struct image_stream *stream)
{
    return !*picture_error(stream->reader);
}

const char *image_stream_error(const struct image_stream *stream)
{
    const char *said = picture_error(stream->reader);
    return *said ? said : "holds NaN or infinite values; expected finite radiance";
}

// ---------------------------------------------------------------- files

static relume_status read_rows(struct relume_image *image, struct image_stream *stream)
{
    const size_t line = (size_t)image->width * (size_t)image->channels;
    relume_status status = RELUME_OK;
    for (int y = 0, rows; !status && y < image->height; y += rows) {
        rows = image->height - y < IMAGE_STREAM_ROWS ? image->height - y : IMAGE_STREAM_ROWS;
        status = image_stream_read(stream, y, rows, image->data + (size_t)y * line);
        image_forget(image, y, rows);
    }
    return status;
}

// `large`: as image_load_large.
static relume_status load(struct relume_image *out, const char *path,
                          const struct relume_image_params *params, bool large, const char *near)
{
    const struct relume_image_params p = PARAMS_WORK(relume_image_params, params);
    const int channels = p.channels == 1 || p.channels == 4 ? p.channels : 3;
    static const float no_gain[3] = {1.0f, 1.0f, 1.0f};
    *out = (struct relume_image){0};
    if (!path && !p.reader)
        return RELUME_EINVAL;
    path = infile_name(path);

    picture_reader *reader;
    relume_status status = picture_open(&reader, path, p.reader, p.limits, p.log);
    if (status)
        return status;
    if (channels >= 3)
        status = picture_need_colour(reader, path, p.log);
    if (status) {
        picture_close(&reader);
        return status;
    }
    const struct picture_info info = *picture_info_of(reader);
    struct image_stream stream;
    status = image_stream_open(&stream, reader, channels, image_transfer(p.transfer, &info),
                               (struct relume_transfer){.curve = RELUME_CURVE_LINEAR}, no_gain);
    if (status)
        return status;
    status = large ? image_create_large(out, info.width, info.height, channels, near, p.log)
                   : relume_image_create(out, info.width, info.height, channels);
    if (!status)
        status = read_rows(out, &stream);
    if (relume_status_is_input(status))
        (void)log_fail(p.log, status, "%s: %s", path, image_stream_error(&stream));
    if (status)
        relume_image_destroy(out);
    image_stream_close(&stream);
    return status;
}

relume_status relume_image_load(struct relume_image *out, const char *path,
                                const struct relume_image_params *params)
{
    return load(out, path, params, false, NULL);
}

relume_status image_load_large(struct relume_image *out, const char *path,
                               const struct relume_image_params *params, const char *near)
{
    return load(out, path, params, true, near);
}

struct exr_source {
    const struct relume_image *image;
    bool half;
};

// Channels sort as A, B, G, R: the reverse of memory order.
static relume_status exr_rows(void *context, int row, int rows, void *samples)
{
    const struct exr_source *s = context;
    const int n = s->image->channels;
    const size_t width = (size_t)s->image->width;
    uint16_t *halves = samples;
    float *floats = samples;
    for (int y = row; y < row + rows; y++)
        for (int c = n - 1; c >= 0; c--) {
            const float *in = s->image->data + (size_t)y * width * (size_t)n + c;
            for (size_t x = 0; x < width; x++)
                if (s->half)
                    *halves++ = half_from_float(in[x * (size_t)n]);
                else
                    *floats++ = in[x * (size_t)n];
        }
    return RELUME_OK;
}

static relume_status save_exr(const struct relume_image *image, const char *path,
                              const struct relume_image_params *p)
{
    static const char *const rgb[] = {"A", "B", "G", "R"};
    static const char *const grey[] = {"Y"};
    struct exr_source source = {image, p->half};
    const struct exr_part part = {
        .name = "image",
        .width = image->width,
        .height = image->height,
        .sample = p->half ? EXR_SAMPLE_HALF : EXR_SAMPLE_FLOAT,
        .codec = EXR_CODEC_PIZ,
        .channels = image->channels,
        .channel = image->channels == 1 ? grey : rgb + 4 - image->channels,
        .rows = exr_rows,
        .context = &source,
    };
    struct relume_log quiet = p->log ? *p->log : (struct relume_log){0};
    quiet.progress = NULL;  // one image is not long work
    return exr_write(path, p->writer, &part, 1, false, p->threads > 1 ? p->threads : 1, &quiet);
}

static int code_of(float v, float top)
{
    return v >= 1.0f ? (int)top : v > 0.0f ? (int)(v * top + 0.5f) : 0;
}

static int srgb_byte(float linear)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    return code_of(relume_transfer_encode(srgb, linear), 255.0f);
}

static int srgb_word(float linear)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    return code_of(relume_transfer_encode(srgb, linear), 65535.0f);
}

struct quantising {
    const struct relume_image *image;
    void *out;
    size_t bytes;
    bool data;
    struct float_steps srgb;  // of one byte
};

static void quantise_row(void *context, size_t y, int worker)
{
    const struct quantising *q = context;
    const size_t channels = (size_t)q->image->channels, n = (size_t)q->image->width * channels;
    const float *from = q->image->data + y * n;
    uint8_t *narrow = (uint8_t *)q->out + y * n;
    uint16_t *wide = (uint16_t *)q->out + y * n;
    (void)worker;
    for (size_t i = 0; i < n; i++) {
        const bool as_is = q->data || (channels == 4 && i % 4 == 3);
        if (q->bytes == 2)
            wide[i] = (uint16_t)(as_is ? code_of(from[i], 65535.0f) : srgb_word(from[i]));
        else
            narrow[i] = (uint8_t)(as_is ? code_of(from[i], 255.0f) : float_step(&q->srgb, from[i]));
    }
}

// Codes of `bytes` each, of light those of sRGB.
static void quantise(void *out, const struct relume_image *image, size_t bytes, bool data,
                     int threads)
{
    struct quantising q = {.image = image, .out = out, .bytes = bytes, .data = data};
    if (bytes == 1 && !data)
        float_steps_init(&q.srgb, srgb_byte, 255);
    thread_for(threads, (size_t)image->height, quantise_row, &q);
}

static relume_status save_codes(const struct relume_image *image, const char *path,
                                const struct relume_image_params *p)
{
    const size_t n = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    const size_t bytes = p->bits == 16 ? 2 : 1;
    void *samples = mem_array(n, bytes);
    struct picture_codes codes = {
        .array = {samples, bytes, image->width, image->height, image->channels},
        .data = p->codes,
        .threads = p->threads > 1 ? p->threads : 1};
    void *profile = p->profile ? profile_srgb(&codes.profile_size) : NULL;
    relume_status status = samples && (profile || !p->profile) ? RELUME_OK : RELUME_ENOMEM;
    codes.profile = profile;
    if (!status) {
        quantise(samples, image, bytes, p->codes, codes.threads);
        status = picture_write_codes(path, p->writer, &codes, p->log);
    }
    mem_free(profile);
    mem_free(samples);
    return status;
}

// /dev/stdout and the like have no extension that names the format.
static bool is_device(const char *path)
{
    return !strchr(path_name(path), '.') && tree_is_device(path);
}

bool relume_image_saves_linear(const char *path)
{
    return picture_has_extension(path, ".exr") || is_device(path) || picture_writes_floats(path);
}

bool relume_image_saves_alpha(const char *path)
{
    return picture_has_extension(path, ".exr") || picture_has_extension(path, ".png");
}

bool relume_image_can_save(const char *path)
{
    return relume_image_saves_linear(path) || picture_writes_bytes(path);
}

relume_status relume_image_save(const struct relume_image *image, const char *path,
                                const struct relume_image_params *params)
{
    const struct relume_image_params p = PARAMS_WORK(relume_image_params, params);
    const bool alpha = image->channels == 4;
    if (!path || (image->channels != 1 && image->channels != 3 && !alpha))
        return RELUME_EINVAL;
    if (alpha && !relume_image_saves_alpha(path))
        return log_fail(p.log, RELUME_EINVAL, "%s: no alpha in this format; expected .png or .exr",
                        path);
    if (!relume_image_can_save(path))
        return log_fail(p.log, RELUME_EINVAL,
                        "%s: no picture format for this ending; expected .exr, .png, .jpg, .tif, "
                        ".hdr, ...",
                        path);
    if (p.bits == 16 && !picture_writes_words(path))
        return log_fail(p.log, RELUME_EINVAL,
                        "%s: no 16 bits in this format; expected .png or .tif", path);
    if (picture_has_extension(path, ".exr") || is_device(path))
        return save_exr(image, path, &p);
    if (picture_writes_floats(path))
        return picture_write_floats(path, p.writer, image->width, image->height, image->channels,
                                    image->data, p.log);
    return save_codes(image, path, &p);
}
