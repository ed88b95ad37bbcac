#include "software.h"

#include "lamps.h"
#include "say.h"

#include <stdlib.h>
#include <string.h>

void software_destroy(struct software *s)
{
    relume_weight_grid_destroy(&s->grid);
    relume_refit_destroy(&s->refit);
}

// ---------------------------------------------------------------- views

void software_view_begin(struct software_view *v, const struct relume_codes *codes, int view)
{
    *v = (struct software_view){.codes = codes, .view = view};
}

static void empty(struct software_group *g)
{
    free(g->light);
    relume_image_destroy(&g->image);
    *g = (struct software_group){0};
}

void software_view_forget(struct software_view *v)
{
    for (int i = 0; i < SOFTWARE_GROUPS; i++)
        empty(&v->group[i]);
}

void software_view_destroy(struct software_view *v, const struct code_source *source)
{
    if (v->codes && source->drop)
        source->drop(source->user, v->view);
    software_view_forget(v);
    relume_image_destroy(&v->surface);
    relume_image_destroy(&v->sum);
    relume_refit_destroy(&v->refit);
    *v = (struct software_view){0};
}

static size_t image_bytes(const struct relume_image *image)
{
    return image->data ? 3 * (size_t)image->width * (size_t)image->height * sizeof *image->data : 0;
}

size_t software_view_bytes(const struct software_view *v)
{
    size_t bytes = image_bytes(&v->surface) + image_bytes(&v->sum);
    for (int i = 0; i < SOFTWARE_GROUPS; i++)
        bytes += image_bytes(&v->group[i].image);
    return bytes;
}

// ---------------------------------------------------------------- needs

static relume_status need_surface(struct software_view *v, const struct code_source *source,
                                  const struct relume_log *log)
{
    if (v->surface.data)
        return RELUME_OK;
    const relume_status status =
        source->surface ? source->surface(&v->surface, source->user, v->view) : RELUME_EINVAL;
    if (status == RELUME_EINVAL)
        return say(log, RELUME_EDATA,
                   "a near light needs to know how far the surface is; use a file with depth");
    return status;
}

static relume_status need_grid(struct software *shared, const relume_coder *coder)
{
    return shared->grid
               ? RELUME_OK
               : relume_weight_grid_create(&shared->grid, coder,
                                           relume_weight_grid_params(.threads = shared->threads));
}

// What the first view's codes teach serves all views.
static relume_status learn(struct software *shared, const struct relume_codes *codes,
                           const struct relume_log *log)
{
    if (shared->refit)
        return RELUME_OK;
    const relume_status status = relume_refit_create(
        &shared->refit, codes, relume_refit_params(.log = log, .threads = shared->threads));
    if (!status)
        relume_refit_forget(shared->refit);
    return status;
}

static relume_status need_refit(struct software_view *v, struct software *shared,
                                const struct relume_log *log)
{
    if (v->refit)
        return RELUME_OK;
    const relume_status status = learn(shared, v->codes, log);
    return status ? status
                  : relume_refit_create(
                        &v->refit, v->codes,
                        relume_refit_params(.like = shared->refit, .threads = shared->threads));
}

// ---------------------------------------------------------------- groups

// Whether distant lights cost one pass however many they are.
static bool folds(const struct relume_codes *codes)
{
    return codes->domain != RELUME_DOMAIN_DISPLAY || codes->books == 1;
}

static bool stands_alone(const struct software_view *v, const struct relume_light *light)
{
    return relume_light_is_near(light->kind) || !folds(v->codes);
}

static bool same_lights(const struct software_group *g, const struct relume_light *lights, int n)
{
    if (!g->image.data || g->lights != n)
        return false;
    for (int i = 0; i < n; i++)
        if (!lamps_same(&g->light[i], &lights[i]))
            return false;
    return true;
}

struct job {
    struct software_view *view;
    struct software *shared;
    const struct code_source *source;
    const struct relume_log *log;
};

static relume_status prepare(const struct job *job, const struct relume_light *lights, int n)
{
    bool near = false, environment = false;
    for (int i = 0; i < n; i++) {
        near |= relume_light_is_near(lights[i].kind);
        environment |= lights[i].kind == RELUME_LIGHT_ENVIRONMENT;
    }
    const struct relume_codes *codes = job->view->codes;
    relume_status status = near ? need_surface(job->view, job->source, job->log) : RELUME_OK;
    if (!status && (near || environment))
        status = need_grid(job->shared, codes->coder);
    if (!status && environment && codes->domain == RELUME_DOMAIN_DISPLAY)
        status = need_refit(job->view, job->shared, job->log);
    return status;
}

static relume_status keep_lights(struct software_group *g, const struct relume_light *lights, int n)
{
    struct relume_light *copy = malloc((size_t)n * sizeof *copy);
    if (!copy)
        return RELUME_ENOMEM;
    memcpy(copy, lights, (size_t)n * sizeof *copy);
    free(g->light);
    g->light = copy;
    g->lights = n;
    return RELUME_OK;
}

// Takes 1 light or more.
static relume_status relight_group(const struct job *job, struct software_group *g,
                                   const struct relume_light *lights, int n)
{
    const struct software_view *v = job->view;
    if (same_lights(g, lights, n))
        return RELUME_OK;
    relume_status status = prepare(job, lights, n);
    if (!status)
        status = keep_lights(g, lights, n);
    if (!status)
        status =
            relume_relight(&g->image, v->codes, lights, n,
                           relume_relight_params(.surface = v->surface.data ? &v->surface : NULL,
                                                 .grid = job->shared->grid, .refit = v->refit,
                                                 .threads = job->shared->threads));
    if (status)
        empty(g);
    return status;
}

// Group 0 holds what folds, the others as many each of the lights that stand alone.
static int group_of(int i, int alone)
{
    const int groups = SOFTWARE_GROUPS - 1;
    return 1 + (alone <= groups ? i : (int)((long long)i * groups / alone));
}

static int gather(struct relume_light *out, const struct software_view *v, int group,
                  const struct relume_light *lights, int n)
{
    int alone = 0, next = 0, count = 0;
    for (int i = 0; i < n; i++)
        alone += stands_alone(v, &lights[i]);
    for (int i = 0; i < n; i++) {
        const int to = stands_alone(v, &lights[i]) ? group_of(next++, alone) : 0;
        if (to == group)
            out[count++] = lights[i];
    }
    return count;
}

static relume_status relight_groups(const struct job *job, const struct relume_light *lights, int n)
{
    struct relume_light *some = malloc((size_t)n * sizeof *some + 1);
    relume_status status = some ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < SOFTWARE_GROUPS; i++) {
        const int count = gather(some, job->view, i, lights, n);
        if (count)
            status = relight_group(job, &job->view->group[i], some, count);
        else
            empty(&job->view->group[i]);
    }
    free(some);
    return status;
}

// ---------------------------------------------------------------- sum

static void add(struct relume_image *sum, const struct relume_image *image, bool first)
{
    const size_t n = 3 * (size_t)sum->width * (size_t)sum->height;
    float *restrict to = sum->data;
    const float *restrict from = image->data;
    if (first)
        memcpy(to, from, n * sizeof *to);
    for (size_t i = 0; !first && i < n; i++)
        to[i] += from[i];
}

// A group that stands alone is the sum.
static relume_status add_groups(const struct relume_image **out, struct software_view *v)
{
    int used = 0;
    for (int i = 0; i < SOFTWARE_GROUPS; i++)
        if (v->group[i].image.data && ++used)
            *out = &v->group[i].image;
    if (used == 1)
        return RELUME_OK;
    *out = &v->sum;
    if (!v->sum.data) {
        const relume_status status =
            relume_image_create(&v->sum, v->codes->width, v->codes->height, 3);
        if (status)
            return status;
    }
    if (!used)
        memset(v->sum.data, 0,
               3 * (size_t)v->sum.width * (size_t)v->sum.height * sizeof *v->sum.data);
    for (int i = 0, n = 0; i < SOFTWARE_GROUPS; i++)
        if (v->group[i].image.data)
            add(&v->sum, &v->group[i].image, n++ == 0);
    return RELUME_OK;
}

relume_status software_view_relight(const struct relume_image **out, struct software_view *v,
                                    struct software *shared, const struct code_source *source,
                                    const struct relume_light *lights, int n,
                                    const struct relume_log *log)
{
    const struct job job = {v, shared, source, log};
    const relume_status status = relight_groups(&job, lights, n);
    return status ? status : add_groups(out, v);
}
