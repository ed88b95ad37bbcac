// av1_write.c - the one place that knows libaom
#include "lossy/av1.h"

#include "base/log.h"
#include "base/memory.h"

#include <aom/aom_encoder.h>
#include <aom/aomcx.h>
#include <string.h>

enum { MOST_KEYFRAME_DISTANCE = 9999 };

struct sequence {
    aom_codec_ctx_t codec;
    aom_codec_enc_cfg_t config;
    aom_image_t *picture;
    unsigned char *bytes;
    size_t size, room;
};

// Every picture has the whole step below or above, so that their mean is the quantiser.
static bool set_step(struct sequence *s, int quantiser, int picture)
{
    const int step = (quantiser * (picture + 1) / AV1_STEPS) - (quantiser * picture / AV1_STEPS);
    s->config.rc_min_quantizer = s->config.rc_max_quantizer = (unsigned)step;
    return !aom_codec_enc_config_set(&s->codec, &s->config) &&
           !aom_codec_control(&s->codec, AOME_SET_CQ_LEVEL, step);
}

static bool control(struct sequence *s, int speed)
{
    return !aom_codec_control(&s->codec, AOME_SET_CPUUSED, speed) &&
           !aom_codec_control(&s->codec, AV1E_SET_COLOR_RANGE, AOM_CR_FULL_RANGE) &&
           !aom_codec_control(&s->codec, AV1E_SET_AQ_MODE, 0) &&
           !aom_codec_control(&s->codec, AV1E_SET_DELTAQ_MODE, 0);
}

static bool begin(struct sequence *s, const struct av1_shape *shape, int speed)
{
    aom_codec_iface_t *av1 = aom_codec_av1_cx();
    const bool grey = shape->components == 1;
    if (aom_codec_enc_config_default(av1, &s->config, AOM_USAGE_GOOD_QUALITY))
        return false;
    aom_codec_enc_cfg_t c = s->config;
    c.g_w = (unsigned)shape->width;
    c.g_h = (unsigned)shape->height;
    c.g_profile = 2;
    c.g_bit_depth = AOM_BITS_12;
    c.g_input_bit_depth = AV1_BITS;
    c.g_threads = 1;
    c.g_lag_in_frames = 0;
    c.monochrome = grey;
    c.rc_end_usage = AOM_Q;
    c.kf_max_dist = MOST_KEYFRAME_DISTANCE;
    s->config = c;
    s->picture =
        aom_img_alloc(NULL, grey ? AOM_IMG_FMT_I42016 : AOM_IMG_FMT_I44416, c.g_w, c.g_h, 16);
    if (!s->picture || aom_codec_enc_init(&s->codec, av1, &c, AOM_CODEC_USE_HIGHBITDEPTH))
        return false;
    s->picture->bit_depth = AV1_BITS;
    s->picture->monochrome = grey;
    return control(s, speed);
}

static void fill(aom_image_t *picture, const uint16_t *samples, const struct av1_shape *shape)
{
    const size_t width = (size_t)shape->width, height = (size_t)shape->height;
    for (int c = 0; c < shape->components; c++)
        for (size_t y = 0; y < height; y++)
            memcpy(picture->planes[c] + (ptrdiff_t)y * picture->stride[c],
                   samples + ((size_t)c * height + y) * width, width * sizeof *samples);
}

// What the encoder has ready joins the bytes; *any: there was something.
static bool collect(struct sequence *s, bool *any)
{
    const aom_codec_cx_pkt_t *p;
    aom_codec_iter_t at = NULL;
    *any = false;
    while ((p = aom_codec_get_cx_data(&s->codec, &at))) {
        if (p->kind != AOM_CODEC_CX_FRAME_PKT)
            continue;
        const size_t size = p->data.frame.sz;
        if (s->size + size > s->room) {
            unsigned char *more = mem_resize(s->bytes, 2 * (s->size + size), 1);
            if (!more)
                return false;
            s->bytes = more;
            s->room = 2 * (s->size + size);
        }
        memcpy(s->bytes + s->size, p->data.frame.buf, size);
        s->size += size;
        *any = true;
    }
    return true;
}

static bool run(struct sequence *s, const uint16_t *samples, const struct av1_shape *shape,
                int quantiser)
{
    const size_t picture = (size_t)shape->components * (size_t)shape->width * (size_t)shape->height;
    bool any = true;
    for (int i = 0; i < shape->pictures; i++) {
        fill(s->picture, samples + (size_t)i * picture, shape);
        if (!set_step(s, quantiser, i) || aom_codec_encode(&s->codec, s->picture, i, 1, 0) ||
            !collect(s, &any))
            return false;
    }
    while (any)
        if (aom_codec_encode(&s->codec, NULL, 0, 0, 0) || !collect(s, &any))
            return false;
    return true;
}

relume_status av1_encode(unsigned char **bytes, size_t *size, const uint16_t *samples,
                         const struct av1_shape *shape, int quantiser, int speed,
                         const struct relume_log *log)
{
    struct sequence s = {0};
    const bool done = begin(&s, shape, speed) && run(&s, samples, shape, quantiser);
    const bool memory = s.codec.err == AOM_CODEC_OK || s.codec.err == AOM_CODEC_MEM_ERROR;
    relume_status status = done ? RELUME_OK : RELUME_ENOMEM;
    if (!done && !memory)
        status = log_fail(log, RELUME_ESYSTEM, "libaom: %s", aom_codec_error(&s.codec));
    aom_codec_destroy(&s.codec);
    aom_img_free(s.picture);
    if (status)
        mem_free(s.bytes);
    *bytes = status ? NULL : s.bytes;
    *size = s.size;
    return status;
}
