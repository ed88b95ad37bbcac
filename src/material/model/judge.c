// judge.c - how far a model is from what was measured
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "material/btf/values.h"
#include "material/model/model.h"

#include <string.h>

struct texel_error {
    double absolute, squared, energy;
};

struct judge {
    const relume_btf_fitted *model;
    const relume_btf *btf;
    struct relume_direction_blend *view, *light;  // of the BTF's directions among the model's
    bool *pair;                                   // [view][light]: whether it counts
    size_t pairs;
    struct texel_error *error;  // [texel]
};

// Whether the model was fitted to that direction.
static bool is_known(const struct relume_direction_blend *b)
{
    return b->count == 1 && b->rim > 1.0 - 1e-9;
}

static relume_status prepare(struct judge *j, bool unseen)
{
    const struct relume_btf_info *info = &j->btf->info;
    j->view = mem_array((size_t)info->views, sizeof *j->view);
    j->light = mem_array((size_t)info->lights, sizeof *j->light);
    j->pair = mem_array((size_t)info->views * (size_t)info->lights, sizeof *j->pair);
    j->error = mem_array(btf_texels(j->btf), sizeof *j->error);
    if (!j->view || !j->light || !j->pair || !j->error)
        return RELUME_ENOMEM;
    for (int v = 0; v < info->views; v++)
        j->view[v] = relume_direction_mesh_at(j->model->view_mesh, info->view[v]);
    for (int l = 0; l < info->lights; l++)
        j->light[l] = relume_direction_mesh_at(j->model->light_mesh, info->light[l]);
    for (int v = 0; v < info->views; v++)
        for (int l = 0; l < info->lights; l++) {
            const bool counts = !unseen || !is_known(&j->view[v]) || !is_known(&j->light[l]);
            j->pair[(size_t)v * (size_t)info->lights + (size_t)l] = counts;
            j->pairs += counts;
        }
    return RELUME_OK;
}

static void predict(const struct judge *j, size_t texel, int v, int l, float rgb[3])
{
    const struct model_blend at = {.view = j->view[v],
                                   .light = j->light[l],
                                   .v = j->btf->info.view[v],
                                   .l = j->btf->info.light[l]};
    model_blend(j->model, texel, &at, rgb);
}

static void judge_texel(void *context, size_t texel, const float *values)
{
    const struct judge *j = context;
    const struct relume_btf_info *info = &j->btf->info;
    struct texel_error e = {0.0, 0.0, 0.0};
    for (int v = 0; v < info->views; v++)
        for (int l = 0; l < info->lights; l++) {
            const size_t pair = (size_t)v * (size_t)info->lights + (size_t)l;
            if (!j->pair[pair])
                continue;
            // values without the cosine are judged as they are looked at: with it
            const double scale = info->without_cosine ? info->light[l].z : 1.0;
            float rgb[3];
            predict(j, texel, v, l, rgb);
            for (int c = 0; c < 3; c++) {
                const double true_value = scale * (double)values[3 * pair + (size_t)c];
                const double d = (double)rgb[c] - true_value;
                e.absolute += fabs(d);
                e.squared += d * d;
                e.energy += true_value * true_value;
            }
        }
    j->error[texel] = e;
}

static void sum_up(const struct judge *j, struct relume_btf_error *out)
{
    const size_t texels = btf_texels(j->btf);
    const double values = 3.0 * (double)j->pairs;
    double squared = 0.0, energy = 0.0;
    *out = (struct relume_btf_error){
        .mean_min = INFINITY, .pairs = j->pairs, .delta_e = NAN, .ssim = NAN};
    for (size_t i = 0; i < texels; i++) {
        const double mean = j->error[i].absolute / values;
        out->mean_avg += mean / (double)texels;
        out->mean_min = fmin(out->mean_min, mean);
        out->mean_max = fmax(out->mean_max, mean);
        squared += j->error[i].squared;
        energy += j->error[i].energy;
    }
    out->rms = sqrt(squared / (values * (double)texels));
    out->relative = energy > 0.0 ? sqrt(squared / energy) : 0.0;
}

// ---------------------------------------------------------------- as pictures

static void draw(const struct judge *j, int v, int l, struct relume_image *model,
                 struct relume_image *measured)
{
    const vec3 view = j->btf->info.view[v], light = j->btf->info.light[l];
    for (int y = 0; y < model->height; y++)
        for (int x = 0; x < model->width; x++) {
            const size_t texel = (size_t)y * (size_t)model->width + (size_t)x;
            predict(j, texel, v, l, model->data + 3 * texel);
            relume_btf_evaluate(j->btf, x, y, view, light, measured->data + 3 * texel);
        }
}

// Pairs spread evenly over those that count.
static relume_status compare_pictures(const struct judge *j,
                                      const struct relume_btf_judge_params *p,
                                      struct relume_btf_error *out)
{
    const int width = j->btf->info.width, height = j->btf->info.height;
    struct relume_image model = {0}, measured = {0};
    relume_status status = relume_image_create(&model, width, height, 3);
    if (!status)
        status = relume_image_create(&measured, width, height, 3);
    size_t seen = 0;
    double delta_e = 0.0, ssim = 0.0;
    const size_t all = (size_t)j->btf->info.views * (size_t)j->btf->info.lights;
    const size_t wanted = (size_t)p->pictures < j->pairs ? (size_t)p->pictures : j->pairs;
    for (size_t pair = 0; pair < all && !status; pair++) {
        if (!j->pair[pair])
            continue;
        seen++;
        if (seen * wanted / j->pairs == (seen - 1) * wanted / j->pairs)
            continue;
        struct relume_difference d;
        draw(j, (int)(pair / (size_t)j->btf->info.lights),
             (int)(pair % (size_t)j->btf->info.lights), &model, &measured);
        status = relume_image_compare(&d, &model, &measured,
                                      relume_compare_params(.threads = p->threads));
        delta_e += d.delta_e;
        ssim += d.ssim;
        out->pictures++;
    }
    if (!status && out->pictures) {
        out->delta_e = delta_e / out->pictures;
        out->ssim = ssim / out->pictures;
    }
    relume_image_destroy(&model);
    relume_image_destroy(&measured);
    return status;
}

relume_status relume_btf_judge(struct relume_btf_error *out, const relume_btf_fitted *fitted,
                               const relume_btf *btf, const struct relume_btf_judge_params *params)
{
    const struct relume_btf_judge_params p = PARAMS_WORK(relume_btf_judge_params, params);
    struct judge j = {.model = fitted, .btf = btf};
    if (fitted->width != btf->info.width || fitted->height != btf->info.height)
        return log_fail(p.log, RELUME_EINVAL, "%s: %d x %d texels; expected %d x %d as the model",
                        btf_name(btf), btf->info.width, btf->info.height, fitted->width,
                        fitted->height);
    relume_status status = prepare(&j, p.unseen);
    if (!status && !j.pairs)
        status = log_fail(p.log, RELUME_EINVAL,
                          "%s: the model was fitted to all directions, so none are left to test it "
                          "on; fit with --leave-out first",
                          btf_name(btf));
    if (!status)
        status = btf_for_texels(btf, p.threads, p.log, "comparing", &j, judge_texel);
    if (!status) {
        sum_up(&j, out);
        if (p.pictures > 0)
            status = compare_pictures(&j, &p, out);
    }
    mem_free(j.view);
    mem_free(j.light);
    mem_free(j.pair);
    mem_free(j.error);
    return status;
}
