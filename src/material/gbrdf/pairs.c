// pairs.c - pairs of pictures whose light and eye have changed places
#include "material/gbrdf/pairs.h"

#include "core/base/memory.h"
#include "core/math/vec.h"

// Directions within a third of a degree are one: tables of angles are rounded.
static const double SAME = 0.006;

// The direction of `d` among `n`, or -1.
static int place_of(vec3 d, const vec3 *list, int n)
{
    for (int i = 0; i < n; i++)
        if (vec3_length(vec3_sub(d, list[i])) < SAME)
            return i;
    return -1;
}

relume_status pairs_reciprocal(struct picture_pair **out, int *count, const relume_btf *btf)
{
    const struct relume_btf_info *info = relume_btf_info(btf);
    int *as_light = mem_array((size_t)info->views, sizeof *as_light);
    struct picture_pair *pair =
        mem_array((size_t)info->views * (size_t)info->views / 2 + 1, sizeof *pair);
    *out = pair;
    *count = 0;
    if (!as_light || !pair) {
        mem_free(as_light);
        return RELUME_ENOMEM;
    }
    for (int v = 0; v < info->views; v++)
        as_light[v] = place_of(info->view[v], info->light, info->lights);
    for (int a = 0; a < info->views; a++)
        for (int b = a + 1; b < info->views; b++)
            if (as_light[a] >= 0 && as_light[b] >= 0)
                pair[(*count)++] = (struct picture_pair){{a, b}, {as_light[b], as_light[a]}};
    mem_free(as_light);
    return RELUME_OK;
}

struct resampling {
    const relume_btf *from, *to;
};

static void resample(const void *context, int view, int light, float *rgb)
{
    const struct resampling *r = context;
    const struct relume_btf_info *info = relume_btf_info(r->to);
    for (int y = 0; y < info->height; y++)
        for (int x = 0; x < info->width; x++, rgb += 3)
            relume_btf_evaluate(r->from, x, y, info->view[view], info->light[light], rgb);
}

relume_status pairs_resample(relume_btf **out, const relume_btf *btf, int threads,
                             const struct relume_log *log)
{
    struct relume_btf_info info = *relume_btf_info(btf);
    info.lights = info.views;
    info.light = info.view;
    info.without_cosine = false;  // evaluation multiplies by it
    info.relief = info.normals = (struct relume_image){0};
    relume_status status = relume_btf_create(out, &info, relume_btf_params(.log = log));
    if (!status)
        status = btf_fill(*out, threads, &(struct resampling){btf, *out}, resample);
    if (status)
        relume_btf_destroy(out);
    return status;
}
