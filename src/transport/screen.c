// screen.c - light by what the frame itself shows: ambient occlusion (Mittring 2007, "Finding next
// gen: CryEngine 2") and directional occlusion with one bounce (Ritschel, Grosch, Seidel 2009,
// "Approximating dynamic global illumination in image space")
//
// Places are tried a random part of a radius away from the site. One that the frame sees something
// in front of is blocked in that direction, unless it lies behind the back of that, too (the second
// layer of the paper's depth peeling). With directional occlusion what blocks sends what its
// pixel shows, as its pixel faces the site, and from all other directions comes what the captured
// scene sends from there. (The paper weighs a blocker by a form factor with a guessed area; here it
// has the direction's own share, so that no light is made.) With ambient occlusion light is even
// all around, and blockers send none.
#include "transport/transport.h"

#include "mesh/places.h"
#include "math/random.h"
#include "math/scalar.h"

// The pixel at which a place appears; false outside.
static bool pixel_of(size_t *pixel, const struct world *w, vec3 place)
{
    const struct relume_image *image = w->bare.places;
    double xy[2];
    if (!relume_viewport_project(xy, w->viewport, place) ||
        !(xy[0] >= 0.0 && xy[1] >= 0.0 && xy[0] < image->width && xy[1] < image->height))
        return false;
    *pixel = (size_t)xy[1] * (size_t)image->width + (size_t)xy[0];
    return true;
}

// How much of a blocker stands in the way: none where it is as far as the radius.
static double part_blocked(const struct world *w, const struct screen *screen, size_t pixel,
                           const struct site *site, vec3 tried)
{
    const double BEGIN = 0.7;  // of the radius: from there on blockers fade
    const vec3 eye = relume_viewport_eye(w->viewport), seen = places_at(screen->places, pixel);
    const double away = vec3_length(vec3_sub(seen, site->position)) / w->radius;
    const double depth = vec3_length(vec3_sub(tried, eye));
    const bool inside = depth > vec3_length(vec3_sub(seen, eye)) &&
                        !(screen->behind && depth > (double)screen->behind[pixel]);
    return inside ? 1.0 - smoothstep(BEGIN, 1.0, away) : 0.0;
}

static void from_pixel(float rgb[3], const struct screen *screen, size_t pixel,
                       const struct site *site)
{
    const vec3 to = vec3_sub(site->position, places_at(screen->places, pixel));
    const bool faces = vec3_dot(to, places_at(screen->normals, pixel)) > 0.0;
    for (size_t c = 0; c < 3; c++)
        rgb[c] = faces ? fmaxf(screen->shown->data[3 * pixel + c], 0.0f) : 0.0f;
}

// What comes from a direction, as a screen has it.
static void arrive_from(float rgb[3], const struct world *w, const struct screen *screen,
                        const struct site *site, const struct look *look, vec3 tried,
                        const float open[3], bool bounces)
{
    float sent[3] = {0.0f, 0.0f, 0.0f};
    size_t pixel;
    const double part =
        pixel_of(&pixel, w, tried) ? part_blocked(w, screen, pixel, site, tried) : 0.0;
    if (part > 0.0 && bounces)
        from_pixel(sent, screen, pixel, site);
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)((1.0 - part) * look->share * (double)open[c] +
                         part * look->share_nearer * (double)sent[c]);
}

static void gather(const struct world *w, const struct site *site, take_arrival *arrive,
                   void *context, bool directional)
{
    struct random steps = random_stream(2, site->key, 0);
    for (int i = 0; i < w->samples; i++) {
        struct look look;
        transport_look(&look, w, site, i, w->samples);
        const vec3 tried =
            vec3_along(site->start, look.towards, w->radius * (1.0 - random_next(&steps)));
        const float *open = directional ? look.scene.sent : w->mean;
        struct arrival a = {.towards = look.towards, .share = 1.0};
        if (!directional)
            look.share = look.share_nearer;
        arrive_from(a.without, w, &w->bare, site, &look, tried, open, directional);
        arrive_from(a.with, w, &w->full, site, &look, tried, open, directional && w->bounces > 0);
        arrive(context, &a);
    }
}

static void gather_ambient(const struct world *w, const struct site *site, take_arrival *arrive,
                           void *context)
{
    gather(w, site, arrive, context, false);
}

static void gather_directional(const struct world *w, const struct site *site, take_arrival *arrive,
                               void *context)
{
    gather(w, site, arrive, context, true);
}

enum { SAMPLES = 16, PATTERN = 4 };

const struct relume_transport transport_ssao = {
    .name = "ssao",
    .summary = "even light, kept away by what the frame shows near by",
    .samples = SAMPLES,
    .pattern = PATTERN,
    .screen = true,
    .passes = 33,
    .gather = gather_ambient,
};
const struct relume_transport transport_ssdo = {
    .name = "ssdo",
    .summary = "light of each direction, kept away or sent by what the frame shows near by",
    .samples = SAMPLES,
    .pattern = PATTERN,
    .screen = true,
    .passes = 33,
    .gather = gather_directional,
};
