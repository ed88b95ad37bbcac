// coder_choice.c - what encode chooses by itself: domain, number of coefficients, storage
//
// All is judged on samples of the capture as `relume eval` judges pictures: display values,
// clipped, PSNR of each light, their mean. The usual choice stays where it reaches the quality that
// is asked for: `pca` of 27 in the capture's own domain, unless that is linear, unseen lights do
// not reach the quality and the display domain predicts them clearly better. Else hard shadows or
// highlights are at work. Linear captures then try the display domain, where equal errors are
// equally visible: errors of dark pixels count, and those of lamps less. Then components are added,
// as many as the quality takes; where smoothing keeps the lights from being reproduced, the
// smoothing goes. Unseen lights are watched by leaving each captured one out (choose.c). So many
// components may take more bytes than the pictures themselves, which also keep the colours of small
// things: then it is `table`.
#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "encode/choose/samples.h"
#include "format/coder/basis.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"
#include "format/coder/interpolant.h"
#include "image/image/encoder.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
    USUAL = 27,         // coefficients
    MOST = 128,         // without being asked
    MOST_ASKED = 384,   // --quality
    JUDGED = 2048,      // pixels
    FEW_LIGHTS = 16,    // judged for storage
    MOST_LIGHTS = 400,  // above, trying is slow and lights are dense
    STEPS = 24,
};
static const int counts[STEPS] = {3,  6,  9,  12, 15, 18,  21,  24,  27,  32,  38,  44,
                                  52, 60, 70, 80, 90, 100, 112, 128, 160, 200, 256, 384};

static const double CLEARLY = 1.0;      // decibels that are worth sums light by light
static const double MOST_DB = 60.0;     // of one light: exact black must not hide others
static const double FREE_STORE = 0.05;  // of the basis's squared error: 0.2 dB
static const double LOSSLESS = 3.2e-6;  // squared error, 55 dB: less than a step of 8 bits

struct choice {
    const relume_capture *capture;
    const struct relume_manifest *manifest;
    struct relume_coder_params params;
    struct relume_project_params encode;
    enum relume_domain usual_domain;  // that is asked for, or the capture's
    double quality;
    struct relume_samples all;   // in `domain`
    struct relume_samples some;  // of them
    enum relume_domain domain;
    bool hdr;
    struct encoder *display;       // from linear light
    struct relume_transfer curve;  // of the display domain
    struct encoder *recode;        // from that to display values, or NULL: it is the same
    relume_coder *coder;
    double psnr[STEPS];  // by `counts`, those that the coder has
    double own, unseen;
    double pooled;        // as `own`, of all lights together
    double usual_unseen;  // of the usual choice, which unseen lights must not fall behind
};

// ---------------------------------------------------------------- quality on samples

static double decibel(double mse)
{
    return fmin(decibels(mse), MOST_DB);
}

struct judging {
    const struct choice *choice;
    struct captured captured;
    float *planes;           // [planes][pixels]
    double (*error)[STEPS];  // [lights]
    const double *predictor;
    double *left_out;  // [lights]
};

// Display values of `n` values of the choice's domain, clipped.
static void to_display(const struct choice *choice, const float *v, size_t n, float *out)
{
    if (choice->domain == RELUME_DOMAIN_LINEAR)
        encoder_apply(choice->display, v, out, (int)n);
    else if (choice->recode)
        encoder_apply(choice->recode, v, out, (int)n);
    else
        memcpy(out, v, n * sizeof *out);
    for (size_t i = 0; i < n; i++)
        out[i] = encoder_clip(out[i]);
}

static double squared_error(const struct choice *choice, const float *a, const float *b, size_t n)
{
    float x[JUDGED], y[JUDGED];
    double sum = 0.0;
    to_display(choice, a, n, x);
    to_display(choice, b, n, y);
    for (size_t i = 0; i < n; i++)
        sum += ((double)x[i] - (double)y[i]) * ((double)x[i] - (double)y[i]);
    return sum / (double)n;
}

// A channel of the samples under a light.
static void wanted(const struct choice *choice, size_t light, size_t channel, float *out)
{
    const size_t n = choice->some.pixels;
    for (size_t x = 0; x < n; x++)
        out[x] = choice->some.data[(light * n + x) * 3 + channel];
}

// One light, by the first k components for every k of `counts`.
static void judge_light(void *context, size_t light, int worker)
{
    (void)worker;
    struct judging *j = context;
    const struct relume_coder_info *info = &j->choice->coder->info;
    const size_t n = j->choice->some.pixels, k = (size_t)info->coefficients;
    float sum[JUDGED], want[JUDGED];
    for (size_t c = 0; c < 3; c++) {
        const size_t row = c * (size_t)info->lights + light;
        const float *basis = j->captured.basis + row * k;
        int step = 0;
        wanted(j->choice, light, c, want);
        for (size_t x = 0; x < n; x++)
            sum[x] = j->captured.constant[row];
        for (size_t i = 0; i < k; i++) {
            const float *plane = j->planes + (size_t)relume_coder_plane(info, (int)i, (int)c) * n;
            for (size_t x = 0; x < n; x++)
                sum[x] += basis[i] * plane[x];
            while (step < STEPS && (size_t)counts[step] < i + 1)
                step++;
            const bool last = i + 1 == k;
            if (step < STEPS && ((size_t)counts[step] == i + 1 || last))
                j->error[light][step] += squared_error(j->choice, sum, want, n) / 3.0;
        }
    }
}

static relume_status find_planes(const struct choice *choice, const relume_coder *coder,
                                 float **out)
{
    const size_t n = choice->some.pixels;
    *out = mem_array((size_t)coder->info.planes * n, sizeof **out);
    return *out ? relume_coder_apply(coder, choice->some.data, 3 * n, n, *out, n) : RELUME_ENOMEM;
}

// How well the coder reproduces the captured lights: choice->psnr, and choice->own with all its
// coefficients.
static relume_status judge(struct choice *choice)
{
    const size_t lights = (size_t)choice->manifest->lights;
    struct judging j = {.choice = choice, .error = mem_zeroed(lights, sizeof *j.error)};
    relume_status status = j.error ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = find_planes(choice, choice->coder, &j.planes);
    if (!status)
        status =
            captured_create(&j.captured, choice->coder, choice->manifest->directions, (int)lights);
    if (!status)
        thread_for(choice->encode.threads, lights, judge_light, &j);
    for (int s = 0; !status && s < STEPS; s++) {
        double square = 0.0;
        choice->psnr[s] = 0.0;
        for (size_t i = 0; i < lights; i++) {
            choice->psnr[s] += decibel(j.error[i][s]) / (double)lights;
            square += j.error[i][s] / (double)lights;
        }
        choice->own = choice->psnr[s];
        choice->pooled = decibel(square);
        if (counts[s] >= choice->coder->info.coefficients)
            break;
    }
    captured_destroy(&j.captured);
    mem_free(j.planes);
    mem_free(j.error);
    return status;
}

// The light as the others predict it: it is missed by (B t)_i / B_ii.
static void leave_out(void *context, size_t light, int worker)
{
    (void)worker;
    struct judging *j = context;
    const size_t n = j->choice->some.pixels, lights = (size_t)j->choice->manifest->lights;
    const double *b = j->predictor + light * lights;
    float sum[JUDGED], want[JUDGED];
    for (size_t c = 0; c < 3; c++) {
        wanted(j->choice, light, c, want);
        memcpy(sum, want, n * sizeof *sum);
        for (size_t i = 0; i < lights; i++) {
            const float w = (float)(b[i] / b[light]);
            for (size_t x = 0; x < n; x++)
                sum[x] -= w * j->choice->some.data[(i * n + x) * 3 + c];
        }
        j->left_out[light] += squared_error(j->choice, sum, want, n) / 3.0;
    }
}

static relume_status judge_unseen(struct choice *choice)
{
    const size_t lights = (size_t)choice->manifest->lights;
    double *b = mem_array(lights * lights, sizeof *b);
    struct judging j = {
        .choice = choice, .left_out = mem_zeroed(lights, sizeof(double)), .predictor = b};
    const bool good = b && j.left_out;
    choice->unseen = 0.0;
    const struct relume_interpolant *between = choice->coder->info.interpolant;
    if (good && lights > 3 && between->predictor) {
        between->predictor(choice->coder->interpolant, b);
        thread_for(choice->encode.threads, lights, leave_out, &j);
        for (size_t i = 0; i < lights; i++)
            choice->unseen += decibel(j.left_out[i]) / (double)lights;
    }
    mem_free(b);
    mem_free(j.left_out);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- domain and coefficients

static relume_status make_coder(struct choice *choice, int count)
{
    struct relume_coder_params p = choice->params;
    p.samples = &choice->all;
    p.coefficients = count;
    relume_coder_destroy(&choice->coder);
    relume_status status =
        relume_coder_create(&choice->coder, &relume_basis_pca, choice->manifest->directions,
                            choice->manifest->lights, &p);
    if (!status)
        status = judge(choice);
    return status ? status : judge_unseen(choice);
}

// From now on with the interpolant's parameters as they were chosen.
static void keep_parameters(struct choice *choice)
{
    choice->params.log = NULL;  // has heard about the lights
    if (choice->params.choose) {
        choice->params.choose = false;
        choice->params.interpolant = choice->coder->info.interpolant;
        memcpy(choice->params.parameter, choice->coder->info.parameter,
               sizeof choice->params.parameter);
    }
}

static relume_status take_some(struct choice *choice)
{
    const size_t n = choice->all.pixels < JUDGED ? choice->all.pixels : JUDGED;
    const size_t lights = (size_t)choice->all.lights;
    choice->some =
        (struct relume_samples){.lights = (int)lights,
                                .pixels = n,
                                .data = mem_array(lights * n, 3 * sizeof *choice->some.data)};
    if (!choice->some.data)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < lights; i++)
        for (size_t x = 0; x < n; x++)
            memcpy(choice->some.data + (i * n + x) * 3,
                   choice->all.data + (i * choice->all.pixels + x * choice->all.pixels / n) * 3,
                   3 * sizeof *choice->some.data);
    return RELUME_OK;
}

struct conversion {
    const struct choice *choice;
    float *data;
    size_t n;
    bool back;
};

static void convert_light(void *context, size_t light, int worker)
{
    (void)worker;
    const struct conversion *c = context;
    float *v = c->data + light * c->n;
    if (c->back)
        for (size_t i = 0; i < c->n; i++)
            v[i] = relume_transfer_decode(c->choice->curve, v[i]);
    else
        encoder_apply(c->choice->display, v, v, (int)c->n);
}

static void move_samples(struct choice *choice, enum relume_domain domain)
{
    const bool back = domain == RELUME_DOMAIN_LINEAR;
    const size_t lights = (size_t)choice->all.lights;
    struct conversion all = {choice, choice->all.data, 3 * choice->all.pixels, back};
    struct conversion some = {choice, choice->some.data, 3 * choice->some.pixels, back};
    thread_for(choice->encode.threads, lights, convert_light, &all);
    thread_for(choice->encode.threads, lights, convert_light, &some);
    choice->domain = domain;
}

// The display domain, where it is better by half a decibel and predicts about as well, or predicts
// clearly better where the quality is reached in both.
static relume_status try_display(struct choice *choice)
{
    const double own = choice->own, pooled = choice->pooled, unseen = choice->unseen;
    const bool reached = own >= choice->quality;
    relume_coder *linear = choice->coder;
    const struct relume_coder_params params = choice->params;
    choice->coder = NULL;
    choice->params.log = NULL;
    move_samples(choice, RELUME_DOMAIN_DISPLAY);
    const relume_status status = make_coder(choice, linear->info.coefficients);
    const bool better = reached
                            ? choice->own >= choice->quality && choice->unseen > unseen + CLEARLY
                            : choice->own > own + 0.5 && choice->unseen > unseen - 0.2;
    if (!status && better) {
        relume_coder_destroy(&linear);
        return RELUME_OK;
    }
    relume_coder_destroy(&choice->coder);
    move_samples(choice, RELUME_DOMAIN_LINEAR);
    choice->coder = linear;
    choice->params = params;
    choice->own = own;
    choice->pooled = pooled;
    choice->unseen = unseen;
    return status;
}

// The least number of `counts` that reaches the quality, or nearly what the most of them reach.
static int enough(const struct choice *choice, int least)
{
    const double want = fmin(choice->quality, choice->own - 0.2);
    const int most = choice->coder->info.coefficients;
    for (int s = 0; s < STEPS && counts[s] < most; s++)
        if (counts[s] >= least && choice->psnr[s] >= want)
            return counts[s];
    return most;
}

static relume_status make_longer(struct choice *choice, int most)
{
    keep_parameters(choice);
    relume_status status = make_coder(choice, most);
    const double own = choice->own, nugget = choice->params.parameter[2];
    if (status || own >= choice->quality || nugget <= 0.0)
        return status;
    choice->params.parameter[2] = 0.0;
    status = make_coder(choice, most);
    if (status || (choice->own > own + 1.0 && choice->unseen > choice->usual_unseen - 0.2))
        return status;
    choice->params.parameter[2] = nugget;
    return make_coder(choice, most);
}

static relume_status choose_coder(struct choice *choice, bool asked)
{
    const int fixed = choice->params.coefficients, lights = choice->manifest->lights;
    const int limit = asked ? MOST_ASKED : MOST;
    const int most = 3 * lights < limit ? 3 * lights : limit;
    const int usual = 3 * lights < USUAL ? 3 * lights : USUAL;
    // More components of lossy planes are nearly free but for their functions in the header.
    const bool lossy = choice->encode.step == RELUME_STEP_HALVED;
    const int least = !asked ? usual : lossy ? smaller_of(lights, USUAL) : 1;
    relume_status status = make_coder(choice, fixed ? fixed : usual);
    choice->usual_unseen = choice->unseen;
    const bool may = choice->encode.domain == RELUME_DOMAIN_AUTO &&
                     choice->domain == RELUME_DOMAIN_LINEAR && lights <= MOST_LIGHTS;
    if (!status && may && (choice->own < choice->quality || choice->unseen < choice->quality))
        status = try_display(choice);
    if (status || fixed || most <= usual || lights > MOST_LIGHTS)
        return status;
    if (choice->own < choice->quality)
        status = make_longer(choice, most);
    const int count = status ? 0 : enough(choice, least);
    if (status || count == choice->coder->info.coefficients)
        return status;
    keep_parameters(choice);
    return make_coder(choice, count);
}

// ---------------------------------------------------------------- storage

struct storing {
    const struct choice *choice;
    const relume_coder *coder;
    struct captured captured;
    float *before, *after;  // [planes][pixels]
    struct range *range;    // [planes], of all samples
    float *step;            // [2][planes]: scales and offsets
    uint16_t *count;        // [65536], of codes
    float gain[5];          // exposures to be looked at
    int gains;
};

static relume_status find_ranges(struct storing *s)
{
    enum { RUN = 4096 };
    const struct relume_samples *all = &s->choice->all;
    const size_t planes = (size_t)s->coder->info.planes;
    float *values = mem_array(planes * RUN, sizeof *values);
    relume_status status = values && s->range ? RELUME_OK : RELUME_ENOMEM;
    for (size_t p = 0; !status && p < planes; p++)
        s->range[p] = (struct range){FLT_MAX, -FLT_MAX};
    for (size_t x = 0; !status && x < all->pixels; x += RUN) {
        const size_t n = all->pixels - x < RUN ? all->pixels - x : RUN;
        status = relume_coder_apply(s->coder, all->data + 3 * x, 3 * all->pixels, n, values, RUN);
        for (size_t p = 0; !status && p < planes; p++)
            s->range[p] = range_join(s->range[p], range_of(values + p * RUN, n));
    }
    for (size_t p = 0; !status && p < planes; p++)
        s->range[p] = range_settle(s->range[p]);
    mem_free(values);
    return status;
}

// The samples in place of a view: one band, whose ranges are those of all samples.
static void quantise(const struct storing *s, enum relume_storage storage)
{
    const size_t n = s->choice->some.pixels, planes = (size_t)s->coder->info.planes;
    relume_coefficients c = {
        .info = {.coder = s->coder, .planes = (int)planes, .storage = storage},
        .scale = s->step,
        .offset = s->step + planes,
        .band = s->range,
    };
    coefficients_choose_steps(&c, s->range, false, RELUME_STEP_PLANE);
    for (size_t p = 0; p < planes; p++)
        coefficients_restore(&c, (int)p, 0, s->before + p * n, n, s->after + p * n);
}

// Bits of a pixel's codes, those of each plane by their frequency (Shannon 1948): what lossless
// packing makes of them is smaller, but about alike for any planes of one scene.
static double bits_of(const struct storing *s, enum relume_storage storage)
{
    const size_t n = s->choice->some.pixels, planes = (size_t)s->coder->info.planes;
    const int top = relume_storage_top(storage);
    double bits = 0.0;
    quantise(s, storage);
    for (size_t p = 0; p < planes; p++) {
        memset(s->count, 0, ((size_t)top + 1) * sizeof *s->count);
        for (size_t x = 0; x < n; x++) {
            const float code = (s->after[p * n + x] - s->step[planes + p]) / s->step[p];
            s->count[(int)(fminf(fmaxf(code, 0.0f), (float)top) + 0.5f)]++;
        }
        for (int c = 0; c <= top; c++)
            if (s->count[c])
                bits -= s->count[c] * log2((double)s->count[c] / (double)n) / (double)n;
    }
    return bits;
}

static void predict(const struct storing *s, int light, int channel, const float *planes,
                    float *out)
{
    const struct relume_coder_info *info = &s->coder->info;
    const size_t n = s->choice->some.pixels, k = (size_t)info->coefficients;
    const size_t row = (size_t)(channel * info->lights + light);
    for (size_t x = 0; x < n; x++)
        out[x] = s->captured.constant[row];
    for (size_t i = 0; i < k; i++) {
        const float w = s->captured.basis[row * k + i];
        const float *plane = planes + (size_t)relume_coder_plane(info, (int)i, channel) * n;
        for (size_t x = 0; x < n; x++)
            out[x] += w * plane[x];
    }
}

// As it looks at another exposure: linear light is multiplied.
static void expose(const struct choice *choice, float gain, size_t n, float *v)
{
    const struct relume_transfer t = choice->curve;
    const bool coded = choice->domain == RELUME_DOMAIN_DISPLAY;
    for (size_t i = 0; gain != 1.0f && i < n; i++)
        v[i] =
            coded ? relume_transfer_encode(t, gain * relume_transfer_decode(t, v[i])) : gain * v[i];
}

// Whether what storing adds is not seen at any exposure.
static bool is_enough(const struct storing *s, enum relume_storage storage)
{
    const struct choice *choice = s->choice;
    const size_t n = choice->some.pixels;
    const int lights = choice->manifest->lights, step = (lights + FEW_LIGHTS - 1) / FEW_LIGHTS;
    float before[JUDGED], after[JUDGED], want[JUDGED];
    quantise(s, storage);
    for (int g = 0; g < s->gains; g++) {
        double fit = 0.0, store = 0.0;
        int count = 0;
        for (int i = 0; i < lights; i += step)
            for (int c = 0; c < 3; c++, count++) {
                predict(s, i, c, s->before, before);
                predict(s, i, c, s->after, after);
                wanted(choice, (size_t)i, (size_t)c, want);
                expose(choice, s->gain[g], n, before);
                expose(choice, s->gain[g], n, after);
                expose(choice, s->gain[g], n, want);
                fit += squared_error(choice, before, want, n);
                store += squared_error(choice, before, after, n);
            }
        if (store / count > fmax(LOSSLESS, FREE_STORE * fit / count))
            return false;
    }
    return true;
}

// High dynamic range: linear light far above white, or one picture of linear light, which nobody
// exposed for the screen.
static bool is_hdr(const struct choice *choice)
{
    static const float FAR_ABOVE_WHITE = 8.0f;
    float most = 0.0f;
    const size_t n = (size_t)choice->all.lights * choice->all.pixels * 3;
    if (choice->manifest->transfer.curve != RELUME_CURVE_LINEAR)
        return false;
    for (size_t i = 0; i < n; i++)
        most = fmaxf(most, choice->all.data[i]);
    if (choice->domain == RELUME_DOMAIN_DISPLAY)
        most = relume_transfer_decode(choice->curve, most);
    return choice->all.lights == 1 || most > FAR_ABOVE_WHITE;
}

// 0 EV as the numbers are; of many lights, 2 EV up. Of one light 4 EV up, and likewise with the
// typical value at middle grey, and 8 EV down from there.
static void choose_exposures(struct storing *s, bool hdr)
{
    const struct choice *choice = s->choice;
    double roots = 0.0;
    size_t lit = 0;
    s->gain[0] = 1.0f;
    s->gains = 1;
    for (size_t i = 0; i < (size_t)choice->some.lights * choice->some.pixels * 3; i++)
        if (choice->some.data[i] > 0.0f) {
            const float v = choice->some.data[i];
            roots += sqrt((double)(choice->domain == RELUME_DOMAIN_DISPLAY
                                       ? relume_transfer_decode(choice->curve, v)
                                       : v));
            lit++;
        }
    if (!hdr || !lit)
        return;
    if (choice->some.lights > 1) {
        s->gain[1] = 4.0f;
        s->gains = 2;
        return;
    }
    const float grey = (float)(0.18 / fmax(roots / (double)lit * roots / (double)lit, 1e-20));
    const float gains[] = {1.0f, 16.0f, grey, 16.0f * grey, grey / 256.0f};
    memcpy(s->gain, gains, sizeof gains);
    s->gains = 5;
}

// Codes of whole numbers are even steps, and how bright the brightest pixel is no sample knows: for
// high dynamic range in linear light it is halves, or floats where these have not range enough.
// `*bits` are those of a pixel's codes, or 0 where they are no whole numbers.
static relume_status choose_storage(struct choice *choice, enum relume_storage *out, double *bits)
{
    static const enum relume_storage even[] = {RELUME_STORE_8, RELUME_STORE_10, RELUME_STORE_12,
                                               RELUME_STORE_16, RELUME_STORE_HALF};
    const size_t n = choice->some.pixels, planes = (size_t)choice->coder->info.planes;
    const bool hdr = choice->hdr;
    struct storing s = {.choice = choice, .coder = choice->coder};
    s.after = mem_array(planes * n, sizeof *s.after);
    s.range = mem_array(planes, sizeof *s.range);
    s.step = mem_array(2 * planes, sizeof *s.step);
    s.count = mem_array(UINT16_MAX + 1, sizeof *s.count);
    relume_status status = s.after && s.step && s.count ? find_ranges(&s) : RELUME_ENOMEM;
    if (!status)
        status = find_planes(choice, choice->coder, &s.before);
    if (!status)
        status = captured_create(&s.captured, choice->coder, choice->manifest->directions,
                                 choice->manifest->lights);
    if (!status && !*out) {
        choose_exposures(&s, hdr);
        *out = RELUME_STORE_FLOAT;
        for (size_t i = hdr && choice->domain == RELUME_DOMAIN_LINEAR ? 4 : 0;
             i < 5 && *out == RELUME_STORE_FLOAT; i++)
            if (is_enough(&s, even[i]))
                *out = even[i];
    }
    *bits = !status && relume_storage_top(*out) ? bits_of(&s, *out) : 0.0;
    captured_destroy(&s.captured);
    mem_free(s.before);
    mem_free(s.after);
    mem_free(s.range);
    mem_free(s.step);
    mem_free(s.count);
    return status;
}

// ---------------------------------------------------------------- all of it

// One light needs no components: its picture is what there is to store.
static relume_status keep_picture(struct choice *choice)
{
    choice->params.choose = false;
    choice->params.interpolant = NULL;
    relume_status status = relume_coder_create(&choice->coder, &relume_basis_table,
                                               choice->manifest->directions, 1, &choice->params);
    return status ? status : judge(choice);
}

// More components than usual are a matter of hard shadows; of many lights a look is enough. Lossy
// planes are decided on by what they take (encode/encode/contest.h).
static bool may_be_pictures(const struct choice *choice)
{
    return choice->encode.step != RELUME_STEP_HALVED && !choice->params.coefficients &&
           choice->manifest->lights > 1 && choice->coder->info.coefficients > USUAL &&
           choice->manifest->lights <= MOST_LIGHTS;
}

static relume_status make_pictures(struct choice *choice, enum relume_storage *storage,
                                   double *bits)
{
    struct relume_coder_params p = choice->params;
    p.coefficients = 0;
    p.parameter[2] = 0.0;  // nothing smooths between them
    *storage = choice->encode.storage;
    relume_coder_destroy(&choice->coder);
    relume_status status =
        relume_coder_create(&choice->coder, &relume_basis_table, choice->manifest->directions,
                            choice->manifest->lights, &p);
    if (!status)
        status = judge(choice);
    if (!status)
        status = judge_unseen(choice);
    return status ? status : choose_storage(choice, storage, bits);
}

// Lights left out as pictures show them that nothing smooths.
static relume_status judge_sharp(struct choice *choice, double *sharp)
{
    const struct relume_coder_info *info = relume_coder_info(choice->coder);
    const double unseen = choice->unseen;
    relume_coder *components = choice->coder;
    struct relume_coder_params p = choice->params;
    p.coefficients = 0;
    p.choose = false;
    p.interpolant = info->interpolant;
    memcpy(p.parameter, info->parameter, sizeof p.parameter);
    p.parameter[2] = 0.0;
    relume_status status =
        relume_coder_create(&choice->coder, &relume_basis_table, choice->manifest->directions,
                            choice->manifest->lights, &p);
    if (!status)
        status = judge_unseen(choice);
    *sharp = choice->unseen;
    choice->unseen = unseen;
    relume_coder_destroy(&choice->coder);
    choice->coder = components;
    return status;
}

// The pictures, where they take fewer bytes than the components that reproduce them worse; those of
// linear light as such, since light is lost where the display coding of lit and of dark is mixed.
static relume_status consider_pictures(struct choice *choice, enum relume_storage *storage,
                                       double bits)
{
    relume_coder *components = choice->coder;
    enum relume_storage other;
    const double own = choice->own, pooled = choice->pooled, unseen = choice->unseen;
    double theirs = 0.0;
    choice->coder = NULL;
    relume_status status = make_pictures(choice, &other, &theirs);
    if (!status && (theirs <= 0.0 || theirs >= bits || choice->own < own ||
                    choice->unseen < choice->usual_unseen - 0.2)) {
        relume_coder_destroy(&choice->coder);
        choice->coder = components;
        choice->own = own;
        choice->pooled = pooled;
        choice->unseen = unseen;
        return RELUME_OK;
    }
    relume_coder_destroy(&components);
    if (!status && choice->domain != choice->usual_domain) {
        move_samples(choice, RELUME_DOMAIN_LINEAR);
        status = make_pictures(choice, &other, &theirs);
    }
    *storage = other;
    return status;
}

relume_status relume_coder_decide(relume_coder **out, struct relume_decision *decision,
                                  const relume_capture *capture, double quality_db, bool display,
                                  const struct relume_coder_params *coder,
                                  const struct relume_project_params *encode)
{
    struct choice choice = {
        .capture = capture,
        .manifest = relume_capture_manifest(capture),
        .params = coder ? *coder : (struct relume_coder_params){.choose = true},
        .encode = PARAMS_WORK(relume_project_params, encode),
        .quality = quality_db > 0.0 ? quality_db : RELUME_USUAL_DB,
        .display = mem_array(1, sizeof *choice.display),
    };
    *out = NULL;
    choice.params.hemispherical = relume_capture_hemispherical(capture);
    choice.params.pole_y = relume_capture_pole_y(capture);
    choice.params.threads = choice.encode.threads;
    choice.usual_domain = choice.domain = relume_capture_domain(capture, choice.encode.domain);
    choice.curve = relume_encode_curve(capture, choice.encode.display);
    relume_status status = choice.display ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        encoder_init(choice.display, relume_encode_display(capture));
    if (!status && choice.curve.curve == RELUME_CURVE_LOG) {
        choice.recode = mem_array(1, sizeof *choice.recode);
        status = choice.recode ? RELUME_OK : RELUME_ENOMEM;
        if (!status)
            encoder_init_from(choice.recode, choice.curve, choice.display->transfer);
    }
    if (!status)
        status = relume_samples_read(&choice.all, capture, samples_enough(choice.manifest->lights),
                                     encode);
    if (!status && !choice.all.pixels)
        status = log_fail(choice.params.log, RELUME_EUNFIT,
                          "the masks are black everywhere; expected white where the object is");
    if (!status)
        status = take_some(&choice);
    choice.hdr = !status && is_hdr(&choice);
    if (!status && display && !choice.hdr) {
        choice.encode.domain = RELUME_DOMAIN_DISPLAY;
        if (choice.domain == RELUME_DOMAIN_LINEAR)
            move_samples(&choice, RELUME_DOMAIN_DISPLAY);
    }
    if (!status && choice.manifest->lights == 1 && !choice.params.coefficients)
        status = keep_picture(&choice);
    else if (!status)
        status = choose_coder(&choice, quality_db > 0.0);
    enum relume_storage storage = choice.encode.storage;
    double bits = 0.0;
    if (!status)
        status = choose_storage(&choice, &storage, &bits);
    if (!status && bits > 0.0 && may_be_pictures(&choice))
        status = consider_pictures(&choice, &storage, bits);
    double sharp = choice.unseen;
    if (!status && choice.encode.step == RELUME_STEP_HALVED &&
        relume_coder_info(choice.coder)->parameter[2] > 0.0)
        status = judge_sharp(&choice, &sharp);
    if (decision)
        *decision = (struct relume_decision){choice.domain, storage, choice.own, choice.unseen,
                                             choice.pooled, sharp,   choice.hdr};
    if (!status) {
        *out = choice.coder;
        choice.coder = NULL;
    }
    relume_samples_destroy(&choice.all);
    relume_samples_destroy(&choice.some);
    relume_coder_destroy(&choice.coder);
    mem_free(choice.display);
    mem_free(choice.recode);
    return status;
}
