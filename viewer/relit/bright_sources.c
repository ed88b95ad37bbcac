// bright_sources.c - environments of files where shadows or highlights move, on the graphics card:
// each bright source is relit alone and replaced in the picture of the whole by what it shows with
// moving shadows and highlights. Twin: exchange_bright_sources of src/relight/frame/relighter.c
#include "common/vec.h"
#include "format/coder/coding.h"
#include "relight/light/environment.h"
#include "relight/shadow/moving.h"
#include "relit/gl_relighter.h"
#include "relit/gl_relighter_parts.h"
#include "relit/moving.h"

static relume_status need_targets(struct gl_relighter *r, const struct relit_view *v)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < 2; i++)
        status = draws_fit(r, &r->exchanged[i], v);
    return status;
}

void bright_sources_destroy(struct gl_relighter *r)
{
    for (int i = 0; i < 2; i++)
        target_destroy(&r->exchanged[i], r->gl);
}

// What an environment shows, before what is below 0 is seen to.
static relume_status relight_alone(const struct target **out, struct gl_relighter *r,
                                   struct relit_view *v, const struct relume_light *environment)
{
    if (v->codes.domain == RELUME_DOMAIN_DISPLAY) {
        if (r->linear)
            gl_relighter_forget(r->linear);  // that of another source may have had the same address
        return linear_copy_picture(out, r, v, environment, 1);
    }
    *out = &r->coded;
    return draws_environment(r, v, environment);
}

static relume_status exchange(struct gl_relighter *r, struct relit_view *v,
                              const struct relume_light *source, const struct target *whole,
                              const struct target *into)
{
    struct moving_picture p = {.picture = {.curve = RELUME_CURVE_LINEAR},
                               .times = {1.0f, 1.0f, 1.0f},
                               .coder = v->codes.coder,
                               .display = {.curve = RELUME_CURVE_LINEAR},
                               .left = v->at.left,
                               .top = v->at.top,
                               .whole = whole};
    struct relume_light alone = {.kind = RELUME_LIGHT_ENVIRONMENT, .rgb = {1.0f, 1.0f, 1.0f}};
    relume_environment *environment;
    const float share =
        (float)relume_coder_clamp(&p.direction, v->codes.coder, vec3_unit(source->direction));
    for (int c = 0; c < 3; c++)
        p.rgb[c] = share * source->rgb[c];
    relume_status status = relume_environment_of_lamp(&environment, source);
    alone.environment = environment;
    if (!status)
        status = relight_alone(&p.coded, r, v, &alone);
    if (!status) {
        target_begin(into, r->gl);
        status = moving_draw(&r->moving, &v->moving, &p, into);
    }
    relume_environment_destroy(&environment);
    return status;
}

static relume_status add_one(struct gl_relighter *r, struct relit_view *v,
                             const struct relume_light *environment)
{
    static const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};
    static const float one[3] = {1.0f, 1.0f, 1.0f};
    struct relume_light source[RELUME_SHADOW_LAMPS];
    const struct target *whole;
    int count;
    relume_status status =
        relume_shadows_bright_sources(source, &count, environment, v->codes.coder);
    if (!status)
        status = relight_alone(&whole, r, v, environment);
    if (status)
        return status;
    target_begin(&r->exchanged[0], r->gl);
    draws_guarded(r, v, whole);
    for (int i = 0; !status && i < count; i++)
        status = exchange(r, v, &source[i], &r->exchanged[i % 2], &r->exchanged[(i + 1) % 2]);
    target_resume(&v->relit, r->gl);
    draws_develop(r, v, &r->exchanged[count % 2], linear, one);
    return status;
}

relume_status bright_sources_relight(struct gl_relighter *r, struct relit_view *v)
{
    relume_status status = need_targets(r, v);
    for (int i = 0; !status && i < r->lights; i++)
        if (gl_relighter_is_environment(r->light[i].kind))
            status = add_one(r, v, &r->light[i]);
    return status;
}
