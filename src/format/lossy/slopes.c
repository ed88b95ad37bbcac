// slopes.c - rows and columns of equal steps become ramps from one crossing to the next
#include "format/lossy/slopes.h"

#include "core/base/memory.h"

#include <stdbool.h>
#include <string.h>

// Samples of equal steps in a row or column.
struct run {
    size_t begin, end;
    float step, first, last;  // what is crossed at its ends, where it rises there
    bool rises_from, rises_to;
};

// Whether a surface goes on from one step to the other.
static bool goes_on(int a, int b)
{
    return a && b && (a - b == 1 || b - a == 1);
}

static float middle(int a, int b)
{
    return 0.5f * (float)(a + b);
}

static struct run run_from(const uint16_t *line, size_t stride, size_t begin, size_t n)
{
    const int step = line[begin * stride];
    size_t end = begin + 1;
    while (end < n && line[end * stride] == step)
        end++;
    const int before = begin ? line[(begin - 1) * stride] : 0;
    const int after = end < n ? line[end * stride] : 0;
    struct run r = {begin,
                    end,
                    (float)step,
                    (float)step,
                    (float)step,
                    goes_on(step, before),
                    goes_on(step, after)};
    r.first = r.rises_from ? middle(step, before) : r.first;
    r.last = r.rises_to ? middle(step, after) : r.last;
    return r;
}

// At t of 0 .. 1 along it: straight, or by its own step where both ends are on the same side.
static float along(const struct run *r, float t)
{
    if (r->rises_from && r->rises_to && r->first == r->last)
        return r->step + (r->first - r->step) * (t < 0.5f ? 1.0f - 2.0f * t : 2.0f * t - 1.0f);
    return r->first + (r->last - r->first) * t;
}

// A run that is crossed from end to end says most.
static float trust(const struct run *r)
{
    if (!r->rises_from && !r->rises_to)
        return 0.0f;
    return r->rises_from && r->rises_to && r->first != r->last ? 1.0f : 0.25f;
}

// Adds to sum[i * stride] what a row or column says, and to weight how much it is worth.
static void add_line(float *sum, float *weight, const uint16_t *line, size_t stride, size_t n)
{
    for (size_t begin = 0; begin < n;) {
        const struct run r = run_from(line, stride, begin, n);
        const float each = 1.0f / (float)(r.end - r.begin);
        const float w = trust(&r);
        for (size_t i = r.begin; w > 0.0f && i < r.end; i++) {
            sum[i * stride] += w * along(&r, ((float)(i - r.begin) + 0.5f) * each);
            weight[i * stride] += w;
        }
        begin = r.end;
    }
}

relume_status slopes_of_steps(struct relume_image *out, const uint16_t *steps)
{
    const size_t width = (size_t)out->width, height = (size_t)out->height, n = width * height;
    float *weight = mem_zeroed(n, sizeof *weight);
    if (!weight)
        return RELUME_ENOMEM;
    memset(out->data, 0, n * sizeof *out->data);
    for (size_t y = 0; y < height; y++)
        add_line(out->data + y * width, weight + y * width, steps + y * width, 1, width);
    for (size_t x = 0; x < width; x++)
        add_line(out->data + x, weight + x, steps + x, width, height);
    for (size_t i = 0; i < n; i++)
        out->data[i] = weight[i] > 0.0f ? out->data[i] / weight[i] : (float)steps[i];
    mem_free(weight);
    return RELUME_OK;
}
