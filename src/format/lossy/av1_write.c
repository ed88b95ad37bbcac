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

const struct av1_preset av1_presets[AV1_PRESETS] = {
    [AV1_GOOD_2_SCREEN] = {"good 2, screen", AV1_GOOD, 2, 12, true},
    [AV1_GOOD_3_SCREEN] = {"good 3, screen", AV1_GOOD, 3, 12, true},
    [AV1_GOOD_6_SCREEN] = {"good 6, screen", AV1_GOOD, 6, 12, true},
    [AV1_GOOD_4] = {"good 4", AV1_GOOD, 4, 12, false},
    [AV1_GOOD_6] = {"good 6", AV1_GOOD, 6, 12, false},
    [AV1_INTRA_6] = {"all intra 6", AV1_INTRA, 6, 12, false},
    [AV1_INTRA_9] = {"all intra 9", AV1_INTRA, 9, 12, false},
    [AV1_REALTIME_5_12] = {"realtime 5, 12 bits", AV1_REALTIME, 5, 12, false},
    [AV1_REALTIME_6_12] = {"realtime 6, 12 bits", AV1_REALTIME, 6, 12, false},
    [AV1_REALTIME_6] = {"realtime 6, 8 bits", AV1_REALTIME, 6, 8, false},
    [AV1_REALTIME_7] = {"realtime 7, 8 bits", AV1_REALTIME, 7, 8, false},
    [AV1_REALTIME_8] = {"realtime 8, 8 bits", AV1_REALTIME, 8, 8, false},
    [AV1_REALTIME_9] = {"realtime 9, 8 bits", AV1_REALTIME, 9, 8, false},
    [AV1_REALTIME_10] = {"realtime 10, 8 bits", AV1_REALTIME, 10, 8, false},
};

struct group {
    aom_codec_ctx_t codec;
    aom_codec_enc_cfg_t config;
    aom_image_t *picture;
    struct av1_bytes *out;  // [members]
    const struct av1_shape *shape;
    const struct av1_effort *effort;
    const struct av1_preset *preset;
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

// The steps of libaom's quantisers at 8 and at 12 bits, in quarters of a sample (AV1 specification,
// 7.12.2).
enum { QUANTISERS = 64, LAST = QUANTISERS - 1 };
static const int steps_8[QUANTISERS] = {
    4,   11,  15,  19,  23,  27,  31,  35,  39,   43,   47,   51,   55,   59,   63,   67,
    71,  75,  79,  83,  87,  91,  95,  99,  104,  112,  120,  128,  136,  144,  152,  164,
    176, 188, 200, 215, 231, 247, 265, 285, 305,  329,  353,  380,  408,  440,  474,  510,
    550, 593, 639, 689, 743, 801, 864, 933, 1007, 1087, 1173, 1267, 1369, 1479, 1628, 1828};
static const int steps_12[QUANTISERS] = {
    4,     35,    75,    126,   183,   247,   314,   384,   456,   530,   604,   679,   753,
    828,   902,   976,   1049,  1121,  1193,  1264,  1335,  1405,  1474,  1543,  1627,  1758,
    1889,  2020,  2150,  2281,  2411,  2605,  2798,  2992,  3185,  3426,  3684,  3941,  4230,
    4550,  4871,  5256,  5641,  6073,  6522,  7034,  7579,  8155,  8795,  9484,  10220, 11020,
    11885, 12813, 13821, 14925, 16110, 17390, 18766, 20270, 21902, 23662, 26047, 29247};

// The step of a quantiser in AV1_STEPS-ths, on the line between whole ones, AV1_STEPS times.
static int step_of(const int *steps, int quantiser)
{
    const int whole = quantiser / AV1_STEPS, part = quantiser % AV1_STEPS;
    return (AV1_STEPS - part) * steps[whole] + (part ? part * steps[whole + 1] : 0);
}

double av1_step(int quantiser, int bits)
{
    const double scaled = 8.0 * AV1_STEPS, top = (1 << bits) - 1;
    return step_of(bits == 8 ? steps_8 : steps_12, quantiser) / scaled * AV1_TOP / top;
}

// The quantiser whose step is 1 << times that of another.
static int coarser(int quantiser, int times, int bits)
{
    const int *steps = bits == 8 ? steps_8 : steps_12;
    const int want = step_of(steps, quantiser) << times;
    while (quantiser < AV1_COARSEST && step_of(steps, quantiser) < want)
        quantiser++;
    return quantiser;
}

// Every picture has the whole step below or above, so that their mean is the quantiser.
static bool set_step(struct group *g, int picture, int member)
{
    static const int above[AV1_STEPS] = {0, 2, 1, 3};
    const int times = g->shape->halved ? g->shape->halved[picture] : 0;
    const int q = coarser(g->effort->quantiser, times, g->preset->bits);
    int step = (q + above[picture % AV1_STEPS]) / AV1_STEPS;
    step -= member ? 0 : finer(g);
    step = step < FINEST_STEP ? FINEST_STEP : step > LAST ? LAST : step;
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
    const int content = g->preset->screen ? AOM_CONTENT_SCREEN : AOM_CONTENT_DEFAULT;
    return !aom_codec_control(&g->codec, AOME_SET_CPUUSED, g->preset->speed) &&
           !aom_codec_control(&g->codec, AV1E_SET_TUNE_CONTENT, content) &&
           !aom_codec_control(&g->codec, AV1E_SET_COLOR_RANGE, AOM_CR_FULL_RANGE) &&
           !aom_codec_control(&g->codec, AV1E_SET_AQ_MODE, 0) &&
           !aom_codec_control(&g->codec, AV1E_SET_DELTAQ_MODE, 0);
}

static bool begin(struct group *g, int threads)
{
    aom_codec_iface_t *av1 = aom_codec_av1_cx();
    const bool grey = g->shape->components == 1;
    static const unsigned usage[] = {[AV1_GOOD] = AOM_USAGE_GOOD_QUALITY,
                                     [AV1_INTRA] = AOM_USAGE_ALL_INTRA,
                                     [AV1_REALTIME] = AOM_USAGE_REALTIME};
    const int bits = g->preset->bits;
    if (aom_codec_enc_config_default(av1, &g->config, usage[g->preset->usage]))
        return false;
    aom_codec_enc_cfg_t c = g->config;
    c.g_w = (unsigned)g->shape->width;
    c.g_h = (unsigned)g->shape->height;
    c.g_profile = bits > 10 ? 2 : grey ? 0 : 1;
    c.g_bit_depth = (aom_bit_depth_t)bits;
    c.g_input_bit_depth = (unsigned)bits;
    c.g_threads = (unsigned)(threads < LEAST_THREADS  ? LEAST_THREADS
                             : threads > MOST_THREADS ? MOST_THREADS
                                                      : threads);
    c.g_lag_in_frames = 0;
    c.monochrome = grey && g->preset->usage != AV1_REALTIME;
    c.rc_end_usage = AOM_Q;
    c.kf_max_dist = g->preset->usage == AV1_INTRA ? 0 : MOST_KEYFRAME_DISTANCE;
    g->config = c;
    const aom_img_fmt_t format =
        (grey ? AOM_IMG_FMT_I420 : AOM_IMG_FMT_I444) | (bits > 8 ? AOM_IMG_FMT_HIGHBITDEPTH : 0);
    g->picture = aom_img_alloc(NULL, format, c.g_w, c.g_h, 16);
    if (!g->picture ||
        aom_codec_enc_init(&g->codec, av1, &c, bits > 8 ? AOM_CODEC_USE_HIGHBITDEPTH : 0))
        return false;
    g->picture->bit_depth = (unsigned)bits;
    g->picture->monochrome = c.monochrome;
    for (int k = 1; grey && bits == 8 && k < 3; k++)
        memset(g->picture->planes[k], 128, (size_t)g->picture->stride[k] * ((c.g_h + 1) / 2));
    for (int k = 1; grey && bits != 8 && k < 3; k++)
        for (size_t i = 0; i < (size_t)g->picture->stride[k] / 2 * ((c.g_h + 1) / 2); i++)
            ((uint16_t *)g->picture->planes[k])[i] = (uint16_t)(1 << (bits - 1));
    return control(g);
}

// A sample in fewer bits, to the nearest; `chroma` keeps its middle.
static int narrow(int sample, int bits, bool chroma)
{
    const int top = (1 << bits) - 1, from = chroma ? AV1_MIDDLE : 0,
              to = chroma ? 1 << (bits - 1) : 0;
    const int scaled = (sample - from) * top;
    const int v = to + (scaled + (scaled < 0 ? -AV1_TOP : AV1_TOP) / 2) / AV1_TOP;
    return v > top ? top : v;
}

static void fill(aom_image_t *picture, const uint16_t *samples, const struct av1_shape *shape)
{
    const size_t width = (size_t)shape->width, height = (size_t)shape->height;
    for (int c = 0; c < shape->components; c++)
        for (size_t y = 0; y < height; y++, samples += width) {
            unsigned char *row = picture->planes[c] + (ptrdiff_t)y * picture->stride[c];
            if (picture->bit_depth == AV1_BITS)
                memcpy(row, samples, width * sizeof *samples);
            for (size_t x = 0; picture->bit_depth == 8 && x < width; x++)
                row[x] = (unsigned char)narrow(samples[x], 8, c > 0);
        }
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
    struct group g = {.out = out,
                      .shape = shape,
                      .effort = effort,
                      .preset = &av1_presets[effort->preset],
                      .members = members};
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
