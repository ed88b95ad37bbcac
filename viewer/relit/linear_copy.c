// linear_copy.c - environments on codes of the display domain: a relighter of linear codes, made
// once from them
#include "relight/light/refit.h"
#include "relit/gl_relighter.h"
#include "relit/gl_relighter_parts.h"

#include <stdlib.h>

static relume_status linear_codes(const struct relume_codes **out, void *user, int view)
{
    struct linear_source *s = user;
    const struct relume_codes *codes;
    relume_refit **refit = s->first ? &s->refit : &s->first;
    relume_status status = s->source.codes(&codes, s->source.user, view);
    if (!status)
        status =
            relume_refit_create(refit, codes, relume_refit_params(.log = s->log, .like = s->first));
    if (!status)
        *out = relume_refit_codes(*refit);
    return status;
}

static void linear_drop(void *user, int view)
{
    struct linear_source *s = user;
    if (s->refit)
        relume_refit_destroy(&s->refit);
    else
        relume_refit_forget(s->first);
    if (s->source.drop)
        s->source.drop(s->source.user, view);
}

static relume_status need_linear(struct gl_relighter *r)
{
    if (r->linear)
        return RELUME_OK;
    r->linear = malloc(sizeof *r->linear);
    if (!r->linear)
        return RELUME_ENOMEM;
    r->linear_source = (struct linear_source){.source = r->source, .log = r->log};
    const struct code_source source = {
        .codes = linear_codes, .drop = linear_drop, .user = &r->linear_source};
    const relume_status status = gl_relighter_create(r->linear, r->gl, &source, r->views, r->log);
    if (status) {
        free(r->linear);
        r->linear = NULL;
    }
    return status;
}

relume_status linear_copy_picture(const struct target **out, struct gl_relighter *r,
                                  const struct relit_view *v,
                                  const struct relume_light *environments, int n)
{
    relume_status status = need_linear(r);
    if (!status)
        status = gl_relighter_begin(r->linear, environments, n);
    if (!status)
        status = gl_relighter_view(out, r->linear, (int)(v - r->view));
    draws_begin(r);
    return status;
}

// The linear copy under the environments alone.
relume_status linear_copy_relight(struct gl_relighter *r, struct relit_view *v)
{
    static const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};
    static const float one[3] = {1.0f, 1.0f, 1.0f};
    const struct target *copy;
    struct relume_light *environments = malloc((size_t)r->lights * sizeof *environments);
    int n = 0;
    for (int i = 0; environments && i < r->lights; i++)
        if (gl_relighter_is_environment(r->light[i].kind))
            environments[n++] = r->light[i];
    const relume_status status =
        environments ? linear_copy_picture(&copy, r, v, environments, n) : RELUME_ENOMEM;
    free(environments);
    if (status)
        return status;
    target_resume(&v->relit, r->gl);
    draws_develop(r, v, copy, linear, one);
    return RELUME_OK;
}

void linear_copy_destroy(struct gl_relighter *r)
{
    if (r->linear)
        gl_relighter_destroy(r->linear);
    free(r->linear);
    relume_refit_destroy(&r->linear_source.first);
}
