// path.c - light followed backwards along random rays (Kajiya 1986, "The rendering equation"): the
// reference of all other ways
//
// A ray that meets the captured scene ends there: what the scene sends holds all of its bounces
// already, less what the objects keep from it. One that meets objects goes on from there while
// bounces are left, by one ray for each step.
#include "world/transport/transport.h"

static bool meets_objects(struct trace_hit *hit, const struct world *w, vec3 origin, vec3 direction,
                          double distance)
{
    float from[3], along[3];
    vec3_store(from, origin);
    vec3_store(along, direction);
    return trace_closest(w->objects, from, along, hit) && (double)hit->distance < distance;
}

static void arrive_from(struct arrival *out, const struct world *w, const struct site *site,
                        const struct look *look, int bounces);

// What the objects send, with what arrives there in its turn.
static void from_objects(float rgb[3], const struct world *w, const struct trace_hit *hit,
                         vec3 origin, vec3 direction, uint64_t key, int bounces)
{
    enum { LOOKS = 2 };  // as the cosine, and for what is bright
    struct arrival arrival[LOOKS];
    struct site site;
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (bounces < 1)
        return;
    w->site(&site, w->context, hit, direction);
    site.key = key * 0x9e3779b97f4a7c15u + 1;
    for (int i = 0; i < LOOKS; i++) {
        struct look look;
        transport_look(&look, w, &site, i, LOOKS);
        arrive_from(&arrival[i], w, &site, &look, bounces - 1);
    }
    w->sent(rgb, w->context, hit, origin, direction, site.key, arrival, LOOKS);
}

static void scaled(float out[3], double factor, const float rgb[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = (float)factor * rgb[c];
}

static void arrive_from(struct arrival *out, const struct world *w, const struct site *site,
                        const struct look *look, int bounces)
{
    const struct scenery_hit *scene = &look->scene;
    struct trace_hit hit;
    *out = (struct arrival){.towards = look->towards, .share = 1.0};
    scaled(out->without, look->share, scene->sent);
    if (meets_objects(&hit, w, site->start, look->towards, scene->distance)) {
        if (look->share_nearer > 0.0)
            from_objects(out->with, w, &hit, site->start, look->towards, site->key, bounces);
        scaled(out->with, look->share_nearer, out->with);
        return;
    }
    const double part = look->share > 0.0 && scene->distance < INFINITY
                            ? w->dimmed(w->context, scene->place, scene->normal, site->key)
                            : 1.0;
    scaled(out->with, part * look->share, scene->sent);
}

static void gather(const struct world *w, const struct site *site, take_arrival *arrive,
                   void *context)
{
    struct site one = *site;
    for (int i = 0; i < w->samples; i++) {
        struct look look;
        struct arrival a;
        transport_look(&look, w, site, i, w->samples);
        one.key = site->key + 0x10001u * (uint64_t)i;
        if (!(look.share > 0.0 || look.share_nearer > 0.0))
            continue;
        arrive_from(&a, w, &one, &look, w->bounces);
        arrive(context, &a);
    }
}

const struct relume_transport transport_path = {
    .name = "path",
    .summary = "paths of light by random rays: the reference of the others",
    .samples = 64,
    .spacing = 1,
    .pattern = 1,
    .gather = gather,
};
