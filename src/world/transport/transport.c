// transport.c - the list of ways, and what they share
#include "world/transport/transport.h"

#include "core/math/random.h"
#include "world/transport/gl_version.h"

#include <string.h>

const struct relume_transport transport_none = {
    .name = "none",
    .summary = "hard shadows of objects on the scene; no light goes between",
};

const struct relume_transport *const relume_transports[] = {
    &transport_none,      &transport_ssao,  &transport_ssdo, &transport_ism,
    &transport_radiosity, &transport_micro, &transport_path, NULL};

const struct relume_transport *relume_transport_find(const char *name)
{
    for (const struct relume_transport *const *t = relume_transports; *t; t++)
        if (!strcmp((*t)->name, name))
            return *t;
    return NULL;
}

const char *relume_transport_name(const struct relume_transport *transport)
{
    return transport->name;
}

int relume_transport_samples(const struct relume_transport *transport)
{
    return transport->samples;
}

int relume_transport_spacing(const struct relume_transport *transport)
{
    return transport->spacing;
}

int relume_transport_gl_version(const struct relume_transport *transport)
{
    return transport->gl_version;
}

int relume_transport_cameras(const struct relume_transport *transport)
{
    return transport->screen ? transport->cameras : -1;
}

// The binary digits of i, mirrored at the point (van der Corput).
static double mirrored(uint32_t i)
{
    i = (i << 16) | (i >> 16);
    i = ((i & 0x00ff00ffu) << 8) | ((i & 0xff00ff00u) >> 8);
    i = ((i & 0x0f0f0f0fu) << 4) | ((i & 0xf0f0f0f0u) >> 4);
    i = ((i & 0x33333333u) << 2) | ((i & 0xccccccccu) >> 2);
    i = ((i & 0x55555555u) << 1) | ((i & 0xaaaaaaaau) >> 1);
    return (double)i * 0x1p-32;
}

static double wrapped(double x)
{
    return x - floor(x);
}

// Around the normal, as the cosine to it.
static vec3 spread(vec3 normal, double u, double v)
{
    const double r = sqrt(u), up = sqrt(fmax(1.0 - u, 1e-6)), around = 2.0 * M_PI * v;
    const vec3 any = fabs(normal.x) < 0.7 ? vec3_of(1, 0, 0) : vec3_of(0, 1, 0);
    const vec3 x = vec3_unit(vec3_cross(any, normal)), y = vec3_cross(normal, x);
    return vec3_unit(
        vec3_along(vec3_along(vec3_scale(x, r * cos(around)), y, r * sin(around)), normal, up));
}

void transport_look(struct look *out, const struct world *w, const struct site *site, int i, int n)
{
    const int bright = n / 2, even = n - bright;
    struct random turn = random_stream(1, site->key, i >= even);
    const double a = random_next(&turn), b = random_next(&turn), c = random_next(&turn);
    *out = (struct look){.share_nearer = i < even ? 1.0 / even : 0.0};
    if (i < even) {
        out->towards =
            spread(site->normal, wrapped((i + 0.5) / even + a), wrapped(mirrored((uint32_t)i) + b));
        (void)scenery_meet(&out->scene, w->scenery, site->start, out->towards);
    } else {
        const int k = i - even;
        const double random[3] = {wrapped((k + 0.5) / bright + a),
                                  wrapped(mirrored((uint32_t)k) + b),
                                  wrapped(k * 0.6180339887498949 + c)};
        size_t source;
        if (!scenery_draw(&out->towards, &source, w->scenery, site->start, random))
            return;
        (void)scenery_meet(&out->scene, w->scenery, site->start, out->towards);
        if (out->scene.source != source)
            return;
    }
    const double cosine = vec3_dot(out->towards, site->normal) / M_PI;
    const double drawn = bright ? scenery_density(w->scenery, &out->scene, out->towards) : 0.0;
    out->share = cosine > 0.0 ? cosine / (even * cosine + bright * drawn) : 0.0;
}
