// slab_depth_confirm.c - what neighbouring views say of a view's depth
#include "capture/multiview/slab_depth.h"

#include "core/base/thread.h"

#include <math.h>

enum { WITNESSES = 8 };
static const float same = 1.0f;     // planes
static const float trusted = 0.5f;  // share of witnesses

struct confirming {
    const struct slab_depth *d;
    struct plane_sweep_target target;
    float *out, *confidence;
};

// The plane that `other` has where it would see a texel of plane `q`; false outside its picture.
static bool seen_by(float *plane, const struct slab_depth *d, int view, int other, int x, int y,
                    float q)
{
    const double disparity = d->first + (double)q * d->step;
    const long there_x = lround(x + disparity * (d->at[view][0] - d->at[other][0]));
    const long there_y = lround(y + disparity * (d->at[view][1] - d->at[other][1]));
    if (there_x < 0 || there_y < 0 || there_x >= d->sweep.width || there_y >= d->sweep.height)
        return false;
    *plane = d->plane[other][there_y * d->sweep.width + there_x];
    return true;
}

// Who sees something nearer says nothing; who sees through it contradicts.
static float confidence_of(const struct confirming *c, int x, int y, float q)
{
    int confirm = 0, contradict = 0, silent = 0;
    for (int i = 0; i < c->target.count; i++) {
        float plane;
        if (!seen_by(&plane, c->d, c->target.view, c->target.other[i], x, y, q))
            continue;
        confirm += fabsf(plane - q) <= same;
        contradict += plane < q - same;
        silent += plane > q + same;
    }
    if (confirm + contradict + silent == 0)
        return trusted;
    return confirm ? (float)confirm / (float)(confirm + contradict) : 0.0f;
}

// The farther of the nearest trusted texels to the left and right.
static float farther_beside(const float *plane, const float *confidence, int x, int width)
{
    int left = x, right = x;
    while (left >= 0 && confidence[left] < trusted)
        left--;
    while (right < width && confidence[right] < trusted)
        right++;
    if (left < 0 || right >= width)
        return left >= 0 ? plane[left] : right < width ? plane[right] : plane[x];
    return fminf(plane[left], plane[right]);
}

static void confirm_row(void *context, size_t item, int worker)
{
    const struct confirming *c = context;
    const int width = c->d->sweep.width, y = (int)item;
    (void)worker;
    const float *plane = c->d->plane[c->target.view] + item * (size_t)width;
    float *out = c->out + item * (size_t)width;
    float *confidence = c->confidence + item * (size_t)width;
    for (int x = 0; x < width; x++)
        confidence[x] = confidence_of(c, x, y, plane[x]);
    for (int x = 0; x < width; x++)
        out[x] = confidence[x] < trusted ? farther_beside(plane, confidence, x, width) : plane[x];
}

void slab_depth_confirm(float *out, float *confidence, const struct slab_depth *d, int view)
{
    struct confirming c = {d, plane_sweep_target(&d->sweep, view, WITNESSES), out, confidence};
    thread_for(d->p.threads, (size_t)d->sweep.height, confirm_row, &c);
}
