// relighter.c - views relit again and again: grids, refits and pictures that are kept

#include "core/base/memory.h"
#include "core/base/params.h"
#include "image/image/image.h"
#include "image/image/rgba8.h"
#include "relight/frame/relighter.h"
#include "relight/light/environment.h"
#include "relight/light/grid.h"
#include "relight/light/refit.h"
#include "relight/shadow/moving.h"

#include <math.h>
#include <relume/relight/relight.h>
#include <string.h>

struct group {
    struct relume_light *light;  // that `image` was relit under
    int lights;
    struct relume_image image;
};

struct view {
    relume_refit *refit;      // or NULL: not needed yet
    struct group *group;      // [groups], or NULL: no picture is kept
    struct relume_image sum;  // of the groups, where there are several
};

struct relume_relighter {
    struct relume_relighter_params params;
    int views;
    struct view *view;         // [views]
    relume_weight_grid *grid;  // of the coder, for all lights
    relume_weight_grid *sums;  // ... for environments alone
    relume_refit *learned;     // of the first view that needed one: all others take over from it
};

// ---------------------------------------------------------------- what is kept

static void empty(struct group *g)
{
    mem_free(g->light);
    relume_image_destroy(&g->image);
    *g = (struct group){0};
}

static void forget(const relume_relighter *r, struct view *v)
{
    for (int i = 0; v->group && i < r->params.groups; i++)
        empty(&v->group[i]);
    mem_free(v->group);
    v->group = NULL;
    relume_image_destroy(&v->sum);
}

void relume_relighter_forget(relume_relighter *r)
{
    for (int i = 0; i < r->views; i++)
        forget(r, &r->view[i]);
}

void relume_relighter_drop(relume_relighter *r, int view)
{
    struct view *v = &r->view[view];
    forget(r, v);
    if (v->refit && v->refit == r->learned) {
        relume_refit_forget(r->learned);
        v->refit = NULL;
    }
    relume_refit_destroy(&v->refit);
}

relume_status relume_relighter_create(relume_relighter **out, int views,
                                      const struct relume_relighter_params *params)
{
    struct relume_relighter_params p = PARAMS(relume_relighter_params, params);
    p.groups = p.groups ? p.groups : 1;
    *out = NULL;
    if (views < 1 || p.groups < 1 || p.groups > RELUME_RELIGHTER_GROUPS)
        return RELUME_EINVAL;
    relume_relighter *r = mem_zeroed(1, sizeof *r);
    struct view *view = mem_zeroed((size_t)views, sizeof *view);
    if (!r || !view) {
        mem_free(r);
        mem_free(view);
        return RELUME_ENOMEM;
    }
    *r = (relume_relighter){.params = p, .views = views, .view = view};
    *out = r;
    return RELUME_OK;
}

void relume_relighter_destroy(relume_relighter **relighter)
{
    relume_relighter *r = *relighter;
    *relighter = NULL;
    if (!r)
        return;
    for (int i = 0; i < r->views; i++)
        relume_relighter_drop(r, i);
    relume_weight_grid_destroy(&r->grid);
    relume_weight_grid_destroy(&r->sums);
    relume_refit_destroy(&r->learned);
    mem_free(r->view);
    mem_free(r);
}

uint64_t relume_relighter_bytes(const relume_relighter *r, int view)
{
    const struct view *v = &r->view[view];
    uint64_t bytes = image_bytes(&v->sum);
    for (int i = 0; v->group && i < r->params.groups; i++)
        bytes += image_bytes(&v->group[i].image);
    if (v->refit) {
        const struct relume_codes *codes = relume_refit_codes(v->refit);
        const int maps = codes->books ? codes->books : codes->planes;
        bytes += 2 * (uint64_t)maps * (uint64_t)codes->width * (uint64_t)codes->height;
    }
    return bytes;
}

// ---------------------------------------------------------------- what lights need

static relume_status need_grid(const relume_weight_grid **grid, relume_relighter *r,
                               const relume_coder *coder, bool sums)
{
    relume_weight_grid **own = sums && !r->grid ? &r->sums : &r->grid;
    const relume_status status =
        *own ? RELUME_OK
             : relume_weight_grid_create(
                   own, coder,
                   relume_weight_grid_params(.sums = sums, .threads = r->params.threads));
    *grid = *own;
    return status;
}

static relume_status need_refit(relume_relighter *r, const struct relume_relit *relit)
{
    struct view *v = &r->view[relit->view];
    if (v->refit)
        return RELUME_OK;
    const relume_status status = relume_refit_create(
        &v->refit, relit->codes,
        relume_refit_params(.log = r->learned ? NULL : relit->log, .like = r->learned,
                            .cpu_off = r->params.cpu_off, .threads = r->params.threads));
    if (!r->learned)
        r->learned = v->refit;
    return status;
}

static relume_status prepare(struct relume_relight_params *p, relume_relighter *r,
                             const struct relume_relit *relit)
{
    bool near = false, environment = false;
    for (int i = 0; i < relit->count; i++) {
        near |= relume_light_is_near(relit->lights[i].kind);
        environment |= relit->lights[i].kind == RELUME_LIGHT_ENVIRONMENT;
    }
    const bool refits =
        environment && relit->codes->domain == RELUME_DOMAIN_DISPLAY && !r->params.once;
    relume_status status = refits ? need_refit(r, relit) : RELUME_OK;
    *p = (struct relume_relight_params){.log = relit->log,
                                        .cpu_off = r->params.cpu_off,
                                        .threads = r->params.threads,
                                        .surface = near ? relit->surface : NULL,
                                        .refit = r->view[relit->view].refit};
    const bool sums = environment && relit->codes->domain == RELUME_DOMAIN_LINEAR;
    if (!status && (near || sums))
        status = need_grid(&p->grid, r, relit->codes->coder, !near);
    return status;
}

// What is added to a light's picture ends where that is black: lights are shown one by one.
static relume_status relight_each(struct relume_image *out, relume_relighter *r,
                                  const struct relume_relit *relit)
{
    struct relume_relit one = *relit;
    one.count = 1;
    relume_status status = relume_relighter_relight(out, r, &one);
    while (!status && ++one.lights < relit->lights + relit->count) {
        struct relume_image image = {0};
        status = relume_relighter_relight(&image, r, &one);
        const size_t n = 3 * (size_t)out->width * (size_t)out->height;
        for (size_t i = 0; !status && i < n; i++)
            out->data[i] += image.data[i];
        relume_image_destroy(&image);
    }
    return status;
}

// Replaces one bright source in the picture of an environment by the same source with moving
// shadows or highlights. `shown` is scratch memory.
static relume_status exchange_bright_source(struct relume_image *out, struct relume_image *shown,
                                            const struct relume_relight_params *p,
                                            const struct relume_relit *relit,
                                            const struct relume_light *source, int threads)
{
    const size_t n = 3 * (size_t)out->width * (size_t)out->height;
    struct relume_light alone = {.kind = RELUME_LIGHT_ENVIRONMENT, .rgb = {1.0f, 1.0f, 1.0f}};
    relume_environment *environment;
    relume_status status = relume_environment_of_lamp(&environment, source);
    alone.environment = environment;
    if (!status)
        status = relume_relight(shown, relit->codes, &alone, 1, p);
    for (size_t i = 0; !status && i < n; i++)
        out->data[i] -= shown->data[i];
    if (!status)
        status = relume_shadows_add_bright_source(shown, relit->left, relit->top, relit->shadows,
                                                  relit->codes->coder, source, threads);
    for (size_t i = 0; !status && i < n; i++)
        out->data[i] = fmaxf(out->data[i] + shown->data[i], 0.0f);
    relume_environment_destroy(&environment);
    return status;
}

static relume_status exchange_bright_sources(struct relume_image *out, const relume_relighter *r,
                                             const struct relume_relight_params *p,
                                             const struct relume_relit *relit)
{
    struct relume_light source[RELUME_SHADOW_LAMPS];
    struct relume_relight_params quiet = *p;
    struct relume_image shown = {0};
    int count;
    relume_status status =
        relume_shadows_bright_sources(source, &count, relit->lights, relit->codes->coder);
    quiet.log = NULL;
    for (int i = 0; !status && i < count; i++)
        status = exchange_bright_source(out, &shown, &quiet, relit, &source[i], r->params.threads);
    relume_image_destroy(&shown);
    return status;
}

relume_status relume_relighter_relight(struct relume_image *out, relume_relighter *r,
                                       const struct relume_relit *relit)
{
    struct relume_relight_params p;
    if (relit->shadows && relit->count > 1)
        return relight_each(out, r, relit);
    relume_status status = prepare(&p, r, relit);
    if (!status)
        status = relume_relight(out, relit->codes, relit->lights, relit->count, &p);
    if (status || !relit->shadows || !relit->count)
        return status;
    return relit->lights[0].kind == RELUME_LIGHT_ENVIRONMENT
               ? exchange_bright_sources(out, r, &p, relit)
               : relume_shadows_add(out, relit->left, relit->top, relit->shadows, relit->codes,
                                    relit->lights, r->params.threads);
}

static relume_status code_shadows(uint8_t *out, relume_relighter *r,
                                  const struct relume_relit *relit, double exposure_ev)
{
    struct relume_image image = {0};
    struct byte_coder coder;
    relume_status status = relume_relighter_relight(&image, r, relit);
    byte_coder_init(&coder, (float)exp2(exposure_ev));
    if (!status)
        byte_code((uint32_t *)(void *)out, image.data, (size_t)image.width * (size_t)image.height,
                  &coder);
    relume_image_destroy(&image);
    return status;
}

relume_status relume_relighter_rgba8(uint8_t *out, relume_relighter *r,
                                     const struct relume_relit *relit, double exposure_ev)
{
    struct relume_relight_params p;
    if (relit->shadows)
        return code_shadows(out, r, relit, exposure_ev);
    const relume_status status = prepare(&p, r, relit);
    p.exposure_ev = (float)exposure_ev;
    return status ? status
                  : relume_relight_rgba8(out, relit->codes, relit->lights, relit->count, &p);
}

// ---------------------------------------------------------------- groups

static bool same_lights(const struct group *g, const struct relume_light *lights, int n)
{
    if (!g->image.data || g->lights != n)
        return false;
    for (int i = 0; i < n; i++)
        if (!relume_light_equal(&g->light[i], &lights[i]))
            return false;
    return true;
}

static relume_status keep_lights(struct group *g, const struct relume_light *lights, int n)
{
    struct relume_light *copy = mem_copy(lights, (size_t)n, sizeof *copy);
    if (!copy)
        return RELUME_ENOMEM;
    mem_free(g->light);
    g->light = copy;
    g->lights = n;
    return RELUME_OK;
}

static relume_status relight_group(relume_relighter *r, struct group *g,
                                   const struct relume_relit *relit)
{
    if (same_lights(g, relit->lights, relit->count))
        return RELUME_OK;
    relume_status status = keep_lights(g, relit->lights, relit->count);
    if (!status)
        status = relume_relighter_relight(&g->image, r, relit);
    if (status)
        empty(g);
    return status;
}

// Codes that fold take any number of distant lights in one loop.
static bool stands_alone(const struct relume_codes *codes, const struct relume_light *light)
{
    const bool folds = codes->domain != RELUME_DOMAIN_DISPLAY || codes->books == 1;
    return relume_light_is_near(light->kind) || !folds;
}

// Group 0 holds what folds, the others as many each of the lights that stand alone.
static int group_of(int i, int alone, int groups)
{
    const int others = groups - 1;
    return 1 + (alone <= others ? i : (int)((long long)i * others / alone));
}

static int gather(struct relume_light *out, const struct relume_relit *relit, int group, int groups)
{
    int alone = 0, next = 0, count = 0;
    for (int i = 0; i < relit->count; i++)
        alone += stands_alone(relit->codes, &relit->lights[i]);
    for (int i = 0; i < relit->count; i++) {
        const bool apart = groups > 1 && stands_alone(relit->codes, &relit->lights[i]);
        if ((apart ? group_of(next++, alone, groups) : 0) == group)
            out[count++] = relit->lights[i];
    }
    return count;
}

static relume_status relight_groups(relume_relighter *r, struct view *v,
                                    const struct relume_relit *relit)
{
    const int groups = r->params.groups;
    struct relume_light *some = mem_array((size_t)relit->count, sizeof *some);
    struct relume_relit part = *relit;
    relume_status status = some ? RELUME_OK : RELUME_ENOMEM;
    part.lights = some;
    for (int i = 0; !status && i < groups; i++) {
        part.count = gather(some, relit, i, groups);
        if (part.count || groups == 1)
            status = relight_group(r, &v->group[i], &part);
        else
            empty(&v->group[i]);
    }
    mem_free(some);
    return status;
}

// ---------------------------------------------------------------- their sum

static void add(struct relume_image *sum, const struct relume_image *image)
{
    const size_t n = 3 * (size_t)sum->width * (size_t)sum->height;
    float *restrict to = sum->data;
    const float *restrict from = image->data;
    for (size_t i = 0; i < n; i++)
        to[i] += from[i];
}

// A group that stands alone is the sum.
static relume_status add_groups(const struct relume_image **out, const relume_relighter *r,
                                struct view *v, const struct relume_codes *codes)
{
    int used = 0;
    for (int i = 0; i < r->params.groups; i++)
        if (v->group[i].image.data && ++used)
            *out = &v->group[i].image;
    if (used == 1)
        return RELUME_OK;
    relume_status status =
        v->sum.data ? RELUME_OK : relume_image_create(&v->sum, codes->width, codes->height, 3);
    if (status)
        return status;
    memset(v->sum.data, 0, image_bytes(&v->sum));
    for (int i = 0; i < r->params.groups; i++)
        if (v->group[i].image.data)
            add(&v->sum, &v->group[i].image);
    *out = &v->sum;
    return RELUME_OK;
}

relume_status relume_relighter_picture(const struct relume_image **out, relume_relighter *r,
                                       const struct relume_relit *relit)
{
    struct view *v = &r->view[relit->view];
    *out = NULL;
    if (!v->group && !(v->group = mem_zeroed((size_t)r->params.groups, sizeof *v->group)))
        return RELUME_ENOMEM;
    const relume_status status = relight_groups(r, v, relit);
    return status ? status : add_groups(out, r, v, relit->codes);
}
