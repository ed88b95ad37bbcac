// sample.c - values between texels of a sample that is repeated without end, and a model's arrays
#include "material/model/model.h"
#include "material/btf/values.h"

// The texels around a place, and their weights.
struct corners {
    int x[2], y[2];
    double weight[2][2];  // [row][column]
};

static int wrap(double at, int n)
{
    const double inside = at - n * floor(at / n);
    return relume_whole(fmin(inside, n - 1));
}

static struct corners corners_of(double x, double y, bool bilinear, int width, int height)
{
    const double left = floor(bilinear ? x - 0.5 : x), top = floor(bilinear ? y - 0.5 : y);
    const double across = bilinear ? x - 0.5 - left : 0.0, down = bilinear ? y - 0.5 - top : 0.0;
    return (struct corners){
        .x = {wrap(left, width), wrap(left + 1.0, width)},
        .y = {wrap(top, height), wrap(top + 1.0, height)},
        .weight = {{(1.0 - across) * (1.0 - down), across * (1.0 - down)},
                   {(1.0 - across) * down, across * down}},
    };
}

static void add(double sum[3], double weight, const float value[3])
{
    for (int c = 0; c < 3; c++)
        sum[c] += weight * (double)value[c];
}

void relume_btf_sample(const relume_btf *btf, double x, double y, bool bilinear,
                       struct relume_vec3 view, struct relume_vec3 light, float rgb[3])
{
    const struct corners c = corners_of(x, y, bilinear, btf->info.width, btf->info.height);
    double sum[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < 4; i++) {
        float value[3];
        if (c.weight[i / 2][i % 2] == 0.0)
            continue;
        relume_btf_evaluate(btf, c.x[i % 2], c.y[i / 2], view, light, value);
        add(sum, c.weight[i / 2][i % 2], value);
    }
    for (int k = 0; k < 3; k++)
        rgb[k] = (float)sum[k];
}

bool relume_btf_fitted_array(struct relume_btf_array *out, const relume_btf_fitted *m, int i)
{
    if (i < 0 || i >= m->arrays)
        return false;
    const struct model_array *a = &m->array[i];
    *out = (struct relume_btf_array){.name = a->name, .dims = a->npy.dims, .data = a->data};
    switch (a->npy.kind) {
    case NPY_U8: out->kind = RELUME_BTF_U8; break;
    case NPY_U16: out->kind = RELUME_BTF_U16; break;
    case NPY_U32: out->kind = RELUME_BTF_U32; break;
    case NPY_HALF: out->kind = RELUME_BTF_HALF; break;
    case NPY_FLOAT: out->kind = RELUME_BTF_FLOAT; break;
    }
    for (int d = 0; d < a->npy.dims; d++)
        out->shape[d] = a->npy.shape[d];
    return true;
}

struct relume_btf_directions relume_btf_fitted_directions(const relume_btf_fitted *m)
{
    return (struct relume_btf_directions){m->view, m->light, m->without_cosine};
}
