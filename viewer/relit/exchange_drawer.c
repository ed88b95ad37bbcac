// exchange_drawer.c - the library draws what was asked for: a file with objects in it, or a scene
// file
#include "relit/exchange_drawer.h"

#include <relume/exchange.h>

enum {
    ROUGHER = 4,      // times fewer pixels along each side
    FINER_ACROSS = 3  // rays along each side of a pixel, as `relume relight` has it
};

static relume_status need_file(struct exchange_drawer *d)
{
    if (d->pack || d->tableau)
        return RELUME_OK;
    d->opens = true;
    const relume_status status =
        d->source.scene
            ? relume_tableau_open(
                  &d->tableau, d->source.file,
                  relume_tableau_params(.log = d->log, .threads = d->source.threads))
            : relume_open(&d->pack, d->source.file,
                          relume_open_params(.log = d->log, .threads = d->source.threads,
                                             .sphere = d->source.sphere));
    d->opens = false;
    return status;
}

static struct relume_render_params render_params(const struct exchange_drawer *d,
                                                 const struct exchange_request *q,
                                                 enum exchange_step step)
{
    return *relume_render_params(.log = d->log,
                                 .samples = step == EXCHANGE_STEP_ROUGH ? 1 : FINER_ACROSS,
                                 .threads = d->source.threads, .transport = q->transport,
                                 .transport_samples = q->samples, .bounces = q->bounces);
}

static relume_status need_renderer(struct exchange_drawer *d, struct exchange_drawn *s,
                                   const struct exchange_request *q, enum exchange_step step)
{
    const struct relume_frame_params params =
        *relume_frame_params(.log = d->log, .threads = d->source.threads,
                             .interpolation = q->interpolation, .aperture = q->aperture,
                             .focus = q->focus);
    const struct relume_render_params render = render_params(d, q, step);
    relume_status status = RELUME_OK;
    if (!s->renderer)
        status = relume_renderer_create(&s->renderer, d->pack, &params);
    if (status)
        return status;
    relume_renderer_set(s->renderer, &params);
    if (s->set.transport && exchange_same_way(&s->set, q) && s->step == step)
        return RELUME_OK;
    s->set.transport = NULL;
    status = relume_renderer_set_objects(s->renderer, d->source.objects, &render);
    if (!status) {
        s->set = *q;
        s->step = step;
    }
    return status;
}

static int rougher(int pixels, enum exchange_step step)
{
    const int fewer = step == EXCHANGE_STEP_ROUGH ? (pixels + ROUGHER - 1) / ROUGHER : pixels;
    return fewer > 0 ? fewer : 1;
}

relume_status exchange_draw(struct relume_image *out, struct exchange_drawer *d, int slot,
                            const struct exchange_request *q, enum exchange_step step)
{
    struct exchange_drawn *s = &d->slot[slot];
    struct relume_camera camera = q->camera;
    camera.width = rougher(camera.width, step);
    camera.height = rougher(camera.height, step);
    relume_status status = need_file(d);
    if (!status && d->tableau) {
        const struct relume_render_params render = render_params(d, q, step);
        return relume_tableau_frame(out, d->tableau, &camera, q->lights, q->count, &render);
    }
    if (!status)
        status = need_renderer(d, s, q, step);
    if (!status)
        status = relume_renderer_set_lights(s->renderer, q->lights, q->count);
    return status ? status : relume_renderer_frame(out, s->renderer, &camera);
}

void exchange_drawer_release(struct exchange_drawer *d)
{
    for (int i = 0; i < EXCHANGER_SLOTS; i++)
        relume_renderer_destroy(&d->slot[i].renderer);
    relume_tableau_destroy(&d->tableau);
    relume_pack_destroy(&d->pack);
}
