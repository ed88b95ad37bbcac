// transport.h - the inside of relume_transport: which light arrives at a place, and from where
//
// Units are those of pictures: a white matte surface shows 1 where light of 1 comes from
// everywhere, and n.l under a lamp of 1.
#ifndef TRANSPORT_TRANSPORT_H
#define TRANSPORT_TRANSPORT_H

#include "world/transport/scenery.h"

#include <relume/relight/viewport.h>
#include <relume/world/transport.h>

// A place of a surface that light arrives at.
struct site {
    vec3 position, normal;  // unit, towards the eye
    vec3 start;             // where rays begin: just off the surface
    uint64_t key;           // of its random numbers
    // What the surface returns of light of 1 from a direction over all that a white matte one
    // returns; NULL: it is matte, or nothing is known of it.
    void (*answer)(float rgb[3], const void *context, vec3 towards);
    const void *answers;  // its context
    vec3 mirrored;        // unit; what a mirror there would show
    bool shines;          // of objects' own: it sends more in some directions than in others
};

// Light from one direction.
struct arrival {
    vec3 towards;      // unit
    double share;      // of what a white matte surface there shows, the cosine included
    float without[3];  // radiance, were there no objects
    float with[3];     // ... as it is
    // [3]: what the surface returns of light of 1, the share included; NULL: it is to be asked.
    const float *answer;
};

// A frame as it shows on the screen, for ways that go by that.
struct screen {
    const struct relume_image *places, *normals, *shown;
    const float *behind;  // [pixels]: how far off the eye it is open again; NULL: nowhere
};

// The objects alone from a further camera, along parallel rays.
struct further {
    vec3 middle, x, y, z;  // of its picture; unit, z is the way it looks
    double half;           // it shows so much to each side of the middle
    struct screen screen;  // `behind` is a depth along z; places of NaN: no object
};

// What light meets, under one light of the rig.
struct world {
    const struct scenery *scenery;
    const tracer *objects;
    const struct mesh *mesh;  // of the objects
    // Where a ray has met the objects; the light that they send back to its origin: what reaches
    // them from the lamps, and the arrivals, `n` of them.
    void (*site)(struct site *out, const void *context, const struct trace_hit *hit,
                 vec3 direction);
    void (*sent)(float rgb[3], const void *context, const struct trace_hit *hit, vec3 origin,
                 vec3 direction, uint64_t key, const struct arrival *arrivals, int n);
    // Of an arrival alone.
    void (*returned)(float rgb[3], const void *context, const struct trace_hit *hit, vec3 origin,
                     vec3 direction, const struct arrival *arrival);
    // Which part of what a place of the scene shows is left with the objects before its lamps.
    double (*dimmed)(const void *context, vec3 place, vec3 normal, uint64_t key);
    const void *context;
    const struct relume_viewport *viewport;
    struct screen bare, full;       // without the objects and with them
    const struct further *further;  // [furthers]: see what the frame does not
    int furthers;
    float mean[3];  // scenery_mean
    double radius;  // of the ball about the objects
    int samples;    // directions at each site
    int bounces;    // off objects
    int threads;
    void *state;  // of the way: what its `begin` has made
};

typedef void take_arrival(void *context, const struct arrival *arrival);

struct relume_transport {
    const char *name, *summary;
    int samples;     // at a site, by default
    int spacing;     // sites gather at every so many pixels each way, by default; 0: always at each
    int pattern;     // sites of `pattern` x `pattern` pixels share their directions; 1: none does
    bool screen;     // needs the frames
    int gl_version;  // OpenGL, times ten, by which relume-view gathers likewise; 0: it cannot
    int cameras;     // further ones, by default
    // NULL: there is nothing to prepare. What a light of the rig needs once before sites gather
    // under it; RELUME_ENOMEM. `end` frees it, and takes a state of NULL.
    relume_status (*begin)(struct world *w, const struct relume_log *log);
    void (*end)(struct world *w);
    void (*gather)(const struct world *w, const struct site *site, take_arrival *arrive,
                   void *context);
};

// Direction `i` of `n` from a site: half of them spread as the cosine to the normal
// (Hammersley's points, rotated by the key: Cranley and Patterson 1976), half by what the scenery
// sends, weighed against each other (the balance heuristic: Veach and Guibas 1995).
struct look {
    vec3 towards;
    struct scenery_hit scene;  // what would be seen there were there no objects
    double share;              // of what the scene sends there; 0: it is hidden, or counted already
    double share_nearer;       // of what something nearer sends, which only cosines find
};
void transport_look(struct look *out, const struct world *w, const struct site *site, int i, int n);

extern const struct relume_transport transport_none, transport_ssao, transport_ssdo, transport_ism,
    transport_radiosity, transport_micro, transport_path;

// ---------------------------------------------------------------- frames

// Whether places lie on one surface: not off its plane by more than a part of the distance that it
// is seen from, nor turned away.
bool transport_same(vec3 place, vec3 normal, vec3 other, vec3 other_normal, double distance);

// A mean over `size` x `size` pixels of each image, of those pixels that are the same surface by
// places and normals ("geometry-aware blur": Segovia et al. 2006); where a place is NaN nothing is
// changed; nor with a `size` of 1. RELUME_ENOMEM.
relume_status transport_smooth(struct relume_image *const *images, int count,
                               const struct relume_image *places,
                               const struct relume_image *normals, vec3 eye, int size, int threads);

// Between pixels that have gathered, which are those where transport_gathers: the ones about a
// pixel that show its surface, with weights that add up to 1 ("bilateral upsampling": Sloan et al.
// 2007). `count` is 0 where they are too few to tell.
struct between_pixels {
    int count;
    size_t pixel[4];
    double weight[4];
};
bool transport_gathers(int spacing, int x, int y);
void transport_between(struct between_pixels *out, int spacing, int x, int y,
                       const struct relume_image *places, const struct relume_image *normals,
                       vec3 eye);

#endif
