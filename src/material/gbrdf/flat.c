// flat.c - a BTF drawn onto its relief
#include "material/gbrdf/flat.h"

#include "core/base/half.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "material/btf/values.h"

#include <stdatomic.h>

struct flattening {
    struct flat *flat;
    const relume_btf *btf;
    const struct meso *relief;
    atomic_bool failed;
};

// Where the place of the relief over a texel's middle shows in the pictures of a view.
static struct bilinear shown_at(const struct meso *m, size_t texel, vec3 v)
{
    const double z = (double)m->z[texel] / v.z;
    return bilinear_tiled((double)(texel % (size_t)m->width) - z * v.x,
                          (double)(texel / (size_t)m->width) + z * v.y, m->width, m->height);
}

static void move_picture(float *to, const uint16_t *from, const struct bilinear *at, size_t texels)
{
    for (size_t i = 0; i < texels; i++, to += 3)
        for (int c = 0; c < 3; c++) {
            to[c] = 0.0f;
            for (int k = 0; k < 4; k++)
                to[c] += bilinear_sharef(&at[i], k, float_from_half(from[3 * at[i].at[k] + c]));
        }
}

static void move_view(void *context, size_t view, int worker)
{
    (void)worker;
    struct flattening *w = context;
    const struct relume_btf_info *info = relume_btf_info(w->btf);
    const size_t texels = btf_texels(w->btf);
    struct bilinear *at = mem_array(texels, sizeof *at);
    float *rgb = mem_array(3 * texels, sizeof *rgb);
    for (size_t i = 0; at && rgb && i < texels; i++)
        at[i] = shown_at(w->relief, i, info->view[view]);
    for (int l = 0; at && rgb && l < info->lights; l++) {
        move_picture(rgb, relume_btf_picture(w->btf, (int)view, l), at, texels);
        relume_btf_store(w->flat->own, (int)view, l, rgb);
    }
    if (!at || !rgb)
        w->failed = true;
    mem_free(at);
    mem_free(rgb);
}

static void look_around(void *context, size_t row, int worker)
{
    (void)worker;
    const struct flattening *w = context;
    const struct relume_btf_info *info = relume_btf_info(w->btf);
    const struct meso *m = w->relief;
    for (int x = 0; x < m->width; x++) {
        const size_t i = row * (size_t)m->width + (size_t)x;
        const vec3 at = vec3_of(x + 0.5, (double)row + 0.5, (double)m->z[i]);
        w->flat->normal[i] = meso_normal(m, x, (int)row);
        for (int v = 0; v < info->views; v++)
            w->flat->seen[i * (size_t)info->views + (size_t)v] = meso_open(m, at, info->view[v]);
        for (int l = 0; l < info->lights; l++)
            w->flat->lit[i * (size_t)info->lights + (size_t)l] = meso_open(m, at, info->light[l]);
    }
}

relume_status flat_make(struct flat *out, const relume_btf *btf, const struct meso *relief,
                        int threads, const struct relume_log *log)
{
    struct relume_btf_info info = *relume_btf_info(btf);
    const size_t texels = btf_texels(btf);
    struct flattening w = {out, btf, relief, false};
    *out = (struct flat){
        .btf = btf,
        .views = info.views,
        .lights = info.lights,
        .seen = mem_array(texels * (size_t)info.views, 1),
        .lit = mem_array(texels * (size_t)info.lights, 1),
        .normal = mem_array(texels, sizeof *out->normal),
    };
    if (!out->seen || !out->lit || !out->normal)
        return RELUME_ENOMEM;
    thread_for(threads, (size_t)info.height, look_around, &w);
    if (relief->low == 0.0f && relief->high == 0.0f)
        return RELUME_OK;
    info.relief = info.normals = (struct relume_image){0};
    const relume_status status = relume_btf_create(&out->own, &info, relume_btf_params(.log = log));
    if (status)
        return status;
    thread_for(threads, (size_t)info.views, move_view, &w);
    out->btf = out->own;
    return w.failed ? RELUME_ENOMEM : RELUME_OK;
}

void flat_free(struct flat *flat)
{
    relume_btf_destroy(&flat->own);
    mem_free(flat->seen);
    mem_free(flat->lit);
    mem_free(flat->normal);
    *flat = (struct flat){.btf = NULL};
}
