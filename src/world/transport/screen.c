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
#include "world/transport/transport.h"

#include "core/math/random.h"
#include "core/math/scalar.h"
#include "relight/frame/viewport.h"
#include "shape/mesh/places.h"

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

// The same of a further camera, where it shows an object.
static bool pixel_of_further(size_t *pixel, const struct further *f, vec3 place)
{
    const struct relume_image *image = f->screen.places;
    const vec3 off = vec3_sub(place, f->middle);
    const double x = 0.5 * (1.0 + vec3_dot(off, f->x) / f->half) * image->width,
                 y = 0.5 * (1.0 + vec3_dot(off, f->y) / f->half) * image->height;
    if (!(x >= 0.0 && y >= 0.0 && x < image->width && y < image->height))
        return false;
    *pixel = (size_t)y * (size_t)image->width + (size_t)x;
    return !isnan(image->data[3 * *pixel]);
}

// What stands in the way.
struct blocker {
    double part;  // 0: nothing
    const struct screen *screen;
    size_t pixel;
    bool faces;   // the site
    double away;  // from the place that is tried
};

// One that is `inside`, at `depth` from its camera: none where it is as far as the radius.
static void block(struct blocker *out, const struct world *w, const struct screen *screen,
                  size_t pixel, const struct site *site, vec3 tried, double depth, double front)
{
    const double BEGIN = 0.7;  // of the radius: from there on blockers fade
    const vec3 seen = places_at(screen->places, pixel), to = vec3_sub(site->position, seen);
    const bool inside = depth > front && !(screen->behind && depth > (double)screen->behind[pixel]);
    *out = (struct blocker){
        .part = inside ? 1.0 - smoothstep(BEGIN, 1.0, vec3_length(to) / w->radius) : 0.0,
        .screen = screen,
        .pixel = pixel,
        .faces = vec3_dot(to, places_at(screen->normals, pixel)) > 0.0,
        .away = vec3_length(vec3_sub(seen, tried)),
    };
}

static struct blocker blocker_of(const struct world *w, const struct screen *screen,
                                 const struct site *site, vec3 tried)
{
    const vec3 eye = relume_viewport_eye(w->viewport);
    struct blocker b = {.part = 0.0};
    size_t pixel;
    if (pixel_of(&pixel, w, tried))
        block(&b, w, screen, pixel, site, tried, vec3_length(vec3_sub(tried, eye)),
              vec3_length(vec3_sub(places_at(screen->places, pixel), eye)));
    return b;
}

// What the further cameras see there: of several the one whose front the site sees, and of these
// the nearest.
static void look_further(struct blocker *b, const struct world *w, const struct site *site,
                         vec3 tried)
{
    for (int i = 0; i < w->furthers; i++) {
        const struct further *f = &w->further[i];
        struct blocker other;
        size_t pixel;
        if (!pixel_of_further(&pixel, f, tried))
            continue;
        block(&other, w, &f->screen, pixel, site, tried, vec3_dot(vec3_sub(tried, f->middle), f->z),
              vec3_dot(vec3_sub(places_at(f->screen.places, pixel), f->middle), f->z));
        const bool better =
            b->part > 0.0 ? other.faces && (!b->faces || other.away < b->away) : true;
        if (other.part > 0.0 && better)
            *b = other;
    }
}

// What comes from a direction past a blocker, or from it.
static void arrive_from(float rgb[3], const struct blocker *b, const struct look *look,
                        const float open[3], bool bounces)
{
    const bool sends = b->part > 0.0 && b->faces && bounces;
    for (size_t c = 0; c < 3; c++) {
        const float sent = sends ? fmaxf(b->screen->shown->data[3 * b->pixel + c], 0.0f) : 0.0f;
        rgb[c] = (float)((1.0 - b->part) * look->share * (double)open[c] +
                         b->part * look->share_nearer * (double)sent);
    }
}

static void gather(const struct world *w, const struct site *site, take_arrival *arrive,
                   void *context, bool directional)
{
    struct random steps = random_stream(2, site->key, 0);
    for (int i = 0; i < w->samples; i++) {
        struct look look;
        transport_look(&look, w, site, i, w->samples);
        const double away = w->radius * (1.0 - random_next(&steps));
        const vec3 tried = vec3_along(site->start, look.towards, away);
        const float *open = directional ? look.scene.sent : w->mean;
        struct arrival a = {.towards = look.towards, .share = 1.0};
        if (!directional)
            look.share = look.share_nearer;
        const struct blocker bare = blocker_of(w, &w->bare, site, tried);
        struct blocker full = blocker_of(w, &w->full, site, tried);
        if (!(look.scene.distance < away))  // else the scene is before what they see
            look_further(&full, w, site, tried);
        arrive_from(a.without, &bare, &look, open, directional);
        arrive_from(a.with, &full, &look, open, directional && w->bounces > 0);
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

// Without what blockers send cameras gain nothing (docs/measurements/transport.md).
enum { SAMPLES = 16, PATTERN = 4, CAMERAS = 4 };

const struct relume_transport transport_ssao = {
    .name = "ssao",
    .summary = "even light, kept away by what the frame shows near by",
    .samples = SAMPLES,
    .pattern = PATTERN,
    .screen = true,
    .gl_version = 33,
    .gather = gather_ambient,
};
const struct relume_transport transport_ssdo = {
    .name = "ssdo",
    .summary = "light of each direction, kept away or sent by what the frame shows near by",
    .samples = SAMPLES,
    .pattern = PATTERN,
    .screen = true,
    .gl_version = 33,
    .cameras = CAMERAS,
    .gather = gather_directional,
};
