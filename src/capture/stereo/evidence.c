// evidence.c - weights of samples
#include "capture/stereo/evidence.h"

#include "capture/stereo/sum.h"

static const float rank = 0.7f;    // of the samples by brightness: the middle
static const float black = 1e-4f;  // middles below hold nothing but noise
// In units of the middle:
static const float dark = 0.2f;       // samples below may lie in shadow
static const float indirect = 0.3f;   // errors below come of light from elsewhere, and of noise
static const float tuning = 2.0f;     // of the Cauchy weights, in standard errors
static const float finest = 0.03f;    // relative errors that nobody should expect less of
static const float tolerated = 0.2f;  // relative error that is half missed

bool evidence_begin(struct stereo_pixel *p, struct stereo_scratch *scratch)
{
    const int stride = p->lights->stride;
    int known = 0;
    for (int i = 0; i < stride; i++)
        if (p->value[i] >= 0.0f)
            scratch->spare[known++] = p->value[i];
    if (!known)
        return false;
    p->middle = value_at_rank(scratch->spare, known, (int)(rank * (float)known));
    if (!(p->middle > black))
        return false;
    for (int i = 0; i < stride; i++) {
        const float v = p->value[i] > 0.0f ? p->value[i] / p->middle : 0.0f,
                    q = 1.0f / (v + indirect);
        const float light = v * v / (v * v + dark * dark);
        scratch->base[i] = p->value[i] < 0.0f ? 0.0f : light * q * sqrtf(q);
    }
    return true;
}

static float relative_miss(const struct stereo_pixel *p, const struct stereo_scratch *scratch,
                           int i)
{
    const float value = p->value[i], expected = scratch->expected[i];
    const float size = (value > expected ? value : expected) + indirect * p->middle;
    return (value - expected) / size;
}

void evidence_weigh(const struct stereo_pixel *p, struct stereo_scratch *scratch)
{
    const int n = p->lights->stride;
    int known = 0;
    for (int i = 0; i < n; i++)
        if (p->value[i] >= 0.0f)
            scratch->spare[known++] = fabsf(relative_miss(p, scratch, i));
    const float median = value_at_rank(scratch->spare, known, known / 2);
    const float scale = fmaxf(1.4826f * tuning * median, finest);
    for (int i = 0; i < n; i++) {
        const float miss = relative_miss(p, scratch, i) / scale;
        scratch->weight[i] = scratch->base[i] / (1.0f + miss * miss);
    }
}

float evidence_miss(const struct stereo_pixel *p, const struct stereo_scratch *scratch)
{
    float sum = 0.0f, all = 0.0f;
    for (int i = 0; i < p->lights->stride; i++) {
        const float value = p->value[i], expected = scratch->expected[i];
        if (value < 0.0f)
            continue;
        const float bright = value > expected ? value : expected;
        const float miss = relative_miss(p, scratch, i), square = miss * miss;
        sum += bright / (bright + p->middle) * square / (square + tolerated * tolerated);
        all += bright / (bright + p->middle);
    }
    return all > 0.0f ? sum / all : 1.0f;
}
