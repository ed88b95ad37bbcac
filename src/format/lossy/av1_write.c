// av1_write.c - the one place that knows libaom
#include "format/lossy/av1.h"

#include "core/base/log.h"
#include "core/base/memory.h"

#include <aom/aom_encoder.h>
#include <aom/aomcx.h>
#include <string.h>

enum { MOST_KEYFRAME_DISTANCE = 1 << 20, FINEST_STEP = AV1_FINEST / AV1_STEPS };

// Slots in which the coder keeps pictures: two for the first sequence, one for each other.
enum { SLOTS = 8, FIRST_SLOTS = 2, REFERENCES = 7 };

// One thread codes a picture otherwise than several do, by a thousandth of the bytes; with two or
// more their number does not matter.
enum { LEAST_THREADS = 2, MOST_THREADS = 16 };

struct group {
    aom_codec_ctx_t codec;
    aom_codec_enc_cfg_t config;
    aom_image_t *picture;
    struct av1_bytes *out;  // [members]
    const struct av1_shape *shape;
    const struct av1_effort *effort;
    int members;
    long coded;  // pictures so far
};

int av1_most_members(int pictures)
{
    return pictures > 1 ? 1 + SLOTS - FIRST_SLOTS : AV1_MOST_MEMBERS;
}

// What others are predicted from is finer: the more of them, the more it is worth.
static int finer(const struct group *g)
{
    const int worth = 4 + g->members / 2;
    return g->members == 1 ? 0 : worth < 12 ? worth : 12;
}

// Every picture has the whole step below or above, so that their mean is the quantiser.
static bool set_step(struct group *g, int picture, int member)
{
    const int q = g->effort->quantiser;
    int step = (q * (picture + 1) / AV1_STEPS) - (q * picture / AV1_STEPS);
    step -= member ? 0 : finer(g);
    step = step > FINEST_STEP ? step : FINEST_STEP;
    g->config.rc_min_quantizer = g->config.rc_max_quantizer = (unsigned)step;
    return !aom_codec_enc_config_set(&g->codec, &g->config) &&
           !aom_codec_control(&g->codec, AOME_SET_CQ_LEVEL, step);
}

// Which slots a picture is predicted from, and which one it takes. All seven names are of these,
// since a picture's head is read by what all of them hold.
static bool set_slots(struct group *g, int picture, int member)
{
    static const int name[REFERENCES] = {0, 3, 6, 1, 4, 2, 5};  // last, golden, altref, ...
    const int now = picture % FIRST_SLOTS, before = 1 - now, own = FIRST_SLOTS + member - 1;
    const bool begun = picture > 0, keeps = g->shape->pictures > 1;
    const int of_first[] = {before, now}, of_other[] = {begun ? own : now, now, before};
    const int *slot = member ? of_other : of_first;
    const int known = !member ? (picture > 1 ? 2 : 1) : begun ? 3 : 1;
    aom_svc_ref_frame_config_t c = {0};
    for (int i = 0; i < REFERENCES; i++) {
        c.ref_idx[name[i]] = slot[i < known ? i : 0];
        c.reference[name[i]] = i < known;
    }
    if (keeps)
        c.refresh[member ? own : now] = 1;
    return g->members == 1 || !(picture || member) ||
           !aom_codec_control(&g->codec, AV1E_SET_SVC_REF_FRAME_CONFIG, &c);
}

static bool control(struct group *g)
{
    // What it tries for screens takes a third more time; it makes rendered pictures 6 % smaller,
    // and photographs 2 % smaller or larger.
    return !aom_codec_control(&g->codec, AOME_SET_CPUUSED, g->effort->speed) &&
           !aom_codec_control(&g->codec, AV1E_SET_TUNE_CONTENT, AOM_CONTENT_SCREEN) &&
           !aom_codec_control(&g->codec, AV1E_SET_COLOR_RANGE, AOM_CR_FULL_RANGE) &&
           !aom_codec_control(&g->codec, AV1E_SET_AQ_MODE, 0) &&
           !aom_codec_control(&g->codec, AV1E_SET_DELTAQ_MODE, 0);
}

static bool begin(struct group *g, int threads)
{
    aom_codec_iface_t *av1 = aom_codec_av1_cx();
    const bool grey = g->shape->components == 1;
    if (aom_codec_enc_config_default(av1, &g->config, AOM_USAGE_GOOD_QUALITY))
        return false;
    aom_codec_enc_cfg_t c = g->config;
    c.g_w = (unsigned)g->shape->width;
    c.g_h = (unsigned)g->shape->height;
    c.g_profile = 2;
    c.g_bit_depth = AOM_BITS_12;
    c.g_input_bit_depth = AV1_BITS;
    c.g_threads = (unsigned)(threads < LEAST_THREADS  ? LEAST_THREADS
                             : threads > MOST_THREADS ? MOST_THREADS
                                                      : threads);
    c.g_lag_in_frames = 0;
    c.monochrome = grey;
    c.rc_end_usage = AOM_Q;
    c.kf_max_dist = MOST_KEYFRAME_DISTANCE;
    g->config = c;
    g->picture =
        aom_img_alloc(NULL, grey ? AOM_IMG_FMT_I42016 : AOM_IMG_FMT_I44416, c.g_w, c.g_h, 16);
    if (!g->picture || aom_codec_enc_init(&g->codec, av1, &c, AOM_CODEC_USE_HIGHBITDEPTH))
        return false;
    g->picture->bit_depth = AV1_BITS;
    g->picture->monochrome = grey;
    return control(g);
}

static void fill(aom_image_t *picture, const uint16_t *samples, const struct av1_shape *shape)
{
    const size_t width = (size_t)shape->width, height = (size_t)shape->height;
    for (int c = 0; c < shape->components; c++)
        for (size_t y = 0; y < height; y++)
            memcpy(picture->planes[c] + (ptrdiff_t)y * picture->stride[c],
                   samples + ((size_t)c * height + y) * width, width * sizeof *samples);
}

static bool append(struct av1_bytes *to, const void *from, size_t size)
{
    if (to->size + size > to->capacity) {
        unsigned char *more = mem_resize(to->byte, 2 * (to->size + size), 1);
        if (!more)
            return false;
        to->byte = more;
        to->capacity = 2 * (to->size + size);
    }
    memcpy(to->byte + to->size, from, size);
    to->size += size;
    return true;
}

static bool code(struct group *g, const uint16_t *samples, int picture, int member)
{
    const size_t size =
        (size_t)g->shape->components * (size_t)g->shape->width * (size_t)g->shape->height;
    const aom_codec_cx_pkt_t *p;
    aom_codec_iter_t at = NULL;
    fill(g->picture, samples + (size_t)picture * size, g->shape);
    if (!set_step(g, picture, member) || !set_slots(g, picture, member) ||
        aom_codec_encode(&g->codec, g->picture, g->coded++, 1, 0))
        return false;
    while ((p = aom_codec_get_cx_data(&g->codec, &at)))
        if (p->kind == AOM_CODEC_CX_FRAME_PKT &&
            !append(&g->out[member], p->data.frame.buf, p->data.frame.sz))
            return false;
    return true;
}

static bool encode_group(struct group *g, const uint16_t *const *samples)
{
    for (int i = 0; i < g->shape->pictures; i++)
        for (int m = 0; m < g->members; m++)
            if (!code(g, samples[m], i, m))
                return false;
    return true;
}

relume_status av1_encode(struct av1_bytes *out, const uint16_t *const *samples, int members,
                         const struct av1_shape *shape, const struct av1_effort *effort,
                         int threads, const struct relume_log *log)
{
    struct group g = {.out = out, .shape = shape, .effort = effort, .members = members};
    memset(out, 0, (size_t)members * sizeof *out);
    const bool done = begin(&g, threads) && encode_group(&g, samples);
    const bool memory = g.codec.err == AOM_CODEC_OK || g.codec.err == AOM_CODEC_MEM_ERROR;
    relume_status status = done ? RELUME_OK : RELUME_ENOMEM;
    if (!done && !memory)
        status = log_fail(log, RELUME_ESYSTEM, "libaom: %s", aom_codec_error(&g.codec));
    aom_codec_destroy(&g.codec);
    aom_img_free(g.picture);
    for (int m = 0; status && m < members; m++) {
        mem_free(out[m].byte);
        out[m] = (struct av1_bytes){0};
    }
    return status;
}
