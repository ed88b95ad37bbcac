// levels.c - levels of detail of a BTF: values are averaged, never the parameters of a model, which
// do not enter them linearly
#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "material/btf/btf.h"
#include "material/btf/values.h"

int btf_half_side(int side)
{
    return side > 1 ? side / 2 : 1;
}

struct halving {
    const relume_btf *from;
    relume_btf *to;
};

// The texels [out[0], out[1]) whose mean texel `i` of a side half as long is: two, at an odd end
// three.
static void span(int i, int side, int out[2])
{
    out[0] = side > 1 ? 2 * i : 0;
    out[1] = i + 1 == btf_half_side(side) ? side : 2 * i + 2;
}

static void average(const struct halving *h, const uint16_t *from, int x, int y, uint16_t to[3])
{
    int across[2], down[2];
    float sum[3] = {0.0f, 0.0f, 0.0f};
    span(x, h->from->info.width, across);
    span(y, h->from->info.height, down);
    for (int j = down[0]; j < down[1]; j++)
        for (int i = across[0]; i < across[1]; i++) {
            const uint16_t *p = from + 3 * ((size_t)j * (size_t)h->from->info.width + (size_t)i);
            for (int c = 0; c < 3; c++)
                sum[c] += float_from_half(p[c]);
        }
    const float count = (float)((across[1] - across[0]) * (down[1] - down[0]));
    for (int c = 0; c < 3; c++)
        to[c] = half_from_float(sum[c] / count);
}

static void halve_view(void *context, size_t view, int worker)
{
    (void)worker;
    const struct halving *h = context;
    const int width = h->to->info.width, height = h->to->info.height;
    for (int l = 0; l < h->from->info.lights; l++) {
        const uint16_t *from = relume_btf_picture(h->from, (int)view, l);
        uint16_t *to = h->to->own + (relume_btf_picture(h->to, (int)view, l) - h->to->values);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++, to += 3)
                average(h, from, x, y, to);
    }
}

relume_status relume_btf_halve(relume_btf **out, const relume_btf *btf,
                               const struct relume_btf_params *params)
{
    struct relume_btf_info info = btf->info;
    info.width = btf_half_side(info.width);
    info.height = btf_half_side(info.height);
    info.relief = info.normals = (struct relume_image){0};
    const struct relume_btf_params own = PARAMS_WORK(relume_btf_params, params);
    const relume_status status = relume_btf_create(out, &info, &own);
    if (status)
        return status;
    struct halving h = {btf, *out};
    thread_for(own.threads, (size_t)info.views, halve_view, &h);
    return RELUME_OK;
}
