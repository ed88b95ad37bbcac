// btf.c - the inside of a relume_btf, and what its readers and its models share
#include "material/btf/btf.h"

#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/scratch.h"
#include "material/btf/values.h"

#include <errno.h>
#include <string.h>

static const float HALF_MAX = 65504.0f;

uint64_t relume_btf_bytes(int width, int height, int views, int lights)
{
    return (uint64_t)width * (uint64_t)height * (uint64_t)views * (uint64_t)lights * 6;
}

static relume_status copy_image(struct relume_image *out, const struct relume_image *from)
{
    if (!from->data)
        return RELUME_OK;
    const relume_status status =
        relume_image_create(out, from->width, from->height, from->channels);
    if (!status)
        memcpy(out->data, from->data,
               (size_t)from->width * (size_t)from->height * (size_t)from->channels * sizeof(float));
    return status;
}

static relume_status check(const struct relume_btf_info *info, const char *path,
                           const struct relume_log *log)
{
    const struct relume_limits limits = limits_or_default(NULL);
    const char *colon = path ? ": " : "";
    path = path ? path : "";
    if (!limits_allow(&limits, info->width, info->height))
        return log_fail(log, RELUME_ELIMIT, "%s%stexels: expected 1 to 65536 a side; found %d x %d",
                        path, colon, info->width, info->height);
    if (info->views > limits.max_views || info->lights > limits.max_lights)
        return log_fail(log, RELUME_ELIMIT, "%s%sdirections: expected at most %d; found %d x %d",
                        path, colon, limits.max_views, info->views, info->lights);
    return RELUME_OK;
}

static bool copy_parts(relume_btf *b, const struct relume_btf_info *info)
{
    const size_t views = (size_t)info->views, lights = (size_t)info->lights;
    b->info.name = mem_text(info->name ? info->name : "");
    b->view = mem_copy(info->view, views, sizeof *b->view);
    b->light = mem_copy(info->light, lights, sizeof *b->light);
    b->view_at = mem_array(views, sizeof *b->view_at);
    b->light_at = mem_array(lights, sizeof *b->light_at);
    if (!b->info.name || !b->view || !b->light || !b->view_at || !b->light_at)
        return false;
    b->info.view = b->view;
    b->info.light = b->light;
    for (int i = 0; i < info->views; i++)
        b->view_at[i] = i;
    for (int i = 0; i < info->lights; i++)
        b->light_at[i] = i;
    b->stored_lights = info->lights;
    return true;
}

relume_status btf_make_mesh(relume_direction_mesh **out, const vec3 *directions, int n,
                            const char *path, const char *what, const struct relume_log *log)
{
    struct log_place place;
    return relume_direction_mesh_create(out, directions, n,
                                        path ? log_at(&place, log, "%s: %s ", path, what) : log);
}

relume_status btf_start(relume_btf **out, const struct relume_btf_info *info, const char *path,
                        const struct relume_log *log)
{
    *out = NULL;
    relume_status status = check(info, path, log);
    if (status)
        return status;
    relume_btf *b = mem_zeroed(1, sizeof *b);
    if (!b)
        return RELUME_ENOMEM;
    b->info = *info;
    b->info.relief = b->info.normals = (struct relume_image){0};
    b->path = path ? mem_text(path) : NULL;
    status = copy_parts(b, info) && !b->path == !path ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = btf_make_mesh(&b->views, b->view, info->views, path, "view", log);
    if (!status)
        status = btf_make_mesh(&b->lights, b->light, info->lights, path, "light", log);
    if (!status)
        status = copy_image(&b->info.relief, &info->relief);
    if (!status)
        status = copy_image(&b->info.normals, &info->normals);
    if (status)
        relume_btf_destroy(&b);
    *out = b;
    return status;
}

static size_t own_bytes(const relume_btf *b)
{
    return relume_btf_bytes(b->info.width, b->info.height, b->info.views, b->info.lights);
}

relume_status btf_allocate(relume_btf *btf, const struct relume_btf_params *params)
{
    char *near = params && params->scratch ? mem_format("%s/values", params->scratch) : NULL;
    btf->own = scratch_map(near, own_bytes(btf));
    const int error = errno;
    btf->values = btf->own;
    mem_free(near);
    if (btf->own)
        return RELUME_OK;
    const char *temp = getenv("TMPDIR");
    return log_fail(params ? params->log : NULL, RELUME_ESYSTEM,
                    "no room for %.3g GiB of temporary data in %s (TMPDIR names another folder); "
                    "%s",
                    (double)own_bytes(btf) / 1073741824.0,
                    params && params->scratch ? params->scratch
                    : temp && *temp           ? temp
                                              : "/tmp",
                    strerror(error));
}

relume_status relume_btf_create(relume_btf **out, const struct relume_btf_info *info,
                                const struct relume_btf_params *params)
{
    relume_status status = btf_start(out, info, NULL, params ? params->log : NULL);
    if (!status)
        status = btf_allocate(*out, params);
    if (status && *out)
        relume_btf_destroy(out);
    return relume_status_is_input(status) ? RELUME_EINVAL : status;
}

void relume_btf_destroy(relume_btf **btf)
{
    relume_btf *b = *btf;
    *btf = NULL;
    if (!b)
        return;
    if (b->own)
        scratch_unmap(b->own, own_bytes(b));
    npy_close(&b->file);
    relume_direction_mesh_destroy(&b->views);
    relume_direction_mesh_destroy(&b->lights);
    relume_image_destroy(&b->info.relief);
    relume_image_destroy(&b->info.normals);
    mem_free((void *)b->info.name);
    mem_free(b->path);
    mem_free(b->view);
    mem_free(b->light);
    mem_free(b->view_at);
    mem_free(b->light_at);
    mem_free(b);
}

const struct relume_btf_info *relume_btf_info(const relume_btf *btf)
{
    return &btf->info;
}

const uint16_t *relume_btf_picture(const relume_btf *btf, int view, int light)
{
    const size_t stored =
        (size_t)btf->view_at[view] * (size_t)btf->stored_lights + (size_t)btf->light_at[light];
    return btf->values + stored * btf_texels(btf) * 3;
}

void relume_btf_store(relume_btf *btf, int view, int light, const float *rgb)
{
    uint16_t *to = btf->own + (relume_btf_picture(btf, view, light) - btf->values);
    for (size_t i = 0; i < btf_texels(btf) * 3; i++)
        to[i] = half_from_float(rgb[i] > HALF_MAX    ? HALF_MAX
                                : rgb[i] < -HALF_MAX ? -HALF_MAX
                                                     : rgb[i]);
}

static void pick(vec3 *to, const vec3 *from, int *at, const int *from_at, const int *which, int n)
{
    for (int i = 0; i < n; i++) {
        to[i] = from[which[i]];
        at[i] = from_at[which[i]];
    }
}

relume_status relume_btf_part(relume_btf **out, const relume_btf *whole, const int *views,
                              int view_count, const int *lights, int light_count,
                              const struct relume_log *log)
{
    *out = NULL;
    vec3 *v = mem_array((size_t)view_count, sizeof *v);
    vec3 *l = mem_array((size_t)light_count, sizeof *l);
    int *v_at = mem_array((size_t)view_count, sizeof *v_at);
    int *l_at = mem_array((size_t)light_count, sizeof *l_at);
    relume_status status = RELUME_ENOMEM;
    if (v && l && v_at && l_at) {
        pick(v, whole->view, v_at, whole->view_at, views, view_count);
        pick(l, whole->light, l_at, whole->light_at, lights, light_count);
        struct relume_btf_info info = whole->info;
        info.views = view_count, info.view = v;
        info.lights = light_count, info.light = l;
        status = btf_start(out, &info, whole->path, log);
    }
    if (!status) {
        (*out)->values = whole->values;
        (*out)->stored_lights = whole->stored_lights;
        memcpy((*out)->view_at, v_at, (size_t)view_count * sizeof *v_at);
        memcpy((*out)->light_at, l_at, (size_t)light_count * sizeof *l_at);
    }
    mem_free(v);
    mem_free(l);
    mem_free(v_at);
    mem_free(l_at);
    return status;
}

void btf_gather(const relume_btf *btf, size_t first, size_t count, float *out)
{
    const size_t lights = (size_t)btf->info.lights, pairs = lights * (size_t)btf->info.views;
    for (int v = 0; v < btf->info.views; v++)
        for (int l = 0; l < btf->info.lights; l++) {
            const uint16_t *from = relume_btf_picture(btf, v, l) + 3 * first;
            float *to = out + 3 * ((size_t)v * lights + (size_t)l);
            for (size_t i = 0; i < count; i++, from += 3, to += 3 * pairs)
                for (int c = 0; c < 3; c++)
                    to[c] = float_from_half(from[c]);
        }
}

void relume_btf_evaluate(const relume_btf *btf, int x, int y, struct relume_vec3 view,
                         struct relume_vec3 light, float rgb[3])
{
    const size_t texel = (size_t)y * (size_t)btf->info.width + (size_t)x;
    double sum[3] = {0.0, 0.0, 0.0};
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (!(view.z > 0.0) || !(light.z > 0.0))
        return;
    const struct relume_direction_blend v = relume_direction_mesh_at(btf->views, view);
    const struct relume_direction_blend l = relume_direction_mesh_at(btf->lights, light);
    for (int i = 0; i < v.count; i++)
        for (int j = 0; j < l.count; j++) {
            const uint16_t *p = relume_btf_picture(btf, v.index[i], l.index[j]) + 3 * texel;
            for (int c = 0; c < 3; c++)
                sum[c] += v.weight[i] * l.weight[j] * float_from_half(p[c]);
        }
    const double scale = btf->info.without_cosine ? light.z : l.rim / l.length;
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(scale * sum[c]);
}
